//! Walls of constant properties: a whole step of such a wall as one linear map, computed once for each stage length.
//!
//! One implicit stage takes cells at `x` to `P x + Q f` between surfaces at `f`. The second stage of SDIRK2 (diagonal
//! coefficient g, Alexander 1977, doi:10.1137/0714068) starts from `x + r (T1 - x)` with `r = (1 - g)/g` and the solution
//! `T1` of the first stage. A step therefore ends with
//!
//! `A x + B f1 + Q f2`, where `A = P ((1 - r) I + r P)` and `B = r P Q`;
//!
//! with one stage r is zero. The heat that a wall sends into a surface is the conductance of its last half cell times the
//! temperature of that cell, and so another row of these maps. The cells themselves are needed only at the end of the step.
//!
//! Walls of the same cells and links have the same maps, which are formed and stored once: a building of many rooms has
//! few kinds of walls, whose maps stay in the fast memory of the processor.
//!
//! `A` has as many rows as columns. Of a wall of more than [`LONGEST`] cells it is not formed: `A x` then takes two solves with the
//! tridiagonal factors, so that memory and work grow with the number of cells and not with its square.
//!
//! Heat `q` that is released in a cell adds `r P R q1 + R q2` with `R` for the stage's cells by that heat ([`heated`]).

use core::ops::Range;
use std::collections::HashMap;

use crate::building::coefficients::{Coefficients, WallCoefficients};
use crate::building::plan::Plan;
use crate::linear::wall::WallSystem;
use crate::number::real::Real;
use crate::number::simd::widened;
use crate::weather::heat_sources::SourceConditions;

use heated::HeatedWall;

mod heated;

/// Rows of a map that are multiplied together: their sums do not depend on each other, so that the processor adds them
/// at once.
const ROWS: usize = 4;

/// Largest number of cells of a wall whose map is formed. Measured with five walls over 1344 steps, one member: both
/// ways take the same time with some 55 cells; with 20 cells a map takes two thirds, with 100 cells the solves do, with
/// 400 a fourteenth.
const LONGEST: usize = 48;

/// Some rows of a map, column by column.
type Rows<S> = [S; ROWS];

/// The maps of one wall of at least one cell. They have the cells as rows, filled up with zeros to whole [`Rows`].
#[derive(Debug, Clone)]
struct StepMap<S> {
    wall: usize,
    cells: Range<usize>,
    /// Whether it has more than [`LONGEST`] cells: there is no map from the cells.
    long: bool,
    /// An earlier wall with the same maps, counted in [`TransitionMatrices::walls`].
    same_as: Option<usize>,
    /// Numbers of [`Rows`] in the map from the cells and in the map from the surfaces.
    blocks: [usize; 2],
    /// Where they begin in [`TransitionMatrices::from_cells`] and [`TransitionMatrices::from_surfaces`].
    places: [usize; 2],
    /// Conductance between each surface and the cell behind it [W/(m2 K)].
    end_conductances: [S; 2],
    /// Heat into surface e in the second stage per degree of surface o in the first [W/(m2 K)].
    carried: [[S; 2]; 2],
    /// Temperatures of the surfaces in the first stage [degC].
    first_surfaces: [S; 2],
}

/// The maps of all walls of constant properties, wall after wall.
#[derive(Debug, Clone)]
pub(crate) struct TransitionMatrices<S> {
    walls: Vec<StepMap<S>>,
    /// `A`, and in two more rows the heat into the surfaces in the first stage [W/m2]; columns are cells.
    from_cells: Vec<Rows<S>>,
    /// `B` and `Q`; columns are the outside and inside surface in the first and in the last stage.
    from_surfaces: Vec<[Rows<S>; 4]>,
    /// `from_cells` times the cells at the start of the step.
    by_start: Vec<Rows<S>>,
    /// Walls in which heat is released.
    heated: Vec<HeatedWall<S>>,
    /// Heat capacity of the cells of the building [J/K].
    capacity: Vec<S>,
    /// `(1 - g)/g` of the scheme's diagonal coefficient.
    ratio: f64,
    /// Whether `by_start` belongs to the current step.
    started: bool,
}

