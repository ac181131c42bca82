//! Steps of unequal length: each is the record interval halved some times.

use crate::error::EngineError;

/// How often a record interval may be halved for a step.
pub const MOST_HALVINGS: u8 = 20;

/// Lengths of the steps of a run. A step never reaches over the end of a record interval.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StepLengths {
    /// How often the interval is halved for each step.
    halvings: Vec<u8>,
    /// The interval that each step lies in, counted from 0, and a last one behind the end.
    intervals: Vec<usize>,
}

impl StepLengths {
    /// From how often the record interval is halved for each step.
    ///
    /// # Errors
    /// [`EngineError::Input`]: a step reaches over the end of an interval, starts between multiples of its length, or is too short.
    pub fn new(halvings: Vec<u8>) -> Result<Self, EngineError> {
        let whole = 1_usize << MOST_HALVINGS;
        let (mut intervals, mut at) = (Vec::with_capacity(halvings.len() + 1), 0_usize);
        for (step, &count) in halvings.iter().enumerate() {
            let length = whole.checked_shr(u32::from(count)).unwrap_or(0);
            if length == 0 || !at.is_multiple_of(length) {
                return Err(EngineError::Input(format!(
                    "step {step} is a record interval halved {count} times; expected at most {MOST_HALVINGS} times, and a start at a \
                     multiple of its length"
                )));
            }
            intervals.push(at / whole);
            at += length;
        }
        if !at.is_multiple_of(whole) {
            return Err(EngineError::Input("the last step does not end with a record interval".to_owned()));
        }
        intervals.push(at / whole);
        Ok(Self { halvings, intervals })
    }

    /// Number of steps.
    #[must_use]
    pub fn steps(&self) -> usize {
        self.halvings.len()
    }

    /// Record intervals that end with the first so many steps, or before.
    pub(crate) fn intervals(&self, steps: usize) -> usize {
        self.intervals[steps.min(self.halvings.len())]
    }

    /// Whether a record interval ends with the first so many steps.
    pub(crate) fn ends_interval(&self, steps: usize) -> bool {
        steps > 0 && self.intervals.get(steps).is_some_and(|&after| after > self.intervals[steps - 1])
    }

    /// Length of a step, in record intervals.
    #[inline(always)]
    pub(crate) fn share(&self, step: usize) -> f64 {
        halved(u32::from(self.halvings[step]))
    }
}

/// One halved some times: a power of two, products with it are exact.
#[inline(always)]
pub(crate) fn halved(times: u32) -> f64 {
    1.0 / f64::from(1_u32 << times)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two intervals: one in three steps, one whole. Their ends and lengths are counted, and what does not fit is refused.
    #[test]
    fn steps_fill_intervals() {
        let lengths = StepLengths::new(vec![1, 2, 2, 0]).unwrap();
        assert_eq!([0, 1, 2, 3].map(|step| lengths.share(step)), [0.5, 0.25, 0.25, 1.0]);
        assert_eq!([0, 1, 2, 3, 4].map(|steps| lengths.intervals(steps)), [0, 0, 0, 1, 2]);
        let ends = [0, 1, 2, 3, 4].map(|steps| lengths.ends_interval(steps));
        assert_eq!(ends, [false, false, false, true, true]);
        for wrong in [vec![2, 1, 2], vec![1], vec![30], vec![1, 0]] {
            assert!(StepLengths::new(wrong.clone()).is_err(), "{wrong:?}");
        }
    }
}
