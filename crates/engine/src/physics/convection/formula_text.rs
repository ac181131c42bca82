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
//! | `Ts` | temperature of the surface [degC] | in every iteration |
//! | `Ta` | temperature of the air in front of it, in a zone that at the start of the step [degC] | once per stage |
//! | `wind_angle` | between the normal and the direction that the wind comes from [deg] | once per stage |
//! | `sun` | irradiance of the plane [W/m2] | once per stage |
//! | `air_change` | of the zone, by its air at the start of the step [1/h] | once per stage |
//! | `total_air_change` | all air that flows into the zone or moves within it [1/h] | once per stage |
//! | `height` | of the side above ground [m] | once per run |
//!
//! Numbers of the law have their own names. `abs(dT)` is `(dT^2 + r^2)^1/2` with the small r of [`natural`](super::natural), as in all
//! laws: its powers and their derivatives are finite at zero. In powers and roots `V` is at least 1 mm/s at the mast, likewise.

use std::collections::HashMap;

use super::wind::{AROUND, CALM};
use crate::physics::formula::graph::{Graph, Id, Level, Node};
use crate::physics::formula::lexer::fault;
use crate::physics::formula::parser::{self, Names};
use crate::physics::formula::program::{Program, TooLong};
use crate::physics::formula::tree::{Condition, Tree};
use crate::physics::formula::{FormulaFault, Position};

/// Names that the side of a surface gives, by their places in [`Tree`].
pub(crate) const VARIABLES: [&str; 14] = [
    "dT",
    "V",
    "windward",
    "tilt",
    "upward",
    "area",
    "density",
    "Ts",
    "Ta",
    "wind_angle",
    "sun",
    "air_change",
    "total_air_change",
    "height",
];
pub(crate) const DIFFERENCE: usize = 0;
pub(crate) const WIND: usize = 1;
pub(crate) const WINDWARD: usize = 2;
pub(crate) const SURFACE: usize = 7;
/// Place of the first of the [`Surroundings`](super::wind::Surroundings): air, angle, sun, air change and all air.
pub(crate) const AIR: usize = 8;
/// Those that change during a run.
pub(crate) const CHANGING: [usize; 9] =
    [DIFFERENCE, WIND, WINDWARD, SURFACE, AIR, AIR + 1, AIR + 2, AIR + 3, AIR + 4];

const NO_WIND: &str =
    "No wind reaches this side: it does not face outdoors, or its exposure leaves the wind out.";
const NO_SUN: &str = "The irradiance is known of sides that face outdoors and whose exposure has the sun.";
const NO_ZONE: &str = "This side faces no zone.";
const NO_HEIGHT: &str =
    "This side has no height above ground: it faces no wind outdoors. Give a number of another name.";
const BY_THESE: &str = "Say where the law holds by dT, Ts, Ta and V.";

/// Names that papers use and that no side gives.
const ABSENT: [(&str, &str); 5] = [
    ("T", "Write Ts for the surface, Ta for the air, or dT for their difference."),
    ("dt", "Write dT."),
    ("v", "Write V for the wind at the surface."),
    ("angle", "Write wind_angle."),
    ("ACH", "Write air_change."),
];

/// Which names a side gives beside those that all sides have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(clippy::struct_excessive_bools, reason = "each says whether some names exist")]
pub(crate) struct SideNames {
    /// The wind reaches it.
    pub(crate) wind: bool,
    /// The irradiance of its plane is known.
    pub(crate) sun: bool,
    /// It faces a zone.
    pub(crate) zone: bool,
    /// It has a height above ground.
    pub(crate) height: bool,
}

impl SideNames {
    /// Names that it does not give, and why.
    fn absent(self) -> Vec<(&'static str, &'static str)> {
        let names = [
            ("V", NO_WIND, self.wind),
            ("windward", NO_WIND, self.wind),
            ("wind_angle", NO_WIND, self.wind),
            ("sun", NO_SUN, self.sun),
            ("air_change", NO_ZONE, self.zone),
            ("total_air_change", NO_ZONE, self.zone),
            ("height", NO_HEIGHT, self.height),
        ];
        let absent = names.into_iter().filter(|(_, _, has)| !has).map(|(name, why, _)| (name, why));
        absent.chain(ABSENT).collect()
    }
}

/// A coefficient written as text.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct FormulaText {
    /// As written; names by their places: [`VARIABLES`], then the numbers.
    pub(crate) tree: Tree,
    pub(crate) valid: Option<Condition>,
    /// Whether it depends on the temperature difference, and on the wind.
    pub(crate) buoyant: bool,
    pub(crate) windy: bool,
    /// Which of the [`Surroundings`](super::wind::Surroundings) the formula uses.
    pub(crate) surroundings: [bool; AROUND],
    /// Whether more than two parts change with wind and surroundings.
    pub(crate) many: bool,
    /// From what a run has, the numbers that the other programs need.
    pub(crate) run: Program,
    pub(crate) run_numbers: Vec<Number>,
    /// From wind and surroundings, what [`Driven`](super::wind::Driven) holds.
    pub(crate) stage: Program,
    /// The coefficient and its derivative, from `d`, `d^2 + r^2` and [`Driven`](super::wind::Driven).
    pub(crate) iteration: Program,
    /// One where the law is valid, else zero, from `d`, `d^2 + r^2`, the wind at the mast and the temperature of the air.
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
    Height,
    /// By its place among the numbers of the law.
    Given(usize),
}

