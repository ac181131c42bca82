//! Whether the units of a formula fit together.
//!
//! A unit is a product of powers of kilogram, metre, second and kelvin. A number without a unit, a number in the text and an angle may
//! have any: papers print `1.31 dT^(1/3)`, where 1.31 has the unit that is missing. Only what is stated is compared.

use super::lexer::{Word, fault};
use super::parser::{Names, Parser};
use super::tree::{Condition, Function, Kind, Operation, Tree};
use super::{Fault, FormulaFault, LawNumber, Position};

/// Exponents of kg, m, s and K.
pub(crate) type Unit = [f64; 4];

/// Units by their names; those of other scales would need a factor.
const KNOWN: [(&str, Unit); 10] = [
    ("kg", [1.0, 0.0, 0.0, 0.0]),
    ("m", [0.0, 1.0, 0.0, 0.0]),
    ("s", [0.0, 0.0, 1.0, 0.0]),
    ("K", [0.0, 0.0, 0.0, 1.0]),
    ("degC", [0.0, 0.0, 0.0, 1.0]),
    ("W", [1.0, 2.0, -3.0, 0.0]),
    ("J", [1.0, 2.0, -2.0, 0.0]),
    ("N", [1.0, 1.0, -2.0, 0.0]),
    ("Pa", [1.0, -1.0, -2.0, 0.0]),
    ("rad", NONE),
];
pub(crate) const NONE: Unit = [0.0; 4];
pub(crate) const KELVIN: Unit = [0.0, 0.0, 0.0, 1.0];
pub(crate) const SPEED: Unit = [0.0, 1.0, -1.0, 0.0];
pub(crate) const AREA: Unit = [0.0, 2.0, 0.0, 0.0];
pub(crate) const DENSITY: Unit = [1.0, -3.0, 0.0, 0.0];
/// Pa, and W/(m K).
pub(crate) const PRESSURE: Unit = [1.0, -1.0, -2.0, 0.0];
pub(crate) const CONDUCTIVITY: Unit = [1.0, 1.0, -3.0, -1.0];
pub(crate) const LENGTH: Unit = [0.0, 1.0, 0.0, 0.0];
/// W/m2.
pub(crate) const FLUX: Unit = [1.0, 0.0, -3.0, 0.0];
/// W/(m2 K).
pub(crate) const COEFFICIENT: Unit = [1.0, 0.0, -3.0, -1.0];
/// Exponents this close are the same.
const SAME: f64 = 1e-9;

/// Reads a unit such as `W/(m2 K^(1+n))`; `names` are those of numbers in its exponents, with their `values`.
///
/// # Errors
/// What is no unit.
fn read(text: &str, names: &[&str], values: &[f64]) -> Result<Unit, Fault> {
    if text.trim() == "-" {
        return Ok(NONE);
    }
    let mut parser = Parser::new(text, Names { usable: names, flags: &[], absent: &[] })?;
    let unit = product(&mut parser, values)?;
    if *parser.word() == Word::End {
        return Ok(unit);
    }
    Err(fault(parser.at(), parser.word().shown(), "a unit", "Write a unit such as W/(m2 K) or m/s."))
}

fn product(parser: &mut Parser<'_>, values: &[f64]) -> Result<Unit, Fault> {
    let mut unit = factor(parser, values)?;
    loop {
        let over = parser.take("/");
        if !over && !parser.take("*") && !matches!(parser.word(), Word::Name(_) | Word::Sign("(")) {
            return Ok(unit);
        }
        let other = factor(parser, values)?;
        unit = combined(unit, other, if over { -1.0 } else { 1.0 });
    }
}

fn factor(parser: &mut Parser<'_>, values: &[f64]) -> Result<Unit, Fault> {
    let at = parser.at();
    parser.deeper()?;
    let word = parser.word().clone();
    parser.advance();
    let unit = match word {
        Word::Name(name) => named(&name, at)?,
        Word::Number(1.0) => NONE,
        Word::Sign("(") => {
            let inside = product(parser, values)?;
            parser.close(at)?;
            inside
        }
        word => return Err(fault(at, word.shown(), "a unit", "Write a unit such as W/(m2 K) or m/s.")),
    };
    if parser.take("^") {
        let exponent = parser.signed()?.value(values);
        return Ok(unit.map(|part| part * exponent));
    }
    Ok(unit)
}

