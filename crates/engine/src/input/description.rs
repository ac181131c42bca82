//! The building as it crosses the border from the description language.
//!
//! Every number that a user may vary is a [`ParamId`]: an index into
//! [`Description::parameters`]. The engine never sees a path or a file; it reads
//! values from a parameter vector, so that the same description serves one run,
//! an ensemble (one vector per member) and derivatives (a vector of duals).
//! What is a plain `usize`, `bool` or list here is structural: it shapes the plan.

use serde::Deserialize;

/// Index of a numeric leaf in [`Description::parameters`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Deserialize)]
#[serde(transparent)]
pub struct ParamId(pub u32);

/// A numeric leaf: its path in the user's description and its nominal value (SI, degC, deg).
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Parameter {
    /// Dotted path, e.g. `materials.energain.latent_heat`.
    pub path: String,
    /// Nominal value.
    pub value: f64,
}

/// A whole building: references between its parts are indices into the lists.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Description {
    /// All numeric leaves, in the order of their ids.
    pub parameters: Vec<Parameter>,
    /// Where the building stands.
    pub site: Site,
    /// Materials.
    pub materials: Vec<Material>,
    /// Constructions.
    pub constructions: Vec<Construction>,
    /// Air zones.
    pub zones: Vec<Zone>,
    /// Air exchanged between zones.
    #[serde(default)]
    pub air_paths: Vec<AirPath>,
    /// Openings between zones and outdoors.
    #[serde(default)]
    pub openings: Vec<Opening>,
    /// Surfaces.
    pub surfaces: Vec<Surface>,
    /// Sensors inside walls.
    #[serde(default)]
    pub sensors: Vec<Sensor>,
    /// Opaque thin polygons outdoors that keep the sun off.
    #[serde(default)]
    pub shades: Vec<Vec<[f64; 3]>>,
    /// Names of the forcing channels that follow the climate channels (measured temperatures, irradiances, schedules).
    #[serde(default)]
    pub channels: Vec<String>,
}

/// Site constants that act in the engine. (Latitude and longitude act through the sun's path in the forcing.)
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Site {
    /// Altitude [m]: gives the air density where none is given.
    pub altitude: ParamId,
    /// Density of the air that enters and fills the zones [kg/m3]; none: from the altitude.
    #[serde(default)]
    pub air_density: Option<ParamId>,
    /// Solar reflectance of the ground [-].
    pub ground_reflectance: ParamId,
    /// How the wind is carried from the mast to a surface.
    pub wind: WindProfile,
    /// Model of the sky's long-wave emission.
    pub sky: Sky,
    /// Cubic factor of cloud cover N [tenths]: 1 + c1 N + c2 N^2 + c3 N^3 (Clark & Allen 1978).
    pub cloud: [ParamId; 3],
    /// Model of the sky's diffuse short-wave radiation.
    pub diffuse: DiffuseSky,
}

/// Power-law wind profile (ASHRAE Handbook of Fundamentals, ch. 24):
/// `V = V_mast (delta_mast/z_mast)^a_mast (z/delta)^a`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WindProfile {
    /// Height of the anemometer [m].
    pub mast_height: ParamId,
    /// Exponent at the mast [-].
    pub mast_exponent: ParamId,
    /// Boundary layer thickness at the mast [m].
    pub mast_layer: ParamId,
    /// Exponent at the building [-].
    pub exponent: ParamId,
    /// Boundary layer thickness at the building [m].
    pub layer: ParamId,
}

/// Sky emission models; see `radiation.rs` for equations and sources.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Sky {
    /// Horizontal infrared of the climate [W/m2] (channel `infrared`), times a scale.
    Measured {
        /// Multiplies the channel [-].
        scale: ParamId,
    },
    /// Emissivity `a + b ln(Tdp/273)`, Tdp in K.
    ClarkAllen {
        /// Constant [-].
        a: ParamId,
        /// Gain of the logarithm [-].
        b: ParamId,
    },
    /// Emissivity `a + b (tdp/100) + c (tdp/100)^2`, tdp in degC.
    MartinBerdahl {
        /// Constant [-].
        a: ParamId,
        /// Linear gain [-].
        b: ParamId,
        /// Square gain [-].
        c: ParamId,
    },
    /// Emissivity `a + b sqrt(pw)`, pw in hPa.
    Brunt {
        /// Constant [-].
        a: ParamId,
        /// Gain of the root [1/hPa^(1/2)].
        b: ParamId,
    },
    /// Sky temperature = air temperature - depression [K].
    Offset {
        /// Air minus sky [K].
        depression: ParamId,
    },
}

