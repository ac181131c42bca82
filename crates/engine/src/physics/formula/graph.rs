//! A formula as a graph in which no part occurs twice: constants are folded, powers simplified, and what depends on less is kept
//! apart, so that it is computed less often.
//!
//! A power `x^y` of anything but a whole exponent needs a positive base. What may be less is raised to [`LEAST`] first; checks of
//! the law refuse formulas in which that matters.

use std::collections::HashMap;

use crate::number::real::Real;

/// A part of a graph.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct Id(pub(crate) u32);

/// When a part can be computed, from what it depends on: the later includes the earlier.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Level {
    /// From numbers of the text alone.
    Text,
    /// Once per run.
    Run,
    /// Once per stage.
    Stage,
    /// In every iteration.
    Iteration,
}

/// Bases of powers and arguments of logarithms below this count as this.
const LEAST: f64 = 1e-30;
/// Whole exponents up to this are products.
const LARGEST_WHOLE: f64 = 32.0;

/// An operation of a graph; numbers by their bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Node {
    Constant(u64),
    /// By its place in the list of inputs.
    Input(u8),
    Plus(Id, Id),
    Minus(Id, Id),
    Times(Id, Id),
    Over(Id, Id),
    Negative(Id),
    Power(Id, Id),
    Sqrt(Id),
    InverseCbrt(Id),
    Exp(Id),
    Ln(Id),
    Sin(Id),
    Cos(Id),
    Min(Id, Id),
    Max(Id, Id),
    /// `yes` where the first is less than the second, else `no`.
    Choose {
        less: [Id; 2],
        yes: Id,
        no: Id,
    },
}

/// What is known of a part.
#[derive(Debug, Clone, Copy)]
pub(super) struct Facts {
    pub(super) level: Level,
    /// Above zero by more than round-off.
    pub(super) positive: bool,
    pub(super) not_negative: bool,
}

/// A formula, or several of them, without repeated parts.
#[derive(Debug, Clone, Default)]
pub(crate) struct Graph {
    nodes: Vec<Node>,
    facts: Vec<Facts>,
    known: HashMap<Node, Id>,
    /// A variable whose magnitude is rounded near zero, and the sum of its square and that of the rounding.
    rounded: Option<[Id; 2]>,
}

impl Graph {
    /// An input; `positive`: whether it is above zero by more than round-off.
    pub(crate) fn input(&mut self, place: u8, level: Level, positive: bool) -> Id {
        self.add(Node::Input(place), Facts { level, positive, not_negative: positive })
    }

    /// Rounds the magnitude of an input near zero; the second is `d^2 + r^2`.
    pub(crate) fn round(&mut self, difference: Id, rounded: Id) {
        self.rounded = Some([difference, rounded]);
    }

    pub(crate) fn node(&self, id: Id) -> Node {
        self.nodes[id.0 as usize]
    }

    pub(crate) fn level(&self, id: Id) -> Level {
        self.facts[id.0 as usize].level
    }

    pub(crate) fn constant(&mut self, value: f64) -> Id {
        // Zero has one sign only.
        let value = if value == 0.0 { 0.0 } else { value };
        let facts = Facts { level: Level::Text, positive: value > 1e-12, not_negative: value >= 0.0 };
        self.add(Node::Constant(value.to_bits()), facts)
    }

    /// The value of a constant.
    pub(crate) fn folded(&self, id: Id) -> Option<f64> {
        if let Node::Constant(bits) = self.node(id) { Some(f64::from_bits(bits)) } else { None }
    }

    /// The parts that a part is made of.
    pub(crate) fn operands(&self, id: Id) -> Vec<Id> {
        match self.node(id) {
            Node::Constant(_) | Node::Input(_) => Vec::new(),
            Node::Plus(a, b)
            | Node::Minus(a, b)
            | Node::Times(a, b)
            | Node::Over(a, b)
            | Node::Power(a, b)
            | Node::Min(a, b)
            | Node::Max(a, b) => vec![a, b],
            Node::Negative(a)
            | Node::Sqrt(a)
            | Node::InverseCbrt(a)
            | Node::Exp(a)
            | Node::Ln(a)
            | Node::Sin(a)
            | Node::Cos(a) => vec![a],
            Node::Choose { less: [a, b], yes, no } => vec![a, b, yes, no],
        }
    }

    fn add(&mut self, node: Node, facts: Facts) -> Id {
        if let Some(&id) = self.known.get(&node) {
            return id;
        }
        let id = Id(u32::try_from(self.nodes.len()).unwrap_or(u32::MAX));
        self.nodes.push(node);
        self.facts.push(facts);
        self.known.insert(node, id);
        id
    }

    pub(super) fn of(&self, id: Id) -> Facts {
        self.facts[id.0 as usize]
    }

    fn later(&self, a: Id, b: Id) -> Level {
        self.level(a).max(self.level(b))
    }

