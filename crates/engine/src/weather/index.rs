//! Which parts of the weather act on which surfaces, sorted once: what several surfaces have in common is computed once.

use crate::building::coefficients::{Boundary, Coefficients};
use crate::building::ids::SideId;
use crate::building::plan::{Plan, SideRole};
use crate::input::forcing::Schedule;
use crate::number::real::{Real, same};
use crate::physics::convection::SurfaceConvection;
use crate::physics::longwave::Emission;
use crate::physics::solar::Plane;

/// Where the irradiance of one or several surfaces comes from.
#[derive(Debug, Clone)]
pub(crate) enum IrradianceSource<S> {
    /// A forcing channel.
    Measured(usize),
    /// A forcing channel with the irradiance of the free plane of a surface, from which obstacles take their part.
    Obstructed(usize, SideId),
    /// A plane and a reflectance of the ground that are the same in all lanes, and the surface whose shading applies.
    Uniform(Plane<f64>, f64, SideId),
    /// Another plane, and the surface whose shading applies.
    Varied(Plane<S>, SideId),
}

/// A surface outdoors.
#[derive(Debug, Clone)]
pub(crate) struct OutdoorSurface<S> {
    pub(crate) surface: SideId,
    /// Position among [`WeatherIndex::irradiance_sources`]; none: no sun.
    pub(crate) source: Option<usize>,
    /// Solar absorptance [-].
    pub(crate) absorptance: S,
    /// Position among [`WeatherIndex::emissions`]; none: the surface heat transfer coefficient includes radiation.
    pub(crate) emission: Option<usize>,
    /// Fractions absorbed of the long-wave emission of the outdoor air and of the sky [-]:
    /// `F_sky (beta E_sky + (1 - beta) E_air) + F_ground E_air`, `beta = sqrt(F_sky)`; the ground is at air temperature.
    pub(crate) air_factor: S,
    pub(crate) sky_factor: S,
}

/// All surfaces that weather or measurements act on.
#[derive(Debug, Clone)]
pub(crate) struct WeatherIndex<S> {
    /// Sources of irradiance, each different from the others.
    pub(crate) irradiance_sources: Vec<IrradianceSource<S>>,
    /// Laws of emission of the outdoor air, each different from the others.
    pub(crate) emissions: Vec<Emission<S>>,
    pub(crate) outdoors: Vec<OutdoorSurface<S>>,
    /// Surfaces outdoors whose heat transfer coefficients depend on the wind.
    pub(crate) windy: Vec<SideId>,
    /// Surfaces in no zone with a law as text that depends on what is around them, and the sources of their irradiance.
    pub(crate) surrounded: Vec<(SideId, Option<usize>)>,
    /// Surfaces in zones with such a law, their zone, and whether the law depends on its air change.
    pub(crate) surrounded_in_zones: Vec<(SideId, usize, bool)>,
    /// Surfaces with a given heat flux [W/m2], and its schedule.
    pub(crate) heated: Vec<(SideId, S, Schedule)>,
    /// Surfaces at imposed temperatures.
    pub(crate) imposed: Vec<SideId>,
    /// Whether any of their laws gives heat or a coefficient beside its temperature.
    pub(crate) beside: bool,
    /// Surfaces not outdoors with a measured irradiance: its source and their absorptance [-].
    pub(crate) irradiated: Vec<(SideId, usize, S)>,
    /// Surfaces with a measured heat transfer coefficient: forcing channel and factor [-].
    pub(crate) measured: Vec<(SideId, usize, S)>,
}

impl<S: Real> WeatherIndex<S> {
    /// Sorts the surfaces of a building.
    pub(crate) fn new(plan: &Plan, coefficients: &Coefficients<S>) -> Self {
        let mut all = Self {
            irradiance_sources: Vec::new(),
            emissions: Vec::new(),
            outdoors: Vec::new(),
            windy: Vec::new(),
            surrounded: Vec::new(),
            surrounded_in_zones: Vec::new(),
            heated: Vec::new(),
            imposed: Vec::new(),
            beside: false,
            irradiated: Vec::new(),
            measured: Vec::new(),
        };
        for (index, surface) in coefficients.surfaces.entries() {
            let source = all.add_source(plan, coefficients, index);
            let measured = surface.convection.as_ref().and_then(SurfaceConvection::measured);
            all.measured.extend(measured.map(|(channel, factor)| (index, channel, factor)));
            all.heated.extend(surface.heat_flux.map(|(flux, schedule)| (index, flux, schedule)));
            let text = surface.convection.as_ref().filter(|law| law.surrounded());
            match (text, plan.surfaces[index].role) {
                (Some(law), SideRole::Zone { zone, .. }) => {
                    all.surrounded_in_zones.push((index, zone, law.needs_air_change()));
                }
                (Some(_), SideRole::Exterior) => all.surrounded.push((index, source)),
                (None, _) => {}
            }
            match (&surface.boundary, source) {
                (Boundary::Outdoors(outdoors), _) => {
                    let emission = outdoors.emission.as_ref().map(|law| all.add_emission(law));
                    let sky_factor = surface.emissivity * outdoors.to_sky;
                    all.outdoors.push(OutdoorSurface {
                        surface: index,
                        source,
                        absorptance: surface.absorptance,
                        emission,
                        air_factor: surface.emissivity - sky_factor,
                        sky_factor,
                    });
                    if surface.exposure.wind
                        && text.is_none()
                        && surface.convection.as_ref().is_some_and(SurfaceConvection::windy)
                    {
                        all.windy.push(index);
                    }
                }
                (boundary, source) => {
                    if matches!(boundary, Boundary::Imposed(_)) {
                        all.imposed.push(index);
                        all.beside |= boundary.gives_heat() || boundary.gives_coefficient();
                    }
                    all.irradiated.extend(source.map(|source| (index, source, surface.absorptance)));
                }
            }
        }
        all
    }

