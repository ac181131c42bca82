//! Small buildings and weathers for the tests of the engine.

#![allow(dead_code, reason = "unit tests and tests of whole runs use parts of their own")]

pub mod assorted;
pub mod conditioned;
pub mod difficult;
pub mod glazed;
pub mod glazed_box;
pub mod linear;
pub mod melting;
pub mod random;

use mascarin_engine::RunControl;
use mascarin_engine::Scheme;
use mascarin_engine::description::{
    Clouds, Construction, Convection, Description, Exposure, Facing, Infiltration, Layer, Material,
    MeltingCurve, OutdoorLongwave, ParamId, Parameter, PcmLaw, PublishedLaw, Sensor, Side, Site, Sky,
    Surface, WindProfile, Zone, ZoneLongwave, ZoneSun,
};
use mascarin_engine::error::EngineError;
use mascarin_engine::forcing::{CLIMATE_CHANNELS, Forcing, channel};
use mascarin_engine::number::Real;
use mascarin_engine::plan::Plan;
use mascarin_engine::run::outputs::Output;
use mascarin_engine::run::{Options, Run, Warmup, simulate};
use mascarin_engine::state::Initial;

/// All schemes.
pub const ALL_SCHEMES: [Scheme; 4] =
    [Scheme::Sdirk2, Scheme::LinearlyImplicit, Scheme::BackwardEuler, Scheme::ApparentCapacity];
/// Those whose stages are solved to the end.
pub const SCHEMES: [Scheme; 3] = [Scheme::Sdirk2, Scheme::BackwardEuler, Scheme::ApparentCapacity];

/// Writes a description part by part.
pub struct Builder {
    pub description: Description,
}

/// A layer: material, thickness [m] (ignored for a resistance), nodes.
pub type LayerOf = (usize, f64, usize);

/// A published law of convection with its numbers.
pub fn law(kind: &str, numbers: &[(String, ParamId)]) -> Convection {
    let numbers: Vec<(&str, ParamId)> = numbers.iter().map(|(name, id)| (name.as_str(), *id)).collect();
    Convection::law(kind, &numbers)
}

impl Builder {
    /// A site at sea level under a sky 10 K colder than the air, without parts.
    pub fn new() -> Self {
        let mut parameters = Vec::new();
        let mut add = |path: &str, value: f64| {
            parameters.push(Parameter { path: path.to_owned(), value });
            ParamId(u32::try_from(parameters.len() - 1).unwrap())
        };
        let site = Site {
            altitude: add("site.altitude", 55.0),
            air_density: None,
            air_specific_heat: None,
            ground_reflectance: add("site.ground_reflectance", 0.2),
            wind: WindProfile {
                mast_height: add("site.wind.mast_height", 10.0),
                mast_exponent: add("site.wind.mast_exponent", 0.14),
                mast_layer: add("site.wind.mast_layer", 270.0),
                exponent: add("site.wind.exponent", 0.22),
                layer: add("site.wind.layer", 370.0),
            },
            sky: Sky::Law(PublishedLaw::new(
                "martin_berdahl",
                &[
                    ("a", add("site.sky.a", 0.711)),
                    ("b", add("site.sky.b", 0.56)),
                    ("c", add("site.sky.c", 0.73)),
                ],
            )),
            cloud: Clouds::Factor([
                add("site.cloud.c1", 0.0224),
                add("site.cloud.c2", -0.0035),
                add("site.cloud.c3", 0.00028),
            ]),
            sky_exponent: None,
            sky_diurnal: None,
            diffuse: "perez".to_owned(),
            horizon: Vec::new(),
        };
        let description = Description {
            outputs: Vec::new(),
            parameters,
            site,
            materials: Vec::new(),
            constructions: Vec::new(),
            zones: Vec::new(),
            air_paths: Vec::new(),
            directed_flows: Vec::new(),
            doors: Vec::new(),
            ventilation_units: Vec::new(),
            thermal_bridges: Vec::new(),
            openings: Vec::new(),
            vents: Vec::new(),
            controls: Vec::new(),
            surfaces: Vec::new(),
            heat_sources: Vec::new(),
            sensors: Vec::new(),
            humidity: None,
            shades: Vec::new(),
            channels: Vec::new(),
        };
        Self { description }
    }

