//! Slopes of a periodic state: of the map `P` of a period, they are `s = P' s + dP/dp`.
//!
//! The values of the state have been found by repetitions (`run/periodic_start`); here they are fixed, and the slopes go through the
//! last repetition until they no longer change. This is a linear map, so that few passes are needed (`run/anderson`), and the slopes
//! do not depend on how the values were found. In reverse the same is done with the transposed map. Source: Christianson (1994),
//! Reverse accumulation and attractive fixed points, doi:10.1080/10556789408805572.

use crate::building::model::Model;
use crate::error::EngineError;
use crate::number::dual::Dual;
use crate::number::real::Real;
use crate::run::anderson::Anderson;
use crate::run::periodic_start::weights;
use crate::step::control::RunControl;
use crate::step::stage_solutions::StageSolutions;
use crate::step::state::State;

use super::kept_steps::{KeptRun, KeptSteps};
use super::stored_steps::DerivativeStepper;

/// Changes from one pass to the next that are remembered.
const DEPTH: usize = 12;
/// Relative change in a pass at which slopes are those of the periodic state.
const CHANGE: f64 = 1e-12;
/// A search ends where the change has not fallen by a tenth in as many passes: round-off is left, or parts of a state that no period
/// changes, such as the memory of a cell that does not melt.
const DAMPING_START: usize = 12;

/// Weights of the squares of the numbers of a state in the size of slopes, in plain numbers.
pub(super) fn plain_weights<S: Real>(model: &Model<'_, S>, state: &State<S>) -> Vec<f64> {
    let mut numbers = Vec::new();
    weights(model, state).write(&mut numbers);
    numbers.into_iter().map(|weight| weight.lane(0)).collect()
}

/// The search for numbers that a linear map does not change.
pub(super) struct SlopeSearch {
    weights: Vec<f64>,
    anderson: Option<Anderson<f64>>,
    /// Square of the smallest change, and the passes since it was found.
    smallest: f64,
    since: usize,
}

impl SlopeSearch {
    pub(super) fn new(weights: Vec<f64>) -> Self {
        Self { weights, anderson: None, smallest: f64::INFINITY, since: 0 }
    }

    /// The numbers to try after these ones with their image; none where they are found.
    pub(super) fn next(&mut self, numbers: &[f64], image: &[f64]) -> Option<Vec<f64>> {
        let change: Vec<f64> = image.iter().zip(numbers).map(|(image, number)| image - number).collect();
        let anderson = match &mut self.anderson {
            Some(anderson) => {
                anderson.learn(true, image, &change);
                anderson
            }
            none => none.insert(Anderson::new(self.weights.clone(), DEPTH, image, &change)),
        };
        let square = anderson.square(&change);
        self.since += 1;
        if square < 0.81 * self.smallest {
            self.smallest = square;
            self.since = 0;
        }
        let found = square <= CHANGE * CHANGE * anderson.square(image) || self.since >= DAMPING_START;
        (!found).then(|| anderson.next())
    }
}

/// Gives a state the slopes of the periodic state at the end of a period, whose numbers are `end`. The slopes that it has are the first guess.
pub(super) fn settle<const K: usize>(
    stepper: &mut DerivativeStepper<'_, Dual<K>>,
    state: &mut State<Dual<K>>,
    (period, end): (&KeptSteps, &State<f64>),
    run: KeptRun<'_, '_>,
    watch: &RunControl,
) -> Result<(), EngineError> {
    let (mut known, unknowns) = (StageSolutions::nothing(), stepper.linearized_stepper.place());
    let stages = run.options.scheme.weights().len();
    let weights = plain_weights(&stepper.linearized_stepper.model, state);
    let mut searches: Vec<_> = (0..K).map(|_| SlopeSearch::new(weights.clone())).collect();
    let mut searching = [true; K];
    let slopes_of = |state: &State<Dual<K>>| -> Vec<[f64; K]> {
        let mut numbers = Vec::with_capacity(state.count());
        state.write(&mut numbers);
        numbers.iter().map(|number: &Dual<K>| number.slope).collect()
    };
    loop {
        let mut slopes = slopes_of(state);
        period.visit(run, false, |actions, stretch| {
            for (&action, (before, solution)) in actions.iter().zip(stretch.iter()) {
                watch.check()?;
                state.read(before, |number, value| number.value = value);
                let cells = &stepper.linearized_stepper.model.parts.nonlinear_cells;
                known.read(cells, solution, stages, (&unknowns, end));
                let length = run.options.length(action.step());
                stepper.take(action, state, run.weather, length, &known);
            }
            Ok(())
        })?;
        let images = slopes_of(state);
        for (k, (search, searching)) in searches.iter_mut().zip(&mut searching).enumerate() {
            if !*searching {
                continue;
            }
            let [numbers, image] =
                [&slopes, &images].map(|all| all.iter().map(|slope| slope[k]).collect::<Vec<_>>());
            let next = search.next(&numbers, &image);
            *searching = next.is_some();
            // Slopes that are found are those at the end of this pass.
            for (slope, next) in slopes.iter_mut().zip(next.unwrap_or(image)) {
                slope[k] = next;
            }
        }
        state.read(&slopes, |number, slope| number.slope = slope);
        if searching == [false; K] {
            return Ok(());
        }
    }
}
