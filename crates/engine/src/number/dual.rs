//! Forward derivatives: a value with its slopes by some parameters.
//!
//! Source: Griewank & Walther (2008), Evaluating Derivatives, 2nd ed., ch. 3, doi:10.1137/1.9780898717761.

use core::ops::{Add, Div, Mul, Neg, Sub};

use crate::number::lanes::Lanes;
use crate::number::macros::{add_assign, chain_rule};
use crate::number::real::{ConstantTerm, Equations, LinearSystem, Logistic, Real};

/// A number with `K` forward derivatives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dual<const K: usize> {
    /// Value.
    pub value: f64,
    /// Derivatives of the value.
    pub slope: [f64; K],
}

impl<const K: usize> Dual<K> {
    /// The variable whose derivative number `which` is one.
    #[inline(always)]
    #[must_use]
    pub fn variable(value: f64, which: usize) -> Self {
        let mut dual = Self::constant(value);
        dual.slope[which] = 1.0;
        dual
    }
    /// f(self) from the value and slope of f.
    #[inline(always)]
    fn chain(self, value: f64, slope: f64) -> Self {
        Self { value, slope: self.slope.map(|s| s * slope) }
    }
}

impl<const K: usize> Add for Dual<K> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self {
            value: self.value + other.value,
            slope: core::array::from_fn(|i| self.slope[i] + other.slope[i]),
        }
    }
}
impl<const K: usize> Sub for Dual<K> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self {
            value: self.value - other.value,
            slope: core::array::from_fn(|i| self.slope[i] - other.slope[i]),
        }
    }
}
impl<const K: usize> Mul for Dual<K> {
    type Output = Self;
    #[allow(clippy::suspicious_arithmetic_impl, reason = "the product rule is a sum")]
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self {
            value: self.value * other.value,
            slope: core::array::from_fn(|i| self.slope[i] * other.value + self.value * other.slope[i]),
        }
    }
}
impl<const K: usize> Div for Dual<K> {
    type Output = Self;
    #[allow(clippy::suspicious_arithmetic_impl, reason = "the quotient rule has a product and a difference")]
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        Self {
            value,
            slope: core::array::from_fn(|i| (self.slope[i] - value * other.slope[i]) / other.value),
        }
    }
}
impl<const K: usize> Neg for Dual<K> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { value: -self.value, slope: self.slope.map(|s| -s) }
    }
}
add_assign!([const K: usize] Dual<K>);

impl<const K: usize> Real for Dual<K> {
    type Mask = bool;
    type Equations = EquationSlopes<K>;
    const LANES: usize = 1;
    const DERIVATIVES: bool = true;

    #[inline(always)]
    fn constant(value: f64) -> Self {
        Self { value, slope: [0.0; K] }
    }
    #[inline(always)]
    fn lane(self, _lane: usize) -> f64 {
        self.value
    }
    #[inline(always)]
    fn fixed(self) -> Self {
        Self::constant(self.value)
    }
    #[inline(always)]
    fn carries(self) -> bool {
        self.slope != [0.0; K]
    }
    #[inline(always)]
    fn with_value(self, value: f64) -> Self {
        Self { value, ..self }
    }
    chain_rule!(always);
    #[inline(always)]
    fn vectorised<R>(work: impl FnOnce() -> R) -> R {
        if K > 1 { crate::number::simd::widened(work) } else { work() }
    }
}

/// Slopes of equations, then of their solution.
#[derive(Debug, Clone, Default)]
pub struct EquationSlopes<const K: usize> {
    rows: Vec<Lanes<K>>,
    scratch: Vec<Lanes<K>>,
}

impl<const K: usize> Equations<Dual<K>> for EquationSlopes<K> {
    #[inline(always)]
    fn begin(&mut self, equations: usize) {
        self.rows.resize(equations, Lanes::zero());
        self.rows.fill(Lanes::zero());
    }

    #[inline(always)]
    fn add_steady(&mut self, terms: &[ConstantTerm<Dual<K>>], known: &[f64]) {
        for &ConstantTerm { number, between: [a, b], equations, factors } in terms {
            let difference = known[a] - known[b];
            for (equation, factor) in equations.into_iter().zip(factors) {
                self.add(equation, number, factor * difference);
            }
        }
    }

    #[inline(always)]
    fn add(&mut self, equation: usize, number: Dual<K>, factor: f64) {
        self.rows[equation] += Lanes(number.slope).scale(factor);
    }

