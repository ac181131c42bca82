//! Derivatives of a graph by its variable, and powers as roots and products.

use std::collections::HashMap;

use super::graph::{Graph, Id, Level, Node};

/// Fractions of exponents whose powers are roots.
const ROOTS: [f64; 7] = [0.5, 0.25, 0.75, 1.0 / 3.0, 2.0 / 3.0, 1.0 / 6.0, 5.0 / 6.0];
/// Exponents this close are the same: `4/3 - 1` has another last bit than `1/3`.
const SAME: f64 = 1e-15;
/// Largest exponent that is made of roots and products.
const LARGEST: f64 = 9.0;

impl Graph {
    /// The derivative of a part by the variable; `slopes`: those of the inputs.
    pub(crate) fn derivative(&mut self, id: Id, slopes: &HashMap<Id, Id>, known: &mut HashMap<Id, Id>) -> Id {
        if let Some(&slope) = slopes.get(&id).or_else(|| known.get(&id)) {
            return slope;
        }
        if self.level(id) < Level::Iteration {
            return self.constant(0.0);
        }
        let slope = match self.node(id) {
            Node::Times(a, b) if self.level(a) < Level::Iteration && self.is_power(b) => {
                let relative = self.relative_slope(b, slopes, known);
                self.times(id, relative)
            }
            Node::Power(..) => {
                let relative = self.relative_slope(id, slopes, known);
                self.times(id, relative)
            }
            Node::Choose { less, yes, no } => {
                let [yes, no] = [yes, no].map(|part| self.derivative(part, slopes, known));
                self.choose(less, yes, no)
            }
            node => {
                let of: Vec<Id> =
                    self.operands(id).iter().map(|&part| self.derivative(part, slopes, known)).collect();
                match of[..] {
                    [da, db] => self.slope_of_two(id, node, [da, db]),
                    [da] => self.slope_of_one(id, node, da),
                    _ => self.constant(0.0),
                }
            }
        };
        known.insert(id, slope);
        slope
    }

    /// The slope of an operation of two parts from their slopes.
    fn slope_of_two(&mut self, id: Id, node: Node, [da, db]: [Id; 2]) -> Id {
        match node {
            Node::Plus(..) => self.plus(da, db),
            Node::Minus(..) => self.minus(da, db),
            Node::Times(a, b) => {
                let (left, right) = (self.times(da, b), self.times(a, db));
                self.plus(left, right)
            }
            Node::Over(_, b) => {
                let lost = self.times(id, db);
                let rest = self.minus(da, lost);
                self.over(rest, b)
            }
            Node::Min(a, b) => self.choose([b, a], db, da),
            Node::Max(a, b) => self.choose([a, b], db, da),
            _ => self.constant(0.0),
        }
    }

    /// The slope of a function of one part from its slope.
    fn slope_of_one(&mut self, id: Id, node: Node, da: Id) -> Id {
        match node {
            Node::Negative(_) => self.negative(da),
            Node::Sqrt(_) => {
                let (relative, half) = (self.over(da, id), self.constant(0.5));
                self.times(half, relative)
            }
            Node::InverseCbrt(a) => {
                let (relative, third) = (self.over(da, a), self.constant(-1.0 / 3.0));
                let factor = self.times(third, id);
                self.times(factor, relative)
            }
            Node::Exp(_) => self.times(id, da),
            Node::Ln(a) => self.over(da, a),
            Node::Sin(a) => {
                let cosine = self.cos(a);
                self.times(cosine, da)
            }
            Node::Cos(a) => {
                let sine = self.sin(a);
                let product = self.times(sine, da);
                self.negative(product)
            }
            _ => self.constant(0.0),
        }
    }

    fn is_power(&self, id: Id) -> bool {
        matches!(self.node(id), Node::Power(..))
    }