impl<S: Real> StepMap<S> {
    /// The map from the cells, of all walls' maps.
    #[inline(always)]
    fn of_cells<'m>(&self, maps: &'m [Rows<S>]) -> &'m [Rows<S>] {
        &maps[self.places[0]..][..self.blocks[0] * self.cells.len()]
    }

    /// The map from the surfaces, of all walls' maps.
    #[inline(always)]
    fn of_surfaces<'m>(&self, maps: &'m [[Rows<S>; 4]]) -> &'m [[Rows<S>; 4]] {
        &maps[self.places[1]..][..self.blocks[1]]
    }

    /// Computes the maps from a factored wall, see [`WallSystem::factor`], column by column.
    fn compute(
        &mut self,
        chain: &WallSystem<S>,
        ratio: f64,
        from_cells: &mut [Rows<S>],
        from_surfaces: &mut [[Rows<S>; 4]],
    ) {
        let n = self.cells.len();
        self.end_conductances = [chain.links[0].right, chain.links[n].left];
        let (zeros, mut known) = (vec![S::zero(); n], vec![S::zero(); n]);
        let (mut start, mut reached, mut carried) = (zeros.clone(), zeros.clone(), zeros.clone());
        let columns = if self.long { 0..0 } else { 0..n };
        // One stage from temperatures of the cells, between surfaces at 0 degC.
        let mut stage = |from: &[S], to: &mut [S]| {
            let held: Vec<S> =
                from.iter().zip(&chain.storage).map(|(&from, storage)| storage.capacity * from).collect();
            chain.source_changes(&held, &mut known);
            chain.temperature_changes(&known, [S::zero(); 2], to);
        };
        for column in columns {
            start.fill(S::zero());
            start[column] = S::one();
            stage(&start, &mut reached);
            let heat = [self.end_conductances[0] * reached[0], self.end_conductances[1] * reached[n - 1]];
            for (start, &reached) in start.iter_mut().zip(&reached) {
                *start = start.scale(1.0 - ratio) + reached.scale(ratio);
            }
            stage(&start, &mut carried);
            for (row, &value) in carried.iter().chain(&heat).enumerate() {
                from_cells[row / ROWS * n + column][row % ROWS] = value;
            }
        }
        for side in 0..2 {
            let mut surfaces = [S::zero(); 2];
            surfaces[side] = S::one();
            chain.temperature_changes(&zeros, surfaces, &mut reached);
            for (start, &reached) in start.iter_mut().zip(&reached) {
                *start = reached.scale(ratio);
            }
            stage(&start, &mut carried);
            for (row, (&carried, &reached)) in carried.iter().zip(&reached).enumerate() {
                from_surfaces[row / ROWS][side][row % ROWS] = carried;
                from_surfaces[row / ROWS][2 + side][row % ROWS] = reached;
            }
            self.carried[0][side] = self.end_conductances[0] * carried[0];
            self.carried[1][side] = self.end_conductances[1] * carried[n - 1];
        }
    }
}

impl<S: Real> StepMap<S> {
    /// What the map from the cells gives, for a wall without one.
    // One copy only: inlining multiplies compile time.
    #[inline(never)]
    fn solve_start(&self, chain: &WallSystem<S>, ratio: f64, start: &[S], rows: &mut [S]) {
        S::vectorised(
            #[inline(always)]
            || {
                let n = start.len();
                let (cells, heat) = rows.split_at_mut(n);
                cells.copy_from_slice(start);
                chain.free_stage(cells);
                heat[0] = self.end_conductances[0] * cells[0];
                heat[1] = self.end_conductances[1] * cells[n - 1];
                // With one stage its solution is the end of the step.
                if ratio != 0.0 {
                    for (cell, &start) in cells.iter_mut().zip(start) {
                        *cell = start.scale(1.0 - ratio) + cell.scale(ratio);
                    }
                    chain.free_stage(cells);
                }
            },
        );
    }
}

