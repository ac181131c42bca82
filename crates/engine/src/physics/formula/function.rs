//! A law of some names that change during a run, as text: its value, and its slope by the first name.
//!
//! What names a law has, where it is looked at before a run and what its values may be is a row of [`KINDS`]: conductivity by temperature, infiltration,
//! emission of the sky. Beyond the values of the first name at which it was looked at, a law stays what it is there, so that
//! Newton's method finds back from any iterate.

use std::collections::HashMap;

use super::graph::{Graph, Id, Level, Node};
use super::lexer::fault;
use super::parser::{self, Names};
use super::program::{Program, TooLong};
use super::tree::{Condition, Tree};
use super::units::{self, Unit};
use super::{Fault, FormulaFault, Position};
use crate::input::description::TextLaw;
use crate::input::values::Values;
use crate::number::real::{Mask, Real};

/// Differences below this are rounded off in `abs`, as in laws of convection [K].
const ROUND_OFF: f64 = 0.01;
const START: Position = Position { line: 1, column: 1 };

/// A name that changes during a run.
#[derive(Debug)]
pub(crate) struct Variable {
    pub(crate) name: &'static str,
    /// Its unit in words.
    pub(crate) words: &'static str,
    pub(crate) unit: Option<Unit>,
    /// Values at which laws are looked at, from the least to the largest; empty for the sum of the first name and another one.
    pub(crate) grid: &'static [f64],
}

/// What a law as text is a law of.
#[derive(Debug)]
pub(crate) struct Kind {
    pub(crate) name: &'static str,
    /// What it gives.
    pub(crate) meaning: &'static str,
    /// The unit of that in words, and the unit; none: any.
    pub(crate) words: &'static str,
    pub(crate) unit: Option<Unit>,
    pub(crate) variables: &'static [Variable],
    /// Place of the name that the first one is added to for the last name.
    pub(crate) sum: Option<usize>,
    /// Least and largest value.
    pub(crate) limits: [f64; 2],
    /// Whether the first name is a temperature difference, which a flow of heat rises with.
    pub(crate) difference: bool,
}

const TEMPERATURES: &[f64] = &[
    -40.0, -35.0, -30.0, -25.0, -20.0, -15.0, -10.0, -5.0, 0.0, 2.5, 5.0, 7.5, 10.0, 12.5, 15.0, 17.5, 20.0,
    22.5, 25.0, 27.5, 30.0, 32.5, 35.0, 40.0, 45.0, 50.0, 55.0, 60.0, 70.0, 80.0, 90.0, 100.0,
];
const DIFFERENCES: &[f64] = &[
    -60.0, -50.0, -40.0, -35.0, -30.0, -25.0, -20.0, -17.0, -14.0, -12.0, -10.0, -8.0, -6.0, -5.0, -4.0,
    -3.0, -2.0, -1.5, -1.0, -0.5, -0.2, -0.05, 0.0, 0.05, 0.2, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0,
    10.0, 12.0, 14.0, 17.0, 20.0, 25.0, 30.0, 35.0, 40.0, 50.0, 60.0,
];
const OUTDOORS: &[f64] = &[-30.0, -15.0, 0.0, 10.0, 20.0, 30.0, 45.0];
const COLD_TO_HOT: &[f64] = &[-60.0, -40.0, -20.0, -10.0, 0.0, 10.0, 20.0, 30.0, 40.0, 60.0];
const WINDS: &[f64] = &[0.0, 0.3, 1.0, 3.0, 6.0, 12.0, 20.0, 30.0];
const CLOUDS: &[f64] = &[0.0, 2.0, 5.0, 8.0, 10.0];
const VAPOUR: &[f64] = &[20.0, 200.0, 600.0, 1200.0, 2000.0, 3500.0];
const KELVIN: Option<Unit> = Some(units::KELVIN);

const SKY: &[Variable] = &[
    Variable { name: "To", words: "degC", unit: KELVIN, grid: COLD_TO_HOT },
    Variable { name: "Td", words: "degC", unit: KELVIN, grid: &[-45.0, -20.0, -5.0, 5.0, 15.0, 25.0, 30.0] },
    Variable { name: "pw", words: "Pa", unit: Some(units::PRESSURE), grid: VAPOUR },
    Variable { name: "cloud", words: "tenths", unit: None, grid: CLOUDS },
];

