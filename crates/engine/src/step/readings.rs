//! What outputs read after a step beside the state.

use crate::building::coefficients::Boundary;
use crate::building::ids::{BySide, SideId};
use crate::building::layout::SideRole;
use crate::building::model::Model;
use crate::linear::wall::WallSystem;
use crate::number::real::{Mask, Real};
use crate::physics::psychrometrics::{condenses, relative_humidity};
use crate::step::film::film;
use crate::step::stage_weather::StageWeather;
use crate::step::state::State;
use crate::step::stepper::Stepper;
use crate::step::vapour::balances::VapourBalances;
use crate::weather::sun_position::position;
use crate::weather::vents::VentConditions;

/// What a step has left for outputs beside the state.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Readings<'r, S: Real> {
    pub(crate) model: &'r Model<'r, S>,
    pub(crate) weather: &'r StageWeather<S>,
    /// Walls, and temperatures of surfaces, of the last stage.
    pub(super) walls: &'r [WallSystem<S>],
    pub(super) surfaces: &'r BySide<S>,
    pub(super) vapour: Option<&'r VapourBalances<'r, S>>,
}

impl<S: Real> Stepper<'_, S> {
    /// What outputs read beside the state.
    pub(crate) fn readings(&self) -> Readings<'_, S> {
        Readings {
            model: &self.model,
            weather: &self.weather,
            walls: &self.solver.system.walls,
            surfaces: &self.solver.solution.surfaces,
            vapour: self.vapour.as_deref(),
        }
    }

    /// Averages what outputs need beside the results of every run.
    pub(crate) fn average_absorbed_sun(&mut self) {
        self.weather.average_absorbed(&self.model);
    }
}

