//! The row of the records that fills as a run goes on: states at its end, means over its steps.

use crate::number::real::Real;
use crate::run::action::Action;
use crate::run::options::Options;
use crate::run::outputs::Output;
use crate::run::outputs::row::Time;
use crate::step::readings::Readings;
use crate::step::state::State;

impl Output {
    /// Whether it is a mean over a step.
    #[inline(always)]
    pub(crate) fn is_mean(&self) -> bool {
        self.row().time == Time::Mean
    }
}

/// A row of the records in the making.
#[derive(Debug, Clone)]
pub(crate) struct RecordRow<S> {
    /// Means over the steps so far, each by its share of the row.
    sums: Vec<S>,
}

impl<S: Real> RecordRow<S> {
    pub(crate) fn new() -> Self {
        Self { sums: Vec::new() }
    }

    /// Adds the state after an action; true where a row ends with it, which is then written behind the records.
    #[inline(always)]
    pub(crate) fn add(
        &mut self,
        (action, options, outputs): (Action, &Options, &[Output]),
        (step, state): (&Readings<'_, S>, &State<S>),
        records: &mut Vec<S>,
    ) -> bool {
        let Some(record) = action.record(options) else { return false };
        let plan = step.model.plan;
        if record.share >= 1.0 {
            records.extend(outputs.iter().map(|output| output.read(plan, step, state)));
            return true;
        }
        self.sums.resize(outputs.len(), S::zero());
        for (sum, output) in self.sums.iter_mut().zip(outputs) {
            if output.is_mean() {
                *sum += output.read(plan, step, state).scale(record.share);
            }
        }
        if record.ends {
            for (sum, output) in self.sums.iter_mut().zip(outputs) {
                let mean = core::mem::replace(sum, S::zero());
                records.push(if output.is_mean() { mean } else { output.read(plan, step, state) });
            }
        }
        record.ends
    }
}
