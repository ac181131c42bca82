//! What the tests of linear systems share: random numbers, and a dense solver that is as simple as can be.

use crate::number::real::Real;

/// Random numbers, the same in every run (a linear congruential generator, Knuth's MMIX).
pub(super) struct Numbers(u64);

impl Numbers {
    pub(super) fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// The next number between 0.1 and 1.1.
    pub(super) fn next<S: Real>(&mut self) -> S {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        S::constant(0.1 + (self.0 >> 40) as f64 / (1u64 << 24) as f64)
    }

    /// Some of them, less 0.6: of both signs.
    pub(super) fn line(&mut self, count: usize) -> Vec<f64> {
        (0..count).map(|_| self.next::<f64>() - 0.6).collect()
    }
}

/// Solution of `matrix x = right`, row by row, by Gauss-Jordan elimination with the largest pivot of each column.
pub(super) fn dense_solution(matrix: &[f64], right: &[f64]) -> Vec<f64> {
    let n = right.len();
    let mut rows: Vec<Vec<f64>> =
        (0..n).map(|i| [&matrix[i * n..(i + 1) * n], &[right[i]]].concat()).collect();
    for k in 0..n {
        let pivot = (k..n).max_by(|&a, &b| rows[a][k].abs().total_cmp(&rows[b][k].abs())).unwrap();
        rows.swap(k, pivot);
        let row = rows[k].clone();
        for (_, other) in rows.iter_mut().enumerate().filter(|(i, _)| *i != k) {
            let factor = other[k] / row[k];
            other.iter_mut().zip(&row).for_each(|(a, p)| *a -= factor * p);
        }
    }
    rows.iter().enumerate().map(|(i, row)| row[n] / row[i]).collect()
}

pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Fails where two lists differ by more than a tolerance times the largest number of the second.
pub(super) fn close(found: &[f64], expected: &[f64], tolerance: f64, context: &str) {
    assert_eq!(found.len(), expected.len(), "{context}");
    let size = expected.iter().fold(1.0, |size: f64, x| size.max(x.abs()));
    for (i, (found, expected)) in found.iter().zip(expected).enumerate() {
        assert!((found - expected).abs() <= tolerance * size, "{context}, {i}: {found} is not {expected}");
    }
}

/// `w . (A x) = (A^T w) . x`, given both products.
pub(super) fn adjoint(forward: (&[f64], &[f64]), back: (&[f64], &[f64]), context: &str) {
    let (forth, back) = (dot(forward.0, forward.1), dot(back.0, back.1));
    assert!((forth - back).abs() < 1e-12 * (1.0 + forth.abs()), "{context}: {forth} is not {back}");
}
