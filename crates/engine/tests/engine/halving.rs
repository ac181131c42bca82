//! Readings over halved steps.

use crate::common::difficult::steps;
use crate::common::relative;
use mascarin_engine::Scheme;
use mascarin_engine::energy_balance::Flow;

/// The heating load over a step is the mean over the whole step, however often it was halved.
#[test]
fn the_load_over_a_halved_step_is_its_mean() {
    let mut wrong = Vec::new();
    let mut compared = 0;
    for scheme in [Scheme::Sdirk2, Scheme::BackwardEuler] {
        for step in steps(scheme, true) {
            let mean = step.run.energy_balance.into[Flow::Heating as usize] / step.dt;
            let load = step.run.state.load[0];
            if step.run.counters.halvings > 0 && mean > 0.0 {
                compared += 1;
                if relative(load, mean) > 1e-9 {
                    wrong.push(format!("{}: load {load} W, mean {mean} W", step.name));
                }
            }
        }
    }
    assert!(compared > 1, "{compared} heated steps are halved");
    assert!(wrong.is_empty(), "{} of {compared}:\n{}", wrong.len(), wrong.join("\n"));
}
