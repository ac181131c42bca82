//! Coefficients of a surface: convection, long-wave and solar properties, and what it borders on.
//!
//! Sources:
//! - Long-wave radiation of the sky by `F_sky sqrt(F_sky)`: Walton (1983), NBSSIR 83-2655.
//! - Wind at the height of a surface: power laws of the boundary layers at the mast and at the site, ASHRAE Handbook of
//!   Fundamentals 2017, ch. 24, eq. 4.

use super::air;
use super::wall::net_area;
use crate::building::ids::SideId;
use crate::building::plan::Plan;
use crate::input::description::{Exposure, Facing, OutdoorLongwave, ParamId, Side, Surface};
use crate::input::forcing::{CLIMATE_CHANNELS, Schedule};
use crate::input::values::Values;
use crate::number::elementary::{cos_of_degrees, sin_of_degrees};
use crate::number::real::Real;
use crate::physics::convection::{Placement, SurfaceConvection};
use crate::physics::horizon;
use crate::physics::imposed::ImposedTemperature;
use crate::physics::longwave::Emission;
use crate::physics::solar::Plane;

/// A surface.
#[derive(Debug, Clone)]
pub struct SurfaceCoefficients<S> {
    /// Law of convection; none: no convection.
    pub convection: Option<SurfaceConvection<S>>,
    /// Convective area over plane area [-].
    pub area_factor: S,
    /// Upward component of the normal that points into the air [-].
    pub upward: S,
    /// Long-wave emissivity [-].
    pub emissivity: S,
    /// Solar absorptance [-].
    pub absorptance: S,
    /// Heat given to the surface from outside [W/m2], and its schedule.
    pub(crate) heat_flux: Option<(S, Schedule)>,
    /// Forcing channel of a measured irradiance on the plane.
    pub irradiance: Option<usize>,
    /// What it borders on.
    pub boundary: Boundary<S>,
    /// Which of sun, sky and wind reach it.
    pub exposure: Exposure,
    /// Height of its middle above that of its zone [m]; none: the air of its zone has one temperature.
    pub(crate) level: Option<f64>,
}

/// What drives a surface that is in contact with no zone.
#[derive(Debug, Clone)]
pub enum Boundary<S> {
    /// Outdoor air, sun, sky and ground.
    Outdoors(Box<Outdoors<S>>),
    /// A temperature, through the surface heat transfer coefficient if there is one.
    Imposed(Imposed<S>),
    /// No heat flow but absorbed sun and a given heat flux.
    Adiabatic,
    /// A zone: solved in the coupled system.
    Zone,
}

impl<S: Real> Boundary<S> {
    /// Whether its law gives the coefficient through which its temperature acts.
    pub(crate) fn gives_coefficient(&self) -> bool {
        matches!(self, Self::Imposed(Imposed::Law(law)) if law.gives_coefficient())
    }

    /// Whether its law gives heat beside its temperature.
    pub(crate) fn gives_heat(&self) -> bool {
        matches!(self, Self::Imposed(Imposed::Law(law)) if law.gives_heat())
    }
}

/// Coefficients of a surface outdoors.
#[derive(Debug, Clone)]
pub struct Outdoors<S> {
    /// Orientation and view factors to sky and ground.
    pub plane: Plane<S>,
    /// The same without horizon and without a given view of the sky, where a measured irradiance is that of the free plane and
    /// obstacles act after it.
    pub free: Option<Box<Plane<S>>>,
    /// Components (north, east) of the azimuth of the normal, for the wind.
    pub heading: [S; 2],
    /// Fraction of the incident long-wave radiation that has the temperature of the sky; the rest has that of the air [-].
    pub to_sky: S,
    /// Long-wave law; none: the surface heat transfer coefficient includes radiation.
    pub emission: Option<Emission<S>>,
}

/// Imposed temperatures.
#[derive(Debug, Clone)]
pub enum Imposed<S> {
    /// Forcing channel.
    Channel(usize),
    /// A law.
    Law(ImposedTemperature<S>),
}

impl<S: Real> SurfaceCoefficients<S> {
    pub(crate) fn new(plan: &Plan, index: SideId, values: &Values<'_, S>) -> Self {
        let wall = &plan.description.surfaces[index.wall()];
        let side = plan.side(index);
        let degrees = values.get(wall.tilt);
        let placement = Placement {
            area: net_area(wall, values),
            upward: outward::<S>(index) * cos_of_degrees(degrees),
            wind_factor: side.height.map_or_else(S::one, |height| wind_factor(plan, height, values)),
            inclination: degrees.min(S::constant(180.0) - degrees),
            density: air::density(plan, values),
            height: values.get_or(side.height, 0.0),
        };
        let boundary = boundary(plan, index, side, values);
        let formula = plan.formulas[index].as_ref();
        let described = side.convection.as_ref();
        let described = described.map(|law| SurfaceConvection::new(values, law, formula, &placement));
        let imposed = boundary.gives_coefficient().then(|| SurfaceConvection::imposed(&placement));
        Self {
            convection: described.or(imposed),
            area_factor: values.get_or(side.area_factor, 1.0),
            upward: placement.upward,
            emissivity: values.get_or(side.emissivity, 0.0),
            absorptance: values.get_or(side.absorptance, 0.0),
            heat_flux: side
                .heat_flux
                .as_ref()
                .map(|given| (values.get(given.flux), Schedule::new(given.schedule))),
            irradiance: side.irradiance.map(|channel| CLIMATE_CHANNELS + channel),
            boundary,
            exposure: side.exposure,
            level: match side.facing {
                Facing::Zone { zone } => {
                    plan.description.zones[zone].stratification.as_ref().map(|_| side.level)
                }
                _ => None,
            },
        }
    }
}