/// All kinds of such laws.
pub(crate) const KINDS: [Kind; 4] = [
    Kind {
        name: "conductivity",
        meaning: "a conductivity",
        words: "W/(m K)",
        unit: Some(units::CONDUCTIVITY),
        variables: &[Variable { name: "T", words: "degC", unit: KELVIN, grid: TEMPERATURES }],
        sum: None,
        limits: [1e-5, 1e4],
        difference: false,
    },
    Kind {
        name: "infiltration",
        meaning: "an air change",
        words: "1/h",
        unit: None,
        variables: &[
            Variable { name: "dT", words: "K", unit: KELVIN, grid: DIFFERENCES },
            Variable { name: "V", words: "m/s", unit: Some(units::SPEED), grid: WINDS },
            Variable { name: "To", words: "degC", unit: KELVIN, grid: OUTDOORS },
            Variable { name: "Ti", words: "degC", unit: KELVIN, grid: &[] },
        ],
        sum: Some(2),
        limits: [0.0, 1e3],
        difference: true,
    },
    Kind {
        name: "sky_emissivity",
        meaning: "an emissivity of the sky",
        words: "-",
        unit: Some(units::NONE),
        variables: SKY,
        sum: None,
        limits: [0.0, 1.5],
        difference: false,
    },
    Kind {
        name: "sky_temperature",
        meaning: "a temperature of the sky",
        words: "degC",
        unit: KELVIN,
        variables: SKY,
        sum: None,
        limits: [-150.0, 60.0],
        difference: false,
    },
];

impl Kind {
    /// A kind by its name.
    ///
    /// # Panics
    /// For a kind that is not in the table: a fault of the engine.
    pub(crate) fn named(name: &str) -> &'static Self {
        KINDS.iter().find(|kind| kind.name == name).expect("the kinds of laws are in one table")
    }
}

/// A law as text, compiled.
#[derive(Debug, Clone)]
pub(crate) struct FunctionText {
    pub(crate) tree: Tree,
    pub(crate) valid: Option<Condition>,
    run: Program,
    given: Vec<Given>,
    point: Program,
}

#[derive(Debug, Clone, Copy)]
enum Given {
    Constant(f64),
    Number(usize),
}

impl FunctionText {
    /// Reads a law; `numbers`: the names of its numbers.
    ///
    /// # Errors
    /// The first fault of its texts.
    pub(crate) fn new(
        kind: &Kind,
        formula: &str,
        valid: Option<&str>,
        numbers: &[&str],
    ) -> Result<Self, FormulaFault> {
        let variables: Vec<&str> = kind.variables.iter().map(|variable| variable.name).collect();
        let usable: Vec<&str> = variables.iter().chain(numbers).copied().collect();
        let at = |key: &str, fault: Fault| FormulaFault { key: key.to_owned(), fault };
        for name in numbers {
            if variables.contains(name) || parser::reserved(name) {
                let found = format!("the name '{name}' for a number");
                let fault = fault(START, found, "a name that has no other meaning", "Give it another name.");
                return Err(at(name, fault));
            }
        }
        let names = Names { usable: &usable, flags: &[], absent: &[] };
        let tree = parser::number(formula, names).map_err(|fault| at("formula", fault))?;
        let valid = valid.map(|text| parser::condition(text, names)).transpose();
        let valid = valid.map_err(|fault| at("valid", fault))?;
        for (place, name) in usable.iter().enumerate().skip(variables.len()) {
            if !tree.uses(place) && !valid.as_ref().is_some_and(|valid| valid.uses(place)) {
                let found = format!("the number '{name}', which the formula does not use");
                let remedy = format!("Use {name} in the formula, or remove it.");
                return Err(at(name, fault(START, found, "numbers of the formula", &remedy)));
            }
        }
        compile(kind, tree, valid, numbers.len()).map_err(|TooLong| {
            let found = "a formula that needs too many numbers at once";
            at("formula", fault(START, found, "fewer operations", "Simplify it."))
        })
    }

    /// Whether a name that changes is used.
    pub(crate) fn uses(&self, place: usize) -> bool {
        self.tree.uses(place) || self.valid.as_ref().is_some_and(|valid| valid.uses(place))
    }
}

fn compile(
    kind: &Kind,
    tree: Tree,
    valid: Option<Condition>,
    numbers: usize,
) -> Result<FunctionText, TooLong> {
    let mut graph = Graph::default();
    let mut place = 0..=u8::MAX;
    let mut next =
        |graph: &mut Graph, level, positive| graph.input(place.next().unwrap_or(u8::MAX), level, positive);
    let first = next(&mut graph, Level::Iteration, false);
    let square = next(&mut graph, Level::Iteration, true);
    if kind.difference {
        graph.round(first, square);
    }
    let others = kind.variables.len() - 1 - usize::from(kind.sum.is_some());
    let mut names = vec![first];
    names.extend((0..others).map(|_| next(&mut graph, Level::Stage, false)));
    let mut inputs = vec![first, square];
    inputs.extend(&names[1..]);
    if let Some(other) = kind.sum {
        names.push(graph.plus(names[other], first));
    }
    let begin = inputs.len();
    names.extend((0..numbers).map(|_| next(&mut graph, Level::Run, false)));
    let value = graph.tree(&tree, false, &mut |_: &mut Graph, name: usize, _: bool| names[name]);
    let (one, two) = (graph.constant(1.0), graph.constant(2.0));
    let doubled = graph.times(two, first);
    let slopes = HashMap::from([(first, one), (square, doubled)]);
    let slope = graph.derivative(value, &slopes, &mut HashMap::new());
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
        Node::Input(place) => Given::Number(usize::from(place) - begin),
        _ => Given::Constant(0.0),
    });
    Ok(FunctionText {
        given: given.collect(),
        run: Program::new(&graph, &known, &[], &leaves)?,
        point: Program::new(&graph, &parts, &inputs, &known)?,
        tree,
        valid,
    })
}

