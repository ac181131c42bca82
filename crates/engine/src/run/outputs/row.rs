//! What a row of the table of outputs says, and the macro that makes the outputs of the rows.

use serde::Serialize;

use crate::building::ids::SideId;
use crate::building::plan::{Plan, SideRole};
use crate::error::EngineError;
use crate::input::description::HeatingMeans;
pub(super) use crate::input::description::OutputPlace as Place;
use crate::number::real::Real;
use crate::step::readings::Readings;
use crate::step::state::State;

/// A row of the table: everything about a quantity but its value.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Row {
    /// Parts of a building that have it.
    pub of: Of,
    /// Its names in a building, with a comma between those of different parts: words in capitals stand for names of the description,
    /// `SIDE` for `outside` or `inside`, `N` for a number; a second name follows `or`.
    pub name: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// Whether it is a mean over a step or a state at its end.
    pub time: Time,
    /// Title of figures of it.
    pub label: &'static str,
    /// Whether a run records it when no outputs are named.
    pub usual: bool,
    /// Least and largest value that it can have [its unit]; JSON has no infinite numbers.
    #[serde(skip)]
    pub limits: [f64; 2],
}

impl Row {
    const fn new(of: Of, name: &'static str, unit: &'static str, time: Time, label: &'static str) -> Self {
        Self { of, name, unit, time, label, usual: false, limits: [f64::NEG_INFINITY, f64::INFINITY] }
    }

    /// A state at the end of a step.
    pub const fn state(of: Of, name: &'static str, unit: &'static str, label: &'static str) -> Self {
        Self::new(of, name, unit, Time::State, label)
    }

    /// A mean over a step.
    pub const fn mean(of: Of, name: &'static str, unit: &'static str, label: &'static str) -> Self {
        Self::new(of, name, unit, Time::Mean, label)
    }

    /// Recorded where no outputs are named.
    #[must_use]
    pub const fn usual(self) -> Self {
        Self { usual: true, ..self }
    }

    /// Nothing beyond these limits is possible.
    #[must_use]
    pub const fn within(self, least: f64, most: f64) -> Self {
        Self { limits: [least, most], ..self }
    }

    /// Nothing below zero is possible.
    #[must_use]
    pub const fn not_negative(self) -> Self {
        self.within(0.0, f64::INFINITY)
    }
}

/// When a record has its value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Time {
    /// At the end of a step.
    State,
    /// The mean over a step.
    Mean,
}

/// A row with its kind and sentence, as other languages read it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Entry {
    /// Kind: the name of the output in JSON.
    pub kind: String,
    /// What it is, in one sentence.
    pub meaning: String,
    /// For what there is such an output.
    pub exists: &'static str,
    /// The row.
    #[serde(flatten)]
    pub row: Row,
}

impl Entry {
    /// From the name of the variant and the lines of its documentation.
    pub(super) fn new(variant: &str, documentation: &[&str], row: Row) -> Self {
        let mut kind = String::new();
        for letter in variant.chars() {
            if letter.is_uppercase() && !kind.is_empty() {
                kind.push('_');
            }
            kind.extend(letter.to_lowercase());
        }
        let lines: Vec<&str> = documentation.iter().map(|line| line.trim()).collect();
        let meaning = lines.join(" ").trim_end_matches('.').to_owned();
        Self { kind, meaning, exists: row.of.exists(), row }
    }
}

/// Parts of a building that have a quantity. `python/mascarin/building/outputs/locations.py` lists the parts of a description.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Of {
    /// Zones.
    Zone,
    /// Zones with ideal heating.
    HeatedZone,
    /// Zones with ideal cooling.
    CooledZone,
    /// Zones with one of both.
    ConditionedZone,
    /// Zones with windows.
    SunlitZone,
    /// Zones with stratified air.
    StratifiedZone,
    /// Zones of a building with humidity.
    HumidZone,
    /// Zones with ideal drying.
    DriedZone,
    /// Zones with ideal humidifying.
    HumidifiedZone,
    /// Sides of surfaces and windows.
    Side,
    /// Sides that the sun may reach.
    SunlitSide,
    /// Sides with long-wave exchange of their own.
    RadiatingSide,
    /// Sides with convection.
    ConvectiveSide,
    /// Sides in the humid air of a zone.
    HumidSide,
    /// Surfaces and windows outdoors.
    OutdoorSurface,
    /// Windows.
    Window,
    /// Windows outdoors.
    OutdoorWindow,
    /// Places between two layers.
    Interface,
    /// Layers.
    Layer,
    /// Layers that melt.
    MeltingLayer,
    /// Openings of the pressure network.
    Vent,
    /// Controls of openings.
    Control,
    /// Heat sources in walls.
    Source,
    /// Those of water.
    WaterSource,
    /// The building.
    Building,
    /// Sensors.
    Sensor,
    /// Derived outputs.
    Derived,
}

