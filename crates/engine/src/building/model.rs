//! What stays the same during a run: the plan, the coefficients of a parameter vector, and which parts are nonlinear.

use core::ops::Range;

use crate::building::coefficients::{Boundary, Coefficients, SurfaceCoefficients};
use crate::building::ids::{BySide, SideId};
use crate::building::plan::{Plan, SideRole};
use crate::number::real::Real;
use crate::physics::convection::SurfaceConvection;
use crate::physics::longwave::Emission;

/// A building at a parameter vector.
#[derive(Debug, Clone)]
pub struct Model<'a, S> {
    /// The building as flat arrays.
    pub(crate) plan: &'a Plan,
    /// Its coefficients.
    pub(crate) coefficients: Coefficients<S>,
    /// Which of its parts are linear, and which are not.
    pub(crate) parts: Parts,
}

impl<'a, S: Real> Model<'a, S> {
    pub(crate) fn new(plan: &'a Plan, coefficients: Coefficients<S>) -> Self {
        let parts = Parts::new(plan, &coefficients);
        Self { plan, coefficients, parts }
    }

    /// Cells of a wall among those of the building.
    #[inline(always)]
    pub(crate) fn cells(&self, wall: usize) -> Range<usize> {
        let wall = &self.plan.walls[wall];
        wall.first_cell..wall.first_cell + wall.len()
    }

    /// Whether ideal loads are found by the responses of the building to each: where there is one load, where loads are partly
    /// radiated, and where set points hold more than airs. (With derivatives they always are.)
    pub(crate) fn loads_by_responses(&self) -> bool {
        let radiated = self.coefficients.zones.iter().any(|zone| zone.radiated_loads.is_some());
        self.plan.ideal_loads.len() == 1 || radiated || self.holds_operative()
    }

    /// What the set points of a zone hold, at temperatures and an ideal load [W]: its air, or its operative temperature [degC].
    #[inline(always)]
    pub(crate) fn held_temperature(&self, zone: usize, (surfaces, air): (&BySide<S>, S), load: S) -> S {
        let numbers = &self.coefficients.zones[zone];
        let surfaces = self.plan.zones[zone].surfaces.iter().map(|&surface| surfaces[surface]);
        numbers.held_temperature(|&number| number, (surfaces, air), numbers.load_parts(load)[1])
    }

    /// Whether the set points of some zone hold another temperature than that of its air.
    pub(crate) fn holds_operative(&self) -> bool {
        self.coefficients.zones.iter().any(|zone| zone.setpoint_radiant_share.is_some())
    }

    /// Law of convection at a surface; none where no heat passes it, or where the surface is held at a temperature.
    pub(crate) fn convection(&self, surface: SideId) -> Option<&SurfaceConvection<S>> {
        convection_law(&self.coefficients, surface)
    }

    /// Law of emission of a surface; none where it exchanges no long-wave radiation of its own.
    pub(crate) fn emission(&self, surface: SideId) -> Option<Emission<S>> {
        emission_law(self.plan, &self.coefficients, surface)
    }
}

fn convection_law<S: Real>(coefficients: &Coefficients<S>, surface: SideId) -> Option<&SurfaceConvection<S>> {
    let surface = &coefficients.surfaces[surface];
    let adiabatic = matches!(surface.boundary, Boundary::Adiabatic);
    surface.convection.as_ref().filter(|_| !adiabatic)
}

fn emission_law<S: Real>(
    plan: &Plan,
    coefficients: &Coefficients<S>,
    surface: SideId,
) -> Option<Emission<S>> {
    match plan.surfaces[surface].role {
        SideRole::Zone { zone, .. } if coefficients.zones[zone].exchange.is_empty() => None,
        SideRole::Zone { zone, .. } => Some(coefficients.zones[zone].emission),
        SideRole::Exterior => outdoor_emission(&coefficients.surfaces[surface]),
    }
}

