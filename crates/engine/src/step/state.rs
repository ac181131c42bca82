//! What passes from step to step, and what a run starts from.

use crate::building::coefficients::Matter;
use crate::building::coefficients::humidity::VapourSurface;
use crate::building::ids::BySide;
use crate::building::model::Model;
use crate::building::plan::Plan;
use crate::error::EngineError;
use crate::linear::unknowns::Temperatures;
use crate::number::real::{Chunk, ChunkTask, Real};
use crate::number::simd::WIDTH;
use crate::physics::pcm::{HISTORY_NUMBERS, PcmHistory};
use crate::physics::psychrometrics::{humidity_ratio, saturation_pressure};

/// Temperatures that a run starts from [degC], the same for all members; phase-change materials have been heated to them.
#[derive(Debug, Clone, PartialEq)]
pub enum Initial {
    /// One temperature everywhere.
    Everywhere(f64),
    /// One for each cell, surface and air.
    Given {
        /// Of the cells of all walls.
        cells: Vec<f64>,
        /// Of the surfaces: the first guess of their balance.
        surfaces: Vec<f64>,
        /// Of the airs of the zones.
        air: Vec<f64>,
    },
}

impl Initial {
    /// Whether it is one temperature everywhere, however it is written.
    pub(crate) fn is_uniform(&self) -> bool {
        let Self::Given { cells, surfaces, air } = self else { return true };
        let mut all = cells.iter().chain(surfaces).chain(air);
        let first = all.next();
        all.all(|temperature| Some(temperature) == first)
    }

    /// Checks that it fits a plan.
    pub(crate) fn check(&self, plan: &Plan) -> Result<(), EngineError> {
        let Self::Given { cells, surfaces, air } = self else { return Ok(()) };
        let expected = [
            ("cells", cells, plan.n_cells),
            ("faces", surfaces, plan.surfaces.len()),
            ("airs", air, plan.zones.len()),
        ];
        for (what, given, count) in expected {
            if given.len() != count || given.iter().any(|temperature| !temperature.is_finite()) {
                return Err(EngineError::Input(format!(
                    "the start gives temperatures for {} {what}, expected {count} finite ones",
                    given.len()
                )));
            }
        }
        Ok(())
    }
}

/// A change of a humidity ratio counts as this change of a temperature, by the latent heat over the specific heat of air [K].
const AS_KELVIN: f64 = 2500.0;
/// A relative change of a moisture content counts as this change of a temperature [K]: with 0.01 K, a content is periodic within 0.1 %.
const CONTENT_AS_KELVIN: f64 = 10.0;

/// Time since controls have closed at the start of a run: no time that they have to stay closed is as long [s].
const LONG_AGO: f64 = 1e12;

/// Everything that passes from step to step.
#[derive(Debug, Clone)]
pub struct State<S> {
    /// Cell temperatures of all walls [degC].
    pub cells: Vec<S>,
    /// Enthalpies of the cells of nonlinear walls [J/m3]; those of others are the capacity times the temperature.
    pub enthalpy: Vec<S>,
    /// Memory of the cells: their history, as far as the laws depend on it.
    pub memory: Vec<PcmHistory<S>>,
    /// Surface temperatures [degC].
    pub surfaces: BySide<S>,
    /// Zone air temperatures [degC].
    pub air: Vec<S>,
    /// Ideal load of each zone, mean over the step that ended here [W]; cooling is negative.
    pub load: Vec<S>,
    /// Humidity ratio of each zone [kg/kg], then the moisture contents of the first and the second layer of each surface that takes up
    /// vapour [kg/m2]; empty in a building without vapour balances.
    pub vapour: Vec<S>,
    /// Whether each control of openings lets them open: 1 or 0.
    pub opened: Vec<S>,
    /// Time since each control has opened or closed [s].
    pub unchanged: Vec<S>,
}

impl<S: Real> State<S> {
    /// The state that a run starts from, in the weather of a forcing row.
    pub(crate) fn new(model: &Model<'_, S>, initial: &Initial, row: &[f64]) -> Self {
        let plan = model.plan;
        let (cells, surfaces, air) = match initial {
            Initial::Everywhere(temperature) => {
                let all = |count| vec![S::constant(*temperature); count];
                (all(plan.n_cells), all(plan.surfaces.len()), all(plan.zones.len()))
            }
            Initial::Given { cells, surfaces, air } => {
                let all = |given: &[f64]| given.iter().map(|&temperature| S::constant(temperature)).collect();
                (all(cells), all(surfaces), all(air))
            }
        };
        let mut state = Self {
            memory: cells.iter().map(|&cell| PcmHistory::new(S::zero(), cell)).collect(),
            enthalpy: vec![S::zero(); plan.n_cells],
            load: vec![S::zero(); plan.zones.len()],
            vapour: vapour_at(model, &air, row),
            opened: vec![S::zero(); plan.description.controls.len()],
            unchanged: vec![S::constant(LONG_AGO); plan.description.controls.len()],
            cells,
            surfaces: surfaces.into(),
            air,
        };
        state.set_enthalpies(model);
        state
    }

