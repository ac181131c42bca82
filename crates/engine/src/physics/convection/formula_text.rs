//! A coefficient that is written as text: its names, and the programs that compute it.
//!
//! | name | meaning | computed |
//! |---|---|---|
//! | `dT` | `T_surface - T_air` [K] | in every iteration |
//! | `V` | wind at the surface [m/s] | once per stage |
//! | `windward` | holds where the wind blows onto the surface | once per stage |
//! | `tilt` | angle between upwards and the normal into the air [deg] | once per run |
//! | `upward` | upward component of that normal, the cosine of `tilt` [-] | once per run |
//! | `area` | of the surface [m2] | once per run |
//! | `density` | of the air [kg/m3] | once per run |
//!
//! Numbers of the law have their own names. `abs(dT)` is `(dT^2 + r^2)^1/2` with the small r of [`natural`](super::natural), as in all
//! laws: its powers and their derivatives are finite at zero. In powers and roots `V` is at least 1 mm/s at the mast, likewise.

use std::collections::HashMap;

use super::wind::CALM;
use crate::physics::formula::graph::{Graph, Id, Level, Node};
use crate::physics::formula::lexer::fault;
use crate::physics::formula::parser::{self, Names};
use crate::physics::formula::program::{Program, TooLong};
use crate::physics::formula::tree::{Condition, Tree};
use crate::physics::formula::{FormulaFault, Position};

/// Names that the side of a surface gives, by their places in [`Tree`].
pub(crate) const VARIABLES: [&str; 7] = ["dT", "V", "windward", "tilt", "upward", "area", "density"];
/// Places of the first three.
pub(crate) const DIFFERENCE: usize = 0;
pub(crate) const WIND: usize = 1;
pub(crate) const WINDWARD: usize = 2;

const NO_WIND: &str =
    "No wind reaches this side: it does not face outdoors, or its exposure leaves the wind out.";
const DIFFERENCE_ONLY: &str =
    "A coefficient may depend on the difference of the two temperatures, not on each: write dT.";
const ANY_DIRECTION: &str = "Say where the law holds by dT and V, for winds of any direction.";
const NOT_HERE: &str = "A coefficient cannot depend on it: give a number of its own beside the formula.";

/// Names that papers use and that no side gives.
const ABSENT: [(&str, &str); 8] = [
    ("Ts", DIFFERENCE_ONLY),
    ("Ta", DIFFERENCE_ONLY),
    ("wind_angle", "Write windward, which holds where the wind blows onto the surface."),
    ("sun", NOT_HERE),
    ("air_change", NOT_HERE),
    ("T", DIFFERENCE_ONLY),
    ("dt", "Write dT."),
    ("v", "Write V for the wind at the surface."),
];

/// A coefficient written as text.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct FormulaText {
    /// As written; names by their places: [`VARIABLES`], then the numbers.
    pub(crate) tree: Tree,
    pub(crate) valid: Option<Condition>,
    /// Whether it depends on the temperature difference, and on the wind.
    pub(crate) buoyant: bool,
    pub(crate) windy: bool,
    /// From what a run has, the numbers that the other programs need.
    pub(crate) run: Program,
    pub(crate) run_numbers: Vec<Number>,
    /// From the wind, what [`Forced`](super::wind::Forced) holds.
    pub(crate) stage: Program,
    /// The coefficient and its derivative, from `d`, `d^2 + r^2` and [`Forced`](super::wind::Forced).
    pub(crate) iteration: Program,
    /// One where the law is valid, else zero, from `d`, `d^2 + r^2`, the wind at the mast and whether it blows onto the surface.
    pub(crate) validity: Option<Program>,
}

/// A number that a run has.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Number {
    Constant(f64),
    WindFactor,
    Tilt,
    Upward,
    Area,
    Density,
    /// By its place among the numbers of the law.
    Given(usize),
}

impl FormulaText {
    /// Reads a law; `numbers`: the names of its numbers; `wind`: whether wind reaches the side.
    ///
    /// # Errors
    /// The first fault of its texts.
    pub(crate) fn new(
        formula: &str,
        valid: Option<&str>,
        numbers: &[&str],
        wind: bool,
    ) -> Result<Self, FormulaFault> {
        let usable: Vec<&str> = VARIABLES.iter().chain(numbers).copied().collect();
        let absent: Vec<(&str, &str)> = if wind {
            ABSENT.to_vec()
        } else {
            [("V", NO_WIND), ("windward", NO_WIND)].into_iter().chain(ABSENT).collect()
        };
        // Places stay the same where there is no wind.
        let usable: Vec<&str> = usable
            .into_iter()
            .map(|name| if !wind && ["V", "windward"].contains(&name) { "" } else { name })
            .collect();
        check_names(numbers)?;
        let names = Names { usable: &usable, flags: &["windward"], absent: &absent };
        let at = |key: &str| {
            let key = key.to_owned();
            move |fault| FormulaFault { key, fault }
        };
        let tree = parser::number(formula, names).map_err(at("formula"))?;
        let usable: Vec<&str> =
            usable.iter().map(|name| if *name == VARIABLES[WINDWARD] { "" } else { *name }).collect();
        let absent: Vec<(&str, &str)> =
            [("windward", ANY_DIRECTION)].into_iter().chain(absent.clone()).collect();
        let names = Names { usable: &usable, flags: &[], absent: &absent };
        let valid = valid.map(|text| parser::condition(text, names)).transpose().map_err(at("valid"))?;
        for (place, name) in numbers.iter().enumerate() {
            let place = VARIABLES.len() + place;
            if !tree.uses(place) && !valid.as_ref().is_some_and(|valid| valid.uses(place)) {
                let found = format!("the number '{name}', which the formula does not use");
                let remedy = format!("Use {name} in the formula, or remove it.");
                return Err(at(name)(fault(START, found, "numbers of the formula", &remedy)));
            }
        }
        Compiler::new(numbers.len()).compile(tree, valid).map_err(|TooLong| {
            let expected = "fewer operations";
            at("formula")(fault(
                START,
                "a formula that needs too many numbers at once",
                expected,
                "Simplify it.",
            ))
        })
    }

