//! A formula of quantities that change together: an output that is derived from others.

use super::graph::{Graph, Id, Level, Node};
use super::lexer::fault;
use super::parser::{self, Names};
use super::program::{Program, TooLong};
use super::tree::Tree;
use super::units::{self, Unit};
use super::{FormulaFault, LawNumber, Position};
use crate::input::description::TextLaw;
use crate::input::values::Values;
use crate::number::real::Real;
use std::collections::HashMap;

/// Quantities that a formula may use.
pub(crate) const MOST: usize = 24;
const START: Position = Position { line: 1, column: 1 };

/// A compiled formula.
#[derive(Debug, Clone)]
pub(crate) struct ExpressionText {
    tree: Tree,
    run: Program,
    given: Vec<Given>,
    program: Program,
}

#[derive(Debug, Clone, Copy)]
enum Given {
    Constant(f64),
    Number(usize),
}

impl ExpressionText {
    /// Reads a formula of quantities by their names, and of numbers.
    ///
    /// # Errors
    /// The first fault of the text.
    pub(crate) fn new(
        formula: &str,
        quantities: &[&str],
        numbers: &[&str],
        absent: &[(&str, &str)],
    ) -> Result<Self, FormulaFault> {
        let at = |key: &str| {
            let key = key.to_owned();
            move |fault| FormulaFault { key, fault }
        };
        for name in numbers {
            if parser::reserved(name) {
                let found = format!("the name '{name}' for a number");
                let expected = "a name that has no other meaning";
                return Err(at(name)(fault(START, found, expected, "Give it another name.")));
            }
        }
        let usable: Vec<&str> = quantities.iter().chain(numbers).copied().collect();
        let names = Names { usable: &usable, flags: &[], absent };
        let tree = parser::number(formula, names).map_err(at("formula"))?;
        for (place, name) in usable.iter().enumerate().skip(quantities.len()) {
            if !tree.uses(place) {
                let found = format!("the number '{name}', which the formula does not use");
                let remedy = format!("Use {name} in the formula, or remove it.");
                return Err(at(name)(fault(START, found, "numbers of the formula", &remedy)));
            }
        }
        let too_long = |TooLong| {
            let found = "a formula that needs too many numbers at once";
            let remedy = "Derive a part of it as an output of its own.";
            at("formula")(fault(START, found, "fewer operations", remedy))
        };
        if quantities.len() > MOST {
            return Err(too_long(TooLong));
        }
        compile(tree, quantities.len(), numbers.len()).map_err(too_long)
    }

    /// Whether a quantity, or a number behind them, is used.
    pub(crate) fn uses(&self, place: usize) -> bool {
        self.tree.uses(place)
    }
}

fn compile(tree: Tree, quantities: usize, numbers: usize) -> Result<ExpressionText, TooLong> {
    let mut graph = Graph::default();
    let count = u8::try_from(quantities + numbers).map_err(|_| TooLong)?;
    let level = |place: u8| if usize::from(place) < quantities { Level::Iteration } else { Level::Run };
    let inputs: Vec<Id> = (0..count).map(|place| graph.input(place, level(place), false)).collect();
    let value = graph.tree(&tree, false, &mut |_: &mut Graph, name: usize, _: bool| inputs[name]);
    let value = graph.lowered(value, &mut HashMap::new());
    let mut known = Vec::new();
    collect(&graph, value, &mut known);
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
        Node::Input(place) => Given::Number(usize::from(place) - quantities),
        _ => Given::Constant(0.0),
    });
    Ok(ExpressionText {
        given: given.collect(),
        run: Program::new(&graph, &known, &[], &leaves)?,
        program: Program::new(&graph, &[value], &inputs[..quantities], &known)?,
        tree,
    })
}

/// The largest parts that do not change during a run.
fn collect(graph: &Graph, part: Id, found: &mut Vec<Id>) {
    if graph.level(part) <= Level::Run {
        if !found.contains(&part) {
            found.push(part);
        }
    } else {
        graph.operands(part).into_iter().for_each(|operand| collect(graph, operand, found));
    }
}

/// A formula with its numbers.
#[derive(Debug, Clone)]
pub(crate) struct Expression<S> {
    text: ExpressionText,
    numbers: Box<[S]>,
}