    /// Lets what the airs cannot hold at a pressure [Pa] condense: the state that a record starts from belongs to other weather, that at the end of
    /// the repeated period or of the run before.
    #[inline(never)]
    pub(crate) fn condense(&mut self, pressure: S) {
        for (ratio, &air) in self.vapour.iter_mut().zip(&self.air) {
            *ratio = ratio.min(humidity_ratio(saturation_pressure(air), pressure));
        }
    }

    /// Enthalpies and memory that belong to the temperatures, in the nonlinear walls.
    fn set_enthalpies(&mut self, model: &Model<'_, S>) {
        for &w in &model.parts.nonlinear_walls {
            let (wall, first_cell) = (&model.coefficients.walls[w], model.plan.walls[w].first_cell);
            for (i, cell) in wall.cells.iter().enumerate() {
                let k = first_cell + i;
                match &cell.matter {
                    Matter::Solid { capacity, .. } => {
                        self.enthalpy[k] = *capacity * self.cells[k];
                    }
                    Matter::Pcm(law) => {
                        let law = &wall.pcm[*law];
                        self.memory[k] = law.begin(self.cells[k]);
                        self.enthalpy[k] = law.at(self.cells[k], &self.memory[k]).enthalpy;
                    }
                }
            }
        }
    }

    /// Changes the enthalpies and the memory of the cells of nonlinear walls, which are those of another state, as the change of their
    /// temperatures since then does. A cell whose enthalpy depends on the path gets the temperature of that state.
    pub(crate) fn move_heat(&mut self, model: &Model<'_, S>, from: &Self) {
        for &w in &model.parts.nonlinear_walls {
            let (wall, first_cell) = (&model.coefficients.walls[w], model.plan.walls[w].first_cell);
            for (k, cell) in (first_cell..).zip(&wall.cells) {
                let (before, now) = (from.cells[k], self.cells[k]);
                let heat = match &cell.matter {
                    Matter::Solid { capacity, .. } => *capacity * (now - before),
                    Matter::Pcm(law) if wall.pcm[*law].has_history() => {
                        self.cells[k] = before;
                        S::zero()
                    }
                    Matter::Pcm(law) => {
                        let law = &wall.pcm[*law];
                        let [before, point] = [before, now].map(|at| law.at(at, &from.memory[k]));
                        self.memory[k] = law.next(&from.memory[k], now, point.liquid_fraction, 0.0);
                        point.enthalpy - before.enthalpy
                    }
                };
                self.enthalpy[k] = from.enthalpy[k] + heat;
            }
        }
    }

    /// Magnitudes of the heat in all cells and airs above 0 degC, or above the reference of a law, summed up [J].
    pub(crate) fn heat_content(&self, model: &Model<'_, S>) -> S {
        let mut content = S::zero();
        for (wall, numbers) in model.plan.walls.iter().zip(&model.coefficients.walls) {
            for (k, cell) in (wall.first_cell..).zip(&numbers.cells) {
                let enthalpy = match &cell.matter {
                    Matter::Solid { capacity, .. } => *capacity * self.cells[k],
                    Matter::Pcm(_) => self.enthalpy[k],
                };
                content += numbers.area * cell.thickness * enthalpy.abs();
            }
        }
        for (air, zone) in self.air.iter().zip(&model.coefficients.zones) {
            content += zone.capacity * air.abs();
        }
        content
    }