    /// Whether a name of [`VARIABLES`] is used by the formula or its validity.
    pub(crate) fn uses(&self, variable: usize) -> bool {
        self.tree.uses(variable) || self.valid.as_ref().is_some_and(|valid| valid.uses(variable))
    }
}

const START: Position = Position { line: 1, column: 1 };

fn check_names(numbers: &[&str]) -> Result<(), FormulaFault> {
    for name in numbers {
        let known = VARIABLES.contains(name) || parser::reserved(name);
        let starts = name.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_');
        let letters = name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
        if known || !starts || !letters {
            let found = format!("the name '{name}' for a number");
            let expected = if known { "a name that has no other meaning" } else { "letters, digits and _" };
            let fault = fault(START, found, expected, "Give the number another name.");
            return Err(FormulaFault { key: (*name).to_owned(), fault });
        }
    }
    Ok(())
}

/// Inputs of the graph.
#[derive(Debug)]
struct Compiler {
    graph: Graph,
    difference: Id,
    rounded: Id,
    speed: Id,
    windward: Id,
    inputs: Vec<(Id, Number)>,
    /// The wind at the surface, as it is and as the base of powers.
    wind: [Id; 2],
}

impl Compiler {
    fn new(numbers: usize) -> Self {
        let mut graph = Graph::default();
        let mut place = 0..=u8::MAX;
        let mut input = |graph: &mut Graph, level, positive| {
            graph.input(place.next().unwrap_or(u8::MAX), level, positive)
        };
        let difference = input(&mut graph, Level::Iteration, false);
        let rounded = input(&mut graph, Level::Iteration, true);
        graph.round(difference, rounded);
        let speed = input(&mut graph, Level::Stage, false);
        let windward = input(&mut graph, Level::Stage, false);
        let mut inputs = vec![
            (input(&mut graph, Level::Run, true), Number::WindFactor),
            (input(&mut graph, Level::Run, false), Number::Tilt),
            (input(&mut graph, Level::Run, false), Number::Upward),
            (input(&mut graph, Level::Run, true), Number::Area),
            (input(&mut graph, Level::Run, true), Number::Density),
        ];
        for given in 0..numbers {
            inputs.push((input(&mut graph, Level::Run, false), Number::Given(given)));
        }
        let calm = graph.constant(CALM);
        let moving = graph.max(speed, calm);
        let wind = [speed, moving].map(|speed| graph.times(inputs[0].0, speed));
        Self { graph, difference, rounded, speed, windward, inputs, wind }
    }

    /// The part that a name stands for; `base`: in the base of a power.
    fn leaf(&self) -> impl FnMut(&mut Graph, usize, bool) -> Id + use<> {
        let inputs: Vec<Id> = self.inputs.iter().map(|(id, _)| *id).collect();
        let (difference, windward, wind) = (self.difference, self.windward, self.wind);
        move |_, name, base| match name {
            DIFFERENCE => difference,
            WIND => wind[usize::from(base)],
            WINDWARD => windward,
            // tilt, upward, area and density come after the wind factor, then the numbers.
            other => inputs[other - WINDWARD],
        }
    }

    fn compile(mut self, tree: Tree, valid: Option<Condition>) -> Result<FormulaText, TooLong> {
        let mut leaf = self.leaf();
        let graph = &mut self.graph;
        let value = graph.tree(&tree, false, &mut leaf);
        let (one, zero, two) = (graph.constant(1.0), graph.constant(0.0), graph.constant(2.0));
        let doubled = graph.times(two, self.difference);
        let slopes = HashMap::from([(self.difference, one), (self.rounded, doubled)]);
        let slope = graph.derivative(value, &slopes, &mut HashMap::new());
        let holds = valid.as_ref().map(|valid| graph.condition(valid, one, zero, &mut leaf));
        let mut lowered = HashMap::new();
        let [value, slope] = [value, slope].map(|part| graph.lowered(part, &mut lowered));
        let holds = holds.map(|part| graph.lowered(part, &mut lowered));
        let buoyant = graph.level(value) == Level::Iteration;
        let slots = if buoyant { self.slots(&[value, slope]) } else { vec![value] };
        let windy = slots.iter().any(|slot| self.graph.level(*slot) == Level::Stage);
        self.programs(tree, valid, ([value, slope], slots, holds), (buoyant, windy))
    }

