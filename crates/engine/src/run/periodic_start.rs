//! The periodic start found in few repetitions: each repetition starts from where the last ones lead.
//!
//! What a repetition makes of temperatures and moisture contents is nearly a linear map, whose slowest modes are those of thick
//! walls: they decay by a few percent a day. Repetitions alone need tens of days for them, Anderson's extrapolation a few. All
//! else that a run passes on (enthalpies, memory of phase-change cells) is found from the temperatures.

use crate::building::coefficients::Matter;
use crate::building::model::Model;
use crate::number::real::{Mask, Real};
use crate::run::anderson::Anderson;
use crate::step::state::State;

/// Changes from one repetition to the next that are remembered.
const DEPTH: usize = 5;
/// A change that is smaller by this factor than all before earns trust (square).
const EARNED: f64 = 0.1;
/// Farthest that a temperature is extrapolated beyond the end of a repetition [K].
const FARTHEST: f64 = 30.0;
/// Humidity ratios and moisture contents are extrapolated up to this factor, and down by it.
const WETTEST: f64 = 2.0;
/// A change of a humidity ratio as a change of temperature, by the latent heat over the specific heat of air [K].
const RATIO_AS_KELVIN: f64 = 2500.0;
/// Heat of evaporation [J/kg], and a change of a moisture content by its own value as a change of temperature [K], which make its
/// change comparable with that of stored heat.
const LATENT: f64 = 2.5e6;
const CONTENT_AS_KELVIN: f64 = 10.0;

/// Weights of the squares of the numbers of a state in the size of a change [J/K]: heat capacities, because heat conduction is
/// symmetric in the norm that they make. Numbers that follow from others have no weight.
pub(crate) fn weights<S: Real>(model: &Model<'_, S>, state: &State<S>) -> State<S> {
    let mut weights = state.clone();
    weights.change_by(state, |weight, _| *weight = S::zero());
    for (wall, numbers) in model.plan.walls.iter().zip(&model.coefficients.walls) {
        for (k, cell) in (wall.first_cell..).zip(&numbers.cells) {
            let capacity = match &cell.matter {
                Matter::Solid { capacity, .. } => *capacity,
                Matter::Pcm(law) => numbers.pcm[*law].sensible_heat(),
            };
            let volume = numbers.area * cell.thickness;
            if wall.nonlinear {
                // These pass enthalpies on: their stored heat over the capacity is as a temperature.
                let some = S::constant(f64::MIN_POSITIVE).lt(capacity);
                weights.enthalpy[k] = S::select(some, volume / capacity, S::zero()).fixed();
            } else {
                weights.cells[k] = (volume * capacity).fixed();
            }
        }
    }
    for (weight, zone) in weights.air.iter_mut().zip(&model.coefficients.zones) {
        *weight = zone.capacity.fixed();
    }
    if let Some(humidity) = &model.coefficients.humidity {
        let (ratios, contents) = weights.vapour.split_at_mut(state.air.len());
        // [J/K] times the square of [K per kg/kg].
        for (weight, zone) in ratios.iter_mut().zip(&model.coefficients.zones) {
            *weight = zone.air_capacity.scale(RATIO_AS_KELVIN * RATIO_AS_KELVIN).fixed();
        }
        let given = state.vapour[state.air.len()..].chunks(2);
        for ((weights, surface), contents) in contents.chunks_mut(2).zip(&humidity.surfaces).zip(given) {
            for (weight, &content) in weights.iter_mut().zip(contents) {
                // Stored heat `area content LATENT` over [K], times the square of [K] over the content.
                let some = S::constant(f64::MIN_POSITIVE).lt(content);
                let by_content = (surface.area / content).scale(LATENT * CONTENT_AS_KELVIN);
                *weight = S::select(some, by_content, S::zero()).fixed();
            }
        }
    }
    weights
}

/// The numbers of a state, and their changes since another one.
fn numbers<S: Real>(state: &State<S>, since: &State<S>) -> [Vec<S>; 2] {
    let (mut numbers, mut before) = (Vec::with_capacity(state.count()), Vec::with_capacity(state.count()));
    state.write(&mut numbers);
    since.write(&mut before);
    let changes = numbers.iter().zip(before).map(|(&now, before)| now - before).collect();
    [numbers, changes]
}

