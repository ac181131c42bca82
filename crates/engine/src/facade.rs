//! What of the weather acts on which face, sorted once: the same for several faces is reckoned once.

use crate::coefficients::{Boundary, Coefficients};
use crate::convection::Film;
use crate::plan::{FaceId, Plan};
use crate::radiation::Emission;
use crate::real::{Real, same};
use crate::solar::Plane;

/// Where the irradiance of one or several faces comes from.
#[derive(Debug, Clone)]
pub(crate) enum Sun<S> {
    /// A forcing channel.
    Measured(usize),
    /// A plane that is the same in all lanes, and the ground before it; a face whose shades it has.
    Even(Plane<f64>, f64, FaceId),
    /// Another plane.
    Varied(Plane<S>, FaceId),
}

/// A face outdoors.
#[derive(Debug, Clone)]
pub(crate) struct Outside<S> {
    pub(crate) face: FaceId,
    /// Position among [`Facade::suns`].
    pub(crate) sun: Option<usize>,
    pub(crate) absorptance: S,
    /// Position among [`Facade::emissions`]; none: the film is combined.
    pub(crate) emission: Option<usize>,
    /// What it absorbs of the long-wave emission of the outdoor air and of the sky [-]:
    /// `F_sky (beta E_sky + (1 - beta) E_air) + F_ground E_air`, `beta = sqrt(F_sky)`; the ground is at air temperature.
    pub(crate) of_air: S,
    pub(crate) of_sky: S,
}

/// All faces that weather or measurements act on.
#[derive(Debug, Clone)]
pub(crate) struct Facade<S> {
    pub(crate) suns: Vec<Sun<S>>,
    /// Laws by which the outdoor air emits.
    pub(crate) emissions: Vec<Emission<S>>,
    pub(crate) outdoors: Vec<Outside<S>>,
    /// Faces outdoors whose films the wind acts on.
    pub(crate) windy: Vec<FaceId>,
    /// Faces at imposed temperatures.
    pub(crate) imposed: Vec<FaceId>,
    /// Other faces with a measured irradiance: the sun and its absorptance.
    pub(crate) lit: Vec<(FaceId, usize, S)>,
}

impl<S: Real> Facade<S> {
    pub(crate) fn new(plan: &Plan, numbers: &Coefficients<S>) -> Self {
        let mut all = Self {
            suns: Vec::new(),
            emissions: Vec::new(),
            outdoors: Vec::new(),
            windy: Vec::new(),
            imposed: Vec::new(),
            lit: Vec::new(),
        };
        for (index, face) in numbers.faces.iter().enumerate() {
            let sun = all.sun_of(plan, numbers, index);
            match (&face.boundary, sun) {
                (Boundary::Outdoors(outdoors), _) => {
                    let emission = outdoors.emission.as_ref().map(|law| all.emission_of(law));
                    let of_sky = face.emissivity * outdoors.to_sky;
                    all.outdoors.push(Outside {
                        face: index,
                        sun,
                        absorptance: face.absorptance,
                        emission,
                        of_air: face.emissivity - of_sky,
                        of_sky,
                    });
                    if face.exposure.wind && face.film.as_ref().is_some_and(Film::windy) {
                        all.windy.push(index);
                    }
                }
                (boundary, sun) => {
                    if matches!(boundary, Boundary::Imposed(_)) {
                        all.imposed.push(index);
                    }
                    all.lit.extend(sun.map(|sun| (index, sun, face.absorptance)));
                }
            }
        }
        all
    }

    /// Position of the sun that shines on a face.
    fn sun_of(&mut self, plan: &Plan, numbers: &Coefficients<S>, index: FaceId) -> Option<usize> {
        let face = &numbers.faces[index];
        let sun = match (face.irradiance, &face.boundary) {
            (Some(channel), _) => Sun::Measured(channel),
            (None, Boundary::Outdoors(outdoors)) if face.exposure.sun => {
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
        let shaded = |face: FaceId| face.is_multiple_of(2) && plan.daylight.shaded(face / 2);
        let alike = |a: FaceId, b: FaceId| !shaded(a) && !shaded(b);
        let known = self.suns.iter().position(|known| match (known, &sun) {
            (Sun::Measured(mine), Sun::Measured(theirs)) => mine == theirs,
            (Sun::Even(mine, _, face), Sun::Even(theirs, _, other)) => {
                mine.same(theirs) && alike(*face, *other)
            }
            (Sun::Varied(mine, face), Sun::Varied(theirs, other)) => {
                mine.same(theirs) && alike(*face, *other)
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

    /// Position of the sun on a face outdoors, if any shines there.
    pub(crate) fn sun_on(&self, face: FaceId) -> Option<usize> {
        self.outdoors.iter().find(|outside| outside.face == face)?.sun
    }
}
