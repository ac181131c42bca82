//! What outputs read of a stepper after a step.

use crate::building::ids::SurfaceId;
use crate::number::real::Real;
use crate::step::state::State;
use crate::step::stepper::Stepper;

impl<S: Real> Stepper<'_, S> {
    /// Outdoor air entering a zone at an air temperature, in the weather of the last stage [1/h].
    pub(crate) fn air_changes(&self, zone: usize, air: S) -> S {
        let (conditions, numbers) = (&self.weather.conditions, &self.model.coefficients.zones[zone]);
        conditions.zones[zone].air_changes(numbers, conditions.wind, conditions.outdoor_air, air)
    }

    /// Short-wave radiation on a surface outdoors, mean over the last step [W/m2].
    pub(crate) fn incident(&self, surface: SurfaceId) -> S {
        self.weather.incident(surface)
    }

    /// Temperature of the sky at the end of the last stage [degC].
    pub(crate) fn sky_temperature(&self) -> S {
        self.weather.sky_temperature()
    }

    /// Enthalpy of a cell of a wall [J/m3].
    pub(crate) fn enthalpy(&self, state: &State<S>, w: usize, cell: usize) -> S {
        let wall = &self.model.plan.walls[w];
        if wall.nonlinear {
            return state.enthalpy[cell];
        }
        self.solver.system.walls[w].storage[cell - wall.first_cell].capacity * state.cells[cell]
    }

    /// Conduction along a link of a wall at the end of the step that led to a state [W/m2], positive towards the inside.
    #[inline(always)]
    pub(crate) fn link_flux(&self, state: &State<S>, w: usize, link: usize) -> S {
        let (wall, chain) = (&self.model.plan.walls[w], &self.solver.system.walls[w]);
        let surfaces = self.solver.solution.surfaces.pair(w);
        if wall.nonlinear {
            return chain.link_flux(link, surfaces);
        }
        let cells = &state.cells[wall.first_cell..wall.first_cell + wall.len()];
        let left = if link == 0 { surfaces[0] } else { cells[link - 1] };
        let right = if link == cells.len() { surfaces[1] } else { cells[link] };
        chain.links[link].flux(left, right)
    }
}
