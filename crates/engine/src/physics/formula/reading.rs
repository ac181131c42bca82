//! From the tree of a formula to a graph.

use super::graph::{Graph, Id};
use super::tree::{Condition, Function, Kind, Operation, Tree};

/// What a graph makes of the names of a formula. The second argument: whether the name is in the base of a power.
pub(crate) type Leaf<'a> = &'a mut dyn FnMut(&mut Graph, usize, bool) -> Id;

impl Graph {
    /// The parts of a formula. `base`: whether they are in the base of a power.
    pub(crate) fn tree(&mut self, tree: &Tree, base: bool, leaf: Leaf<'_>) -> Id {
        match &tree.kind {
            Kind::Constant(value) => self.constant(*value),
            Kind::Name(name) => leaf(self, *name, base),
            Kind::Negative(of) => {
                let of = self.tree(of, base, leaf);
                self.negative(of)
            }
            Kind::Binary(operation, of) => self.binary(*operation, of, base, leaf),
            Kind::Call(function, of) => self.call(*function, of, base, leaf),
            Kind::If(condition, of) => {
                let [yes, no] = [self.tree(&of[0], base, leaf), self.tree(&of[1], base, leaf)];
                self.condition(condition, yes, no, leaf)
            }
        }
    }

    fn binary(&mut self, operation: Operation, of: &[Tree; 2], base: bool, leaf: Leaf<'_>) -> Id {
        if operation == Operation::Power {
            let exponent = self.tree(&of[1], false, leaf);
            let whole = self.folded(exponent).is_some_and(|value| value.fract() == 0.0);
            let base = self.tree(&of[0], base || !whole, leaf);
            return self.power(base, exponent);
        }
        let (a, b) = (self.tree(&of[0], base, leaf), self.tree(&of[1], base, leaf));
        match operation {
            Operation::Plus => self.plus(a, b),
            Operation::Minus => self.minus(a, b),
            Operation::Times => self.times(a, b),
            Operation::Over | Operation::Power => self.over(a, b),
        }
    }

    fn call(&mut self, function: Function, of: &[Tree], base: bool, leaf: Leaf<'_>) -> Id {
        let root = matches!(function, Function::Sqrt | Function::Cbrt | Function::Log | Function::Log10);
        let first = self.tree(&of[0], base || root, leaf);
        match function {
            Function::Abs => self.abs(first),
            Function::Sqrt => {
                let half = self.constant(0.5);
                self.power(first, half)
            }
            Function::Cbrt => self.cbrt(first),
            Function::Exp => self.exp(first),
            Function::Log => self.ln(first),
            Function::Log10 => {
                let (natural, scale) = (self.ln(first), self.constant(core::f64::consts::LOG10_E));
                self.times(scale, natural)
            }
            Function::Sin => self.sin(first),
            Function::Cos => self.cos(first),
            Function::Tanh => self.tanh(first),
            Function::Min | Function::Max => of[1..].iter().fold(first, |found, of| {
                let next = self.tree(of, base, leaf);
                if function == Function::Min { self.min(found, next) } else { self.max(found, next) }
            }),
        }
    }

    /// The cube root, which is negative for negative numbers.
    fn cbrt(&mut self, a: Id) -> Id {
        let (third, zero) = (self.constant(1.0 / 3.0), self.constant(0.0));
        let root = self.power(a, third);
        if self.of(a).not_negative {
            return root;
        }
        let other = self.negative(a);
        let other = self.power(other, third);
        let other = self.negative(other);
        self.choose([a, zero], other, root)
    }

    /// `1 - 2/(exp(2 x) + 1)`, which has no large numbers.
    fn tanh(&mut self, a: Id) -> Id {
        let [one, two] = [1.0, 2.0].map(|value| self.constant(value));
        let double = self.times(two, a);
        let power = self.exp(double);
        let sum = self.plus(one, power);
        let part = self.over(two, sum);
        self.minus(one, part)
    }

    /// A value where a condition holds, and another one where it does not.
    pub(crate) fn condition(&mut self, condition: &Condition, yes: Id, no: Id, leaf: Leaf<'_>) -> Id {
        match condition {
            Condition::Less(of) => {
                let less = [self.tree(&of[0], false, leaf), self.tree(&of[1], false, leaf)];
                self.choose(less, yes, no)
            }
            Condition::Flag(of) => {
                let (half, flag) = (self.constant(0.5), self.tree(of, false, leaf));
                self.choose([half, flag], yes, no)
            }
            Condition::Not(of) => self.condition(of, no, yes, leaf),
            Condition::Both(of) => {
                let inside = self.condition(&of[1], yes, no, leaf);
                self.condition(&of[0], inside, no, leaf)
            }
            Condition::Either(of) => {
                let inside = self.condition(&of[1], yes, no, leaf);
                self.condition(&of[0], yes, inside, leaf)
            }
        }
    }
}
