//! What is booked of a stage, sorted once: one pass over the surfaces that heat enters by.

use crate::balance::ledger::{Flow, Power};
use crate::building::coefficients::{Boundary, Coefficients};
use crate::building::ids::{BySurface, SurfaceId};
use crate::building::plan::Plan;
use crate::linear::surface_balance::SurfaceLaws;
use crate::number::real::Real;
use crate::weather::conditions::Conditions;

/// A surface outdoors.
#[derive(Debug, Clone)]
struct Outside<S> {
    surface: SurfaceId,
    area: S,
    emissivity: S,
    /// Whether it absorbs sun itself: the panes of windows are booked by themselves.
    opaque: bool,
    /// Whether it exchanges long-wave radiation beside its film.
    radiates: bool,
}

/// Where heat enters.
#[derive(Debug, Clone)]
pub(crate) struct FlowIndex<S> {
    outdoors: Vec<Outside<S>>,
    /// Other opaque surfaces with a measured irradiance, and their areas.
    lit: Vec<(SurfaceId, S)>,
    /// Surfaces at imposed temperatures, and their areas.
    pub(crate) imposed: Vec<(SurfaceId, S)>,
    /// Zones with gains, and those that air is let into on purpose.
    pub(crate) gaining: Vec<usize>,
    pub(crate) aired: Vec<usize>,
}

impl<S: Real> FlowIndex<S> {
    pub(crate) fn new(plan: &Plan, numbers: &Coefficients<S>) -> Self {
        let (mut outdoors, mut lit, mut imposed) = (Vec::new(), Vec::new(), Vec::new());
        for (index, surface) in numbers.surfaces.entries() {
            let area = numbers.walls[index.wall()].area;
            let opaque = plan.walls[index.wall()].glass.is_none();
            if let Boundary::Outdoors(at) = &surface.boundary {
                let (emissivity, radiates) = (surface.emissivity, at.emission.is_some());
                outdoors.push(Outside { surface: index, area, emissivity, opaque, radiates });
            } else if opaque && surface.irradiance.is_some() {
                lit.push((index, area));
            }
            if matches!(surface.boundary, Boundary::Imposed(_)) {
                imposed.push((index, area));
            }
        }
        let zones = |has: &dyn Fn(usize) -> bool| (0..plan.zones.len()).filter(|&zone| has(zone)).collect();
        Self {
            outdoors,
            lit,
            imposed,
            gaining: zones(&|zone| !numbers.zones[zone].gains.is_empty()),
            aired: zones(&|zone| {
                !numbers.zones[zone].ventilation.is_empty() || !numbers.zones[zone].openings.is_empty()
            }),
        }
    }

    /// FlowIndex what enters by the surfaces outdoors and by the sun on others [W].
    #[inline(always)]
    pub(crate) fn surfaces(
        &self,
        conditions: &Conditions<S>,
        laws: &BySurface<SurfaceLaws<S>>,
        temperatures: &BySurface<S>,
        power: &mut Power<S>,
    ) {
        let (mut solar, mut convection, mut longwave) = (Sum::none(), Sum::none(), Sum::none());
        for outside in &self.outdoors {
            let (at, laws) = (&conditions.surfaces[outside.surface], &laws[outside.surface]);
            let temperature = temperatures[outside.surface];
            if outside.opaque {
                solar.add(outside.area * at.solar);
            }
            convection.add(-(outside.area * laws.convection.at(temperature - at.temperature)));
            if outside.radiates {
                let net = at.longwave - outside.emissivity * laws.emission.at(temperature);
                longwave.add(outside.area * net);
            }
        }
        for &(surface, area) in &self.lit {
            solar.add(area * conditions.surfaces[surface].solar);
        }
        power.book_sum(Flow::Solar, &solar);
        power.book_sum(Flow::Convection, &convection);
        power.book_sum(Flow::Longwave, &longwave);
    }
}

/// Heat of one flow through several surfaces, and its magnitudes.
pub(crate) struct Sum<S> {
    pub(crate) net: S,
    pub(crate) magnitude: S,
}

impl<S: Real> Sum<S> {
    #[inline(always)]
    fn none() -> Self {
        Self { net: S::zero(), magnitude: S::zero() }
    }

    #[inline(always)]
    fn add(&mut self, power: S) {
        self.net += power;
        self.magnitude += power.abs();
    }
}