/// A unit with a whole exponent behind it, such as `m2`.
fn named(name: &str, at: Position) -> Result<Unit, Fault> {
    let letters = name.trim_end_matches(|c: char| c.is_ascii_digit());
    let exponent: f64 = name[letters.len()..].parse().unwrap_or(1.0);
    if let Some((_, unit)) = KNOWN.iter().find(|(known, _)| *known == letters) {
        return Ok(unit.map(|part| part * exponent));
    }
    let known: Vec<&str> = KNOWN.iter().map(|(name, _)| *name).collect();
    let expected = format!("a unit made of {}", known.join(", "));
    let remedy = "Convert the number to these units, without prefixes: 0.05 m for 5 cm.";
    Err(fault(at, format!("'{name}'"), &expected, remedy))
}

fn combined(a: Unit, b: Unit, sign: f64) -> Unit {
    core::array::from_fn(|k| a[k] + sign * b[k])
}

fn same(a: Unit, b: Unit) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() < SAME)
}

/// A unit in words.
fn shown(unit: Unit) -> String {
    if same(unit, COEFFICIENT) {
        return "W/(m2 K)".into();
    }
    if same(unit, FLUX) {
        return "W/m2".into();
    }
    if same(unit, CONDUCTIVITY) {
        return "W/(m K)".into();
    }
    let power = |(name, exponent): (&str, f64)| match exponent {
        1.0 => name.to_owned(),
        exponent => format!("{name}^{}", (exponent * 1e4).round() / 1e4),
    };
    let parts = ["kg", "m", "s", "K"].into_iter().zip(unit).filter(|(_, exponent)| exponent.abs() > SAME);
    let parts: Vec<String> = parts.map(power).collect();
    if parts.is_empty() { "no unit".into() } else { parts.join(" ") }
}

/// A unit as outputs state it; none where it is no product of the known ones.
pub(crate) fn known(text: &str) -> Option<Unit> {
    read(text, &[], &[]).ok()
}

/// As [`of_numbers`], also where no number states a unit.
///
/// # Errors
/// What is no unit, by the name of its number.
pub(crate) fn of_any_numbers(
    variables: &[Option<Unit>],
    numbers: &[LawNumber],
) -> Result<Vec<Option<Unit>>, FormulaFault> {
    let stated = of_numbers(variables, numbers)?;
    Ok(stated.unwrap_or_else(|| variables.iter().copied().chain(numbers.iter().map(|_| None)).collect()))
}

/// Units of variables and numbers, by their places; none where no number states one: then nothing is compared.
///
/// # Errors
/// What is no unit, by the name of its number.
pub(crate) fn of_numbers(
    variables: &[Option<Unit>],
    numbers: &[LawNumber],
) -> Result<Option<Vec<Option<Unit>>>, FormulaFault> {
    if numbers.iter().all(|number| number.unit.is_none()) {
        return Ok(None);
    }
    let names: Vec<&str> = numbers.iter().map(|number| number.name.as_str()).collect();
    let values: Vec<f64> = numbers.iter().map(|number| number.value).collect();
    let mut units = variables.to_vec();
    for number in numbers {
        let at = |fault| FormulaFault { key: number.name.clone(), fault };
        let unit = number.unit.as_ref().map(|text| read(text, &names, &values)).transpose();
        units.push(unit.map_err(at)?);
    }
    Ok(Some(units))
}

/// Units and values of the names of a formula, by their places; none: any unit.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stated<'a> {
    pub(crate) units: &'a [Option<Unit>],
    pub(crate) values: &'a [f64],
    /// Places of the names that change during a run; exponents of units must not depend on them.
    pub(crate) changing: &'a [usize],
}