    pub fn number(&mut self, path: &str, value: f64) -> ParamId {
        self.description.parameters.push(Parameter { path: path.to_owned(), value });
        ParamId(u32::try_from(self.description.parameters.len() - 1).unwrap())
    }

    pub fn channel(&mut self, name: &str) -> usize {
        self.description.channels.push(name.to_owned());
        self.description.channels.len() - 1
    }

    fn material(&mut self, material: Material) -> usize {
        self.description.materials.push(material);
        self.description.materials.len() - 1
    }

    pub fn solid(&mut self, name: &str, conductivity: f64, density: f64, specific_heat: f64) -> usize {
        let material = Material::Solid {
            conductivity: self.number(&format!("materials.{name}.conductivity"), conductivity),
            density: self.number(&format!("materials.{name}.density"), density),
            specific_heat: self.number(&format!("materials.{name}.specific_heat"), specific_heat),
        };
        self.material(material)
    }

    pub fn resistance(&mut self, name: &str, resistance: f64) -> usize {
        let resistance = self.number(&format!("materials.{name}.resistance"), resistance);
        self.material(Material::Resistance { resistance })
    }

    /// `numbers`: conductivity, specific heat of solid and liquid.
    pub fn pcm(&mut self, name: &str, numbers: [[f64; 2]; 2], density: f64, law: PcmLaw) -> usize {
        let mut pair = |leaf: &str, values: [f64; 2]| {
            [("solid", values[0]), ("liquid", values[1])]
                .map(|(phase, value)| self.number(&format!("materials.{name}.{leaf}.{phase}"), value))
        };
        let material = Material::Pcm {
            conductivity: pair("conductivity", numbers[0]),
            specific_heat: pair("specific_heat", numbers[1]),
            density: pair("density", [density; 2]),
            law,
        };
        self.material(material)
    }

    pub fn tanh(&mut self, latent_heat: f64, melting_temperature: f64, width: f64) -> PcmLaw {
        PcmLaw::Melting {
            latent_heat: self.number("law.latent_heat", latent_heat),
            curve: MeltingCurve::TanhWidth {
                melting_temperature: self.number("law.melting_temperature", melting_temperature),
                width: self.number("law.width", width),
            },
        }
    }

    /// The paper's material: Table 2 with a sharpness.
    pub fn energain(&mut self, gamma: f64) -> usize {
        let law = PcmLaw::Melting {
            latent_heat: self.number("materials.energain.latent_heat", 71e3),
            curve: MeltingCurve::TanhGamma {
                melting_temperature: self.number("materials.energain.melting_temperature", 23.4),
                gamma: self.number("materials.energain.law.gamma", gamma),
                delta_t: self.number("materials.energain.law.delta_t", 0.01),
            },
        };
        self.pcm("energain", [[0.22, 0.18], [3134.0, 2833.0]], 855.0, law)
    }

    pub fn construction(&mut self, name: &str, layers: &[LayerOf]) -> usize {
        let layers = layers.iter().enumerate().map(|(i, &(material, thickness, nodes))| Layer {
            name: format!("layer_{i}"),
            material,
            thickness: (nodes > 0)
                .then(|| self.number(&format!("constructions.{name}.layers.{i}.thickness"), thickness)),
            nodes,
        });
        let layers = layers.collect();
        self.description.constructions.push(Construction {
            name: name.to_owned(),
            layers,
            glazing: None,
            blind: None,
        });
        self.description.constructions.len() - 1
    }

