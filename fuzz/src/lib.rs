//! The functions that Python calls, each with a call read from bytes. What they refuse is fine; a panic is a defect.
//!
//! Each returns whether the engine took the call.

use mascarin_engine::derivatives::{self, Trajectory};
use mascarin_engine::description::Description;
use mascarin_engine::forcing::Forcing;
use mascarin_engine::plan::Plan;
use mascarin_engine::run::outputs::Output;
use mascarin_engine::run::ratings::window_ratings;
use mascarin_engine::run::{self, Options, Warmup};
use mascarin_engine::state::Initial;
use mascarin_engine::{RunControl, Scheme, linear_model};
use serde::Deserialize;

/// Longest forcing: longer runs only take longer.
const MOST_VALUES: usize = 4096;
/// Most cells of a plan; the time of a run grows with them.
const MOST_CELLS: usize = 2000;

/// A call as Python makes it, as JSON.
#[derive(Deserialize)]
struct Call {
    description: Description,
    values: Vec<f64>,
    forcing: Vec<f64>,
    stages: usize,
    channels: usize,
    dt: f64,
    scheme: u8,
    initial: f64,
    warmup_steps: usize,
    outputs: Vec<Output>,
    record_from: usize,
    record_every: usize,
}

/// A call that is read, with its plan.
struct Ready {
    plan: Plan,
    values: Vec<f64>,
    forcing: Vec<f64>,
    shape: [usize; 2],
    options: Options,
}

impl Ready {
    fn read(data: &[u8]) -> Option<Self> {
        let call: Call = serde_json::from_slice(data).ok()?;
        if call.forcing.len() > MOST_VALUES || call.values.len() > MOST_VALUES || call.outputs.len() > 100 {
            return None;
        }
        let plan = Plan::new(call.description).ok()?;
        if plan.n_cells > MOST_CELLS {
            return None;
        }
        let warmup = (call.warmup_steps > 0).then_some(Warmup {
            steps: call.warmup_steps,
            tolerance: 0.01,
            max_cycles: 3,
        });
        let options = Options {
            dt: call.dt,
            scheme: [
                Scheme::Sdirk2,
                Scheme::LinearlyImplicit,
                Scheme::BackwardEuler,
                Scheme::ApparentCapacity,
            ][usize::from(call.scheme % 4)],
            initial: Initial::Everywhere(call.initial),
            warmup,
            outputs: call.outputs,
            record_from: call.record_from,
            record_every: call.record_every,
            residuals: false,
            lengths: None,
        };
        Some(Self {
            plan,
            values: call.values,
            forcing: call.forcing,
            shape: [call.stages, call.channels],
            options,
        })
    }

    fn forcing(&self) -> Option<Forcing<'_>> {
        self.shape[0].checked_mul(self.shape[1])?;
        Forcing::new(&self.forcing, self.shape[0], self.shape[1]).ok()
    }
}

/// `Plan(description)`: the description alone.
pub fn plan(data: &[u8]) -> bool {
    if let Ok(description) = serde_json::from_slice::<Description>(data) {
        return Plan::new(description).is_ok();
    }
    Ready::read(data).is_some()
}

/// `Plan.simulate_into`.
pub fn simulate(data: &[u8]) -> bool {
    let Some(ready) = Ready::read(data) else { return false };
    let Some(forcing) = ready.forcing() else { return false };
    let found = run::simulate(&ready.plan, &ready.values, &forcing, &ready.options, &RunControl::default());
    let taken = found.is_ok();
    if let Ok(run) = found {
        assert!(
            run.records.iter().all(|value| value.is_finite()),
            "a run without an error has records that are not finite"
        );
    }
    taken
}

/// `Plan.ensemble`, with two members.
pub fn ensemble(data: &[u8]) -> bool {
    let Some(ready) = Ready::read(data) else { return false };
    let Some(forcing) = ready.forcing() else { return false };
    let members = [ready.values.clone(), ready.values.clone()].concat();
    run::ensemble::ensemble(&ready.plan, &members, &forcing, &ready.options, &RunControl::default()).is_ok()
}

/// `Plan.jacobian`, by the first and the last parameter.
pub fn jacobian(data: &[u8]) -> bool {
    let Some(ready) = Ready::read(data) else { return false };
    let Some(forcing) = ready.forcing() else { return false };
    let which = [0, ready.values.len().saturating_sub(1)];
    derivatives::jacobian(
        &ready.plan,
        &ready.values,
        &which,
        &forcing,
        &ready.options,
        &RunControl::default(),
    )
    .is_ok()
}

/// `Trajectory` and `Trajectory.pull`.
pub fn reverse(data: &[u8]) -> bool {
    let Some(ready) = Ready::read(data) else { return false };
    let Some(forcing) = ready.forcing() else { return false };
    let watch = RunControl::default();
    let kept = Trajectory::new(&ready.plan, &ready.values, &forcing, &ready.options, &watch, 1 << 20);
    if let Ok(kept) = kept {
        let weights = vec![1.0; kept.run.records.len()];
        return kept.pull(&ready.plan, &ready.values, &forcing, &ready.options, &watch, &weights).is_ok();
    }
    false
}

/// `Plan.state_space`.
pub fn state_space(data: &[u8]) -> bool {
    let Some(ready) = Ready::read(data) else { return false };
    if ready.values.len() == ready.plan.description.parameters.len() {
        return linear_model::state_space(&ready.plan, &ready.values, &RunControl::default()).is_ok();
    }
    false
}

/// `Plan.window_ratings` and `Plan.stage_bytes`.
pub fn ratings(data: &[u8]) -> bool {
    let Some(ready) = Ready::read(data) else { return false };
    if ready.values.len() != ready.plan.description.parameters.len() {
        return false;
    }
    window_ratings(&ready.plan, &ready.values);
    run::ensemble::stage_bytes(&ready.plan) > 0
}

/// Every function by its name.
pub const TARGETS: [(&str, fn(&[u8]) -> bool); 7] = [
    ("plan", plan),
    ("simulate", simulate),
    ("ensemble", ensemble),
    ("jacobian", jacobian),
    ("reverse", reverse),
    ("state_space", state_space),
    ("ratings", ratings),
];
