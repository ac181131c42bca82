//! Elimination of a dense front: of a fixed size with its rows in registers, or of any size.
//!
//! Both do the same operations in the same order and leave the same bits. Rows are eliminated from above: a row is loaded
//! once, all rows above are subtracted, and it is stored. Of the symmetric part only the upper triangle is computed; the row
//! of the air is not symmetric (surfaces count by emission there) and is kept apart. The matrix is an M-matrix: no pivoting.

use crate::number::real::{Chunk, Real};

use super::equations::Equations;
use super::layout::Layout;

/// Runs a block for every number below 16, each a constant of the compiler.
macro_rules! each {
    ($k:ident, $label:lifetime: $body:block) => {
        each!(@ $k, $label: $body; 0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15)
    };
    (@ $k:ident, $label:lifetime: $body:block; $($number:literal)*) => {
        $label: { $({ const $k: usize = $number; $body })* }
    };
}

/// The factors of a front.
#[derive(Debug, Clone)]
pub(super) struct Factors<S> {
    /// What is right of each pivot, then the rows of the retained unknowns.
    pub(super) rows: Vec<S>,
    /// One over the pivots, and the entries below them in the row of the air.
    pub(super) inverse_pivots: Vec<S>,
    pub(super) below: Vec<S>,
}

impl<S: Real> Factors<S> {
    pub(super) fn new(layout: &Layout) -> Self {
        let zeros = |count| vec![S::zero(); count];
        Self {
            rows: zeros(layout.matrix()),
            inverse_pivots: zeros(layout.stride),
            below: zeros(layout.stride),
        }
    }

    /// Assembles a front and eliminates its surfaces.
    #[inline(always)]
    pub(super) fn eliminate<V: Chunk<S>>(&mut self, equations: &Equations<S>, layout: &Layout) {
        // A constant: no code is compiled for the fixed sizes.
        if const { !S::IN_REGISTERS } {
            return self.eliminate_any(equations, layout);
        }
        let registers = layout.stride / S::CHUNK;
        if const { S::CHUNK > 1 } {
            return match registers {
                1 => self.eliminate_fixed::<V, 1>(equations, layout),
                2 => self.eliminate_fixed::<V, 2>(equations, layout),
                _ => self.eliminate_any(equations, layout),
            };
        }
        match registers {
            2 => self.eliminate_fixed::<V, 2>(equations, layout),
            3 => self.eliminate_fixed::<V, 3>(equations, layout),
            4 => self.eliminate_fixed::<V, 4>(equations, layout),
            5 => self.eliminate_fixed::<V, 5>(equations, layout),
            6 => self.eliminate_fixed::<V, 6>(equations, layout),
            7 => self.eliminate_fixed::<V, 7>(equations, layout),
            8 => self.eliminate_fixed::<V, 8>(equations, layout),
            9 => self.eliminate_fixed::<V, 9>(equations, layout),
            10 => self.eliminate_fixed::<V, 10>(equations, layout),
            11 => self.eliminate_fixed::<V, 11>(equations, layout),
            12 => self.eliminate_fixed::<V, 12>(equations, layout),
            _ => self.eliminate_any(equations, layout),
        }
    }

