//! Zones: air, internal gains, ventilation, ideal heating and cooling.

use serde::Deserialize;

use super::convection::TextLaw;
use super::flow_density::FlowDensity;
use super::parameter::ParamId;
use super::published_law::PublishedLaw;

/// A volume of well-mixed air.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Zone {
    /// Name in messages and outputs.
    pub name: String,
    /// Volume [m3].
    pub volume: ParamId,
    /// Heat capacity of air and contents over that of the air alone [-].
    pub capacity_factor: ParamId,
    /// Air changes per hour with outdoors: `constant + temperature |dT| + wind V`.
    pub infiltration: Infiltration,
    /// Long-wave exchange between the surfaces of the zone.
    pub longwave: ZoneLongwave,
    /// Relative view-factor weights `A_i F_ij` between the zone's surfaces [m2 or any other unit], in the order of
    /// [`Description::surfaces`](super::Description::surfaces) (outside before inside of the same wall). Scaled in the engine so that
    /// closure and reciprocity hold exactly at the areas of the run. Empty: every surface sees every other one
    /// except those of the same tilt and azimuth.
    #[serde(default)]
    pub view_weights: Vec<Vec<f64>>,
    /// Which surfaces the sun transmitted by its windows reaches.
    #[serde(default)]
    pub sun: ZoneSun,
    /// Part of the sun transmitted by its windows that the air gets at once, by what light furniture gives off [-]. None: nothing.
    #[serde(default)]
    pub solar_to_air: Option<ParamId>,
    /// Heat from people, light and machines.
    #[serde(default)]
    pub gains: Vec<Gain>,
    /// Intended supply of outdoor air.
    #[serde(default)]
    pub ventilation: Vec<Ventilation>,
    /// Air that a fan moves within the zone. None: none.
    #[serde(default)]
    pub mixing: Option<Mixing>,
    /// Air that is warmer above than below. None: one temperature.
    #[serde(default)]
    pub stratification: Option<Stratification>,
    /// Ideal heating.
    #[serde(default)]
    pub heating: Option<IdealLoad>,
    /// Ideal cooling.
    #[serde(default)]
    pub cooling: Option<IdealLoad>,
    /// Share of the mean radiant temperature in the temperature that set points of heating and cooling hold [-]. None: the air alone.
    #[serde(default)]
    pub setpoint_radiant_share: Option<ParamId>,
    /// Whether what fans take out of the zone and do not bring in comes through the pressure network; else by leaks from outdoors.
    #[serde(default)]
    pub makeup_by_vents: bool,
}

/// A vertical gradient of the air temperature of a zone, about its mean at middle height.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stratification {
    /// Gradient, upwards [K/m]; where a channel gives it, what that is multiplied by.
    pub gradient: ParamId,
    /// Index into [`Description::channels`](super::Description::channels): what it is multiplied by. None: one.
    #[serde(default)]
    pub schedule: Option<usize>,
    /// From floor to ceiling [m].
    pub height: f64,
}

/// Infiltration of outdoor air.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Infiltration {
    /// Constant air changes [1/h].
    pub constant: ParamId,

    /// Air changes per degree between zone and outdoors [1/(h K)].
    pub temperature: ParamId,

    /// Air changes per wind speed at the mast [1/h per m/s].
    pub wind: ParamId,

    /// What a pressure test adds to them: a law of `physics/leakage`. None: nothing.
    #[serde(default)]
    pub leakage: Option<PublishedLaw>,

    /// Air changes as text, in addition. None: nothing.
    #[serde(default)]
    pub law: Option<TextLaw>,

    /// Index into [`Description::channels`](super::Description::channels): fraction of all of them [-]. None: always all.
    #[serde(default)]
    pub schedule: Option<usize>,

    /// Index into [`Description::controls`](super::Description::controls). None: not controlled.
    #[serde(default)]
    pub control: Option<usize>,

    /// Density of the air that air changes and flows are volumes of. None: that of the site.
    #[serde(default)]
    pub density: Option<FlowDensity>,
}

/// Long-wave exchange inside a zone.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum ZoneLongwave {
    /// Exact grey-diffuse exchange (radiosity), T^4.
    Radiosity,
    /// The same exchange factors, linearised about a reference temperature [degC].
    Linearised {
        /// Temperature of the tangent [degC].
        reference: ParamId,
    },
    /// No separate exchange (the surface heat transfer coefficients include it).
    None,
}

