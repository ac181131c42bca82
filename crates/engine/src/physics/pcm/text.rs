//! A curve of the liquid fraction that is written as text.
//!
//! The formula has the temperature `T` and the melting temperature `Tm` [degC] beside its numbers, and melts within a range about `Tm`. What
//! is missing to 0 and 1 at its ends is shared out: the curve is `(f(T) - f(low))/(f(high) - f(low))` between them, 0 below and 1
//! above. Its slope is the derivative of the formula.
//!
//! For the nested iteration the curve is split into two convex parts (Brugnano & Casulli 2009) as `f + K/2 (T - low)^2` and `K/2 (T -
//! low)^2`, with a K above the largest fall of the slope, found at many temperatures.

use std::collections::HashMap;

use crate::number::real::Real;
use crate::physics::formula::graph::{Graph, Id, Level, Node};
use crate::physics::formula::lexer::fault;
use crate::physics::formula::parser::{self, Names};
use crate::physics::formula::program::{Program, TooLong};
use crate::physics::formula::tree::Tree;
use crate::physics::formula::units;
use crate::physics::formula::{Fault, FormulaFault, LawNumber, Position};

/// Names of a curve before those of its numbers.
const VARIABLES: [&str; 2] = ["T", "Tm"];
/// Temperatures at which the slope of a curve is looked at.
const POINTS: u32 = 100;
/// More than the largest fall of the slope between them.
const MARGIN: f64 = 2.0;
/// What may be missing to 0 and 1 at the ends of the range [-].
const MISSING: f64 = 0.02;
const START: Position = Position { line: 1, column: 1 };

/// A curve of the liquid fraction as text.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct FractionText {
    tree: Tree,
    run: Program,
    /// What the first program needs: a constant, or a name by its place after `T`.
    given: Vec<Given>,
    /// Fraction and slope from the temperature.
    curve: Program,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Given {
    Constant(f64),
    Number(usize),
}

impl FractionText {
    /// Reads a curve; `numbers`: the names of its numbers.
    ///
    /// # Errors
    /// The first fault of the text.
    pub(crate) fn new(formula: &str, numbers: &[&str]) -> Result<Self, FormulaFault> {
        let usable: Vec<&str> = VARIABLES.iter().chain(numbers).copied().collect();
        let at = |key: &str, fault: Fault| FormulaFault { key: key.to_owned(), fault };
        for name in numbers {
            if VARIABLES.contains(name) || parser::reserved(name) {
                let found = format!("the name '{name}' for a number");
                let fault = fault(START, found, "a name that has no other meaning", "Give it another name.");
                return Err(at(name, fault));
            }
        }
        let names = Names { usable: &usable, flags: &[], absent: &[] };
        let tree = parser::number(formula, names).map_err(|fault| at("formula", fault))?;
        for (place, name) in usable.iter().enumerate() {
            if !tree.uses(place) {
                let found = format!("a formula without {name}");
                let fault =
                    fault(START, found, "one that depends on it", &format!("Use {name} in the formula."));
                return Err(at(if place < VARIABLES.len() { "formula" } else { name }, fault));
            }
        }
        compile(tree, usable.len() - 1).map_err(|TooLong| {
            at(
                "formula",
                fault(
                    START,
                    "a formula that needs too many numbers at once",
                    "fewer operations",
                    "Simplify it.",
                ),
            )
        })
    }

    /// Looks at the curve between two distances from the melting temperature [K]: `numbers` are that and the numbers.
    ///
    /// # Errors
    /// The first temperature at which it is no curve of a liquid fraction.
    pub(crate) fn check(&self, [low, high]: [f64; 2], numbers: &[f64]) -> Result<(), FormulaFault> {
        let refuse = |found: String, expected: &str, at: Position| {
            let remedy = "Correct the formula, or the range in which it melts.";
            Err(FormulaFault { key: "formula".into(), fault: fault(at, found, expected, remedy) })
        };
        let mut names: Vec<f64> = core::iter::once(0.0).chain(numbers.iter().copied()).collect();
        let mut before = f64::NEG_INFINITY;
        for k in 0..=4 * POINTS {
            let part = f64::from(k) / f64::from(4 * POINTS);
            names[0] = numbers[0] + low + (high - low) * part;
            let value = self.tree.value(&names);
            let place = format!("at {:.3} degC", names[0]);
            if !value.is_finite() {
                let at = self.tree.unbounded(&names).unwrap_or(self.tree.at);
                return refuse(format!("{value} {place}"), "a finite liquid fraction", at);
            }
            if value < before - 1e-12 {
                let found = format!("a liquid fraction that falls from {before:.6} to {value:.6} {place}");
                return refuse(found, "one that rises with T", START);
            }
            let missing = if k == 0 { Some(value) } else { (k == 4 * POINTS).then_some(value - 1.0) };
            if let Some(missing) = missing
                && missing.abs() > MISSING
            {
                let found = format!("a liquid fraction of {value:.4} {place}, an end of the range");
                let expected = if k == 0 { "0 there, within 0.02" } else { "1 there, within 0.02" };
                return refuse(found, expected, START);
            }
            before = value;
        }
        Ok(())
    }
}

