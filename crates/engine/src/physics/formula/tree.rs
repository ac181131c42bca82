//! A formula as a tree, and its plain value as it is written.
//!
//! The value of the tree follows the text to the letter: it is no number where the text has none, such as the root of a negative
//! number. Checks use it. Runs compute the [`program`](super::program), which rounds magnitudes near zero.
#![allow(
    clippy::disallowed_methods,
    reason = "checks say what a formula is by the usual meaning of its functions"
)]

use super::Position;

/// A number of a formula.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Tree {
    /// Where its operation stands.
    pub(crate) at: Position,
    pub(crate) kind: Kind,
}

/// How a number comes about.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Kind {
    Constant(f64),
    /// By its place in the list of names.
    Name(usize),
    Negative(Box<Tree>),
    Binary(Operation, Box<[Tree; 2]>),
    Call(Function, Vec<Tree>),
    If(Box<Condition>, Box<[Tree; 2]>),
}

/// An operation of two numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Operation {
    Plus,
    Minus,
    Times,
    Over,
    Power,
}

/// A function of one number, or of several.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Function {
    Abs,
    Sqrt,
    Cbrt,
    Exp,
    Log,
    Log10,
    Sin,
    Cos,
    Tanh,
    Min,
    Max,
}

/// Functions by their names.
pub(crate) const FUNCTIONS: [(&str, Function); 12] = [
    ("abs", Function::Abs),
    ("sqrt", Function::Sqrt),
    ("cbrt", Function::Cbrt),
    ("exp", Function::Exp),
    ("log", Function::Log),
    ("ln", Function::Log),
    ("log10", Function::Log10),
    ("sin", Function::Sin),
    ("cos", Function::Cos),
    ("tanh", Function::Tanh),
    ("min", Function::Min),
    ("max", Function::Max),
];

/// Something that holds or not.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Condition {
    Less(Box<[Tree; 2]>),
    /// A name that is one or zero.
    Flag(Box<Tree>),
    Not(Box<Condition>),
    Both(Box<[Condition; 2]>),
    Either(Box<[Condition; 2]>),
}

impl Tree {
    /// Its value, from those of the names.
    pub(crate) fn value(&self, names: &[f64]) -> f64 {
        match &self.kind {
            Kind::Constant(value) => *value,
            Kind::Name(index) => names[*index],
            Kind::Negative(of) => -of.value(names),
            Kind::Binary(operation, of) => {
                let [a, b] = [of[0].value(names), of[1].value(names)];
                match operation {
                    Operation::Plus => a + b,
                    Operation::Minus => a - b,
                    Operation::Times => a * b,
                    Operation::Over => a / b,
                    Operation::Power => a.powf(b),
                }
            }
            Kind::Call(function, of) => call(*function, of, names),
            Kind::If(condition, of) => of[usize::from(!condition.holds(names))].value(names),
        }
    }

    /// The first operation, from inside outwards, whose value is no finite number.
    pub(crate) fn unbounded(&self, names: &[f64]) -> Option<Position> {
        let inside = match &self.kind {
            Kind::Constant(_) | Kind::Name(_) => None,
            Kind::Negative(of) => of.unbounded(names),
            Kind::Binary(_, of) => of.iter().find_map(|of| of.unbounded(names)),
            Kind::Call(_, of) => of.iter().find_map(|of| of.unbounded(names)),
            Kind::If(condition, of) => of[usize::from(!condition.holds(names))].unbounded(names),
        };
        inside.or_else(|| (!self.value(names).is_finite()).then_some(self.at))
    }

    /// Whether a name is used.
    pub(crate) fn uses(&self, name: usize) -> bool {
        match &self.kind {
            Kind::Constant(_) => false,
            Kind::Name(index) => *index == name,
            Kind::Negative(of) => of.uses(name),
            Kind::Binary(_, of) => of.iter().any(|of| of.uses(name)),
            Kind::Call(_, of) => of.iter().any(|of| of.uses(name)),
            Kind::If(condition, of) => condition.uses(name) || of.iter().any(|of| of.uses(name)),
        }
    }
}

fn call(function: Function, of: &[Tree], names: &[f64]) -> f64 {
    let value = of[0].value(names);
    match function {
        Function::Abs => value.abs(),
        Function::Sqrt => value.sqrt(),
        Function::Cbrt => value.cbrt(),
        Function::Exp => value.exp(),
        Function::Log => value.ln(),
        Function::Log10 => value.log10(),
        Function::Sin => value.sin(),
        Function::Cos => value.cos(),
        Function::Tanh => value.tanh(),
        Function::Min => of[1..].iter().fold(value, |least, of| least.min(of.value(names))),
        Function::Max => of[1..].iter().fold(value, |most, of| most.max(of.value(names))),
    }
}

impl Condition {
    /// Whether it holds, from the values of the names.
    pub(crate) fn holds(&self, names: &[f64]) -> bool {
        match self {
            Self::Less(of) => of[0].value(names) < of[1].value(names),
            Self::Flag(of) => of.value(names) > 0.5,
            Self::Not(of) => !of.holds(names),
            Self::Both(of) => of.iter().all(|of| of.holds(names)),
            Self::Either(of) => of.iter().any(|of| of.holds(names)),
        }
    }

    /// Whether a name is used.
    pub(crate) fn uses(&self, name: usize) -> bool {
        match self {
            Self::Less(of) => of.iter().any(|of| of.uses(name)),
            Self::Flag(of) => of.uses(name),
            Self::Not(of) => of.uses(name),
            Self::Both(of) | Self::Either(of) => of.iter().any(|of| of.uses(name)),
        }
    }
}
