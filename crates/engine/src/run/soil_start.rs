//! Where a repeated first period leads slow soil: to the state that a period leaves as it is.
//!
//! Soil behind a floor follows what is around it in years. After a period of length `P` from cells at `x` to cells at `x'`, the mean over the
//! period satisfies `K X = f - C (x' - x)/P` with the conductances `K` and heat capacities `C` of its cells and the heat `f` that they get.
//! With the same `f` nothing changes any more where all cells are warmer by `K^-1 C (x' - x)/P`. This is exact for cells much slower than
//! the period and nothing for much faster ones; the zone counts as it is, behind the floor and its film.

use crate::building::model::Model;
use crate::number::real::Real;
use crate::step::state::State;

/// Resistance between the floor and its zone (ISO 6946:2017, heat flow downwards) [m2 K/W].
const FILM: f64 = 0.17;

/// A block of soil behind a floor.
struct Soil<S> {
    first_cell: usize,
    /// Whether its cells pass enthalpies on.
    nonlinear: bool,
    /// Heat capacities of its cells [J/(m2 K)].
    capacities: Vec<f64>,
    /// Conductances from what lies behind to the zone, one more than there are cells [W/(m2 K)].
    conductances: Vec<S>,
}

/// All blocks of soil of a building.
pub(super) struct SoilStart<S> {
    blocks: Vec<Soil<S>>,
    /// Length of the first period [s].
    period: f64,
}

impl<S: Real> SoilStart<S> {
    /// For a first period of a length [s].
    pub(super) fn new(model: &Model<'_, S>, period: f64) -> Self {
        let mut blocks = Vec::new();
        for (w, surface) in model.plan.description.surfaces.iter().enumerate() {
            let Some(soil) = &surface.soil else { continue };
            let mut resistances: Vec<S> =
                soil.resistances.iter().map(|&resistance| S::constant(resistance)).collect();
            if let Some(last) = resistances.last_mut() {
                *last += model.coefficients.walls[w].resistance_behind(soil.capacities.len());
                *last += S::constant(FILM);
            }
            blocks.push(Soil {
                first_cell: model.plan.walls[w].first_cell,
                nonlinear: model.plan.walls[w].nonlinear,
                capacities: soil.capacities.clone(),
                conductances: resistances.into_iter().map(|resistance| S::one() / resistance).collect(),
            });
        }
        Self { blocks, period }
    }

    /// The state at the end of a period, with soil where it would stay; none in a building without soil.
    pub(super) fn advance(&self, start: &State<S>, end: &State<S>) -> Option<State<S>> {
        if self.blocks.is_empty() {
            return None;
        }
        let mut advanced = end.clone();
        for block in &self.blocks {
            let cells = block.first_cell..block.first_cell + block.capacities.len();
            let changes = start.cells[cells.clone()].iter().zip(&end.cells[cells.clone()]);
            let heat = changes.zip(&block.capacities);
            let heat = heat.map(|((&from, &to), &capacity)| (to - from).scale(capacity / self.period));
            let rises = block.rises(heat.collect());
            for ((k, rise), &capacity) in cells.zip(rises).zip(&block.capacities) {
                advanced.cells[k] += rise;
                if block.nonlinear {
                    // Cells of soil are one metre thick.
                    advanced.enthalpy[k] += rise.scale(capacity);
                }
            }
        }
        Some(advanced)
    }
}

impl<S: Real> Soil<S> {
    /// How much warmer the cells become in a steady state by heat into them [W/m2].
    fn rises(&self, mut heat: Vec<S>) -> Vec<S> {
        let links = &self.conductances;
        let mut pivots = Vec::with_capacity(heat.len());
        for i in 0..heat.len() {
            let mut pivot = links[i] + links[i + 1];
            if i > 0 {
                let share = links[i] / pivots[i - 1];
                pivot = pivot - share * links[i];
                let passed = share * heat[i - 1];
                heat[i] += passed;
            }
            pivots.push(pivot);
        }
        for i in (0..heat.len()).rev() {
            if i + 1 < heat.len() {
                let passed = links[i + 1] * heat[i + 1];
                heat[i] += passed;
            }
            heat[i] = heat[i] / pivots[i];
        }
        heat
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two cells between 0 degC behind and in the zone, 1 m2 K/W apart: with 1 W/m2 into the first one they are 2/3 and 1/3 K warmer.
    #[test]
    fn steady_rises_by_hand() {
        let soil =
            Soil { first_cell: 0, nonlinear: false, capacities: vec![1.0; 2], conductances: vec![1.0; 3] };
        for (found, expected) in soil.rises(vec![1.0_f64, 0.0]).into_iter().zip([2.0 / 3.0, 1.0 / 3.0]) {
            assert!((found - expected).abs() < 1e-15, "{found} is not {expected}");
        }
    }
}