/// Walls of one kind have the same maps: the bits of everything that these are computed from. Numbers with derivatives
/// are a kind each, since their derivatives may differ.
fn kind<S: Real>(wall: &WallCoefficients<S>, chain: &WallSystem<S>, index: usize) -> Vec<u64> {
    if S::DERIVATIVES {
        return vec![index as u64];
    }
    let cells =
        wall.cells.iter().zip(&chain.storage).flat_map(|(cell, storage)| [cell.thickness, storage.capacity]);
    let links = chain.links.iter().flat_map(|link| [link.left, link.right]);
    cells.chain(links).flat_map(|number| (0..S::LANES).map(move |lane| number.lane(lane).to_bits())).collect()
}

/// `sum + map x` for some rows.
#[inline(always)]
fn multiply<S: Real>(mut sum: Rows<S>, map: &[Rows<S>], x: &[S]) -> Rows<S> {
    // Some columns at a time: the compiler then counts no single ones.
    let ((columns, rest), (some, others)) = (map.as_chunks::<ROWS>(), x.as_chunks::<ROWS>());
    for (columns, some) in columns.iter().zip(some) {
        for (column, &x) in columns.iter().zip(some) {
            for (sum, &factor) in sum.iter_mut().zip(column) {
                *sum += factor * x;
            }
        }
    }
    for (column, &x) in rest.iter().zip(others) {
        for (sum, &factor) in sum.iter_mut().zip(column) {
            *sum += factor * x;
        }
    }
    sum
}

/// Calls work with a number of cells that is a constant in each arm.
macro_rules! in_arms {
    ($n:expr, $work:expr; $($number:literal)*) => {
        match $n {
            $($number => $work($number),)*
            n => $work(n),
        }
    };
}

/// Works on a wall with its number of cells. For plain numbers a small one is a constant of the compiler, which then neither counts rows and
/// columns nor checks their places. In packs this is a small part of the work, and pages carry the engine with them.
#[inline(always)]
fn with_known_cells<S: Real>(n: usize, mut work: impl FnMut(usize)) {
    if const { S::CHUNK == 1 || cfg!(target_arch = "wasm32") } {
        return work(n);
    }
    in_arms!(n, work; 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16);
}

/// `map x` for all rows of a wall of `n` cells.
#[inline(always)]
fn multiply_cells<S: Real>(n: usize, map: &[Rows<S>], x: &[S], rows: &mut [Rows<S>]) {
    let (x, rows) = (&x[..n], &mut rows[..(n + 2).div_ceil(ROWS)]);
    for (rows, map) in rows.iter_mut().zip(map.chunks_exact(n)) {
        *rows = multiply([S::zero(); ROWS], map, x);
    }
}

/// The cells of a wall of `n` cells at the end of a step, from what its start and its surfaces give; adds up the heat that they have stored.
#[inline(always)]
fn reach_end<S: Real>(
    n: usize,
    (by_start, map): (&[Rows<S>], &[[Rows<S>; 4]]),
    surfaces: &[S; 4],
    (cells, capacity): (&mut [S], &[S]),
    stored: &mut Rows<S>,
) {
    let ((whole, rest), (whole_capacity, rest_capacity)) =
        (cells[..n].as_chunks_mut::<ROWS>(), capacity[..n].as_chunks::<ROWS>());
    let blocks = n.div_ceil(ROWS);
    let mut reached = by_start[..blocks].iter().zip(&map[..blocks]).map(
        #[inline(always)]
        |(&by_start, map)| multiply(by_start, map, surfaces),
    );
    for ((cells, capacity), reached) in whole.iter_mut().zip(whole_capacity).zip(&mut reached) {
        for i in 0..ROWS {
            stored[i] += capacity[i] * (reached[i] - cells[i]);
        }
        *cells = reached;
    }
    if let Some(reached) = reached.next() {
        for ((cell, &capacity), reached) in rest.iter_mut().zip(rest_capacity).zip(reached) {
            stored[0] += capacity * (reached - *cell);
            *cell = reached;
        }
    }
}

/// Runs work on rows of plain numbers with wide instructions, where the machine has them. Packs of lanes use them anyway.
#[inline(always)]
fn with_wide_instructions<S: Real, R>(work: impl FnOnce() -> R) -> R {
    if S::LANES == 1 { widened(work) } else { work() }
}

