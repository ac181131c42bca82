//! Walls of constant properties in which heat is released that is known when a stage begins.

use core::ops::Range;

use crate::building::plan::SurfacePlan;
use crate::linear::wall::WallSystem;
use crate::number::real::Real;
use crate::weather::heat_sources::SourceConditions;

/// Heat that one source releases in a wall, and what it does there.
#[derive(Debug, Clone)]
struct Released<S> {
    /// Index of the source, and the cell of the wall that it releases heat in.
    source: usize,
    cell: usize,
    /// In the first and in the last stage of the step [W/m2].
    heat: [S; 2],
    /// What of it reaches the surfaces in its stage, and in the second stage of that of the first [-].
    into_surfaces: [[S; 2]; 2],
    /// Warming of the cells at the end of the step by the heat of the first and of the last stage, cell by cell [m2 K/W].
    warming: Vec<[S; 2]>,
}

/// A wall in which heat is released.
#[derive(Debug, Clone)]
pub(super) struct HeatedWall<S> {
    pub(super) wall: usize,
    /// Where its cells stand among the rows of all walls.
    rows: Range<usize>,
    released: Vec<Released<S>>,
}

impl<S: Real> HeatedWall<S> {
    /// A wall of a plan; `start`: the first of its rows.
    pub(super) fn new(wall: usize, of_plan: &SurfacePlan, start: usize) -> Self {
        let nothing = [S::zero(); 2];
        let released = |&(source, cell): &(usize, usize)| Released {
            source,
            cell,
            heat: nothing,
            into_surfaces: [nothing; 2],
            warming: vec![nothing; of_plan.len()],
        };
        let released = of_plan.planes.iter().map(released).collect();
        Self { wall, rows: start..start + of_plan.len(), released }
    }

    /// Computes what heat does, from the factored wall and `(1 - g)/g` of the scheme's diagonal coefficient.
    pub(super) fn compute(&mut self, chain: &WallSystem<S>, ratio: f64) {
        let n = self.rows.len();
        let zeros = || vec![S::zero(); n];
        let (mut known, mut reached, mut carried) = (zeros(), zeros(), zeros());
        for released in &mut self.released {
            let mut heat = zeros();
            heat[released.cell] = S::one();
            let own = chain.heat_changes(&heat, &mut known);
            chain.temperature_changes(&known, [S::zero(); 2], &mut reached);
            let storage = chain.storage.iter().zip(&reached);
            let held: Vec<S> =
                storage.map(|(storage, &reached)| storage.capacity * reached.scale(ratio)).collect();
            let later = chain.source_changes(&held, &mut known);
            chain.temperature_changes(&known, [S::zero(); 2], &mut carried);
            released.into_surfaces = [own, later];
            for ((warming, &carried), &reached) in released.warming.iter_mut().zip(&carried).zip(&reached) {
                *warming = [carried, reached];
            }
        }
    }

    /// Notes the heat of a stage, and adds what reaches the surfaces [W/m2].
    #[inline(always)]
    pub(super) fn release(&mut self, stage: usize, at: &[SourceConditions<S>], sources: &mut [S; 2]) {
        for released in &mut self.released {
            let heat = at[released.source].heat;
            released.heat[1] = heat;
            if stage == 0 {
                released.heat[0] = heat;
            }
            let [own, later] = released.into_surfaces;
            for side in 0..2 {
                sources[side] += own[side] * heat;
                if stage > 0 {
                    sources[side] += later[side] * released.heat[0];
                }
            }
        }
    }

    /// Adds the heat of the step to the cells at its end, among the rows of all walls [degC].
    #[inline(always)]
    pub(super) fn warm(&self, rows: &mut [S]) {
        for released in &self.released {
            let [first, last] = released.heat;
            for (cell, &[carried, reached]) in rows[self.rows.clone()].iter_mut().zip(&released.warming) {
                *cell += carried * first + reached * last;
            }
        }
    }
}