/// Diffuse short-wave models on a tilted plane.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DiffuseSky {
    /// Isotropic (Liu & Jordan 1963).
    Isotropic,
    /// Hay & Davies (1980).
    HayDavies,
    /// Perez et al. (1990), coefficients "all sites composite 1990".
    Perez,
}

/// What a layer is made of.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Material {
    /// Constant properties: W/(m K), kg/m3, J/(kg K).
    Solid {
        /// [W/(m K)].
        conductivity: ParamId,
        /// [kg/m3].
        density: ParamId,
        /// [J/(kg K)].
        specific_heat: ParamId,
    },
    /// No heat capacity, a resistance [m2 K/W]; the layer has no thickness.
    Resistance {
        /// [m2 K/W].
        resistance: ParamId,
    },
    /// A frame by its rated U value: what the rated films leave of its resistance.
    Rated {
        /// Air to air [W/(m2 K)].
        u_value: ParamId,
    },
    /// Phase-change material; pairs are [solid, liquid].
    Pcm {
        /// [W/(m K)].
        conductivity: [ParamId; 2],
        /// [kg/m3].
        density: [ParamId; 2],
        /// [J/(kg K)].
        specific_heat: [ParamId; 2],
        /// Enthalpy over temperature.
        law: PcmLaw,
    },
}

/// How enthalpy depends on temperature.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum PcmLaw {
    /// Sensible heat, and latent heat by one curve of the liquid fraction.
    Melting {
        /// Heat of melting [J/kg].
        latent_heat: ParamId,
        /// Liquid fraction over temperature.
        curve: MeltingCurve,
    },
    /// The same with one curve for melting and another for freezing.
    Hysteresis {
        /// Heat of melting [J/kg].
        latent_heat: ParamId,
        /// What happens on a reversal within the range.
        model: HysteresisModel,
        /// Liquid fraction on melting.
        heating: MeltingCurve,
        /// Liquid fraction on freezing, nowhere below that on melting.
        cooling: MeltingCurve,
    },
    /// Monotone C1 curve of specific enthalpy over temperature [degC]; read at `T - temperature_shift`, multiplied by
    /// `enthalpy_scale`. `specific_heat` of the material is used outside the table. The liquid fraction is 0 below
    /// `melting_range[0]`, 1 above `melting_range[1]` and follows the enthalpy between.
    Tabulated {
        /// Points of the curve, rising [degC].
        temperatures: Vec<f64>,

        /// What is given at each point.
        points: TablePoints,

        /// Solidus and liquidus [degC].
        melting_range: [f64; 2],

        /// Shifts the curve towards higher temperatures [K].
        temperature_shift: ParamId,

        /// Multiplies the enthalpies [-].
        enthalpy_scale: ParamId,
    },
}

/// Points of a tabulated curve.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum TablePoints {
    /// Rising [J/kg], interpolated by monotone cubics.
    Enthalpies(Vec<f64>),
    /// Positive [J/(kg K)], interpolated linearly: the enthalpy is their integral.
    Capacities(Vec<f64>),
}

