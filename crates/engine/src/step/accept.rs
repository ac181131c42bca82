//! The end of a step: the last stage becomes the new state, and the ledger receives the heat of the step.

use crate::balance::energy_balance::{EnergyBalance, Power};
use crate::building::coefficients::Matter;
use crate::building::model::Model;
use crate::linear::wall::{StorageRule, WallSystem};
use crate::number::real::Real;
use crate::physics::pcm::reversed;
use crate::step::scheme::Scheme;
use crate::step::stage_histories::StageHistories;
use crate::step::state::State;
use crate::step::stepper::Stepper;

impl<S: Real> Stepper<'_, S> {
    /// Takes the last stage of a step of a length [s] as the new state.
    #[inline(always)]
    pub(super) fn accept(
        &mut self,
        state: &mut State<S>,
        energy: &Power<S>,
        length: f64,
        energy_balance: &mut EnergyBalance<S>,
    ) {
        let Self { model, scheme, solver, histories, .. } = &mut *self;
        let mut stored =
            solver.system.transition_matrices.finish(&solver.solution.surfaces, &mut state.cells);
        let reached = Reached {
            walls: &solver.system.walls,
            cells: &solver.solution.cells,
            first_fraction: &solver.start.first_fraction,
            histories,
            length,
        };
        let mut in_walls = S::zero();
        let reversals = accept_nonlinear(
            model,
            *scheme,
            &reached,
            state,
            #[inline(always)]
            |[area, thickness], [before, after]| in_walls += area * thickness * (after - before),
        );
        stored += in_walls;
        solver.counters.reversals += reversals;
        let solution = &self.solver.solution;
        for (zone, numbers) in self.model.coefficients.zones.iter().enumerate() {
            stored += numbers.capacity * (solution.air[zone] - state.air[zone]);
        }
        state.surfaces.copy_from_slice(&solution.surfaces);
        state.air.copy_from_slice(&solution.air);
        state.load.copy_from_slice(&self.solver.start.load);
        if let (Some(residuals), Some(largest)) =
            (&self.residuals, &mut self.solver.counters.largest_residual)
        {
            *largest = residuals.stages.iter().fold(*largest, |largest, &residual| largest.max(residual));
        }
        energy_balance.add_step(energy, stored);
    }
}

/// What the last stage of a step has reached in the nonlinear walls.
pub(super) struct Reached<'r, S> {
    /// As linearised for the last solution.
    pub(super) walls: &'r [WallSystem<S>],
    /// Temperatures of the cells [degC].
    pub(super) cells: &'r [S],
    /// Liquid fractions of the cells at the first stage of the step [-].
    pub(super) first_fraction: &'r [S],
    /// Histories of the cells in the last stage.
    pub(super) histories: &'r StageHistories<S>,
    /// Length of the step [s].
    pub(super) length: f64,
}

/// Cells of the nonlinear walls at the end of the last stage, and their memory; how many cells have melted and frozen in the step.
/// `store` is given the area and thickness of each cell, and its enthalpy before and after: whoever balances heat adds it up.
#[inline(always)]
pub(super) fn accept_nonlinear<S: Real>(
    model: &Model<'_, S>,
    scheme: Scheme,
    reached: &Reached<'_, S>,
    state: &mut State<S>,
    mut store: impl FnMut([S; 2], [S; 2]),
) -> S {
    let apparent = scheme.tableau().storage == StorageRule::ApparentCapacity;
    let stages = scheme.weights().len();
    let mut reversals = S::zero();
    for &w in &model.parts.nonlinear_walls {
        let (wall, chain, numbers) = (&model.plan.walls[w], &reached.walls[w], &model.coefficients.walls[w]);
        for (i, cell) in numbers.cells.iter().enumerate() {
            let k = wall.first_cell + i;
            let temperature = reached.cells[k];
            let mut enthalpy = chain.storage[i].at_solution();
            if let Matter::Pcm(law) = cell.matter {
                let law = &numbers.pcm[law];
                let mut fraction = chain.fraction_at_solution(i);
                // Where the history matters: the point itself.
                if law.has_history() || apparent {
                    let point = law.at(temperature, &reached.histories.within(state)[k]);
                    fraction = point.liquid_fraction;
                    if apparent {
                        // What the material stores, which differs from what the scheme has counted.
                        enthalpy = point.enthalpy;
                    }
                }
                if law.has_history() && stages > 1 {
                    let start = state.memory[k].liquid_fraction;
                    let turned = reversed(start, reached.first_fraction[k], fraction);
                    reversals += S::select(turned, S::one(), S::zero());
                }
                state.memory[k] = law.next(&state.memory[k], temperature, fraction, reached.length);
            }
            store([numbers.area, cell.thickness], [state.enthalpy[k], enthalpy]);
            state.enthalpy[k] = enthalpy;
            state.cells[k] = temperature;
        }
    }
    reversals
}
