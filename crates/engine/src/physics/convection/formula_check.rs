//! Whether a coefficient written as text is one: finite, not negative, with a flow of heat that rises with the difference.
//!
//! The text is computed as written, without rounding, on a grid of differences (-60 to 60 K) and winds (0 to 30 m/s), wherever it
//! says that it is valid: with the values of its numbers, and with the ends of their ranges.

use core::fmt::Write;

use super::formula_text::{DIFFERENCE, FormulaText, WIND, WINDWARD};
use crate::physics::formula::lexer::fault;
use crate::physics::formula::units::{self, Unit};
use crate::physics::formula::{Fault, FormulaFault, LawNumber, Position};

/// Largest difference of the grid [K].
const FARTHEST: f64 = 60.0;
/// Differences on each side of zero; the distances between them grow.
const DIFFERENCES: i32 = 100;
/// Winds of the grid [m/s].
const WINDS: [f64; 7] = [0.0, 0.2, 1.0, 3.0, 8.0, 15.0, 30.0];
/// Coefficients above this have no physical meaning [W/(m2 K)].
const LARGEST: f64 = 1e5;
/// Rounding of a flow, as a part of it.
const ROUNDING: f64 = 1e-9;
/// Units of the names of a side, in their order; an angle may be in degrees or not.
const SIDE_UNITS: [Option<Unit>; 7] = [
    Some(units::KELVIN),
    Some(units::SPEED),
    Some(units::NONE),
    None,
    Some(units::NONE),
    Some(units::AREA),
    Some(units::DENSITY),
];
/// With more numbers that have ranges not all ends of them are combined.
const COMBINED: usize = 4;

/// A coefficient as text, at a side of a surface.
#[derive(Debug, Clone, PartialEq)]
pub struct LawText<'a> {
    /// The coefficient [W/(m2 K)].
    pub formula: &'a str,
    /// Where it is valid.
    pub valid: Option<&'a str>,
    /// Its numbers.
    pub numbers: &'a [LawNumber],
    /// Whether wind reaches the side.
    pub wind: bool,
    /// Angle between upwards and the normal into the air [deg].
    pub tilt: f64,
    /// Area [m2].
    pub area: f64,
    /// Density of the air [kg/m3].
    pub density: f64,
}

