//! The residual of the stages of a step, on demand: the heat balances at the solution, all laws evaluated there.
//!
//! Newton's iteration estimates it from its last change. The residual of the balances measures the error of a solution
//! independently of the iteration.

use crate::balance::flow_index::FlowIndex;
use crate::balance::terms::{self, Balances, Contents};
use crate::linear::unknowns::Unknowns;
use crate::linear::wall::Storage;
use crate::number::real::Real;
use crate::step::newton::StageSolver;
use crate::step::stage::Stage;

/// Residuals of the stages of a step.
#[derive(Debug, Clone)]
pub(crate) struct StageResiduals<S> {
    /// Cells [degC], enthalpies [J/m3] and airs [degC] at the end of the first stage.
    first: [Vec<S>; 3],
    /// Cells at the end of the last stage [degC].
    pub(super) cells: Vec<S>,
    /// Largest residual of each stage [W].
    pub(super) stages: [S; 2],
    /// Largest residual of each stage over its largest heat flow density [-].
    #[cfg(test)]
    pub(super) relative: [S; 2],
    /// Of all stages so far, with the laws as linearised for the last linear solve: the largest residual over the largest heat
    /// flow density [-]; and how many stages these were.
    #[cfg(test)]
    pub(super) linear: (S, usize),
}

impl<S: Real> Default for StageResiduals<S> {
    fn default() -> Self {
        Self {
            first: Default::default(),
            cells: Vec::new(),
            stages: [S::zero(); 2],
            #[cfg(test)]
            relative: [S::zero(); 2],
            #[cfg(test)]
            linear: (S::zero(), 0),
        }
    }
}

impl<S: Real> StageResiduals<S> {
    /// Evaluates the stage just solved.
    pub(super) fn record(
        &mut self,
        solver: &StageSolver<'_, S>,
        flows: &FlowIndex<S>,
        stage: &Stage<'_, S>,
        ratio: f64,
    ) {
        let (model, state, index) = (stage.model, stage.state, stage.index());
        let start = Contents { cells: &state.cells, enthalpy: &state.enthalpy, air: &state.air };
        let [cells, enthalpy, air] = &self.first;
        let (ratio, first) =
            if index > 0 { (ratio, Contents { cells, enthalpy, air }) } else { (0.0, start) };
        let held = terms::Stage { length: stage.length, ratio, start, first };
        let cells = solved_cells(solver, stage, start.cells, first.cells, ratio);
        let Unknowns { surfaces, air, .. } = &solver.solution;
        let (mut linearisation, mut walls) = (solver.linearisation.clone(), solver.system.walls.clone());
        #[cfg(test)]
        {
            let mut laws = linearisation.laws.clone();
            solver.system.zone_fronts.laws_in_zones(&mut laws.surfaces);
            let (conditions, load) = (stage.conditions, &solver.start.load);
            let balances = Balances { model, index: flows, conditions, walls: &walls, laws: &laws, load };
            let residual = balances.residual(&held, &cells, surfaces, air);
            let relative = residual.largest() / residual.largest_flow;
            let (largest, stages) = self.linear;
            self.linear = (S::select(relative.lt(largest), largest, relative), stages + 1);
        }
        let at = Unknowns { cells: cells.clone(), surfaces: surfaces.clone(), air: air.clone() };
        for &w in &model.parts.nonlinear_walls {
            linearisation.linearise_wall(stage, w, (&at, None), &mut walls[w]);
        }
        linearisation.set_wind(model, stage.conditions, true);
        linearisation.linearise_surfaces(model, stage.conditions, &at, true);
        let balances = Balances {
            model,
            index: flows,
            conditions: stage.conditions,
            walls: &walls,
            laws: &linearisation.laws,
            load: &solver.start.load,
        };
        let residual = balances.residual(&held, &cells, surfaces, air);
        #[cfg(test)]
        {
            self.relative[index] = residual.largest() / residual.largest_flow;
        }
        self.stages[index] = residual.largest_heat(model);
        if index == 0 {
            let mut enthalpy = state.enthalpy.clone();
            for &w in &model.parts.nonlinear_walls {
                let reached = solver.system.walls[w].storage.iter().map(Storage::at_solution);
                for (enthalpy, reached) in enthalpy[model.cells(w)].iter_mut().zip(reached) {
                    *enthalpy = reached;
                }
            }
            self.first = [cells.clone(), enthalpy, air.clone()];
        }
        self.cells = cells;
    }
}

/// Temperatures of all cells at the end of the stage just solved. Those of linear walls follow from what they start from,
/// `start + ratio (first - start)`, and the surfaces.
fn solved_cells<S: Real>(
    solver: &StageSolver<'_, S>,
    stage: &Stage<'_, S>,
    start: &[S],
    first: &[S],
    ratio: f64,
) -> Vec<S> {
    let model = stage.model;
    let mut cells = solver.solution.cells.clone();
    for &w in &model.parts.linear_walls {
        let (range, chain) = (model.cells(w), &solver.system.walls[w]);
        let from = start[range.clone()].iter().zip(&first[range.clone()]);
        let from = from.map(|(&a, &b)| a + (b - a).scale(ratio));
        let laws = chain.storage.iter().zip(&chain.rate);
        let mut heat: Vec<S> =
            from.zip(laws).map(|(from, (cell, &rate))| cell.capacity * from * rate).collect();
        for &(source, cell) in &model.plan.walls[w].planes {
            heat[cell] += stage.conditions.heat_sources[source].heat;
        }
        let mut known = vec![S::zero(); range.len()];
        chain.heat_changes(&heat, &mut known);
        chain.temperature_changes(&known, solver.solution.surfaces.pair(w), &mut cells[range]);
    }
    cells
}
