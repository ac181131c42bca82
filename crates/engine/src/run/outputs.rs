//! What a run records: quantities read at the end of a step.

use serde::Deserialize;

use crate::building::coefficients::{Matter, WallCoefficients};
use crate::building::ids::SurfaceId;
use crate::building::plan::{Plan, SurfaceRole};
use crate::error::EngineError;
use crate::number::real::Real;
use crate::physics::psychrometrics::{dew_point, relative_humidity, wet_bulb};
use crate::step::readings::Readings;
use crate::step::state::State;

/// A quantity to record.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Output {
    /// Air temperature of a zone [degC].
    AirTemperature {
        /// Index of the zone.
        zone: usize,
    },
    /// Area-weighted mean temperature of a zone's surfaces [degC].
    MeanRadiantTemperature {
        /// Index of the zone.
        zone: usize,
    },
    /// Temperature of a surface [degC]; side 0 outside, 1 inside.
    FaceTemperature {
        /// Index of the wall or window.
        surface: usize,
        /// 0 outside, 1 inside.
        side: usize,
    },
    /// Conduction through a surface [W/m2], positive towards the inside.
    FaceFlux {
        /// Index of the wall or window.
        surface: usize,
        /// 0 outside, 1 inside.
        side: usize,
    },
    /// Temperature between layer `interface - 1` and `interface`, counted from outside [degC].
    InterfaceTemperature {
        /// Index of the wall or window.
        surface: usize,
        /// Layers before it.
        interface: usize,
    },
    /// Conduction through the middle of a layer [W/m2], positive towards the inside.
    LayerFlux {
        /// Index of the wall or window.
        surface: usize,
        /// Index of the layer, counted from outside.
        layer: usize,
    },
    /// Mean temperature of a layer over its volume [degC].
    LayerTemperature {
        /// Index of the wall or window.
        surface: usize,
        /// Index of the layer, counted from outside.
        layer: usize,
    },
    /// Mean liquid fraction of a layer [-].
    LiquidFraction {
        /// Index of the wall or window.
        surface: usize,
        /// Index of the layer, counted from outside.
        layer: usize,
    },
    /// Mean enthalpy of a layer above its law's reference [J/m3].
    LayerEnthalpy {
        /// Index of the wall or window.
        surface: usize,
        /// Index of the layer, counted from outside.
        layer: usize,
    },
    /// Ideal heating of a zone, mean over the step [W].
    HeatingLoad {
        /// Index of the zone.
        zone: usize,
    },
    /// Ideal heating less ideal cooling of a zone, mean over the step [W].
    NetLoad {
        /// Index of the zone.
        zone: usize,
    },
    /// Ideal cooling of a zone, mean over the step [W].
    CoolingLoad {
        /// Index of the zone.
        zone: usize,
    },
    /// Outdoor air entering a zone: infiltration, ventilation and openings [1/h].
    AirChanges {
        /// Index of the zone.
        zone: usize,
    },
    /// Short-wave radiation on the outside surface, after shading, mean over the step [W/m2].
    IncidentSolar {
        /// Index of the wall or window.
        surface: usize,
    },
    /// Sun that a window transmits, mean over the step [W].
    TransmittedSolar {
        /// Index of the wall or window.
        surface: usize,
    },
    /// Sun that the windows of a zone transmit, mean over the step [W].
    ZoneTransmittedSolar {
        /// Index of the zone.
        zone: usize,
    },
    /// Sun that leaves a zone through its windows again, mean over the step [W].
    ZoneLostSolar {
        /// Index of the zone.
        zone: usize,
    },
    /// Sun that a window transmits over the sun on it, zero without sun, mean over the step [-].
    SolarTransmittance {
        /// Index of the wall or window.
        surface: usize,
    },
    /// Sun absorbed at a surface, or by all panes of a window, mean over the step [W/m2].
    AbsorbedSolar {
        /// Index of the wall or window.
        surface: usize,
        /// 0 outside, 1 inside.
        side: usize,
    },
    /// Long-wave radiation that a surface gains from its surroundings at the end of the step [W/m2].
    NetLongwave {
        /// Index of the wall or window.
        surface: usize,
        /// 0 outside, 1 inside.
        side: usize,
    },
    /// Convective surface heat transfer coefficient at the end of the step [W/(m2 K)].
    Convection {
        /// Index of the wall or window.
        surface: usize,
        /// 0 outside, 1 inside.
        side: usize,
    },
    /// Humidity ratio of the air of a zone [kg/kg].
    HumidityRatio {
        /// Index of the zone.
        zone: usize,
    },
    /// Relative humidity of the air of a zone [-].
    RelativeHumidity {
        /// Index of the zone.
        zone: usize,
    },
    /// Dew point of the air of a zone [degC].
    DewPoint {
        /// Index of the zone.
        zone: usize,
    },
    /// Wet-bulb temperature of the air of a zone [degC].
    WetBulb {
        /// Index of the zone.
        zone: usize,
    },
    /// Latent heat that ideal drying takes away, mean over the step [W].
    LatentCooling {
        /// Index of the zone.
        zone: usize,
    },
    /// Latent heat that ideal humidifying adds, mean over the step [W].
    LatentHeating {
        /// Index of the zone.
        zone: usize,
    },
    /// Relative humidity of the air of a zone at the temperature of a surface in it [-].
    SurfaceHumidity {
        /// Index of the wall or window.
        surface: usize,
        /// 0 outside, 1 inside.
        side: usize,
    },
    /// 1 where a surface in a zone is colder than the dew point of its air, else 0 [-].
    Condensation {
        /// Index of the wall or window.
        surface: usize,
        /// 0 outside, 1 inside.
        side: usize,
    },
    /// Air into the zone of an opening of the pressure network, in the last stage [m3/s].
    VentInflow {
        /// Index of the opening.
        vent: usize,
    },
    /// Air out of the zone of an opening of the pressure network, in the last stage [m3/s].
    VentOutflow {
        /// Index of the opening.
        vent: usize,
    },
    /// Open fraction of an opening of the pressure network, in the last stage [-].
    VentOpen {
        /// Index of the opening.
        vent: usize,
    },
    /// 1 where a control lets openings open, else 0, during the step [-].
    ControlOpen {
        /// Index of the control.
        control: usize,
    },
    /// Temperature of the sky as a black body [degC].
    SkyTemperature,
    /// Temperature at a sensor [degC].
    Sensor {
        /// Index of the sensor.
        sensor: usize,
    },
}