    #[inline(always)]
    pub(crate) fn view(&self) -> Temperatures<'_, S> {
        Temperatures { cells: &self.cells, surfaces: &self.surfaces, air: &self.air }
    }

    /// All but the memory.
    #[inline(always)]
    fn plain(&self) -> [&[S]; 8] {
        let Self { cells, enthalpy, surfaces, air, load, vapour, opened, unchanged, .. } = self;
        [cells, enthalpy, surfaces, air, load, vapour, opened, unchanged]
    }

    /// All its numbers, one after the other.
    pub(crate) fn write(&self, numbers: &mut Vec<S>) {
        for values in self.plain() {
            numbers.extend_from_slice(values);
        }
        for memory in &self.memory {
            numbers.extend_from_slice(&memory.numbers());
        }
    }

    /// Changes each number by one of others, in the order of [`Self::write`].
    #[inline(always)]
    pub(crate) fn read<T: Copy>(&mut self, mut numbers: &[T], mut change: impl FnMut(&mut S, T)) {
        let Self { cells, enthalpy, memory, surfaces, air, load, vapour, opened, unchanged } = self;
        for values in [&mut cells[..], enthalpy, surfaces, air, load, vapour, opened, unchanged] {
            let (own, rest) = numbers.split_at(values.len());
            numbers = rest;
            for (mine, &theirs) in values.iter_mut().zip(own) {
                change(mine, theirs);
            }
        }
        let (all, _) = numbers.as_chunks::<HISTORY_NUMBERS>();
        for (memory, numbers) in memory.iter_mut().zip(all) {
            memory.read(numbers, &mut change);
        }
    }

    /// Passes each number with one of others to a function, in the order of [`Self::write`].
    #[inline(always)]
    pub(crate) fn zip_with<T: Copy>(&self, mut numbers: &[T], mut see: impl FnMut(S, T)) {
        for values in self.plain() {
            let (own, rest) = numbers.split_at(values.len());
            numbers = rest;
            for (&mine, &theirs) in values.iter().zip(own) {
                see(mine, theirs);
            }
        }
        let (all, _) = numbers.as_chunks::<HISTORY_NUMBERS>();
        for (memory, numbers) in self.memory.iter().zip(all) {
            for (mine, &theirs) in memory.numbers().into_iter().zip(numbers) {
                see(mine, theirs);
            }
        }
    }

    /// Copies another state.
    pub(crate) fn copy_from(&mut self, other: &Self) {
        self.cells.copy_from_slice(&other.cells);
        self.enthalpy.copy_from_slice(&other.enthalpy);
        self.surfaces.copy_from_slice(&other.surfaces);
        self.air.copy_from_slice(&other.air);
        self.load.copy_from_slice(&other.load);
        self.vapour.copy_from_slice(&other.vapour);
        self.opened.copy_from_slice(&other.opened);
        self.unchanged.copy_from_slice(&other.unchanged);
        self.memory.copy_from_slice(&other.memory);
    }

    /// How many numbers it has.
    pub(crate) fn count(&self) -> usize {
        self.plain().into_iter().map(<[S]>::len).sum::<usize>() + HISTORY_NUMBERS * self.memory.len()
    }

    /// Changes each number by the one at its place in another state.
    pub(crate) fn change_by<T: Real>(&mut self, other: &State<T>, mut change: impl FnMut(&mut S, T)) {
        let plain = [
            (&mut self.cells[..], &other.cells[..]),
            (&mut self.enthalpy, &other.enthalpy),
            (&mut self.surfaces, &other.surfaces),
            (&mut self.air, &other.air),
            (&mut self.load, &other.load),
            (&mut self.vapour, &other.vapour),
            (&mut self.opened, &other.opened),
            (&mut self.unchanged, &other.unchanged),
        ];
        for (mine, theirs) in plain {
            for (mine, &theirs) in mine.iter_mut().zip(theirs) {
                change(mine, theirs);
            }
        }
        for (mine, theirs) in self.memory.iter_mut().zip(&other.memory) {
            mine.read(&theirs.numbers(), &mut change);
        }
    }

    /// Copies the lanes of `other` where the mask is true.
    #[inline(always)]
    pub fn take(&mut self, mask: S::Mask, other: &Self) {
        blend(mask, &mut self.cells, &other.cells);
        blend(mask, &mut self.enthalpy, &other.enthalpy);
        blend(mask, &mut self.surfaces, &other.surfaces);
        blend(mask, &mut self.air, &other.air);
        blend(mask, &mut self.load, &other.load);
        blend(mask, &mut self.vapour, &other.vapour);
        blend(mask, &mut self.opened, &other.opened);
        blend(mask, &mut self.unchanged, &other.unchanged);
        for (a, b) in self.memory.iter_mut().zip(&other.memory) {
            a.take(mask, b);
        }
    }

    /// The lowest and the highest of all temperatures [degC].
    // One copy only.
    #[inline(never)]
    pub(crate) fn extremes(&self) -> [S; 2] {
        S::vectorised(
            #[inline(always)]
            || S::in_chunks(Extremes(self)),
        )
    }

    /// Largest change of a cell or an air against another state [K]; of humidity, see `AS_KELVIN` and `CONTENT_AS_KELVIN`.
    #[inline(always)]
    pub fn distance(&self, other: &Self) -> S {
        let pairs = self.cells.iter().zip(&other.cells).chain(self.air.iter().zip(&other.air));
        let mut largest = pairs.fold(S::zero(), |largest, (a, b)| largest.max((*a - *b).abs()));
        let zones = self.air.len();
        for (k, (&a, &b)) in self.vapour.iter().zip(&other.vapour).enumerate() {
            let change = (a - b).abs();
            let as_kelvin = if k < zones {
                change.scale(AS_KELVIN)
            } else {
                change.scale(CONTENT_AS_KELVIN) / a.abs().max(S::constant(f64::MIN_POSITIVE))
            };
            largest = largest.max(as_kelvin);
        }
        largest
    }
}

