//! Steps that are made in parts.

use crate::common::conditioned::ideal_load;
use crate::common::melting::{ceiling_weather, fine_ceiling};
use crate::common::{forcing, options, run};
use mascarin_engine::Scheme;
use mascarin_engine::energy_balance::Flow;
use mascarin_engine::plan::Plan;
use mascarin_engine::run::outputs::Output;

const STEP: f64 = 900.0;

/// The load reported of a step is its mean, however many parts the step was made in: loads times the step are the heat in
/// the ledger. Newton's iteration fails where a steep law melts in thin cells under a strong surface heat transfer
/// coefficient; narrow set points keep the loads changing there.
#[test]
fn loads_are_means_over_halved_steps() {
    let mut description = fine_ceiling(1000.0, 80, 25.0);
    description.zones[0].heating = Some(ideal_load(&mut description, "room.heating", 21.0, 5000.0));
    description.zones[0].cooling = Some(ideal_load(&mut description, "room.cooling", 21.5, 5000.0));
    let plan = Plan::new(description).unwrap();
    let weather = |time, row: &mut [f64]| ceiling_weather(20.0 * 3600.0 + time, row);
    for scheme in [Scheme::Sdirk2, Scheme::BackwardEuler] {
        let rows = forcing(&plan, scheme, 60, STEP, weather);
        let outputs = vec![Output::HeatingLoad { zone: 0 }, Output::CoolingLoad { zone: 0 }];
        let run = run(&plan, &rows, &options(scheme, STEP, outputs));
        assert!(run.counters.halvings > 0, "{:?}", run.counters);
        let loads = run.records.chunks(2).skip(1);
        let (reported, all) = loads.fold((0.0, 0.0), |(net, all), load| {
            (net + (load[0] - load[1]) * STEP, all + (load[0] + load[1]) * STEP)
        });
        let in_ledger =
            run.energy_balance.into[Flow::Heating as usize] + run.energy_balance.into[Flow::Cooling as usize];
        assert!(all > 1e7, "{all} J");
        assert!(
            (reported - in_ledger).abs() < 1e-12 * all,
            "{reported} J, in the ledger {in_ledger} J, {scheme:?}"
        );
    }
}
