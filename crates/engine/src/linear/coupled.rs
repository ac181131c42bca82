//! The linear system of airs and of the surfaces that zones share, which walls and zones are eliminated onto.

use core::ops::Range;

use crate::number::real::Real;

/// The system of zone surfaces and airs. Its matrix is an M-matrix: no pivoting.
///
/// The first unknowns are the surfaces of walls of constant properties. As long as nothing that enters their rows changes
/// they stay eliminated, and only the rest is entered and solved again.
#[derive(Debug, Clone)]
pub(crate) struct CoupledSystem<'a, S> {
    /// For each row the later ones that it meets, see [`Plan::reach`](crate::building::plan::Plan::reach).
    reach: &'a [Vec<Range<usize>>],
    /// Number of rows before all of them, see [`Plan::own_rows`](crate::building::plan::Plan::own_rows).
    before: usize,
    /// Number of the first unknowns, see [`Plan::constant_rows`](crate::building::plan::Plan::constant_rows).
    first: usize,
    matrix: Vec<S>,
    /// Right-hand sides, then the solution, of all rows.
    pub(crate) right: Vec<S>,
    /// What eliminating the first unknowns leaves of the others' matrix, and all right-hand sides.
    kept: Vec<S>,
    kept_right: Vec<S>,
}

impl<'a, S: Real> CoupledSystem<'a, S> {
    pub(crate) fn new(reach: &'a [Vec<Range<usize>>], before: usize, first: usize) -> Self {
        let size = reach.len();
        let (all, line) = (vec![S::zero(); size * size], vec![S::zero(); size]);
        let right = vec![S::zero(); before + size];
        Self { reach, before, first, kept: all.clone(), matrix: all, kept_right: line, right }
    }

    #[inline(always)]
    pub(crate) fn clear_matrix(&mut self) {
        self.matrix.fill(S::zero());
    }

    #[inline(always)]
    pub(crate) fn clear_right(&mut self) {
        self.right[self.before..].fill(S::zero());
    }

    #[inline(always)]
    pub(crate) fn add(&mut self, row: usize, column: usize, value: S) {
        self.matrix[(row - self.before) * self.reach.len() + column - self.before] += value;
    }

    /// A conductance between two unknowns.
    #[inline(always)]
    pub(crate) fn couple(&mut self, a: usize, b: usize, conductance: S) {
        self.add(a, a, conductance);
        self.add(b, b, conductance);
        self.add(a, b, -conductance);
        self.add(b, a, -conductance);
    }

    /// Eliminates the first unknowns from the matrix, once it holds all that enters their rows.
    #[inline(always)]
    pub(crate) fn keep_matrix(&mut self) {
        self.eliminate(0..self.first);
        let start = self.first * self.reach.len();
        self.kept[start..].copy_from_slice(&self.matrix[start..]);
    }

    /// Eliminates them from the right-hand side.
    #[inline(always)]
    pub(crate) fn keep_right(&mut self) {
        forward(self.reach, &self.matrix, &mut self.right[self.before..], 0..self.first);
        self.kept_right.copy_from_slice(&self.right[self.before..]);
    }

    /// Goes back to where the first unknowns have been eliminated and nothing else has been entered.
    #[inline(always)]
    pub(crate) fn begin(&mut self) {
        let start = self.first * self.reach.len();
        self.matrix[start..].copy_from_slice(&self.kept[start..]);
        self.right[self.before..].copy_from_slice(&self.kept_right);
    }

    /// Solves for the other unknowns; they replace their right-hand sides.
    #[inline(always)]
    pub(crate) fn solve_rest(&mut self) {
        let rest = self.first..self.reach.len();
        self.eliminate(rest.clone());
        let right = &mut self.right[self.before..];
        forward(self.reach, &self.matrix, right, rest.clone());
        back(self.reach, &self.matrix, right, rest);
    }

    /// Solves for the first unknowns, once the others are known.
    #[inline(always)]
    pub(crate) fn solve_first(&mut self) {
        back(self.reach, &self.matrix, &mut self.right[self.before..], 0..self.first);
    }

