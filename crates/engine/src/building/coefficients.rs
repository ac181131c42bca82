//! A plan with the numbers of one run (or of a pack of members in lanes).

use crate::building::glazing::{Glass, GlassWall, rated_resistance};
use crate::building::ids::{BySurface, SurfaceId};
use crate::building::plan::{Plan, WallPlan};
use crate::building::sun_distribution::{Inside, Landing};
use crate::input::description::{
    Exposure as Reach, Facing, Infiltration, Material, OutdoorLongwave, ParamId, Side, Surface, ZoneLongwave,
};
use crate::input::forcing::CLIMATE_CHANNELS;
use crate::input::values::Values;
use crate::number::real::Real;
use crate::physics::air_flow::{AirFlow, Opening, Path};
use crate::physics::constants::{AIR_GAS_CONSTANT, AIR_SPECIFIC_HEAT};
use crate::physics::convection::{Placement, SurfaceConvection};
use crate::physics::gains::{Gain, Thermostat};
use crate::physics::longwave::{Emission, direct_exchange_areas, exchange_areas, self_weight};
use crate::physics::pcm::PcmCoefficients;
use crate::physics::solar::Plane;

/// Resistance of both films of a rated U value [m2 K/W] (ISO 6946:2017, table 7: 0.13 inside, 0.04 outside).
const RATED_FILMS: f64 = 0.17;

/// Angle of a day in the year [rad/d].
pub(crate) const PER_DAY: f64 = core::f64::consts::TAU / 365.0;

/// All numbers of a run.
#[derive(Debug, Clone)]
pub struct Coefficients<S> {
    /// One per surface.
    pub walls: Vec<WallCoefficients<S>>,
    /// Two per surface.
    pub surfaces: BySurface<SurfaceCoefficients<S>>,
    /// Zones.
    pub zones: Vec<ZoneCoefficients<S>>,
    /// Air exchanged between zones.
    pub paths: Vec<Path<S>>,
    /// Solar reflectance of the ground [-].
    pub ground_reflectance: S,
    /// Cloud polynomial of the sky.
    pub cloud: [S; 3],
    /// Depth of each sensor from the outside surface [m].
    pub sensor_depths: Vec<S>,
}

/// A finite volume.
#[derive(Debug, Clone)]
pub struct Cell<S> {
    /// Thickness [m].
    pub thickness: S,
    /// What it is made of.
    pub matter: Matter<S>,
}

/// Constant or phase-changing.
#[derive(Debug, Clone)]
pub enum Matter<S> {
    /// Conductivity [W/(m K)], volumetric heat capacity [J/(m3 K)].
    Solid {
        /// Conductivity [W/(m K)].
        conductivity: S,
        /// Volumetric heat capacity [J/(m3 K)].
        capacity: S,
    },
    /// Index into [`Wall::pcm`].
    Pcm(usize),
}

/// A wall.
#[derive(Debug, Clone)]
pub struct WallCoefficients<S> {
    /// Area [m2].
    pub area: S,
    /// Cells, outside to inside.
    pub cells: Vec<Cell<S>>,
    /// Massless resistance in each link [m2 K/W].
    pub extra: Vec<S>,
    /// Whether a massless layer lies in a link.
    pub massless: Vec<bool>,
    /// Phase-change laws of its layers.
    pub pcm: Vec<PcmCoefficients<S>>,
    /// Resistance of each massless layer, zero for the others [m2 K/W].
    pub layer_resistance: Vec<S>,
    /// A window's optics and gaps.
    pub glass: Option<Glass<S>>,
}

/// What drives a surface that is not in a zone.
#[derive(Debug, Clone)]
pub enum Boundary<S> {
    /// Outdoor air, sun, sky and ground.
    Outdoors(Box<Outdoors<S>>),
    /// A temperature, through the film if there is one.
    Imposed(Imposed<S>),
    /// Nothing.
    Adiabatic,
    /// A zone: solved in the room block.
    Zone,
}

/// Numbers of an outdoor surface.
#[derive(Debug, Clone)]
pub struct Outdoors<S> {
    /// Geometry seen by the sun.
    pub plane: Plane<S>,
    /// Unit azimuth vector (north, east) of the normal, for the wind.
    pub heading: [S; 2],
    /// Weight of the sky in the long-wave radiation that arrives; the rest comes from the air and the ground [-].
    pub to_sky: S,
    /// Long-wave law; none: the film is combined.
    pub emission: Option<Emission<S>>,
}