    /// Position of the source of a surface's irradiance, added where no earlier surface has the same; none: no sun.
    fn add_source(&mut self, plan: &Plan, coefficients: &Coefficients<S>, index: SideId) -> Option<usize> {
        let source = source_of(plan, coefficients, index)?;
        let shaded = |surface: SideId| plan.solar_geometry.shaded(surface);
        let unshaded = |a: SideId, b: SideId| !shaded(a) && !shaded(b);
        let known = self.irradiance_sources.iter().position(|known| match (known, &source) {
            (IrradianceSource::Measured(a), IrradianceSource::Measured(b)) => a == b,
            (IrradianceSource::Uniform(a, _, surface), IrradianceSource::Uniform(b, _, other)) => {
                a.same(b) && unshaded(*surface, *other)
            }
            (IrradianceSource::Varied(a, surface), IrradianceSource::Varied(b, other)) => {
                a.same(b) && unshaded(*surface, *other)
            }
            _ => false,
        });
        Some(known.unwrap_or_else(|| {
            self.irradiance_sources.push(source);
            self.irradiance_sources.len() - 1
        }))
    }

    fn add_emission(&mut self, law: &Emission<S>) -> usize {
        self.emissions.iter().position(|known| known.same(law)).unwrap_or_else(|| {
            self.emissions.push(*law);
            self.emissions.len() - 1
        })
    }

    /// Position of the source of irradiance of a surface outdoors; none: no sun.
    pub(crate) fn irradiance_source(&self, surface: SideId) -> Option<usize> {
        self.outdoors.iter().find(|outside| outside.surface == surface)?.source
    }
}

/// The source of a surface's irradiance; none: no sun.
fn source_of<S: Real>(
    plan: &Plan,
    coefficients: &Coefficients<S>,
    index: SideId,
) -> Option<IrradianceSource<S>> {
    let surface = &coefficients.surfaces[index];
    match (surface.irradiance, &surface.boundary) {
        (Some(channel), _) if plan.takes_from_measured(index) => {
            Some(IrradianceSource::Obstructed(channel, index))
        }
        (Some(channel), _) => Some(IrradianceSource::Measured(channel)),
        (None, Boundary::Outdoors(outdoors)) if surface.exposure.sun => {
            let (plane, ground) = (&outdoors.plane, coefficients.ground_reflectance);
            let first = |number: S| S::constant(number.lane(0));
            // In single precision a plain number has other roundings, by which a member would depend on its neighbours.
            Some(if !S::SINGLE && plane.same(&plane.map(first)) && same(ground, first(ground)) {
                IrradianceSource::Uniform(plane.map(|number| number.lane(0)), ground.lane(0), index)
            } else {
                IrradianceSource::Varied(*plane, index)
            })
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::building::test_buildings::{WINDOW, glazed_zone, values};

    fn index_of(overhang: bool) -> WeatherIndex<f64> {
        let plan = Plan::new(glazed_zone("area", overhang)).unwrap();
        WeatherIndex::new(&plan, &Coefficients::new(&plan, &values(&plan.description)))
    }

    /// South wall and window share a source of irradiance; under an overhang each has its own.
    #[test]
    fn surfaces_of_one_orientation_share_a_source() {
        let index = index_of(false);
        let source = |index: &WeatherIndex<f64>, wall| index.irradiance_source(SideId::outside(wall));
        assert_eq!(index.irradiance_sources.len(), 6);
        assert_eq!((source(&index, 0), source(&index, WINDOW)), (Some(0), Some(0)));
        assert_eq!(index.irradiance_source(SideId::inside(0)), None);
        assert_eq!((index.emissions.len(), index.outdoors.len(), index.windy.len()), (1, 7, 7));
        let shaded = index_of(true);
        assert_eq!(shaded.irradiance_sources.len(), 7);
        assert_ne!(source(&shaded, 0), source(&shaded, WINDOW));
    }

    /// Of the long-wave radiation on a vertical wall of emissivity 0.9 the fraction 0.5^(3/2) has the temperature of the sky.
    #[test]
    fn long_wave_fractions() {
        let index = index_of(false);
        let sky_factor = 0.9 * 0.5 * 0.5_f64.sqrt();
        assert!((index.outdoors[0].sky_factor - sky_factor).abs() < 1e-15);
        assert!((index.outdoors[0].air_factor - (0.9 - sky_factor)).abs() < 1e-15);
    }
}