    /// The solution for another right-hand side, with the factors in hand.
    #[inline(always)]
    pub(crate) fn solve_again(&self, right: &mut [S]) {
        let (right, all) = (&mut right[self.before..], 0..self.reach.len());
        forward(self.reach, &self.matrix, right, all.clone());
        back(self.reach, &self.matrix, right, all);
    }

    /// Gaussian elimination of what is not zero. Pivots are left inverted; what is below them stays.
    #[inline(always)]
    fn eliminate(&mut self, rows: Range<usize>) {
        let n = self.reach.len();
        for k in rows {
            let reach = &self.reach[k];
            let (upper, lower) = self.matrix.split_at_mut((k + 1) * n);
            let pivot = &mut upper[k * n..];
            let inverse = S::one() / pivot[k];
            pivot[k] = inverse;
            for later in reach {
                let later = &mut lower[(later.start - k - 1) * n..(later.end - k - 1) * n];
                for row in later.chunks_exact_mut(n) {
                    let factor = row[k] * inverse;
                    for run in reach {
                        for (a, &p) in row[run.clone()].iter_mut().zip(&pivot[run.clone()]) {
                            *a = *a - factor * p;
                        }
                    }
                }
            }
        }
    }
}

impl CoupledSystem<'_, f64> {
    /// The solution for right-hand sides of another kind of number, with the factors in hand.
    #[inline(always)]
    pub(crate) fn solve_beside<R: Real>(&self, right: &mut [R]) {
        let (right, n) = (&mut right[self.before..], self.reach.len());
        for k in 0..n {
            let known = right[k].scale(self.matrix[k * n + k]);
            for row in self.reach[k].iter().cloned().flatten() {
                right[row] = right[row] - known.scale(self.matrix[row * n + k]);
            }
        }
        for k in (0..n).rev() {
            let line = &self.matrix[k * n..(k + 1) * n];
            let mut sum = right[k];
            for column in self.reach[k].iter().cloned().flatten() {
                sum = sum - right[column].scale(line[column]);
            }
            right[k] = sum.scale(line[k]);
        }
    }

    /// The solution of the transposed system, with the factors in hand.
    #[inline(always)]
    pub(crate) fn solve_transposed(&self, right: &mut [f64]) {
        let (right, n) = (&mut right[self.before..], self.reach.len());
        for k in 0..n {
            let line = &self.matrix[k * n..(k + 1) * n];
            let weight = right[k] * line[k];
            right[k] = weight;
            for run in &self.reach[k] {
                for (later, &factor) in right[run.clone()].iter_mut().zip(&line[run.clone()]) {
                    *later -= factor * weight;
                }
            }
        }
        for k in (0..n).rev() {
            let mut sum = 0.0;
            for row in self.reach[k].iter().cloned().flatten() {
                sum += self.matrix[row * n + k] * right[row];
            }
            right[k] -= self.matrix[k * n + k] * sum;
        }
    }
}

/// The right-hand side through the elimination of some unknowns.
#[inline(always)]
fn forward<S: Real>(reach: &[Vec<Range<usize>>], matrix: &[S], right: &mut [S], rows: Range<usize>) {
    let n = reach.len();
    for k in rows {
        let known = right[k] * matrix[k * n + k];
        for run in &reach[k] {
            for row in run.clone() {
                right[row] = right[row] - matrix[row * n + k] * known;
            }
        }
    }
}

