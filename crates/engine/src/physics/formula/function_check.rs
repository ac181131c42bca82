//! Whether a law as text is one, before a run: finite, within what has a meaning, and with a flow of heat that rises with its difference.

use core::fmt::Write;

use super::function::{FunctionText, Kind, names};
use super::lexer::fault;
use super::units;
use super::{FormulaFault, LawNumber, Position, corners};

/// Rounding of a flow, as a part of it.
const ROUNDING: f64 = 1e-9;
const START: Position = Position { line: 1, column: 1 };

/// A law as text that is none of convection or melting.
#[derive(Debug, Clone, PartialEq)]
pub struct FunctionLaw<'a> {
    /// What it is a law of: `conductivity`, `infiltration`, `sky_emissivity` or `sky_temperature`.
    pub kind: &'a str,
    /// The formula.
    pub formula: &'a str,
    /// Where it is valid.
    pub valid: Option<&'a str>,
    /// Its numbers.
    pub numbers: &'a [LawNumber],
}

impl FunctionLaw<'_> {
    /// Reads the law and looks at its values.
    ///
    /// # Errors
    /// The first fault of its texts, or the first point at which it is no law.
    pub fn check(&self) -> Result<(), FormulaFault> {
        let (kind, text) = (Kind::named(self.kind), self.read()?);
        let nominal: Vec<f64> = self.numbers.iter().map(|number| number.value).collect();
        self.check_units(kind, &text, &nominal)?;
        if !self.sweep(kind, &text, &nominal)? {
            let found = "no point of the looked-at range at which it is valid";
            let fault = fault(START, found, "some at which it is", "Correct 'valid'.");
            return Err(FormulaFault { key: "valid".into(), fault });
        }
        for corner in corners(self.numbers) {
            self.sweep(kind, &text, &corner)?;
        }
        Ok(())
    }

    /// Values of the law, as written; each point has the names that change, in their order, without a sum of two.
    ///
    /// # Errors
    /// The first fault of its texts.
    pub fn values(&self, points: &[Vec<f64>]) -> Result<Vec<f64>, FormulaFault> {
        let (kind, text) = (Kind::named(self.kind), self.read()?);
        let given: Vec<f64> = self.numbers.iter().map(|number| number.value).collect();
        Ok(points.iter().map(|point| text.tree.value(&names(kind, point, &given))).collect())
    }

    fn read(&self) -> Result<FunctionText, FormulaFault> {
        let names: Vec<&str> = self.numbers.iter().map(|number| number.name.as_str()).collect();
        FunctionText::new(Kind::named(self.kind), self.formula, self.valid, &names)
    }

    fn check_units(&self, kind: &Kind, text: &FunctionText, nominal: &[f64]) -> Result<(), FormulaFault> {
        let variables: Vec<_> = kind.variables.iter().map(|variable| variable.unit).collect();
        let Some(units) = units::of_numbers(&variables, self.numbers)? else { return Ok(()) };
        let values: Vec<f64> =
            vec![0.0; variables.len()].into_iter().chain(nominal.iter().copied()).collect();
        let changing: Vec<usize> = (0..variables.len()).collect();
        let stated = units::Stated { units: &units, values: &values, changing: &changing };
        let at = |key: &str| {
            let key = key.to_owned();
            move |fault| FormulaFault { key, fault }
        };
        stated.check_if(&text.tree, kind.unit).map_err(at("formula"))?;
        let valid = text.valid.as_ref();
        valid.map_or(Ok(()), |valid| stated.check_condition(valid)).map_err(at("valid"))
    }

    /// Looks at all points of the grid; whether it is valid at some of them.
    fn sweep(&self, kind: &Kind, text: &FunctionText, given: &[f64]) -> Result<bool, FormulaFault> {
        let mut others: Vec<Vec<f64>> = vec![Vec::new()];
        for (place, variable) in kind.variables.iter().enumerate().skip(1) {
            if variable.grid.is_empty() {
                continue;
            }
            let summed = kind.sum == Some(place) && text.uses(kind.variables.len() - 1);
            let used = text.uses(place) || summed;
            let grid = if used { variable.grid } else { &variable.grid[variable.grid.len() / 2..][..1] };
            let with = |point: Vec<f64>| {
                grid.iter().map(move |&value| point.iter().copied().chain([value]).collect::<Vec<f64>>())
            };
            others = others.into_iter().flat_map(with).collect();
        }
        let mut valid = false;
        for other in others {
            let mut before: Option<[f64; 2]> = None;
            for &first in kind.variables[0].grid {
                let point: Vec<f64> = core::iter::once(first).chain(other.iter().copied()).collect();
                let names = names(kind, &point, given);
                if text.valid.as_ref().is_some_and(|valid| !valid.holds(&names)) {
                    before = None;
                    continue;
                }
                valid = true;
                let value = self.value(kind, text, &names)?;
                if !kind.difference {
                    continue;
                }
                let flow = value * first;
                if let Some([last, lower]) = before
                    && flow < lower - ROUNDING * (lower.abs() + flow.abs())
                {
                    let place = self.place(kind, text, &names);
                    let found = format!(
                        "a heat flow n dT that falls from {lower:.4} at dT = {last} K to {flow:.4} K/h {place}"
                    );
                    return Err(refusal(START, found, "a heat flow that rises with dT"));
                }
                before = Some([first, flow]);
            }
        }
        Ok(valid)
    }

    fn value(&self, kind: &Kind, text: &FunctionText, names: &[f64]) -> Result<f64, FormulaFault> {
        let value = text.tree.value(names);
        let [least, most] = kind.limits;
        let found = || format!("{value:.6} {} {}", kind.words, self.place(kind, text, names));
        if !value.is_finite() {
            let place = text.tree.unbounded(names).unwrap_or(text.tree.at);
            return Err(refusal(place, found(), &format!("{} that is finite", kind.meaning)));
        }
        if !(least - 1e-9..=most).contains(&value) {
            let expected = format!("{} of {least} to {most} {}", kind.meaning, kind.words);
            return Err(refusal(START, found(), &expected));
        }
        Ok(value)
    }

    /// A point in words.
    fn place(&self, kind: &Kind, text: &FunctionText, names: &[f64]) -> String {
        let mut words = String::from("at");
        let mut before = " ";
        for (place, (variable, value)) in kind.variables.iter().zip(names).enumerate() {
            if place == 0 || text.uses(place) {
                // Writing to a string cannot fail.
                let _ = write!(words, "{before}{} = {value} {}", variable.name, variable.words);
                before = ", ";
            }
        }
        for (number, value) in self.numbers.iter().zip(&names[kind.variables.len()..]) {
            if number.range.is_some() {
                let _ = write!(words, "{before}{} = {value}", number.name);
            }
        }
        words
    }
}

