//! What follows the elimination of a front: its Schur complement, its solution, other right-hand sides and the transpose.
//!
//! Where the matrix is constant, the *influence* of right-hand sides and retained unknowns on the eliminated surfaces is
//! computed once, and a new right-hand side is a product of matrix and vector, whose sums do not depend on each other.

use crate::linear::coupled::CoupledSystem;
use crate::linear::product::{PlainMatrix, Product, SameKind};
use crate::number::real::{Chunk, Real};

use super::front::ZoneFront;
use super::layout::{Elimination, Layout};

impl<S: Real> ZoneFront<S> {
    /// Computes the influence coefficients, column by column of the inverse.
    #[cold]
    #[inline(never)]
    pub(super) fn compute_influence(&mut self) {
        let Layout { surfaces, eliminated, stride, .. } = self.layout;
        self.influence.begin(stride);
        for j in 0..eliminated {
            let mut values = vec![S::zero(); surfaces + 1];
            values[j] = S::one();
            self.forward::<SameKind, S>(&mut values, |i| i);
            for (i, retained) in values.iter_mut().enumerate().skip(eliminated) {
                self.influence.of_right[j * stride + i] = *retained;
                // The retained unknowns themselves are zero here: their influence follows.
                *retained = S::zero();
            }
            self.back::<SameKind, S>(&mut values, |i| i);
            self.influence.of_right[j * stride..j * stride + eliminated]
                .copy_from_slice(&values[..eliminated]);
        }
        for retained in eliminated..=surfaces {
            let mut values = vec![S::zero(); surfaces + 1];
            values[retained] = S::one();
            self.back::<SameKind, S>(&mut values, |i| i);
            let start = retained * stride;
            self.influence.of_retained[start..start + eliminated].copy_from_slice(&values[..eliminated]);
        }
    }

    /// Influence of the current right-hand side, where the matrix is constant.
    #[inline(always)]
    pub(super) fn apply_influence<V: Chunk<S>>(&mut self) {
        let registers = (self.layout.surfaces + 1).div_ceil(S::CHUNK);
        for pair in 0..registers / 2 {
            self.apply_to_registers::<V, 2>(2 * pair * S::CHUNK);
        }
        if registers % 2 == 1 {
            self.apply_to_registers::<V, 1>((registers - 1) * S::CHUNK);
        }
    }

    #[inline(always)]
    fn apply_to_registers<V: Chunk<S>, const C: usize>(&mut self, start: usize) {
        let Layout { eliminated, stride, .. } = self.layout;
        let lines = self.influence.of_right.chunks_exact(stride);
        let right = self.equations.right[..eliminated].iter().copied();
        let sums = add_lines::<S, V, C>([V::zero(); C], lines.zip(right), start);
        store_row(&sums, &mut self.influence.applied[start..]);
    }

    /// Adds the Schur complement of the retained unknowns, and their right-hand sides, to the coupled system. Its unknowns are
    /// temperatures; convection of retained surfaces is added here, too.
    #[inline(always)]
    pub(super) fn add_schur_complement(
        &self,
        elimination: Elimination,
        constant: bool,
        coupled: &mut CoupledSystem<'_, S>,
    ) {
        if constant {
            let Layout { eliminated, retained_rows, .. } = &self.layout;
            for (i, &row) in (*eliminated..).zip(retained_rows) {
                coupled.right[row] += self.equations.right[i] + self.influence.applied[i];
            }
        }
        if elimination == Elimination::RightHandSide {
            return;
        }
        if self.side_by_side() {
            return self.add_schur_complements(coupled);
        }
        let (layout, emission) = (&self.layout, &self.laws.emission);
        let (surfaces, eliminated) = (layout.surfaces, layout.eliminated);
        // A large front has no other rows.
        let first = if self.columns.is_some() { 0 } else { eliminated };
        let rows_of_retained = &self.factors.rows[first * layout.stride..];
        let entry = |i: usize, j: usize| rows_of_retained[(i - eliminated) * layout.stride + j];
        let count = surfaces - eliminated + 1;
        let places = layout.places.chunks_exact(count);
        let air_diagonal = layout.air_places[count - 1][0];
        let rows = places.zip(&layout.air_places);
        for (i, (places, &[diagonal, to_air_place, from_air_place])) in (eliminated..).zip(rows) {
            let row = layout.retained_rows[i - eliminated];
            let mut right = entry(i, surfaces + 1);
            for (j, place) in (eliminated..surfaces).zip(places) {
                // Between surfaces only the upper triangle is stored.
                let entry = if i <= j || i == surfaces { entry(i, j) } else { entry(j, i) };
                if let Some(place) = *place {
                    coupled.add_at(place, entry * emission[1][j]);
                }
                right = right - entry * emission[0][j];
            }
            coupled.add_at(to_air_place, entry(i, surfaces));
            if i < surfaces {
                let to_air = self.equations.to_air[i];
                coupled.add_at(diagonal, to_air);
                coupled.add_at(air_diagonal, to_air);
                coupled.add_at(to_air_place, -to_air);
                coupled.add_at(from_air_place, -to_air);
                right += self.equations.right[i];
            }
            if !constant {
                coupled.right[row] += right;
            }
        }
    }