/// Liquid fraction over temperature. Widths [K] are half-widths unless said otherwise; shifts and temperatures [degC].
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum MeltingCurve {
    /// `1/2 + 1/2 tanh((T - Tm)/w)`.
    TanhWidth {
        /// Middle of the melting range [degC].
        melting_temperature: ParamId,
        /// Half-width w [K].
        width: ParamId,
    },
    /// The paper's form, `w = 4 delta_t / gamma`.
    TanhGamma {
        /// Middle of the melting range [degC].
        melting_temperature: ParamId,
        /// The paper's gamma [-].
        gamma: ParamId,
        /// The paper's delta T [K].
        delta_t: ParamId,
    },
    /// The polynomial of least degree from 0 at `Tm - w` to 1 at `Tm + w` with so many continuous derivatives.
    SmoothStep {
        /// Middle of the melting range [degC].
        melting_temperature: ParamId,
        /// Half-width w [K].
        width: ParamId,
        /// 1 or 2.
        continuity: u8,
    },
    /// The normal distribution.
    Gaussian {
        /// Mean [degC].
        melting_temperature: ParamId,
        /// Standard deviation [K].
        width: ParamId,
    },
    /// The Gumbel distribution, the skewed one of extremes.
    Gumbel {
        /// Its mode, where most melts [degC].
        melting_temperature: ParamId,
        /// Its scale [K].
        width: ParamId,
        /// Where its long tail is.
        tail: Tail,
    },
    /// Straight from 0 at `Tm - w` to 1 at `Tm + w`.
    Linear {
        /// Middle of the melting range [degC].
        melting_temperature: ParamId,
        /// Half-width w [K].
        width: ParamId,
    },
    /// Latent capacity that rises straight to the peak and falls straight after it.
    Triangle {
        /// The peak [degC].
        melting_temperature: ParamId,
        /// From the solidus to the peak [K].
        below: ParamId,
        /// From the peak to the liquidus [K].
        above: ParamId,
    },
    /// Measured fractions, interpolated by monotone cubics; read at `T - temperature_shift`.
    Fractions {
        /// Points of the curve, rising [degC].
        temperatures: Vec<f64>,
        /// Rising from 0 to 1.
        fractions: Vec<f64>,
        /// Shifts the curve towards higher temperatures [K].
        temperature_shift: ParamId,
    },
}

/// Side of the long tail of a skewed curve.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Tail {
    /// Melting starts slowly and ends abruptly.
    Low,
    /// Melting starts abruptly and ends slowly.
    High,
}

/// What a material does when the temperature turns back before all has melted or frozen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum HysteresisModel {
    /// It stays on its curve until all has melted or frozen.
    CurveTrack,
    /// Its liquid fraction stays until the other curve is met.
    CurveSwitch,
    /// It follows the other curve, scaled to what is left to melt or to freeze.
    CurveScale,
}

/// Layers from outside to inside, or a glazing.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Construction {
    /// Name in messages and outputs.
    pub name: String,

    /// Outside to inside; none in a glazing.
    #[serde(default)]
    pub layers: Vec<Layer>,

    /// Panes instead of layers.
    #[serde(default)]
    pub glazing: Option<Glazing>,
}

/// What a window is made of; equations and sources in `optics.rs` and `glazing.rs`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Glazing {
    /// Panes and the gaps between them, outside to inside.
    Panes {
        /// Outside to inside.
        panes: Vec<Pane>,
        /// One less than panes.
        gaps: Vec<Gap>,
        /// Optics of the whole unit; none: calculated from those of the panes.
        #[serde(default)]
        angular: Option<Angular>,
    },
    /// Rated U value and solar heat gain only.
    Simple {
        /// Air to air at the rated films [W/(m2 K)].
        u_value: ParamId,
        /// Total solar heat gain at normal incidence [-].
        solar_heat_gain: ParamId,
        /// Number of panes, for the angular law [-].
        panes: ParamId,
        /// Category of coating, for the angular law [-].
        category: ParamId,
        /// Rated resistances of the outside and inside film [m2 K/W].
        films: [ParamId; 2],
    },
}

/// A pane.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Pane {
    /// [m].
    pub thickness: ParamId,
    /// [W/(m K)].
    pub conductivity: ParamId,
    /// Density [kg/m3] and specific heat [J/(kg K)]; none: it holds no heat.
    #[serde(default)]
    pub storage: Option<[ParamId; 2]>,
    /// Long-wave emissivity of its outer and inner face [-].
    pub emissivity: [ParamId; 2],
    /// Solar optics at normal incidence; needed without the unit's angular table.
    #[serde(default)]
    pub optics: Option<PaneOptics>,
}

/// Solar optics of one pane at normal incidence.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PaneOptics {
    /// [-].
    pub transmittance: ParamId,
    /// From outside and from inside [-].
    pub reflectance: [ParamId; 2],
    /// Whether a coating makes the angular behaviour, and no homogeneous pane.
    #[serde(default)]
    pub coated: bool,
}

