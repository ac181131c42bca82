//! Parts of a step: one that does not converge is replaced by its two halves.

use crate::error::EngineError;

/// How often a step may be halved before it counts as unsolvable.
const MAX_HALVINGS: u32 = 6;

/// A part of a step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Part {
    pub(crate) step: usize,
    /// Start, in steps.
    pub(crate) from: f64,
    /// Length, in steps.
    pub(crate) share: f64,
    /// How often the step was halved for it.
    pub(crate) halvings: u32,
}

impl Part {
    /// A whole step.
    #[inline(always)]
    pub(crate) fn whole(step: usize) -> Self {
        Self { step, from: 0.0, share: 1.0, halvings: 0 }
    }

    /// Its two halves.
    pub(crate) fn halves(self) -> [Self; 2] {
        let share = 0.5 * self.share;
        let first = Self { share, halvings: self.halvings + 1, ..self };
        [first, Self { from: self.from + share, ..first }]
    }
}

/// The parts of a step that are still to be solved, the next one last.
#[derive(Debug, Clone, Default)]
pub(crate) struct StepParts(Vec<Part>);

impl StepParts {
    /// Begins with a whole step.
    #[inline(always)]
    pub(crate) fn begin(&mut self, step: usize) {
        self.0.push(Part::whole(step));
    }

    /// The next part.
    #[inline(always)]
    pub(crate) fn next(&mut self) -> Option<Part> {
        self.0.pop()
    }

    /// Puts two halves in the place of a part that could not be solved.
    ///
    /// # Errors
    /// The error, where halves would not help: after many halvings, or where something is not a number, which comes from
    /// what drives the step.
    pub(crate) fn halve(&mut self, part: Part, error: EngineError) -> Result<(), EngineError> {
        let solvable = matches!(error, EngineError::NotConverged { residual, .. } if !residual.is_nan());
        if part.halvings == MAX_HALVINGS || !solvable {
            self.0.clear();
            return Err(error);
        }
        let [first, second] = part.halves();
        self.0.extend([second, first]);
        Ok(())
    }

    /// Drops all parts.
    pub(crate) fn clear(&mut self) {
        self.0.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unsolved(residual: f64) -> EngineError {
        EngineError::NotConverged { step: 3, stage: 1, place: String::new(), residual, iterations: 60 }
    }

    /// Halves follow each other without gap, down to 1/64 of the step, and then the error is given back.
    #[test]
    fn halves_cover_the_step() {
        let mut parts = StepParts::default();
        parts.begin(3);
        let (mut end, mut count) = (0.0, 0);
        while let Some(part) = parts.next() {
            // Only the smallest parts can be solved, and the second half of the step.
            if part.from < 0.5 && part.halvings < MAX_HALVINGS {
                parts.halve(part, unsolved(1.0)).unwrap();
                continue;
            }
            assert_eq!((part.step, part.from), (3, end));
            end += part.share;
            count += 1;
        }
        assert_eq!((end, count), (1.0, 33));
        let smallest = Part { step: 3, from: 0.0, share: 1.0 / 64.0, halvings: MAX_HALVINGS };
        assert!(parts.halve(smallest, unsolved(1.0)).is_err() && parts.next().is_none());
        assert!(parts.halve(Part::whole(3), unsolved(f64::NAN)).is_err());
    }
}