    /// An entry of the factors.
    #[inline(always)]
    fn entry(&self, i: usize, j: usize) -> S {
        self.factors.rows[i * self.layout.stride + j]
    }

    /// Temperatures of the eliminated surfaces and of the exterior surfaces of their walls, once the retained unknowns are
    /// known.
    #[inline(always)]
    pub(super) fn solve<V: Chunk<S>>(&mut self, constant: bool, unknowns: &mut [S], surfaces: &mut [S]) {
        if self.side_by_side() {
            self.solve_side_by_side::<V>(unknowns);
        } else if constant {
            self.solve_by_influence::<V>(unknowns);
        } else if let Some(columns) = self.columns.take() {
            self.solve_by_columns::<V>(&columns, unknowns);
            self.columns = Some(columns);
        } else {
            self.solve_by_factors::<V>(unknowns);
        }
        let Layout { eliminated, ref first_rows, members, .. } = self.layout;
        if self.side_by_side() {
            for (lane, &row) in first_rows.iter().enumerate().take(members) {
                let values = self.equations.right[..eliminated].iter().skip(lane).step_by(S::CHUNK);
                for (unknown, &value) in unknowns[row..row + eliminated / S::CHUNK].iter_mut().zip(values) {
                    *unknown = value;
                }
            }
        } else {
            let row = first_rows[0];
            unknowns[row..row + eliminated].copy_from_slice(&self.equations.right[..eliminated]);
        }
        self.write_surfaces::<V>(surfaces);
    }

    /// Temperatures of the eliminated surfaces in place of their right-hand sides, where the matrix is constant.
    #[inline(always)]
    fn solve_by_influence<V: Chunk<S>>(&mut self, unknowns: &[S]) {
        let registers = self.layout.eliminated.div_ceil(S::CHUNK);
        for pair in 0..registers / 2 {
            self.solve_registers::<V, 2>(unknowns, 2 * pair * S::CHUNK);
        }
        if registers % 2 == 1 {
            self.solve_registers::<V, 1>(unknowns, (registers - 1) * S::CHUNK);
        }
    }

    #[inline(always)]
    fn solve_registers<V: Chunk<S>, const C: usize>(&mut self, unknowns: &[S], start: usize) {
        let Layout { eliminated, stride, retained_rows, .. } = &self.layout;
        let lines = self.influence.of_retained[eliminated * stride..].chunks_exact(*stride);
        let retained = retained_rows.iter().map(
            #[inline(always)]
            |&row| unknowns[row],
        );
        let applied = load_row::<S, V, C>(&self.influence.applied[start..]);
        let sums = add_lines(applied, lines.zip(retained), start);
        store_row(&sums, &mut self.equations.right[start..]);
    }