fn compile(tree: Tree, numbers: usize) -> Result<FractionText, TooLong> {
    let mut graph = Graph::default();
    let temperature = graph.input(0, Level::Iteration, false);
    let inputs: Vec<Id> = (0..numbers)
        .map(|k| graph.input(u8::try_from(k + 1).unwrap_or(u8::MAX), Level::Run, false))
        .collect();
    let mut leaf =
        |_: &mut Graph, name: usize, _: bool| if name == 0 { temperature } else { inputs[name - 1] };
    let value = graph.tree(&tree, false, &mut leaf);
    let one = graph.constant(1.0);
    let slope = graph.derivative(value, &HashMap::from([(temperature, one)]), &mut HashMap::new());
    let mut lowered = HashMap::new();
    let parts = [value, slope].map(|part| graph.lowered(part, &mut lowered));
    let mut known = Vec::new();
    collect(&graph, &parts, &mut known);
    let mut leaves = Vec::new();
    let mut pending = known.clone();
    while let Some(part) = pending.pop() {
        if matches!(graph.node(part), Node::Constant(_) | Node::Input(_)) && !leaves.contains(&part) {
            leaves.push(part);
        }
        pending.extend(graph.operands(part));
    }
    let given = leaves.iter().map(|&part| match graph.node(part) {
        Node::Constant(bits) => Given::Constant(f64::from_bits(bits)),
        Node::Input(place) => Given::Number(usize::from(place) - 1),
        _ => Given::Constant(0.0),
    });
    Ok(FractionText {
        given: given.collect(),
        run: Program::new(&graph, &known, &[], &leaves)?,
        curve: Program::new(&graph, &parts, &[temperature], &known)?,
        tree,
    })
}

/// The largest parts that do not depend on the temperature.
fn collect(graph: &Graph, parts: &[Id], found: &mut Vec<Id>) {
    for &part in parts {
        if graph.level(part) > Level::Run {
            collect(graph, &graph.operands(part), found);
        } else if !found.contains(&part) {
            found.push(part);
        }
    }
}

/// A curve as text with values of its numbers.
#[derive(Debug, Clone, PartialEq)]
pub struct CurveText<'a> {
    /// The liquid fraction.
    pub formula: &'a str,
    /// Its numbers; their ranges are not used.
    pub numbers: &'a [LawNumber],
    /// Melting temperature [degC].
    pub melting_temperature: f64,
    /// Where it melts, about the melting temperature [K].
    pub range: [f64; 2],
}

impl CurveText<'_> {
    /// Reads the curve and looks at its values.
    ///
    /// # Errors
    /// The first fault of the text, or the first temperature at which it is no curve of a liquid fraction.
    pub fn check(&self) -> Result<(), FormulaFault> {
        let (text, given) = (self.read()?, self.given());
        self.check_units(&text, &given)?;
        text.check(self.range, &given)
    }

    /// Liquid fractions at temperatures [degC], as in a run.
    ///
    /// # Errors
    /// The first fault of the text.
    pub fn fractions(&self, temperatures: &[f64]) -> Result<Vec<f64>, FormulaFault> {
        let curve = Text::new(self.read()?, &self.given(), self.range);
        Ok(temperatures.iter().map(|&temperature| curve.at(temperature)[0]).collect())
    }

    fn read(&self) -> Result<FractionText, FormulaFault> {
        let names: Vec<&str> = self.numbers.iter().map(|number| number.name.as_str()).collect();
        FractionText::new(self.formula, &names)
    }

    fn check_units(&self, text: &FractionText, given: &[f64]) -> Result<(), FormulaFault> {
        let values: Vec<f64> = core::iter::once(given[0]).chain(given.iter().copied()).collect();
        let variables = [Some(units::KELVIN); VARIABLES.len()];
        let units = units::of_numbers(&variables, self.numbers)?;
        let Some(units) = units else { return Ok(()) };
        let stated = units::Stated { units: &units, values: &values, changing: &[0] };
        let at = |fault| FormulaFault { key: "formula".into(), fault };
        stated.check(&text.tree, units::NONE).map_err(at)
    }

    fn given(&self) -> Vec<f64> {
        let numbers = self.numbers.iter().map(|number| number.value);
        core::iter::once(self.melting_temperature).chain(numbers).collect()
    }
}