/// Law of emission of a surface outdoors; none where the surface heat transfer coefficient contains it.
#[inline(always)]
pub(crate) fn outdoor_emission<S: Real>(surface: &SurfaceCoefficients<S>) -> Option<Emission<S>> {
    match &surface.boundary {
        Boundary::Outdoors(outdoors) => outdoors.emission,
        Boundary::Imposed(_) | Boundary::Adiabatic | Boundary::Zone => None,
    }
}

/// Which parts of a building are linear, and which are not: found from the plan and from the kinds of laws, never from
/// the value of a parameter.
#[derive(Debug, Clone)]
pub(crate) struct Parts {
    /// Walls of constant properties, and those of them that are thick.
    pub(crate) linear_walls: Vec<usize>,
    pub(crate) thick_walls: Vec<usize>,
    /// Those of them that no zone front eliminates.
    pub(crate) shared_walls: Vec<usize>,
    /// Those of them that touch no zone.
    pub(crate) detached_walls: Vec<usize>,
    /// Their surfaces in zones.
    pub(crate) zone_surfaces: Vec<SideId>,
    /// Walls whose properties depend on temperature, and their cells, those that follow each other together.
    pub(crate) nonlinear_walls: Vec<usize>,
    pub(crate) nonlinear_cells: Vec<Range<usize>>,
    /// Those of these walls in which something melts, and the cells of the others.
    pub(crate) melting_walls: Vec<usize>,
    pub(crate) solid_cells: Vec<Range<usize>>,
    /// Those of these walls that zone fronts eliminate, all of them windows, and the others.
    pub(crate) front_windows: Vec<usize>,
    pub(crate) coupled_walls: Vec<usize>,
    /// Surfaces whose laws are linearised or change with the wind: all of them, and those that no zone front eliminates.
    pub(crate) surfaces: VariableSurfaces,
    pub(crate) other_surfaces: VariableSurfaces,
    /// Places of the surfaces at which something is linearised: convection, radiation or the wall behind; and those of thick walls.
    pub(crate) linearised: Vec<Range<usize>>,
    /// Whether the heat balance of a surface of a linear wall is nonlinear.
    pub(crate) nonlinear_balances: bool,
    /// Whether the wind changes the slope of such a balance.
    pub(crate) wind_changes_balances: bool,
}

/// Ranges in order, those that follow each other together.
fn together(ranges: impl Iterator<Item = Range<usize>>) -> Vec<Range<usize>> {
    let mut all: Vec<Range<usize>> = Vec::new();
    for range in ranges {
        match all.last_mut() {
            Some(last) if last.end == range.start => last.end = range.end,
            _ => all.push(range),
        }
    }
    all
}

/// Surfaces whose laws change during a run.
#[derive(Debug, Clone, Default)]
pub(crate) struct VariableSurfaces {
    /// Convection that depends on the wind alone.
    pub(crate) windy: Vec<SideId>,
    /// Convection that depends on the temperature difference.
    pub(crate) nonlinear: Vec<SideId>,
    /// Emission with the fourth power of the temperature.
    pub(crate) radiant: Vec<SideId>,
}

impl VariableSurfaces {
    /// Those for which a condition holds.
    fn filter(&self, holds: impl Fn(SideId) -> bool) -> Self {
        let some = |surfaces: &[SideId]| surfaces.iter().copied().filter(|&surface| holds(surface)).collect();
        Self { windy: some(&self.windy), nonlinear: some(&self.nonlinear), radiant: some(&self.radiant) }
    }
}