impl<S: Real> Expression<S> {
    /// Reads a formula of a description, whose text a plan has checked.
    ///
    /// # Panics
    /// For a text that cannot be read: a plan refuses it.
    pub(crate) fn of(law: &TextLaw, quantities: &[&str], values: &Values<'_, S>) -> Self {
        let names: Vec<&str> = law.numbers.iter().map(|number| number.name.as_str()).collect();
        let text = ExpressionText::new(&law.formula, quantities, &names, &[]);
        let text = text.expect("a plan reads its formulas");
        let known: Vec<S> = (text.given.iter())
            .map(|given| match *given {
                Given::Constant(value) => S::constant(value),
                Given::Number(place) => values.get(law.numbers[place].value),
            })
            .collect();
        Self { numbers: text.run.compute_all(&known).into(), text }
    }

    /// Its value from those of the quantities.
    // One copy only: it is used once per record.
    #[inline(never)]
    pub(crate) fn value(&self, quantities: &[S]) -> S {
        let [value] = self.text.program.compute(quantities, |place| self.numbers[place]);
        value
    }
}

/// A derived output as text.
#[derive(Debug, Clone, PartialEq)]
pub struct DerivedText<'a> {
    /// The formula.
    pub formula: &'a str,
    /// Names of outputs that it may use, and their units.
    pub outputs: &'a [(String, String)],
    /// Its numbers.
    pub numbers: &'a [LawNumber],
    /// Its unit; none: not stated.
    pub unit: Option<&'a str>,
    /// Names that are no outputs, and what to do.
    pub absent: &'a [(String, String)],
}

impl DerivedText<'_> {
    /// Reads it and compares its units.
    ///
    /// # Errors
    /// The first fault of its text.
    pub fn check(&self) -> Result<(), FormulaFault> {
        let outputs: Vec<&str> = self.outputs.iter().map(|(name, _)| name.as_str()).collect();
        let numbers: Vec<&str> = self.numbers.iter().map(|number| number.name.as_str()).collect();
        let absent: Vec<(&str, &str)> =
            self.absent.iter().map(|(name, why)| (name.as_str(), why.as_str())).collect();
        let text = ExpressionText::new(self.formula, &outputs, &numbers, &absent)?;
        if !(0..outputs.len()).any(|place| text.uses(place)) {
            let remedy = "Name an output of the building, such as room.air_temperature.";
            let fault = fault(START, "a formula of no output", "one that depends on an output", remedy);
            return Err(FormulaFault { key: "formula".into(), fault });
        }
        // Units of outputs that are no products of the known ones, such as 1/h, are not compared.
        let known = |(_, unit): &(String, String)| units::known(unit);
        let variables: Vec<Option<Unit>> = self.outputs.iter().map(known).collect();
        let stated_units = units::of_any_numbers(&variables, self.numbers)?;
        let mut values = vec![0.0; outputs.len()];
        values.extend(self.numbers.iter().map(|number| number.value));
        let changing: Vec<usize> = (0..outputs.len()).collect();
        let stated = units::Stated { units: &stated_units, values: &values, changing: &changing };
        let expected = match self.unit {
            Some(unit) => units::known(unit),
            None => None,
        };
        let at = |fault| FormulaFault { key: "formula".into(), fault };
        stated.check_if(&text.tree, expected).map_err(at)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(formula: &str, unit: Option<&str>, numbers: &[LawNumber]) -> Result<(), String> {
        let outputs = [("room.air", "degC"), ("roof.flux", "W/m2"), ("roof.convection", "W/(m2 K)")];
        let outputs = outputs.map(|(name, unit)| (name.to_owned(), unit.to_owned()));
        let absent = [("room.ait".to_owned(), "Did you mean room.air?".to_owned())];
        let text = DerivedText { formula, outputs: &outputs, numbers, unit, absent: &absent };
        text.check().map_err(|fault| format!("{} {}", fault.key, fault.fault))
    }

    #[test]
    fn derived_outputs_are_read_and_their_units_compared() {
        assert_eq!(check("roof.flux/roof.convection + 2*room.air", Some("K"), &[]), Ok(()));
        let area = [LawNumber { name: "a".into(), value: 2.0, range: None, unit: Some("m2".into()) }];
        assert_eq!(check("a*roof.flux", Some("W"), &area), Ok(()));
        for (formula, unit, words) in [
            ("roof.flux + room.air", None, "formula column 11: found W/m2 beside K"),
            ("roof.flux", Some("degC"), "a formula in W/m2"),
            ("roof.flux*(", None, "formula column 12"),
            ("room.ait*2", None, "Did you mean room.air?"),
            ("2 + 3", None, "formula of no output"),
        ] {
            let fault = check(formula, unit, &[]).unwrap_err();
            assert!(fault.contains(words), "{formula}: {fault}");
        }
        assert!(check("roof.flux", None, &area).unwrap_err().contains("does not use"));
    }
}