    /// A zone of a volume [m3] with constant air changes [1/h].
    pub fn zone(&mut self, name: &str, volume: f64, air_changes: f64, longwave: ZoneLongwave) -> usize {
        let zone = Zone {
            name: name.to_owned(),
            volume: self.number(&format!("zones.{name}.volume"), volume),
            capacity_factor: self.number(&format!("zones.{name}.capacity_factor"), 1.0),
            infiltration: Infiltration {
                law: None,
                constant: self.number(&format!("zones.{name}.infiltration.constant"), air_changes),
                temperature: self.number(&format!("zones.{name}.infiltration.temperature"), 0.0),
                wind: self.number(&format!("zones.{name}.infiltration.wind"), 0.0),
                leakage: None,
                schedule: None,
                control: None,
                density: None,
            },
            longwave,
            view_weights: Vec::new(),
            sun: ZoneSun::Area,
            solar_to_air: None,
            stratification: None,
            setpoint_radiant_share: None,
            makeup_by_vents: false,
            gains: Vec::new(),
            ventilation: Vec::new(),
            mixing: None,
            heating: None,
            cooling: None,
        };
        self.description.zones.push(zone);
        self.description.zones.len() - 1
    }

    /// `place`: area [m2], tilt, azimuth [deg].
    pub fn surface(
        &mut self,
        name: &str,
        construction: usize,
        place: [f64; 3],
        outside: Side,
        inside: Side,
    ) -> usize {
        let surface = Surface {
            name: name.to_owned(),
            construction,
            area: self.number(&format!("surfaces.{name}.area"), place[0]),
            openings: Vec::new(),
            frame: None,
            cavity_height: None,
            soil: None,
            vertices: Vec::new(),
            tilt: self.number(&format!("surfaces.{name}.tilt"), place[1]),
            azimuth: self.number(&format!("surfaces.{name}.azimuth"), place[2]),
            outside,
            inside,
        };
        self.description.surfaces.push(surface);
        self.description.surfaces.len() - 1
    }

    pub fn sensor(&mut self, surface: usize, depth: f64) -> usize {
        let depth = self.number("sensors.depth", depth);
        self.description.sensors.push(Sensor { name: "sensor".to_owned(), surface, depth });
        self.description.sensors.len() - 1
    }

    pub fn convection(&mut self, coefficient: f64) -> Convection {
        Convection::law("constant", &[("coefficient", self.number("convection.coefficient", coefficient))])
    }

    pub fn power(&mut self, upward: [f64; 5], downward: [f64; 5]) -> Convection {
        let mut numbers = Vec::new();
        for (direction, values) in [("upward", upward), ("downward", downward)] {
            for (name, value) in ["a", "b", "n", "c", "m"].into_iter().zip(values) {
                numbers.push((format!("{direction}.{name}"), self.number("convection.power", value)));
            }
        }
        law("power", &numbers)
    }

    pub fn outdoors(&mut self, convection: Convection, emissivity: f64, absorptance: f64) -> Side {
        let emissivity = Some(self.number("outside.emissivity", emissivity));
        let absorptance = Some(self.number("outside.absorptance", absorptance));
        Side { emissivity, absorptance, ..facing(Facing::Outdoors, Some(convection)) }
    }

    pub fn inside(&mut self, zone: usize, convection: Convection, emissivity: f64) -> Side {
        let emissivity = Some(self.number("inside.emissivity", emissivity));
        Side { emissivity, ..facing(Facing::Zone { zone }, Some(convection)) }
    }

    pub fn describe(self) -> Description {
        self.description
    }

    pub fn plan(self) -> Plan {
        Plan::new(self.description).unwrap()
    }
}

/// A side without radiation.
pub fn facing(facing: Facing, convection: Option<Convection>) -> Side {
    Side {
        facing,
        convection,
        emissivity: None,
        absorptance: None,
        area_factor: None,
        sky_view: None,
        ground_view: None,
        height: None,
        longwave: OutdoorLongwave::Exact,
        irradiance: None,
        behind_obstacles: false,
        heat_flux: None,
        own_shades: Vec::new(),
        outline: Vec::new(),
        exposure: Exposure::default(),
        shaded_by: Vec::new(),
        level: 0.0,
    }
}

/// Nominal values of a plan.
pub fn values(plan: &Plan) -> Vec<f64> {
    plan.description.parameters.iter().map(|parameter| parameter.value).collect()
}