    /// The same by back substitution, from the last surface to the first.
    #[inline(always)]
    fn solve_by_factors<V: Chunk<S>>(&mut self, unknowns: &[S]) {
        let Self { layout, laws, equations, factors, scratch: emissions, .. } = self;
        let Layout { surfaces, eliminated, stride, .. } = *layout;
        let retained = emissions[eliminated..=surfaces].iter_mut().zip(&layout.retained_rows);
        for (i, (value, &row)) in retained.enumerate() {
            let (offset, slope) = (laws.emission[0][eliminated + i], laws.emission[1][eliminated + i]);
            *value = if eliminated + i == surfaces { unknowns[row] } else { offset + slope * unknowns[row] };
        }
        let known = &mut emissions[..=surfaces];
        for (k, &inverse) in factors.inverse_pivots[..eliminated].iter().enumerate().rev() {
            let (entries, right) = factors.rows[k * stride..][..surfaces + 2].split_at(surfaces + 1);
            // The value that was computed last is subtracted last: the other products need not wait for it.
            let mut sum = right[0];
            for (&entry, &value) in entries[k + 1..].iter().zip(&known[k + 1..]).rev() {
                sum = sum - entry * value;
            }
            known[k] = sum * inverse;
        }
        for start in (0..eliminated).step_by(S::CHUNK) {
            let temperature: V = (part!(emissions, start) - part!(laws.emission[0], start))
                * part!(equations.inverse_slope, start);
            temperature.store(&mut equations.right[start..start + S::CHUNK]);
        }
    }

    /// Takes the eliminated surfaces from a solution of all unknowns.
    #[inline(always)]
    pub(super) fn write<V: Chunk<S>>(&mut self, unknowns: &[S], surfaces: &mut [S]) {
        let Layout { eliminated, ref first_rows, .. } = self.layout;
        if self.side_by_side() {
            for (lane, &row) in first_rows.iter().enumerate() {
                let values = self.equations.right[..eliminated].iter_mut().skip(lane).step_by(S::CHUNK);
                for (value, &unknown) in values.zip(&unknowns[row..row + eliminated / S::CHUNK]) {
                    *value = unknown;
                }
            }
        } else {
            let row = first_rows[0];
            self.equations.right[..eliminated].copy_from_slice(&unknowns[row..row + eliminated]);
        }
        self.write_surfaces::<V>(surfaces);
    }

    /// Writes the eliminated surfaces and the exterior surfaces of their walls to the surfaces of the building.
    #[inline(always)]
    fn write_surfaces<V: Chunk<S>>(&mut self, surfaces: &mut [S]) {
        let interior = &self.equations.right;
        for start in (0..self.layout.eliminated).step_by(S::CHUNK) {
            let exterior: V = self.exterior.temperatures(part!(interior, start), start);
            exterior.store(&mut self.scratch[start..start + S::CHUNK]);
        }
        let (walls, thick) = self.layout.walls.split_at(self.layout.exterior);
        for ((&surface, &interior), &exterior) in walls.iter().zip(interior).zip(&self.scratch) {
            (surfaces[surface.index()], surfaces[surface.opposite().index()]) = (interior, exterior);
        }
        for (&surface, &interior) in thick.iter().zip(&interior[walls.len()..]) {
            surfaces[surface.index()] = interior;
        }
    }

    /// Eliminates the surfaces from another right-hand side; `place` is the position of an unknown of the front in it.
    #[inline(always)]
    pub(super) fn forward<P: Product<S, R>, R: Real>(
        &self,
        values: &mut [R],
        place: impl Fn(usize) -> usize,
    ) {
        let Layout { surfaces, eliminated, stride, .. } = self.layout;
        let pivots = self.factors.inverse_pivots.iter().zip(&self.factors.below);
        let rows = self.factors.rows.chunks_exact(stride).zip(pivots);
        for (k, (row, (&inverse, &below))) in rows.enumerate().take(eliminated) {
            let known = P::of(inverse, values[place(k)]);
            for (i, &entry) in (k + 1..surfaces).zip(&row[k + 1..surfaces]) {
                let at = place(i);
                values[at] = values[at] - P::of(entry, known);
            }
            let at = place(surfaces);
            values[at] = values[at] - P::of(below, known);
        }
    }

    /// Temperatures of the eliminated surfaces, from the last to the first, once the retained unknowns are known.
    #[inline(always)]
    pub(super) fn back<P: Product<S, R>, R: Real>(&self, values: &mut [R], place: impl Fn(usize) -> usize) {
        let Layout { surfaces, eliminated, stride, .. } = self.layout;
        for (k, &inverse) in self.factors.inverse_pivots[..eliminated].iter().enumerate().rev() {
            let row = &self.factors.rows[k * stride..][..=surfaces];
            let mut sum = values[place(k)] - P::of(row[surfaces], values[place(surfaces)]);
            let entries = row[k + 1..surfaces].iter().zip(&self.laws.emission[1][k + 1..surfaces]);
            for (j, (&entry, &slope)) in (k + 1..surfaces).zip(entries) {
                sum = sum - P::of_both(entry, slope, values[place(j)]);
            }
            values[place(k)] = P::of_both(self.equations.inverse_slope[k], inverse, sum);
        }
    }