fn refusal(at: Position, found: String, expected: &str) -> FormulaFault {
    let remedy = "Write 'valid:' with the range in which the law holds, or correct the formula.";
    FormulaFault { key: "formula".into(), fault: fault(at, found, expected, remedy) }
}

#[cfg(test)]
mod tests {
    use super::super::function::Function;
    use super::*;
    use crate::number::dual::Dual;
    use crate::number::real::Real;

    fn number(name: &str, value: f64, range: Option<[f64; 2]>, unit: Option<&str>) -> LawNumber {
        LawNumber { name: name.into(), value, range, unit: unit.map(str::to_owned) }
    }

    #[track_caller]
    fn fault_of(kind: &str, formula: &str, valid: Option<&str>, numbers: &[LawNumber]) -> String {
        let fault = FunctionLaw { kind, formula, valid, numbers }.check().unwrap_err();
        format!("{} {}", fault.key, fault.fault)
    }

    /// Value and slope of a law are those of its tree and of differences, with derivatives by its numbers.
    #[test]
    fn values_and_slopes() {
        for (kind, formula, others) in [
            ("conductivity", "a + b*T + 1e-5*T^2", vec![]),
            ("infiltration", "a*sqrt(b*abs(dT) + 0.01*V^2)*(Ti + 273.15)/300 + 0.001*To", vec![4.0, -5.0]),
            ("sky_emissivity", "a + b*sqrt(pw/1e5) + 1e-3*To*cloud/10", vec![3.0, 700.0, 5.0]),
        ] {
            let numbers = [number("a", 0.6, None, None), number("b", 0.02, None, None)];
            let law = FunctionLaw { kind, formula, valid: None, numbers: &numbers };
            let plain = Function::<f64>::new(Kind::named(kind), (formula, None), &["a", "b"], &[0.6, 0.02]);
            for first in [-11.0, 3.0, 25.0] {
                let point: Vec<f64> = core::iter::once(first).chain(others.clone()).collect();
                let [value, slope] = plain.at(first, &others);
                assert!((value / law.values(&[point]).unwrap()[0] - 1.0).abs() < 1e-5, "{kind} at {first}");
                let quotient =
                    (plain.at(first + 1e-4, &others)[0] - plain.at(first - 1e-4, &others)[0]) / 2e-4;
                assert!((slope - quotient).abs() < 1e-7, "{kind} at {first}: {slope} is not {quotient}");
                let mut values = [0.6, 0.02].map(Dual::<2>::constant);
                (values[0].slope[0], values[1].slope[1]) = (1.0, 1.0);
                let dual = Function::new(Kind::named(kind), (formula, None), &["a", "b"], &values);
                let others: Vec<_> = others.iter().map(|&other| Dual::constant(other)).collect();
                let by = dual.at(Dual::constant(first), &others)[0];
                let with = |b: f64| {
                    let law =
                        Function::<f64>::new(Kind::named(kind), (formula, None), &["a", "b"], &[0.6, b]);
                    let others: Vec<f64> = others.iter().map(|other| other.value).collect();
                    law.at(first, &others)[0]
                };
                let quotient = (with(0.02 + 1e-6) - with(0.02 - 1e-6)) / 2e-6;
                assert!((by.slope[1] / quotient - 1.0).abs() < 1e-4, "{kind}: {} {quotient}", by.slope[1]);
            }
            // Beyond the grid it stays.
            let [end, slope] = plain.at(500.0, &others);
            assert!(slope == 0.0 && end == plain.at(1e6, &others)[0]);
        }
    }

