//! What is booked of a stage, sorted once: one pass over the faces that heat enters by.

use crate::balance::FaceLaws;
use crate::coefficients::{Boundary, Coefficients};
use crate::drive::Drive;
use crate::ledger::{Flow, Power};
use crate::plan::{FaceId, Plan};
use crate::real::Real;

/// A face outdoors.
#[derive(Debug, Clone)]
struct Outside<S> {
    face: FaceId,
    area: S,
    emissivity: S,
    /// Whether it absorbs sun itself: the panes of windows are booked by themselves.
    opaque: bool,
    /// Whether it exchanges long-wave radiation beside its film.
    radiates: bool,
}

/// Where heat enters.
#[derive(Debug, Clone)]
pub(crate) struct Books<S> {
    outdoors: Vec<Outside<S>>,
    /// Other opaque faces with a measured irradiance, and their areas.
    lit: Vec<(FaceId, S)>,
    /// Faces at imposed temperatures, and their areas.
    pub(crate) imposed: Vec<(FaceId, S)>,
    /// Zones with gains, and those that air is let into on purpose.
    pub(crate) gaining: Vec<usize>,
    pub(crate) aired: Vec<usize>,
}

impl<S: Real> Books<S> {
    pub(crate) fn new(plan: &Plan, numbers: &Coefficients<S>) -> Self {
        let (mut outdoors, mut lit, mut imposed) = (Vec::new(), Vec::new(), Vec::new());
        for (index, face) in numbers.faces.iter().enumerate() {
            let area = numbers.walls[index / 2].area;
            let opaque = plan.walls[index / 2].glass.is_none();
            if let Boundary::Outdoors(at) = &face.boundary {
                let (emissivity, radiates) = (face.emissivity, at.emission.is_some());
                outdoors.push(Outside { face: index, area, emissivity, opaque, radiates });
            } else if opaque && face.irradiance.is_some() {
                lit.push((index, area));
            }
            if matches!(face.boundary, Boundary::Imposed(_)) {
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

    /// Books what enters by the faces outdoors and by the sun on others [W].
    #[inline(always)]
    pub(crate) fn faces(
        &self,
        drive: &Drive<S>,
        laws: &[FaceLaws<S>],
        temperatures: &[S],
        power: &mut Power<S>,
    ) {
        let (mut solar, mut convection, mut longwave) = (Sum::none(), Sum::none(), Sum::none());
        for outside in &self.outdoors {
            let (at, laws) = (&drive.faces[outside.face], &laws[outside.face]);
            let temperature = temperatures[outside.face];
            if outside.opaque {
                solar.add(outside.area * at.solar);
            }
            convection.add(-(outside.area * laws.film.at(temperature - at.temperature)));
            if outside.radiates {
                let net = at.longwave - outside.emissivity * laws.emission.at(temperature);
                longwave.add(outside.area * net);
            }
        }
        for &(face, area) in &self.lit {
            solar.add(area * drive.faces[face].solar);
        }
        power.book_sum(Flow::Solar, &solar);
        power.book_sum(Flow::Convection, &convection);
        power.book_sum(Flow::Longwave, &longwave);
    }
}

/// Heat of one flow through several faces, and its magnitudes.
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
