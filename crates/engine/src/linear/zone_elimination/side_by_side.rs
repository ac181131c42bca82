//! Zones of one shape side by side in one front: as many as plain numbers fill a register.
//!
//! In a building of many rooms most zones have as many surfaces as others, of which as many are eliminated. Neighbours in the
//! arrays of such a front are surfaces of the same number in different zones, so that each operation computes one number of
//! all zones. Rows need not be filled up to whole registers, no element of a row is taken out of its register, and the
//! matrices are half as large. Every number has the bits that it has in the front of one zone.
//!
//! A front of zones that differ less in number than a register has places holds the first one again in the others.

use crate::linear::coupled::CoupledSystem;
use crate::number::real::{Chunk, Real};

use super::front::ZoneFront;
use super::layout::Layout;

/// The register at a place of a line, see [`ZoneFront::side_by_side`].
macro_rules! register {
    ($numbers:expr, $i:expr) => {
        V::load(&$numbers[$i * S::CHUNK..($i + 1) * S::CHUNK])
    };
}

impl<S: Real> ZoneFront<S> {
    /// Sums of what acts on the airs.
    #[inline(always)]
    pub(super) fn sum_airs<V: Chunk<S>>(&mut self, matrix: bool) {
        let equations = &mut self.equations;
        let [surfaces, eliminated] =
            [self.layout.surfaces, self.layout.eliminated].map(|count| count / S::CHUNK);
        let sum = |numbers: &[S], count: usize| {
            let mut sum = V::zero();
            for i in 0..count {
                sum += register!(numbers, i);
            }
            sum
        };
        let heat = sum(&equations.air_heat, surfaces);
        heat.store(&mut equations.right[surfaces * S::CHUNK..]);
        if matrix {
            let to_air = sum(&equations.to_air, eliminated);
            to_air.store(&mut equations.diagonal[surfaces * S::CHUNK..]);
        }
    }

    /// Eliminates the surfaces of all zones: the operations of [`Factors::eliminate`](super::eliminate::Factors::eliminate).
    #[inline(always)]
    pub(super) fn eliminate_side_by_side<V: Chunk<S>>(&mut self) {
        let Self { layout, equations, factors, .. } = self;
        let [surfaces, eliminated] = [layout.surfaces, layout.eliminated].map(|count| count / S::CHUNK);
        let (columns, stride) = (surfaces + 2, layout.stride);
        let (rows, air) = factors.rows.split_at_mut(surfaces * stride);
        let air = &mut air[..stride];
        for i in 0..surfaces {
            (-register!(equations.to_air_by_emission, i)).store(&mut air[i * S::CHUNK..]);
        }
        for (i, line) in [(surfaces, &equations.diagonal), (surfaces + 1, &equations.right)] {
            let column = surfaces;
            register!(line, column).store(&mut air[i * S::CHUNK..]);
        }
        for i in 0..surfaces {
            let (above, row) = rows.split_at_mut(i * stride);
            let row = &mut row[..stride];
            let exchange = &equations.exchange[i * stride..(i + 1) * stride];
            row[i * S::CHUNK..].copy_from_slice(&exchange[i * S::CHUNK..]);
            if i < eliminated {
                let diagonal: V = register!(row, i) + register!(equations.diagonal, i);
                diagonal.store(&mut row[i * S::CHUNK..]);
                (-register!(equations.to_air, i)).store(&mut row[surfaces * S::CHUNK..]);
                register!(equations.right, i).store(&mut row[(surfaces + 1) * S::CHUNK..]);
            }
            for (k, above) in above.chunks_exact(stride).enumerate().take(eliminated) {
                let factor: V = register!(above, i) * register!(factors.inverse_pivots, k);
                subtract::<S, V>(row, factor, above, i..columns);
            }
            if i < eliminated {
                let inverse = V::one() / register!(row, i);
                inverse.store(&mut factors.inverse_pivots[i * S::CHUNK..]);
                let below: V = register!(air, i);
                below.store(&mut factors.below[i * S::CHUNK..]);
                subtract::<S, V>(air, below * inverse, row, i + 1..columns);
            }
        }
    }

