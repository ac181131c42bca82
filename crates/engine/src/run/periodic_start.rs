//! The periodic start found in few repetitions: each repetition starts from where the last ones lead.
//!
//! What a repetition makes of temperatures and moisture contents is nearly a linear map, whose slowest modes are those of thick
//! walls: they decay by a few percent a day. Repetitions alone need tens of days for them, Anderson's extrapolation a few. All
//! else that a run passes on (enthalpies, memory of phase-change cells) is found from the temperatures.

use crate::building::coefficients::Matter;
use crate::building::model::Model;
use crate::number::real::Real;
use crate::run::anderson::Anderson;
use crate::step::state::State;

/// Changes from one repetition to the next that are remembered.
const DEPTH: usize = 5;
/// Farthest that a temperature is extrapolated beyond the end of a repetition [K].
const FARTHEST: f64 = 30.0;
/// Humidity ratios and moisture contents are extrapolated up to this factor, and down by it.
const WETTEST: f64 = 2.0;
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
            *weight = zone.air_capacity.scale(LATENT / 1000.0 * LATENT / 1000.0).fixed();
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

/// What is known after some repetitions.
pub(super) struct PeriodicStart<S: Real> {
    anderson: Anderson<S>,
    /// End of the last repetition that was not rejected, and the square of its change.
    end: State<S>,
    square: S,
    /// Lanes that repetitions alone do not bring to their end in one more.
    slow: S::Mask,
    /// Lanes whose repetition started from an extrapolated state.
    extrapolated: S::Mask,
}

impl<S: Real> PeriodicStart<S> {
    pub(super) fn trace(&self) -> String {
        use crate::number::real::Mask;
        format!("slow {} extrapolated {} norm {:.4e}", self.slow.lane(0), self.extrapolated.lane(0), self.square.lane(0).sqrt())
    }
    /// Knows the first repetition, from `start` to `end`. The next one starts from its end.
    pub(super) fn new(model: &Model<'_, S>, start: &State<S>, end: &State<S>) -> Self {
        let [image, residual] = numbers(end, start);
        let mut metric = Vec::with_capacity(image.len());
        weights(model, end).write(&mut metric);
        let anderson = Anderson::new(metric, DEPTH, &image, &residual);
        let none = S::one().lt(S::zero());
        Self {
            square: anderson.square(&residual),
            anderson,
            end: end.clone(),
            slow: none,
            extrapolated: none,
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
        // An extrapolation that has made the change larger is taken back.
        let rejected = self.extrapolated & !square.lt(self.square);
        let kept = !rejected;
        self.anderson.learn(kept, &image, &residual);
        let allowed = S::constant(tolerance * tolerance) * self.square;
        self.slow = self.slow | !(change * change * square).lt(allowed);
        self.extrapolated = self.slow & kept;
        let mut next = self.end.clone();
        next.take(kept, end);
        self.end.take(kept, end);
        self.square = S::select(kept, square, self.square);
        let extrapolated = extrapolated(model, end, &self.anderson.next());
        next.take(self.extrapolated, &extrapolated);
        next
    }
}

/// A state whose temperatures and moisture contents are those of `numbers` within bounds, and all else goes with them.
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
