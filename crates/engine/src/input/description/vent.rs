//! Openings of the pressure network, and what opens and closes them.

use serde::Deserialize;

use super::parameter::ParamId;

/// An opening that pressure drives air through, from a zone to outdoors or to another zone; equations in `physics/vents.rs`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Vent {
    /// Name in messages.
    pub name: String,
    /// Index into [`Description::zones`](super::Description::zones).
    pub zone: usize,
    /// Index of the zone at its other end. None: outdoors.
    #[serde(default)]
    pub to: Option<usize>,
    /// Free area [m2].
    pub area: ParamId,
    /// Height of the opening itself [m]. None: so low that air passes in one direction.
    #[serde(default)]
    pub height: Option<ParamId>,
    /// Height of its middle above the ground [m].
    pub elevation: ParamId,
    /// Discharge coefficient [-].
    pub discharge: ParamId,
    /// Exponent of the pressure difference [-].
    pub exponent: ParamId,
    /// The wind on it. None: no wind reaches it, or it leads to a zone.
    #[serde(default)]
    pub wind: Option<WindOnVent>,
    /// Index into [`Description::channels`](super::Description::channels): fraction of the area that is open [-]. None: always all of it.
    #[serde(default)]
    pub schedule: Option<usize>,
    /// Index into [`Description::controls`](super::Description::controls). None: not controlled.
    #[serde(default)]
    pub control: Option<usize>,
}

impl Vent {
    /// The zones that it joins. None: it leads outdoors.
    pub(crate) fn between(&self) -> Option<[usize; 2]> {
        self.to.map(|to| [self.zone, to])
    }
}

/// The wind on an opening.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WindOnVent {
    /// Azimuth of the normal that points outdoors [deg], from -360 to 360. None: the direction has no effect.
    #[serde(default)]
    pub azimuth: Option<ParamId>,
    /// Height above the ground of the wind that the coefficients refer to [m].
    pub height: ParamId,
    /// Speed of the wind there over that on open ground around the site [-].
    pub shelter: ParamId,
    /// Coefficients by direction.
    pub pressure: WindPressure,
}

/// Wind pressure coefficients.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum WindPressure {
    /// A wall of a low building by Swami & Chandra.
    LowRise {
        /// Length of the wall over that of the next wall [-].
        side_ratio: ParamId,
    },
    /// By angle.
    Table {
        /// At equal angles of a whole turn, the first along the normal, then clockwise [-].
        coefficients: Vec<f64>,
    },
}

/// What opens and closes openings: all of its conditions hold where they are open.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VentControl {
    /// Name in messages.
    pub name: String,
    /// Index of the zone whose air it measures.
    pub zone: usize,
    /// Temperature of the zone above limits [degC].
    #[serde(default)]
    pub indoor: Option<Band>,
    /// Temperature of the outdoor air above limits [degC].
    #[serde(default)]
    pub outdoor: Option<Band>,
    /// Temperature of the zone below limits [degC].
    #[serde(default)]
    pub indoor_below: Option<Band>,
    /// Temperature of the outdoor air below limits [degC].
    #[serde(default)]
    pub outdoor_below: Option<Band>,
    /// Index of the zone whose air takes the place of the outdoor air in `difference`. None: the outdoor air.
    #[serde(default)]
    pub reference_zone: Option<usize>,
    /// Temperature of the zone less that of the outdoor air, or of another zone, above limits [K].
    #[serde(default)]
    pub difference: Option<Band>,
    /// Wind at the mast below limits [m/s].
    #[serde(default)]
    pub wind: Option<Band>,
    /// A channel, such as rain, below limits.
    #[serde(default)]
    pub rain: Option<ChannelBand>,
    /// Time for which it stays open once it has opened, wind and rain apart [min]. None: 0.
    #[serde(default)]
    pub minimum_open_time: Option<ParamId>,
    /// Time for which it stays closed once it has closed [min]. None: 0.
    #[serde(default)]
    pub minimum_closed_time: Option<ParamId>,
}

/// Limits of a condition.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Band {
    /// Beyond it the condition lets open what is closed.
    pub open: ParamId,
    /// Beyond it, on the other side, it closes what is open.
    pub close: ParamId,
}

/// Limits of a channel.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ChannelBand {
    /// Index into [`Description::channels`](super::Description::channels).
    pub channel: usize,
    /// Limits.
    pub band: Band,
}
