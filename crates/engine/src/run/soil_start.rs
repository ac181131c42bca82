//! Where a repeated first period leads slow soil: to the state that a period leaves as it is.
//!
//! Soil behind a floor follows what is around it in years, and with it the layers of the floor behind an insulation. After a period of
//! length `P` from cells at `x` to cells at `x'`, the mean over the period satisfies `K X = f - C (x' - x)/P` with the conductances `K` and
//! heat capacities `C` of its cells and the heat `f` that they get. With the same `f` nothing changes any more where all cells are warmer by
//! `r = M (x' - x)`, `M = K^-1 C/P`. This is exact for cells much slower than the period and too much for others: what is left to a cell
//! that relaxes in a time `m P` is `1/(exp(1/m) - 1)` of its change, which is `m - 1/2` where it is slow and nothing where it is fast. So the
//! cells are moved by `(M + 1/2)^-1 M r`, which is both. The zone counts as it is, behind the film of the floor, and so does what changes its
//! properties with temperature.

use crate::building::coefficients::{Matter, WallCoefficients};
use crate::building::model::Model;
use crate::number::real::Real;
use crate::step::state::State;

/// Resistance between the floor and its zone (ISO 6946:2017, heat flow downwards) [m2 K/W].
const FILM: f64 = 0.17;

/// A block of soil behind a floor, with the layers of the floor before it.
struct Soil<S> {
    first_cell: usize,
    /// Whether its cells pass enthalpies on.
    nonlinear: bool,
    /// Heat capacities of the cells: of their material [J/(m3 K)], and over the length of the first period [W/(m2 K)].
    capacities: Vec<S>,
    flows: Vec<S>,
    /// Conductances from what lies behind to the zone, one more than there are cells [W/(m2 K)].
    conductances: Vec<S>,
}

/// All blocks of soil of a building.
pub(super) struct SoilStart<S> {
    blocks: Vec<Soil<S>>,
}

impl<S: Real> SoilStart<S> {
    /// For a first period of a length [s].
    pub(super) fn new(model: &Model<'_, S>, period: f64) -> Self {
        let surfaces = model.plan.description.surfaces.iter().enumerate();
        let blocks = surfaces.filter(|(_, surface)| surface.soil.is_some()).map(|(w, _)| {
            let wall = &model.plan.walls[w];
            Soil::new(&model.coefficients.walls[w], (wall.first_cell, wall.nonlinear), period)
        });
        Self { blocks: blocks.collect() }
    }

    /// The state at the end of a period, with soil where it would stay, and how far the soil was moved at most [K]; none in a building
    /// without soil.
    pub(super) fn advance(&self, start: &State<S>, end: &State<S>) -> Option<(State<S>, S)> {
        if self.blocks.is_empty() {
            return None;
        }
        let (mut advanced, mut farthest) = (end.clone(), S::zero());
        for block in &self.blocks {
            let cells = block.first_cell..block.first_cell + block.capacities.len();
            let changes = start.cells[cells.clone()].iter().zip(&end.cells[cells.clone()]);
            let rises = block.rises(changes.map(|(&from, &to)| to - from).collect());
            for ((k, rise), &capacity) in cells.zip(rises).zip(&block.capacities) {
                advanced.cells[k] += rise;
                farthest = farthest.max(rise.abs());
                if block.nonlinear {
                    advanced.enthalpy[k] += rise * capacity;
                }
            }
        }
        Some((advanced, farthest))
    }
}

impl<S: Real> Soil<S> {
    /// The cells from what lies behind to the zone, or to the first layer whose properties change.
    fn new(wall: &WallCoefficients<S>, (first_cell, nonlinear): (usize, bool), period: f64) -> Self {
        let (mut capacities, mut flows, mut conductances) = (Vec::new(), Vec::new(), Vec::new());
        let mut resistance = S::zero();
        for (cell, &extra) in wall.cells.iter().zip(&wall.extra) {
            let Matter::Solid { conductivity, capacity } = cell.matter else { break };
            let half = (cell.thickness / conductivity).scale(0.5);
            conductances.push(S::one() / (resistance + extra + half));
            resistance = half;
            capacities.push(capacity);
            flows.push((capacity * cell.thickness).scale(1.0 / period));
        }
        resistance += wall.resistance_behind(capacities.len()) + S::constant(FILM);
        conductances.push(S::one() / resistance);
        Self { first_cell, nonlinear, capacities, flows, conductances }
    }

    /// How much warmer the cells become after changes over a period [K].
    fn rises(&self, changes: Vec<S>) -> Vec<S> {
        let nothing = vec![S::zero(); changes.len()];
        let heat = |rises: Vec<S>| rises.iter().zip(&self.flows).map(|(&rise, &flow)| rise * flow).collect();
        let steady = self.solve(&nothing, S::one(), heat(changes));
        self.solve(&self.flows, S::constant(0.5), heat(steady))
    }

    /// Temperatures by heat into the cells [W/m2], with conductances of each cell to 0 degC and a part of those between them.
    fn solve(&self, to_zero: &[S], part: S, mut heat: Vec<S>) -> Vec<S> {
        let links: Vec<S> = self.conductances.iter().map(|&conductance| part * conductance).collect();
        let mut pivots = Vec::with_capacity(heat.len());
        for i in 0..heat.len() {
            let mut pivot = links[i] + links[i + 1] + to_zero[i];
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

    /// Cells of some heat flows [W/(m2 K)] 1 m2 K/W apart.
    fn soil(flows: &[f64]) -> Soil<f64> {
        Soil {
            first_cell: 0,
            nonlinear: false,
            capacities: vec![1.0; flows.len()],
            flows: flows.to_vec(),
            conductances: vec![1.0; flows.len() + 1],
        }
    }

    /// Two cells between 0 degC behind and in the zone, 1 m2 K/W apart: with 1 W/m2 into the first one they are 2/3 and 1/3 K warmer.
    #[test]
    fn steady_rises_by_hand() {
        let rises = soil(&[1.0; 2]).solve(&[0.0; 2], 1.0, vec![1.0, 0.0]);
        for (found, expected) in rises.into_iter().zip([2.0 / 3.0, 1.0 / 3.0]) {
            assert!((found - expected).abs() < 1e-15, "{found} is not {expected}");
        }
    }

    /// A cell with links of 1 W/(m2 K) on both sides relaxes in `m = flow/2` periods. What is left to it after a change of 1 K is
    /// `1/(exp(1/m) - 1)`: within 0.1 K where it is fast, slow, or neither.
    #[test]
    fn a_cell_is_moved_by_what_is_left_to_it() {
        for flow in [0.02, 0.2, 1.0, 2.0, 5.0, 20.0, 200.0] {
            let rise = soil(&[flow]).rises(vec![1.0])[0];
            let left = 1.0 / (Real::exp(2.0 / flow) - 1.0);
            assert!((rise - left).abs() < 0.1, "{flow}: {rise} K, {left} K are left");
        }
    }
}
