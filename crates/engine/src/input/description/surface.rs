//! Walls and windows, their two sides and what these are in contact with.

use serde::Deserialize;

use super::convection::Convection;
use super::parameter::ParamId;
use super::published_law::PublishedLaw;

/// A plane wall or window between two sides. (A wall of the engine; "surfaces" of the engine are its two sides.)
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Surface {
    /// Name in messages and outputs.
    pub name: String,
    /// Index into [`Description::constructions`](super::Description::constructions).
    pub construction: usize,
    /// Area [m2], including `openings` and the part that is `frame`.
    pub area: ParamId,
    /// Areas of the windows in this wall [m2].
    #[serde(default)]
    pub openings: Vec<ParamId>,
    /// Which part of a window this is; none: all of it, or a wall.
    #[serde(default)]
    pub frame: Option<FrameShare>,
    /// Height of the gaps of a window, for their convection [m].
    #[serde(default)]
    pub cavity_height: Option<ParamId>,
    /// Corners seen from outside, counter-clockwise [m]; needed where shades, other walls or traced sun are.
    #[serde(default)]
    pub vertices: Vec<[f64; 3]>,
    /// Tilt of the outside normal [deg]: 0 up, 90 vertical, 180 down.
    pub tilt: ParamId,
    /// Azimuth of the outside normal [deg], clockwise from north.
    pub azimuth: ParamId,

    /// The side that the construction's first layer touches; with soil, that the outermost cell of the soil touches.
    pub outside: Side,

    /// Soil behind the construction's first layer. None: none.
    #[serde(default)]
    pub soil: Option<Soil>,

    /// The side that the construction's last layer touches.
    pub inside: Side,
}

/// A block of soil as a row of cells, outside to inside: numbers of its structure, which are no parameters.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Soil {
    /// Heat capacities of the cells [J/(m2 K)].
    pub capacities: Vec<f64>,
    /// Resistances before, between and after the cells [m2 K/W].
    pub resistances: Vec<f64>,
    /// Indices into [`Description::channels`](super::Description::channels): heat by the outdoor air into the innermost cell and the next one
    /// [W/m2].
    pub heat: [usize; 2],
}

/// The part of a window that is frame, or the part that is not.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FrameShare {
    /// Share of the frame in the window's area [-].
    pub fraction: ParamId,
    /// Whether this surface is the frame; else it is the glass.
    pub is_frame: bool,
}

/// One side of a wall or window and what it is in contact with.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Side {
    /// What it is in contact with.
    pub facing: Facing,
    /// Surface heat transfer coefficient (also that of a `measured` air temperature). None: the surface itself has the
    /// imposed temperature (`ground`, `measured`), or no heat flows (`adiabatic`).
    #[serde(default)]
    pub convection: Option<Convection>,
    /// Heat that is given to the surface of an `adiabatic` side from outside. None: none.
    #[serde(default)]
    pub heat_flux: Option<HeatFlux>,
    /// Long-wave emissivity [-]. Needed for `zone` where it exchanges radiation, and for `outdoors` where the side does.
    #[serde(default)]
    pub emissivity: Option<ParamId>,
    /// Solar absorptance [-]. Needed for `outdoors` and for a `measured` irradiance.
    #[serde(default)]
    pub absorptance: Option<ParamId>,
    /// Convective area over plane area [-] (corrugated sheets).
    #[serde(default)]
    pub area_factor: Option<ParamId>,
    /// Fraction of the sky seen past all obstacles [-]; none: (1 + cos tilt)/2, less what obstacles cover.
    #[serde(default)]
    pub sky_view: Option<ParamId>,
    /// Fraction of the ground seen past all obstacles [-], for the sun that it reflects; none: (1 - cos tilt)/2, less what obstacles cover.
    #[serde(default)]
    pub ground_view: Option<ParamId>,
    /// Height of the surface above ground for the wind profile [m]; none: mast wind is used as it is.
    #[serde(default)]
    pub height: Option<ParamId>,
    /// Long-wave exchange with sky, air and ground of an `outdoors` side.
    #[serde(default)]
    pub longwave: OutdoorLongwave,
    /// Index into [`Description::channels`](super::Description::channels): measured irradiance on this plane [W/m2].
    #[serde(default)]
    pub irradiance: Option<usize>,
    /// Whether the irradiance was measured behind all obstacles, and is used as it is; else it is that of the free plane, from which
    /// obstacles take their part.
    #[serde(default)]
    pub behind_obstacles: bool,
    /// What of the weather reaches an `outdoors` side.
    #[serde(default)]
    pub exposure: Exposure,
    /// Indices into [`Description::surfaces`](super::Description::surfaces): walls that stand in front of an `outdoors` side.
    #[serde(default)]
    pub shaded_by: Vec<usize>,
    /// Corners of thin shades that act on this `outdoors` side alone: the reveal and the overhang of a window [m].
    #[serde(default)]
    pub own_shades: Vec<Vec<[f64; 3]>>,
    /// Corners of the side where its wall has no vertices, in coordinates that its own shades share alone [m].
    #[serde(default)]
    pub outline: Vec<[f64; 3]>,
    /// Height of its middle above the middle of its zone [m], where the air of the zone is stratified.
    #[serde(default)]
    pub level: f64,
}

/// A given heat flow density.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HeatFlux {
    /// Into the surface [W/m2]; where a channel gives it, what that is multiplied by.
    pub flux: ParamId,
    /// Index into [`Description::channels`](super::Description::channels): fraction of it [-], or the flux [W/m2]. None: always all of it.
    #[serde(default)]
    pub schedule: Option<usize>,
}

/// What of the weather reaches an `outdoors` side, beside the temperature of the air.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Exposure {
    /// Short-wave radiation of sun, sky and ground.
    pub sun: bool,
    /// The wind.
    pub wind: bool,
    /// The sky's long-wave radiation; without it all incident long-wave radiation is that of a black body at air temperature.
    pub sky: bool,
}

impl Default for Exposure {
    fn default() -> Self {
        Self { sun: true, wind: true, sky: true }
    }
}

/// What a side is in contact with.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Facing {
    /// Outdoor air, sun, sky and ground.
    Outdoors,
    /// Index into [`Description::zones`](super::Description::zones).
    Zone {
        /// Index into [`Description::zones`](super::Description::zones).
        zone: usize,
    },
    /// The temperature of a law of `physics/imposed`, such as that of the ground.
    Imposed {
        /// The law.
        law: PublishedLaw,
    },
    /// Measured temperature: index into [`Description::channels`](super::Description::channels).
    Measured {
        /// Index into [`Description::channels`](super::Description::channels).
        channel: usize,
    },

    /// Nothing: no heat flows.
    Adiabatic,
}

impl Facing {
    /// The temperature of a law with its numbers.
    #[must_use]
    pub fn imposed(kind: &str, numbers: &[(&str, ParamId)]) -> Self {
        Self::Imposed { law: PublishedLaw::new(kind, numbers) }
    }
}

/// Long-wave exchange of an `outdoors` side.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum OutdoorLongwave {
    /// T^4 with sky, air and ground.
    #[default]
    Exact,
    /// Linearised about a reference temperature [degC].
    Linearised {
        /// Temperature of the tangent [degC].
        reference: ParamId,
    },
    /// None (the surface heat transfer coefficient includes it).
    None,
}

/// A thermometer in a wall.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sensor {
    /// Name in messages and outputs.
    pub name: String,
    /// Index into [`Description::surfaces`](super::Description::surfaces).
    pub surface: usize,
    /// Depth from the outside surface [m].
    pub depth: ParamId,
}
