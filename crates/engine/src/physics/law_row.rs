//! What a law says of itself. The description language, its checks, the reference, references to sources, titles of pages and the
//! alternatives of studies follow from it.

use serde::Serialize;

use crate::input::description::PublishedLaw;
use crate::input::values::Values;
use crate::number::real::Real;

/// Everything about a law but its equation.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct LawRow {
    /// Its name in reports.
    pub title: &'static str,
    /// What it is, in one sentence.
    pub meaning: &'static str,
    /// More about it; empty where a sentence is enough.
    pub details: &'static str,
    /// Where it is published.
    pub source: Option<&'static str>,
    /// Where what it is made of is published.
    pub further_sources: &'static [&'static str],
    /// Where it is valid.
    pub valid: &'static str,
    /// Its numbers, in the order of the description.
    pub numbers: &'static [LawParameter],
    /// Choices that values of its numbers are tabulated by.
    pub choices: &'static [Choice],
    /// Whether it has its numbers twice: where heat flows up (or the surface is vertical), and where it flows down.
    pub by_direction: bool,
    /// Sides on which it may stand.
    pub sides: Sides,
    /// How it depends on the tilt.
    pub tilt: Tilt,
    /// Where studies try it in place of another law, with these values of the numbers that have no default.
    pub alternatives: &'static [Alternative],
    /// Columns of the weather that it needs.
    pub weather: &'static [&'static str],
    /// Effect of clouds that it is used with, where none is described; none: clouds have no effect on it.
    pub clouds: Option<CloudKind>,
    /// Of a law of what a side is in contact with: whether it gives heat beside its temperature.
    pub gives_heat: bool,
    /// Whether it gives the coefficient through which its temperature acts.
    pub gives_coefficient: bool,
}

impl LawRow {
    /// A law without numbers that may stand anywhere.
    pub const fn new(title: &'static str, meaning: &'static str, valid: &'static str) -> Self {
        Self {
            title,
            meaning,
            details: "",
            source: None,
            further_sources: &[],
            valid,
            numbers: &[],
            choices: &[],
            by_direction: false,
            sides: Sides::Any,
            tilt: Tilt::None,
            alternatives: &[],
            weather: &[],
            clouds: None,
            gives_heat: false,
            gives_coefficient: false,
        }
    }

    /// Gives heat to the surface beside its temperature.
    #[must_use]
    pub const fn gives_heat(self) -> Self {
        Self { gives_heat: true, ..self }
    }

    /// Gives the coefficient of heat transfer between its temperature and the surface.
    #[must_use]
    pub const fn gives_coefficient(self) -> Self {
        Self { gives_coefficient: true, ..self }
    }

    /// With more about it.
    #[must_use]
    pub const fn details(self, details: &'static str) -> Self {
        Self { details, ..self }
    }

    /// With choices that values of its numbers are tabulated by.
    #[must_use]
    pub const fn choices(self, choices: &'static [Choice]) -> Self {
        Self { choices, ..self }
    }

    /// Published there.
    #[must_use]
    pub const fn source(self, source: &'static str) -> Self {
        Self { source: Some(source), ..self }
    }

