use super::*;
use crate::balance::energy_balance::Flow;
use crate::building::coefficients::Coefficients;
use crate::building::ids::BySide;
use crate::building::plan::Plan;
use crate::common::{Builder, facing, values};
use crate::input::description::{Facing, OutdoorLongwave};
use crate::weather::index::WeatherIndex;

const AREA: f64 = 7.0;
const OUTDOOR: f64 = -4.0;
const IMPOSED: f64 = 21.0;

/// A wall of a resistance between outdoor air and an imposed temperature, with convection to it or held at it.
fn wall(resistance: f64, coefficients: [Option<f64>; 2]) -> Plan {
    let mut b = Builder::new();
    let material = b.resistance("insulation", resistance);
    let construction = b.construction("wall", &[(material, 0.0, 0)]);
    let channel = b.channel("imposed");
    let [outer, inner] =
        coefficients.map(|coefficient| coefficient.map(|coefficient| b.convection(coefficient)));
    let mut outside = b.outdoors(outer.unwrap(), 0.9, 0.0);
    outside.longwave = OutdoorLongwave::None;
    b.surface("wall", construction, [AREA, 90.0, 0.0], outside, facing(Facing::Measured { channel }, inner));
    b.plan()
}

/// Balances of that wall at temperatures of its surfaces: residuals [W/m2], heat by convection and from the imposed
/// temperature [W].
fn at(plan: &Plan, surfaces: [f64; 2]) -> ([f64; 2], [f64; 2]) {
    let model = Model::new(plan, Coefficients::new(plan, &values(plan)));
    let coefficients = &model.coefficients;
    let weather = WeatherIndex::new(plan, coefficients);
    let index = FlowIndex::new(plan, coefficients, &weather);
    let mut conditions = Conditions::new(plan, coefficients, &weather);
    conditions.surfaces[SideId::outside(0)].temperature = OUTDOOR;
    conditions.surfaces[SideId::inside(0)].temperature = IMPOSED;
    let walls: Vec<_> = coefficients.walls.iter().map(WallSystem::new).collect();
    let balances = Balances {
        model: &model,
        index: &index,
        conditions: &conditions,
        walls: &walls,
        laws: &LinearisedLaws::new(&model),
        load: &[],
    };
    let none = Contents { cells: &[], enthalpy: &[], air: &[] };
    let stage = Stage { length: 300.0, ratio: 0.0, start: none, first: none };
    let temperatures = BySide::from(surfaces.to_vec());
    let residual = balances.residual(&stage, &[], &temperatures, &[]);
    let into_wall =
        |surface: SideId| walls[0].links[0].left * (temperatures[surface] - temperatures[surface.opposite()]);
    let power = balances.power((&[], &temperatures, &[]), into_wall);
    (residual.surfaces.pair(0), [power.into[Flow::Convection as usize], power.into[Flow::Boundary as usize]])
}

/// `q = (T_imposed - T_outdoor) / (1/h_outside + R + 1/h_inside)`: no residual there, and `A q` in the ledger.
#[test]
fn a_wall_between_two_temperatures_conducts_its_u_value() {
    const RESISTANCE: f64 = 0.8;
    for coefficients in [[Some(20.0), Some(7.0)], [Some(20.0), None]] {
        let plan = wall(RESISTANCE, coefficients);
        let [outer, inner] = coefficients.map(|coefficient| coefficient.unwrap_or(f64::INFINITY));
        let density = (IMPOSED - OUTDOOR) / (1.0 / outer + RESISTANCE + 1.0 / inner);
        let surfaces = [OUTDOOR + density / outer, IMPOSED - density / inner];
        let (residual, [convection, imposed]) = at(&plan, surfaces);
        assert!(residual.iter().all(|residual| residual.abs() < 1e-12), "{residual:?}");
        assert!((imposed - AREA * density).abs() < 1e-11, "{imposed} is not {}", AREA * density);
        assert!((convection + AREA * density).abs() < 1e-11, "{convection} is not {}", -AREA * density);
    }
}

/// One kelvin too warm, a surface loses `h + 1/R` more than it gets [W/m2].
#[test]
fn the_residual_is_the_missing_heat() {
    let (resistance, coefficients) = (0.5, [20.0, 7.0]);
    let plan = wall(resistance, coefficients.map(Some));
    let density = (IMPOSED - OUTDOOR) / (1.0 / coefficients[0] + resistance + 1.0 / coefficients[1]);
    let surfaces = [OUTDOOR + density / coefficients[0] + 1.0, IMPOSED - density / coefficients[1]];
    let ([outside, inside], _) = at(&plan, surfaces);
    assert!((outside + coefficients[0] + 1.0 / resistance).abs() < 1e-11, "{outside}");
    assert!((inside - 1.0 / resistance).abs() < 1e-11, "{inside}");
}