    fn programs(
        self,
        tree: Tree,
        valid: Option<Condition>,
        ([value, slope], slots, holds): ([Id; 2], Vec<Id>, Option<Id>),
        (buoyant, windy): (bool, bool),
    ) -> Result<FormulaText, TooLong> {
        let graph = &self.graph;
        let mut numbers = Vec::new();
        let iteration_parts = if buoyant { vec![value, slope] } else { Vec::new() };
        let iteration_inputs: Vec<Id> =
            [self.difference, self.rounded].into_iter().chain(slots.clone()).collect();
        let stage_inputs = [self.speed, self.windward];
        // One slot fills both places.
        let stage_parts: Vec<Id> =
            slots.iter().chain(&slots).take(2 * usize::from(!slots.is_empty())).copied().collect();
        let validity_inputs = [self.difference, self.rounded, self.speed, self.windward];
        let validity_parts: Vec<Id> = holds.into_iter().collect();
        constants(graph, &iteration_parts, &iteration_inputs, &mut numbers);
        constants(graph, &stage_parts, &stage_inputs, &mut numbers);
        constants(graph, &validity_parts, &validity_inputs, &mut numbers);
        let mut known = Vec::new();
        let mut run_numbers = Vec::new();
        for &part in &numbers {
            self.leaves(part, &mut known, &mut run_numbers);
        }
        let validity =
            holds.map(|_| Program::new(graph, &validity_parts, &validity_inputs, &numbers)).transpose()?;
        Ok(FormulaText {
            run: Program::new(graph, &numbers, &[], &known)?,
            run_numbers,
            stage: Program::new(graph, &stage_parts, &stage_inputs, &numbers)?,
            iteration: Program::new(graph, &iteration_parts, &iteration_inputs, &numbers)?,
            validity,
            tree,
            valid,
            buoyant,
            windy,
        })
    }

    /// What the wind gives to the coefficient, at most two parts: what is expensive to compute if that is enough.
    fn slots(&self, parts: &[Id]) -> Vec<Id> {
        let mut found = [Vec::new(), Vec::new(), Vec::new()];
        for &part in parts {
            self.collect(part, &mut found, &mut Vec::new());
        }
        let [largest, expensive, inputs] = found;
        [expensive, largest].into_iter().find(|slots| slots.len() <= 2).unwrap_or(inputs)
    }

    fn collect(&self, part: Id, found: &mut [Vec<Id>; 3], seen: &mut Vec<Id>) {
        if seen.contains(&part) {
            return;
        }
        seen.push(part);
        match self.graph.level(part) {
            Level::Iteration => {
                for operand in self.graph.operands(part) {
                    self.collect(operand, found, seen);
                }
            }
            Level::Stage => {
                insert(&mut found[0], part);
                self.below(part, found, false);
            }
            Level::Run | Level::Text => {}
        }
    }

    /// The expensive parts and the inputs of a part that depends on the wind.
    fn below(&self, part: Id, found: &mut [Vec<Id>; 3], mut under: bool) {
        if self.graph.level(part) != Level::Stage {
            return;
        }
        let cheap = matches!(
            self.graph.node(part),
            Node::Plus(..) | Node::Minus(..) | Node::Times(..) | Node::Negative(_)
        );
        if !cheap && !under {
            insert(&mut found[1], part);
            under = true;
        }
        if matches!(self.graph.node(part), Node::Input(_)) {
            insert(&mut found[2], part);
        }
        for operand in self.graph.operands(part) {
            self.below(operand, found, under);
        }
    }

    /// Constants and inputs of a part.
    fn leaves(&self, part: Id, known: &mut Vec<Id>, numbers: &mut Vec<Number>) {
        if known.contains(&part) {
            return;
        }
        let number = match self.graph.node(part) {
            Node::Constant(bits) => Some(Number::Constant(f64::from_bits(bits))),
            Node::Input(_) => self.inputs.iter().find(|(id, _)| *id == part).map(|(_, number)| *number),
            _ => None,
        };
        if let Some(number) = number {
            known.push(part);
            numbers.push(number);
        }
        for operand in self.graph.operands(part) {
            self.leaves(operand, known, numbers);
        }
    }
}

fn insert(list: &mut Vec<Id>, id: Id) {
    if !list.contains(&id) {
        list.push(id);
    }
}

/// The largest parts that a run computes once, of parts that are computed more often.
fn constants(graph: &Graph, parts: &[Id], inputs: &[Id], found: &mut Vec<Id>) {
    for &part in parts {
        if inputs.contains(&part) {
            continue;
        }
        if graph.level(part) <= Level::Run {
            insert(found, part);
        } else {
            constants(graph, &graph.operands(part), inputs, found);
        }
    }
}
