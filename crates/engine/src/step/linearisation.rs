//! The laws of a building linearised about an iterate.

use crate::building::model::Model;
use crate::building::plan::SideRole;
use crate::linear::laws::LinearisedLaws;
use crate::linear::unknowns::Unknowns;
use crate::linear::wall::{Iterate, Link, Start, WallSystem};
use crate::number::line::Line;
use crate::number::real::Real;
use crate::physics::air_flow;
use crate::physics::doors;
use crate::physics::longwave::Emission;
use crate::physics::window_gaps::GapTangent;
use crate::step::gap_convection::GapConvection;
use crate::step::stage::Stage;
use crate::weather::conditions::Conditions;

/// Laws at surfaces and in zones as tangents, and the convection in window gaps.
#[derive(Debug, Clone)]
pub(crate) struct Linearisation<S> {
    pub(crate) laws: LinearisedLaws<S>,
    gap_convection: GapConvection<S>,
}

impl<S: Real> Linearisation<S> {
    /// With the laws of a building that never change; the others are zero.
    pub(crate) fn new(model: &Model<'_, S>, stages: usize) -> Self {
        Self { laws: LinearisedLaws::new(model), gap_convection: GapConvection::new(model, stages) }
    }

    /// Evaluates the convection in gaps at the cell temperatures that are expected in a stage: those of the step's start in
    /// the first, so that a step depends on the state and the weather only.
    #[inline(always)]
    pub(crate) fn extrapolate_gaps(&mut self, stage: usize, expected: &[S]) {
        self.gap_convection.expect(stage, expected);
    }

    /// Convective conductance of the only gap of a window, expected in a stage [W/(m2 K)].
    #[inline(always)]
    pub(crate) fn gap_convection(&self, stage: usize, w: usize) -> S {
        self.gap_convection.of_wall(stage, w)[0]
    }

    /// Convection that depends on the wind alone; zone fronts evaluate that of their surfaces, unless `all` is asked for.
    #[inline(always)]
    pub(crate) fn set_wind(&mut self, model: &Model<'_, S>, conditions: &Conditions<S>, all: bool) {
        for &surface in &model.parts.variable_surfaces(all).windy {
            let numbers = &model.coefficients.surfaces[surface];
            self.laws.surfaces[surface].convection.slope =
                conditions.surfaces[surface].forced[0] * numbers.area_factor;
        }
    }

    /// Linearises a nonlinear wall about the iterate; `outer`: cells about which the concave part of the enthalpy is
    /// linearised.
    #[inline(always)]
    pub(crate) fn linearise_wall(
        &self,
        stage: &Stage<'_, S>,
        w: usize,
        (iterate, outer): (&Unknowns<S>, Option<&[S]>),
        chain: &mut WallSystem<S>,
    ) {
        let (cells, state) = (stage.model.cells(w), stage.state);
        let numbers = &stage.model.coefficients.walls[w];
        let at = Iterate {
            cells: &iterate.cells[cells.clone()],
            surfaces: iterate.surfaces.pair(w),
            outer: outer.map(
                #[inline(always)]
                |outer| &outer[cells.clone()],
            ),
        };
        let start = Start {
            cells: &state.cells[cells.clone()],
            enthalpy: &state.enthalpy[cells.clone()],
            memory: &stage.histories[cells],
        };
        if let Some(glass) = &numbers.glass {
            let links = &mut chain.links;
            glass.linearise(
                at.cells,
                self.gap_convection.of_wall(stage.index(), w),
                #[inline(always)]
                |link, GapTangent { left, right, offset }| links[link] = Link { left, right, offset },
            );
            if let Some((link, blind)) = &glass.blind {
                let windows = stage.model.plan.windows.iter().zip(&stage.conditions.sun.windows);
                let covered = windows.filter(|(window, _)| **window == w).map(|(_, sun)| sun.covered).next();
                let conductance = blind.conductance(covered.unwrap_or_else(S::zero));
                chain.links[*link] = Link { left: conductance, right: conductance, offset: S::zero() };
            }
        } else {
            chain.linearise(numbers, &at, &start, stage.tableau.storage);
            if chain.has_sources() {
                chain.set_sources(&stage.model.plan.walls[w].planes, &stage.conditions.heat_sources);
            }
        }
    }

    /// Linearises what depends on the temperatures of surfaces and airs; zone fronts linearise their surfaces, unless `all`
    /// is asked for.
    #[inline(always)]
    pub(crate) fn linearise_surfaces(
        &mut self,
        model: &Model<'_, S>,
        conditions: &Conditions<S>,
        iterate: &Unknowns<S>,
        all: bool,
    ) {
        let variable = model.parts.variable_surfaces(all);
        for &index in &variable.nonlinear {
            let (surface, at) = (&model.coefficients.surfaces[index], &conditions.surfaces[index]);
            let air = match model.plan.surfaces[index].role {
                SideRole::Zone { zone, .. } => iterate.air[zone],
                SideRole::Exterior => at.temperature,
            };
            if let Some(convection) = &surface.convection {
                let difference = iterate.surfaces[index] - air;
                let flux = convection.tangent_flux(difference - at.air_shift, &at.forced);
                let (flux, slope) = (flux.flux * surface.area_factor, flux.slope * surface.area_factor);
                self.laws.surfaces[index].convection = Line::tangent(flux, slope, difference);
            }
        }
        for &index in &variable.radiant {
            let temperature = iterate.surfaces[index];
            let (value, slope) = Emission::Exact.at(temperature);
            self.laws.surfaces[index].emission = Line::tangent(value, slope, temperature);
        }
        for (zone, numbers) in model.coefficients.zones.iter().enumerate() {
            let (wind, outdoor, air) = (conditions.wind, conditions.outdoor_air, iterate.air[zone]);
            let of_zone = &conditions.zones[zone];
            let capacity = of_zone.infiltrated_capacity(numbers);
            self.laws.infiltration[zone] =
                air_flow::infiltration(&numbers.infiltration, capacity, wind, outdoor, air);
            self.laws.ventilation[zone] = of_zone.outdoor_heat(numbers, wind, outdoor, air);
            if let Some(law) = &numbers.leakage {
                let heat = law.heat(capacity, wind, outdoor, air);
                self.laws.infiltration[zone] = self.laws.infiltration[zone].plus(&heat);
            }
            if let Some(law) = &numbers.infiltration_law {
                let heat = air_flow::heat_of_law(law, capacity, wind, outdoor, air);
                self.laws.infiltration[zone] = self.laws.infiltration[zone].plus(&heat);
            }
        }
        for (line, fans) in self.laws.ventilation.iter_mut().zip(&conditions.mechanical_air.zones) {
            *line = line.plus(&fans.heat());
        }
        let doors = model.coefficients.doors.iter().zip(&conditions.doors);
        for (line, (door, &whole)) in self.laws.doors.iter_mut().zip(doors) {
            let [a, b] = door.between.map(|zone| iterate.air[zone]);
            *line = doors::tangent(whole, a - b);
        }
    }
}
