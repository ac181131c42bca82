//! Conjugate gradients for the surfaces of a large zone: work that grows with the square of their number.
//!
//! The matrix is `G + D`, with exchange areas `G` that never change, symmetric and dense, and a diagonal `D` that changes in
//! each iteration. Scaled by its own diagonal it is nearly the unit matrix: an exchange area is an integral over views, most of
//! which are alike, so that few eigenvalues are far from one. Nothing is kept from one solution to the next: a solution depends
//! on its own equations alone, and so do its bits.
//!
//! Source: Hestenes & Stiefel (1952), J. Res. Nat. Bur. Standards 49(6), 409-436, doi:10.6028/jres.049.044.

use crate::number::dense::solve_many;
use crate::number::real::{ByPrecision, Chunk, ChunkTask, Mask, Real};
use crate::number::simd::WIDTH;

/// Squared norm of the residual, relative to that of the right-hand side, at which a solution is accepted: round-off.
const ROUND_OFF: ByPrecision = ByPrecision { double: 1e-32, single: 1e-14 };
/// Iterations that are always allowed; then as many as half of the unknowns before the equations are eliminated instead.
const LEAST_ITERATIONS: usize = 100;
/// Right-hand sides that are solved together: the matrix is read once for all of them.
const TOGETHER: usize = 2;
/// Rows of the matrix that are read together.
const ROWS: usize = 4;

/// Symmetric positive definite equations.
#[derive(Debug, Clone, Copy)]
pub(super) struct Symmetric<'m, S> {
    /// Rows of the constant part, and the numbers in each.
    pub(super) rows: &'m [S],
    pub(super) stride: usize,
    /// What its diagonal has beside it.
    pub(super) diagonal: &'m [S],
    /// Number of unknowns.
    pub(super) unknowns: usize,
}

/// Numbers in a line of unknowns: zeros fill it up to whole registers.
pub(super) fn length_of_line(unknowns: usize) -> usize {
    unknowns.next_multiple_of(WIDTH)
}

impl<S: Real> Symmetric<'_, S> {
    /// Replaces right-hand sides, in lines one after the other, by their solutions.
    // One copy for each kind of number, with its wide instructions. Numbers with derivatives are eliminated.
    #[inline(never)]
    pub(super) fn solve(&self, lines: &mut [S]) {
        if const { S::DERIVATIVES } {
            return;
        }
        self.solve_within(lines, LEAST_ITERATIONS.max(self.unknowns / 2));
    }

    /// The same; what takes more than some iterations is eliminated.
    pub(super) fn solve_within(&self, lines: &mut [S], most: usize) {
        for lines in lines.chunks_mut(TOGETHER * length_of_line(self.unknowns)) {
            let given = lines.to_vec();
            let open = S::vectorised(
                #[inline(always)]
                || S::in_chunks(Iterate { matrix: self, lines: &mut *lines, most }),
            );
            if open.iter().any(|open| open.any()) {
                self.eliminate(&given, lines, &open);
            }
        }
    }

    /// Solves the lines that are open by elimination, in the lanes in which they are.
    #[cold]
    fn eliminate(&self, given: &[S], lines: &mut [S], open: &[S::Mask]) {
        let (n, line) = (self.unknowns, length_of_line(self.unknowns));
        for ((given, solution), &open) in given.chunks(line).zip(lines.chunks_mut(line)).zip(open) {
            let mut matrix: Vec<S> =
                self.rows.chunks(self.stride).take(n).flat_map(|row| &row[..n]).copied().collect();
            for (i, &more) in self.diagonal.iter().enumerate().take(n) {
                matrix[i * n + i] += more;
            }
            let mut right = given[..n].to_vec();
            solve_many(&mut matrix, &mut right, 1);
            for (mine, &found) in solution.iter_mut().zip(&right) {
                *mine = S::select(open, found, *mine);
            }
        }
    }
}

