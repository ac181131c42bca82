//! Temperatures of cells, surfaces and airs: the unknowns of a stage.

use core::ops::Range;

use crate::building::ids::BySide;
use crate::number::real::Real;

/// Temperatures of an iterate or a state, to read [degC].
#[derive(Debug, Clone, Copy)]
pub(crate) struct Temperatures<'a, S> {
    pub(crate) cells: &'a [S],
    pub(crate) surfaces: &'a BySide<S>,
    pub(crate) air: &'a [S],
}

/// Temperatures of one iterate [degC].
#[derive(Debug, Clone)]
pub(crate) struct Unknowns<S> {
    pub(crate) cells: Vec<S>,
    pub(crate) surfaces: BySide<S>,
    pub(crate) air: Vec<S>,
}

impl Unknowns<f64> {
    /// Writes all its numbers.
    pub(crate) fn write(&self, numbers: &mut Vec<f64>) {
        for values in [&self.cells[..], &self.surfaces, &self.air] {
            numbers.extend_from_slice(values);
        }
    }

    /// Reads numbers, and gives those after them; none where there are too few.
    pub(crate) fn read<'n>(&mut self, mut numbers: &'n [f64]) -> Option<&'n [f64]> {
        for values in [&mut self.cells[..], &mut self.surfaces, &mut self.air] {
            let (own, rest) = numbers.split_at_checked(values.len())?;
            values.copy_from_slice(own);
            numbers = rest;
        }
        Some(numbers)
    }
}

impl<S: Real> Unknowns<S> {
    /// As many zeros as there are cells, surfaces and zones.
    pub(crate) fn zero(cells: usize, surfaces: usize, zones: usize) -> Self {
        let zeros = |n: usize| vec![S::zero(); n];
        Self { cells: zeros(cells), surfaces: zeros(surfaces).into(), air: zeros(zones) }
    }

    #[inline(always)]
    pub(crate) fn view(&self) -> Temperatures<'_, S> {
        Temperatures { cells: &self.cells, surfaces: &self.surfaces, air: &self.air }
    }

    /// The values alone.
    pub(crate) fn plain(&self) -> Unknowns<f64> {
        let values = |numbers: &[S]| -> Vec<f64> { numbers.iter().map(|number| number.lane(0)).collect() };
        Unknowns {
            cells: values(&self.cells),
            surfaces: values(&self.surfaces).into(),
            air: values(&self.air),
        }
    }

    /// Copies plain temperatures; of cells only some.
    #[inline(always)]
    pub(crate) fn set(&mut self, cells: &[Range<usize>], plain: &Unknowns<f64>) {
        for cells in cells {
            for (a, &b) in self.cells[cells.clone()].iter_mut().zip(&plain.cells[cells.clone()]) {
                *a = S::constant(b);
            }
        }
        let pairs: [(&mut [S], &[f64]); 2] =
            [(&mut self.surfaces, &plain.surfaces), (&mut self.air, &plain.air)];
        for (mine, plain) in pairs {
            for (a, &b) in mine.iter_mut().zip(plain) {
                *a = S::constant(b);
            }
        }
    }

    /// Copies other temperatures.
    #[inline(always)]
    pub(crate) fn copy_from(&mut self, other: &Self) {
        self.cells.copy_from_slice(&other.cells);
        self.surfaces.copy_from_slice(&other.surfaces);
        self.air.copy_from_slice(&other.air);
    }

    /// Copies the lanes of others where the mask is true.
    pub(crate) fn take(&mut self, mask: S::Mask, other: &Self) {
        let kinds = [
            (&mut self.cells[..], &other.cells[..]),
            (&mut *self.surfaces, &other.surfaces),
            (&mut *self.air, &other.air),
        ];
        for (mine, theirs) in kinds {
            for (mine, &theirs) in mine.iter_mut().zip(theirs) {
                *mine = S::select(mask, theirs, *mine);
            }
        }
    }

    /// Copies other temperatures; of cells only some.
    #[inline(always)]
    pub(crate) fn copy_some(&mut self, cells: &[Range<usize>], other: &Temperatures<'_, S>) {
        copy_ranges(cells, &mut self.cells, other.cells);
        self.surfaces.copy_from_slice(other.surfaces);
        self.air.copy_from_slice(other.air);
    }
}

/// Copies some ranges of numbers.
#[inline(always)]
pub(crate) fn copy_ranges<S: Real>(ranges: &[Range<usize>], mine: &mut [S], theirs: &[S]) {
    for range in ranges {
        mine[range.clone()].copy_from_slice(&theirs[range.clone()]);
    }
}

/// `from + ratio (to - from)`.
#[inline(always)]
pub(crate) fn line<S: Real>(from: S, to: S, ratio: f64) -> S {
    from + (to - from).scale(ratio)
}
