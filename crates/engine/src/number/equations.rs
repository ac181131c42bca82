//! Equations at a known solution: from the slopes of the equations to the slopes of the solution.
//!
//! Where equations `r(z, p) = 0` are solved by z, a change dp of the parameters moves the solution by
//! `dz = A^-1 (dr/dp) dp`, `A = -dr/dz` (implicit function theorem). Forward derivatives need for that only the slopes of
//! r at the solution, where z is a constant, and one solve with the factors of the plain matrix A, for all slopes at
//! once. Reverse derivatives keep the terms of r, and solve with the transposed matrix in the reverse pass. No
//! elimination is computed with derivatives.
//!
//! Source: Griewank & Walther (2008), Evaluating Derivatives, 2nd ed., ch. 15, doi:10.1137/1.9780898717761.

use core::fmt::Debug;

use crate::number::real::{Dual, Lanes, Real};

/// A linear system with plain coefficients, factored: the matrix A above. The stepper's plain twin is one.
pub trait LinearSystem {
    /// Replaces the right-hand sides of all equations by their solution. `scratch` is working memory of any size.
    fn solve<R: Real>(&self, rows: &mut [R], scratch: &mut Vec<R>);
}

/// What a kind of number needs to know of the equations of a stage. Plain numbers need nothing.
pub trait Equations<S: Copy>: Clone + Debug + Default + Send + Sync {
    /// Starts with so many equations, all of them empty.
    fn begin(&mut self, equations: usize);

    /// Adds `factor number` to an equation.
    fn add(&mut self, equation: usize, number: S, factor: f64);

    /// Solves the equations of a stage with its factored `system`. `at` is the known solution: the values of the unknowns
    /// of `solution`, which are cells, surfaces and zone airs.
    fn solve<L: LinearSystem>(&mut self, stage: usize, system: &L, at: &[f64], solution: [&mut [S]; 3]);
}

impl<S: Copy + Debug> Equations<S> for () {
    fn begin(&mut self, _equations: usize) {}

    fn add(&mut self, _equation: usize, _number: S, _factor: f64) {}

    fn solve<L: LinearSystem>(&mut self, _stage: usize, _system: &L, _at: &[f64], _solution: [&mut [S]; 3]) {}
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
        self.rows.clear();
        self.rows.resize(equations, Lanes::zero());
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
        let found = self.rows.iter().zip(at);
        for (unknown, (slope, &value)) in solution.into_iter().flatten().zip(found) {
            *unknown = Dual { value, slope: slope.0 };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
}