/// The largest parts that do not change during a run.
fn collect(graph: &Graph, parts: &[Id], found: &mut Vec<Id>) {
    for &part in parts {
        if graph.level(part) > Level::Run {
            collect(graph, &graph.operands(part), found);
        } else if !found.contains(&part) {
            found.push(part);
        }
    }
}

/// Values of all names at a point: the names that change, a sum of two of them, the numbers.
pub(crate) fn names(kind: &Kind, point: &[f64], given: &[f64]) -> Vec<f64> {
    let sum = kind.sum.map(|other| point[0] + point[other]);
    point.iter().copied().chain(sum).chain(given.iter().copied()).collect()
}

/// A law as text with its numbers.
#[derive(Debug, Clone)]
pub(crate) struct Function<S> {
    kind: &'static Kind,
    text: FunctionText,
    /// Its numbers as they are given.
    given: Box<[S]>,
    numbers: Box<[S]>,
    /// Values of the first name between which it is used as it is.
    ends: [f64; 2],
    limits: [f64; 2],
    others: usize,
}

impl<S: Real> Function<S> {
    /// Reads a law of a description.
    pub(crate) fn of(kind: &str, law: &TextLaw, values: &Values<'_, S>) -> Self {
        let names: Vec<&str> = law.numbers.iter().map(|number| number.name.as_str()).collect();
        let numbers: Vec<S> = law.numbers.iter().map(|number| values.get(number.value)).collect();
        Self::new(Kind::named(kind), (&law.formula, law.valid.as_deref()), &names, &numbers)
    }

    /// Reads a law whose text a plan has checked.
    ///
    /// # Panics
    /// For a text that cannot be read: a plan refuses it.
    pub(crate) fn new(
        kind: &'static Kind,
        (formula, valid): (&str, Option<&str>),
        names: &[&str],
        values: &[S],
    ) -> Self {
        let text = FunctionText::new(kind, formula, valid, names).expect("a plan reads its formulas");
        let known: Vec<S> = (text.given.iter())
            .map(|given| match *given {
                Given::Constant(value) => S::constant(value),
                Given::Number(place) => values[place],
            })
            .collect();
        let grid = kind.variables[0].grid;
        Self {
            kind,
            given: values.into(),
            numbers: text.run.compute_all(&known).into(),
            ends: [grid[0], grid[grid.len() - 1]],
            limits: kind.limits,
            others: kind.variables.len() - 1 - usize::from(kind.sum.is_some()),
            text,
        }
    }

    /// Whether its formula uses a name that changes.
    pub(crate) fn uses(&self, place: usize) -> bool {
        self.text.tree.uses(place)
    }

    /// Whether it says where it holds.
    pub(crate) fn limited(&self) -> bool {
        self.text.valid.is_some()
    }

    /// Name, unit in words and value of the names that its `valid` uses, where it does not hold in a lane at values of the names that change.
    pub(crate) fn beyond(
        &self,
        point: &[f64],
        lane: usize,
    ) -> Option<Vec<(&'static str, &'static str, f64)>> {
        let valid = self.text.valid.as_ref()?;
        let given: Vec<f64> = self.given.iter().map(|number| number.lane(lane)).collect();
        let names = names(self.kind, point, &given);
        if valid.holds(&names) {
            return None;
        }
        let variables = self.kind.variables.iter().enumerate();
        let used = variables.filter(|(place, _)| valid.uses(*place));
        Some(used.map(|(place, variable)| (variable.name, variable.words, names[place])).collect())
    }

    /// Value and slope by the first name; `others`: the names that are no sum, in their order.
    #[inline(always)]
    pub(crate) fn at(&self, first: S, others: &[S]) -> [S; 2] {
        let [low, high] = self.ends.map(S::constant);
        let beyond = first.lt(low) | high.lt(first);
        let x = first.max(low).min(high);
        let mut inputs = [S::zero(); 8];
        (inputs[0], inputs[1]) = (x, x * x + S::constant(ROUND_OFF * ROUND_OFF));
        inputs[2..2 + self.others].copy_from_slice(&others[..self.others]);
        let [value, slope] = self.text.point.compute(&inputs[..2 + self.others], |place| self.numbers[place]);
        let [least, most] = self.limits.map(S::constant);
        let limited = beyond | value.lt(least) | most.lt(value);
        let kept = if limited.any() { S::select(limited, S::zero(), slope) } else { slope };
        [value.max(least).min(most), kept]
    }
}
