//! Coefficients of the vapour balances of the zones.

use super::air;
use super::wall::WallCoefficients;
use super::zone::ZoneCoefficients;
use crate::building::ids::SideId;
use crate::building::plan::{Plan, SideRole};
use crate::input::description::{Drying, HumidityControl, HumiditySetPoint, ZoneHumidity};
use crate::input::forcing::{CLIMATE_CHANNELS, Schedule, channel, scheduled};
use crate::input::values::Values;
use crate::number::real::Real;
use crate::physics::constants::AIR_SPECIFIC_HEAT;
use crate::physics::occupants::sensible_share;
use crate::physics::psychrometrics::{LATENT_HEAT, condensing_pressure};
use crate::physics::vapour_layers::VapourLayers;

/// Vapour that an ideal plant takes away or adds where no capacity is given [kg/s]: more than any building needs.
const UNLIMITED: f64 = 1e6;

/// Vapour in the zones of a building.
#[derive(Debug, Clone)]
pub struct HumidityCoefficients<S> {
    /// Relative humidity at the start [-].
    pub initial: S,
    /// Heat over vapour transfer coefficient of surfaces [J/(m3 K)].
    pub heat_over_vapour: S,
    /// Mass flow of air of a flow of heat capacity [kg K/J]: one over its specific heat.
    pub mass: S,
    /// Pressure of the air where the weather gives none [Pa].
    pub pressure: S,
    /// Zones.
    pub zones: Vec<VapourZone<S>>,
    /// Surfaces that take up vapour.
    pub surfaces: Vec<VapourSurface<S>>,
    /// Effectiveness of the recovery of vapour, for each ventilation unit.
    pub recoveries: Vec<Option<S>>,
}

/// Vapour in the air of a zone.
#[derive(Debug, Clone)]
pub struct VapourZone<S> {
    /// Dry air, contents included [kg].
    pub air: S,
    gains: Vec<Source<S>>,
    /// Ideal drying.
    pub drying: Option<Dryer<S>>,
    /// Ideal humidifying.
    pub humidifying: Option<Control<S>>,
}

/// A source of vapour.
#[derive(Debug, Clone)]
struct Source<S> {
    /// [kg/s].
    whole: S,
    /// Heat of the activity of a person, of whose heat only the latent part counts [W]; none: all of it is vapour.
    activity: Option<S>,
    schedule: Schedule,
}

impl<S: Real> Source<S> {
    /// Vapour in a forcing row and in air of a temperature [kg/s].
    #[inline(always)]
    fn at(&self, row: &[f64], air: S) -> S {
        let whole = scheduled(self.whole, self.schedule, row);
        match self.activity {
            Some(activity) => whole * (S::one() - sensible_share(activity, air)),
            None => whole,
        }
    }
}

/// Ideal drying.
#[derive(Debug, Clone)]
pub enum Dryer<S> {
    /// Down to a set point.
    Controlled(Control<S>),
    /// By a coil that cools the air.
    Coil {
        /// Vapour taken away per heat [kg/J].
        per_heat: S,
        /// Saturation pressure at the temperature of the coil, over ice where frost forms on it [Pa].
        saturated: S,
    },
}

/// A set point and a capacity.
#[derive(Debug, Clone)]
pub struct Control<S> {
    /// Whether the set point is a relative humidity.
    pub(crate) relative: bool,
    target: SetHumidity<S>,
    capacity: S,
    schedule: Schedule,
}

/// A set point of humidity: relative humidity [-] or humidity ratio [kg/kg].
#[derive(Debug, Clone, Copy)]
enum SetHumidity<S> {
    Constant(S),
    /// Of a channel of the forcing.
    Scheduled(usize),
}

/// A surface that takes up vapour.
#[derive(Debug, Clone)]
pub struct VapourSurface<S> {
    pub(crate) surface: SideId,
    pub(crate) zone: usize,
    pub(crate) area: S,
    pub(crate) layers: VapourLayers<S>,
}