    /// Computes the Schur complements of all zones, for [`Self::add_schur_complements`]: the sums of
    /// [`ZoneFront::add_schur_complement`], in the same order.
    #[inline(always)]
    pub(super) fn compute_schur_complements<V: Chunk<S>>(&mut self) {
        let Self { layout, laws, equations, factors, schur, .. } = self;
        let [surfaces, eliminated] = [layout.surfaces, layout.eliminated].map(|count| count / S::CHUNK);
        let (count, retained) = (surfaces - eliminated + 1, surfaces - eliminated);
        let (entries, rest) = schur.split_at_mut(count * count * S::CHUNK);
        let (diagonals, right_sides) = rest.split_at_mut(retained * S::CHUNK);
        let mut air_factor = V::zero();
        for i in eliminated..=surfaces {
            let row = &factors.rows[i * layout.stride..(i + 1) * layout.stride];
            let entries = &mut entries[(i - eliminated) * count * S::CHUNK..][..count * S::CHUNK];
            let mut right: V = register!(row, surfaces + 1);
            for (j, place) in (eliminated..surfaces).zip(entries.chunks_exact_mut(S::CHUNK)) {
                // Between surfaces only the upper triangle is stored.
                let entry: V = if i <= j || i == surfaces {
                    register!(row, j)
                } else {
                    register!(factors.rows[j * layout.stride..], i)
                };
                let mut by_temperature = entry * register!(laws.emission[1], j);
                if i == surfaces {
                    let to_air: V = register!(equations.to_air, j);
                    by_temperature = -to_air + by_temperature;
                }
                by_temperature.store(place);
                right = right - entry * register!(laws.emission[0], j);
            }
            let mut of_column: V = register!(row, surfaces);
            if i < surfaces {
                let to_air: V = register!(equations.to_air, i);
                air_factor += to_air;
                of_column += -to_air;
                to_air.store(&mut diagonals[(i - eliminated) * S::CHUNK..]);
                right += register!(equations.right, i);
            } else {
                of_column = air_factor + of_column;
            }
            of_column.store(&mut entries[retained * S::CHUNK..]);
            right.store(&mut right_sides[(i - eliminated) * S::CHUNK..]);
        }
    }

    /// Adds them to the coupled system.
    #[inline(always)]
    pub(super) fn add_schur_complements(&self, coupled: &mut CoupledSystem<'_, S>) {
        let (places, members) = (&self.layout.register_places, self.layout.members);
        let (entries, right_sides) = self.schur.split_at(places.len());
        coupled.add_all(places, entries);
        let rows = self.layout.retained_rows.chunks_exact(S::CHUNK);
        for (rows, sides) in rows.zip(right_sides.chunks_exact(S::CHUNK)) {
            for (&row, &right) in rows.iter().zip(sides).take(members) {
                coupled.right[row] += right;
            }
        }
    }

    /// Temperatures of the eliminated surfaces in place of their right-hand sides, by back substitution.
    #[inline(always)]
    pub(super) fn solve_side_by_side<V: Chunk<S>>(&mut self, unknowns: &[S]) {
        let Self { layout, laws, equations, factors, scratch: emissions, .. } = self;
        let [surfaces, eliminated] = [layout.surfaces, layout.eliminated].map(|count| count / S::CHUNK);
        for (i, rows) in (eliminated..).zip(layout.retained_rows.chunks_exact(S::CHUNK)) {
            let unknown = V::gather(unknowns, rows);
            let value = if i == surfaces {
                unknown
            } else {
                register!(laws.emission[0], i) + register!(laws.emission[1], i) * unknown
            };
            value.store(&mut emissions[i * S::CHUNK..]);
        }
        for (k, row) in factors.rows.chunks_exact(layout.stride).enumerate().take(eliminated).rev() {
            let mut sum = register!(row, surfaces + 1);
            for i in (k + 1..=surfaces).rev() {
                sum = sum - register!(row, i) * register!(emissions, i);
            }
            let emission: V = sum * register!(factors.inverse_pivots, k);
            emission.store(&mut emissions[k * S::CHUNK..]);
        }
        for i in 0..eliminated {
            let temperature: V = (register!(emissions, i) - register!(laws.emission[0], i))
                * register!(equations.inverse_slope, i);
            temperature.store(&mut equations.right[i * S::CHUNK..]);
        }
    }