    /// The slope of a power over the power, `y' ln x + y x'/x`.
    fn relative_slope(&mut self, id: Id, slopes: &HashMap<Id, Id>, known: &mut HashMap<Id, Id>) -> Id {
        let Node::Power(base, exponent) = self.node(id) else { return self.constant(0.0) };
        let [dbase, dexponent] = [base, exponent].map(|part| self.derivative(part, slopes, known));
        let relative = self.over(dbase, base);
        let share = self.times(exponent, relative);
        if self.folded(dexponent) == Some(0.0) {
            return share;
        }
        let logarithm = self.ln(base);
        let product = self.times(dexponent, logarithm);
        self.plus(share, product)
    }

    /// The same part with powers replaced by roots, products, exponentials and logarithms.
    pub(crate) fn lowered(&mut self, id: Id, known: &mut HashMap<Id, Id>) -> Id {
        if let Some(&done) = known.get(&id) {
            return done;
        }
        let of: Vec<Id> = self.operands(id).iter().map(|&part| self.lowered(part, known)).collect();
        let done = match (self.node(id), &of[..]) {
            (Node::Plus(..), &[a, b]) => self.plus(a, b),
            (Node::Minus(..), &[a, b]) => self.minus(a, b),
            (Node::Times(..), &[a, b]) => self.times(a, b),
            (Node::Over(..), &[a, b]) => self.over(a, b),
            (Node::Min(..), &[a, b]) => self.min(a, b),
            (Node::Max(..), &[a, b]) => self.max(a, b),
            (Node::Power(..), &[base, exponent]) => self.lowered_power(base, exponent),
            (Node::Negative(_), &[a]) => self.negative(a),
            (Node::Sqrt(_), &[a]) => self.sqrt(a),
            (Node::InverseCbrt(_), &[a]) => self.inverse_cbrt(a),
            (Node::Exp(_), &[a]) => self.exp(a),
            (Node::Ln(_), &[a]) => self.ln(a),
            (Node::Sin(_), &[a]) => self.sin(a),
            (Node::Cos(_), &[a]) => self.cos(a),
            (Node::Choose { .. }, &[a, b, yes, no]) => self.choose([a, b], yes, no),
            _ => id,
        };
        known.insert(id, done);
        done
    }

    fn lowered_power(&mut self, base: Id, exponent: Id) -> Id {
        if let Some(value) = self.folded(exponent) {
            let (whole, fraction) = (value.abs().floor(), value.abs().fract());
            let root = ROOTS.iter().find(|root| (*root - fraction).abs() < SAME);
            if let Some(&root) = root
                && whole < LARGEST
            {
                let root = self.root(base, root);
                let whole = self.constant(whole);
                let product = self.power(base, whole);
                let power = self.times(root, product);
                if value > 0.0 {
                    return power;
                }
                let one = self.constant(1.0);
                return self.over(one, power);
            }
        }
        let logarithm = self.ln(base);
        let product = self.times(exponent, logarithm);
        self.exp(product)
    }

    /// A root of a positive part.
    fn root(&mut self, base: Id, exponent: f64) -> Id {
        let third = |graph: &mut Self| {
            let inverse = graph.inverse_cbrt(base);
            [inverse, graph.times(base, inverse)]
        };
        if exponent == 0.5 {
            return self.sqrt(base);
        }
        if exponent == 0.25 || exponent == 0.75 {
            let half = self.sqrt(base);
            let quarter = self.sqrt(half);
            return if exponent == 0.25 { quarter } else { self.times(half, quarter) };
        }
        let [inverse, two_thirds] = third(self);
        if exponent == 2.0 / 3.0 {
            return two_thirds;
        }
        let one_third = self.times(two_thirds, inverse);
        if exponent == 1.0 / 3.0 {
            return one_third;
        }
        let half = self.sqrt(if exponent == 1.0 / 6.0 { one_third } else { base });
        if exponent == 1.0 / 6.0 { half } else { self.times(half, one_third) }
    }
}