/// Imposed temperatures.
#[derive(Debug, Clone)]
pub enum Imposed<S> {
    /// Forcing channel.
    Channel(usize),
    /// `mean - amplitude cos(2 pi (day - coldest)/365)`.
    Annual {
        /// Annual mean [degC].
        mean: S,
        /// Amplitude times cosine and sine of the coldest day's angle [K].
        swing: [S; 2],
    },
}

/// A surface.
#[derive(Debug, Clone)]
pub struct SurfaceCoefficients<S> {
    /// SurfaceConvection; none: no convection.
    pub convection: Option<SurfaceConvection<S>>,
    /// Convective area over plane area.
    pub area_factor: S,
    /// Upward component of the normal that points into the air.
    pub upward: S,
    /// Long-wave emissivity.
    pub emissivity: S,
    /// Solar absorptance.
    pub absorptance: S,
    /// Forcing channel of a measured irradiance on the plane.
    pub irradiance: Option<usize>,
    /// What it borders on.
    pub boundary: Boundary<S>,
    /// What of the weather reaches it.
    pub exposure: Reach,
}

/// A zone.
#[derive(Debug, Clone)]
pub struct ZoneCoefficients<S> {
    /// Heat capacity of the air and contents [J/K].
    pub capacity: S,
    /// Heat capacity of the zone's air volume [J/K], for air changes.
    pub air_capacity: S,
    /// [1/h], [1/(h K)], [1/(h m/s)].
    pub infiltration: [S; 3],
    /// Exchange areas between its surfaces [m2]; empty without separate exchange.
    pub exchange: Vec<S>,
    /// Sum of each surface's exchange areas with the others [m2].
    pub exchange_sums: Vec<S>,
    /// Law of emission.
    pub emission: Emission<S>,
    /// Areas of its surfaces [m2].
    pub areas: Vec<S>,
    /// Heat from people, light and machines.
    pub gains: Vec<Gain<S>>,
    /// Share of each surface in the heat that gains radiate [-].
    pub radiant_shares: Vec<S>,
    /// Outdoor air let in on purpose.
    pub ventilation: Vec<AirFlow<S>>,
    /// Openings to outdoors.
    pub openings: Vec<Opening<S>>,
    /// Ideal heating.
    pub heating: Option<Thermostat<S>>,
    /// Ideal cooling.
    pub cooling: Option<Thermostat<S>>,
    /// Where the sun that enters lands; none without windows.
    pub landing: Option<Landing<S>>,
}

impl<S: Real> Coefficients<S> {
    /// Evaluates a plan at a parameter vector.
    #[must_use]
    pub fn new(plan: &Plan, numbers: &[S]) -> Self {
        let values = Values::new(numbers);
        let description = &plan.description;
        let walls: Vec<_> = (0..plan.walls.len()).map(|i| WallCoefficients::new(plan, i, &values)).collect();
        let surfaces: BySurface<_> =
            plan.surfaces.ids().map(|i| SurfaceCoefficients::new(plan, i, &values)).collect();
        let site = &description.site;
        let density = air_density(plan, &values);
        let zones = (0..plan.zones.len())
            .map(|i| ZoneCoefficients::new(plan, i, &values, &walls, &surfaces, density))
            .collect();
        let paths = description.air_paths.iter().map(|path| Path::new(path, &values, density)).collect();
        Self {
            walls,
            surfaces,
            zones,
            paths,
            ground_reflectance: values.get(site.ground_reflectance),
            cloud: site.cloud.map(|id| values.get(id)),
            sensor_depths: description.sensors.iter().map(|sensor| values.get(sensor.depth)).collect(),
        }
    }
}

/// Density of the air that fills the zones [kg/m3].
fn air_density<S: Real>(plan: &Plan, values: &Values<'_, S>) -> S {
    let site = &plan.description.site;
    site.air_density.map_or_else(|| density_at(values.get(site.altitude)), |id| values.get(id))
}

/// Density of dry air [kg/m3] at an altitude [m]: pressure of the standard atmosphere (ICAO Doc 7488) at 15 degC.
fn density_at<S: Real>(altitude: S) -> S {
    let pressure = (S::one() - altitude.scale(2.255_77e-5)).powf(S::constant(5.255_88)).scale(101_325.0);
    pressure.scale(1.0 / (AIR_GAS_CONSTANT * 288.15))
}

