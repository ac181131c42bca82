//! Dense linear systems: Gaussian elimination without pivoting, the engine's only solver of such systems beside the fronts of
//! zones, which are symmetric.
//!
//! Pivots are taken in the order of the rows, which keeps the order of all operations independent of the values: every
//! lane of a pack computes the bits that it computes alone. This is safe where all leading principal minors are positive: for
//! diagonally dominant matrices (exchange of radiation, surfaces of a linear model), for M-matrices and for the inverses of
//! M-matrices (responses of airs to loads).

use core::convert::Infallible;

use super::real::Real;

/// Solves `matrix X = right` in place for `width` right-hand sides.
///
/// The matrix is square, and both arguments are stored row by row. `right` becomes the solution, `matrix` its upper triangular factor
/// (with what the elimination leaves below the diagonal).
#[inline(always)]
pub(crate) fn solve_many<S: Real>(matrix: &mut [S], right: &mut [S], width: usize) {
    let Ok(()) = solve_many_while(|| Ok::<(), Infallible>(()), matrix, right, width);
}

/// The same for as long as `proceed`, asked before each row, allows it.
///
/// # Errors
/// That of `proceed`: both arguments then have no meaning any more.
#[inline(always)]
pub(crate) fn solve_many_while<S: Real, E>(
    proceed: impl Fn() -> Result<(), E>,
    matrix: &mut [S],
    right: &mut [S],
    width: usize,
) -> Result<(), E> {
    let n = right.len() / width;
    for k in 0..n {
        proceed()?;
        let inverse = S::one() / matrix[k * n + k];
        for i in k + 1..n {
            let factor = matrix[i * n + k] * inverse;
            for j in k + 1..n {
                matrix[i * n + j] = matrix[i * n + j] - factor * matrix[k * n + j];
            }
            for j in 0..width {
                right[i * width + j] = right[i * width + j] - factor * right[k * width + j];
            }
        }
    }
    for k in (0..n).rev() {
        proceed()?;
        for j in 0..width {
            let mut sum = right[k * width + j];
            for i in k + 1..n {
                sum = sum - matrix[k * n + i] * right[i * width + j];
            }
            right[k * width + j] = sum / matrix[k * n + k];
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `[[4, 1], [2, 5]]` has the inverse `[[5, -1], [-2, 4]]/18`.
    #[test]
    fn an_inverse_by_hand() {
        let (mut matrix, mut right) = ([4.0, 1.0, 2.0, 5.0], [1.0, 0.0, 0.0, 1.0]);
        solve_many(&mut matrix, &mut right, 2);
        for (found, expected) in right.iter().zip([5.0, -1.0, -2.0, 4.0]) {
            assert!((found - expected / 18.0).abs() < 1e-15, "{found} is not {expected}/18");
        }
    }

    /// The product of a diagonally dominant matrix and the solution gives the right-hand sides again; each right-hand side
    /// has the bits that it has alone.
    #[test]
    fn the_solution_satisfies_the_equations() {
        let number = |k: usize| ((13 * k + 5) % 17) as f64 / 17.0;
        for (n, width) in (1..=40).map(|n| (n, [n, 1, 3][n % 3])) {
            let entry = |k: usize| if k / n == k % n { 0.5 + n as f64 } else { -number(k) };
            let matrix: Vec<f64> = (0..n * n).map(entry).collect();
            let right: Vec<f64> = (0..n * width).map(|k| number(3 * k + 1)).collect();
            let (mut factor, mut solution) = (matrix.clone(), right.clone());
            solve_many(&mut factor, &mut solution, width);
            for j in 0..width {
                let column =
                    |all: &[f64]| -> Vec<f64> { all.iter().skip(j).step_by(width).copied().collect() };
                let (expected, found) = (column(&right), column(&solution));
                for (row, expected) in matrix.chunks(n).zip(&expected) {
                    let product: f64 = row.iter().zip(&found).map(|(a, x)| a * x).sum();
                    assert!((product - expected).abs() < 1e-14, "{n} rows: {product} is not {expected}");
                }
                let mut alone = expected;
                solve_many(&mut matrix.clone(), &mut alone, 1);
                assert_eq!(alone, found, "bits of column {j} of {n} rows");
            }
        }
    }

    /// Symmetric positive matrices need no dominance: the Hilbert matrix of 4 rows, and its inverse by hand.
    #[test]
    fn positive_minors_are_enough() {
        let mut matrix: Vec<f64> = (0..16).map(|k| 1.0 / f64::from(k / 4 + k % 4 + 1)).collect();
        let mut right = [1.0, 0.0, 0.0, 0.0];
        solve_many(&mut matrix, &mut right, 1);
        for (found, expected) in right.iter().zip([16.0, -120.0, 240.0, -140.0]) {
            assert!((found - expected).abs() < 1e-9, "{found} is not {expected}");
        }
    }
}
