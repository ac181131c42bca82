//! Dense linear systems: Gaussian elimination without pivoting.
//!
//! Pivots are taken in the order of the rows. This is safe for the systems of this engine, whose matrices are diagonally
//! dominant, and it keeps the order of all operations independent of the values: every lane of a pack computes the bits
//! that it computes alone.

use super::real::Real;

/// Solves `matrix X = right` in place for `n` right-hand sides.
///
/// Both arguments are `n` by `n`, row by row. `right` becomes the solution, `matrix` its upper triangular factor (with
/// what the elimination leaves below the diagonal). The matrix has to be diagonally dominant: there is no pivoting.
pub(crate) fn solve_many<S: Real>(matrix: &mut [S], right: &mut [S], n: usize) {
    for k in 0..n {
        let inverse = S::one() / matrix[k * n + k];
        for i in k + 1..n {
            let factor = matrix[i * n + k] * inverse;
            for j in k + 1..n {
                matrix[i * n + j] = matrix[i * n + j] - factor * matrix[k * n + j];
            }
            for j in 0..n {
                right[i * n + j] = right[i * n + j] - factor * right[k * n + j];
            }
        }
    }
    for k in (0..n).rev() {
        for j in 0..n {
            let mut sum = right[k * n + j];
            for i in k + 1..n {
                sum = sum - matrix[k * n + i] * right[i * n + j];
            }
            right[k * n + j] = sum / matrix[k * n + k];
        }
    }
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

    /// The product of a diagonally dominant matrix and the solution gives the right-hand sides again.
    #[test]
    fn the_solution_satisfies_the_equations() {
        let n = 7;
        let number = |k: usize| ((13 * k + 5) % 17) as f64 / 17.0;
        let matrix: Vec<f64> = (0..n * n).map(|k| if k / n == k % n { 9.0 } else { -number(k) }).collect();
        let right: Vec<f64> = (0..n * n).map(|k| number(3 * k + 1)).collect();
        let (mut factor, mut solution) = (matrix.clone(), right.clone());
        solve_many(&mut factor, &mut solution, n);
        for i in 0..n {
            for j in 0..n {
                let product: f64 = (0..n).map(|k| matrix[i * n + k] * solution[k * n + j]).sum();
                assert!((product - right[i * n + j]).abs() < 1e-14);
            }
        }
    }
}