    /// Made of what is published there.
    #[must_use]
    pub const fn further_sources(self, further_sources: &'static [&'static str]) -> Self {
        Self { further_sources, ..self }
    }

    /// Needs these columns of the weather.
    #[must_use]
    pub const fn weather(self, weather: &'static [&'static str]) -> Self {
        Self { weather, ..self }
    }

    /// An emissivity of the clear sky, used with this effect of clouds where none is described.
    #[must_use]
    pub const fn clouds(self, clouds: CloudKind) -> Self {
        Self { clouds: Some(clouds), ..self }
    }

    /// With these numbers.
    #[must_use]
    pub const fn numbers(self, numbers: &'static [LawParameter]) -> Self {
        Self { numbers, ..self }
    }

    /// With these numbers where heat flows up, and again where it flows down.
    #[must_use]
    pub const fn numbers_by_direction(self, numbers: &'static [LawParameter]) -> Self {
        Self { numbers, by_direction: true, ..self }
    }

    /// On these sides.
    #[must_use]
    pub const fn sides(self, sides: Sides) -> Self {
        Self { sides, ..self }
    }

    /// With this dependence on the tilt.
    #[must_use]
    pub const fn tilt(self, tilt: Tilt) -> Self {
        Self { tilt, ..self }
    }

    /// Tried by studies.
    #[must_use]
    pub const fn alternatives(self, alternatives: &'static [Alternative]) -> Self {
        Self { alternatives, ..self }
    }

    /// Names of all numbers, and whether each may be absent: `upward.a` is `a` where heat flows up.
    pub(crate) fn names(&self) -> Vec<(String, bool)> {
        let groups: &[&str] = if self.by_direction { &["upward.", "downward."] } else { &[""] };
        (groups.iter())
            .flat_map(|group| self.numbers.iter().map(move |n| (format!("{group}{}", n.name), n.outdoors)))
            .collect()
    }

    /// Whether a description has all numbers of a law, and no others.
    ///
    /// # Errors
    /// What was found, and what was expected.
    pub(crate) fn check(&self, law: &PublishedLaw) -> Result<(), String> {
        let (kind, names) = (&law.kind, self.names());
        let known = |name: &str| names.iter().any(|(other, _)| other == name);
        if let Some((name, _)) = law.numbers.iter().find(|(name, _)| !known(name)) {
            return Err(format!("found the number '{name}' of '{kind}', expected {names:?}"));
        }
        let has = |name: &str| law.number(name).is_some();
        if let Some((name, _)) = names.iter().find(|(name, optional)| !optional && !has(name)) {
            return Err(format!("found '{kind}' without '{name}', expected all its numbers"));
        }
        let outdoors: Vec<&str> =
            names.iter().filter(|(_, optional)| *optional).map(|(name, _)| name.as_str()).collect();
        if outdoors.iter().any(|name| has(name)) && !outdoors.iter().all(|name| has(name)) {
            return Err(format!(
                "found only one of them, expected {} together, or none",
                outdoors.join(" and ")
            ));
        }
        Ok(())
    }
}

/// The error for a kind that is no law.
pub(crate) fn unknown_kind(law: &PublishedLaw) -> String {
    format!("found the kind '{}', expected one of the table", law.kind)
}

/// The values of the numbers of a law, by name.
pub(crate) struct Numbers<'a, S> {
    values: &'a Values<'a, S>,
    law: &'a PublishedLaw,
}

impl<'a, S: Real> Numbers<'a, S> {
    pub(crate) fn new(values: &'a Values<'a, S>, law: &'a PublishedLaw) -> Self {
        Self { values, law }
    }

    /// A number of the row.
    pub(crate) fn of(&self, name: &str) -> S {
        self.optional(name).expect("a plan knows the numbers of its laws")
    }

    /// A number of the row that outdoor sides alone have.
    pub(crate) fn optional(&self, name: &str) -> Option<S> {
        self.law.number(name).map(|id| self.values.get(id))
    }
}

/// A number of a law.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct LawParameter {
    /// Its key in a description.
    pub name: &'static str,
    /// Its unit; `-` where there is none.
    pub unit: &'static str,
    /// What it is.
    pub meaning: &'static str,
    /// Its plausible range and the reason for it.
    pub range: LawRange,
    /// Values outside have no meaning.
    pub limits: Limits,
    /// Words in place of a value.
    pub words: &'static [(&'static str, f64)],
    /// Its value where none is written.
    pub default: Default,
    /// Whether it is there on outdoor sides only.
    pub outdoors: bool,
    /// Whether it has an effect only where wind reaches the side.
    pub wind: bool,
    /// The number that it belongs to: no effect where that one is zero.
    pub of: Option<&'static str>,
    /// A value for examples.
    pub example: f64,
}

impl LawParameter {
    /// A number that has to be written, not below zero.
    pub const fn new(
        name: &'static str,
        unit: &'static str,
        meaning: &'static str,
        range: LawRange,
        example: f64,
    ) -> Self {
        let limits = Limits { above: None, at_least: Some(0.0), at_most: None };
        let default = Default::Required;
        Self {
            name,
            unit,
            meaning,
            range,
            limits,
            words: &[],
            default,
            outdoors: false,
            wind: false,
            of: None,
            example,
        }
    }

    /// Above zero.
    #[must_use]
    pub const fn positive(self) -> Self {
        Self { limits: Limits { above: Some(0.0), at_least: None, ..self.limits }, ..self }
    }

    /// Within other limits.
    #[must_use]
    pub const fn limits(self, limits: Limits) -> Self {
        Self { limits, ..self }
    }

