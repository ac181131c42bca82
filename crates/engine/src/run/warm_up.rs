//! The warm-up: the first period repeated until the state at its end is that at its start.
//!
//! A lane that has converged keeps what it passes on: its state, and what its guesses are made from. Other lanes repeat the period, and
//! it with them, to no effect.

use crate::balance::energy_balance::EnergyBalance;
use crate::building::model::Model;
use crate::error::EngineError;
use crate::number::real::{ByPrecision, Mask, Real};
use crate::run::action::Action;
use crate::run::options::Options;
use crate::run::periodic_start::PeriodicStart;
use crate::run::soil_start::SoilStart;
use crate::step::control::RunControl;
use crate::step::history::History;
use crate::step::state::State;
use crate::step::stepper::Stepper;
use crate::weather::conditions::Weather;

/// Least change of a temperature between two repetitions that is asked for [K]: in single precision, smaller ones are rounding.
const LEAST: ByPrecision = ByPrecision { double: 0.0, single: 2e-3 };

/// Two states are the same where no number differs by more than a part of itself and a sum, for each kelvin of the tolerance of the warm-up:
/// of temperatures, by a few thousandths of the tolerance at most.
const SAME: [f64; 2] = [1e-5, 1e-4];

/// A state that was reached before, to see where the repetitions go round in a circle: a control that switches may come back to where
/// it was after some periods, and never to the start of one. The state is replaced after 1, 2, 4, ... repetitions, so that a circle of any
/// length is seen (Brent 1980, doi:10.1007/BF01933190). A state that is that of the repetition just before is no circle, but what the
/// repetitions converge to: soil is moved between them.
struct Circle<S: Real> {
    tolerance: f64,
    before: State<S>,
    /// The repetition after which the state was remembered.
    since: usize,
    numbers: Vec<S>,
}

impl<S: Real> Circle<S> {
    fn new(state: &State<S>, tolerance: f64) -> Self {
        Self { tolerance, before: state.clone(), since: 0, numbers: Vec::new() }
    }

    /// The lanes in which the state after a repetition, counted from 1, is one that was reached before.
    fn comes_back(&mut self, state: &State<S>, cycle: usize) -> S::Mask {
        let mut same = S::Mask::splat(cycle > self.since + 1);
        self.numbers.clear();
        self.before.write(&mut self.numbers);
        state.zip_with(&self.numbers, |now, before| {
            let [part, sum] = SAME.map(|same| same * self.tolerance);
            same = same & (now - before).abs().lt(before.abs().scale(part) + S::constant(sum));
        });
        if cycle.is_power_of_two() {
            self.before.copy_from(state);
            self.since = cycle;
        }
        same
    }
}

/// Lanes that repeat the period, and what is left to change in them.
struct Progress<S: Real> {
    tolerance: f64,
    active: S::Mask,
    circle: Circle<S>,
    /// Lanes that go round in a circle: they will never converge.
    circling: S::Mask,
    /// Largest change in the last repetition [K].
    change_left: S,
}

impl<S: Real> Progress<S> {
    fn new(state: &State<S>, tolerance: f64) -> Self {
        let circle = Circle::new(state, tolerance);
        let circling = S::Mask::splat(false);
        Self { tolerance, active: S::Mask::splat(true), circle, circling, change_left: S::zero() }
    }

    /// Notes a repetition, counted from 1, and its largest change [K]. Gives the lanes that made it.
    fn note(&mut self, next: &State<S>, change: S, cycle: usize, failed: S::Mask) -> S::Mask {
        let reached = self.active;
        self.change_left = S::select(reached, change, self.change_left);
        self.active = reached & !failed & S::constant(self.tolerance).lt(change);
        self.circling = self.circling | (self.active & self.circle.comes_back(next, cycle));
        self.active = self.active & !self.circling;
        reached
    }
}