/// Position of a parameter.
pub fn position(plan: &Plan, path: &str) -> usize {
    plan.description.parameters.iter().position(|parameter| parameter.path == path).unwrap()
}

/// Stage times of a scheme over the step.
fn nodes(scheme: Scheme) -> Vec<f64> {
    match scheme {
        Scheme::Sdirk2 | Scheme::LinearlyImplicit => vec![1.0 - core::f64::consts::FRAC_1_SQRT_2, 1.0],
        Scheme::BackwardEuler | Scheme::ApparentCapacity => vec![1.0],
    }
}

/// A forcing array: `fill` gets the time [s] and a row at rest (20 degC, calm, dark).
pub fn forcing(
    plan: &Plan,
    scheme: Scheme,
    steps: usize,
    dt: f64,
    fill: impl Fn(f64, &mut [f64]),
) -> Vec<f64> {
    forcing_over(plan, scheme, (0..steps).map(|step| (step as f64, dt)), fill)
}

/// The same over steps of different lengths: the start of each, in its own length [s].
pub fn forcing_over(
    plan: &Plan,
    scheme: Scheme,
    steps: impl Iterator<Item = (f64, f64)>,
    fill: impl Fn(f64, &mut [f64]),
) -> Vec<f64> {
    let mut all = Vec::new();
    for (start, dt) in steps {
        for node in nodes(scheme) {
            let mut row = vec![0.0; plan.n_channels()];
            row[channel::AIR_TEMPERATURE] = 20.0;
            row[channel::DEW_POINT] = 12.0;
            row[channel::INFRARED] = f64::NAN;
            row[channel::PRESSURE] = f64::NAN;
            row[channel::DIRECT_NORMAL_EXTRA] = 1361.0;
            row[channel::SUN_UP] = -1.0;
            fill((start + node) * dt, &mut row);
            all.extend(row);
        }
    }
    all
}

/// Fills the building's own channel.
pub fn set(row: &mut [f64], channel: usize, value: f64) {
    row[CLIMATE_CHANNELS + channel] = value;
}

/// A made-up subtropical weather with sun, clouds, and a wind that turns.
pub fn weather(time: f64, row: &mut [f64]) {
    let hour = time / 3600.0;
    let day = hour / 24.0;
    // Solar noon falls on no stage, so that no surface has the sun exactly in its plane.
    let angle = core::f64::consts::TAU * (day - 0.513);
    row[channel::AIR_TEMPERATURE] = 22.5 + 5.0 * Real::cos(angle - 0.6) + Real::sin(0.9 * day);
    row[channel::DEW_POINT] = 14.0 + Real::cos(2.1 * day);
    row[channel::CLOUD_COVER] = 4.0 + 3.0 * Real::sin(3.3 * day);
    row[channel::WIND_SPEED] = (3.0 + 2.5 * Real::sin(angle + 0.3) + Real::cos(17.0 * day)).max(0.0);
    row[channel::WIND_DIRECTION] = (140.0 * day) % 360.0;
    let elevation = 1.1 * Real::cos(angle);
    let sun = [-Real::sin(angle) * Real::cos(elevation), 0.4, Real::sin(elevation)];
    let length = sun.iter().map(|x| x * x).sum::<f64>().sqrt();
    row[channel::SUN_EAST] = sun[0] / length;
    row[channel::SUN_NORTH] = sun[1] / length;
    let up = sun[2] / length;
    row[channel::SUN_UP] = up;
    if up > 0.0 {
        row[channel::DIRECT_NORMAL] = 800.0 * up.sqrt();
        row[channel::DIFFUSE_HORIZONTAL] = 120.0 * up;
        row[channel::GLOBAL_HORIZONTAL] = 800.0 * up.sqrt() * up + 120.0 * up;
    }
    row[channel::DAY_OF_YEAR] = 200.0 + day;
}

/// A run of given steps from 20 degC, recording everything asked for.
pub fn options(scheme: Scheme, dt: f64, outputs: Vec<Output>) -> Options {
    Options {
        dt,
        scheme,
        initial: Initial::Everywhere(20.0),
        warmup: None,
        outputs,
        record_from: 0,
        record_every: 1,
        residuals: false,
        lengths: None,
    }
}