impl Output {
    /// Checks that the zone, wall, layer or sensor exists.
    ///
    /// # Errors
    /// [`EngineError::Input`].
    pub fn check(&self, plan: &Plan) -> Result<(), EngineError> {
        let description = &plan.description;
        let layers = |surface: usize| {
            let construction = description.surfaces.get(surface).map(|s| s.construction);
            construction.map_or(0, |index| description.constructions[index].layers.len())
        };
        let known = match *self {
            Self::AirTemperature { zone }
            | Self::MeanRadiantTemperature { zone }
            | Self::HeatingLoad { zone }
            | Self::NetLoad { zone }
            | Self::CoolingLoad { zone }
            | Self::AirChanges { zone }
            | Self::ZoneTransmittedSolar { zone }
            | Self::ZoneLostSolar { zone } => zone < plan.zones.len(),
            Self::HumidityRatio { zone }
            | Self::RelativeHumidity { zone }
            | Self::DewPoint { zone }
            | Self::WetBulb { zone }
            | Self::LatentCooling { zone }
            | Self::LatentHeating { zone } => plan.humidity.is_some() && zone < plan.zones.len(),
            Self::SurfaceHumidity { surface, side } | Self::Condensation { surface, side } => {
                plan.humidity.is_some()
                    && surface < plan.walls.len()
                    && side < 2
                    && matches!(plan.surfaces[SurfaceId::new(surface, side)].role, SurfaceRole::Zone { .. })
            }
            Self::IncidentSolar { surface } => surface < plan.walls.len(),
            Self::TransmittedSolar { surface } | Self::SolarTransmittance { surface } => {
                plan.windows.contains(&surface)
            }
            Self::SkyTemperature => true,
            Self::FaceTemperature { surface, side }
            | Self::FaceFlux { surface, side }
            | Self::AbsorbedSolar { surface, side }
            | Self::NetLongwave { surface, side }
            | Self::Convection { surface, side } => surface < plan.walls.len() && side < 2,
            Self::InterfaceTemperature { surface, interface } => interface > 0 && interface < layers(surface),
            Self::LayerFlux { surface, layer } => layer < layers(surface),
            Self::LayerTemperature { surface, layer }
            | Self::LiquidFraction { surface, layer }
            | Self::LayerEnthalpy { surface, layer } => {
                layer < layers(surface)
                    && plan.walls[surface].layer_cells[layer].1 > plan.walls[surface].layer_cells[layer].0
            }
            Self::VentInflow { vent } | Self::VentOutflow { vent } | Self::VentOpen { vent } => {
                vent < description.vents.len()
            }
            Self::ControlOpen { control } => control < description.controls.len(),
            Self::Sensor { sensor } => sensor < description.sensors.len(),
        };
        if known {
            Ok(())
        } else {
            Err(EngineError::Input(format!("there is nothing to record for {self:?}")))
        }
    }

    /// Whether it is the mean over the step of the sun that surfaces absorb, which is averaged on request only.
    #[must_use]
    pub fn averages_absorbed_sun(&self) -> bool {
        matches!(self, Self::AbsorbedSolar { .. })
    }

