//! Exchange of long-wave radiation in an enclosure of grey diffuse surfaces.
//!
//! Sources:
//! - Exchange in an enclosure of grey diffuse surfaces: Hottel & Sarofim (1967), Radiative Transfer, ch. 3.
//! - View factors from areas: the symmetric form of Carroll's mean-radiant-temperature network: Carroll (1980), Energy and
//!   Buildings 3(2), 101-112.
//! - Scaling to given row sums: Sinkhorn & Knopp (1967), Pacific J. Math. 21(2), doi:10.2140/pjm.1967.21.343.

use crate::number::dense::solve_many;
use crate::number::real::{Real, same};

use super::absorption::absorbed;

/// Sweeps of the scaling: each halves the imbalance or better; zones reach round-off in about thirty.
const SCALING_SWEEPS: usize = 200;
/// Rows that are summed up beside each other.
const ROWS: usize = 4;
/// Surfaces from which what they absorb is computed in panels.
const MANY: usize = 64;

/// Total exchange areas of a zone [m2], symmetric, diagonal unused:
/// `Q_ij = X_ij (E_i - E_j)` is the net heat from surface i to surface j.
///
/// `weights` holds `A_i F_ij` up to errors of closure; it is scaled symmetrically until every row sums to the
/// surface's area, so that reciprocity and closure hold exactly at the areas of this run.
///
/// In double precision also where numbers have single precision: scales of a zone whose areas cannot close grow without bound.
pub fn exchange_areas<S: Real>(areas: &[S], emissivities: &[S], weights: &[S]) -> Vec<S> {
    if const { S::SINGLE } {
        let of =
            |lane: usize, numbers: &[S]| numbers.iter().map(|number| number.lane(lane)).collect::<Vec<_>>();
        let of = |lane| exchange_areas(&of(lane, areas), &of(lane, emissivities), &of(lane, weights));
        let found: Vec<Vec<f64>> = (0..S::LANES).map(of).collect();
        return (0..weights.len()).map(|place| S::of_lanes(|lane| found[lane][place])).collect();
    }
    let n = areas.len();
    let direct = direct_exchange_areas(areas, weights);
    let exchange = if n < MANY {
        absorbed_by_few(&direct, areas, emissivities)
    } else {
        absorbed(&direct, areas, emissivities)
    };
    symmetric(&exchange, n)
}

/// What each surface absorbs of the emission of each one [m2], by row.
fn absorbed_by_few<S: Real>(direct: &[S], areas: &[S], emissivities: &[S]) -> Vec<S> {
    let n = areas.len();
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
    exchange
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
    let together = if n < MANY { 1 } else { ROWS };
    let mut scale = vec![S::one(); n];
    for _ in 0..SCALING_SWEEPS {
        let mut next = scale.clone();
        for first in (0..n).step_by(together) {
            let rows = sums_of_rows(weights, &scale, first);
            for (i, &row) in (first..n).zip(&rows).take(together) {
                // A surface that sees no other keeps its zero row; its scale would grow without bound.
                let least = S::constant(1e-300);
                let scaled = (scale[i] * areas[i] / row.max(least)).sqrt();
                next[i] = S::select(least.lt(row), scaled, S::one());
            }
        }
        // All further sweeps would do the same.
        let done = next.iter().zip(&scale).all(|(&new, &old)| same(new, old));
        scale = next;
        if done {
            break;
        }
    }
    let mut direct = weights.to_vec();
    for i in 0..n {
        for j in 0..n {
            direct[i * n + j] = scale[i] * weights[i * n + j] * scale[j];
        }
    }
    direct
}

/// Sums of some rows of weights, each multiplied by the scale of its column.
fn sums_of_rows<S: Real>(weights: &[S], scale: &[S], first: usize) -> [S; ROWS] {
    let n = scale.len();
    let mut sums = [S::zero(); ROWS];
    if n < MANY || first + ROWS > n {
        let rows = if n < MANY { 1 } else { n - first };
        for (row, sum) in weights[first * n..].chunks_exact(n).zip(&mut sums).take(rows) {
            for (&weight, &scale) in row.iter().zip(scale) {
                *sum += weight * scale;
            }
        }
        return sums;
    }
    // Sums that do not wait for each other.
    let rows: [&[S]; ROWS] = core::array::from_fn(|r| &weights[(first + r) * n..(first + r + 1) * n]);
    for (j, &scale) in scale.iter().enumerate() {
        for (sum, row) in sums.iter_mut().zip(rows) {
            *sum += row[j] * scale;
        }
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::dual::Dual;
    use crate::number::simd::{LaneTask, Level, run};

    /// Many surfaces, some of which do not see each other, and a black one.
    fn enclosure<S: Real>(n: usize) -> [Vec<S>; 3] {
        let number = |k: usize| S::constant(((13 * k + 5) % 17) as f64 / 17.0);
        let areas = (0..n).map(|i| S::one() + number(i)).collect::<Vec<_>>();
        let emissivities =
            (0..n).map(|i| if i == 3 { S::one() } else { S::constant(0.05) + number(i).scale(0.9) });
        let sees = |i: usize, j: usize| i != j && i % 6 != j % 6;
        let weight = |k: usize| if sees(k / n, k % n) { number((k / n) * (k % n)) } else { S::zero() };
        let weights = (0..n * n).map(weight).collect::<Vec<_>>();
        let direct = direct_exchange_areas(&areas, &weights);
        [areas, emissivities.collect(), direct]
    }

    /// Numbers of both ways to solve for the radiosities: the same bits.
    fn both<S: Real>() -> Vec<u64> {
        let mut all = Vec::new();
        for n in [6, 31, 64, 70, 101] {
            let [areas, emissivities, direct] = enclosure::<S>(n);
            let few = absorbed_by_few(&direct, &areas, &emissivities);
            let many = absorbed(&direct, &areas, &emissivities);
            for (k, (few, many)) in few.iter().zip(&many).enumerate() {
                let [few, many] = [few, many].map(|number| number.lane(S::LANES - 1).to_bits());
                assert_eq!(few, many, "number {k} of {n} surfaces");
                all.push(few);
            }
        }
        all
    }

    struct Both;

    impl LaneTask for Both {
        type Output = Vec<u64>;
        fn run<S: Real>(self, _: impl Fn(&[f64]) -> S + Copy) -> Vec<u64> {
            both::<S>()
        }
        fn without_lanes(self) -> Vec<u64> {
            both::<f64>()
        }
    }

    #[test]
    fn many_surfaces_have_the_bits_of_few() {
        let plain = both::<f64>();
        assert_eq!(both::<Dual<1>>(), plain);
        for level in Level::available() {
            assert_eq!(run(level, Both), plain, "{level:?}");
        }
    }

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