impl<S: Real> HumidityCoefficients<S> {
    /// Evaluates the vapour balances at a parameter vector; none where the building has none.
    pub(crate) fn new(
        plan: &Plan,
        values: &Values<'_, S>,
        walls: &[WallCoefficients<S>],
        zones: &[ZoneCoefficients<S>],
    ) -> Option<Self> {
        let humidity = plan.description.humidity.as_ref()?;
        let site = &plan.description.site;
        let pressure = air::pressure_at(values.get(site.altitude));
        let specific_heat = values.get_or(site.air_specific_heat, AIR_SPECIFIC_HEAT);
        let heat = air::heat_capacity(plan, values, air::density(plan, values));
        let mass = S::one() / specific_heat;
        let of_zone = |(zone, numbers): (&ZoneHumidity, &ZoneCoefficients<S>)| {
            VapourZone::new(zone, values, numbers.air_capacity * mass)
        };
        let surfaces = humidity.buffers.iter().filter_map(|buffer| {
            let surface = SideId::new(buffer.surface, buffer.side);
            let SideRole::Zone { zone, .. } = plan.surfaces[surface].role else { return None };
            let layers = VapourLayers::new(buffer, values, pressure);
            Some(VapourSurface { surface, zone, area: walls[buffer.surface].area, layers })
        });
        Some(Self {
            initial: values.get(humidity.initial),
            heat_over_vapour: values.get(humidity.lewis) * heat,
            mass,
            pressure,
            zones: humidity.zones.iter().zip(zones).map(of_zone).collect(),
            surfaces: surfaces.collect(),
            recoveries: humidity.recoveries.iter().map(|id| id.map(|id| values.get(id))).collect(),
        })
    }
}

impl<S: Real> HumidityCoefficients<S> {
    /// Pressure of the air in a forcing row [Pa].
    #[inline(always)]
    pub(crate) fn pressure_in(&self, row: &[f64]) -> S {
        let pressure = row[channel::PRESSURE];
        if pressure.is_nan() { self.pressure } else { S::constant(pressure) }
    }
}

impl<S: Real> VapourZone<S> {
    /// `air`: dry air of the zone [kg].
    fn new(zone: &ZoneHumidity, values: &Values<'_, S>, air: S) -> Self {
        let gains = zone.gains.iter().map(|gain| Source {
            whole: values.get_or(gain.rate, 0.0) + values.get_or(gain.power, 0.0).scale(1.0 / LATENT_HEAT),
            activity: gain.activity.map(|id| values.get(id)),
            schedule: Schedule::new(gain.schedule),
        });
        let drying = zone.drying.as_ref().map(|drying| match drying {
            Drying::Controlled { control } => Dryer::Controlled(Control::new(control, values)),
            Drying::Coil { sensible_heat_ratio, temperature } => {
                let ratio = values.get(*sensible_heat_ratio);
                Dryer::Coil {
                    per_heat: (S::one() - ratio) / ratio.scale(LATENT_HEAT),
                    saturated: condensing_pressure(values.get(*temperature)),
                }
            }
        });
        Self {
            air: air * values.get(zone.storage),
            gains: gains.collect(),
            drying,
            humidifying: zone.humidifying.as_ref().map(|control| Control::new(control, values)),
        }
    }

    /// Whether it is dried or humidified.
    #[inline(always)]
    pub(crate) fn has_plants(&self) -> bool {
        self.drying.is_some() || self.humidifying.is_some()
    }

    /// Whether there are sources, or it is dried or humidified.
    #[inline(always)]
    pub(crate) fn has_sources(&self) -> bool {
        !self.gains.is_empty() || self.has_plants()
    }

    /// Vapour from all sources in a forcing row [kg/s]; `air`: of the zone at the start of the step [degC].
    #[inline(always)]
    pub(crate) fn gain(&self, row: &[f64], air: S) -> S {
        self.gains.iter().fold(S::zero(), |sum, gain| sum + gain.at(row, air))
    }

    /// Whether people are among its sources.
    pub(crate) fn has_people(&self) -> bool {
        self.gains.iter().any(|gain| gain.activity.is_some())
    }
}

impl<S: Real> Control<S> {
    fn new(control: &HumidityControl, values: &Values<'_, S>) -> Self {
        let constant = |id| SetHumidity::Constant(values.get(id));
        let of_channel = |channel| SetHumidity::Scheduled(CLIMATE_CHANNELS + channel);
        let (relative, target) = match control.setpoint {
            HumiditySetPoint::Relative { humidity } => (true, constant(humidity)),
            HumiditySetPoint::Ratio { ratio } => (false, constant(ratio)),
            HumiditySetPoint::RelativeScheduled { channel } => (true, of_channel(channel)),
            HumiditySetPoint::RatioScheduled { channel } => (false, of_channel(channel)),
        };
        let given = |id| values.get(id).scale(1.0 / LATENT_HEAT);
        Self {
            relative,
            target,
            capacity: control.capacity.map_or_else(|| S::constant(UNLIMITED), given),
            schedule: Schedule::new(control.schedule),
        }
    }

    /// Set point [-] or [kg/kg], and capacity [kg/s], in a forcing row.
    #[inline(always)]
    pub(crate) fn at(&self, row: &[f64]) -> (S, S) {
        let target = match self.target {
            SetHumidity::Constant(target) => target,
            SetHumidity::Scheduled(channel) => S::constant(row[channel]),
        };
        (target, scheduled(self.capacity, self.schedule, row))
    }
}