/// Repetitions after which what is left to soil counts no more: a control that switches moves it a little, again and again.
const SETTLING: usize = 50;

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
    let period = options.elapsed(warmup.steps);
    let soil_start = SoilStart::new(&stepper.model, period);
    let mut progress = Progress::new(state, tolerance);
    let mut known: Option<PeriodicStart<S>> = None;
    // What the guesses of the lanes that have converged are made from, as their last repetition left it.
    let mut history: Option<History<S>> = None;
    let mut cycles = warmup.max_cycles;
    for cycle in 1..=warmup.max_cycles {
        let mut next = state.clone();
        let mut unused = EnergyBalance::new();
        observe(stepper, state, Action::BeginPeriod)?;
        for action in (0..warmup.steps).map(Action::WarmUp) {
            control.check()?;
            action.take(stepper, &mut next, weather, options.length(action.step()), &mut unused)?;
            observe(stepper, &next, action)?;
        }
        let advanced = soil_start.advance(state, &next);
        let left = advanced.as_ref().filter(|_| cycle <= SETTLING).map_or_else(S::zero, |(_, left)| *left);
        let change = next.distance(state).max(left);
        let reached = progress.note(&next, change, cycle, stepper.failed());
        if S::LANES > 1 {
            remember(&mut history, reached, stepper.history());
        }
        if !progress.active.any() {
            state.take(reached, &next);
            if progress.circling.any() {
                cycles = cycle;
                break;
            }
            restore(stepper, history.as_ref());
            return Ok((cycle, progress.change_left));
        }
        let end = advanced.as_ref().map_or(&next, |(advanced, _)| advanced);
        let start = next_start(&mut known, &stepper.model, (state, end), change, tolerance);
        state.take(reached, &next);
        state.take(progress.active, &start);
        stepper.guess.move_by(&next, state);
    }
    let Progress { active, circling, change_left, .. } = progress;
    let lost = active | circling;
    // Lanes that have converged do not depend on the others: these are run again alone.
    if S::LANES > 1 && (!(lost | stepper.failed())).any() {
        stepper.mark_failed(lost);
        restore(stepper, history.as_ref());
        return Ok((cycles, change_left));
    }
    let residual = (0..S::LANES).map(|lane| change_left.lane(lane)).fold(0.0, f64::max);
    Err(EngineError::WarmUpNotConverged { cycles, residual, tolerance })
}

/// What the next repetition starts from, after one from a start to an end whose largest change was `change` [K].
fn next_start<S: Real>(
    known: &mut Option<PeriodicStart<S>>,
    model: &Model<'_, S>,
    (start, end): (&State<S>, &State<S>),
    change: S,
    tolerance: f64,
) -> State<S> {
    if let Some(known) = known {
        return known.next(model, start, end, change, tolerance);
    }
    *known = Some(PeriodicStart::new(model, start, end));
    end.clone()
}

/// Takes over what guesses are made from, in some lanes.
fn remember<S: Real>(history: &mut Option<History<S>>, reached: S::Mask, now: History<S>) {
    match history {
        Some(history) => history.take(reached, &now),
        None => *history = Some(now),
    }
}

/// Sets what guesses are made from.
fn restore<S: Real>(stepper: &mut Stepper<'_, S>, history: Option<&History<S>>) {
    if let Some(history) = history {
        stepper.set_history(history);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn state(temperature: f64) -> State<f64> {
        State {
            cells: vec![temperature; 3],
            enthalpy: Vec::new(),
            memory: Vec::new(),
            surfaces: vec![temperature; 2].into(),
            air: vec![temperature],
            load: Vec::new(),
            vapour: Vec::new(),
            opened: Vec::new(),
            unchanged: Vec::new(),
        }
    }

    /// After how many repetitions a sequence of temperatures comes back.
    fn circle(tolerance: f64, temperatures: impl Iterator<Item = f64>) -> Option<usize> {
        let mut circle = Circle::new(&state(f64::NAN), tolerance);
        let mut cycles = (1..).zip(temperatures.take(1000));
        cycles.find_map(|(cycle, next)| circle.comes_back(&state(next), cycle).then_some(cycle))
    }

    /// A factor to the power of 1, 2, 3, ...
    fn powers(factor: f64) -> impl Iterator<Item = f64> {
        core::iter::successors(Some(factor), move |power| Some(power * factor))
    }

    /// A circle of seven repetitions after a transient: it is seen as soon as a state of it is remembered for seven. What converges, from one
    /// side or in decaying circles, is none, however small the tolerance is.
    #[test]
    fn a_circle_is_seen_and_a_slow_decay_is_none() {
        let turning = (1..).zip(powers(0.5)).map(|(cycle, decay)| f64::from(cycle % 7) + 5.0 * decay);
        assert_eq!(circle(0.01, turning), Some(32 + 7));
        let back_and_forth = (1..).map(|cycle| f64::from(cycle % 2));
        assert_eq!(circle(0.01, back_and_forth), Some(4));
        for tolerance in [1e-2, 1e-9] {
            for factor in [0.98, -0.9] {
                let seen = circle(tolerance, powers(factor).map(|decay| 20.0 + decay));
                // The change between two repetitions is below the tolerance by then.
                let change = powers(factor).map(|power| (power * (1.0 - factor)).abs());
                let converged = change.take_while(|&change| change > tolerance).count();
                assert!(seen.is_none_or(|cycle| cycle > converged), "{tolerance}, {factor}: {seen:?}");
            }
        }
    }
}