fn radians<S: Real>(degrees: S) -> S {
    degrees.scale(core::f64::consts::PI / 180.0)
}

impl<S: Real> WallCoefficients<S> {
    fn new(plan: &Plan, index: usize, values: &Values<'_, S>) -> Self {
        let description = &plan.description;
        let described = &description.surfaces[index];
        let construction = &description.constructions[described.construction];
        let wall: &WallPlan = &plan.walls[index];
        let area = own_area(described, values);
        if let (Some(glazing), Some(glass)) = (&construction.glazing, &wall.glass) {
            let GlassWall { cells, extra, glass } = GlassWall::new(values, glazing, glass, described);
            let massless = vec![true; extra.len()];
            let (pcm, layer_resistance) = (Vec::new(), Vec::new());
            return Self { area, cells, extra, massless, pcm, layer_resistance, glass: Some(glass) };
        }
        let mut pcm = Vec::new();
        let mut cells = Vec::with_capacity(wall.len());
        let layer_resistance: Vec<S> =
            construction.layers.iter().map(|layer| resistance(plan, layer.material, values)).collect();
        for (layer, &(start, end)) in construction.layers.iter().zip(&wall.layer_cells) {
            let thickness = values.get_or(layer.thickness, 0.0);
            let matter = match &description.materials[layer.material] {
                Material::Resistance { .. } | Material::Rated { .. } => continue,
                Material::Solid { conductivity, density, specific_heat } => Matter::Solid {
                    conductivity: values.get(*conductivity),
                    capacity: values.get(*density) * values.get(*specific_heat),
                },
                Material::Pcm { conductivity, density, specific_heat, law } => {
                    pcm.push(PcmCoefficients::new(values, *conductivity, *density, *specific_heat, law));
                    Matter::Pcm(pcm.len() - 1)
                }
            };
            #[allow(clippy::cast_precision_loss, reason = "node counts are small")]
            let share = 1.0 / (end - start) as f64;
            for _ in start..end {
                cells.push(Cell { thickness: thickness.scale(share), matter: matter.clone() });
            }
        }
        let extra = wall
            .link_layers
            .iter()
            .map(|layers| layers.iter().fold(S::zero(), |sum, &layer| sum + layer_resistance[layer]));
        let extra = extra.collect();
        let massless = wall.link_layers.iter().map(|layers| !layers.is_empty()).collect();
        Self { area, extra, massless, cells, pcm, layer_resistance, glass: None }
    }
}

/// What openings and frame leave of a surface's area [m2].
fn own_area<S: Real>(wall: &Surface, values: &Values<'_, S>) -> S {
    let whole = values.get(wall.area);
    if let Some(frame) = &wall.frame {
        let fraction = values.get(frame.fraction);
        return whole * if frame.is_frame { fraction } else { S::one() - fraction };
    }
    wall.openings.iter().fold(whole, |rest, opening| rest - values.get(*opening))
}

/// Resistance of a massless material, zero for others [m2 K/W].
fn resistance<S: Real>(plan: &Plan, material: usize, values: &Values<'_, S>) -> S {
    match &plan.description.materials[material] {
        Material::Resistance { resistance } => values.get(*resistance),
        Material::Rated { u_value } => rated_resistance(values.get(*u_value), S::constant(RATED_FILMS)),
        Material::Solid { .. } | Material::Pcm { .. } => S::zero(),
    }
}

impl<S: Real> SurfaceCoefficients<S> {
    fn new(plan: &Plan, index: SurfaceId, values: &Values<'_, S>) -> Self {
        let wall = &plan.description.surfaces[index.wall()];
        let side = plan.side(index);
        let degrees = values.get(wall.tilt);
        let tilt = radians(degrees);
        let outward = if index.is_outside() { S::one() } else { -S::one() };
        let placement = Placement {
            area: own_area(wall, values),
            upward: outward * tilt.cos(),
            wind_factor: side.height.map_or_else(S::one, |height| wind_factor(plan, height, values)),
            inclination: degrees.min(S::constant(180.0) - degrees),
            density: air_density(plan, values),
        };
        Self {
            convection: side.convection.as_ref().map(|law| SurfaceConvection::new(values, law, &placement)),
            area_factor: values.get_or(side.area_factor, 1.0),
            upward: placement.upward,
            emissivity: values.get_or(side.emissivity, 0.0),
            absorptance: values.get_or(side.absorptance, 0.0),
            irradiance: side.irradiance.map(|channel| CLIMATE_CHANNELS + channel),
            boundary: boundary(plan, index, side, values),
            exposure: side.exposure,
        }
    }
}

