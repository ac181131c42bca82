//! Equations at a known solution, and how what parameters do to them becomes what they do to the solution.
//!
//! Where equations `r(z, p) = 0` are solved by z, a change dp of what they are made of moves the solution by
//! `dz = A^-1 (dr/dp) dp`, `A = -dr/dz` (implicit function theorem). Numbers that carry slopes need for that only the
//! slopes of r at the solution, which is a constant there, and one solve with the factors of the plain matrix A, all
//! slopes side by side. Numbers that are gone back along keep what r was made of, and solve with the transposed matrix on
//! the way back. No elimination is done with derivatives.
//!
//! Source: Griewank & Walther (2008), Evaluating Derivatives, 2nd ed., ch. 15, doi:10.1137/1.9780898717761.

use core::fmt::Debug;

use crate::number::real::{Dual, Lanes, Real};
use crate::step::Stepper;

/// What a kind of number gathers of the equations of a stage. Plain numbers gather nothing.
pub trait Residual<S: Copy>: Clone + Debug + Default + Send + Sync {
    /// Begins with equations, one for each unknown.
    fn begin(&mut self, equations: usize);

    /// Adds `factor number` to an equation.
    fn add(&mut self, equation: usize, number: S, factor: f64);

    /// Solves with the factors of a stage's plain `twin`; `at` is the known solution. Unknowns are cells, surfaces and airs.
    fn solve(&mut self, stage: usize, twin: &Stepper<'_, f64>, at: &[f64], solution: [&mut [S]; 3]);
}

impl<S: Copy + Debug> Residual<S> for () {
    fn begin(&mut self, _equations: usize) {}

    fn add(&mut self, _equation: usize, _number: S, _factor: f64) {}

    fn solve(&mut self, _stage: usize, _twin: &Stepper<'_, f64>, _at: &[f64], _solution: [&mut [S]; 3]) {}
}

/// Slopes of equations, then of their solution.
#[derive(Debug, Clone, Default)]
pub struct Slopes<const K: usize> {
    rows: Vec<Lanes<K>>,
    block: Vec<Lanes<K>>,
}

impl<const K: usize> Residual<Dual<K>> for Slopes<K> {
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
    fn solve(&mut self, _stage: usize, twin: &Stepper<'_, f64>, at: &[f64], solution: [&mut [Dual<K>]; 3]) {
        twin.solve_beside(&mut self.rows, &mut self.block);
        let found = self.rows.iter().zip(at);
        for (unknown, (slope, &value)) in solution.into_iter().flatten().zip(found) {
            *unknown = Dual { value, slope: slope.0 };
        }
    }
}
