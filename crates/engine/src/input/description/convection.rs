//! Surface heat transfer coefficients; equations and sources in `physics/convection`.

use serde::Deserialize;

use super::parameter::ParamId;
use super::published_law::{PublishedLaw, WrittenNumbers};

/// Surface heat transfer coefficients [W/(m2 K)]; equations and sources in `physics/convection`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(try_from = "Written")]
pub enum Convection {
    /// A published law.
    Law(PublishedLaw),
    /// A forcing channel [W/(m2 K)], times a factor.
    Measured {
        /// Index into [`Description::channels`](super::Description::channels).
        channel: usize,
        /// Multiplies the channel [-].
        factor: ParamId,
    },
    /// As written, see `physics/convection/formula_text.rs`.
    Formula {
        /// The coefficient [W/(m2 K)].
        formula: String,
        /// Where it is valid; none: everywhere.
        valid: Option<String>,
        /// Its numbers.
        numbers: Vec<FormulaNumber>,
    },
}

impl Convection {
    /// A published law with its numbers.
    pub fn law(kind: &str, numbers: &[(&str, ParamId)]) -> Self {
        Self::Law(PublishedLaw::new(kind, numbers))
    }
}

/// A coefficient in JSON.
#[derive(Deserialize)]
struct Written {
    kind: String,
    channel: Option<usize>,
    formula: Option<String>,
    valid: Option<String>,
    numbers: Option<Vec<FormulaNumber>>,
    #[serde(flatten)]
    law: WrittenNumbers,
}

impl TryFrom<Written> for Convection {
    type Error = String;

    fn try_from(written: Written) -> Result<Self, String> {
        let Written { kind, channel, formula, valid, numbers, law } = written;
        let PublishedLaw { kind, numbers: ids } = PublishedLaw::written(kind, law);
        match (kind.as_str(), channel, formula, numbers) {
            ("measured", Some(channel), None, None) => match ids.as_slice() {
                [(name, factor)] if name == "factor" => Ok(Self::Measured { channel, factor: *factor }),
                _ => Err("found a measured coefficient with other keys, expected its factor".into()),
            },
            ("formula", None, Some(formula), Some(numbers)) if ids.is_empty() => {
                Ok(Self::Formula { formula, valid, numbers })
            }
            ("measured" | "formula", ..) => Err(format!("found other keys than those of '{kind}'")),
            (_, None, None, None) => Ok(Self::Law(PublishedLaw { kind, numbers: ids })),
            _ => Err(format!("found a channel or a formula in '{kind}'")),
        }
    }
}

/// A law of other things than convection and melting as text, see `physics/formula/function.rs`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TextLaw {
    /// The law.
    pub formula: String,

    /// Where it is valid; none: everywhere.
    #[serde(default)]
    pub valid: Option<String>,

    /// Its numbers.
    pub numbers: Vec<FormulaNumber>,
}

/// A number of a formula.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FormulaNumber {
    /// Its name in the formula.
    pub name: String,

    /// Its value.
    pub value: ParamId,
}