    /// The two in an order that does not depend on how they were written.
    fn sorted(&self, a: Id, b: Id) -> [Id; 2] {
        if (self.level(a), a) <= (self.level(b), b) { [a, b] } else { [b, a] }
    }

    pub(crate) fn plus(&mut self, a: Id, b: Id) -> Id {
        match (self.folded(a), self.folded(b)) {
            (Some(x), Some(y)) => return self.constant(x + y),
            (Some(0.0), _) => return b,
            (_, Some(0.0)) => return a,
            _ => {}
        }
        let [a, b] = self.sorted(a, b);
        let (x, y) = (self.of(a), self.of(b));
        let not_negative = x.not_negative && y.not_negative;
        let positive = not_negative && (x.positive || y.positive);
        self.add(Node::Plus(a, b), Facts { level: self.later(a, b), positive, not_negative })
    }

    pub(crate) fn minus(&mut self, a: Id, b: Id) -> Id {
        match (self.folded(a), self.folded(b)) {
            (Some(x), Some(y)) => return self.constant(x - y),
            (_, Some(0.0)) => return a,
            (Some(0.0), _) => return self.negative(b),
            _ if a == b => return self.constant(0.0),
            _ => {}
        }
        let facts = Facts { level: self.later(a, b), positive: false, not_negative: false };
        self.add(Node::Minus(a, b), facts)
    }

    pub(crate) fn times(&mut self, a: Id, b: Id) -> Id {
        let [a, b] = self.sorted(a, b);
        match (self.folded(a), self.folded(b)) {
            (Some(x), Some(y)) => return self.constant(x * y),
            (Some(0.0), _) => return a,
            (Some(1.0), _) => return b,
            _ => {}
        }
        // Constants are multiplied with each other.
        if self.level(a) == Level::Text
            && let Node::Over(above, below) = self.node(b)
        {
            let above = self.times(a, above);
            return self.over(above, below);
        }
        // What depends on less is multiplied first.
        if let Node::Times(first, second) = self.node(b)
            && self.level(first) < self.level(second)
            && self.level(a) < self.level(second)
        {
            let factor = self.times(a, first);
            return self.times(factor, second);
        }
        let (x, y) = (self.of(a), self.of(b));
        let facts = Facts {
            level: self.later(a, b),
            positive: x.positive && y.positive,
            not_negative: a == b || (x.not_negative && y.not_negative),
        };
        self.add(Node::Times(a, b), facts)
    }

    pub(crate) fn over(&mut self, a: Id, b: Id) -> Id {
        match (self.folded(a), self.folded(b)) {
            (Some(x), Some(y)) => return self.constant(x / y),
            (Some(0.0), _) | (_, Some(1.0)) => return a,
            _ => {}
        }
        if self.level(b) < self.level(a) {
            let one = self.constant(1.0);
            let inverse = self.over(one, b);
            return self.times(inverse, a);
        }
        let (x, y) = (self.of(a), self.of(b));
        let not_negative = x.not_negative && y.not_negative;
        let positive = x.positive && y.positive;
        self.add(Node::Over(a, b), Facts { level: self.later(a, b), positive, not_negative })
    }

    pub(crate) fn negative(&mut self, a: Id) -> Id {
        if let Some(value) = self.folded(a) {
            return self.constant(-value);
        }
        if let Node::Negative(inside) = self.node(a) {
            return inside;
        }
        let facts = Facts { level: self.level(a), positive: false, not_negative: false };
        self.add(Node::Negative(a), facts)
    }

    /// The larger one of a part and the least base of a power.
    fn safe(&mut self, a: Id) -> Id {
        if self.of(a).positive {
            return a;
        }
        let least = self.constant(LEAST);
        let raised = self.max(a, least);
        self.facts[raised.0 as usize].positive = true;
        raised
    }

    pub(crate) fn power(&mut self, base: Id, exponent: Id) -> Id {
        let known = self.folded(exponent);
        if known == Some(1.0) {
            return base;
        }
        if known == Some(0.0) {
            return self.constant(1.0);
        }
        if let Some(value) = known
            && value.fract() == 0.0
            && value.abs() <= LARGEST_WHOLE
            && !matches!(self.node(base), Node::Power(..))
        {
            if let Node::Times(a, b) = self.node(base)
                && self.level(a) < self.level(b)
            {
                let (a, b) = (self.power(a, exponent), self.power(b, exponent));
                return self.times(a, b);
            }
            return self.whole_power(base, value);
        }
        // Where the one factor is positive, the other one must be, too.
        if let Node::Times(a, b) = self.node(base)
            && self.level(a) < self.level(b)
            && (self.of(a).positive || self.of(b).positive)
        {
            let (a, b) = (self.power(a, exponent), self.power(b, exponent));
            return self.times(a, b);
        }
        let base = self.rounded_square(base);
        let base = self.safe(base);
        if let Node::Power(inside, inner) = self.node(base)
            && self.of(inside).positive
        {
            let product = self.times(inner, exponent);
            return self.power(inside, product);
        }
        if let (Some(x), Some(y)) = (self.folded(base), known) {
            return self.constant(Real::powf(x, y));
        }
        let facts = Facts { level: self.later(base, exponent), positive: true, not_negative: true };
        self.add(Node::Power(base, exponent), facts)
    }