/// A gap between two panes.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Gap {
    /// Convection and radiation together [W/(m2 K)].
    Given {
        /// [W/(m2 K)].
        conductance: ParamId,
    },
    /// A gas: convection by correlation, radiation exactly.
    Filled {
        /// [m].
        thickness: ParamId,
        /// [Pa].
        pressure: ParamId,
        /// Which gas.
        gas: Gas,
    },
}

/// Gases between panes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Gas {
    /// Dry air.
    Air,
    /// Argon.
    Argon,
    /// Krypton.
    Krypton,
    /// Xenon.
    Xenon,
}

/// Optics of a whole unit over the angle of incidence, for sun from outside.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Angular {
    /// Rising from 0 to 90 [deg].
    pub angles: Vec<f64>,
    /// At each angle [-].
    pub transmittance: Vec<f64>,
    /// Of each pane, at each angle [-].
    pub absorptance: Vec<Vec<f64>>,
    /// Hemispherical transmittance [-]; none: integrated.
    #[serde(default)]
    pub diffuse_transmittance: Option<f64>,
    /// Hemispherical absorptance of each pane [-]; none: integrated.
    #[serde(default)]
    pub diffuse_absorptance: Option<Vec<f64>>,
    /// Multiplies the transmittances [-].
    pub transmittance_scale: ParamId,
    /// Multiplies the absorptances [-].
    pub absorptance_scale: ParamId,
}

/// One layer of a construction.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Layer {
    /// Name in messages and outputs.
    pub name: String,
    /// Index into [`Description::materials`].
    pub material: usize,
    /// Thickness [m]; none for a resistance.
    #[serde(default)]
    pub thickness: Option<ParamId>,
    /// Number of finite volumes; 0 for a resistance.
    pub nodes: usize,
}

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
    /// Long-wave exchange between the faces of the zone.
    pub longwave: ZoneLongwave,
    /// Relative view-factor weights `A_i F_ij` between the zone's faces, in the order of
    /// [`Description::surfaces`] (outside face before inside face of the same surface). Scaled in the engine so that
    /// closure and reciprocity hold exactly at the areas of the run. Empty: every face sees every other one
    /// except those of the same tilt and azimuth.
    #[serde(default)]
    pub view_weights: Vec<Vec<f64>>,
    /// Where the sun that enters through its windows lands.
    #[serde(default)]
    pub sun: ZoneSun,
    /// Heat from people, light and machines.
    #[serde(default)]
    pub gains: Vec<Gain>,
    /// Outdoor air let in on purpose.
    #[serde(default)]
    pub ventilation: Vec<Ventilation>,
    /// Ideal heating.
    #[serde(default)]
    pub heating: Option<Plant>,
    /// Ideal cooling.
    #[serde(default)]
    pub cooling: Option<Plant>,
}

/// Heat from people, light and machines. Its radiative part goes to the faces of the zone.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Gain {
    /// Name in messages and inputs.
    pub name: String,
    /// Heat at full schedule [W].
    pub power: ParamId,
    /// Part of it that is radiated [-].
    pub radiative: ParamId,
    /// Index into [`Description::channels`]: fraction of the power [-]. None: always all of it.
    #[serde(default)]
    pub schedule: Option<usize>,
}

/// Outdoor air let in on purpose, at the density of the site: either rate is given.
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
    /// Index into [`Description::channels`]: fraction of the flow [-]. None: always all of it.
    #[serde(default)]
    pub schedule: Option<usize>,
}

/// Ideal heating or cooling of the air of a zone.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Plant {
    /// Air temperature that it keeps.
    pub setpoint: SetPoint,
    /// Most heat that it gives or takes [W]. None: as much as it needs.
    #[serde(default)]
    pub capacity: Option<ParamId>,
    /// Index into [`Description::channels`]: fraction of the capacity that is available [-]. None: always all of it.
    #[serde(default)]
    pub schedule: Option<usize>,
}

/// Air temperature that a plant keeps [degC].
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum SetPoint {
    /// One number.
    Constant {
        /// [degC].
        temperature: ParamId,
    },
    /// Index into [`Description::channels`]; the value at the end of a step counts.
    Scheduled {
        /// Index into [`Description::channels`].
        channel: usize,
    },
}