    #[inline(always)]
    fn solve<L: LinearSystem>(
        &mut self,
        _stage: usize,
        system: &L,
        at: &[f64],
        solution: [&mut [Dual<K>]; 3],
    ) {
        system.solve(&mut self.rows, &mut self.scratch);
        let (mut rows, mut values) = (&self.rows[..], at);
        for unknowns in solution {
            let (own, rest) = rows.split_at(unknowns.len());
            let (own_values, rest_values) = values.split_at(unknowns.len());
            for ((unknown, slope), &value) in unknowns.iter_mut().zip(own).zip(own_values) {
                *unknown = Dual { value, slope: slope.0 };
            }
            (rows, values) = (rest, rest_values);
        }
    }
}

#[cfg(test)]
#[allow(clippy::disallowed_methods, reason = "compared with the functions of the standard library")]
mod tests {
    use super::*;

    fn close(a: f64, b: f64, tolerance: f64) {
        assert!((a - b).abs() <= tolerance * b.abs().max(1e-300), "{a} is not {b}");
    }

    #[test]
    fn duals_differentiate() {
        let x: Dual<1> = Dual::variable(1.3, 0);
        let f = |x: Dual<1>| (x * x).exp() / x.sqrt() + x.ln() * x.cbrt() - x.sin() / x.cos();
        let value = |x: f64| (x * x).exp() / x.sqrt() + x.ln() * x.cbrt() - x.tan();
        let step = 1e-6;
        let difference = (value(1.3 + step) - value(1.3 - step)) / (2.0 * step);
        close(f(x).value, value(1.3), 1e-14);
        close(f(x).slope[0], difference, 1e-8);
        for place in [-2.3, -0.4, 0.7, 5.1] {
            let at = Dual::<1>::variable(place, 0).logistic();
            let [after, before] = [step, -step].map(|step| (place + step).logistic());
            let quotient = |after: f64, before: f64| (after - before) / (2.0 * step);
            close(at.rise.slope[0], quotient(after.rise, before.rise), 1e-7);
            close(at.rest.slope[0], quotient(after.rest, before.rest), 1e-7);
            close(at.tail.slope[0], quotient(after.tail, before.tail), 1e-7);
        }
    }

    /// `[[2, 1], [0, 4]]`, by substitution.
    struct Triangle;

    impl LinearSystem for Triangle {
        fn solve<R: Real>(&self, rows: &mut [R], _scratch: &mut Vec<R>) {
            rows[1] = rows[1].scale(0.25);
            rows[0] = (rows[0] - rows[1]).scale(0.5);
        }
    }

    #[test]
    fn slopes_of_a_solution_come_from_the_slopes_of_the_equations() {
        // 2 x + y = p, 4 y = 3 q at p = 5, q = 4: y = 3, x = 1; dx/dp = 1/2, dx/dq = -3/8, dy/dq = 3/4.
        let (p, q) = (Dual::<2>::variable(5.0, 0), Dual::variable(4.0, 1));
        let mut equations = EquationSlopes::default();
        equations.begin(2);
        equations.add(0, p, 1.0);
        equations.add(1, q, 3.0);
        let (mut x, mut y) = ([Dual::zero()], [Dual::zero()]);
        equations.solve(0, &Triangle, &[1.0, 3.0], [&mut x, &mut y, &mut []]);
        assert_eq!(x[0], Dual { value: 1.0, slope: [0.5, -0.375] });
        assert_eq!(y[0], Dual { value: 3.0, slope: [0.0, 0.75] });
    }

    #[test]
    fn a_steady_term_is_added_to_both_of_its_equations() {
        // p = 10 is multiplied by 5 - 3, and -2 and 3 times that are added: slopes 2 (-2) and 2 (3).
        let number = Dual::<1>::variable(10.0, 0);
        let term = ConstantTerm { number, between: [0, 2], equations: [0, 1], factors: [-2.0, 3.0] };
        let mut equations = EquationSlopes::default();
        equations.begin(2);
        equations.add_steady(&[term], &[5.0, 1.0, 3.0]);
        let (mut x, mut y) = ([Dual::zero()], [Dual::zero()]);
        equations.solve(0, &Triangle, &[0.0; 2], [&mut x, &mut y, &mut []]);
        assert_eq!((y[0].slope, x[0].slope), ([6.0 / 4.0], [(-4.0 - 6.0 / 4.0) / 2.0]));
    }
}
