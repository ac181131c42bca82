//! The residual of each balance: heat in less heat stored [W], which is zero at the solution.

use crate::building::coefficients::Coefficients;
use crate::building::ids::{BySide, SideId};
use crate::building::model::Model;
use crate::linear::building_system::is_held;
use crate::number::real::Real;

use super::evaluation::{Evaluation, HeatSink};
use super::{Balances, Node, Stage};

/// Residuals as heat flow densities, and the largest heat flow density of the building [W/m2].
#[derive(Debug, Clone)]
pub(crate) struct Residual<S> {
    pub(crate) cells: Vec<S>,
    /// Of surfaces held at a temperature: how far they are from it [K].
    pub(crate) surfaces: BySide<S>,
    /// Over the area of the surfaces of the zone.
    pub(crate) air: Vec<S>,
    pub(crate) largest_flow: S,
}

impl<S: Real> Residual<S> {
    /// The largest residual of a balance as heat [W]. Infinite where one is not a number. Surfaces held at a temperature have
    /// no balance.
    pub(crate) fn largest_heat(&self, model: &Model<'_, S>) -> S {
        let coefficients = &model.coefficients;
        let mut largest = S::zero();
        let mut add = |density: S, area: S| {
            let heat = (density * area).abs();
            largest =
                largest.max(S::select(heat.lt(S::constant(f64::MAX)), heat, S::constant(f64::INFINITY)));
        };
        for (w, wall) in coefficients.walls.iter().enumerate() {
            for &cell in &self.cells[model.cells(w)] {
                add(cell, wall.area);
            }
        }
        for (surface, &density) in self.surfaces.entries() {
            if !is_held(model, surface) {
                add(density, coefficients.walls[surface.wall()].area);
            }
        }
        for (&density, zone) in self.air.iter().zip(&coefficients.zones) {
            add(density, zone.areas.iter().fold(S::zero(), |sum, &area| sum + area));
        }
        largest
    }

    /// The largest of all residuals.
    #[cfg(test)]
    pub(crate) fn largest(&self) -> S {
        let all = self.cells.iter().chain(&self.surfaces).chain(&self.air);
        // A residual that is no number is larger than all others.
        all.fold(S::zero(), |largest, residual| {
            let magnitude = residual.abs();
            S::select(magnitude.lt(largest), largest, magnitude)
        })
    }
}

/// Sums up what flows into each node.
struct Imbalance<'a, S> {
    coefficients: &'a Coefficients<S>,
    wall_of_cell: Vec<usize>,
    temperatures: &'a BySide<S>,
    residual: Residual<S>,
    held: Vec<(SideId, S)>,
}

impl<S: Real> Imbalance<'_, S> {
    fn area(&self, node: Node) -> S {
        match node {
            Node::Cell(cell) => self.coefficients.walls[self.wall_of_cell[cell]].area,
            Node::Surface(surface) => self.coefficients.walls[surface.wall()].area,
            Node::Air(zone) => {
                let areas = &self.coefficients.zones[zone].areas;
                areas.iter().fold(S::zero(), |sum, &area| sum + area)
            }
        }
    }
}

impl<S: Real> HeatSink<S> for Imbalance<'_, S> {
    fn add_to_node(&mut self, node: Node, _size: S, heat: S) {
        let density = heat / self.area(node);
        self.residual.largest_flow = self.residual.largest_flow.max(density.abs());
        match node {
            Node::Cell(cell) => self.residual.cells[cell] += density,
            Node::Surface(surface) => self.residual.surfaces[surface] += density,
            Node::Air(zone) => self.residual.air[zone] += density,
        }
    }

    fn impose(&mut self, surface: SideId, _area: S, temperature: S) {
        self.held.push((surface, temperature - self.temperatures[surface]));
    }
}

impl<S: Real> Balances<'_, S> {
    /// The residuals of a stage at temperatures [degC].
    pub(crate) fn residual(
        &self,
        stage: &Stage<'_, S>,
        cells: &[S],
        surfaces: &BySide<S>,
        air: &[S],
    ) -> Residual<S> {
        let plan = self.model.plan;
        let zeros = |count: usize| vec![S::zero(); count];
        let walls = plan.walls.iter().enumerate();
        let heat = Imbalance {
            coefficients: &self.model.coefficients,
            wall_of_cell: walls.flat_map(|(w, wall)| core::iter::repeat_n(w, wall.len())).collect(),
            temperatures: surfaces,
            residual: Residual {
                cells: zeros(plan.n_cells),
                surfaces: zeros(plan.surfaces.len()).into(),
                air: zeros(plan.zones.len()),
                largest_flow: S::zero(),
            },
            held: Vec::new(),
        };
        let mut evaluation = Evaluation { cells, surfaces, air, heat };
        self.visit(stage, &mut evaluation);
        let Imbalance { mut residual, held, .. } = evaluation.heat;
        for (surface, missing) in held {
            residual.surfaces[surface] = missing;
        }
        residual
    }
}