    /// `d^2` as the rounded square, where a root of it is taken.
    fn rounded_square(&self, base: Id) -> Id {
        match (self.node(base), self.rounded) {
            (Node::Times(a, b), Some([difference, rounded])) if a == b && a == difference => rounded,
            _ => base,
        }
    }

    fn whole_power(&mut self, base: Id, exponent: f64) -> Id {
        if exponent < 0.0 {
            let (one, power) = (self.constant(1.0), self.whole_power(base, -exponent));
            return self.over(one, power);
        }
        if exponent == 1.0 {
            return base;
        }
        let half = self.whole_power(base, (exponent / 2.0).floor());
        let square = self.times(half, half);
        if exponent % 2.0 == 0.0 { square } else { self.times(square, base) }
    }

    fn unary(&mut self, node: fn(Id) -> Node, a: Id, value: fn(f64) -> f64, positive: bool) -> Id {
        if let Some(number) = self.folded(a) {
            return self.constant(value(number));
        }
        let facts = Facts { level: self.level(a), positive, not_negative: positive };
        self.add(node(a), facts)
    }

    pub(crate) fn exp(&mut self, a: Id) -> Id {
        self.unary(Node::Exp, a, Real::exp, true)
    }

    pub(crate) fn ln(&mut self, a: Id) -> Id {
        let a = self.safe(a);
        self.unary(Node::Ln, a, Real::ln, false)
    }

    pub(crate) fn sin(&mut self, a: Id) -> Id {
        self.unary(Node::Sin, a, Real::sin, false)
    }

    pub(crate) fn cos(&mut self, a: Id) -> Id {
        self.unary(Node::Cos, a, Real::cos, false)
    }

    pub(crate) fn sqrt(&mut self, a: Id) -> Id {
        self.unary(Node::Sqrt, a, Real::sqrt, true)
    }

    pub(crate) fn inverse_cbrt(&mut self, a: Id) -> Id {
        self.unary(Node::InverseCbrt, a, Real::inverse_cbrt, true)
    }

    pub(crate) fn min(&mut self, a: Id, b: Id) -> Id {
        if let (Some(x), Some(y)) = (self.folded(a), self.folded(b)) {
            return self.constant(x.min(y));
        }
        let (x, y) = (self.of(a), self.of(b));
        let facts = Facts {
            level: self.later(a, b),
            positive: x.positive && y.positive,
            not_negative: x.not_negative && y.not_negative,
        };
        self.add(Node::Min(a, b), facts)
    }

    pub(crate) fn max(&mut self, a: Id, b: Id) -> Id {
        if let (Some(x), Some(y)) = (self.folded(a), self.folded(b)) {
            return self.constant(x.max(y));
        }
        let (x, y) = (self.of(a), self.of(b));
        let facts = Facts {
            level: self.later(a, b),
            positive: x.positive || y.positive,
            not_negative: x.not_negative || y.not_negative,
        };
        self.add(Node::Max(a, b), facts)
    }

    pub(crate) fn choose(&mut self, less: [Id; 2], yes: Id, no: Id) -> Id {
        if yes == no {
            return yes;
        }
        if let [Some(x), Some(y)] = less.map(|id| self.folded(id)) {
            return if x < y { yes } else { no };
        }
        let (x, y) = (self.of(yes), self.of(no));
        let facts = Facts {
            level: self.later(less[0], less[1]).max(self.later(yes, no)),
            positive: x.positive && y.positive,
            not_negative: x.not_negative && y.not_negative,
        };
        self.add(Node::Choose { less, yes, no }, facts)
    }

    pub(crate) fn abs(&mut self, a: Id) -> Id {
        if self.of(a).not_negative {
            return a;
        }
        if let Some([difference, rounded]) = self.rounded {
            if a == difference {
                let half = self.constant(0.5);
                return self.power(rounded, half);
            }
            if let Node::Times(factor, inside) = self.node(a)
                && inside == difference
            {
                let (factor, magnitude) = (self.abs(factor), self.abs(inside));
                return self.times(factor, magnitude);
            }
        }
        if let Node::Negative(inside) = self.node(a) {
            return self.abs(inside);
        }
        let (zero, other) = (self.constant(0.0), self.negative(a));
        let magnitude = self.choose([a, zero], other, a);
        self.facts[magnitude.0 as usize].not_negative = true;
        magnitude
    }
}