    /// Rows of `C` registers, which stay there while they are computed.
    #[allow(clippy::absurd_extreme_comparisons, reason = "only the first number is the smallest")]
    #[inline(always)]
    fn eliminate_fixed<V: Chunk<S>, const C: usize>(&mut self, equations: &Equations<S>, layout: &Layout) {
        let (surfaces, eliminated, stride) = (layout.surfaces, layout.eliminated, C * S::CHUNK);
        let equations = View::new(equations, stride);
        let rows = &mut self.rows[..stride * stride];
        let (inverse_pivots, below) = (&mut self.inverse_pivots[..stride], &mut self.below[..stride]);
        let mut air: [V; C] = air_row(&equations, surfaces);
        each!(I, 'rows: {
            if const { I + 1 >= C * S::CHUNK } {
                break 'rows;
            }
            if I >= surfaces {
                break 'rows;
            }
            let first = I / S::CHUNK;
            let mut row: [V; C] = surface_row(&equations, layout, I);
            let last = if I < eliminated { I } else { eliminated };
            for (above, &inverse) in rows.chunks_exact(stride).zip(&*inverse_pivots).take(last) {
                let factor = V::filled(above[I] * inverse);
                for c in first..C {
                    row[c] = row[c] - factor * V::load(&above[c * S::CHUNK..(c + 1) * S::CHUNK]);
                }
            }
            for c in first..C {
                row[c].store(&mut rows[I * stride + c * S::CHUNK..][..S::CHUNK]);
            }
            if I < eliminated {
                let inverse = S::one() / row[first].broadcast(I % S::CHUNK).first();
                inverse_pivots[I] = inverse;
                let entry = air[first].broadcast(I % S::CHUNK);
                below[I] = entry.first();
                let factor = entry * V::filled(inverse);
                for c in first..C {
                    air[c] = air[c] - factor * row[c];
                }
            }
        });
        for (&entry, numbers) in air.iter().zip(rows[surfaces * stride..].chunks_exact_mut(S::CHUNK)) {
            entry.store(numbers);
        }
    }

    /// Rows of any length.
    #[inline(always)]
    pub(super) fn eliminate_any(&mut self, equations: &Equations<S>, layout: &Layout) {
        let Layout { surfaces, eliminated, stride, .. } = *layout;
        let (rows, air) = self.rows.split_at_mut(surfaces * stride);
        for (entry, &by_emission) in air.iter_mut().zip(&equations.to_air_by_emission) {
            *entry = -by_emission;
        }
        air[surfaces] = equations.diagonal[surfaces];
        air[surfaces + 1] = equations.right[surfaces];
        for i in 0..surfaces {
            let (above, row) = rows.split_at_mut(i * stride);
            let row = &mut row[..stride];
            row.copy_from_slice(&equations.exchange[i * stride..(i + 1) * stride]);
            if i < eliminated {
                row[i] += equations.diagonal[i];
                row[surfaces] = -equations.to_air[i];
                row[surfaces + 1] = equations.right[i];
            }
            for (above, &inverse) in above.chunks_exact(stride).zip(&self.inverse_pivots).take(eliminated) {
                let factor = above[i] * inverse;
                for (entry, &above) in row[i..surfaces + 2].iter_mut().zip(&above[i..]) {
                    *entry = *entry - factor * above;
                }
            }
            if i < eliminated {
                self.inverse_pivots[i] = S::one() / row[i];
                self.below[i] = air[i];
                let factor = air[i] * self.inverse_pivots[i];
                for (entry, &row) in air[i + 1..surfaces + 2].iter_mut().zip(&row[i + 1..]) {
                    *entry = *entry - factor * row;
                }
            }
        }
    }
}

/// Equations of a fixed size: the compiler then leaves out the checks of the indices.
struct View<'e, S> {
    exchange: &'e [S],
    to_air: &'e [S],
    to_air_by_emission: &'e [S],
    diagonal: &'e [S],
    right: &'e [S],
}

impl<'e, S> View<'e, S> {
    #[inline(always)]
    fn new(equations: &'e Equations<S>, stride: usize) -> Self {
        Self {
            exchange: &equations.exchange[..stride * stride],
            to_air: &equations.to_air[..stride],
            to_air_by_emission: &equations.to_air_by_emission[..stride],
            diagonal: &equations.diagonal[..stride],
            right: &equations.right[..stride],
        }
    }
}

/// The row of the air, by emissions.
#[inline(always)]
fn air_row<S: Real, V: Chunk<S>, const C: usize>(equations: &View<'_, S>, surfaces: usize) -> [V; C] {
    let mut air: [V; C] = load_row(equations.to_air_by_emission, 0);
    for entry in &mut air {
        *entry = -*entry;
    }
    add_at(&mut air, surfaces, equations.diagonal[surfaces]);
    add_at(&mut air, surfaces + 1, equations.right[surfaces]);
    air
}

/// The row of a surface, from the register of its diagonal on. Retained surfaces have nothing but their exchange here: the
/// rest is assembled in the coupled system.
#[inline(always)]
fn surface_row<S: Real, V: Chunk<S>, const C: usize>(
    equations: &View<'_, S>,
    layout: &Layout,
    i: usize,
) -> [V; C] {
    let (stride, first) = (C * S::CHUNK, i / S::CHUNK);
    let mut row: [V; C] = load_row(&equations.exchange[i * stride..], first);
    if i < layout.eliminated {
        row[first] += V::single(equations.diagonal[i], i % S::CHUNK);
        add_at(&mut row, layout.surfaces, -equations.to_air[i]);
        add_at(&mut row, layout.surfaces + 1, equations.right[i]);
    }
    row
}

/// A row from some register on, zeros before.
#[inline(always)]
fn load_row<S: Real, V: Chunk<S>, const C: usize>(numbers: &[S], first: usize) -> [V; C] {
    let numbers = &numbers[..C * S::CHUNK];
    let mut row = [V::zero(); C];
    for c in first..C {
        row[c] = V::load(&numbers[c * S::CHUNK..(c + 1) * S::CHUNK]);
    }
    row
}

/// Adds a number to a row at a column.
#[inline(always)]
fn add_at<S: Real, V: Chunk<S>, const C: usize>(row: &mut [V; C], column: usize, value: S) {
    let value = V::single(value, column % S::CHUNK);
    for (c, entry) in row.iter_mut().enumerate() {
        if c == column / S::CHUNK {
            *entry += value;
        }
    }
}
