//! Whether a coefficient written as text is one: finite, not negative, with a flow of heat that rises with the difference.
//!
//! The text is computed as written, without rounding, on a grid of differences (-60 to 60 K) and winds (0 to 30 m/s), wherever it
//! says that it is valid: with the values of its numbers, and with the ends of their ranges.

use core::fmt::Write;

use super::formula_text::{
    AIR, CHANGING, DIFFERENCE, FormulaText, SURFACE, SideNames, VARIABLES, WIND, WINDWARD,
};
use super::wind::{AROUND, Surroundings};
use crate::physics::formula::lexer::fault;
use crate::physics::formula::units::{self, Unit};
use crate::physics::formula::{Fault, FormulaFault, LawNumber, Position, corners};

/// Largest difference of the grid [K].
const FARTHEST: f64 = 60.0;
/// Differences on each side of zero; the distances between them grow.
const DIFFERENCES: i32 = 100;
/// Winds of the grid [m/s].
const WINDS: [f64; 7] = [0.0, 0.2, 1.0, 3.0, 8.0, 15.0, 30.0];
/// Temperatures of the air of the grid [degC], angles of the wind [deg], irradiances [W/m2] and air changes [1/h].
const SURROUNDINGS: [&[f64]; AROUND] = [
    &[-30.0, -10.0, 5.0, 20.0, 35.0, 60.0],
    &[0.0, 45.0, 90.0, 135.0, 180.0],
    &[0.0, 100.0, 500.0, 1200.0],
    &[0.0, 0.3, 2.0, 10.0, 50.0],
    &[0.0, 0.3, 3.0, 20.0, 100.0],
];
/// Coefficients above this have no physical meaning [W/(m2 K)].
const LARGEST: f64 = 1e5;
/// Rounding of a flow, as a part of it.
const ROUNDING: f64 = 1e-9;
/// Units of the names of a side, in their order; an angle may be in degrees or not.
const SIDE_UNITS: [Option<Unit>; VARIABLES.len()] = [
    Some(units::KELVIN),
    Some(units::SPEED),
    Some(units::NONE),
    None,
    Some(units::NONE),
    Some(units::AREA),
    Some(units::DENSITY),
    Some(units::KELVIN),
    Some(units::KELVIN),
    None,
    Some(units::FLUX),
    None,
    None,
    Some(units::LENGTH),
];

/// A coefficient as text, at a side of a surface.
#[derive(Debug, Clone, PartialEq)]
pub struct LawText<'a> {
    /// The coefficient [W/(m2 K)].
    pub formula: &'a str,
    /// Where it is valid.
    pub valid: Option<&'a str>,
    /// Its numbers.
    pub numbers: &'a [LawNumber],
    /// The side that it stands at.
    pub side: LawSide,
}

/// A side of a surface, as far as laws as text depend on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LawSide {
    /// Whether wind reaches it.
    pub wind: bool,
    /// Whether the irradiance of its plane is known.
    pub sun: bool,
    /// Whether it faces a zone.
    pub zone: bool,
    /// Angle between upwards and the normal into the air [deg].
    pub tilt: f64,
    /// Area [m2].
    pub area: f64,
    /// Density of the air [kg/m3].
    pub density: f64,
    /// Height above ground, where it has one [m].
    pub height: Option<f64>,
}

impl LawSide {
    /// Values of the names that a side gives, in their order; those that change are zero.
    fn values(&self) -> [f64; VARIABLES.len()] {
        let upward = crate::number::elementary::cos_of_degrees(self.tilt);
        let mut values = [0.0; VARIABLES.len()];
        values[3..7].copy_from_slice(&[self.tilt, upward, self.area, self.density]);
        values[AIR + AROUND] = self.height.unwrap_or(0.0);
        values
    }
}

/// A point of a law: the temperature difference [K], the wind at the surface, windward [m/s], and what is around it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LawPoint {
    /// [K].
    pub difference: f64,
    /// [m/s].
    pub wind: f64,
    /// What is around the surface.
    pub around: Surroundings<f64>,
}

