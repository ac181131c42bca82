//! Moisture content of materials by relative humidity: any of the laws of [`laws`], or a table.

pub(crate) mod laws;
pub(crate) mod prelude;
pub(crate) mod sorption_law;

use crate::input::description::{PublishedLaw, Sorption};
use crate::input::values::Values;
use crate::number::real::{Mask, Real};
use crate::physics::law_row::{LawEntry, LawRow, Numbers};
use laws::with_laws;
use sorption_law::SorptionLaw;

/// Relative humidities between which a law is straight lines [-].
const POINTS: [f64; 14] = [0.0, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.85, 0.9, 0.95, 1.0];

/// Defines the functions of the laws, one for each file of `laws`.
macro_rules! laws {
    ($(($module:ident, $law:ident, $kind:literal))*) => {
        /// The lines of a law; none for a kind that is no law.
        fn lines<S: Real>(law: &PublishedLaw, values: &Values<'_, S>) -> Option<Vec<Segment<S>>> {
            let number = &Numbers::new(values, law);
            match law.kind.as_str() {
                $($kind => Some(lines_of(&<laws::$module::$law<S> as SorptionLaw<S>>::new(number))),)*
                _ => None,
            }
        }

        /// All laws that a description has by name, in the order of their kinds.
        #[must_use]
        pub fn table() -> Vec<LawEntry> {
            vec![$(LawEntry::new($kind, <laws::$module::$law<f64> as SorptionLaw<f64>>::ROW)),*]
        }

        /// What a law says of itself; none for a kind that is no law.
        pub(crate) fn row(law: &PublishedLaw) -> Option<LawRow> {
            match law.kind.as_str() {
                $($kind => Some(<laws::$module::$law<f64> as SorptionLaw<f64>>::ROW),)*
                _ => None,
            }
        }
    };
}

with_laws!(laws);

/// Straight lines between points of a law.
fn lines_of<S: Real, L: SorptionLaw<S>>(law: &L) -> Vec<Segment<S>> {
    let points: &[f64] = if L::STRAIGHT { &[0.0, 1.0] } else { &POINTS };
    let line = |ends: &[f64]| {
        let (content, next) = (law.content(ends[0]), law.content(ends[1]));
        Segment { humidity: ends[0], content, slope: (next - content).scale(1.0 / (ends[1] - ends[0])) }
    };
    points.windows(2).map(line).collect()
}

/// Moisture content by relative humidity: straight lines, the first and the last without end.
#[derive(Debug, Clone)]
pub struct Isotherm<S> {
    lines: Vec<Segment<S>>,
}

/// A straight line from a point.
#[derive(Debug, Clone, Copy)]
struct Segment<S> {
    humidity: f64,
    content: S,
    /// [kg/m3].
    slope: S,
}

impl<S: Real> Isotherm<S> {
    /// Evaluates an isotherm at a parameter vector.
    ///
    /// # Panics
    /// For a kind that is no law: a plan refuses it.
    #[must_use]
    pub fn new(sorption: &Sorption, values: &Values<'_, S>) -> Self {
        let lines = match sorption {
            Sorption::Law(law) => lines(law, values).expect("a plan knows its laws of sorption"),
            Sorption::Table { humidities, contents, factor } => {
                let factor = values.get(*factor);
                let pairs = humidities.windows(2).zip(contents.windows(2));
                let line = |(humidity, content): (&[f64], &[f64])| Segment {
                    humidity: humidity[0],
                    content: factor.scale(content[0]),
                    slope: factor.scale((content[1] - content[0]) / (humidity[1] - humidity[0])),
                };
                pairs.map(line).collect()
            }
        };
        Self { lines }
    }

    /// Whether it is one straight line.
    #[inline(always)]
    pub(crate) fn is_straight(&self) -> bool {
        self.lines.len() == 1
    }

    /// Content at a relative humidity [kg/m3].
    #[inline(always)]
    pub fn content(&self, humidity: S) -> S {
        let of = |line: &Segment<S>| line.content + line.slope * (humidity - S::constant(line.humidity));
        let mut content = of(&self.lines[0]);
        for line in &self.lines[1..] {
            content = S::select(humidity.lt(S::constant(line.humidity)), content, of(line));
        }
        content
    }

    /// Relative humidity at a content [kg/m3], and the slope of the content there [kg/m3].
    #[inline(always)]
    pub fn humidity(&self, content: S) -> (S, S) {
        let (humidity, start, slope) = self.line_at(content);
        (humidity + (content - start) / slope, slope)
    }

    /// The line at a content: humidity and content at its start, and its slope.
    #[inline(always)]
    fn line_at(&self, content: S) -> (S, S, S) {
        let of = |line: &Segment<S>| (S::constant(line.humidity), line.content, line.slope);
        let (first, others) = (&self.lines[0], &self.lines[1..]);
        if S::LANES == 1 {
            // One number is looked up, with the result of the selections below.
            let begins = |line: &&Segment<S>| !content.lt(line.content).any();
            return of(others.iter().rfind(begins).unwrap_or(first));
        }
        let mut at = of(first);
        for line in others {
            let (below, next) = (content.lt(line.content), of(line));
            at.0 = S::select(below, at.0, next.0);
            at.1 = S::select(below, at.1, next.1);
            at.2 = S::select(below, at.2, next.2);
        }
        at
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::description::ParamId;

    /// Content and humidity are inverse to each other, on all lines and beyond the last point.
    #[test]
    fn isotherms_are_inverted() {
        let table = Sorption::Table {
            humidities: vec![0.0, 0.5, 0.9],
            contents: vec![0.0, 4.0, 10.0],
            factor: ParamId(0),
        };
        let isotherm = Isotherm::new(&table, &Values::new(&[2.0]));
        assert!((isotherm.content(0.5) - 8.0).abs() < 1e-15);
        assert!((isotherm.content(0.7) - 14.0).abs() < 1e-14);
        for humidity in [0.1, 0.5, 0.6, 1.1] {
            let (found, slope) = isotherm.humidity(isotherm.content(humidity));
            let expected = if humidity < 0.5 { 16.0 } else { 30.0 };
            assert!((found - humidity).abs() < 1e-15 && (slope - expected).abs() < 1e-13, "{humidity}");
        }
    }
}