/// Conjugate gradients for some right-hand sides. Gives where they are not solved.
struct Iterate<'i, S> {
    matrix: &'i Symmetric<'i, S>,
    lines: &'i mut [S],
    most: usize,
}

impl<S: Real> ChunkTask<S> for Iterate<'_, S> {
    type Output = Vec<S::Mask>;
    #[inline(always)]
    fn run<V: Chunk<S>>(self) -> Vec<S::Mask> {
        let line = length_of_line(self.matrix.unknowns);
        if self.lines.len() == TOGETHER * line {
            return iterate::<S, V, TOGETHER>(self.matrix, self.lines, self.most).to_vec();
        }
        iterate::<S, V, 1>(self.matrix, self.lines, self.most).to_vec()
    }
}

/// A right-hand side while it is solved: what is left of it, weighted with the diagonal.
#[derive(Clone, Copy)]
struct Progress<S: Real> {
    left: S,
    accepted: S,
    open: S::Mask,
}

/// Conjugate gradients, preconditioned with the diagonal. A line that is solved, in a lane, keeps its bits.
#[inline(always)]
fn iterate<S: Real, V: Chunk<S>, const K: usize>(
    matrix: &Symmetric<'_, S>,
    solutions: &mut [S],
    most: usize,
) -> [S::Mask; K] {
    let line = length_of_line(matrix.unknowns);
    let mut inverse = vec![S::zero(); line];
    for (i, inverse) in inverse.iter_mut().enumerate().take(matrix.unknowns) {
        *inverse = S::one() / (matrix.rows[i * matrix.stride + i] + matrix.diagonal[i]);
    }
    let mut residuals = solutions.to_vec();
    solutions.fill(S::zero());
    let mut directions = vec![S::zero(); K * line];
    let mut products = vec![S::zero(); K * line];
    let mut progress = [Progress { left: S::one(), accepted: S::zero(), open: S::Mask::splat(true) }; K];
    for (k, progress) in progress.iter_mut().enumerate() {
        let lines = k * line..(k + 1) * line;
        let (residual, direction) = (&residuals[lines.clone()], &mut directions[lines]);
        progress.left = turn::<S, V>(residual, &inverse, direction, |_| S::zero());
        progress.accepted = progress.left.scale(ROUND_OFF.of::<S>());
        progress.open = progress.accepted.lt(progress.left);
    }
    for _ in 0..most {
        if !progress.iter().any(|progress| progress.open.any()) {
            break;
        }
        multiply::<S, V, K>(matrix, &directions, &mut products);
        for (k, progress) in progress.iter_mut().enumerate() {
            let lines = k * line..(k + 1) * line;
            let (direction, product) = (&mut directions[lines.clone()], &products[lines.clone()]);
            let (solution, residual) = (&mut solutions[lines.clone()], &mut residuals[lines]);
            let step = progress.left / sum_of_products::<S, V>(direction, product);
            let step = S::select(progress.open, step, S::zero());
            advance::<S, V>(step, [direction, product], [solution, residual]);
            let before = progress.left;
            let open = progress.open;
            progress.left = turn::<S, V>(
                residual,
                &inverse,
                direction,
                #[inline(always)]
                |left| S::select(open, left / before, S::zero()),
            );
            progress.open = open & progress.accepted.lt(progress.left);
        }
    }
    progress.map(|progress| progress.open)
}

/// Turns a direction towards a residual, by a factor of what is left of it. Returns what is left.
#[inline(always)]
fn turn<S: Real, V: Chunk<S>>(
    residual: &[S],
    inverse: &[S],
    direction: &mut [S],
    factor: impl Fn(S) -> S,
) -> S {
    let left = sum::<S, V>(
        residual.len(),
        #[inline(always)]
        |start| {
            let residual: V = part!(residual, start);
            residual * residual * part!(inverse, start)
        },
    );
    let factor = V::filled(factor(left));
    for start in (0..residual.len()).step_by(S::CHUNK) {
        let scaled: V = part!(residual, start) * part!(inverse, start);
        (scaled + factor * part!(direction, start)).store(&mut direction[start..start + S::CHUNK]);
    }
    left
}

