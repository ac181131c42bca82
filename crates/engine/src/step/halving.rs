//! Parts of a step: one that does not converge, or carries the air of a zone beyond its causes, is replaced by its two halves, and the
//! first step of a run that starts from one temperature everywhere is made in parts that grow.

use crate::error::EngineError;
use crate::number::real::Real;

/// How often a step may be halved before it counts as unsolvable.
const MAX_HALVINGS: u32 = 6;

/// How often the first step of a run is halved towards its start.
///
/// One temperature everywhere does not fit the weather: the surfaces jump, and behind them the temperature changes with the square root of time,
/// which a scheme of second order does not follow over a whole step. Parts that double in length do: each is as long as the time since
/// the start. With six halvings the first part is 14 s of a step of 15 min, shorter than the time constant of the air of a room
/// (minutes); the error of the surface at the end of the step is then that of the steps after it (`docs/engine.md`).
const FIRST_HALVINGS: u32 = 6;

/// Iterations that a step may take with all its parts before it is given up: some thousand times those of a usual stage, so that a run
/// stops in seconds where a step cannot be solved.
pub(super) const MAX_WORK: usize = 3000;

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

    /// Whether the step ends with it.
    #[inline(always)]
    pub(crate) fn is_last(self) -> bool {
        // Lengths are powers of a half, so that the sum is exact.
        self.from + self.share >= 1.0
    }

    /// Whether it may be halved.
    pub(crate) fn divisible(self) -> bool {
        self.halvings < MAX_HALVINGS
    }

    /// Its two halves.
    pub(crate) fn halves(self) -> [Self; 2] {
        let share = 0.5 * self.share;
        let first = Self { share, halvings: self.halvings + 1, ..self };
        [first, Self { from: self.from + share, ..first }]
    }
}

/// The parts of a step.
#[derive(Debug, Clone)]
pub(crate) struct Substeps<S> {
    /// Still to be solved, the next one last.
    left: Vec<Part>,
    /// Ideal load of each zone, summed over the parts solved so far, each by its share of the step [W].
    load: Vec<S>,
    /// Iterations made before the step.
    before: usize,
}

impl<S: Real> Substeps<S> {
    /// For a number of zones.
    pub(crate) fn new(zones: usize) -> Self {
        Self { left: Vec::new(), load: vec![S::zero(); zones], before: 0 }
    }

    /// Begins with a whole step.
    #[inline(always)]
    pub(crate) fn begin(&mut self, step: usize) {
        self.left.push(Part::whole(step));
    }

    /// Begins with a part of a step.
    pub(crate) fn begin_part(&mut self, part: Part) {
        self.load.fill(S::zero());
        self.left.push(part);
    }

    /// Begins with the first step of a run, in parts that grow.
    #[cold]
    pub(crate) fn begin_first(&mut self) {
        self.load.fill(S::zero());
        let mut rest = Part::whole(0);
        while rest.halvings < FIRST_HALVINGS {
            let [first, second] = rest.halves();
            self.left.push(second);
            rest = first;
        }
        self.left.push(rest);
    }

    /// Notes the iterations made so far: the step may take [`MAX_WORK`] more.
    #[inline(always)]
    pub(crate) fn count_from(&mut self, iterations: usize) {
        self.before = iterations;
    }

    /// Whether the step has taken more iterations than it may, of those made so far.
    #[inline(always)]
    pub(crate) fn limit_reached(&self, iterations: usize) -> bool {
        iterations - self.before > MAX_WORK
    }

    /// The next part.
    #[inline(always)]
    pub(crate) fn next(&mut self) -> Option<Part> {
        self.left.pop()
    }

    /// Replaces a part that could not be solved by its two halves.
    ///
    /// # Errors
    /// The error itself, where halves would not help: after many halvings, or where a number is NaN, which comes from the
    /// weather or the parameters of the step.
    pub(crate) fn halve(&mut self, part: Part, error: EngineError) -> Result<(), EngineError> {
        let solvable = matches!(error, EngineError::NotConverged { residual, .. } if !residual.is_nan());
        if !(part.divisible() && solvable) {
            self.left.clear();
            return Err(error);
        }
        self.divide(part);
        Ok(())
    }

    /// Replaces a part by its two halves.
    pub(crate) fn divide(&mut self, part: Part) {
        if part.halvings == 0 {
            self.load.fill(S::zero());
        }
        let [first, second] = part.halves();
        self.left.extend([second, first]);
    }

    /// Adds the mean loads over a part; after the last one they are replaced by the means over the step.
    #[cold]
    pub(crate) fn average(&mut self, part: Part, load: &mut [S]) {
        for (sum, &load) in self.load.iter_mut().zip(load.iter()) {
            *sum += load.scale(part.share);
        }
        if self.left.is_empty() {
            load.copy_from_slice(&self.load);
        }
    }

    /// Drops all parts.
    pub(crate) fn clear(&mut self) {
        self.left.clear();
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
        let mut parts = Substeps::<f64>::new(1);
        parts.begin(3);
        let (mut end, mut count, mut mean) = (0.0, 0, 0.0_f64);
        while let Some(part) = parts.next() {
            // Only the smallest parts can be solved, and the second half of the step.
            if part.from < 0.5 && part.halvings < MAX_HALVINGS {
                parts.halve(part, unsolved(1.0)).unwrap();
                continue;
            }
            assert_eq!((part.step, part.from), (3, end));
            end += part.share;
            count += 1;
            // A load of as many watts as the part is early: its mean over the step is an integral.
            let mut load = [1.0 - part.from - 0.5 * part.share];
            parts.average(part, &mut load);
            mean = load[0];
        }
        assert!((mean - 0.5).abs() < 1e-15, "the mean over the step is {mean}");
        assert_eq!((end, count), (1.0, 33));
        let smallest = Part { step: 3, from: 0.0, share: 1.0 / 64.0, halvings: MAX_HALVINGS };
        assert!(parts.halve(smallest, unsolved(1.0)).is_err() && parts.next().is_none());
        assert!(parts.halve(Part::whole(3), unsolved(f64::NAN)).is_err());
    }
}
