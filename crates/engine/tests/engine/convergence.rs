//! When Newton's iteration stops.

use crate::common::melting::ceiling_weather;
use crate::common::{ALL_SCHEMES, Builder, SCHEMES, facing, forcing, options, run};
use mascarin_engine::Scheme;
use mascarin_engine::description::{Description, Facing, ZoneLongwave};
use mascarin_engine::plan::Plan;
use mascarin_engine::run::outputs::Output;
use mascarin_engine::run::{Options, Run};

const STEP: f64 = 900.0;

/// The same zone under the same phase-change ceiling, so many times side by side.
fn copies(count: usize) -> Description {
    let mut b = Builder::new();
    let board = b.solid("board", 0.16, 800.0, 1090.0);
    let energain = b.energain(1.0);
    let construction = b.construction("ceiling", &[(energain, 0.00526, 4), (board, 0.0125, 2)]);
    let above = b.channel("above");
    for copy in 0..count {
        let room = b.zone(&format!("room_{copy}"), 27.0, 0.5, ZoneLongwave::None);
        let out = b.convection(4.0);
        let inner = b.power([0.3, 1.4, 0.3, 0.0, 1.0], [0.2, 0.6, 0.25, 0.0, 1.0]);
        let inside = b.inside(room, inner, 0.9);
        let outside = facing(Facing::Measured { channel: above }, Some(out));
        b.surface(&format!("ceiling_{copy}"), construction, [9.0, 0.0, 0.0], outside, inside);
    }
    b.describe()
}

fn simulate(count: usize, scheme: Scheme) -> Run<f64> {
    let plan = Plan::new(copies(count)).unwrap();
    let rows = forcing(&plan, scheme, 192, STEP, ceiling_weather);
    run(&plan, &rows, &options(scheme, STEP, vec![Output::AirTemperature { zone: 0 }]))
}

/// The criterion of convergence does not depend on the size of the building: many copies of a zone take the iterations of
/// one, and end with its bits.
#[test]
fn copies_converge_as_one() {
    for scheme in ALL_SCHEMES {
        let (one, many) = (simulate(1, scheme), simulate(49, scheme));
        assert_eq!(one.counters.iterations, many.counters.iterations, "{scheme:?}");
        assert_eq!(one.counters.largest_change.to_bits(), many.counters.largest_change.to_bits());
        for (a, b) in one.records.iter().zip(&many.records) {
            assert_eq!(a.to_bits(), b.to_bits(), "{a} is not {b}, {scheme:?}");
        }
    }
}

/// The last change of every stage is reported: so small that its square over the melting range counts no more.
#[test]
fn the_largest_last_change_is_small() {
    for scheme in SCHEMES {
        let change = simulate(1, scheme).counters.largest_change;
        assert!(change > 1e-9 && change < 0.05, "{change} K with {scheme:?}");
    }
}

/// The residual of accepted stages is reported where it is asked for: heat that is missing in a balance, less than a
/// thousandth of the flow of some hundred watts. Asking for it changes no bit of the run.
#[test]
fn residuals_are_reported_on_demand() {
    let plan = Plan::new(copies(1)).unwrap();
    for scheme in SCHEMES {
        let rows = forcing(&plan, scheme, 192, STEP, ceiling_weather);
        let without = options(scheme, STEP, vec![Output::AirTemperature { zone: 0 }]);
        let with = Options { residuals: true, ..without.clone() };
        let (without, with) = (run(&plan, &rows, &without), run(&plan, &rows, &with));
        assert!(without.counters.largest_residual.is_none());
        let residual = with.counters.largest_residual.unwrap();
        assert!(residual > 0.0 && residual < 0.2, "{residual} W with {scheme:?}");
        assert!(without.records.iter().zip(&with.records).all(|(a, b)| a.to_bits() == b.to_bits()));
    }
}