    /// [`Self::forward`] of a right-hand side of the building.
    #[inline(always)]
    pub(super) fn forward_in_building(&self, right: &mut [S]) {
        if self.side_by_side() {
            return (0..self.layout.members).for_each(|lane| self.forward_of(lane, right));
        }
        if self.columns.is_some() {
            return self.forward_by_columns(right);
        }
        self.forward::<SameKind, S>(
            right,
            #[inline(always)]
            |i| self.layout.row(i),
        );
    }

    /// [`Self::back`] of a right-hand side of the building.
    #[inline(always)]
    pub(super) fn back_in_building(&self, right: &mut [S]) {
        if self.side_by_side() {
            return (0..self.layout.members).for_each(|lane| self.back_of(lane, right));
        }
        if let Some(columns) = &self.columns {
            return self.back_by_columns(columns, right);
        }
        self.back::<SameKind, S>(
            right,
            #[inline(always)]
            |i| self.layout.row(i),
        );
    }
}

/// Some registers of a row.
#[inline(always)]
fn load_row<S: Real, V: Chunk<S>, const C: usize>(numbers: &[S]) -> [V; C] {
    let numbers = &numbers[..C * S::CHUNK];
    core::array::from_fn(
        #[inline(always)]
        |c| V::load(&numbers[c * S::CHUNK..(c + 1) * S::CHUNK]),
    )
}

/// Writes some registers of a row.
#[inline(always)]
fn store_row<S: Real, V: Chunk<S>, const C: usize>(row: &[V; C], numbers: &mut [S]) {
    let numbers = &mut numbers[..C * S::CHUNK];
    for (c, &register) in row.iter().enumerate() {
        register.store(&mut numbers[c * S::CHUNK..(c + 1) * S::CHUNK]);
    }
}

/// Registers of a row plus those of some lines from a place on, each line times its number: one pass, in which the sums stay in registers.
#[inline(always)]
fn add_lines<'l, S: Real, V: Chunk<S>, const C: usize>(
    mut sums: [V; C],
    lines: impl Iterator<Item = (&'l [S], S)>,
    start: usize,
) -> [V; C] {
    for (line, number) in lines {
        let (line, number) = (load_row::<S, V, C>(&line[start..]), V::filled(number));
        for (sum, part) in sums.iter_mut().zip(line) {
            *sum += part * number;
        }
    }
    sums
}

impl ZoneFront<f64> {
    /// [`ZoneFront::forward_in_building`] of values of any kind.
    #[inline(always)]
    pub(super) fn forward_values<R: Real>(&self, values: &mut [R]) {
        self.forward::<PlainMatrix, R>(
            values,
            #[inline(always)]
            |i| self.layout.row(i),
        );
    }

    /// [`ZoneFront::back_in_building`] of values of any kind.
    #[inline(always)]
    pub(super) fn back_values<R: Real>(&self, values: &mut [R]) {
        self.back::<PlainMatrix, R>(
            values,
            #[inline(always)]
            |i| self.layout.row(i),
        );
    }

    /// The transpose of [`ZoneFront::back`].
    pub(super) fn back_transposed(&self, values: &mut [f64]) {
        let Layout { surfaces, eliminated, .. } = self.layout;
        let row = |i| self.layout.row(i);
        for k in 0..eliminated {
            let weight = values[row(k)] * (self.factors.inverse_pivots[k] * self.equations.inverse_slope[k]);
            values[row(k)] = weight;
            values[row(surfaces)] -= self.entry(k, surfaces) * weight;
            for j in k + 1..surfaces {
                values[row(j)] -= self.entry(k, j) * self.laws.emission[1][j] * weight;
            }
        }
    }

    /// The transpose of [`ZoneFront::forward`].
    pub(super) fn forward_transposed(&self, values: &mut [f64]) {
        let Layout { surfaces, eliminated, .. } = self.layout;
        let row = |i| self.layout.row(i);
        for k in (0..eliminated).rev() {
            let mut sum = self.factors.below[k] * values[row(surfaces)];
            for i in k + 1..surfaces {
                sum += self.entry(k, i) * values[row(i)];
            }
            values[row(k)] -= self.factors.inverse_pivots[k] * sum;
        }
    }
}