/// Air that two zones exchange, as much one way as the other.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AirPath {
    /// Name in messages.
    pub name: String,
    /// Indices into [`Description::zones`].
    pub between: [usize; 2],
    /// Volume flow each way at the density of the site [m3/s].
    pub flow: ParamId,
    /// Index into [`Description::channels`]: fraction of the flow [-]. None: always all of it.
    #[serde(default)]
    pub schedule: Option<usize>,
}

/// An opening to outdoors that wind and buoyancy drive air through; equation and source in `zone.rs`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Opening {
    /// Name in messages.
    pub name: String,
    /// Index into [`Description::zones`].
    pub zone: usize,
    /// Free area [m2].
    pub area: ParamId,
    /// From the opening to the neutral level [m].
    pub height: ParamId,
    /// Discharge coefficient of the buoyant flow [-].
    pub discharge: ParamId,
    /// Effectiveness against the wind [-].
    pub wind_coefficient: ParamId,
    /// Index into [`Description::channels`]: fraction of the area that is open [-]. None: always all of it.
    #[serde(default)]
    pub schedule: Option<usize>,
}

/// Where the sun that enters a zone lands; equations in `interior.rs`.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum ZoneSun {
    /// Evenly over all faces, each absorbing by its absorptance; glass lets part of it out.
    #[default]
    Area,
    /// Given shares, scaled to a sum of one.
    Shares {
        /// Absorbed by each of the zone's faces, in their order [-]; none: nothing.
        faces: Vec<Option<ParamId>>,
        /// Leaves through the windows [-]; none: nothing.
        #[serde(default)]
        lost: Option<ParamId>,
    },
    /// The beam where its rays end, all else by view factors; what is reflected again by view factors.
    Geometry,
}

/// Outdoor air entering a zone unasked [1/h, 1/(h K), 1/(h m/s)].
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Infiltration {
    /// Air changes that always happen [1/h].
    pub constant: ParamId,

    /// Air changes per degree between zone and outdoors [1/(h K)].
    pub temperature: ParamId,

    /// Air changes per wind speed at the mast [1/h per m/s].
    pub wind: ParamId,
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
    /// No separate exchange (films are combined coefficients).
    None,
}

/// A plane wall or window between two sides.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Surface {
    /// Name in messages and outputs.
    pub name: String,
    /// Index into [`Description::constructions`].
    pub construction: usize,
    /// Area [m2]; of it, `openings` and `frame` leave the wall's own.
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
    /// Corners seen from outside, counter-clockwise [m]; needed where shades or traced sun are.
    #[serde(default)]
    pub vertices: Vec<[f64; 3]>,
    /// Tilt of the outside normal [deg]: 0 up, 90 vertical, 180 down.
    pub tilt: ParamId,
    /// Azimuth of the outside normal [deg], clockwise from north.
    pub azimuth: ParamId,

    /// The side that the construction's first layer touches.
    pub outside: Side,

    /// The side that the construction's last layer touches.
    pub inside: Side,
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

/// One face of a surface and what it sees.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Side {
    /// What it sees.
    pub facing: Facing,
    /// Convection (also the film of a `measured` air temperature). None: the face itself takes the imposed
    /// temperature (`ground`, `measured`), or nothing flows (`adiabatic`).
    #[serde(default)]
    pub convection: Option<Convection>,
    /// Long-wave emissivity [-]. Needed for `outdoors` and `zone`.
    #[serde(default)]
    pub emissivity: Option<ParamId>,
    /// Solar absorptance [-]. Needed for `outdoors` and for a `measured` irradiance.
    #[serde(default)]
    pub absorptance: Option<ParamId>,
    /// Convective area over plane area [-] (corrugated sheets).
    #[serde(default)]
    pub area_factor: Option<ParamId>,
    /// Fraction of the sky seen [-]; none: (1 + cos tilt)/2.
    #[serde(default)]
    pub sky_view: Option<ParamId>,
    /// Height of the face above ground for the wind profile [m]; none: mast wind is used as it is.
    #[serde(default)]
    pub height: Option<ParamId>,
    /// Long-wave exchange with sky, air and ground of an `outdoors` side.
    #[serde(default)]
    pub longwave: OutdoorLongwave,
    /// Name index into [`Description::channels`]: measured irradiance on this plane [W/m2], used as it is.
    #[serde(default)]
    pub irradiance: Option<usize>,
    /// What of the weather reaches an `outdoors` side.
    #[serde(default)]
    pub exposure: Exposure,
}