    /// Reads the quantity after a step.
    // Long because each quantity has its own line.
    pub(crate) fn read<S: Real>(&self, plan: &Plan, step: &Readings<'_, S>, state: &State<S>) -> S {
        match *self {
            Self::AirTemperature { zone } => state.air[zone],
            Self::MeanRadiantTemperature { zone } => mean_radiant(plan, step, state, zone),
            Self::HeatingLoad { zone } => state.load[zone].max(S::zero()),
            Self::NetLoad { zone } => state.load[zone],
            Self::CoolingLoad { zone } => (-state.load[zone]).max(S::zero()),
            Self::AirChanges { zone } => step.air_changes(zone, state.air[zone]),
            Self::FaceTemperature { surface, side } => state.surfaces[SurfaceId::new(surface, side)],
            Self::FaceFlux { surface, side } => {
                step.link_flux(state, surface, side * plan.walls[surface].len())
            }
            Self::InterfaceTemperature { surface, interface } => {
                interface_temperature(plan, step, state, surface, interface)
            }
            Self::LayerFlux { surface, layer } => layer_flux(plan, step, state, surface, layer),
            Self::LayerTemperature { surface, layer } => layer_mean(plan, surface, layer, |k| state.cells[k]),
            Self::LiquidFraction { surface, layer } => {
                layer_mean(plan, surface, layer, |k| state.memory[k].liquid_fraction)
            }
            Self::LayerEnthalpy { surface, layer } => {
                layer_mean(plan, surface, layer, |k| step.enthalpy(state, surface, k))
            }
            Self::IncidentSolar { surface } => step.incident(SurfaceId::outside(surface)),
            Self::TransmittedSolar { surface } => transmitted(plan, step, surface),
            Self::SolarTransmittance { surface } => {
                let on =
                    step.model.coefficients.walls[surface].area * step.incident(SurfaceId::outside(surface));
                let dark = on.lt(S::constant(1e-9));
                let part = transmitted(plan, step, surface) / S::select(dark, S::one(), on);
                S::select(dark, S::zero(), part)
            }
            Self::ZoneTransmittedSolar { zone } => step.weather.sun.zones[zone],
            Self::ZoneLostSolar { zone } => step.weather.sun.lost[zone],
            Self::AbsorbedSolar { surface, side } => step.weather.absorbed(SurfaceId::new(surface, side)),
            Self::NetLongwave { surface, side } => step.net_longwave(state, SurfaceId::new(surface, side)),
            Self::Convection { surface, side } => step.convection(state, SurfaceId::new(surface, side)),
            Self::HumidityRatio { zone } => state.vapour[zone],
            Self::RelativeHumidity { zone } => {
                relative_humidity(state.air[zone], state.vapour[zone], step.pressure())
            }
            Self::DewPoint { zone } => dew_point(state.vapour[zone], step.pressure()),
            Self::WetBulb { zone } => wet_bulb(state.air[zone], state.vapour[zone], step.pressure()),
            Self::LatentCooling { zone } => step.latent(zone, false),
            Self::LatentHeating { zone } => step.latent(zone, true),
            Self::SurfaceHumidity { surface, side } => {
                step.surface_humidity(state, SurfaceId::new(surface, side))
            }
            Self::Condensation { surface, side } => {
                let condenses = step.condenses(state, SurfaceId::new(surface, side));
                S::select(condenses, S::one(), S::zero())
            }
            Self::VentInflow { vent } => step.vents_now().flows[vent][1],
            Self::VentOutflow { vent } => step.vents_now().flows[vent][0],
            Self::VentOpen { vent } => step.vents_now().open[vent],
            Self::ControlOpen { control } => state.opened[control],
            Self::SkyTemperature => step.sky_temperature(),
            Self::Sensor { sensor } => {
                let surface = plan.description.sensors[sensor].surface;
                let depth = step.model.coefficients.sensor_depths[sensor];
                profile_at(&profile(plan, step, state, surface), depth)
            }
        }
    }
}

/// Sun that a window transmits, mean over the step [W].
fn transmitted<S: Real>(plan: &Plan, step: &Readings<'_, S>, surface: usize) -> S {
    let window = plan.windows.iter().position(|&w| w == surface);
    window.map_or_else(S::zero, |window| step.weather.sun.windows[window])
}

fn mean_radiant<S: Real>(plan: &Plan, step: &Readings<'_, S>, state: &State<S>, zone: usize) -> S {
    let areas = &step.model.coefficients.zones[zone].areas;
    let (mut sum, mut total) = (S::zero(), S::zero());
    for (&surface, &area) in plan.zones[zone].surfaces.iter().zip(areas) {
        sum += area * state.surfaces[surface];
        total += area;
    }
    sum / total
}

