//! Surfaces and zones that exchange heat with the environment, sorted once: one pass over them gives all heat that enters
//! the building.

use crate::building::coefficients::{Boundary, Coefficients};
use crate::building::ids::SideId;
use crate::building::plan::{Plan, SideRole};
use crate::number::real::Real;
use crate::weather::index::WeatherIndex;

/// A surface outdoors.
#[derive(Debug, Clone)]
pub(crate) struct Outdoors<S> {
    pub(crate) surface: SideId,
    pub(crate) area: S,
    pub(crate) emissivity: S,
    /// Whether it absorbs sun itself: the panes of windows are counted by themselves.
    pub(crate) opaque: bool,
    /// Whether it exchanges long-wave radiation beside its convection.
    pub(crate) radiates: bool,
    pub(crate) absorptance: S,
    /// Absorbed parts of the emission of the sky and of the outdoor air [-].
    pub(crate) sky_factor: S,
    pub(crate) air_factor: S,
}

/// Another opaque surface with a measured irradiance.
#[derive(Debug, Clone)]
pub(crate) struct Lit<S> {
    pub(crate) surface: SideId,
    pub(crate) area: S,
    pub(crate) absorptance: S,
}

/// A surface with an imposed temperature.
#[derive(Debug, Clone)]
pub(crate) struct ImposedSurface<S> {
    pub(crate) surface: SideId,
    pub(crate) area: S,
    /// Whether the surface is held at it; else it is that of the air that the surface convects to.
    pub(crate) held: bool,
}

/// Where heat enters.
#[derive(Debug, Clone)]
pub(crate) struct FlowIndex<S> {
    pub(crate) outdoors: Vec<Outdoors<S>>,
    pub(crate) lit: Vec<Lit<S>>,
    /// Surfaces with a given heat flux, and their areas.
    pub(crate) heated: Vec<(SideId, S)>,
    /// Other surfaces that sun reaches through windows, and their areas.
    pub(crate) transmitted_sun: Vec<(SideId, S)>,
    pub(crate) imposed: Vec<ImposedSurface<S>>,
    /// Zones with gains, and those with ventilation or openings.
    pub(crate) gaining: Vec<usize>,
    pub(crate) ventilated: Vec<usize>,
}

impl<S: Real> FlowIndex<S> {
    pub(crate) fn new(plan: &Plan, numbers: &Coefficients<S>, weather: &WeatherIndex<S>) -> Self {
        let (mut lit, mut transmitted_sun, mut imposed) = (Vec::new(), Vec::new(), Vec::new());
        let of = |surface: SideId| {
            (numbers.walls[surface.wall()].area, plan.walls[surface.wall()].glass.is_none())
        };
        for (index, surface) in numbers.surfaces.entries() {
            let (area, opaque) = of(index);
            let held = matches!(surface.boundary, Boundary::Imposed(_)) && surface.convection.is_none();
            if matches!(surface.boundary, Boundary::Imposed(_)) {
                imposed.push(ImposedSurface { surface: index, area, held });
            }
            let in_zone = matches!(plan.surfaces[index].role, SideRole::Zone { .. });
            if matches!(surface.boundary, Boundary::Outdoors(_)) {
                continue;
            }
            if opaque && surface.irradiance.is_some() {
                lit.push(Lit { surface: index, area, absorptance: surface.absorptance });
            } else if in_zone || (!opaque && !held) {
                transmitted_sun.push((index, area));
            }
        }
        let outdoors = weather.outdoors.iter().map(|outside| {
            let (area, opaque) = of(outside.surface);
            Outdoors {
                surface: outside.surface,
                area,
                emissivity: numbers.surfaces[outside.surface].emissivity,
                opaque,
                radiates: outside.emission.is_some(),
                absorptance: outside.absorptance,
                sky_factor: outside.sky_factor,
                air_factor: outside.air_factor,
            }
        });
        let zones = |has: &dyn Fn(usize) -> bool| (0..plan.zones.len()).filter(|&zone| has(zone)).collect();
        let warmed =
            weather.imposed.iter().filter(|&&surface| numbers.surfaces[surface].boundary.gives_heat());
        let heated = weather.heated.iter().map(|(surface, ..)| surface).chain(warmed);
        Self {
            heated: heated.map(|&surface| (surface, of(surface).0)).collect(),
            outdoors: outdoors.collect(),
            lit,
            transmitted_sun,
            imposed,
            gaining: zones(&|zone| !numbers.zones[zone].gains.is_empty()),
            ventilated: zones(&|zone| {
                let zone_flows = &numbers.zones[zone];
                let fans = numbers.mechanical_air.reaches(zone);
                fans || !zone_flows.ventilation.is_empty() || !zone_flows.openings.is_empty()
            }),
        }
    }
}