impl FormulaText {
    /// Reads a law; `numbers`: the names of its numbers; `side`: which names the side gives.
    ///
    /// # Errors
    /// The first fault of its texts.
    pub(crate) fn new(
        formula: &str,
        valid: Option<&str>,
        numbers: &[&str],
        side: SideNames,
    ) -> Result<Self, FormulaFault> {
        let usable: Vec<&str> = VARIABLES.iter().chain(numbers).copied().collect();
        let absent = side.absent();
        let gives = |name: &str| absent.iter().all(|(other, _)| *other != name);
        // Places stay the same where a side does not give a name.
        let usable: Vec<&str> = usable.into_iter().map(|name| if gives(name) { name } else { "" }).collect();
        check_names(numbers)?;
        let names = Names { usable: &usable, flags: &["windward"], absent: &absent };
        let at = |key: &str| {
            let key = key.to_owned();
            move |fault| FormulaFault { key, fault }
        };
        let tree = parser::number(formula, names).map_err(at("formula"))?;
        let elsewhere = ["windward", "wind_angle", "sun", "air_change", "total_air_change"];
        let usable: Vec<&str> =
            usable.iter().map(|name| if elsewhere.contains(name) { "" } else { *name }).collect();
        let absent: Vec<(&str, &str)> =
            elsewhere.into_iter().map(|name| (name, BY_THESE)).chain(absent.clone()).collect();
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
            let found = "a formula that needs too many numbers at once";
            let remedy = "Simplify it; write terms of wind, sun and air side by side in one bracket.";
            at("formula")(fault(START, found, "fewer operations", remedy))
        })
    }

    /// Whether a name of [`VARIABLES`] is used by the formula or its validity.
    pub(crate) fn uses(&self, variable: usize) -> bool {
        self.tree.uses(variable) || self.valid.as_ref().is_some_and(|valid| valid.uses(variable))
    }
}

/// Places of [`Driven`](super::wind::Driven).
const SLOTS: usize = 4;
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
    surroundings: [Id; AROUND],
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
        let surroundings = [(); AROUND].map(|()| input(&mut graph, Level::Stage, false));
        let mut inputs = vec![
            (input(&mut graph, Level::Run, true), Number::WindFactor),
            (input(&mut graph, Level::Run, false), Number::Tilt),
            (input(&mut graph, Level::Run, false), Number::Upward),
            (input(&mut graph, Level::Run, true), Number::Area),
            (input(&mut graph, Level::Run, true), Number::Density),
            (input(&mut graph, Level::Run, false), Number::Height),
        ];
        for given in 0..numbers {
            inputs.push((input(&mut graph, Level::Run, false), Number::Given(given)));
        }
        let calm = graph.constant(CALM);
        let moving = graph.max(speed, calm);
        let wind = [speed, moving].map(|speed| graph.times(inputs[0].0, speed));
        Self { graph, difference, rounded, speed, windward, surroundings, inputs, wind }
    }

    /// The part that a name stands for; `base`: in the base of a power.
    fn leaf(&self) -> impl FnMut(&mut Graph, usize, bool) -> Id + use<> {
        let inputs: Vec<Id> = self.inputs.iter().map(|(id, _)| *id).collect();
        let (difference, windward, wind) = (self.difference, self.windward, self.wind);
        let surroundings = self.surroundings;
        move |graph, name, base| match name {
            DIFFERENCE => difference,
            WIND => wind[usize::from(base)],
            WINDWARD => windward,
            SURFACE => graph.plus(surroundings[0], difference),
            name if (AIR..AIR + AROUND).contains(&name) => surroundings[name - AIR],
            // tilt, upward, area and density come after the wind factor, then the height and the numbers.
            name if name < SURFACE => inputs[name - WINDWARD],
            name => inputs[name - AIR - AROUND + SURFACE - WINDWARD],
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
        let [air, angle, sun, air_change, total] = self.surroundings;
        let stage_inputs = [self.speed, self.windward, air, angle, sun, air_change, total];
        if slots.len() > SLOTS {
            return Err(TooLong);
        }
        // The slots fill all places.
        let filled = SLOTS * usize::from(!slots.is_empty());
        let stage_parts: Vec<Id> = slots.iter().cycle().take(filled).copied().collect();
        let validity_inputs = [self.difference, self.rounded, self.speed, air];
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
            surroundings: core::array::from_fn(|place| {
                tree.uses(AIR + place) || (place == 0 && tree.uses(SURFACE))
            }),
            many: slots.len() > 2,
            tree,
            valid,
            buoyant,
            windy,
        })
    }

    /// What wind and surroundings give to the coefficient: what is expensive to compute if that is two parts at most, else the
    /// fewest of several ways.
    fn slots(&self, parts: &[Id]) -> Vec<Id> {
        let mut found = [Vec::new(), Vec::new(), Vec::new()];
        for &part in parts {
            self.collect(part, &mut found, &mut Vec::new());
        }
        let [largest, expensive, inputs] = found;
        let ways = [expensive, largest, inputs];
        let few = ways.iter().find(|slots| slots.len() <= 2);
        few.or_else(|| ways.iter().min_by_key(|slots| slots.len())).cloned().unwrap_or_default()
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
