//! The actions of a run: each changes the state.

use crate::balance::energy_balance::EnergyBalance;
use crate::error::EngineError;
use crate::number::real::Real;
use crate::run::options::Options;
use crate::step::scheme::Scheme;
use crate::step::state::State;
use crate::step::stepper::Stepper;
use crate::weather::conditions::Weather;

/// One change of the state of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Action {
    /// The first period begins, or begins again, from a state that no other action has made.
    BeginPeriod,
    /// A step of the warm-up.
    WarmUp(usize),
    /// The surfaces brought into balance with the weather of the start.
    Balance,
    /// The first step of a run that starts from one temperature everywhere.
    FirstStep,
    /// A step.
    Step(usize),
}

impl Action {
    /// Carries the action out.
    #[inline(always)]
    pub(crate) fn take<S: Real>(
        self,
        stepper: &mut Stepper<'_, S>,
        state: &mut State<S>,
        weather: &Weather<'_>,
        dt: f64,
        energy_balance: &mut EnergyBalance<S>,
    ) -> Result<(), EngineError> {
        match self {
            Self::BeginPeriod => Ok(()),
            Self::WarmUp(step) | Self::Step(step) => stepper.step(state, weather, step, dt, energy_balance),
            Self::FirstStep => stepper.first_step(state, weather, dt, energy_balance),
            Self::Balance => {
                stepper.forget();
                // The weather of the first stage is used for the start.
                stepper.balance_surfaces(state, &weather.at(0, 0))
            }
        }
    }

    /// The first step of a run. One temperature everywhere fits no weather; a periodic state, and one that a run has reached, do.
    pub(crate) fn first(options: &Options) -> Self {
        let jumps = options.warmup.is_none() && options.initial.is_uniform();
        if jumps { Self::FirstStep } else { Self::Step(0) }
    }

    /// The actions of a run of some steps, without those of its warm-up.
    pub(crate) fn all(steps: usize, options: &Options) -> impl Iterator<Item = Self> + use<> {
        [Self::Balance, Self::first(options)].into_iter().chain((1..steps).map(Self::Step))
    }

    /// Index of the step that it takes; that of the first one where it takes none.
    pub(crate) fn step(self) -> usize {
        match self {
            Self::BeginPeriod | Self::Balance | Self::FirstStep => 0,
            Self::WarmUp(step) | Self::Step(step) => step,
        }
    }

    /// The forcing of its first and of its last stage.
    pub(crate) fn weather_rows<'w>(self, weather: &Weather<'w>, scheme: Scheme) -> [&'w [f64]; 2] {
        let last = if self == Self::Balance { 0 } else { scheme.weights().len() - 1 };
        [0, last].map(|stage| weather.row(self.step(), stage))
    }

    /// Row of the records that the state after it is written to.
    pub(crate) fn row(self, options: &Options) -> Option<usize> {
        // Row k is the state at the start of step `record_from + k * record_every`.
        let steps = match self {
            Self::BeginPeriod | Self::WarmUp(_) => return None,
            Self::Balance => 0,
            Self::FirstStep => 1,
            Self::Step(step) => step + 1,
        };
        let since = steps.checked_sub(options.record_from)?;
        since.is_multiple_of(options.record_every).then(|| since / options.record_every)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::step::state::Initial;

    /// The rows of the actions of a run are those that its options count, without gap.
    #[test]
    fn rows_follow_each_other() {
        for (steps, record_from, record_every) in
            [(1, 0, 1), (10, 0, 3), (10, 4, 1), (10, 4, 3), (10, 10, 1), (5, 9, 1)]
        {
            let options = Options {
                dt: 900.0,
                scheme: Scheme::BackwardEuler,
                initial: Initial::Everywhere(20.0),
                warmup: None,
                outputs: Vec::new(),
                record_from,
                record_every,
                residuals: false,
            };
            let actions = Action::all(steps, &options);
            let rows: Vec<usize> = actions.filter_map(|action| action.row(&options)).collect();
            assert_eq!(
                rows,
                (0..options.rows(steps)).collect::<Vec<_>>(),
                "{steps}, {record_from}, {record_every}"
            );
            assert_eq!(Action::WarmUp(record_from).row(&options), None);
        }
    }
}
