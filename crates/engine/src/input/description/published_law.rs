//! A published law with its numbers: a file in a folder of laws of `physics`.

use std::collections::BTreeMap;

use serde::Deserialize;

use super::parameter::ParamId;

/// A published law with its numbers. What it says of itself is its row (`physics/law_row.rs`).
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(from = "Written")]
pub struct PublishedLaw {
    /// Name of its file.
    pub kind: String,
    /// Its numbers by name, in the order of their names; `upward.a` is `a` where heat flows up.
    pub numbers: Vec<(String, ParamId)>,
}

/// Numbers of a law in JSON.
pub(super) type WrittenNumbers = BTreeMap<String, Option<WrittenNumber>>;

/// A number of a law, or those of a direction of the flow of heat.
#[derive(Deserialize)]
#[serde(untagged)]
pub(super) enum WrittenNumber {
    One(ParamId),
    Group(BTreeMap<String, ParamId>),
}

/// A law in JSON.
#[derive(Deserialize)]
struct Written {
    kind: String,
    #[serde(flatten)]
    numbers: WrittenNumbers,
}

impl From<Written> for PublishedLaw {
    fn from(written: Written) -> Self {
        Self::written(written.kind, written.numbers)
    }
}

impl PublishedLaw {
    /// A law with its numbers.
    #[must_use]
    pub fn new(kind: &str, numbers: &[(&str, ParamId)]) -> Self {
        let mut numbers: Vec<(String, ParamId)> =
            numbers.iter().map(|(name, id)| ((*name).to_owned(), *id)).collect();
        numbers.sort_by(|(a, _), (b, _)| a.cmp(b));
        Self { kind: kind.to_owned(), numbers }
    }

    /// The number of a name.
    #[must_use]
    pub fn number(&self, name: &str) -> Option<ParamId> {
        self.numbers.iter().find(|(other, _)| other == name).map(|(_, id)| *id)
    }

    /// A law as JSON has it.
    pub(super) fn written(kind: String, written: WrittenNumbers) -> Self {
        let mut numbers = Vec::new();
        for (name, number) in written {
            match number {
                Some(WrittenNumber::One(id)) => numbers.push((name, id)),
                Some(WrittenNumber::Group(group)) => {
                    numbers.extend(group.into_iter().map(|(inner, id)| (format!("{name}.{inner}"), id)));
                }
                None => {}
            }
        }
        Self { kind, numbers }
    }
}