impl Stated<'_> {
    /// Compares the unit of a formula with the one that it should have.
    ///
    /// # Errors
    /// The first operation of parts that do not fit together.
    pub(crate) fn check(&self, tree: &Tree, expected: Unit) -> Result<(), Fault> {
        match self.unit(tree)? {
            Some(unit) if !same(unit, expected) => Err(fault(
                tree.at,
                format!("a formula in {}", shown(unit)),
                &format!("one in {}", shown(expected)),
                "Correct the units of its numbers, or leave out those that the paper does not state.",
            )),
            _ => Ok(()),
        }
    }

    /// The same, where a unit is expected; else only the units of its parts are compared.
    ///
    /// # Errors
    /// The first operation of parts that do not fit together.
    pub(crate) fn check_if(&self, tree: &Tree, expected: Option<Unit>) -> Result<(), Fault> {
        match expected {
            Some(expected) => self.check(tree, expected),
            None => self.unit(tree).map(|_| ()),
        }
    }

    /// Compares the units within a condition.
    ///
    /// # Errors
    /// The first comparison of parts that do not fit together.
    pub(crate) fn check_condition(&self, condition: &Condition) -> Result<(), Fault> {
        match condition {
            Condition::Less(of) => self.alike(of[1].at, &of[..]).map(|_| ()),
            Condition::Flag(_) => Ok(()),
            Condition::Not(of) => self.check_condition(of),
            Condition::Both(of) | Condition::Either(of) => {
                of.iter().try_for_each(|of| self.check_condition(of))
            }
        }
    }

    fn unit(&self, tree: &Tree) -> Result<Option<Unit>, Fault> {
        match &tree.kind {
            Kind::Constant(_) => Ok(None),
            Kind::Name(place) => Ok(self.units[*place]),
            Kind::Negative(of) => self.unit(of),
            Kind::Binary(Operation::Plus | Operation::Minus, of) => self.alike(tree.at, &of[..]),
            Kind::Binary(Operation::Power, of) => self.power(tree.at, of),
            Kind::Binary(operation, of) => {
                let sign = if *operation == Operation::Over { -1.0 } else { 1.0 };
                let [a, b] = [self.unit(&of[0])?, self.unit(&of[1])?];
                Ok(a.zip(b).map(|(a, b)| combined(a, b, sign)))
            }
            Kind::Call(function, of) => self.call(tree.at, *function, of),
            Kind::If(condition, of) => {
                self.check_condition(condition)?;
                self.alike(tree.at, &of[..])
            }
        }
    }

    /// The unit of parts that are added or compared.
    fn alike(&self, at: Position, parts: &[Tree]) -> Result<Option<Unit>, Fault> {
        let mut found: Option<Unit> = None;
        for part in parts {
            let unit = self.unit(part)?;
            if let (Some(a), Some(b)) = (found, unit)
                && !same(a, b)
            {
                let both = format!("{} beside {}", shown(a), shown(b));
                let remedy = "Correct the unit of a number: parts that are added or compared have one unit.";
                return Err(fault(at, both, "parts of one unit", remedy));
            }
            found = found.or(unit);
        }
        Ok(found)
    }

    fn power(&self, at: Position, of: &[Tree; 2]) -> Result<Option<Unit>, Fault> {
        let [base, exponent] = [self.unit(&of[0])?, self.unit(&of[1])?];
        require_none(of[1].at, exponent, "an exponent")?;
        let Some(base) = base else { return Ok(None) };
        if same(base, NONE) {
            return Ok(Some(NONE));
        }
        if self.changing.iter().any(|&name| of[1].uses(name)) {
            let remedy = "Divide the base by a number of its unit.";
            return Err(fault(
                at,
                format!("a power of {} that changes", shown(base)),
                "a base without unit",
                remedy,
            ));
        }
        let exponent = of[1].value(self.values);
        Ok(Some(base.map(|part| part * exponent)))
    }

    fn call(&self, at: Position, function: Function, of: &[Tree]) -> Result<Option<Unit>, Fault> {
        let scaled = |exponent: f64| {
            let unit = self.unit(&of[0])?;
            Ok(unit.map(|unit| unit.map(|part| part * exponent)))
        };
        match function {
            Function::Abs => self.unit(&of[0]),
            Function::Min | Function::Max => self.alike(at, of),
            Function::Sqrt => scaled(0.5),
            Function::Cbrt => scaled(1.0 / 3.0),
            Function::Exp
            | Function::Log
            | Function::Log10
            | Function::Sin
            | Function::Cos
            | Function::Tanh => {
                let unit = self.unit(&of[0])?;
                require_none(at, unit, "an argument")?;
                Ok(Some(NONE))
            }
        }
    }
}

/// Refuses a unit where none may be.
fn require_none(at: Position, unit: Option<Unit>, what: &str) -> Result<(), Fault> {
    match unit {
        Some(unit) if !same(unit, NONE) => {
            let remedy = "Divide it by a number of the same unit.";
            Err(fault(at, format!("{what} in {}", shown(unit)), &format!("{what} without unit"), remedy))
        }
        _ => Ok(()),
    }
}