/// A repeated first day.
pub fn warmup(dt: f64) -> Warmup {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few hundred steps")]
    let steps = (86400.0 / dt).round() as usize;
    Warmup { steps, tolerance: 0.01, max_cycles: 200 }
}

/// Runs a plan at its nominal values.
pub fn run(plan: &Plan, rows: &[f64], options: &Options) -> Run<f64> {
    try_run(plan, &values(plan), rows, options).unwrap()
}

/// Runs a plan at given values.
pub fn try_run(
    plan: &Plan,
    values: &[f64],
    rows: &[f64],
    options: &Options,
) -> Result<Run<f64>, EngineError> {
    let forcing = Forcing::new(rows, nodes(options.scheme).len(), plan.n_channels()).unwrap();
    simulate(plan, values, &forcing, options, &RunControl::default())
}

/// A number in units of another.
pub fn relative(value: f64, expected: f64) -> f64 {
    (value / expected - 1.0).abs()
}

/// A two-zone cell with a phase-change ceiling under a metal roof, with every law of convection and every kind of boundary.
pub fn cell(gamma: f64) -> Description {
    let mut b = Builder::new();
    let concrete = b.solid("concrete", 1.75, 2240.0, 900.0);
    let foam = b.solid("foam", 0.028, 30.0, 1470.0);
    let board = b.solid("board", 0.16, 800.0, 1090.0);
    let steel = b.solid("steel", 45.0, 7800.0, 480.0);
    let mask = b.resistance("mask", 0.15);
    let energain = b.energain(gamma);
    let wall = b.construction("wall", &[(board, 0.005, 1), (foam, 0.07, 4), (board, 0.005, 1)]);
    let concrete_floor = b.construction("concrete floor", &[(concrete, 0.08, 4), (foam, 0.06, 3)]);
    let ceiling = b.construction("ceiling", &[(energain, 0.00526, 4), (board, 0.0125, 2)]);
    let roof = b.construction("roof", &[(steel, 0.001, 1)]);
    let door = b.construction("door", &[(mask, 0.0, 0)]);
    let room = b.zone("room", 27.0, 0.2, ZoneLongwave::Radiosity);
    let gap = b.zone("gap", 2.68, 0.1, ZoneLongwave::Radiosity);
    let soil = b.channel("soil");

    let tarp = |b: &mut Builder, outdoors: bool| {
        let mut numbers = vec![("factor", b.number("tarp.factor", 1.0))];
        if outdoors {
            numbers.push(("roughness", b.number("tarp.roughness", 1.5)));
            numbers.push(("perimeter", b.number("tarp.perimeter", 12.0)));
        }
        Convection::law("tarp", &numbers)
    };
    let mowitt = |b: &mut Builder| Convection::law("mowitt", &[("factor", b.number("mowitt.factor", 1.0))]);
    let alamdari = |b: &mut Builder, length: f64| {
        Convection::law(
            "alamdari_hammond",
            &[("length", b.number("alamdari.length", length)), ("factor", b.number("alamdari.factor", 1.0))],
        )
    };

    let outer = tarp(&mut b, true);
    let inner = alamdari(&mut b, 3.0);
    let (outside, inside) = (b.outdoors(outer, 0.9, 0.4), b.inside(room, inner, 0.9));
    b.surface("north", wall, [9.0, 90.0, 0.0], outside, inside);

    let (outer, inner) = (mowitt(&mut b), tarp(&mut b, false));
    let mut outside = b.outdoors(outer, 0.9, 0.4);
    outside.height = Some(b.number("surfaces.east.outside.height", 1.5));
    let inside = b.inside(room, inner, 0.9);
    b.surface("east", wall, [9.0, 90.0, 90.0], outside, inside);

    let outer = Convection::law(
        "linear_wind",
        &[("constant", b.number("linear.constant", 5.7)), ("wind", b.number("linear.wind", 3.8))],
    );
    let inner = b.power([0.3, 1.4, 0.3, 0.0, 1.0], [0.2, 0.6, 0.25, 0.0, 1.0]);
    let (outside, inside) = (b.outdoors(outer, 0.9, 0.4), b.inside(room, inner, 0.9));
    b.surface("south", wall, [7.0, 90.0, 180.0], outside, inside);

    let outer = b.power([2.0, 1.2, 0.33, 3.1, 0.8], [2.0, 0.7, 0.25, 3.1, 0.8]);
    let inner = Convection::law(
        "guichard2016_eq5",
        &[("length", b.number("eq5.length", 2.0)), ("factor", b.number("eq5.factor", 1.0))],
    );
    let (outside, inside) = (b.outdoors(outer, 0.9, 0.5), b.inside(room, inner, 0.9));
    b.surface("door", door, [2.0, 90.0, 180.0], outside, inside);

    let inner = tarp(&mut b, false);
    let inside = b.inside(room, inner, 0.9);
    let outside = facing(Facing::Measured { channel: soil }, None);
    b.surface("floor", concrete_floor, [9.0, 180.0, 0.0], outside, inside);

    let (outer, inner) = (alamdari(&mut b, 3.0), tarp(&mut b, false));
    let (outside, inside) = (b.inside(gap, outer, 0.05), b.inside(room, inner, 0.9));
    b.surface("ceiling", ceiling, [9.58, 20.0, 0.0], outside, inside);

    let (outer, inner) = (mowitt(&mut b), alamdari(&mut b, 3.0));
    let mut outside = b.outdoors(outer, 0.9, 0.8);
    outside.area_factor = Some(b.number("surfaces.roof.outside.area_factor", 1.1));
    let inside = b.inside(gap, inner, 0.25);
    b.surface("roof", roof, [9.58, 20.0, 0.0], outside, inside);

    let inner = b.convection(1.5);
    let inside = b.inside(gap, inner, 0.9);
    b.surface("gable", wall, [1.5, 90.0, 270.0], facing(Facing::Adiabatic, None), inside);
    b.sensor(5, 0.006);
    b.describe()
}