impl<S: Real> Readings<'_, S> {
    /// Outdoor air entering a zone at an air temperature, in the weather of the last stage [1/h].
    pub(crate) fn air_changes(&self, zone: usize, air: S) -> S {
        let (conditions, numbers) = (&self.weather.conditions, &self.model.coefficients.zones[zone]);
        let rate = conditions.zones[zone].air_changes(numbers, conditions.wind, conditions.outdoor_air, air);
        let fans = conditions.mechanical_air.zones.get(zone);
        fans.map_or(rate, |fans| rate + fans.fresh.scale(3600.0) / numbers.air_capacity)
    }

    /// All air that flows into a zone by what is not a door, or moves within it, in the weather of the last stage [1/h].
    pub(crate) fn total_air_changes(&self, zone: usize, air: S) -> S {
        self.weather.conditions.total_air_changes(&self.model.coefficients, zone, air)
    }

    /// Openings of the pressure network in the last stage.
    pub(crate) fn vents_now(&self) -> &VentConditions<S> {
        &self.weather.conditions.vents
    }

    /// Heat of a heat source at the end of the step [W].
    pub(crate) fn released(&self, state: &State<S>, source: usize) -> S {
        let numbers = &self.model.coefficients.heat_sources[source];
        let at = &self.weather.conditions.heat_sources[source];
        self.model.coefficients.walls[numbers.wall].area * at.released(state.cells[numbers.cell])
    }

    /// Temperature of the plane of a heat source [degC].
    pub(crate) fn plane(&self, state: &State<S>, source: usize) -> S {
        state.cells[self.model.coefficients.heat_sources[source].cell]
    }

    /// Temperature of the water that leaves a heat source [degC].
    pub(crate) fn returned(&self, state: &State<S>, source: usize) -> S {
        let at = &self.weather.conditions.heat_sources[source];
        at.supply - at.effectiveness * (at.supply - self.plane(state, source))
    }

    /// Short-wave radiation on a surface outdoors, mean over the last step [W/m2].
    pub(crate) fn incident(&self, surface: SideId) -> S {
        self.weather.incident(surface)
    }

    /// The part of it from the sun's disc, where it is not measured, mean over the last step [W/m2].
    pub(crate) fn incident_beam(&self, surface: SideId) -> S {
        self.weather.incident_beam(surface)
    }

    /// Air of a zone at a height from its middle, as a part of the height of the zone [degC].
    pub(crate) fn air_at(&self, state: &State<S>, zone: usize, part: f64) -> S {
        let gradient = self.weather.conditions.zones[zone].gradient;
        state.air[zone] + gradient.scale(part * self.model.coefficients.zones[zone].height)
    }

    /// Altitude of the sun, negative below the horizon, and its azimuth clockwise from north, at the end of the step [deg].
    pub(crate) fn sun_position(&self) -> [f64; 2] {
        position(self.weather.conditions.sun.direction)
    }

    /// Fractions of sky and ground that a surface sees past all obstacles [-]; zeros where it does not face outdoors.
    pub(crate) fn views(&self, surface: SideId) -> [S; 2] {
        let open = self.model.plan.solar_geometry.visibility(surface, &[]);
        match &self.model.coefficients.surfaces[surface].boundary {
            Boundary::Outdoors(outdoors) => {
                [outdoors.plane.sky_view.scale(open.sky), outdoors.plane.ground_view.scale(open.ground)]
            }
            _ => [S::zero(); 2],
        }
    }

    /// Long-wave radiation that a surface gains in the weather of the last stage [W/m2]; zero where the heat transfer
    /// coefficient contains it.
    pub(crate) fn net_longwave(&self, state: &State<S>, surface: SideId) -> S {
        let Some(emission) = self.model.emission(surface) else { return S::zero() };
        let numbers = &self.model.coefficients;
        let own = emission.at(state.surfaces[surface]).0;
        let SideRole::Zone { zone, .. } = self.model.plan.surfaces[surface].role else {
            return self.weather.conditions.surfaces[surface].longwave
                - numbers.surfaces[surface].emissivity * own;
        };
        let (surfaces, zone) = (&self.model.plan.zones[zone].surfaces, &numbers.zones[zone]);
        let n = surfaces.len();
        let Some(i) = surfaces.iter().position(|&other| other == surface) else { return S::zero() };
        let mut gain = S::zero();
        for (j, &other) in surfaces.iter().enumerate() {
            gain += zone.exchange[i * n + j] * (emission.at(state.surfaces[other]).0 - own);
        }
        gain / zone.areas[i]
    }

    /// Convective heat transfer coefficient of a surface in the weather of the last stage [W/(m2 K)].
    pub(crate) fn convection(&self, state: &State<S>, surface: SideId) -> S {
        let air = match self.model.plan.surfaces[surface].role {
            SideRole::Zone { zone, .. } => state.air[zone],
            SideRole::Exterior => self.weather.conditions.surfaces[surface].temperature,
        };
        film(self.model, &self.weather.conditions, surface, state.surfaces[surface], air)
    }

    /// Pressure of the air in the weather of the last stage [Pa]; zero in a building without vapour balances.
    pub(crate) fn pressure(&self) -> S {
        self.weather.conditions.humidity.as_ref().map_or_else(S::zero, |humidity| humidity.pressure)
    }

    /// Latent heat that ideal drying takes away or ideal humidifying adds, mean over the step [W].
    pub(crate) fn latent(&self, zone: usize, humidifying: bool) -> S {
        self.vapour.as_ref().map_or_else(S::zero, |vapour| vapour.latent(zone, humidifying))
    }

    /// Relative humidity of the air of a zone at the temperature of a surface in it [-]; zero in no zone.
    pub(crate) fn surface_humidity(&self, state: &State<S>, surface: SideId) -> S {
        let SideRole::Zone { zone, .. } = self.model.plan.surfaces[surface].role else { return S::zero() };
        relative_humidity(state.surfaces[surface], state.vapour[zone], self.pressure())
    }

    /// Whether vapour of the air of a zone condenses on a surface in it, or forms frost there.
    pub(crate) fn condenses(&self, state: &State<S>, surface: SideId) -> S::Mask {
        let SideRole::Zone { zone, .. } = self.model.plan.surfaces[surface].role else {
            return S::Mask::splat(false);
        };
        condenses(state.surfaces[surface], state.vapour[zone], self.pressure())
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
        self.walls[w].storage[cell - wall.first_cell].capacity * state.cells[cell]
    }

    /// Conduction along a link of a wall at the end of the step that led to a state [W/m2], positive towards the inside.
    #[inline(always)]
    pub(crate) fn link_flux(&self, state: &State<S>, w: usize, link: usize) -> S {
        let (wall, chain) = (&self.model.plan.walls[w], &self.walls[w]);
        let surfaces = self.surfaces.pair(w);
        if wall.nonlinear {
            return chain.link_flux(link, surfaces);
        }
        let cells = &state.cells[wall.first_cell..wall.first_cell + wall.len()];
        let left = if link == 0 { surfaces[0] } else { cells[link - 1] };
        let right = if link == cells.len() { surfaces[1] } else { cells[link] };
        chain.links[link].flux(left, right)
    }
}
