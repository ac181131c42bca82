//! Elimination of the last rows of the coupled system where all of them meet: a few airs and surfaces, such as those of a building of
//! one or two zones. Their number is a constant of the compiler and the rows are copied out of the sparse matrix, so that neither places nor
//! lengths are looked up. The same operations in the same order as the sparse elimination: the same bits.

use crate::building::pattern::{DENSE, Pattern};
use crate::number::real::Real;

/// Where the entries of the last rows in their columns begin; each row has them without gaps.
#[derive(Debug, Clone)]
pub(super) struct DenseRows {
    starts: Vec<usize>,
    /// The first of the rows.
    first: usize,
}

impl DenseRows {
    /// The rows from `first` on; none where some of them do not meet, or where they are too many.
    pub(super) fn new(pattern: &Pattern, first: usize) -> Option<Self> {
        let count = pattern.size() - first;
        if count == 0 || count > DENSE {
            return None;
        }
        let meets_later = |row: usize| pattern.row(row).later.len() == pattern.size() - 1 - row;
        let rows = first..pattern.size();
        if !rows.clone().all(meets_later) {
            return None;
        }
        Some(Self { starts: rows.map(|row| pattern.row(row).diagonal - (row - first)).collect(), first })
    }

    /// Eliminates the unknowns of the rows and solves for them: matrix and right-hand sides of all rows, which their factors and solution
    /// replace.
    #[inline(always)]
    pub(super) fn solve<S: Real>(&self, matrix: &mut [S], right: &mut [S]) {
        let right = &mut right[self.first..];
        match self.starts.len() {
            1 => solve::<S, 1>(&self.starts, matrix, right),
            2 => solve::<S, 2>(&self.starts, matrix, right),
            3 => solve::<S, 3>(&self.starts, matrix, right),
            4 => solve::<S, 4>(&self.starts, matrix, right),
            5 => solve::<S, 5>(&self.starts, matrix, right),
            _ => solve::<S, DENSE>(&self.starts, matrix, right),
        }
    }
}

/// Gaussian elimination of `N` rows. Pivots are left inverted; what is below them stays.
#[inline(always)]
fn solve<S: Real, const N: usize>(starts: &[usize], matrix: &mut [S], right: &mut [S]) {
    let (Some(starts), Some(right)) = (starts.first_chunk::<N>(), right.first_chunk_mut::<N>()) else {
        return;
    };
    let mut rows = [[S::zero(); N]; N];
    for (row, &start) in rows.iter_mut().zip(starts) {
        row.copy_from_slice(&matrix[start..start + N]);
    }
    for k in 0..N {
        let inverse = S::one() / rows[k][k];
        rows[k][k] = inverse;
        let (pivot, known) = (rows[k], inverse * right[k]);
        for i in k + 1..N {
            let factor = rows[i][k] * inverse;
            for j in k + 1..N {
                rows[i][j] = rows[i][j] - factor * pivot[j];
            }
            right[i] = right[i] - rows[i][k] * known;
        }
    }
    for k in (0..N).rev() {
        let mut sum = right[k];
        for j in k + 1..N {
            sum = sum - rows[k][j] * right[j];
        }
        right[k] = rows[k][k] * sum;
    }
    for (row, &start) in rows.iter().zip(starts) {
        matrix[start..start + N].copy_from_slice(row);
    }
}
