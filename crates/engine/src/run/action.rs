//! The actions of a run: each changes the state.

use core::ops::Range;

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
    /// Carries the action out; `dt` is the length of its step [s].
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
        Self::over(0..steps, options)
    }

    /// The actions of a part of a run.
    pub(crate) fn over(steps: Range<usize>, options: &Options) -> impl Iterator<Item = Self> + use<> {
        let begins = if steps.start == 0 { 2 } else { 0 };
        let begin = [Self::Balance, Self::first(options)].into_iter().take(begins);
        begin.chain((steps.start.max(1)..steps.end).map(Self::Step))
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

    /// What it adds to the records.
    #[inline(always)]
    pub(crate) fn record(self, options: &Options) -> Option<Recorded> {
        let steps = match self {
            Self::BeginPeriod | Self::WarmUp(_) => return None,
            Self::Balance => 0,
            Self::FirstStep => 1,
            Self::Step(step) => step + 1,
        };
        // Row k is the state at the start of step, or record interval, `record_from + k * record_every`.
        let (ended, share, ends) = match &options.lengths {
            Some(lengths) if steps > 0 => {
                let ends = lengths.ends_interval(steps);
                let ended = lengths.intervals(steps) + usize::from(!ends);
                (ended, lengths.share(steps - 1), ends)
            }
            _ => (steps, 1.0, true),
        };
        let since = ended.checked_sub(options.record_from)?;
        let row = since.is_multiple_of(options.record_every).then(|| since / options.record_every)?;
        Some(Recorded { row, share, ends })
    }
}

/// What an action adds to the records.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Recorded {
    pub(crate) row: usize,
    /// Part of the means of the row that its step is.
    pub(crate) share: f64,
    /// Whether the row ends with it.
    pub(crate) ends: bool,
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;

    use crate::run::step_lengths::StepLengths;
    use crate::step::state::Initial;

    /// The rows of the actions of a run are those that its options count, without gap.
    #[test]
    fn rows_follow_each_other() {
        for (steps, record_from, record_every) in
            [(1, 0, 1), (10, 0, 3), (10, 4, 1), (10, 4, 3), (10, 10, 1), (5, 9, 1)]
        {
            let options = Options {
                dt: 900.0,
                lengths: None,
                scheme: Scheme::BackwardEuler,
                initial: Initial::Everywhere(20.0),
                warmup: None,
                outputs: Vec::new(),
                record_from,
                record_every,
                residuals: false,
            };
            let actions = Action::all(steps, &options);
            let rows: Vec<usize> =
                actions.filter_map(|action| action.record(&options)).map(|record| record.row).collect();
            assert_eq!(
                rows,
                (0..options.rows(steps)).collect::<Vec<_>>(),
                "{steps}, {record_from}, {record_every}"
            );
            assert_eq!(Action::WarmUp(record_from).record(&options), None);
            let halves = Action::over(0..steps / 2, &options).chain(Action::over(steps / 2..steps, &options));
            assert!(steps < 2 || halves.eq(Action::all(steps, &options)), "{steps}");
        }
    }

    /// Steps of an interval share its row, each by its length.
    #[test]
    fn steps_of_an_interval_share_a_row() {
        let lengths = StepLengths::new(vec![1, 2, 2, 0]).unwrap();
        let options = Options {
            dt: 900.0,
            lengths: Some(Arc::new(lengths)),
            scheme: Scheme::BackwardEuler,
            initial: Initial::Everywhere(20.0),
            warmup: None,
            outputs: Vec::new(),
            record_from: 0,
            record_every: 1,
            residuals: false,
        };
        assert_eq!(options.rows(4), 3);
        let records: Vec<_> =
            Action::all(4, &options).map(|action| action.record(&options).unwrap()).collect();
        let shares: Vec<_> = records.iter().map(|record| (record.row, record.share, record.ends)).collect();
        let expected = [(0, 1.0, true), (1, 0.5, false), (1, 0.25, false), (1, 0.25, true), (2, 1.0, true)];
        assert_eq!(shares, expected);
    }
}