fn boundary<S: Real>(plan: &Plan, index: SurfaceId, side: &Side, values: &Values<'_, S>) -> Boundary<S> {
    match side.facing {
        Facing::Zone { .. } => Boundary::Zone,
        Facing::Adiabatic => Boundary::Adiabatic,
        Facing::Measured { channel } => Boundary::Imposed(Imposed::Channel(CLIMATE_CHANNELS + channel)),
        Facing::Ground { mean, amplitude, coldest_day } => {
            let (amplitude, angle) = (values.get(amplitude), values.get(coldest_day).scale(PER_DAY));
            let swing = [amplitude * angle.cos(), amplitude * angle.sin()];
            Boundary::Imposed(Imposed::Annual { mean: values.get(mean), swing })
        }
        Facing::Outdoors => Boundary::Outdoors(Box::new(outdoors(plan, index, side, values))),
    }
}

/// The plane of a surface that looks outdoors, and its azimuth vector (north, east).
pub(crate) fn plane<S: Real>(plan: &Plan, index: SurfaceId, values: &Values<'_, S>) -> (Plane<S>, [S; 2]) {
    let (wall, side) = (&plan.description.surfaces[index.wall()], plan.side(index));
    let (tilt, azimuth) = (radians(values.get(wall.tilt)), radians(values.get(wall.azimuth)));
    // The inside surface of a surface that looks outdoors looks the other way.
    let outward = if index.is_outside() { S::one() } else { -S::one() };
    let (sin_tilt, cos_tilt) = (tilt.sin(), tilt.cos() * outward);
    let heading = [azimuth.cos() * outward, azimuth.sin() * outward];
    let sky_view = side.sky_view.map_or_else(|| (S::one() + cos_tilt).scale(0.5), |id| values.get(id));
    let normal = [heading[1] * sin_tilt, heading[0] * sin_tilt, cos_tilt];
    (Plane { normal, sin_tilt, sky_view, ground_view: (S::one() - cos_tilt).scale(0.5) }, heading)
}