impl LawText<'_> {
    /// Reads the law and looks at its values.
    ///
    /// # Errors
    /// The first fault of its texts, or the first point at which it is no coefficient.
    pub fn check(&self) -> Result<(), FormulaFault> {
        let text = self.read()?;
        let side = self.side.values();
        let nominal: Vec<f64> = self.numbers.iter().map(|number| number.value).collect();
        let mut names: Vec<f64> = side.into_iter().chain(nominal.clone()).collect();
        self.check_units(&text, &names)?;
        if !self.sweep(&text, &mut names)? {
            let found = "no difference of -60 to 60 K, no wind of 0 to 30 m/s and no air of -30 to 60 degC at which it is valid";
            let fault = fault(START, found, "some at which it is", "Correct 'valid'.");
            return Err(FormulaFault { key: "valid".into(), fault });
        }
        for corner in corners(self.numbers) {
            names[side.len()..].copy_from_slice(&corner);
            self.sweep(&text, &mut names)?;
        }
        Ok(())
    }

    /// Values of the coefficient [W/(m2 K)]; as written.
    ///
    /// # Errors
    /// The first fault of its texts.
    pub fn values(&self, points: &[LawPoint]) -> Result<Vec<f64>, FormulaFault> {
        let text = self.read()?;
        let given = self.numbers.iter().map(|number| number.value);
        let mut names: Vec<f64> = self.side.values().into_iter().chain(given).collect();
        names[WINDWARD] = 1.0;
        Ok(points
            .iter()
            .map(|LawPoint { difference, wind, around }| {
                (names[DIFFERENCE], names[WIND]) = (*difference, *wind);
                names[AIR..AIR + AROUND].copy_from_slice(&around.list());
                names[SURFACE] = around.air + difference;
                text.tree.value(&names)
            })
            .collect())
    }

    fn check_units(&self, text: &FormulaText, values: &[f64]) -> Result<(), FormulaFault> {
        let Some(units) = units::of_numbers(&SIDE_UNITS, self.numbers)? else { return Ok(()) };
        let at = |key: &str, fault: Fault| FormulaFault { key: key.to_owned(), fault };
        let stated = units::Stated { units: &units, values, changing: &CHANGING };
        stated.check(&text.tree, units::COEFFICIENT).map_err(|fault| at("formula", fault))?;
        let valid = text.valid.as_ref();
        valid.map_or(Ok(()), |valid| stated.check_condition(valid)).map_err(|fault| at("valid", fault))
    }

    fn read(&self) -> Result<FormulaText, FormulaFault> {
        let names: Vec<&str> = self.numbers.iter().map(|number| number.name.as_str()).collect();
        let LawSide { wind, sun, zone, height, .. } = self.side;
        let side = SideNames { wind, sun, zone, height: height.is_some() };
        FormulaText::new(self.formula, self.valid, &names, side)
    }

    /// Winds, sides of the wind and surroundings of the grid: those that the law uses.
    fn weathers(text: &FormulaText) -> Vec<[f64; AROUND + 2]> {
        let one: &[f64] = &[0.0];
        let mut all = vec![[0.0; AROUND + 2]];
        let air = text.uses(AIR) || text.uses(SURFACE);
        let lists: [&[f64]; AROUND + 2] = [
            if text.uses(WIND) { &WINDS } else { one },
            if text.uses(WINDWARD) { &[0.0, 1.0] } else { &[1.0] },
            if air { SURROUNDINGS[0] } else { one },
            if text.uses(AIR + 1) { SURROUNDINGS[1] } else { one },
            if text.uses(AIR + 2) { SURROUNDINGS[2] } else { one },
            if text.uses(AIR + 3) { SURROUNDINGS[3] } else { one },
            if text.uses(AIR + 4) { SURROUNDINGS[4] } else { one },
        ];
        for (place, list) in lists.into_iter().enumerate() {
            let with = |weather: [f64; AROUND + 2]| {
                list.iter().map(move |&value| {
                    let mut changed = weather;
                    changed[place] = value;
                    changed
                })
            };
            all = all.into_iter().flat_map(with).collect();
        }
        all
    }

    /// Looks at all points of the grid; whether it is valid at some of them.
    fn sweep(&self, text: &FormulaText, names: &mut [f64]) -> Result<bool, FormulaFault> {
        let mut valid = false;
        for [wind, windward, around @ ..] in Self::weathers(text) {
            (names[WIND], names[WINDWARD]) = (wind, windward);
            names[AIR..AIR + AROUND].copy_from_slice(&around);
            let mut before: Option<[f64; 2]> = None;
            for k in -DIFFERENCES..=DIFFERENCES {
                let part = f64::from(k) / f64::from(DIFFERENCES);
                let difference = FARTHEST * part * part.abs();
                (names[DIFFERENCE], names[SURFACE]) = (difference, around[0] + difference);
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
        let others = [("Ts", SURFACE, "degC"), ("Ta", AIR, "degC"), ("wind_angle", AIR + 1, "deg")];
        let others = others.into_iter().chain([
            ("sun", AIR + 2, "W/m2"),
            ("air_change", AIR + 3, "1/h"),
            ("total_air_change", AIR + 4, "1/h"),
        ]);
        for (name, place, unit) in others {
            if text.uses(place) {
                let _ = write!(words, ", {name} = {:.3} {unit}", names[place]);
            }
        }
        for (number, value) in self.numbers.iter().zip(&names[VARIABLES.len()..]) {
            if number.range.is_some() {
                let _ = write!(words, ", {} = {value}", number.name);
            }
        }
        words
    }
}

const START: Position = Position { line: 1, column: 1 };
