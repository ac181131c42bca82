//! The convection in the gaps of all windows, as many gaps at once as fill a register.
//!
//! It is evaluated once a stage, at temperatures that are expected in it.

use crate::building::glazing::Glass;
use crate::building::model::Model;
use crate::number::real::{Chunk, ChunkTask, Real};
use crate::physics::window_gaps::{GapRegister, GasGap};

/// Gaps that are computed together.
#[derive(Debug, Clone)]
struct Together<S> {
    /// Places of the cells on the outer and on the inner side, among all cells.
    cells: [Box<[usize]>; 2],
    gaps: GapRegister<S>,
}

/// The convection in the gaps of all windows.
#[derive(Debug, Clone)]
pub(super) struct GapConvection<S> {
    registers: Vec<Together<S>>,
    /// The first gap of each wall, and one more at the end: a wall that is no window has none.
    first: Vec<usize>,
    /// Conductance of the gas in each gap expected in each stage [W/(m2 K)]; more at the end, where a register is not full.
    expected: Vec<Vec<S>>,
}

impl<S: Real> GapConvection<S> {
    /// For a building and a number of stages.
    pub(super) fn new(model: &Model<'_, S>, stages: usize) -> Self {
        let (mut all, mut first): (Vec<([usize; 2], &GasGap<S>)>, _) = (Vec::new(), vec![0]);
        for (w, wall) in model.coefficients.walls.iter().enumerate() {
            let cells = model.cells(w);
            let of_wall = wall.glass.as_ref().map_or(&[][..], Glass::gaps);
            all.extend(
                of_wall.iter().map(|(link, gap)| ([link - 1, *link].map(|cell| cells.start + cell), gap)),
            );
            first.push(all.len());
        }
        let together = |gaps: &[([usize; 2], &GasGap<S>)]| {
            let last = gaps.len() - 1;
            let places = |side: usize| (0..S::CHUNK).map(|k| gaps[k.min(last)].0[side]).collect();
            let numbers: Vec<_> = gaps.iter().map(|(_, gap)| *gap).collect();
            Together { cells: [places(0), places(1)], gaps: GapRegister::new(&numbers) }
        };
        let places = all.len().next_multiple_of(S::CHUNK);
        Self {
            registers: all.chunks(S::CHUNK).map(together).collect(),
            first,
            expected: vec![vec![S::zero(); places]; stages],
        }
    }

    /// Evaluates it at the cell temperatures that are expected in a stage [degC].
    #[inline(always)]
    pub(super) fn expect(&mut self, stage: usize, cells: &[S]) {
        if !self.registers.is_empty() {
            let expected = &mut self.expected[stage];
            expect(&self.registers, cells, expected);
        }
    }

    /// Conductance in the gaps of a wall expected in a stage [W/(m2 K)].
    #[inline(always)]
    pub(super) fn of_wall(&self, stage: usize, w: usize) -> &[S] {
        &self.expected[stage][self.first[w]..self.first[w + 1]]
    }
}

// One copy only: inlining multiplies compile time.
#[inline(never)]
fn expect<S: Real>(registers: &[Together<S>], cells: &[S], expected: &mut [S]) {
    S::vectorised(
        #[inline(always)]
        || S::in_chunks(Expect { registers, cells, expected }),
    );
}

/// The convection in all gaps.
struct Expect<'r, S> {
    registers: &'r [Together<S>],
    cells: &'r [S],
    expected: &'r mut [S],
}

impl<S: Real> ChunkTask<S> for Expect<'_, S> {
    type Output = ();
    #[inline(always)]
    fn run<V: Chunk<S>>(self) {
        for (register, expected) in self.registers.iter().zip(self.expected.chunks_exact_mut(S::CHUNK)) {
            let [outer, inner] = &register.cells;
            let (outer, inner) = (V::gather(self.cells, outer), V::gather(self.cells, inner));
            register.gaps.convection(outer, inner).store(expected);
        }
    }
}
