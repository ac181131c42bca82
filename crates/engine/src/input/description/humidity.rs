//! Humidity of the air: sources of vapour, drying and humidifying, and vapour that surfaces take up.

use serde::Deserialize;

use super::parameter::ParamId;
use super::published_law::{PublishedLaw, WrittenNumbers};

/// The vapour balance of all zones. None in a description: air without vapour.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Humidity {
    /// Relative humidity of the airs and of the surfaces that a run, or its warm-up, starts from [-].
    pub initial: ParamId,
    /// Heat transfer coefficient of a surface over its vapour transfer coefficient times `rho c` [-].
    pub lewis: ParamId,
    /// One for each zone.
    pub zones: Vec<ZoneHumidity>,
    /// Surfaces that take up vapour.
    #[serde(default)]
    pub buffers: Vec<Buffer>,
    /// Effectiveness of the recovery of vapour, for each ventilation unit [-]; none: no recovery. Empty: none at all.
    #[serde(default)]
    pub recoveries: Vec<Option<ParamId>>,
}

/// What adds vapour to the air of a zone and takes it away.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ZoneHumidity {
    /// Vapour stored in air and contents over that of the air alone [-].
    pub storage: ParamId,
    /// Sources of vapour.
    #[serde(default)]
    pub gains: Vec<VapourGain>,
    /// Ideal drying.
    #[serde(default)]
    pub drying: Option<Drying>,
    /// Ideal humidifying.
    #[serde(default)]
    pub humidifying: Option<HumidityControl>,
}

/// A source of vapour, as heat or as mass.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VapourGain {
    /// Name in messages.
    pub name: String,
    /// Latent heat at full schedule [W].
    #[serde(default)]
    pub power: Option<ParamId>,
    /// Vapour at full schedule [kg/s].
    #[serde(default)]
    pub rate: Option<ParamId>,
    /// Heat of the activity of a person [W]: the power is then all heat of people, and the air gets the latent part of it at its
    /// temperature. None: the power is all latent.
    #[serde(default)]
    pub activity: Option<ParamId>,
    /// Index into [`Description::channels`](super::Description::channels): fraction of the source [-]. None: always all of it.
    #[serde(default)]
    pub schedule: Option<usize>,
}

/// Ideal drying of the air of a zone.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Drying {
    /// Down to a set point.
    Controlled {
        /// The set point and what is available.
        control: HumidityControl,
    },
    /// By a coil that cools the air: what it takes away follows from its sensible load.
    Coil {
        /// Sensible over total cooling [-].
        sensible_heat_ratio: ParamId,
        /// Temperature at which the air leaves the coil saturated [degC]: the air of the zone gets no drier than this.
        temperature: ParamId,
    },
}

/// Set point of a humidity, and the latent heat that is available.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HumidityControl {
    /// The set point.
    pub setpoint: HumiditySetPoint,
    /// Largest latent heat [W]. None: unlimited.
    #[serde(default)]
    pub capacity: Option<ParamId>,
    /// Index into [`Description::channels`](super::Description::channels): fraction of the capacity that is available [-]. None: always all of it.
    #[serde(default)]
    pub schedule: Option<usize>,
}

/// Set point of a humidity.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum HumiditySetPoint {
    /// Relative humidity at the temperature of the air.
    Relative {
        /// [-].
        humidity: ParamId,
    },
    /// Humidity ratio.
    Ratio {
        /// [kg/kg].
        ratio: ParamId,
    },
    /// Relative humidity that a channel gives.
    RelativeScheduled {
        /// Index into [`Description::channels`](super::Description::channels) [-].
        channel: usize,
    },
    /// Humidity ratio that a channel gives.
    RatioScheduled {
        /// Index into [`Description::channels`](super::Description::channels) [kg/kg].
        channel: usize,
    },
}

/// A surface in a zone that takes up vapour: one layer behind it, or two.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Buffer {
    /// Index into [`Description::surfaces`](super::Description::surfaces).
    pub surface: usize,
    /// 0 outside, 1 inside.
    pub side: usize,
    /// Moisture content by relative humidity.
    pub sorption: Sorption,
    /// Resistance of the material to vapour over that of still air [-].
    pub resistance_factor: ParamId,
    /// Thickness of the layer of the construction [m]: no depth is larger.
    pub thickness: ParamId,
    /// Paint: thickness of still air of the same resistance to vapour [m]. None: no paint.
    #[serde(default)]
    pub coating: Option<ParamId>,
    /// Depth of the layer at the surface.
    pub depth: Depth,
    /// Depth of a second layer behind it. None: no second layer.
    #[serde(default)]
    pub deep: Option<Depth>,
}

/// Moisture content of a material by relative humidity.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(try_from = "WrittenSorption")]
pub enum Sorption {
    /// A published law.
    Law(PublishedLaw),
    /// Straight lines between points.
    Table {
        /// Relative humidities, increasing [-].
        humidities: Vec<f64>,
        /// Moisture contents, increasing [kg/m3].
        contents: Vec<f64>,
        /// Multiplies the contents [-].
        factor: ParamId,
    },
}

/// A sorption in JSON.
#[derive(Deserialize)]
struct WrittenSorption {
    kind: String,
    humidities: Option<Vec<f64>>,
    contents: Option<Vec<f64>>,
    #[serde(flatten)]
    numbers: WrittenNumbers,
}

impl TryFrom<WrittenSorption> for Sorption {
    type Error = String;

    fn try_from(written: WrittenSorption) -> Result<Self, String> {
        let WrittenSorption { kind, humidities, contents, numbers } = written;
        let law = PublishedLaw::written(kind, numbers);
        match (law.kind.as_str(), humidities, contents) {
            ("table", Some(humidities), Some(contents)) => match law.numbers.as_slice() {
                [(name, factor)] if name == "factor" => {
                    Ok(Self::Table { humidities, contents, factor: *factor })
                }
                _ => Err("found a table with other numbers, expected its factor".into()),
            },
            ("table", ..) => Err("found a table without points, expected humidities and contents".into()),
            (_, None, None) => Ok(Self::Law(law)),
            _ => Err(format!("found points in '{}'", law.kind)),
        }
    }
}

/// Depth to which a swing of humidity penetrates.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Depth {
    /// Given.
    Given {
        /// [m].
        depth: ParamId,
    },
    /// That of a swing of this period, `sqrt(D period/pi)`.
    Period {
        /// [h].
        period: ParamId,
    },
}