    #[test]
    fn laws_that_are_none_are_refused() {
        let a = [number("a", 0.04, Some([0.01, 0.1]), None)];
        let sound =
            FunctionLaw { kind: "conductivity", formula: "a + 1e-4*T", valid: Some("T > 0"), numbers: &a };
        assert_eq!(sound.check(), Ok(()));
        let w = [number("a", 0.04, None, Some("W/(m2 K)"))];
        for (kind, formula, valid, numbers, words) in [
            ("conductivity", "a*(T - ", None, &a[..], "formula column 8"),
            ("conductivity", "a*Tx", None, &a, "column 3: found the name 'Tx'"),
            ("conductivity", "a/(T - 20)", Some("T > 18"), &a, "column 2: found inf"),
            ("conductivity", "a - 0.01*T", Some("T > 0"), &a, "expected a conductivity of 0.00001"),
            ("conductivity", "a + 0*T", None, &w, "a formula in W/(m2 K)"),
            ("conductivity", "a", Some("T > 500"), &a, "valid column 1: found no point"),
            ("infiltration", "a*exp(-abs(dT))*(V + 1)", None, &a, "falls from"),
            ("infiltration", "a - 0.01*V", None, &a, "an air change of 0 to 1000"),
            ("sky_emissivity", "a*log(pw - 100)", None, &a, "column 3: found NaN"),
            ("sky_temperature", "To*20 + a", None, &a, "a temperature of the sky of -150 to 60"),
        ] {
            let fault = fault_of(kind, formula, valid, numbers);
            assert!(fault.contains(words), "{formula}: {fault}");
        }
    }
}