impl<S: Real> TransitionMatrices<S> {
    /// Walls of a plan, for a scheme's diagonal coefficient.
    pub(crate) fn new(
        plan: &Plan,
        numbers: &Coefficients<S>,
        chains: &[WallSystem<S>],
        diagonal: f64,
    ) -> Self {
        let mut transition_matrices = Self {
            walls: Vec::new(),
            from_cells: Vec::new(),
            from_surfaces: Vec::new(),
            by_start: Vec::new(),
            heated: Vec::new(),
            capacity: vec![S::zero(); plan.n_cells],
            ratio: (1.0 - diagonal) / diagonal,
            started: false,
        };
        let zero = [S::zero(); ROWS];
        let mut kinds = HashMap::new();
        let constant = plan.walls.iter().enumerate().filter(|(_, wall)| !wall.nonlinear && !wall.is_empty());
        for (wall, of_plan) in constant {
            let cells = of_plan.first_cell..of_plan.first_cell + of_plan.len();
            let of_cells = numbers.walls[wall].cells.iter().zip(&chains[wall].storage);
            for (capacity, (cell, storage)) in
                transition_matrices.capacity[cells.clone()].iter_mut().zip(of_cells)
            {
                *capacity = numbers.walls[wall].area * cell.thickness * storage.capacity;
            }
            let blocks = [2, 0].map(|more| (of_plan.len() + more).div_ceil(ROWS));
            let long = of_plan.len() > LONGEST;
            let index = transition_matrices.walls.len();
            let first = *kinds.entry(kind(&numbers.walls[wall], &chains[wall], wall)).or_insert(index);
            let places = if first < index {
                transition_matrices.walls[first].places
            } else {
                let places = [transition_matrices.from_cells.len(), transition_matrices.from_surfaces.len()];
                let columns = if long { 0 } else { of_plan.len() };
                transition_matrices.from_cells.resize(places[0] + blocks[0] * columns, zero);
                transition_matrices.from_surfaces.resize(places[1] + blocks[1], [zero; 4]);
                places
            };
            let start = transition_matrices.by_start.len();
            transition_matrices.by_start.resize(start + blocks[0], zero);
            if !of_plan.planes.is_empty() {
                transition_matrices.heated.push(HeatedWall::new(wall, of_plan, ROWS * start));
            }
            let nothing = [S::zero(); 2];
            transition_matrices.walls.push(StepMap {
                wall,
                cells,
                long,
                same_as: (first < index).then_some(first),
                blocks,
                places,
                end_conductances: nothing,
                carried: [nothing; 2],
                first_surfaces: nothing,
            });
        }
        transition_matrices
    }

    /// Computes all maps from the walls, factored for a stage length.
    #[cold]
    #[inline(never)]
    pub(crate) fn factor(&mut self, chains: &[WallSystem<S>]) {
        for i in 0..self.walls.len() {
            let (before, rest) = self.walls.split_at_mut(i);
            let step_map = &mut rest[0];
            if let Some(first) = step_map.same_as {
                step_map.end_conductances = before[first].end_conductances;
                step_map.carried = before[first].carried;
                continue;
            }
            let columns = if step_map.long { 0 } else { step_map.cells.len() };
            let of_cells = &mut self.from_cells[step_map.places[0]..][..step_map.blocks[0] * columns];
            let of_surfaces = &mut self.from_surfaces[step_map.places[1]..][..step_map.blocks[1]];
            step_map.compute(&chains[step_map.wall], self.ratio, of_cells, of_surfaces);
        }
        for heated in &mut self.heated {
            heated.compute(&chains[heated.wall], self.ratio);
        }
        self.started = false;
    }

    /// Begins a step from another state.
    #[inline(always)]
    pub(crate) fn begin(&mut self) {
        self.started = false;
    }

    /// Heat into the surfaces [W/m2] in the first stage of a step that starts from cells.
    #[inline(always)]
    pub(crate) fn first_sources(&mut self, chains: &[WallSystem<S>], cells: &[S], sources: &mut [[S; 2]]) {
        with_wide_instructions::<S, _>(
            #[inline(always)]
            || self.multiply_start(chains, cells, sources),
        );
    }

