//! The warm-up: the first period repeated until the state at its end is that at its start.
//!
//! A lane that has converged keeps what it passes on: its state, and what its guesses are made from. Other lanes repeat the period, and
//! it with them, to no effect.

use crate::balance::energy_balance::EnergyBalance;
use crate::building::plan::Plan;
use crate::error::EngineError;
use crate::number::real::{ByPrecision, Mask, Real};
use crate::run::action::Action;
use crate::run::options::Options;
use crate::run::periodic_start::PeriodicStart;
use crate::step::control::RunControl;
use crate::step::history::History;
use crate::step::state::State;
use crate::step::stepper::Stepper;
use crate::weather::conditions::Weather;

/// Least change of a temperature between two repetitions that is asked for [K]: in single precision, smaller ones are rounding.
const LEAST: ByPrecision = ByPrecision { double: 0.0, single: 2e-3 };

/// Repetitions by which a change of soil is multiplied at most: more would ask for what short periods never show.
const SLOWEST: f64 = 200.0;

/// Repeats the first period until every lane has converged. Gives the number of repetitions
/// and the largest change in the last one [K].
pub(super) fn warm_up<'a, S: Real>(
    stepper: &mut Stepper<'a, S>,
    state: &mut State<S>,
    weather: &Weather<'_>,
    options: &Options,
    control: &RunControl,
    observe: &mut impl FnMut(&Stepper<'a, S>, &State<S>, Action) -> Result<(), EngineError>,
) -> Result<(usize, S), EngineError> {
    let Some(warmup) = options.warmup else { return Ok((0, S::zero())) };
    let tolerance = warmup.tolerance.max(LEAST.of::<S>());
    let soil = slow_soil(stepper.model.plan, warmup.steps as f64 * options.dt);
    let mut active = S::Mask::splat(true);
    let mut change_left = S::zero();
    let mut known: Option<PeriodicStart<S>> = None;
    // What the guesses of the lanes that have converged are made from, as their last repetition left it.
    let mut history: Option<History<S>> = None;
    for cycle in 1..=warmup.max_cycles {
        let mut next = state.clone();
        let mut unused = EnergyBalance::new();
        observe(stepper, state, Action::BeginPeriod)?;
        for action in (0..warmup.steps).map(Action::WarmUp) {
            control.check()?;
            action.take(stepper, &mut next, weather, options.dt, &mut unused)?;
            observe(stepper, &next, action)?;
        }
        let change = largest_change(state, &next, &soil);
        let reached = active;
        change_left = S::select(active, change, change_left);
        active = active & !stepper.failed() & S::constant(tolerance).lt(change);
        if S::LANES > 1 {
            let now = stepper.history();
            match &mut history {
                Some(history) => history.take(reached, &now),
                None => history = Some(now),
            }
        }
        if !active.any() {
            state.take(reached, &next);
            restore(stepper, history.as_ref());
            return Ok((cycle, change_left));
        }
        let start = if let Some(known) = &mut known {
            known.next(&stepper.model, state, &next, change, tolerance)
        } else {
            known = Some(PeriodicStart::new(&stepper.model, state, &next));
            next.clone()
        };
        state.take(reached, &next);
        state.take(active, &start);
        stepper.guess.move_by(&next, state);
    }
    // Lanes that have converged do not depend on the others: these are run again alone.
    if S::LANES > 1 && (!(active | stepper.failed())).any() {
        stepper.mark_failed(active);
        restore(stepper, history.as_ref());
        return Ok((warmup.max_cycles, change_left));
    }
    let residual = (0..S::LANES).map(|lane| change_left.lane(lane)).fold(0.0, f64::max);
    Err(EngineError::WarmUpNotConverged { cycles: warmup.max_cycles, residual, tolerance })
}

/// The largest change between two repetitions [K]; that of slow cells of soil as what is left to change.
fn largest_change<S: Real>(state: &State<S>, next: &State<S>, soil: &[(usize, f64)]) -> S {
    soil.iter().fold(next.distance(state), |largest, &(cell, repetitions)| {
        largest.max((next.cells[cell] - state.cells[cell]).abs().scale(repetitions))
    })
}

/// Cells of soil that take more than one repetition of a period [s] to follow what is around them, and how many: a change is that part of what
/// is left to change.
fn slow_soil(plan: &Plan, period: f64) -> Vec<(usize, f64)> {
    let mut slow = Vec::new();
    for (wall, surface) in plan.walls.iter().zip(&plan.description.surfaces) {
        let Some(soil) = &surface.soil else { continue };
        let mut behind = 0.0;
        for (cell, (capacity, resistance)) in soil.capacities.iter().zip(&soil.resistances).enumerate() {
            behind += resistance;
            let repetitions = capacity * behind / period;
            if repetitions > 1.0 {
                slow.push((wall.first_cell + cell, repetitions.min(SLOWEST)));
            }
        }
    }
    slow
}

/// Sets what guesses are made from.
fn restore<S: Real>(stepper: &mut Stepper<'_, S>, history: Option<&History<S>>) {
    if let Some(history) = history {
        stepper.set_history(history);
    }
}