impl Parts {
    fn new<S: Real>(plan: &Plan, coefficients: &Coefficients<S>) -> Self {
        let (nonlinear_walls, linear_walls): (Vec<_>, Vec<_>) =
            (0..plan.walls.len()).partition(|&wall| plan.walls[wall].nonlinear);
        let exterior = |surface: SideId| plan.surfaces[surface].role == SideRole::Exterior;
        let (linear, nonlinear) = (|| linear_walls.iter().copied(), || nonlinear_walls.iter().copied());
        let cells =
            |wall: usize| plan.walls[wall].first_cell..plan.walls[wall].first_cell + plan.walls[wall].len();
        let melts = |&wall: &usize| !coefficients.walls[wall].pcm.is_empty();
        let mut parts = Self {
            thick_walls: linear().filter(|&wall| plan.walls[wall].thick).collect(),
            shared_walls: linear().filter(|&wall| !plan.walls[wall].condensed_in_zone).collect(),
            detached_walls: linear().filter(|&wall| SideId::pair(wall).into_iter().all(exterior)).collect(),
            zone_surfaces: linear().flat_map(SideId::pair).filter(|&surface| !exterior(surface)).collect(),
            nonlinear_cells: together(nonlinear().map(cells)),
            melting_walls: nonlinear().filter(melts).collect(),
            solid_cells: together(nonlinear().filter(|wall| !melts(wall)).map(cells)),
            front_windows: nonlinear().filter(|&wall| plan.walls[wall].condensed_in_zone).collect(),
            coupled_walls: nonlinear().filter(|&wall| !plan.walls[wall].condensed_in_zone).collect(),
            linear_walls,
            nonlinear_walls,
            surfaces: VariableSurfaces::default(),
            other_surfaces: VariableSurfaces::default(),
            linearised: Vec::new(),
            nonlinear_balances: false,
            wind_changes_balances: false,
        };
        for surface in plan.surfaces.ids() {
            parts.sort(plan, coefficients, surface);
        }
        let surfaces = &parts.surfaces;
        // They are in order.
        let linearised = |surface: &SideId| {
            plan.walls[surface.wall()].nonlinear
                || plan.walls[surface.wall()].thick
                || surfaces.nonlinear.binary_search(surface).is_ok()
                || surfaces.radiant.binary_search(surface).is_ok()
        };
        let places = plan.surfaces.ids().filter(linearised).map(SideId::index);
        parts.linearised = together(places.map(|place| place..place + 1));
        parts.other_surfaces = parts
            .surfaces
            .filter(|surface| exterior(surface) && !plan.walls[surface.wall()].condensed_in_zone);
        parts
    }

    /// Sorts a surface by its laws.
    fn sort<S: Real>(&mut self, plan: &Plan, coefficients: &Coefficients<S>, surface: SideId) {
        // The exterior surface of a wall that is nonlinear itself is eliminated with its wall, in every iteration.
        let of_linear_wall = matches!(plan.surfaces[surface].role, SideRole::Zone { .. })
            || !plan.walls[surface.wall()].nonlinear;
        self.nonlinear_balances |= plan.walls[surface.wall()].condensed_in_zone && !of_linear_wall;
        // Where the air is stratified, the line of a law has an offset that changes.
        let shifted = coefficients.surfaces[surface].level.is_some();
        match convection_law(coefficients, surface) {
            Some(law) if law.constant().is_some() && !shifted => {}
            Some(law) if law.straight() && !shifted => {
                self.surfaces.windy.push(surface);
                self.wind_changes_balances |= of_linear_wall;
            }
            Some(_) => {
                self.surfaces.nonlinear.push(surface);
                self.nonlinear_balances |= of_linear_wall;
            }
            None => {}
        }
        if let Some(Emission::Exact) = emission_law(plan, coefficients, surface) {
            self.surfaces.radiant.push(surface);
            self.nonlinear_balances |= of_linear_wall;
        }
    }

    /// Surfaces whose laws change: all of them, or those that no zone front eliminates.
    #[inline(always)]
    pub(crate) fn variable_surfaces(&self, all: bool) -> &VariableSurfaces {
        if all { &self.surfaces } else { &self.other_surfaces }
    }

    /// Whether no slope of the balances of the surfaces of linear walls ever changes.
    #[inline(always)]
    pub(crate) fn balances_stay(&self) -> bool {
        !self.nonlinear_balances && !self.wind_changes_balances
    }
}