/// A curve with its numbers.
#[derive(Debug, Clone)]
pub(super) struct Text<S> {
    law: FractionText,
    numbers: Box<[S]>,
    /// Temperatures between which it melts [degC].
    ends: [S; 2],
    /// Fraction as written at the lower end, and what the rest is multiplied by [-].
    start: S,
    gain: S,
    /// Temperature of the largest slope [degC].
    pub(super) steepest: S,
    /// Half of the reciprocal of that slope: the half-width of a straight line with it [K].
    pub(super) width: S,
    /// More than the largest fall of the slope over temperature [1/K2].
    bend: S,
}

impl<S: Real> Text<S> {
    /// `given`: melting temperature and numbers; `range`: about the melting temperature [K].
    pub(super) fn new(text: FractionText, given: &[S], range: [f64; 2]) -> Self {
        let known = text.given.iter().map(|number| match *number {
            Given::Constant(value) => S::constant(value),
            Given::Number(place) => given[place],
        });
        let known: Vec<S> = known.collect();
        let numbers = text.run.compute_all(&known).into();
        let ends = range.map(|distance| given[0] + S::constant(distance));
        let (zero, one) = (S::zero(), S::one());
        let mut curve = Self {
            law: text,
            numbers,
            ends,
            start: zero,
            gain: one,
            steepest: ends[0],
            width: one,
            bend: zero,
        };
        let [low, high] = ends.map(|end| curve.raw(end)[0]);
        (curve.start, curve.gain) = (low, one / (high - low));
        curve.survey(range);
        curve
    }

    /// Finds the largest slope and the largest fall of the slope; both are no numbers with derivatives.
    fn survey(&mut self, [low, high]: [f64; 2]) {
        let step = (high - low) / f64::from(POINTS);
        let (mut most, mut fall) = (S::zero(), S::zero());
        let mut before: Option<S> = None;
        for k in 0..=POINTS {
            let place = (self.ends[0] + S::constant(step * f64::from(k))).fixed();
            let slope = (self.raw(place)[1] * self.gain).fixed();
            if let Some(before) = before {
                fall = fall.max((before - slope).scale(MARGIN / step));
            }
            before = Some(slope);
            self.steepest = S::select(most.lt(slope), place, self.steepest);
            most = most.max(slope);
        }
        self.width = S::constant(0.5) / most.max(S::constant(1e-6));
        self.bend = fall;
    }

    /// The formula and its derivative.
    #[inline(always)]
    fn raw(&self, temperature: S) -> [S; 2] {
        self.law.curve.compute(
            &[temperature],
            #[inline(always)]
            |place| self.numbers[place],
        )
    }

    /// Fraction and slope at a temperature.
    // One copy only: inlining multiplies compile time.
    #[inline(never)]
    pub(super) fn at(&self, temperature: S) -> [S; 2] {
        S::vectorised(
            #[inline(always)]
            || {
                let [low, high] = self.ends;
                let [value, slope] = self.raw(temperature.max(low).min(high));
                let inside = !temperature.lt(low) & !high.lt(temperature);
                let slope = S::select(inside, slope * self.gain, S::zero());
                [((value - self.start) * self.gain).max(S::zero()).min(S::one()), slope]
            },
        )
    }

    /// The convex part between two temperatures, and its slope; beyond the second its tangent there.
    pub(super) fn convex(&self, temperature: S, [from, to]: [S; 2]) -> (S, S) {
        let [low, high] = self.ends;
        let place = temperature.max(from).min(to);
        let [fraction, slope] = self.at(place.min(high));
        let inside = (place.min(high) - low).max(S::zero());
        let value = fraction + (self.bend * inside * inside).scale(0.5);
        let slope = slope + self.bend * inside;
        (value + slope * (temperature - place.min(high)), slope)
    }

    /// Temperatures between which it melts [degC].
    pub(super) fn ends(&self) -> [S; 2] {
        self.ends
    }
}