    /// At most a value.
    #[must_use]
    pub const fn at_most(self, most: f64) -> Self {
        Self { limits: Limits { at_most: Some(most), ..self.limits }, ..self }
    }

    /// With words in place of values.
    #[must_use]
    pub const fn words(self, words: &'static [(&'static str, f64)]) -> Self {
        Self { words, ..self }
    }

    /// Not necessary.
    #[must_use]
    pub const fn default(self, default: Default) -> Self {
        Self { default, ..self }
    }

    /// On outdoor sides only, together with all others that are.
    #[must_use]
    pub const fn outdoors(self) -> Self {
        Self { outdoors: true, ..self }
    }

    /// Without effect where no wind reaches the side.
    #[must_use]
    pub const fn of_wind(self) -> Self {
        Self { wind: true, ..self }
    }

    /// Without effect where another number is zero.
    #[must_use]
    pub const fn of(self, other: &'static str) -> Self {
        Self { of: Some(other), ..self }
    }
}

/// A choice among some integers that no formula has, such as the number of storeys.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Choice {
    /// Its key in a description.
    pub name: &'static str,
    /// What it is.
    pub meaning: &'static str,
    /// What may be chosen.
    pub among: &'static [i64],
    /// What is chosen where nothing is written.
    pub default: i64,
}

/// The range in which a number is plausible, with its reason.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum LawRange {
    /// A part of the value to each side [%].
    Percent(f64, &'static str),
    /// So much to each side of the value.
    Within(f64, &'static str),
    /// Two fixed ends.
    Span(f64, f64, &'static str),
}

/// Limits of a number.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Limits {
    /// It is above this.
    pub above: Option<f64>,
    /// It is not below this.
    pub at_least: Option<f64>,
    /// It is not above this.
    pub at_most: Option<f64>,
}

impl Limits {
    /// None.
    pub const NONE: Self = Self { above: None, at_least: None, at_most: None };
}

/// What a number is where none is written.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Default {
    /// It has to be written.
    Required,
    /// A value and its reason.
    Value(f64, &'static str),
    /// A value and its source.
    Published(f64, &'static str),
    /// A value that is listed as an assumption, and its source.
    Assumed(f64, &'static str),
    /// A value for each combination of the choices, the last choice varying fastest, and the reason.
    Tabulated(&'static [f64], &'static str),
    /// The height of a vertical surface, 4 area/perimeter of another one.
    Length,
    /// The perimeter of the surface.
    Perimeter,
}

/// Sides on which a law may stand.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Sides {
    /// All sides with convection.
    Any,
    /// Outdoors and in zones, not to a temperature that is given.
    Air,
    /// Outdoors, and in zones of the engine's tests; the description language allows it outdoors only.
    Outdoors,
}

/// Effect of clouds on the emissivity of the clear sky.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum CloudKind {
    /// A factor.
    Factor,
    /// An opaque layer.
    Layer,
}

/// How a law depends on the tilt of the surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Tilt {
    /// Not at all.
    None,
    /// It only decides between vertical and horizontal.
    Cases,
    /// Steadily.
    Steady,
}

/// Where a study tries a law in place of another.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Alternative {
    /// Outdoors, or in a zone.
    pub outdoors: bool,
    /// Values of numbers.
    pub numbers: &'static [(&'static str, f64)],
}

impl Alternative {
    /// With all defaults, where there are no sides.
    pub const USUAL: Self = Self { outdoors: true, numbers: &[] };
    /// Outdoors, with all defaults.
    pub const OUTDOORS: Self = Self { outdoors: true, numbers: &[] };
    /// In a zone, with all defaults.
    pub const INDOORS: Self = Self { outdoors: false, numbers: &[] };
}

/// A law with its kind, as other languages read it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct LawEntry {
    /// Its name in a description.
    pub kind: &'static str,
    /// Whether it depends on the wind.
    pub wind: bool,
    /// Whether it depends on the direction of the wind.
    pub wind_direction: bool,
    /// Whether the flow of heat is linear in the temperature difference.
    pub linear: bool,
    /// The row.
    #[serde(flatten)]
    pub row: LawRow,
}

impl LawEntry {
    /// A law that neither wind nor a temperature difference drives.
    pub(crate) const fn new(kind: &'static str, row: LawRow) -> Self {
        Self { kind, wind: false, wind_direction: false, linear: false, row }
    }
}
