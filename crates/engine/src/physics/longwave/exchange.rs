//! Exchange of long-wave radiation in an enclosure of grey diffuse surfaces.
//!
//! Sources:
//! - Exchange in an enclosure of grey diffuse surfaces: Hottel & Sarofim (1967), Radiative Transfer, ch. 3.
//! - View factors from areas: the symmetric form of Carroll's mean-radiant-temperature network: Carroll (1980), Energy and
//!   Buildings 3(2), 101-112.
//! - Scaling to given row sums: Sinkhorn & Knopp (1967), Pacific J. Math. 21(2), doi:10.2140/pjm.1967.21.343.

use crate::number::dense::solve_many;
use crate::number::real::Real;

/// Sweeps of the scaling: each halves the imbalance or better; zones reach round-off in about thirty.
const SCALING_SWEEPS: usize = 200;

/// Total exchange areas of a zone [m2], symmetric, diagonal unused:
/// `Q_ij = X_ij (E_i - E_j)` is the net heat from surface i to surface j.
///
/// `weights` holds `A_i F_ij` up to errors of closure; it is scaled symmetrically until every row sums to the
/// surface's area, so that reciprocity and closure hold exactly at the areas of this run.
pub fn exchange_areas<S: Real>(areas: &[S], emissivities: &[S], weights: &[S]) -> Vec<S> {
    let n = areas.len();
    let direct = direct_exchange_areas(areas, weights);
    // Radiosity J: (I - (1 - e) F) J = e E. What i absorbs of the emission of j: X = A e F (I - (1-e) F)^-1 e.
    let mut matrix = vec![S::zero(); n * n];
    let mut right = vec![S::zero(); n * n];
    for i in 0..n {
        for j in 0..n {
            let view = direct[i * n + j] / areas[i];
            let unit = if i == j { S::one() } else { S::zero() };
            matrix[i * n + j] = unit - (S::one() - emissivities[i]) * view;
        }
        right[i * n + i] = emissivities[i];
    }
    solve_many(&mut matrix, &mut right, n);
    let mut exchange = vec![S::zero(); n * n];
    for i in 0..n {
        for j in 0..n {
            let mut arriving = S::zero();
            for k in 0..n {
                arriving += direct[i * n + k] * right[k * n + j];
            }
            exchange[i * n + j] = emissivities[i] * arriving;
        }
    }
    symmetric(&exchange, n)
}

/// Weight with which a surface sees itself: zero, unless it is larger than all others together. Then it has to enclose
/// them (a shell round a body), because the areas close in no other case. For a body and its shell it is exact.
pub fn self_weight<S: Real>(areas: &[S], surface: usize) -> S {
    let others = areas.iter().enumerate().filter(|(i, _)| *i != surface);
    let excess = others.fold(areas[surface], |rest, (_, area)| rest - *area);
    areas[surface] * excess.max(S::zero())
}

/// The mean of a matrix and its transpose: what surface i gives to j is exactly what j receives from i.
fn symmetric<S: Real>(matrix: &[S], n: usize) -> Vec<S> {
    let mut mean = matrix.to_vec();
    for i in 0..n {
        for j in 0..n {
            mean[i * n + j] = (matrix[i * n + j] + matrix[j * n + i]).scale(0.5);
        }
    }
    mean
}

/// Direct exchange areas `A_i F_ij` [m2]: weights scaled by a symmetric diagonal to row sums `areas` (iteration of Sinkhorn &
/// Knopp, with a square root that keeps the symmetry).
pub(crate) fn direct_exchange_areas<S: Real>(areas: &[S], weights: &[S]) -> Vec<S> {
    let n = areas.len();
    let mut scale = vec![S::one(); n];
    for _ in 0..SCALING_SWEEPS {
        let mut next = scale.clone();
        for i in 0..n {
            let mut row = S::zero();
            for j in 0..n {
                row += weights[i * n + j] * scale[j];
            }
            // A surface that sees no other keeps its zero row; its scale would grow without bound.
            let least = S::constant(1e-300);
            let scaled = (scale[i] * areas[i] / row.max(least)).sqrt();
            next[i] = S::select(least.lt(row), scaled, S::one());
        }
        scale = next;
    }
    let mut direct = weights.to_vec();
    for i in 0..n {
        for j in 0..n {
            direct[i * n + j] = scale[i] * weights[i * n + j] * scale[j];
        }
    }
    direct
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two infinite plates: X = A / (1/e1 + 1/e2 - 1).
    #[test]
    fn parallel_plates() {
        let exchange = exchange_areas(&[2.0, 2.0], &[0.9, 0.25], &[0.0, 1.0, 1.0, 0.0]);
        assert!((exchange[1] - 2.0 / (1.0 / 0.9 + 1.0 / 0.25 - 1.0)).abs() < 1e-12);
    }

    /// A body in a shell: 1/X = (1-e1)/(e1 A1) + 1/A1 + (1-e2)/(e2 A2) (Hottel & Sarofim 1967, ch. 3).
    #[test]
    fn body_in_a_shell() {
        for shell in [10.5, 20.0, 400.0] {
            let areas = [10.0, shell];
            let weights =
                [self_weight(&areas, 0), areas[0] * areas[1], areas[0] * areas[1], self_weight(&areas, 1)];
            let exchange = exchange_areas(&areas, &[0.8, 0.3], &weights);
            let expected = 1.0 / (0.2 / 8.0 + 0.1 + 0.7 / (0.3 * shell));
            assert!(
                (exchange[1] / expected - 1.0).abs() < 1e-9,
                "{shell}: {} is not {expected}",
                exchange[1]
            );
        }
    }

    /// In a cube with black walls the exchange area is A F; rows sum to the areas for any emissivities of the rest.
    #[test]
    fn black_enclosure_and_closure() {
        let areas = [9.0, 9.0, 12.0, 12.0, 9.5, 10.0];
        let n = areas.len();
        let weights: Vec<f64> =
            (0..n * n).map(|k| if k / n == k % n { 0.0 } else { areas[k / n] * areas[k % n] }).collect();
        let direct = direct_exchange_areas(&areas, &weights);
        for i in 0..n {
            let row: f64 = (0..n).map(|j| direct[i * n + j]).sum();
            assert!((row / areas[i] - 1.0).abs() < 1e-13);
        }
        let exchange = exchange_areas(&areas, &[1.0; 6], &weights);
        for (x, d) in exchange.iter().zip(&direct) {
            assert!((x - d).abs() < 1e-12);
        }
        // One grey surface among black ones takes exactly e A of black radiation.
        let exchange = exchange_areas(&areas, &[0.3, 1.0, 1.0, 1.0, 1.0, 1.0], &weights);
        let row: f64 = (0..n).map(|j| exchange[j]).sum();
        assert!((row / (0.3 * 9.0) - 1.0).abs() < 1e-12);
    }
}
