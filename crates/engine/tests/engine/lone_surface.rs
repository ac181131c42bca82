//! Surfaces that see no other surface of their zone.

use crate::common::{Builder, forcing, options, run};
use mascarin_engine::Scheme;
use mascarin_engine::description::ZoneLongwave;
use mascarin_engine::plan::Plan;
use mascarin_engine::run::outputs::Output;

/// Two walls that look the same way do not see each other: they exchange no long-wave radiation, as without any.
#[test]
fn walls_that_look_the_same_way_exchange_nothing() {
    let solve = |longwave: ZoneLongwave| {
        let mut b = Builder::new();
        let board = b.solid("board", 0.16, 800.0, 1090.0);
        let wall = b.construction("wall", &[(board, 0.05, 3)]);
        let zone = b.zone("zone", 50.0, 0.5, longwave);
        for (name, area) in [("large", 12.0), ("small", 7.0)] {
            let (outer, inner) = (b.convection(15.0), b.convection(3.0));
            let (outside, inside) = (b.outdoors(outer, 0.9, 0.6), b.inside(zone, inner, 0.9));
            b.surface(name, wall, [area, 90.0, 0.0], outside, inside);
        }
        let plan = Plan::new(b.describe()).unwrap();
        let rows = forcing(&plan, Scheme::Sdirk2, 48, 900.0, crate::common::weather);
        let readings = |side| Output::FaceTemperature { surface: 1, side };
        let outputs = vec![Output::AirTemperature { zone: 0 }, readings(0), readings(1)];
        run(&plan, &rows, &options(Scheme::Sdirk2, 900.0, outputs)).records
    };
    let (with, without) = (solve(ZoneLongwave::Radiosity), solve(ZoneLongwave::None));
    for (with, without) in with.iter().zip(&without) {
        assert!((with - without).abs() < 1e-8, "{with} and {without} degC");
    }
}