/// From the last unknown to the first.
#[inline(always)]
fn back<S: Real>(reach: &[Vec<Range<usize>>], matrix: &[S], right: &mut [S], rows: Range<usize>) {
    let n = reach.len();
    for k in rows.rev() {
        let row = &matrix[k * n..(k + 1) * n];
        let mut sum = right[k];
        for run in &reach[k] {
            for (&a, &x) in row[run.clone()].iter().zip(&right[run.clone()]) {
                sum = sum - a * x;
            }
        }
        right[k] = sum * row[k];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Five unknowns, three of them first; the last couples of the others change and are solved again.
    #[test]
    fn the_rest_is_solved_again() {
        let reach = vec![vec![1..2, 3..4], vec![2..5], vec![3..5], vec![4..5], vec![]];
        let mut block: CoupledSystem<'_, f64> = CoupledSystem::new(&reach, 0, 3);
        let couples = [(0, 1, 2.0), (0, 3, 1.0), (1, 2, 0.5), (1, 4, 3.0), (2, 4, 1.5)];
        let held = [1.0, 0.5, 2.0, 0.0, 0.1];
        let enter = |block: &mut CoupledSystem<'_, f64>| {
            for (a, b, conductance) in couples {
                block.couple(a, b, conductance);
            }
            for (row, held) in held.into_iter().enumerate() {
                block.add(row, row, held);
                block.right[row] = held * 20.0 + 5.0;
            }
        };
        block.clear_matrix();
        block.clear_right();
        enter(&mut block);
        block.keep_matrix();
        block.keep_right();
        for last in [0.2, 4.0, 1.0] {
            block.begin();
            block.couple(3, 4, last);
            block.right[4] += 7.0;
            block.solve_rest();
            block.solve_first();
            let found = block.right.clone();
            // Residual of the whole system, entered anew.
            let mut whole: CoupledSystem<'_, f64> = CoupledSystem::new(&reach, 0, 3);
            enter(&mut whole);
            whole.couple(3, 4, last);
            whole.right[4] += 7.0;
            for row in 0..5 {
                let sum: f64 =
                    whole.matrix[5 * row..5 * (row + 1)].iter().zip(&found).map(|(a, x)| a * x).sum();
                assert!((sum - whole.right[row]).abs() < 1e-12, "row {row} at {last}");
            }
            let mut again = whole.right.clone();
            block.solve_again(&mut again);
            assert!(again.iter().zip(&found).all(|(a, b)| (a - b).abs() < 1e-12), "solved again at {last}");
        }
    }

    /// Numbers that follow no rule, between 0 and 1.
    fn numbers() -> impl FnMut() -> f64 {
        let mut state = 1_u32;
        move || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(state >> 8) / f64::from(1_u32 << 24)
        }
    }

    /// `w . (A^-1 b) = (A^-T w) . b` with the factors of random M-matrices that are not symmetric.
    #[test]
    fn the_transpose_is_the_transpose() {
        const N: usize = 7;
        let mut next = numbers();
        let reach: Vec<Vec<Range<usize>>> =
            (0..N).map(|k| Vec::from_iter((k + 1 < N).then_some(k + 1..N))).collect();
        for first in [0, 3, N] {
            let mut block: CoupledSystem<'_, f64> = CoupledSystem::new(&reach, 0, first);
            block.clear_matrix();
            block.clear_right();
            let mut whole = [[0.0; N]; N];
            for row in 0..N {
                for column in (0..N).filter(|&column| column != row) {
                    let (gain, held) = (next(), next());
                    whole[row][column] = -gain;
                    // Columns that sum up to more than nothing make an M-matrix.
                    whole[column][column] += gain + 0.1 * held;
                }
            }
            for (row, line) in whole.iter().enumerate() {
                for (column, &value) in line.iter().enumerate() {
                    block.add(row, column, value);
                }
            }
            block.keep_matrix();
            block.keep_right();
            block.begin();
            block.solve_rest();
            let right: [f64; N] = core::array::from_fn(|_| next());
            let weights: [f64; N] = core::array::from_fn(|_| next());
            let (mut solution, mut back) = (right, weights);
            block.solve_beside(&mut solution);
            block.solve_transposed(&mut back);
            for (line, right) in whole.iter().zip(right) {
                let sum: f64 = line.iter().zip(solution).map(|(a, x)| a * x).sum();
                assert!((sum - right).abs() < 1e-12, "{sum} is not {right}");
            }
            let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
            let (forth, back) = (dot(&weights, &solution), dot(&back, &right));
            assert!((forth - back).abs() < 1e-12 * forth.abs(), "{forth} is not {back}");
        }
    }
}
