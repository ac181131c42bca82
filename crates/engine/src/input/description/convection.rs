//! Surface heat transfer coefficients; equations and sources in `physics/convection`.

use std::collections::BTreeMap;

use serde::Deserialize;

use super::parameter::ParamId;

/// Surface heat transfer coefficients [W/(m2 K)]; equations and sources in `physics/convection`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(try_from = "Written")]
pub enum Convection {
    /// A published law.
    Law(ConvectionLaw),
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

/// A law of `physics/convection/laws` with its numbers.
#[derive(Debug, Clone, PartialEq)]
pub struct ConvectionLaw {
    /// Name of its file.
    pub kind: String,
    /// Its numbers by name, in the order of their names; `upward.a` is `a` where heat flows up.
    pub numbers: Vec<(String, ParamId)>,
}

impl ConvectionLaw {
    /// The number of a name.
    pub fn number(&self, name: &str) -> Option<ParamId> {
        self.numbers.iter().find(|(other, _)| other == name).map(|(_, id)| *id)
    }
}

impl Convection {
    /// A published law with its numbers.
    pub fn law(kind: &str, numbers: &[(&str, ParamId)]) -> Self {
        let mut numbers: Vec<(String, ParamId)> =
            numbers.iter().map(|(name, id)| ((*name).to_owned(), *id)).collect();
        numbers.sort_by(|(a, _), (b, _)| a.cmp(b));
        Self::Law(ConvectionLaw { kind: kind.to_owned(), numbers })
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
    law: BTreeMap<String, Option<WrittenNumber>>,
}

/// A number of a law, or those of a direction of the flow of heat.
#[derive(Deserialize)]
#[serde(untagged)]
enum WrittenNumber {
    One(ParamId),
    Group(BTreeMap<String, ParamId>),
}

impl TryFrom<Written> for Convection {
    type Error = String;

    fn try_from(written: Written) -> Result<Self, String> {
        let Written { kind, channel, formula, valid, numbers, law } = written;
        let mut ids = Vec::new();
        for (name, number) in law {
            match number {
                Some(WrittenNumber::One(id)) => ids.push((name, id)),
                Some(WrittenNumber::Group(group)) => {
                    ids.extend(group.into_iter().map(|(inner, id)| (format!("{name}.{inner}"), id)));
                }
                None => {}
            }
        }
        match (kind.as_str(), channel, formula, numbers) {
            ("measured", Some(channel), None, None) => match ids.as_slice() {
                [(name, factor)] if name == "factor" => Ok(Self::Measured { channel, factor: *factor }),
                _ => Err("found a measured coefficient with other keys, expected its factor".into()),
            },
            ("formula", None, Some(formula), Some(numbers)) if ids.is_empty() => {
                Ok(Self::Formula { formula, valid, numbers })
            }
            ("measured" | "formula", ..) => Err(format!("found other keys than those of '{kind}'")),
            (_, None, None, None) => Ok(Self::Law(ConvectionLaw { kind, numbers: ids })),
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