/// What is known after some repetitions. A change is measured by the square of its size.
pub(super) struct PeriodicStart<S: Real> {
    anderson: Anderson<S>,
    /// End of the last repetition that was not taken back, and its change.
    end: State<S>,
    square: S,
    /// Smallest change so far.
    smallest: S,
    /// How many more extrapolations may be taken back.
    trust: S,
    /// Lanes that repetitions alone do not bring to their end in one more.
    slow: S::Mask,
    /// Lanes whose repetition started from an extrapolated state.
    extrapolated: S::Mask,
}

impl<S: Real> PeriodicStart<S> {
    /// Knows the first repetition, from `start` to `end`. The next one starts from its end.
    pub(super) fn new(model: &Model<'_, S>, start: &State<S>, end: &State<S>) -> Self {
        let [image, residual] = numbers(end, start);
        let mut metric = Vec::with_capacity(image.len());
        weights(model, end).write(&mut metric);
        let anderson = Anderson::new(metric, DEPTH, &image, &residual);
        let square = anderson.square(&residual);
        Self {
            anderson,
            end: end.clone(),
            square,
            smallest: square,
            trust: S::one(),
            slow: S::Mask::splat(false),
            extrapolated: S::Mask::splat(false),
        }
    }

    /// Learns from the next repetition, whose largest change was `change` [K]. Gives the state that the one after it starts from.
    pub(super) fn next(
        &mut self,
        model: &Model<'_, S>,
        start: &State<S>,
        end: &State<S>,
        change: S,
        tolerance: f64,
    ) -> State<S> {
        let [image, residual] = numbers(end, start);
        let square = self.anderson.square(&residual);
        let kept = self.judge(square);
        self.anderson.learn(kept, &image, &residual);
        // Where the change is expected to be below the tolerance after the next repetition, nothing is to be gained.
        let expected = S::constant(tolerance * tolerance) * self.square;
        self.slow = self.slow | !(change * change * square).lt(expected);
        self.extrapolated = self.slow & kept & S::zero().lt(self.trust);
        let mut next = self.end.clone();
        next.take(kept, end);
        self.end.take(kept, end);
        self.square = S::select(kept, square, self.square);
        if self.extrapolated.any() {
            next.take(self.extrapolated, &extrapolated(model, end, &self.anderson.next()));
        }
        next
    }

    /// Lanes that go on from a repetition with this change. The others take the extrapolation back that it started from: the change
    /// has not become smaller than ever. This may happen once, and once more each time that the change has become much smaller than ever:
    /// where laws have bends, repetitions go on alone.
    fn judge(&mut self, square: S) -> S::Mask {
        let kept = !self.extrapolated | square.lt(self.smallest);
        let earned = self.extrapolated & square.lt(self.smallest.scale(EARNED));
        self.trust += S::select(earned, S::one(), S::zero()) - S::select(kept, S::zero(), S::one());
        self.smallest = S::select(kept, self.smallest.min(square), self.smallest);
        kept
    }
}

/// A state whose temperatures and moisture contents are those of `numbers` within bounds, and all else goes with them. Cells whose
/// enthalpy depends on the path stay as they are.
fn extrapolated<S: Real>(model: &Model<'_, S>, end: &State<S>, numbers: &[S]) -> State<S> {
    let mut state = end.clone();
    state.read(numbers, |mine, number| *mine = number);
    let State { cells, surfaces, air, vapour, .. } = &mut state;
    let from = end.cells.iter().chain(&*end.surfaces).chain(&end.air);
    for (number, &from) in cells.iter_mut().chain(&mut **surfaces).chain(air).zip(from) {
        let far = S::constant(FARTHEST);
        *number = number.max(from - far).min(from + far);
    }
    for (number, from) in vapour.iter_mut().zip(&end.vapour) {
        *number = number.max(from.scale(1.0 / WETTEST)).min(from.scale(WETTEST));
    }
    state.enthalpy.copy_from_slice(&end.enthalpy);
    state.load.copy_from_slice(&end.load);
    state.opened.copy_from_slice(&end.opened);
    state.unchanged.copy_from_slice(&end.unchanged);
    state.memory.copy_from_slice(&end.memory);
    state.move_heat(model, end);
    state
}
