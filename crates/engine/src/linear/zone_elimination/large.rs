//! The front of a large zone, solved by [conjugate gradients](super::conjugate) in place of an elimination.
//!
//! Its equations are solved for the right-hand side, for the air and for each retained surface. The emissions of the eliminated
//! surfaces are then a sum of these columns,
//!
//! ```text
//! E = column of the right-hand side + column of the air T_air + sum (column of a retained surface) E_retained      [W/m2]
//! ```
//!
//! and the Schur complement of the retained unknowns follows from them. It stands where an elimination leaves it.

use crate::number::real::{Chunk, Real};

use super::conjugate::{Symmetric, length_of_line};
use super::front::{Columns, ZoneFront};
use super::layout::Layout;

impl<S: Real> ZoneFront<S> {
    /// Solves this front by conjugate gradients from now on.
    pub(super) fn make_large(&mut self) {
        let Layout { surfaces, eliminated, stride, .. } = self.layout;
        let (columns, line) = (surfaces - eliminated + 2, length_of_line(eliminated));
        self.columns = Some(Columns { numbers: vec![S::zero(); columns * line], line });
        // The rows of the retained unknowns alone.
        self.factors.rows = vec![S::zero(); (surfaces - eliminated + 1) * stride];
    }

    /// The equations of the eliminated surfaces.
    fn symmetric(&self) -> Symmetric<'_, S> {
        Symmetric {
            rows: &self.equations.exchange,
            stride: self.layout.stride,
            diagonal: &self.equations.diagonal,
            unknowns: self.layout.eliminated,
        }
    }

    /// Solves the assembled equations for all columns, and computes the Schur complement.
    pub(super) fn solve_columns(&mut self) {
        let Some(mut columns) = self.columns.take() else { return };
        let Layout { surfaces, eliminated, stride, .. } = self.layout;
        let equations = &self.equations;
        let lines = columns.numbers.chunks_exact_mut(columns.line);
        for (k, line) in lines.enumerate() {
            line.fill(S::zero());
            match k {
                0 => line[..eliminated].copy_from_slice(&equations.right[..eliminated]),
                1 => line[..eliminated].copy_from_slice(&equations.to_air[..eliminated]),
                _ => {
                    let row = (eliminated + k - 2) * stride;
                    for (mine, &area) in line.iter_mut().zip(&equations.exchange[row..row + eliminated]) {
                        *mine = -area;
                    }
                }
            }
        }
        self.symmetric().solve(&mut columns.numbers);
        for i in eliminated..=surfaces {
            self.complement(i, &columns);
        }
        self.columns = Some(columns);
    }

    /// The row of a retained unknown in the Schur complement, from the diagonal on.
    fn complement(&mut self, i: usize, columns: &Columns<S>) {
        let Layout { surfaces, eliminated, stride, .. } = self.layout;
        let equations = &self.equations;
        let is_air = i == surfaces;
        let row = &mut self.factors.rows[(i - eliminated) * stride..(i - eliminated + 1) * stride];
        // Coefficients of the emissions of the eliminated surfaces.
        let by_emission = |j: usize| {
            if is_air { -equations.to_air_by_emission[j] } else { equations.exchange[i * stride + j] }
        };
        let sum = |column: &[S]| {
            let mut sum = S::zero();
            for (j, &number) in column.iter().enumerate().take(eliminated) {
                sum += by_emission(j) * number;
            }
            sum
        };
        let first = if is_air { eliminated } else { i };
        for (j, entry) in row.iter_mut().enumerate().take(surfaces).skip(first) {
            *entry = by_emission(j) + sum(columns.column(2 + j - eliminated));
        }
        let (diagonal, right) =
            if is_air { (equations.diagonal[i], equations.right[i]) } else { (S::zero(), S::zero()) };
        row[surfaces] = diagonal + sum(columns.column(1));
        row[surfaces + 1] = right - sum(columns.column(0));
    }

    /// Temperatures of the eliminated surfaces in place of their right-hand sides.
    #[inline(always)]
    pub(super) fn solve_by_columns<V: Chunk<S>>(&mut self, columns: &Columns<S>, unknowns: &[S]) {
        let Self { layout, laws, equations, .. } = self;
        let Layout { surfaces, eliminated, ref retained_rows, .. } = *layout;
        for start in (0..eliminated).step_by(S::CHUNK) {
            let mut emission: V = part!(columns.column(0), start);
            for (i, &row) in (eliminated..).zip(retained_rows) {
                let (column, value) = if i == surfaces {
                    (1, unknowns[row])
                } else {
                    (2 + i - eliminated, laws.emission[0][i] + laws.emission[1][i] * unknowns[row])
                };
                emission += part!(columns.column(column), start) * V::filled(value);
            }
            let temperature =
                (emission - part!(laws.emission[0], start)) * part!(equations.inverse_slope, start);
            temperature.store(&mut equations.right[start..start + S::CHUNK]);
        }
    }

    /// Eliminates the surfaces from another right-hand side of the building: leaves their emissions with the retained
    /// unknowns at zero.
    #[cold]
    pub(super) fn forward_by_columns(&self, right: &mut [S]) {
        let Layout { surfaces, eliminated, stride, .. } = self.layout;
        let mut emissions = vec![S::zero(); length_of_line(eliminated)];
        let place = self.layout.row(0);
        emissions[..eliminated].copy_from_slice(&right[place..place + eliminated]);
        self.symmetric().solve(&mut emissions);
        right[place..place + eliminated].copy_from_slice(&emissions[..eliminated]);
        for i in eliminated..=surfaces {
            let row = self.layout.row(i);
            for (j, &emission) in emissions.iter().enumerate().take(eliminated) {
                let entry = if i == surfaces {
                    -self.equations.to_air_by_emission[j]
                } else {
                    self.equations.exchange[i * stride + j]
                };
                right[row] = right[row] - entry * emission;
            }
        }
    }

    /// Temperatures of the eliminated surfaces for another right-hand side of the building, once the retained unknowns are
    /// known.
    #[cold]
    pub(super) fn back_by_columns(&self, columns: &Columns<S>, right: &mut [S]) {
        let Layout { surfaces, eliminated, .. } = self.layout;
        let place = self.layout.row(0);
        for i in eliminated..=surfaces {
            let value = right[self.layout.row(i)];
            let (column, value) = if i == surfaces {
                (1, value)
            } else {
                (2 + i - eliminated, self.laws.emission[1][i] * value)
            };
            for (mine, &number) in right[place..place + eliminated].iter_mut().zip(columns.column(column)) {
                *mine += number * value;
            }
        }
        for (mine, &inverse) in right[place..].iter_mut().zip(&self.equations.inverse_slope[..eliminated]) {
            *mine = inverse * *mine;
        }
    }
}
