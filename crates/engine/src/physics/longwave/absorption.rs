//! What surfaces absorb of each other's emission, for many surfaces: the radiosities in panels of columns that stay in the cache.
//!
//! The operations are those of [`exchange_areas`](super::exchange_areas), each number in the same order, and so are the bits.

use crate::number::real::{Chunk, ChunkTask, Real};
use crate::number::simd::WIDTH;

/// Registers across a panel.
const PANEL: usize = 4;
/// Rows that are eliminated together.
const ROWS: usize = 4;

/// The numbers from a place on that fill a register.
macro_rules! part {
    ($line:expr, $start:expr) => {
        V::load(&$line[$start..$start + S::CHUNK])
    };
}

/// What each surface absorbs of the emission of each one [m2], by row: `X = e A F (I - (1 - e) F)^-1 e` with `A F` given as
/// `direct`.
pub(super) fn absorbed<S: Real>(direct: &[S], areas: &[S], emissivities: &[S]) -> Vec<S> {
    S::vectorised(
        #[inline(always)]
        || S::in_chunks(Absorbed { direct, areas, emissivities }),
    )
}

struct Absorbed<'a, S> {
    direct: &'a [S],
    areas: &'a [S],
    emissivities: &'a [S],
}

impl<S: Real> ChunkTask<S> for Absorbed<'_, S> {
    type Output = Vec<S>;
    #[inline(always)]
    fn run<V: Chunk<S>>(self) -> Vec<S> {
        let n = self.areas.len();
        let factors = self.factors::<V>();
        let mut absorbed = vec![S::zero(); n * n];
        let width = PANEL * S::CHUNK;
        let mut panel = vec![S::zero(); n * width];
        for first in (0..n).step_by(width) {
            panel.fill(S::zero());
            for j in first..n.min(first + width) {
                panel[j * width + j - first] = self.emissivities[j];
            }
            solve::<S, V>(&factors, &mut panel, first);
            for i in 0..n {
                let mut sums = [V::zero(); PANEL];
                for (&view, row) in self.direct[i * n..(i + 1) * n].iter().zip(panel.chunks_exact(width)) {
                    let view = V::filled(view);
                    for (c, sum) in sums.iter_mut().enumerate() {
                        *sum += view * part!(row, c * S::CHUNK);
                    }
                }
                let mut arriving = [S::zero(); PANEL * WIDTH];
                for (c, sum) in sums.into_iter().enumerate() {
                    (V::filled(self.emissivities[i]) * sum).store(&mut arriving[c * S::CHUNK..]);
                }
                let count = width.min(n - first);
                absorbed[i * n + first..i * n + first + count].copy_from_slice(&arriving[..count]);
            }
        }
        absorbed
    }
}

/// Triangular factors of a matrix: the upper one, and left of the diagonal what each row was multiplied with.
struct Factors<S> {
    rows: Vec<S>,
    stride: usize,
    /// Number of rows.
    count: usize,
}

impl<S: Real> Absorbed<'_, S> {
    /// Eliminates the matrix of the radiosities, some rows at a time.
    #[inline(always)]
    fn factors<V: Chunk<S>>(&self) -> Factors<S> {
        let n = self.areas.len();
        let stride = n.next_multiple_of(S::CHUNK);
        let mut rows = vec![S::zero(); n * stride];
        for (i, row) in rows.chunks_exact_mut(stride).enumerate() {
            for (j, entry) in row.iter_mut().enumerate().take(n) {
                let view = self.direct[i * n + j] / self.areas[i];
                let unit = if i == j { S::one() } else { S::zero() };
                *entry = unit - (S::one() - self.emissivities[i]) * view;
            }
        }
        let mut inverses = Vec::with_capacity(n);
        for first in (0..n).step_by(ROWS) {
            let (above, block) = rows.split_at_mut(first * stride);
            let block = &mut block[..(n - first).min(ROWS) * stride];
            for (k, (above, &inverse)) in above.chunks_exact(stride).zip(&inverses).enumerate() {
                for row in block.chunks_exact_mut(stride) {
                    subtract::<S, V>(row, above, k, inverse);
                }
            }
            for i in 0..block.len() / stride {
                let (before, row) = block.split_at_mut(i * stride);
                let row = &mut row[..stride];
                for (k, above) in (first..).zip(before.chunks_exact(stride)) {
                    subtract::<S, V>(row, above, k, inverses[k]);
                }
                inverses.push(S::one() / row[first + i]);
            }
        }
        Factors { rows, stride, count: n }
    }
}

/// Subtracts a row above from a row, and leaves there what it was multiplied with.
#[inline(always)]
fn subtract<S: Real, V: Chunk<S>>(row: &mut [S], above: &[S], k: usize, inverse: S) {
    let factor = row[k] * inverse;
    let filled = V::filled(factor);
    // The register of the pivot itself number by number.
    let whole = (k + 1).next_multiple_of(S::CHUNK).min(row.len());
    for (entry, &above) in row[k + 1..whole].iter_mut().zip(&above[k + 1..whole]) {
        *entry = *entry - factor * above;
    }
    for start in (whole..row.len()).step_by(S::CHUNK) {
        let entry: V = part!(row, start) - filled * part!(above, start);
        entry.store(&mut row[start..start + S::CHUNK]);
    }
    row[k] = factor;
}

/// Solves for some columns, which are zero above a row.
#[inline(always)]
fn solve<S: Real, V: Chunk<S>>(factors: &Factors<S>, panel: &mut [S], first: usize) {
    let (n, stride, width) = (factors.count, factors.stride, PANEL * S::CHUNK);
    for i in first..n {
        let (above, row) = panel.split_at_mut(i * width);
        let multiples = &factors.rows[i * stride + first..i * stride + i];
        reduce::<S, V>(&mut row[..width], multiples, &above[first * width..]);
    }
    for i in (0..n).rev() {
        let (row, below) = panel[i * width..].split_at_mut(width);
        reduce::<S, V>(row, &factors.rows[i * stride + i + 1..i * stride + n], below);
        let pivot = V::filled(factors.rows[i * stride + i]);
        for start in (0..width).step_by(S::CHUNK) {
            (part!(row, start) / pivot).store(&mut row[start..start + S::CHUNK]);
        }
    }
}

/// Subtracts multiples of other rows of a panel from one.
#[inline(always)]
fn reduce<S: Real, V: Chunk<S>>(row: &mut [S], multiples: &[S], others: &[S]) {
    let mut sums: [V; PANEL] = core::array::from_fn(
        #[inline(always)]
        |c| part!(row, c * S::CHUNK),
    );
    for (&multiple, other) in multiples.iter().zip(others.chunks_exact(PANEL * S::CHUNK)) {
        let multiple = V::filled(multiple);
        for (c, sum) in sums.iter_mut().enumerate() {
            *sum = *sum - multiple * part!(other, c * S::CHUNK);
        }
    }
    for (c, sum) in sums.into_iter().enumerate() {
        sum.store(&mut row[c * S::CHUNK..(c + 1) * S::CHUNK]);
    }
}