/// The lowest and the highest temperature of a state, of neighbours at once: every step asks for them.
struct Extremes<'r, S>(&'r State<S>);

impl<S: Real> ChunkTask<S> for Extremes<'_, S> {
    type Output = [S; 2];
    #[inline(always)]
    fn run<V: Chunk<S>>(self) -> [S; 2] {
        let wider = |[low, high]: [S; 2], temperature: S| [low.min(temperature), high.max(temperature)];
        let mut all = [S::constant(f64::INFINITY), S::constant(f64::NEG_INFINITY)];
        let [mut low, mut high]: [V; 2] = all.map(V::filled);
        for temperatures in [&self.0.cells[..], &self.0.surfaces, &self.0.air] {
            let chunks = temperatures.chunks_exact(S::CHUNK);
            all = chunks.remainder().iter().copied().fold(all, wider);
            for chunk in chunks {
                let chunk = V::load(chunk);
                (low, high) = (low.min(chunk), high.max(chunk));
            }
        }
        let mut parts = [S::zero(); WIDTH];
        let parts = &mut parts[..S::CHUNK];
        low.store(parts);
        all[0] = parts.iter().copied().fold(all[0], S::min);
        high.store(parts);
        all[1] = parts.iter().copied().fold(all[1], S::max);
        all
    }
}

/// Humidity ratios and moisture contents at the relative humidity that the building starts from, with airs at temperatures [degC], at the
/// pressure of a forcing row.
fn vapour_at<S: Real>(model: &Model<'_, S>, air: &[S], row: &[f64]) -> Vec<S> {
    let Some(humidity) = &model.coefficients.humidity else { return Vec::new() };
    let pressure = humidity.pressure_in(row);
    let ratio = |&air: &S| humidity_ratio(humidity.initial * saturation_pressure(air), pressure);
    let content = |surface: &VapourSurface<S>| {
        let layers = &surface.layers;
        let content = layers.isotherm.content(humidity.initial);
        [layers.depths[0] * content, if layers.two { layers.depths[1] * content } else { S::zero() }]
    };
    air.iter().map(ratio).chain(humidity.surfaces.iter().flat_map(content)).collect()
}

/// Copies `theirs` where the mask is true.
#[inline(always)]
pub(crate) fn blend<S: Real>(mask: S::Mask, mine: &mut [S], theirs: &[S]) {
    for (a, &b) in mine.iter_mut().zip(theirs) {
        *a = S::select(mask, b, *a);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::building::ids::SideId;

    /// Wherever they are: among 19 cells, 10 surfaces or 3 airs, of which registers hold eight.
    #[test]
    fn extremes_of_a_state() {
        let nothing = PcmHistory::new(0.0, 20.0);
        let state = State {
            cells: vec![20.0; 19],
            enthalpy: vec![0.0; 19],
            memory: vec![nothing; 19],
            surfaces: vec![20.0; 10].into(),
            air: vec![20.0; 3],
            load: vec![0.0; 3],
            vapour: Vec::new(),
            opened: Vec::new(),
            unchanged: Vec::new(),
        };
        assert_eq!(state.extremes(), [20.0; 2]);
        for place in 0..32 {
            for (temperature, expected) in [(-30.0, [-30.0, 20.0]), (60.0, [20.0, 60.0])] {
                let mut state = state.clone();
                match place {
                    0..19 => state.cells[place] = temperature,
                    19..29 => state.surfaces[SideId::from_index(place - 19)] = temperature,
                    _ => state.air[place - 29] = temperature,
                }
                assert_eq!(state.extremes(), expected, "{place}");
            }
        }
    }
}
