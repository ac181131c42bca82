//! Small buildings in which something melts.

use mascarin_engine::description::{
    Description, Facing, FormulaNumber, MeltingCurve, PcmLaw, TablePoints, Tail, ZoneLongwave,
};
use mascarin_engine::number::Real;

use super::{Builder, cell_weather, facing, set};

/// A phase-change ceiling between a hot gap and a room, everything else imposed.
pub fn ceiling(gamma: f64) -> Description {
    layered(gamma, (0.00526, 4), 4.0)
}

/// The same with a number of nodes and a coefficient above [W/(m2 K)]: where the melting is sharp, the nodes are many and the coefficient
/// is strong, Newton's iteration fails in some steps.
pub fn fine_ceiling(gamma: f64, nodes: usize, coefficient: f64) -> Description {
    layered(gamma, (0.005, nodes), coefficient)
}

/// The ceiling with a thickness [m] and a number of nodes of what melts, and the heat transfer coefficient above it [W/(m2 K)].
fn layered(gamma: f64, (thickness, nodes): (f64, usize), coefficient: f64) -> Description {
    let mut b = Builder::new();
    let board = b.solid("board", 0.16, 800.0, 1090.0);
    let energain = b.energain(gamma);
    let construction = b.construction("ceiling", &[(energain, thickness, nodes), (board, 0.0125, 2)]);
    let room = b.zone("room", 27.0, 0.5, ZoneLongwave::None);
    let above = b.channel("above");
    let (outer, inner) = (b.convection(coefficient), b.convection(6.0));
    let inside = b.inside(room, inner, 0.9);
    let outside = facing(Facing::Measured { channel: above }, Some(outer));
    b.surface("ceiling", construction, [9.0, 0.0, 0.0], outside, inside);
    b.describe()
}

/// Swings that cross the melting range every day, with some jumps.
pub fn ceiling_weather(time: f64, row: &mut [f64]) {
    cell_weather(time, row);
    let day = time / 86400.0;
    let jump = if (3.0 * day).fract() < 0.1 { 6.0 } else { 0.0 };
    set(row, 0, 24.0 + 9.0 * Real::sin(core::f64::consts::TAU * day) + jump);
}

/// Layers that melt between an imposed temperature and a room: one for each shape of the melting curve. With a model of
/// hysteresis each material freezes 2 K below its melting, or supercools by them; without one, layers with tabulated laws are added.
pub fn melting(model: Option<&str>) -> Description {
    let mut b = Builder::new();
    let board = b.solid("board", 0.16, 800.0, 1090.0);
    let room = b.zone("room", 27.0, 0.5, ZoneLongwave::None);
    let above = b.channel("above");
    let mut laws = Vec::new();
    for shape in 0..SHAPES {
        let latent_heat = b.number("law.latent_heat", 71e3);
        let heating = curve(&mut b, shape, 23.0);
        laws.push(match model {
            None => PcmLaw::Melting { latent_heat, curve: heating },
            Some("supercooling") => {
                let numbers = [("degree", 2.0), ("time_constant", 600.0)].map(|(name, value)| {
                    FormulaNumber { name: name.to_owned(), value: b.number(name, value) }
                });
                let (model, curves) = ("supercooling".to_owned(), vec![heating]);
                PcmLaw::History { latent_heat, model, curves, numbers: numbers.into() }
            }
            Some(model) => {
                let cooling = curve(&mut b, shape, 21.0);
                let curves = vec![heating, cooling];
                PcmLaw::History { latent_heat, model: model.to_owned(), curves, numbers: Vec::new() }
            }
        });
    }
    if model.is_none() {
        let temperatures = vec![19.0, 21.0, 22.5, 23.0, 24.5];
        let enthalpies = vec![0.0, 8e3, 40e3, 65e3, 80e3];
        let capacities = vec![3e3, 6e3, 35e3, 20e3, 3e3];
        for points in [TablePoints::Enthalpies(enthalpies), TablePoints::Capacities(capacities)] {
            laws.push(PcmLaw::Tabulated {
                temperatures: temperatures.clone(),
                points,
                melting_range: [20.0, 24.0],
                temperature_shift: b.number("law.temperature_shift", 0.2),
                enthalpy_scale: b.number("law.enthalpy_scale", 0.9),
            });
        }
    }
    for (index, law) in laws.into_iter().enumerate() {
        let name = format!("pcm_{index}");
        let pcm = b.pcm(&name, [[0.22, 0.18], [3134.0, 2833.0]], 855.0, law);
        let construction = b.construction(&name, &[(pcm, 0.00526, 3), (board, 0.0125, 2)]);
        let (outer, inner) = (b.convection(4.0), b.convection(6.0));
        let inside = b.inside(room, inner, 0.9);
        let outside = facing(Facing::Measured { channel: above }, Some(outer));
        b.surface(&name, construction, [1.5, 0.0, 0.0], outside, inside);
    }
    b.describe()
}

/// Swings that turn within the melting range.
pub fn melting_weather(time: f64, row: &mut [f64]) {
    ceiling_weather(time, row);
    let angle = core::f64::consts::TAU * time / 86400.0;
    set(row, 0, 22.5 + 5.0 * Real::sin(3.0 * angle) + 3.0 * Real::sin(7.7 * angle));
}

/// Number of shapes that [`curve`] knows.
const SHAPES: usize = 9;

/// A melting curve of a shape about a temperature [degC].
fn curve(b: &mut Builder, shape: usize, at: f64) -> MeltingCurve {
    let mut put = |leaf: &str, value: f64| b.number(&format!("law.{leaf}"), value);
    let melting_temperature = put("melting_temperature", at);
    match shape {
        0 => MeltingCurve::TanhWidth { melting_temperature, width: put("width", 0.7) },
        1 => MeltingCurve::SmoothStep { melting_temperature, width: put("width", 1.1), continuity: 1 },
        2 => MeltingCurve::SmoothStep { melting_temperature, width: put("width", 1.2), continuity: 2 },
        3 => MeltingCurve::Gaussian { melting_temperature, width: put("width", 0.6) },
        4 => MeltingCurve::Gumbel { melting_temperature, width: put("width", 0.5), tail: Tail::Low },
        5 => MeltingCurve::Gumbel { melting_temperature, width: put("width", 0.5), tail: Tail::High },
        6 => MeltingCurve::Linear { melting_temperature, width: put("width", 1.0) },
        7 => {
            MeltingCurve::Triangle { melting_temperature, below: put("below", 1.3), above: put("above", 0.8) }
        }
        _ => MeltingCurve::Fractions {
            temperatures: vec![21.0, 22.0, 22.8, 23.4, 24.0],
            fractions: vec![0.0, 0.1, 0.5, 0.9, 1.0],
            temperature_shift: put("temperature_shift", at - 23.0),
        },
    }
}