/// Distribution of the transmitted sun over a zone; equations in `building/sun_distribution.rs`.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum ZoneSun {
    /// The same irradiance on all surfaces, each absorbs by its absorptance; glass transmits a part of it outwards.
    #[default]
    Area,
    /// Given shares, scaled to a sum of one.
    Shares {
        /// Absorbed by each of the zone's surfaces, in their order [-]; none: nothing.
        #[serde(rename = "faces")]
        surfaces: Vec<Option<ParamId>>,
        /// Leaves through the windows [-]; none: nothing.
        #[serde(default)]
        lost: Option<ParamId>,
        /// Shares of the diffuse part; none: the same for all.
        #[serde(default)]
        diffuse: Option<SunShares>,
    },
    /// The beam evenly on the floor; what it reflects, and the diffuse part, as by area.
    Floor {
        /// Which of the zone's surfaces, in their order, are floor.
        floor: Vec<bool>,
    },
    /// The beam where its rays end, all else by view factors; what is reflected again by view factors.
    Geometry,
}

/// Shares of a part of the transmitted sun, scaled to a sum of one.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SunShares {
    /// Absorbed by each of the zone's surfaces, in their order [-]; none: nothing.
    pub faces: Vec<Option<ParamId>>,
    /// Leaves through the windows [-]; none: nothing.
    #[serde(default)]
    pub lost: Option<ParamId>,
}

/// Heat from people, light and machines. The radiative part is absorbed by the surfaces of the zone.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Gain {
    /// Name in messages and inputs.
    pub name: String,
    /// Heat at full schedule [W].
    pub power: ParamId,
    /// Part of it that is radiated [-].
    pub radiative: ParamId,
    /// Heat of the activity of a person [W]: the power is then all heat of people, and the air gets the sensible part of it at
    /// its temperature. None: the power is what the air gets.
    #[serde(default)]
    pub activity: Option<ParamId>,
    /// Index into [`Description::channels`](super::Description::channels): fraction of the power [-]. None: always all of it.
    #[serde(default)]
    pub schedule: Option<usize>,
}

/// Intended supply of outdoor air: either rate is given.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Ventilation {
    /// Name in messages.
    pub name: String,
    /// Air changes [1/h].
    #[serde(default)]
    pub air_changes: Option<ParamId>,
    /// Volume flow [m3/s].
    #[serde(default)]
    pub flow: Option<ParamId>,
    /// Index into [`Description::channels`](super::Description::channels): fraction of the flow [-]. None: always all of it.
    #[serde(default)]
    pub schedule: Option<usize>,
    /// Density of the air that air changes and flows are volumes of. None: that of the site.
    #[serde(default)]
    pub density: Option<FlowDensity>,
    /// Index into [`Description::controls`](super::Description::controls). None: not controlled.
    #[serde(default)]
    pub control: Option<usize>,
}

/// Air that moves within a zone; it acts on laws of convection that depend on it.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mixing {
    /// Air changes [1/h]; where a channel gives them, what that is multiplied by.
    pub air_changes: ParamId,
    /// Index into [`Description::channels`](super::Description::channels): fraction of them [-], or the air changes [1/h]. None: always all.
    #[serde(default)]
    pub schedule: Option<usize>,
}

/// Ideal heating or cooling of the air of a zone.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct IdealLoad {
    /// Set point of the air temperature, or of the temperature that [`Zone::setpoint_radiant_share`] states.
    pub setpoint: SetPoint,
    /// Largest heat that it supplies or removes [W]. None: unlimited.
    #[serde(default)]
    pub capacity: Option<ParamId>,
    /// Part that goes to the surfaces of the zone by radiation [-]. None: all of it goes to the air.
    #[serde(default)]
    pub radiative: Option<ParamId>,
    /// Index into [`Description::channels`](super::Description::channels): fraction of the capacity that is available [-]. None: always all of it.
    #[serde(default)]
    pub schedule: Option<usize>,
}

/// Set point of the air temperature [degC].
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum SetPoint {
    /// One number.
    Constant {
        /// [degC].
        temperature: ParamId,
    },
    /// Index into [`Description::channels`](super::Description::channels); the value at the end of a step counts.
    Scheduled {
        /// Index into [`Description::channels`](super::Description::channels).
        channel: usize,
    },
}
