//! What the guesses of a step are made from beside its state: with it a run goes on with the same bits.

use crate::building::plan::Plan;
use crate::number::real::Real;
use crate::step::guess::Guess;
use crate::step::ideal_loads::loads::LoadHistory;
use crate::step::stepper::Stepper;

/// What the guesses of the next step are made from beside the state.
#[derive(Debug, Clone)]
pub(crate) struct History<S> {
    guess: Guess<S>,
    loads: LoadHistory<S>,
}

impl<S: Real> Stepper<'_, S> {
    /// What the guesses of the next step are made from.
    pub(crate) fn history(&self) -> History<S> {
        History { guess: self.guess.clone(), loads: self.ideal_loads.history() }
    }

    /// The next step goes on from another run.
    pub(crate) fn set_history(&mut self, history: &History<S>) {
        self.guess.clone_from(&history.guess);
        self.ideal_loads.set_history(&history.loads);
    }
}

impl<S: Real> History<S> {
    /// Copies the lanes of another one where the mask is true.
    pub(crate) fn take(&mut self, mask: S::Mask, other: &Self) {
        self.guess.take(mask, &other.guess);
        self.loads.take(mask, &other.loads);
    }
}

impl History<f64> {
    /// Writes all its numbers.
    pub(crate) fn write(&self, numbers: &mut Vec<f64>) {
        self.guess.write(numbers);
        self.loads.write(numbers);
    }

    /// Reads the numbers that the history of a run of the same plan wrote. False where these are none: it has no meaning then.
    pub(crate) fn read(&mut self, plan: &Plan, numbers: &[f64]) -> bool {
        let rest = self.guess.read(plan, numbers);
        rest.and_then(|rest| self.loads.read(rest)).is_some_and(<[f64]>::is_empty)
    }
}