impl LawText<'_> {
    /// Reads the law and looks at its values.
    ///
    /// # Errors
    /// The first fault of its texts, or the first point at which it is no coefficient.
    pub fn check(&self) -> Result<(), FormulaFault> {
        let text = self.read()?;
        let upward = crate::number::elementary::cos_of_degrees(self.tilt);
        let side = [0.0, 0.0, 0.0, self.tilt, upward, self.area, self.density];
        let nominal: Vec<f64> = self.numbers.iter().map(|number| number.value).collect();
        let mut names: Vec<f64> = side.into_iter().chain(nominal.clone()).collect();
        self.check_units(&text, &names)?;
        if !self.sweep(&text, &mut names)? {
            let found = "no difference of -60 to 60 K and no wind of 0 to 30 m/s at which it is valid";
            let fault = fault(START, found, "some at which it is", "Correct 'valid'.");
            return Err(FormulaFault { key: "valid".into(), fault });
        }
        for corner in self.corners(&nominal) {
            names[side.len()..].copy_from_slice(&corner);
            self.sweep(&text, &mut names)?;
        }
        Ok(())
    }

    /// Values of the coefficient at differences [K] and winds at the surface [m/s], windward [W/(m2 K)]; as written.
    ///
    /// # Errors
    /// The first fault of its texts.
    pub fn values(&self, points: &[[f64; 2]]) -> Result<Vec<f64>, FormulaFault> {
        let text = self.read()?;
        let upward = crate::number::elementary::cos_of_degrees(self.tilt);
        let given = self.numbers.iter().map(|number| number.value);
        let side = [0.0, 0.0, 1.0, self.tilt, upward, self.area, self.density];
        let mut names: Vec<f64> = side.into_iter().chain(given).collect();
        Ok(points
            .iter()
            .map(|[difference, wind]| {
                (names[DIFFERENCE], names[WIND]) = (*difference, *wind);
                text.tree.value(&names)
            })
            .collect())
    }

    fn check_units(&self, text: &FormulaText, values: &[f64]) -> Result<(), FormulaFault> {
        let Some(units) = units::of_numbers(&SIDE_UNITS, self.numbers)? else { return Ok(()) };
        let at = |key: &str, fault: Fault| FormulaFault { key: key.to_owned(), fault };
        let stated = units::Stated { units: &units, values, variables: WINDWARD + 1 };
        stated.check(&text.tree, units::COEFFICIENT).map_err(|fault| at("formula", fault))?;
        let valid = text.valid.as_ref();
        valid.map_or(Ok(()), |valid| stated.check_condition(valid)).map_err(|fault| at("valid", fault))
    }

    fn read(&self) -> Result<FormulaText, FormulaFault> {
        let names: Vec<&str> = self.numbers.iter().map(|number| number.name.as_str()).collect();
        FormulaText::new(self.formula, self.valid, &names, self.wind)
    }

    /// The numbers at the ends of their ranges.
    fn corners(&self, nominal: &[f64]) -> Vec<Vec<f64>> {
        let ranges: Vec<(usize, [f64; 2])> = (self.numbers.iter().enumerate())
            .filter_map(|(place, number)| number.range.map(|range| (place, range)))
            .collect();
        let with = |chosen: &dyn Fn(usize) -> Option<usize>| {
            let mut values = nominal.to_vec();
            for (k, (place, range)) in ranges.iter().enumerate() {
                if let Some(end) = chosen(k) {
                    values[*place] = range[end];
                }
            }
            values
        };
        let count = ranges.len();
        if count == 0 {
            return Vec::new();
        }
        if count <= COMBINED {
            return (0..1usize << count).map(|bits| with(&|k| Some(bits >> k & 1))).collect();
        }
        let alone = (0..count).flat_map(|k| [0, 1].map(|end| with(&|other| (other == k).then_some(end))));
        alone.chain([0, 1].map(|end| with(&|_| Some(end)))).collect()
    }

    /// Looks at all points of the grid; whether it is valid at some of them.
    fn sweep(&self, text: &FormulaText, names: &mut [f64]) -> Result<bool, FormulaFault> {
        let winds: &[f64] = if text.uses(WIND) { &WINDS } else { &WINDS[..1] };
        let sides: &[f64] = if text.uses(WINDWARD) { &[0.0, 1.0] } else { &[1.0] };
        let mut valid = false;
        for (&wind, &windward) in winds.iter().flat_map(|wind| sides.iter().map(move |side| (wind, side))) {
            (names[WIND], names[WINDWARD]) = (wind, windward);
            let mut before: Option<[f64; 2]> = None;
            for k in -DIFFERENCES..=DIFFERENCES {
                let part = f64::from(k) / f64::from(DIFFERENCES);
                let difference = FARTHEST * part * part.abs();
                names[DIFFERENCE] = difference;
                if text.valid.as_ref().is_some_and(|valid| !valid.holds(names)) {
                    before = None;
                    continue;
                }
                valid = true;
                let flux = self.coefficient(text, names)? * difference;
                if let Some([last, lower]) = before
                    && flux < lower - ROUNDING * (lower.abs() + flux.abs())
                {
                    return Err(self.falls(text, names, [last, lower, flux]));
                }
                before = Some([difference, flux]);
            }
        }
        Ok(valid)
    }

    /// The coefficient at a point.
    fn coefficient(&self, text: &FormulaText, names: &[f64]) -> Result<f64, FormulaFault> {
        let value = text.tree.value(names);
        let refuse = |at, found: String, expected: &str| {
            let remedy = "Write 'valid:' with the range in which the law holds, or correct the formula.";
            Err(FormulaFault { key: "formula".into(), fault: fault(at, found, expected, remedy) })
        };
        let at = self.point(text, names);
        if !value.is_finite() || value > LARGEST {
            let place = text.tree.unbounded(names).unwrap_or(text.tree.at);
            return refuse(
                place,
                format!("{value} W/(m2 K) {at}"),
                "a finite coefficient, below 1e5 W/(m2 K)",
            );
        }
        if value < -1e-9 {
            return refuse(START, format!("{value:.4} W/(m2 K) {at}"), "a coefficient that is not negative");
        }
        Ok(value)
    }

    fn falls(&self, text: &FormulaText, names: &[f64], [last, lower, flux]: [f64; 3]) -> FormulaFault {
        let found = format!(
            "a heat flow h dT that falls from {lower:.4} W/m2 at dT = {last:.3} K to {flux:.4} W/m2 {}",
            self.point(text, names)
        );
        let remedy = "Write 'valid:' with the range in which the flow rises, or correct the formula.";
        let fault: Fault = fault(START, found, "a heat flow that rises with dT", remedy);
        FormulaFault { key: "formula".into(), fault }
    }

    /// A point in words.
    fn point(&self, text: &FormulaText, names: &[f64]) -> String {
        // Writing to a string cannot fail.
        let mut words = format!("at dT = {:.3} K", names[DIFFERENCE]);
        if text.uses(WIND) {
            let _ = write!(words, ", V = {} m/s", names[WIND]);
        }
        if text.uses(WINDWARD) {
            words += if names[WINDWARD] > 0.5 { ", windward" } else { ", leeward" };
        }
        for (number, value) in self.numbers.iter().zip(&names[super::formula_text::VARIABLES.len()..]) {
            if number.range.is_some() {
                let _ = write!(words, ", {} = {value}", number.name);
            }
        }
        words
    }
}

const START: Position = Position { line: 1, column: 1 };