/// 1 for an outside surface, whose normal has the tilt and azimuth of the description; -1 for an inside surface.
fn outward<S: Real>(surface: SideId) -> S {
    if surface.is_outside() { S::one() } else { -S::one() }
}

fn boundary<S: Real>(plan: &Plan, index: SideId, side: &Side, values: &Values<'_, S>) -> Boundary<S> {
    match side.facing {
        Facing::Zone { .. } => Boundary::Zone,
        Facing::Outdoors => Boundary::Outdoors(Box::new(outdoors(plan, index, side, values))),
        _ => imposed(&side.facing, values).map_or(Boundary::Adiabatic, Boundary::Imposed),
    }
}

/// The temperature that a contact imposes; none where it imposes none.
pub(super) fn imposed<S: Real>(facing: &Facing, values: &Values<'_, S>) -> Option<Imposed<S>> {
    match facing {
        Facing::Measured { channel } => Some(Imposed::Channel(CLIMATE_CHANNELS + channel)),
        Facing::Imposed { law } => ImposedTemperature::new(law, values).map(Imposed::Law),
        Facing::Zone { .. } | Facing::Outdoors | Facing::Adiabatic => None,
    }
}

fn outdoors<S: Real>(plan: &Plan, index: SideId, side: &Side, values: &Values<'_, S>) -> Outdoors<S> {
    let wall = &plan.description.surfaces[index.wall()];
    let (mut plane, heading) = plane(wall, index, side, values);
    let free = plan.takes_from_measured(index).then(|| {
        let [sky_view, ground_view] = by_tilt(plane.normal[2]);
        Box::new(Plane { sky_view, ground_view, ..plane })
    });
    let horizon = &plan.description.site.horizon;
    if !horizon.is_empty() {
        let [sky, band] = horizon::open(horizon, &plane);
        plane.sin_tilt = plane.sin_tilt * band;
        if side.sky_view.is_none() {
            plane.sky_view = plane.sky_view * sky;
        }
    }
    let sky_view = plane.sky_view;
    let open = plan.solar_geometry.open_sky(index);
    Outdoors {
        plane,
        free,
        heading,
        to_sky: if side.exposure.sky {
            to_sky(sky_view, plan.description.site.sky_exponent, values).scale(open)
        } else {
            S::zero()
        },
        emission: match side.longwave {
            OutdoorLongwave::Exact => Some(Emission::Exact),
            OutdoorLongwave::Linearised { reference } => Some(Emission::Linearised(values.get(reference))),
            OutdoorLongwave::None => None,
        },
    }
}

/// Part of the emission of a sky that a surface receives, which sees a part of it [-]: `F_sky^exponent`.
///
/// Near the horizon the sky has the temperature of the air, and so have the walls that cover a part: `F_sky sqrt(F_sky)` (Walton 1983,
/// NBSIR 83-2655), where no exponent is given. An isotropic sky has the exponent 1.
fn to_sky<S: Real>(sky_view: S, exponent: Option<ParamId>, values: &Values<'_, S>) -> S {
    let seen = sky_view.max(S::constant(1e-300));
    match exponent {
        None => sky_view * seen.sqrt(),
        Some(id) => seen.powf(values.get(id)),
    }
}

/// The plane of a surface outdoors, and the components (north, east) of its azimuth.
fn plane<S: Real>(wall: &Surface, index: SideId, side: &Side, values: &Values<'_, S>) -> (Plane<S>, [S; 2]) {
    let (tilt, azimuth) = (values.get(wall.tilt), values.get(wall.azimuth));
    let outward = outward::<S>(index);
    let (sin_tilt, cos_tilt) = (sin_of_degrees(tilt), cos_of_degrees(tilt) * outward);
    let heading = [cos_of_degrees(azimuth) * outward, sin_of_degrees(azimuth) * outward];
    let [sky, ground] = by_tilt(cos_tilt);
    let [sky_view, ground_view] = [(side.sky_view, sky), (side.ground_view, ground)]
        .map(|(given, by_tilt)| given.map_or(by_tilt, |id| values.get(id)));
    let normal = [heading[1] * sin_tilt, heading[0] * sin_tilt, cos_tilt];
    (Plane { normal, sin_tilt, sky_view, ground_view }, heading)
}

