//! The heat balances of the stage just solved, and the heat that it adds to the ledger.

use crate::balance::energy_balance::Power;
use crate::balance::terms::Balances;
use crate::building::ids::SideId;
use crate::number::real::Real;
use crate::step::stage::Stage;
use crate::step::state::State;
use crate::step::stepper::Stepper;

impl<S: Real> Stepper<'_, S> {
    /// The balances of a stage, its laws as linearised for the last linear solve; zone fronts keep those of their surfaces.
    #[inline(always)]
    fn balances(&self) -> Balances<'_, S> {
        Balances {
            model: &self.model,
            index: &self.flows,
            conditions: &self.weather.conditions,
            walls: &self.solver.system.walls,
            laws: &self.solver.linearisation.laws,
            load: &self.solver.start.load,
        }
    }

    /// Adds the heat of the stage, which counts for a duration [s], to that of a step: at the values of the last linear
    /// solve.
    #[inline(always)]
    pub(super) fn add_heat(&self, duration: f64, energy: &mut Power<S>) {
        let solution = &self.solver.solution;
        let flux = |surface| self.flux_into_wall(surface);
        energy.add_for(
            duration,
            &self.balances().power((&solution.cells, &solution.surfaces, &solution.air), flux),
        );
    }

    /// Evaluates the residual of the stage just solved.
    #[cold]
    #[inline(never)]
    pub(super) fn record_residual(&mut self, state: &State<S>, length: f64, index: usize) {
        let (model, conditions, tableau) = (&self.model, &self.weather.conditions, self.scheme.tableau());
        let histories = self.histories.within(state);
        let stage = Stage { model, conditions, state, histories, tableau, length, place: (0, index + 1) };
        if let Some(residuals) = &mut self.residuals {
            residuals.record(&self.solver, &self.flows, &stage, tableau.ratio);
        }
    }

    /// Conduction from a surface into its wall [W/m2].
    #[inline(always)]
    fn flux_into_wall(&self, surface: SideId) -> S {
        let (w, e) = (surface.wall(), surface.side());
        let (system, surfaces) = (&self.solver.system, self.solver.solution.surfaces.pair(w));
        let wall = &self.model.plan.walls[w];
        if wall.nonlinear {
            let flux = system.walls[w].link_flux(e * wall.len(), surfaces);
            return if e == 0 { flux } else { -flux };
        }
        -(system.sources[w][e] + system.responses[w].heat(e, surfaces))
    }
}