#[cfg(test)]
#[allow(clippy::disallowed_methods, reason = "compared with the functions of the standard library")]
mod tests {
    use super::*;
    use crate::number::dual::Dual;

    const TANH: &str = "0.5 + 0.5*tanh((T - Tm)/w)";

    fn text<S: Real>(formula: &str, given: &[S], range: [f64; 2]) -> Text<S> {
        Text::new(FractionText::new(formula, &["w"]).unwrap(), given, range)
    }

    /// `(1 + tanh u)/2` and its slope, which is 0.1 % of the whole short at the ends of 3.4 widths.
    #[test]
    fn a_curve_by_hand() {
        let curve = text(TANH, &[23.0, 2.0], [-20.0, 20.0]);
        for temperature in [10.0, 20.0, 22.5, 23.0, 24.0, 29.0] {
            let tanh = ((temperature - 23.0) / 2.0_f64).tanh();
            let [fraction, slope] = curve.at(temperature);
            assert!((fraction - (0.5 + 0.5 * tanh)).abs() < 1e-8, "{temperature}");
            assert!((slope - 0.25 * (1.0 - tanh * tanh)).abs() < 1e-8, "{temperature}");
        }
        assert_eq!(curve.at(0.0), [0.0, 0.0]);
        assert_eq!(curve.at(50.0), [1.0, 0.0]);
        assert!((curve.steepest - 23.0).abs() < 0.3 && (curve.width - 2.0).abs() < 0.1);
    }

    /// By temperature, melting temperature and width, against differences.
    #[test]
    fn derivatives() {
        let at = |numbers: [f64; 3]| text(TANH, &numbers[1..], [-9.0, 9.0]).at(numbers[0]);
        for temperature in [16.0, 22.0, 24.0] {
            let numbers = [temperature, 23.0, 2.0];
            let dual: Vec<Dual<3>> = (0..3).map(|k| Dual::variable(numbers[k], k)).collect();
            let found = text(TANH, &dual[1..], [-9.0, 9.0]).at(dual[0]);
            for which in 0..3 {
                let moved = |step: f64| {
                    let mut numbers = numbers;
                    numbers[which] += step;
                    at(numbers)
                };
                let [after, before] = [moved(1e-5), moved(-1e-5)];
                for k in 0..2 {
                    let quotient = (after[k] - before[k]) / 2e-5;
                    assert!((found[k].slope[which] - quotient).abs() < 1e-8, "{temperature}: {which}, {k}");
                }
            }
        }
    }

    /// Both parts of the split are convex: their slopes never fall.
    #[test]
    fn the_split_is_convex() {
        let curve = text("1/(1 + exp(-(T - Tm)/w))", &[23.0, 0.8], [-6.0, 9.0]);
        let mut before = [f64::NEG_INFINITY; 2];
        for k in 0..4000 {
            let temperature = 10.0 + 0.006 * f64::from(k);
            let (value, slope) = curve.convex(temperature, [0.0, 60.0]);
            let [fraction, rate] = curve.at(temperature);
            let rest = slope - rate;
            assert!(slope >= before[0] - 1e-12 && rest >= before[1] - 1e-12, "{temperature}");
            assert!(value >= fraction - 1e-12);
            before = [slope, rest];
        }
    }

    #[test]
    fn curves_that_are_none_are_refused() {
        let check = |formula: &str, range| {
            let text = FractionText::new(formula, &["w"]).map_err(|found| found.fault.to_string())?;
            text.check(range, &[23.0, 2.0]).map_err(|found| found.fault.to_string())
        };
        assert_eq!(check(TANH, [-8.0, 8.0]), Ok(()));
        for (formula, range, words) in [
            (TANH, [-1.0, 8.0], "an end of the range"),
            ("0.5 - 0.5*tanh((T - Tm)/w)", [-8.0, 8.0], "an end of the range"),
            ("0.5 + 0.5*tanh((T - Tm)/w) + 0.6*exp(-(T - Tm)^2/w)", [-8.0, 8.0], "falls from"),
            ("0.5 + w/(T - Tm)", [-8.0, 8.0], "found"),
            ("sqrt(T - Tm)*w", [-8.0, 8.0], "column 1: found NaN"),
            ("w*T", [-8.0, 8.0], "without Tm"),
            ("T*Tm", [-8.0, 8.0], "without w"),
            ("T*Tm*w)", [-8.0, 8.0], "Remove this bracket"),
        ] {
            let fault = check(formula, range).unwrap_err();
            assert!(fault.contains(words), "{formula}: {fault}");
        }
    }
}