/// What of the weather reaches an `outdoors` side, beside the temperature of the air.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Exposure {
    /// The sun, from sky and ground alike.
    pub sun: bool,
    /// The wind.
    pub wind: bool,
    /// The sky's long-wave radiation; without it all long-wave radiation that arrives is that of the air's temperature.
    pub sky: bool,
}

impl Default for Exposure {
    fn default() -> Self {
        Self { sun: true, wind: true, sky: true }
    }
}

/// What a side faces.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Facing {
    /// Outdoor air, sun, sky and ground.
    Outdoors,
    /// Index into [`Description::zones`].
    Zone {
        /// Index into [`Description::zones`].
        zone: usize,
    },
    /// Ground temperature [degC]: `mean - amplitude cos(2 pi (day - coldest_day)/365)`.
    Ground {
        /// Annual mean [degC].
        mean: ParamId,

        /// Half of the annual swing [K].
        amplitude: ParamId,

        /// Day of the year with the lowest temperature [d].
        coldest_day: ParamId,
    },
    /// Measured temperature: index into [`Description::channels`].
    Measured {
        /// Index into [`Description::channels`].
        channel: usize,
    },

    /// Nothing: no heat flows.
    Adiabatic,
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
    /// None (the film is a combined coefficient).
    None,
}

/// Film coefficients [W/(m2 K)]; equations and sources in `convection.rs`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Convection {
    /// One number.
    Constant {
        /// [W/(m2 K)].
        coefficient: ParamId,
    },
    /// `constant + wind V`.
    LinearWind {
        /// Coefficient in still air [W/(m2 K)].
        constant: ParamId,

        /// Its rise with wind [W/(m2 K) per m/s].
        wind: ParamId,
    },
    /// Alamdari & Hammond (1983); `length`: height of a vertical face, 4 A/P of a horizontal one [m].
    AlamdariHammond {
        /// [m].
        length: ParamId,

        /// Multiplies the correlation [-].
        factor: ParamId,
    },
    /// The paper's eq. 5 as printed, `length` = H [m].
    PaperEq5 {
        /// [m].
        length: ParamId,

        /// Multiplies the correlation [-].
        factor: ParamId,
    },
    /// TARP (Walton 1983). On an outdoor side the forced part is added; roughness and perimeter [m] act there alone.
    Tarp {
        /// Multiplies the correlation [-].
        factor: ParamId,
        #[serde(default)]

        /// Roughness multiplier Rf [-].
        roughness: Option<ParamId>,
        #[serde(default)]

        /// Perimeter of the face [m].
        perimeter: Option<ParamId>,
    },
    /// `MoWiTT` (Yazdanian & Klems 1994), times a factor.
    Mowitt {
        /// Multiplies the correlation [-].
        factor: ParamId,
    },
    /// DOE-2: TARP's natural part and `MoWiTT`'s wind on a face of some roughness.
    Doe2 {
        /// Multiplies the correlation [-].
        factor: ParamId,

        /// Roughness multiplier Rf [-].
        roughness: ParamId,
    },
    /// ISO 15099 at the room's face of a glazing; `length`: its height [m].
    Iso15099 {
        /// [m].
        length: ParamId,

        /// Multiplies the correlation [-].
        factor: ParamId,
    },
    /// `a + b |dT|^n + c V^m` by direction of heat flow.
    Power {
        /// Heat flows up, or the face is vertical.
        upward: PowerLaw,
        /// Heat flows down.
        downward: PowerLaw,
    },
}

/// Coefficients of [`Convection::Power`].
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PowerLaw {
    /// Constant [W/(m2 K)].
    pub a: ParamId,

    /// Gain of the temperature difference [W/(m2 K) per K^n].
    pub b: ParamId,

    /// Exponent of the temperature difference [-].
    pub n: ParamId,

    /// Gain of the wind [W/(m2 K) per (m/s)^m].
    pub c: ParamId,

    /// Exponent of the wind [-].
    pub m: ParamId,
}

/// A thermometer in a wall.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sensor {
    /// Name in messages and outputs.
    pub name: String,
    /// Index into [`Description::surfaces`].
    pub surface: usize,
    /// Depth from the outside face [m].
    pub depth: ParamId,
}