/// Soil under the cell.
pub fn cell_weather(time: f64, row: &mut [f64]) {
    weather(time, row);
    set(row, 0, 22.0 + 0.5 * Real::sin(time / 86400.0));
}

/// Readings that see every part of the cell.
pub fn cell_outputs() -> Vec<Output> {
    vec![
        Output::AirTemperature { zone: 0 },
        Output::AirTemperature { zone: 1 },
        Output::MeanRadiantTemperature { zone: 0 },
        Output::FaceTemperature { surface: 6, side: 0 },
        Output::FaceFlux { surface: 5, side: 1 },
        Output::InterfaceTemperature { surface: 5, interface: 1 },
        Output::LayerFlux { surface: 0, layer: 1 },
        Output::LiquidFraction { surface: 5, layer: 0 },
        Output::LayerEnthalpy { surface: 5, layer: 0 },
        Output::Sensor { sensor: 0 },
    ]
}

/// Members with other numbers (sharp and blunt melting, other heat transfer coefficients, other warm-ups), to be run together.
pub fn cell_members(plan: &Plan, count: usize) -> Vec<f64> {
    let nominal = values(plan);
    let gamma = position(plan, "materials.energain.law.gamma");
    let melting = position(plan, "materials.energain.melting_temperature");
    let foam = position(plan, "materials.foam.conductivity");
    let concrete = position(plan, "materials.concrete.density");
    let tilt = position(plan, "surfaces.roof.tilt");
    let mut all = Vec::new();
    for member in 0..count {
        let x = member as f64;
        let mut numbers = nominal.clone();
        numbers[gamma] = [0.01, 0.04, 0.5, 20.0][member % 4];
        numbers[melting] += 0.7 * Real::sin(1.3 * x);
        numbers[foam] *= 1.0 + 0.4 * Real::cos(0.7 * x);
        numbers[concrete] *= 1.0 + 0.5 * Real::sin(2.1 * x);
        numbers[tilt] += 3.0 * x;
        all.extend(numbers);
    }
    all
}