#[allow(clippy::cast_precision_loss, reason = "cell counts are small")]
fn layer_mean<S: Real>(plan: &Plan, surface: usize, layer: usize, value: impl Fn(usize) -> S) -> S {
    let wall = &plan.walls[surface];
    let (start, end) = wall.layer_cells[layer];
    let sum = (start..end).fold(S::zero(), |sum, i| sum + value(wall.first_cell + i));
    sum.scale(1.0 / (end - start) as f64)
}

/// Flux at the middle of a layer: along the middle link, or the mean of the two about the middle cell.
fn layer_flux<S: Real>(
    plan: &Plan,
    step: &Readings<'_, S>,
    state: &State<S>,
    surface: usize,
    layer: usize,
) -> S {
    let (start, end) = plan.walls[surface].layer_cells[layer];
    let (first, last) = (usize::midpoint(start, end), (start + end).div_ceil(2));
    (step.link_flux(state, surface, first) + step.link_flux(state, surface, last)).scale(0.5)
}

/// Half of a cell's resistance at its present state [m2 K/W].
fn half_resistance<S: Real>(wall: &WallCoefficients<S>, state: &State<S>, first_cell: usize, i: usize) -> S {
    let half = wall.cells[i].thickness.scale(0.5);
    match wall.cells[i].matter {
        Matter::Solid { conductivity, .. } => half / conductivity,
        Matter::Pcm(law) => {
            let k = first_cell + i;
            half / wall.pcm[law].at(state.cells[k], &state.memory[k]).conductivity
        }
    }
}

/// Temperature on the inner side of the layers before `interface`, from the flux that crosses it.
fn interface_temperature<S: Real>(
    plan: &Plan,
    step: &Readings<'_, S>,
    state: &State<S>,
    surface: usize,
    interface: usize,
) -> S {
    let (wall, numbers) = (&plan.walls[surface], &step.model.coefficients.walls[surface]);
    // The link that holds the interface follows the cells of all layers before it.
    let link = wall.layer_cells[interface - 1].1;
    let flux = step.link_flux(state, surface, link);
    let (mut temperature, mut resistance) = if link == 0 {
        (state.surfaces[SurfaceId::outside(surface)], S::zero())
    } else {
        let half = half_resistance(numbers, state, wall.first_cell, link - 1);
        (state.cells[wall.first_cell + link - 1], half)
    };
    for &layer in wall.link_layers[link].iter().filter(|&&layer| layer < interface) {
        resistance += numbers.layer_resistance[layer];
    }
    temperature = temperature - flux * resistance;
    temperature
}

/// Temperatures and depths of the surfaces, cell centres and interfaces of a wall, outside to inside.
fn profile<S: Real>(plan: &Plan, step: &Readings<'_, S>, state: &State<S>, surface: usize) -> Vec<(S, S)> {
    let (wall, numbers) = (&plan.walls[surface], &step.model.coefficients.walls[surface]);
    let at = |surface: SurfaceId| state.surfaces[surface];
    let mut depth = S::zero();
    let mut points = vec![(depth, at(SurfaceId::outside(surface)))];
    for (layer, &(start, end)) in wall.layer_cells.iter().enumerate() {
        if layer > 0 {
            points.push((depth, interface_temperature(plan, step, state, surface, layer)));
        }
        for i in start..end {
            let half = numbers.cells[i].thickness.scale(0.5);
            points.push((depth + half, state.cells[wall.first_cell + i]));
            depth += numbers.cells[i].thickness;
        }
    }
    points.push((depth, at(SurfaceId::inside(surface))));
    points
}

/// Piecewise linear interpolation in a profile, without a branch on the depth (it may differ between lanes).
fn profile_at<S: Real>(points: &[(S, S)], depth: S) -> S {
    let mut temperature = points[0].1;
    for pair in points.windows(2) {
        let ((x0, t0), (x1, t1)) = (pair[0], pair[1]);
        let length = x1 - x0;
        let thin = length.lt(S::constant(1e-12));
        let inside = ((depth - x0) / length.max(S::constant(1e-12))).max(S::zero()).min(S::one());
        let beyond = S::select(x0.lt(depth), S::one(), S::zero());
        temperature += S::select(thin, beyond, inside) * (t1 - t0);
    }
    temperature
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Between two points on a straight line, constant beyond the ends, and a jump over a layer without thickness.
    #[test]
    fn a_profile_is_read_between_its_points() {
        let points = [(0.0, 10.0), (0.1, 20.0), (0.1, 26.0), (0.3, 22.0)];
        for (depth, expected) in
            [(-1.0, 10.0), (0.0, 10.0), (0.05, 15.0), (0.2, 24.0), (0.3, 22.0), (9.0, 22.0)]
        {
            let found: f64 = profile_at(&points, depth);
            assert!((found - expected).abs() < 1e-12, "{found} at {depth}, expected {expected}");
        }
    }
}