impl Of {
    /// For what there is such an output, in words.
    pub const fn exists(self) -> &'static str {
        match self {
            Self::Zone => "every zone",
            Self::HeatedZone => "zones with `heating`",
            Self::CooledZone => "zones with `cooling`",
            Self::ConditionedZone => "zones with `heating` or `cooling`",
            Self::SunlitZone => "zones with windows",
            Self::StratifiedZone => "zones with `air_gradient`",
            Self::HumidZone => "every zone of a building with `humidity`",
            Self::DriedZone => "zones with `drying` in `humidity`",
            Self::HumidifiedZone => "zones with `humidifying` in `humidity`",
            Self::Side => "both sides",
            Self::SunlitSide => "sides in the sun, surfaces of zones with windows, windows",
            Self::RadiatingSide => "sides with long-wave exchange of their own",
            Self::ConvectiveSide => "sides that face air outdoors or of a zone",
            Self::HumidSide => "surfaces in zones of a building with `humidity`",
            Self::OutdoorSurface => "every surface and window that faces outdoors",
            Self::Window => "every window",
            Self::OutdoorWindow => "windows that face outdoors",
            Self::Interface => "surfaces of two or more layers",
            Self::Layer => "every layer",
            Self::MeltingLayer => "layers of phase-change materials",
            Self::Vent => "every vent",
            Self::Control => "every control",
            Self::Source => "every entry of `heat_sources`",
            Self::WaterSource => "entries of `heat_sources` with `water`",
            Self::Building => "every building",
            Self::Sensor => "every entry of `sensors`",
            Self::Derived => "every entry of `derived_outputs`",
        }
    }

    /// Whether the engine can read a quantity of these parts at a place.
    pub(super) fn is_at(self, plan: &Plan, at: &Place) -> bool {
        let description = &plan.description;
        let construction = description.surfaces.get(at.surface).map(|surface| surface.construction);
        let layers = construction.map_or(0, |index| description.constructions[index].layers.len());
        let is_zone = at.zone < plan.zones.len();
        let is_surface = at.surface < plan.walls.len();
        match self {
            Self::Zone
            | Self::HeatedZone
            | Self::CooledZone
            | Self::ConditionedZone
            | Self::SunlitZone
            | Self::StratifiedZone => is_zone,
            Self::HumidZone | Self::DriedZone | Self::HumidifiedZone => plan.humidity.is_some() && is_zone,
            Self::Side | Self::SunlitSide | Self::RadiatingSide | Self::ConvectiveSide => {
                is_surface && at.side < 2
            }
            Self::HumidSide => {
                let side = SideId::new(at.surface, at.side);
                plan.humidity.is_some()
                    && is_surface
                    && at.side < 2
                    && matches!(plan.surfaces[side].role, SideRole::Zone { .. })
            }
            Self::OutdoorSurface => is_surface,
            Self::Window | Self::OutdoorWindow => plan.windows.contains(&at.surface),
            Self::Interface => at.interface > 0 && at.interface < layers,
            Self::Layer => at.layer < layers,
            Self::MeltingLayer => {
                at.layer < layers && {
                    let (start, end) = plan.walls[at.surface].layer_cells[at.layer];
                    end > start
                }
            }
            Self::Vent => at.vent < description.vents.len(),
            Self::Control => at.control < description.controls.len(),
            Self::Source => at.source < description.heat_sources.len(),
            Self::WaterSource => {
                let source = description.heat_sources.get(at.source);
                source.is_some_and(|source| matches!(source.means, HeatingMeans::Water { .. }))
            }
            Self::Building => true,
            Self::Sensor => at.sensor < description.sensors.len(),
            Self::Derived => at.derived < description.outputs.len(),
        }
    }

    /// The part at a place, as messages name it.
    pub(super) fn part(self, plan: &Plan, at: &Place) -> String {
        let description = &plan.description;
        match self {
            Self::Zone
            | Self::HeatedZone
            | Self::CooledZone
            | Self::ConditionedZone
            | Self::SunlitZone
            | Self::StratifiedZone
            | Self::HumidZone
            | Self::DriedZone
            | Self::HumidifiedZone => format!("zone {}", description.zones[at.zone].name),
            Self::Side | Self::SunlitSide | Self::RadiatingSide | Self::ConvectiveSide | Self::HumidSide => {
                plan.surface_name(SideId::new(at.surface, at.side))
            }
            Self::OutdoorSurface | Self::Window | Self::OutdoorWindow => {
                format!("surface {}", description.surfaces[at.surface].name)
            }
            Self::Interface => {
                format!("surface {} (interface {})", description.surfaces[at.surface].name, at.interface)
            }
            Self::Layer | Self::MeltingLayer => {
                let surface = &description.surfaces[at.surface];
                let layers = &description.constructions[surface.construction].layers;
                format!("surface {} (layer {})", surface.name, layers[at.layer].name)
            }
            Self::Vent => format!("vent {}", description.vents[at.vent].name),
            Self::Control => format!("control {}", description.controls[at.control].name),
            Self::Source | Self::WaterSource => {
                format!("heat source {}", description.heat_sources[at.source].name)
            }
            Self::Building => "the building".to_owned(),
            Self::Sensor => format!("sensor {}", description.sensors[at.sensor].name),
            Self::Derived => format!("output {}", description.outputs[at.derived].name),
        }
    }
}

