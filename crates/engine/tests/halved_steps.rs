//! Steps that are made in parts.

mod common;

use common::conditioned::plant;
use common::melting::{ceiling_weather, fine_ceiling};
use common::{forcing, options, run};
use mascarin_engine::ledger::Flow;
use mascarin_engine::plan::Plan;
use mascarin_engine::probe::Probe;
use mascarin_engine::step::Scheme;

const STEP: f64 = 900.0;

/// The load reported of a step is its mean, however many parts the step was made in: loads times the step are the heat in
/// the ledger. Newton's iteration fails where a steep law melts in thin cells under a strong surface heat transfer
/// coefficient.
#[test]
fn loads_are_means_over_halved_steps() {
    let mut description = fine_ceiling(1000.0, 80, 25.0);
    description.zones[0].heating = Some(plant(&mut description, "room.heating", 22.0, 5000.0));
    description.zones[0].cooling = Some(plant(&mut description, "room.cooling", 24.0, 5000.0));
    let plan = Plan::new(description).unwrap();
    let weather = |time, row: &mut [f64]| ceiling_weather(20.0 * 3600.0 + time, row);
    let scheme = Scheme::BackwardEuler;
    let rows = forcing(&plan, scheme, 21, STEP, weather);
    let outputs = vec![Probe::HeatingLoad { zone: 0 }, Probe::CoolingLoad { zone: 0 }];
    let run = run(&plan, &rows, &options(scheme, STEP, outputs));
    assert!(run.counters.halvings > 0, "{:?}", run.counters);
    let mut heat = [0.0; 2];
    for record in run.records.chunks(2).skip(1) {
        heat[0] += record[0] * STEP;
        heat[1] += record[1] * STEP;
    }
    let booked = [run.ledger.into[Flow::Heating as usize], -run.ledger.into[Flow::Cooling as usize]];
    assert!(heat[0] + heat[1] > 1e5, "{heat:?}");
    assert!(
        (heat[0] - heat[1] - booked[0] + booked[1]).abs() < 1e-9 * (heat[0] + heat[1]),
        "{heat:?}, {booked:?}"
    );
}
