//! The end of a step: the last stage becomes the new state, and the ledger receives the heat of the step.

use crate::balance::ledger::{Ledger, Power};
use crate::building::coefficients::Matter;
use crate::linear::wall::StorageRule;
use crate::number::real::Real;
use crate::physics::pcm::reversed;
use crate::step::state::State;
use crate::step::stepper::Stepper;

impl<S: Real> Stepper<'_, S> {
    /// Takes the last stage as the new state.
    #[inline(always)]
    pub(super) fn accept(&mut self, state: &mut State<S>, energy: &Power<S>, ledger: &mut Ledger<S>) {
        let solver = &self.solver;
        let mut stored = solver.system.step_maps.finish(&solver.solution.surfaces, &mut state.cells);
        stored += self.accept_nonlinear(state);
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
        ledger.add_step(energy, stored);
    }

    /// Cells of the nonlinear walls at the end of the last stage, and their memory; the heat stored [J].
    #[inline(always)]
    pub(super) fn accept_nonlinear(&mut self, state: &mut State<S>) -> S {
        let apparent = self.scheme.tableau().storage == StorageRule::ApparentCapacity;
        let stages = self.scheme.weights().len();
        let (model, solver) = (&self.model, &mut self.solver);
        let mut stored = S::zero();
        for &w in &model.parts.nonlinear_walls {
            let (wall, chain, numbers) =
                (&model.plan.walls[w], &solver.system.walls[w], &model.coefficients.walls[w]);
            for (i, cell) in numbers.cells.iter().enumerate() {
                let k = wall.first_cell + i;
                let temperature = solver.solution.cells[k];
                let mut enthalpy = chain.storage[i].at_solution();
                if let Matter::Pcm(law) = cell.matter {
                    let law = &numbers.pcm[law];
                    let mut fraction = chain.fraction_at_solution(i);
                    // Where the history matters: the point itself.
                    if law.remembers() || apparent {
                        let point = law.at(temperature, &state.memory[k]);
                        fraction = point.liquid_fraction;
                        if apparent {
                            // What the material stores, which differs from what the scheme has counted.
                            enthalpy = point.enthalpy;
                        }
                    }
                    if law.remembers() && stages > 1 {
                        let start = state.memory[k].liquid_fraction;
                        let turned = reversed(start, solver.start.first_fraction[k], fraction);
                        solver.counters.reversals += S::select(turned, S::one(), S::zero());
                    }
                    state.memory[k] = law.next(&state.memory[k], temperature, fraction);
                }
                stored += numbers.area * cell.thickness * (enthalpy - state.enthalpy[k]);
                state.enthalpy[k] = enthalpy;
                state.cells[k] = temperature;
            }
        }
        stored
    }
}
