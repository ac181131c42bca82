//! What of the weather acts on which surface, sorted once: the same for several surfaces is reckoned once.

use crate::building::coefficients::{Boundary, Coefficients};
use crate::building::ids::SurfaceId;
use crate::building::plan::Plan;
use crate::number::real::{Real, same};
use crate::physics::convection::SurfaceConvection;
use crate::physics::longwave::Emission;
use crate::physics::solar::Plane;

/// Where the irradiance of one or several surfaces comes from.
#[derive(Debug, Clone)]
pub(crate) enum Sun<S> {
    /// A forcing channel.
    Measured(usize),
    /// A plane that is the same in all lanes, and the ground before it; a surface whose shades it has.
    Even(Plane<f64>, f64, SurfaceId),
    /// Another plane.
    Varied(Plane<S>, SurfaceId),
}

/// A surface outdoors.
#[derive(Debug, Clone)]
pub(crate) struct Outside<S> {
    pub(crate) surface: SurfaceId,
    /// Position among [`WeatherIndex::suns`].
    pub(crate) sun: Option<usize>,
    pub(crate) absorptance: S,
    /// Position among [`WeatherIndex::emissions`]; none: the film is combined.
    pub(crate) emission: Option<usize>,
    /// What it absorbs of the long-wave emission of the outdoor air and of the sky [-]:
    /// `F_sky (beta E_sky + (1 - beta) E_air) + F_ground E_air`, `beta = sqrt(F_sky)`; the ground is at air temperature.
    pub(crate) of_air: S,
    pub(crate) of_sky: S,
}

/// All surfaces that weather or measurements act on.
#[derive(Debug, Clone)]
pub(crate) struct WeatherIndex<S> {
    pub(crate) suns: Vec<Sun<S>>,
    /// Laws by which the outdoor air emits.
    pub(crate) emissions: Vec<Emission<S>>,
    pub(crate) outdoors: Vec<Outside<S>>,
    /// Surfaces outdoors whose films the wind acts on.
    pub(crate) windy: Vec<SurfaceId>,
    /// Surfaces at imposed temperatures.
    pub(crate) imposed: Vec<SurfaceId>,
    /// Other surfaces with a measured irradiance: the sun and its absorptance.
    pub(crate) lit: Vec<(SurfaceId, usize, S)>,
}

impl<S: Real> WeatherIndex<S> {
    pub(crate) fn new(plan: &Plan, numbers: &Coefficients<S>) -> Self {
        let mut all = Self {
            suns: Vec::new(),
            emissions: Vec::new(),
            outdoors: Vec::new(),
            windy: Vec::new(),
            imposed: Vec::new(),
            lit: Vec::new(),
        };
        for (index, surface) in numbers.surfaces.entries() {
            let sun = all.sun_of(plan, numbers, index);
            match (&surface.boundary, sun) {
                (Boundary::Outdoors(outdoors), _) => {
                    let emission = outdoors.emission.as_ref().map(|law| all.emission_of(law));
                    let of_sky = surface.emissivity * outdoors.to_sky;
                    all.outdoors.push(Outside {
                        surface: index,
                        sun,
                        absorptance: surface.absorptance,
                        emission,
                        of_air: surface.emissivity - of_sky,
                        of_sky,
                    });
                    if surface.exposure.wind
                        && surface.convection.as_ref().is_some_and(SurfaceConvection::windy)
                    {
                        all.windy.push(index);
                    }
                }
                (boundary, sun) => {
                    if matches!(boundary, Boundary::Imposed(_)) {
                        all.imposed.push(index);
                    }
                    all.lit.extend(sun.map(|sun| (index, sun, surface.absorptance)));
                }
            }
        }
        all
    }

    /// Position of the sun that shines on a surface.
    fn sun_of(&mut self, plan: &Plan, numbers: &Coefficients<S>, index: SurfaceId) -> Option<usize> {
        let surface = &numbers.surfaces[index];
        let sun = match (surface.irradiance, &surface.boundary) {
            (Some(channel), _) => Sun::Measured(channel),
            (None, Boundary::Outdoors(outdoors)) if surface.exposure.sun => {
                let (plane, ground) = (&outdoors.plane, numbers.ground_reflectance);
                let first = |number: S| S::constant(number.lane(0));
                if plane.same(&plane.map(first)) && same(ground, first(ground)) {
                    Sun::Even(plane.map(|number| number.lane(0)), ground.lane(0), index)
                } else {
                    Sun::Varied(*plane, index)
                }
            }
            _ => return None,
        };
        let shaded = |surface: SurfaceId| surface.is_outside() && plan.solar_geometry.shaded(surface.wall());
        let alike = |a: SurfaceId, b: SurfaceId| !shaded(a) && !shaded(b);
        let known = self.suns.iter().position(|known| match (known, &sun) {
            (Sun::Measured(mine), Sun::Measured(theirs)) => mine == theirs,
            (Sun::Even(mine, _, surface), Sun::Even(theirs, _, other)) => {
                mine.same(theirs) && alike(*surface, *other)
            }
            (Sun::Varied(mine, surface), Sun::Varied(theirs, other)) => {
                mine.same(theirs) && alike(*surface, *other)
            }
            _ => false,
        });
        Some(known.unwrap_or_else(|| {
            self.suns.push(sun);
            self.suns.len() - 1
        }))
    }

    fn emission_of(&mut self, law: &Emission<S>) -> usize {
        self.emissions.iter().position(|known| known.same(law)).unwrap_or_else(|| {
            self.emissions.push(*law);
            self.emissions.len() - 1
        })
    }

    /// Position of the sun on a surface outdoors, if any shines there.
    pub(crate) fn sun_on(&self, surface: SurfaceId) -> Option<usize> {
        self.outdoors.iter().find(|outside| outside.surface == surface)?.sun
    }
}