/// Moves a solution along a direction, and its residual along the product of the matrix with it.
#[inline(always)]
fn advance<S: Real, V: Chunk<S>>(
    step: S,
    [direction, product]: [&[S]; 2],
    [solution, residual]: [&mut [S]; 2],
) {
    let step = V::filled(step);
    for start in (0..direction.len()).step_by(S::CHUNK) {
        let places = start..start + S::CHUNK;
        (part!(solution, start) + step * part!(direction, start)).store(&mut solution[places.clone()]);
        (part!(residual, start) - step * part!(product, start)).store(&mut residual[places]);
    }
}

#[inline(always)]
fn sum_of_products<S: Real, V: Chunk<S>>(a: &[S], b: &[S]) -> S {
    sum::<S, V>(
        a.len(),
        #[inline(always)]
        |start| -> V { part!(a, start) * part!(b, start) },
    )
}

/// Sum of some terms: eight partial sums, which any number has, in lanes or alone.
#[inline(always)]
fn sum<S: Real, V: Chunk<S>>(count: usize, term: impl Fn(usize) -> V) -> S {
    let mut parts = [S::zero(); WIDTH];
    for block in (0..count).step_by(WIDTH) {
        for place in (0..WIDTH).step_by(S::CHUNK) {
            let sum: V = part!(parts, place) + term(block + place);
            sum.store(&mut parts[place..place + S::CHUNK]);
        }
    }
    parts.into_iter().fold(S::zero(), |sum, part| sum + part)
}

/// Products of the matrix with some lines. Each number is a sum over the rows in their order.
#[inline(always)]
fn multiply<S: Real, V: Chunk<S>, const K: usize>(
    matrix: &Symmetric<'_, S>,
    lines: &[S],
    products: &mut [S],
) {
    let (n, line) = (matrix.unknowns, length_of_line(matrix.unknowns));
    for k in 0..K {
        for start in (0..n).step_by(S::CHUNK) {
            let at = k * line + start;
            let product: V = part!(matrix.diagonal, start) * part!(lines, at);
            product.store(&mut products[at..at + S::CHUNK]);
        }
    }
    let mut first = 0;
    while first + ROWS <= n {
        add_rows::<S, V, K, ROWS>(matrix, first, lines, products);
        first += ROWS;
    }
    for row in first..n {
        add_rows::<S, V, K, 1>(matrix, row, lines, products);
    }
}

/// Adds what some rows, which by symmetry are columns, contribute to the products.
#[inline(always)]
fn add_rows<S: Real, V: Chunk<S>, const K: usize, const R: usize>(
    matrix: &Symmetric<'_, S>,
    first: usize,
    lines: &[S],
    products: &mut [S],
) {
    let (n, line, stride) = (matrix.unknowns, length_of_line(matrix.unknowns), matrix.stride);
    let rows: [&[S]; R] = core::array::from_fn(
        #[inline(always)]
        |r| &matrix.rows[(first + r) * stride..(first + r + 1) * stride],
    );
    let factors: [[V; R]; K] = core::array::from_fn(
        #[inline(always)]
        |k| {
            core::array::from_fn(
                #[inline(always)]
                |r| V::filled(lines[k * line + first + r]),
            )
        },
    );
    for start in (0..n).step_by(S::CHUNK) {
        let entries: [V; R] = core::array::from_fn(
            #[inline(always)]
            |r| part!(rows[r], start),
        );
        for (k, factors) in factors.iter().enumerate() {
            let at = k * line + start;
            let mut sum: V = part!(products, at);
            for (&entry, &factor) in entries.iter().zip(factors) {
                sum += entry * factor;
            }
            sum.store(&mut products[at..at + S::CHUNK]);
        }
    }
}