fn outdoors<S: Real>(plan: &Plan, index: SurfaceId, side: &Side, values: &Values<'_, S>) -> Outdoors<S> {
    let (plane, heading) = plane(plan, index, values);
    let sky_view = plane.sky_view;
    Outdoors {
        plane,
        heading,
        // F_sky sqrt(F_sky): the sky near the horizon is as warm as the air (Walton 1983).
        to_sky: if side.exposure.sky {
            sky_view * sky_view.max(S::constant(1e-300)).sqrt()
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

/// `(delta_mast/z_mast)^a_mast (z/delta)^a`.
fn wind_factor<S: Real>(plan: &Plan, height: ParamId, values: &Values<'_, S>) -> S {
    let wind = &plan.description.site.wind;
    let get = |id| values.get(id);
    let mast = (get(wind.mast_layer) / get(wind.mast_height)).powf(get(wind.mast_exponent));
    // Below a tenth of a metre the profile has no meaning.
    let height = get(height).max(S::constant(0.1));
    mast * (height / get(wind.layer)).powf(get(wind.exponent))
}

impl<S: Real> ZoneCoefficients<S> {
    fn new(
        plan: &Plan,
        index: usize,
        values: &Values<'_, S>,
        walls: &[WallCoefficients<S>],
        surfaces: &BySurface<SurfaceCoefficients<S>>,
        density: S,
    ) -> Self {
        let definition = &plan.description.zones[index];
        let zone_surfaces = &plan.zones[index].surfaces;
        let areas: Vec<S> = zone_surfaces.iter().map(|&surface| walls[surface.wall()].area).collect();
        let emissivities: Vec<S> =
            zone_surfaces.iter().map(|&surface| surfaces[surface].emissivity).collect();
        let emission = match definition.longwave {
            ZoneLongwave::Linearised { reference } => Emission::Linearised(values.get(reference)),
            ZoneLongwave::Radiosity | ZoneLongwave::None => Emission::Exact,
        };
        let exchange = if matches!(definition.longwave, ZoneLongwave::None) || zone_surfaces.len() < 2 {
            Vec::new()
        } else {
            exchange_areas(&areas, &emissivities, &view_weights(plan, index, &areas))
        };
        let n = zone_surfaces.len();
        let others = |row: usize| (0..exchange.len() / n.max(1)).filter(move |&column| column != row);
        let sum = |row: usize| others(row).fold(S::zero(), |sum, column| sum + exchange[row * n + column]);
        let exchange_sums = (0..n).map(sum).collect();
        let air_capacity = values.get(definition.volume) * density.scale(AIR_SPECIFIC_HEAT);
        let Infiltration { constant, temperature, wind } = &definition.infiltration;
        let exchanging = !matches!(definition.longwave, ZoneLongwave::None);
        let heat = density.scale(AIR_SPECIFIC_HEAT);
        let openings = plan.description.openings.iter().filter(|opening| opening.zone == index);
        let thermostat = |ideal_load| Thermostat::new(ideal_load, values);
        Self {
            gains: definition.gains.iter().map(|gain| Gain::new(gain, values)).collect(),
            radiant_shares: radiant_shares(&areas, exchanging.then_some(&emissivities)),
            ventilation: definition
                .ventilation
                .iter()
                .map(|flow| AirFlow::new(flow, values, heat, air_capacity))
                .collect(),
            openings: openings.map(|opening| Opening::new(opening, values, heat)).collect(),
            heating: definition.heating.as_ref().map(thermostat),
            cooling: definition.cooling.as_ref().map(thermostat),
            capacity: air_capacity * values.get(definition.capacity_factor),
            air_capacity,
            infiltration: [constant, temperature, wind].map(|id| values.get(*id)),
            exchange,
            exchange_sums,
            emission,
            landing: Landing::new(
                &definition.sun,
                &Inside { zone_surfaces, areas: &areas, walls, surfaces },
                values,
                || direct_exchange_areas(&areas, &view_weights(plan, index, &areas)),
            ),
            areas,
        }
    }
}

/// Shares by area times emissivity; by area alone where the surfaces exchange no long-wave radiation.
fn radiant_shares<S: Real>(areas: &[S], emissivities: Option<&Vec<S>>) -> Vec<S> {
    let weights: Vec<S> = match emissivities {
        Some(emissivities) => areas.iter().zip(emissivities).map(|(&a, &e)| a * e).collect(),
        None => areas.to_vec(),
    };
    let total = weights.iter().fold(S::zero(), |sum, &weight| sum + weight);
    weights.into_iter().map(|weight| weight / total).collect()
}

/// Given weights, or `A_i A_j` between surfaces that do not lie in parallel planes looking the same way.
fn view_weights<S: Real>(plan: &Plan, index: usize, areas: &[S]) -> Vec<S> {
    let surfaces = &plan.zones[index].surfaces;
    let given = &plan.description.zones[index].view_weights;
    let n = surfaces.len();
    let mut weights = Vec::with_capacity(n * n);
    for i in 0..n {
        for j in 0..n {
            let weight = if given.len() == n {
                // The given weights hold the nominal areas: they follow when an area is varied.
                S::constant(given[i][j])
            } else if i == j {
                self_weight(areas, i)
            } else if !same_plane(plan, surfaces[i], surfaces[j]) {
                areas[i] * areas[j]
            } else {
                S::zero()
            };
            weights.push(weight);
        }
    }
    weights
}

/// True when two surfaces of a zone look the same way at their nominal tilt and azimuth: parts of one plane.
fn same_plane(plan: &Plan, a: SurfaceId, b: SurfaceId) -> bool {
    let normal = |surface: SurfaceId| {
        let wall = &plan.description.surfaces[surface.wall()];
        let value = |id: ParamId| plan.description.parameters[id.0 as usize].value.to_radians();
        let (tilt, azimuth) = (value(wall.tilt), value(wall.azimuth));
        let sign = if surface.is_outside() { 1.0 } else { -1.0 };
        [
            Real::sin(azimuth) * Real::sin(tilt) * sign,
            Real::cos(azimuth) * Real::sin(tilt) * sign,
            Real::cos(tilt) * sign,
        ]
    };
    let dot: f64 = normal(a).iter().zip(normal(b)).map(|(x, y)| x * y).sum();
    dot > 1.0 - 1e-9
}