/// View factors of a free plane to sky and ground [-], by the cosine of its tilt.
fn by_tilt<S: Real>(cosine: S) -> [S; 2] {
    [(S::one() + cosine).scale(0.5), (S::one() - cosine).scale(0.5)]
}

/// Wind at a height of the site over the wind at the mast [-]: `(delta_mast/z_mast)^a_mast (z/delta)^a`.
pub(super) fn wind_factor<S: Real>(plan: &Plan, height: ParamId, values: &Values<'_, S>) -> S {
    let wind = &plan.description.site.wind;
    let get = |id| values.get(id);
    let mast = (get(wind.mast_layer) / get(wind.mast_height)).powf(get(wind.mast_exponent));
    // Below a tenth of a metre the power law has no meaning.
    let height = get(height).max(S::constant(0.1));
    mast * (height / get(wind.layer)).powf(get(wind.exponent))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::building::coefficients::Coefficients;
    use crate::building::test_buildings::{glazed_zone, values};

    fn outdoors_of(wall: usize) -> Outdoors<f64> {
        let plan = Plan::new(glazed_zone("area", false)).unwrap();
        let surfaces = Coefficients::new(&plan, &values(&plan.description)).surfaces;
        match &surfaces[SideId::outside(wall)].boundary {
            Boundary::Outdoors(outdoors) => (**outdoors).clone(),
            other => panic!("{other:?}"),
        }
    }

    /// The south wall sees half of the sky, the floor none, the roof all of it; `to_sky` is the view factor to the power 3/2.
    #[test]
    fn orientation_and_view_factors() {
        for (wall, normal, sky) in [
            (0, [0.0, -1.0, 0.0], 0.5),
            (2, [1.0, 0.0, 0.0], 0.5),
            (4, [0.0, 0.0, -1.0], 0.0),
            (5, [0.0, 0.0, 1.0], 1.0),
        ] {
            let Outdoors { plane, to_sky, .. } = outdoors_of(wall);
            assert!((0..3).all(|k| (plane.normal[k] - normal[k]).abs() < 1e-15), "{:?}", plane.normal);
            assert!((plane.sky_view - sky).abs() < 1e-15 && (plane.ground_view - (1.0 - sky)).abs() < 1e-15);
            assert!((to_sky - sky * sky.sqrt()).abs() < 1e-15);
        }
        // Wind from the south is normal to the south wall: the components of its azimuth are north -1, east 0.
        let [north, east] = outdoors_of(0).heading;
        assert!((north + 1.0).abs() < 1e-15 && east.abs() < 1e-15);
    }

    /// Of a quarter of the sky: 1/8 where none is given, 1/4 of an isotropic sky, 1/16 with the exponent 2; nothing of none.
    #[test]
    fn part_of_the_sky_by_its_exponent() {
        let numbers = [1.0, 1.5, 2.0];
        let values = Values::new(&numbers[..]);
        for (exponent, expected) in [(None, 0.125), (Some(0), 0.25), (Some(1), 0.125), (Some(2), 0.0625)] {
            let exponent = exponent.map(ParamId);
            assert!((to_sky(0.25, exponent, &values) - expected).abs() < 1e-15);
            assert!(to_sky(0.0, exponent, &values).abs() < 1e-200);
            assert!((to_sky(1.0, exponent, &values) - 1.0).abs() < 1e-15);
        }
    }

    /// The normal of the inside surface of the roof points down, that of the floor up.
    #[test]
    fn normals_of_inside_surfaces() {
        let plan = Plan::new(glazed_zone("area", false)).unwrap();
        let surfaces = Coefficients::new(&plan, &values(&plan.description)).surfaces;
        let upward = |surface: SideId| surfaces[surface].upward;
        assert_eq!((upward(SideId::outside(5)), upward(SideId::inside(5))), (1.0, -1.0));
        assert_eq!((upward(SideId::outside(4)), upward(SideId::inside(4))), (-1.0, 1.0));
    }

    /// At 10 m over open country to 10 m in suburbs, by the power laws: 1.586 x 0.4516 = 0.716.
    #[test]
    fn wind_at_the_height_of_a_surface() {
        let mut description = glazed_zone("area", false);
        let height = description.site.wind.mast_height;
        description.surfaces[0].outside.height = Some(height);
        let numbers = values(&description);
        let plan = Plan::new(description).unwrap();
        let factor = wind_factor(&plan, height, &Values::new(&numbers));
        assert!((factor - Real::powf(27.0, 0.14) * Real::powf(1.0 / 37.0, 0.22)).abs() < 1e-14);
        assert!((factor - 0.7168).abs() < 1e-4, "{factor}");
    }
}