    #[inline(always)]
    fn multiply_start(&mut self, chains: &[WallSystem<S>], cells: &[S], sources: &mut [[S; 2]]) {
        let mut by_start = &mut self.by_start[..];
        for step_map in &self.walls {
            let x = &cells[step_map.cells.clone()];
            let n = x.len();
            let own;
            (own, by_start) = by_start.split_at_mut(step_map.blocks[0]);
            if !self.started && step_map.long {
                step_map.solve_start(&chains[step_map.wall], self.ratio, x, own.as_flattened_mut());
            } else if !self.started {
                let map = step_map.of_cells(&self.from_cells);
                with_known_cells::<S>(
                    n,
                    #[inline(always)]
                    |n| multiply_cells(n, map, x, own),
                );
            }
            let own = own.as_flattened();
            sources[step_map.wall] = [own[n], own[n + 1]];
        }
        self.started = true;
    }

    /// Stores the temperatures of the surfaces at the end of the first stage.
    #[inline(always)]
    pub(crate) fn set_first_surfaces(&mut self, surfaces: &[S]) {
        let (pairs, _) = surfaces.as_chunks::<2>();
        for step_map in &mut self.walls {
            step_map.first_surfaces = pairs[step_map.wall];
        }
    }

    /// Heat into the surfaces [W/m2] in the second stage.
    #[inline(always)]
    pub(crate) fn second_sources(&self, sources: &mut [[S; 2]]) {
        let mut by_start = &self.by_start[..];
        for step_map in &self.walls {
            let own;
            (own, by_start) = by_start.split_at(step_map.blocks[0]);
            let [outside, inside] = step_map.first_surfaces;
            let [into_outside, into_inside] = step_map.carried;
            // What the start alone makes of the first and the last cell.
            let ends = [own[0][0], own.as_flattened()[step_map.cells.len() - 1]];
            sources[step_map.wall] = [
                step_map.end_conductances[0] * ends[0] + into_outside[0] * outside + into_outside[1] * inside,
                step_map.end_conductances[1] * ends[1] + into_inside[0] * outside + into_inside[1] * inside,
            ];
        }
    }

    /// Releases heat in a stage, and adds what of it reaches the surfaces [W/m2].
    #[inline(always)]
    pub(crate) fn release(&mut self, stage: usize, at: &[SourceConditions<S>], sources: &mut [[S; 2]]) {
        for heated in &mut self.heated {
            heated.release(stage, at, &mut sources[heated.wall]);
        }
    }

    /// Heat into surface e of each wall in the second stage per degree of its surface o in the first [W/(m2 K)].
    pub(crate) fn carried(&self) -> impl Iterator<Item = (usize, [[S; 2]; 2])> + '_ {
        self.walls.iter().map(|step_map| (step_map.wall, step_map.carried))
    }

    /// Ends a step with the surface temperatures of its last stage: replaces the cells at its start by those at its end, and
    /// returns the heat stored [J].
    #[inline(always)]
    pub(crate) fn finish(&mut self, surfaces: &[S], cells: &mut [S]) -> S {
        for heated in &self.heated {
            heated.warm(self.by_start.as_flattened_mut());
        }
        with_wide_instructions::<S, _>(
            #[inline(always)]
            || self.multiply_surfaces(surfaces, cells),
        )
    }

    #[inline(always)]
    fn multiply_surfaces(&self, surfaces: &[S], cells: &mut [S]) -> S {
        // As many sums as rows, none of which depends on another.
        let mut stored = [S::zero(); ROWS];
        let mut by_start = &self.by_start[..];
        let (pairs, _) = surfaces.as_chunks::<2>();
        for step_map in &self.walls {
            let own;
            (own, by_start) = by_start.split_at(step_map.blocks[0]);
            let map = step_map.of_surfaces(&self.from_surfaces);
            let ([a, b], [c, d]) = (step_map.first_surfaces, pairs[step_map.wall]);
            let (cells, capacity) =
                (&mut cells[step_map.cells.clone()], &self.capacity[step_map.cells.clone()]);
            with_known_cells::<S>(
                cells.len(),
                #[inline(always)]
                |n| reach_end(n, (own, map), &[a, b, c, d], (cells, capacity), &mut stored),
            );
        }
        (stored[0] + stored[1]) + (stored[2] + stored[3])
    }
}

#[cfg(test)]
mod tests;
