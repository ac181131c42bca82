//! Panes, gaps and their optics; equations and sources in `physics/optics` and `physics/window_gaps`.

use serde::Deserialize;

use super::parameter::ParamId;

/// What a window is made of; equations and sources in `physics/optics` and `physics/window_gaps.rs`.
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
        /// Air to air with the rated surface resistances [W/(m2 K)].
        u_value: ParamId,
        /// Total solar heat gain at normal incidence [-].
        solar_heat_gain: ParamId,
        /// Solar transmittance at normal incidence [-]; none: estimated.
        #[serde(default)]
        transmittance: Option<ParamId>,
        /// Number of panes [-].
        panes: ParamId,
        /// Category of glass, for the angular law [-].
        category: ParamId,
        /// Rated resistances of the outside and inside surface [m2 K/W].
        #[serde(rename = "films")]
        surface_resistances: [ParamId; 2],
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
    /// Density [kg/m3] and specific heat [J/(kg K)]; none: no heat capacity.
    #[serde(default)]
    pub storage: Option<[ParamId; 2]>,
    /// Long-wave emissivity of its outer and inner surface [-].
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
    /// Whether a coating determines the angular behaviour; else the pane is homogeneous.
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

/// A blind or shutter; equations in `physics/blinds.rs`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Blind {
    /// Whether it is on the side of the room; else it is outdoors.
    pub inside: bool,
    /// Solar transmittance [-].
    pub transmittance: ParamId,
    /// Solar reflectance of both sides [-].
    pub reflectance: ParamId,
    /// Of the closed blind and the air behind it [m2 K/W].
    pub resistance: ParamId,
    /// Part of the window that it covers when it is closed [-].
    pub cover: ParamId,
    /// Index into [`Description::channels`](super::Description::channels): how far it is closed [-]. None: always closed.
    #[serde(default)]
    pub schedule: Option<usize>,
    /// Irradiance of the window above which it is closed [W/m2]; none: it follows its schedule alone.
    #[serde(default)]
    pub radiation: Option<ParamId>,
    /// Part of the sun that an inner blind absorbs which the air behind it carries into the room [-]; none: no part.
    #[serde(default)]
    pub to_air: Option<ParamId>,
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
    /// Hemispherical transmittance from inside [-]; none: that from outside.
    #[serde(default)]
    pub back_transmittance: Option<f64>,
    /// Hemispherical absorptance of each pane from inside, outside to inside [-]; none: that from outside, panes reversed.
    #[serde(default)]
    pub back_absorptance: Option<Vec<f64>>,
    /// Multiplies the transmittances [-].
    pub transmittance_scale: ParamId,
    /// Multiplies the absorptances [-].
    pub absorptance_scale: ParamId,
}
