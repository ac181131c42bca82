//! Constructions and their layers.

use serde::Deserialize;

use super::glazing::{Blind, Glazing};
use super::parameter::ParamId;

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

    /// A blind in front of a glazing or behind it.
    #[serde(default)]
    pub blind: Option<Blind>,
}

/// One layer of a construction.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Layer {
    /// Name in messages and outputs.
    pub name: String,
    /// Index into [`Description::materials`](super::Description::materials).
    pub material: usize,
    /// Thickness [m]; none for a resistance.
    #[serde(default)]
    pub thickness: Option<ParamId>,
    /// Number of finite volumes; 0 for a resistance.
    pub nodes: usize,
}