/// What the value of a quantity is read from after a step.
#[derive(Debug, Clone, Copy)]
pub(super) struct At<'r, S: Real> {
    pub(super) plan: &'r Plan,
    pub(super) step: &'r Readings<'r, S>,
    pub(super) state: &'r State<S>,
}

/// Makes the outputs from a table of rows:
/// documentation, which is the sentence; name and positions; row; value, of what is read after a step.
macro_rules! outputs {
    ($(
        $(#[doc = $sentence:literal])+
        $variant:ident $({ $($position:ident),+ })? = $row:expr, |$at:ident| $value:expr;
    )+) => {
        /// A quantity to record. Positions count zones, surfaces (windows follow them), layers and interfaces from outside, openings,
        /// controls and sensors of the description; side 0 is the outside, 1 the inside.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
        #[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
        pub enum Output {
            $(
                $(#[doc = $sentence])+
                $variant $({ $(
                    #[doc = concat!("Position of the ", stringify!($position), ".")]
                    $position: usize
                ),+ })?,
            )+
        }

        impl Output {
            /// All rows, in their order.
            #[must_use]
            pub fn table() -> Vec<Entry> {
                vec![$(Entry::new(stringify!($variant), &[$($sentence),+], $row)),+]
            }

            /// Its row.
            #[must_use]
            pub fn row(&self) -> &'static Row {
                match self {
                    $(Self::$variant $({ $($position: _),+ })? => {
                        const ROW: Row = $row;
                        &ROW
                    })+
                }
            }

            fn place(&self) -> Place {
                match *self {
                    $(Self::$variant $({ $($position),+ })? => {
                        #[allow(clippy::needless_update, reason = "a row may use all positions or none")]
                        Place { $($($position,)+)? ..Place::default() }
                    })+
                }
            }

            /// An output by its kind, as in JSON, and its place.
            pub(super) fn at(kind: &str, place: &Place) -> Option<Self> {
                $(if is_kind(kind, stringify!($variant)) {
                    return Some(Self::$variant $({ $($position: place.$position),+ })?);
                })+
                None
            }

            /// Reads the quantity after a step.
            pub(crate) fn read<S: Real>(&self, plan: &Plan, step: &Readings<'_, S>, state: &State<S>) -> S {
                let now = At { plan, step, state };
                match *self {
                    $(Self::$variant $({ $($position),+ })? => {
                        let $at = now;
                        $value
                    })+
                }
            }
        }
    };
}
pub(super) use outputs;

/// Whether a kind is that of a variant, which is written without `_` and with capitals.
pub(super) fn is_kind(kind: &str, variant: &str) -> bool {
    let letters = kind.bytes().filter(|letter| *letter != b'_');
    letters.eq(variant.bytes().map(|letter| letter.to_ascii_lowercase()))
}

/// Checks that the engine can read a quantity of some parts at a place.
///
/// # Errors
/// [`EngineError::Input`].
pub(super) fn require(
    of: Of,
    plan: &Plan,
    at: &Place,
    what: &impl core::fmt::Debug,
) -> Result<(), EngineError> {
    if of.is_at(plan, at) {
        Ok(())
    } else {
        Err(EngineError::Input(format!("there is nothing to record for {what:?}")))
    }
}