    /// Eliminates the surfaces of one of the zones from another right-hand side of the building.
    #[inline(always)]
    pub(super) fn forward_of(&self, lane: usize, right: &mut [S]) {
        let (layout, factors) = (&self.layout, &self.factors);
        let [surfaces, eliminated] = [layout.surfaces, layout.eliminated].map(|count| count / S::CHUNK);
        let row_of = rows_of::<S>(layout, lane);
        let air = row_of(surfaces);
        for (k, row) in factors.rows.chunks_exact(layout.stride).enumerate().take(eliminated) {
            let known = factors.inverse_pivots[k * S::CHUNK + lane] * right[row_of(k)];
            for (i, entries) in row.chunks_exact(S::CHUNK).enumerate().take(surfaces).skip(k + 1) {
                let at = row_of(i);
                right[at] = right[at] - entries[lane] * known;
            }
            right[air] = right[air] - factors.below[k * S::CHUNK + lane] * known;
        }
    }

    /// Solves for the eliminated surfaces of one of the zones, for another right-hand side of the building.
    #[inline(always)]
    pub(super) fn back_of(&self, lane: usize, right: &mut [S]) {
        let (layout, factors) = (&self.layout, &self.factors);
        let [surfaces, eliminated] = [layout.surfaces, layout.eliminated].map(|count| count / S::CHUNK);
        let row_of = rows_of::<S>(layout, lane);
        let air = row_of(surfaces);
        let rows = factors.rows.chunks_exact(layout.stride);
        for (k, row) in rows.enumerate().take(eliminated).rev() {
            let at = k * S::CHUNK + lane;
            let mut sum = right[row_of(k)] - row[surfaces * S::CHUNK + lane] * right[air];
            let entries = row.chunks_exact(S::CHUNK).zip(self.laws.emission[1].chunks_exact(S::CHUNK));
            for (j, (entries, slopes)) in entries.enumerate().take(surfaces).skip(k + 1) {
                sum = sum - entries[lane] * (slopes[lane] * right[row_of(j)]);
            }
            right[row_of(k)] = self.equations.inverse_slope[at] * (factors.inverse_pivots[at] * sum);
        }
    }
}

/// Subtracts a multiple of a row from another one, in some columns.
#[inline(always)]
fn subtract<S: Real, V: Chunk<S>>(row: &mut [S], factor: V, above: &[S], columns: core::ops::Range<usize>) {
    let places = columns.start * S::CHUNK..columns.end * S::CHUNK;
    let above = above[places.clone()].chunks_exact(S::CHUNK);
    for (numbers, above) in row[places].chunks_exact_mut(S::CHUNK).zip(above) {
        (V::load(numbers) - factor * V::load(above)).store(numbers);
    }
}

/// Rows of the unknowns of one of the zones among those of the building.
#[inline(always)]
fn rows_of<S: Real>(layout: &Layout, lane: usize) -> impl Fn(usize) -> usize {
    let (first, eliminated) = (layout.first_rows[lane], layout.eliminated / S::CHUNK);
    move |i| {
        if i < eliminated { first + i } else { layout.retained_rows[(i - eliminated) * S::CHUNK + lane] }
    }
}
