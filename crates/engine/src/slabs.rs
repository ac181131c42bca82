//! Walls of constant properties: a step of such a wall is one linear map, worked out once per stage length.
//!
//! A stage makes `P x + Q f` of cells that start from `x`, between faces at `f`. The second stage of a step starts from
//! `x + r (T1 - x)`, with `r = (1 - g)/g` and `T1` what the first one reached, so that a step ends with
//! `A x + B f1 + Q f2`, where `A = P ((1 - r) I + r P)` and `B = r P Q`; with one stage `r` is zero. The heat that a wall
//! sends into a face is the conductance of its last half cell times the temperature of that cell: a row of these maps.
//! Cells inside are never looked at between the stages.

use core::ops::Range;

use crate::coefficients::Coefficients;
use crate::conduction::Chain;
use crate::dispatch::widened;
use crate::plan::Plan;
use crate::real::Real;

/// Rows of a map that are multiplied together: their sums do not wait for each other.
const ROWS: usize = 4;

/// Some rows of a map, column by column.
type Rows<S> = [S; ROWS];

/// One wall of at least one cell. Its maps have the cells as rows, filled up with zeros to whole [`Rows`].
#[derive(Debug, Clone)]
struct Slab<S> {
    wall: usize,
    cells: Range<usize>,
    /// Blocks of rows of the map from the cells, and of that from the faces.
    blocks: [usize; 2],
    /// Conductance between the faces and the cells behind them [W/(m2 K)].
    ends: [S; 2],
    /// Heat into face e in the second stage per degree of face o in the first [W/(m2 K)].
    carried: [[S; 2]; 2],
    /// Temperatures of the faces in the first stage.
    first: [S; 2],
}

/// All of them. Maps follow each other wall by wall.
#[derive(Debug, Clone)]
pub(crate) struct Slabs<S> {
    walls: Vec<Slab<S>>,
    /// `A`, and in two more rows the heat into the faces in the first stage; columns are cells.
    from_cells: Vec<Rows<S>>,
    /// `B` and `Q`; columns are the outside and inside face in the first and in the last stage.
    from_faces: Vec<[Rows<S>; 4]>,
    /// What the start of the step makes of the rows of the former.
    left: Vec<Rows<S>>,
    /// Heat capacity of the cells of the building [J/K].
    capacity: Vec<S>,
    /// `(1 - g)/g` of the scheme's diagonal coefficient.
    ratio: f64,
    /// The start of the step is worked in.
    begun: bool,
}

impl<S: Real> Slab<S> {
    /// Works out the maps from an elimination, see [`Chain::factor`].
    fn map(
        &mut self,
        chain: &Chain<S>,
        ratio: f64,
        from_cells: &mut [Rows<S>],
        from_faces: &mut [[Rows<S>; 4]],
    ) {
        let n = self.cells.len();
        self.ends = [chain.links[0].right, chain.links[n].left];
        let (zeros, mut known) = (vec![S::zero(); n], vec![S::zero(); n]);
        let (mut start, mut reached, mut carried) = (zeros.clone(), zeros.clone(), zeros.clone());
        // What a stage makes of cells that start from temperatures.
        let mut stage = |from: &[S], to: &mut [S]| {
            let held: Vec<S> =
                from.iter().zip(&chain.storage).map(|(&from, storage)| storage.capacity * from).collect();
            chain.source_changes(&held, &mut known);
            chain.temperature_changes(&known, [S::zero(); 2], to);
        };
        for column in 0..n {
            start.fill(S::zero());
            start[column] = S::one();
            stage(&start, &mut reached);
            let heat = [self.ends[0] * reached[0], self.ends[1] * reached[n - 1]];
            for (start, &reached) in start.iter_mut().zip(&reached) {
                *start = start.scale(1.0 - ratio) + reached.scale(ratio);
            }
            stage(&start, &mut carried);
            for (row, &value) in carried.iter().chain(&heat).enumerate() {
                from_cells[row / ROWS * n + column][row % ROWS] = value;
            }
        }
        for side in 0..2 {
            let mut faces = [S::zero(); 2];
            faces[side] = S::one();
            chain.temperature_changes(&zeros, faces, &mut reached);
            for (start, &reached) in start.iter_mut().zip(&reached) {
                *start = reached.scale(ratio);
            }
            stage(&start, &mut carried);
            for (row, (&carried, &reached)) in carried.iter().zip(&reached).enumerate() {
                from_faces[row / ROWS][side][row % ROWS] = carried;
                from_faces[row / ROWS][2 + side][row % ROWS] = reached;
            }
            self.carried[0][side] = self.ends[0] * carried[0];
            self.carried[1][side] = self.ends[1] * carried[n - 1];
        }
    }
}

/// `sum + map x` for some rows.
#[inline(always)]
fn multiply<S: Real>(mut sum: Rows<S>, map: &[Rows<S>], x: &[S]) -> Rows<S> {
    for (column, &x) in map.iter().zip(x) {
        for (sum, &factor) in sum.iter_mut().zip(column) {
            *sum += factor * x;
        }
    }
    sum
}

/// Does work on rows of plain numbers with wider instructions, where the machine has them. Lanes are as wide by themselves.
#[inline(always)]
fn side_by_side<S: Real, R>(work: impl FnOnce() -> R) -> R {
    if S::LANES == 1 { widened(work) } else { work() }
}

impl<S: Real> Slabs<S> {
    /// Walls of a plan, for a scheme's diagonal coefficient.
    pub(crate) fn new(plan: &Plan, numbers: &Coefficients<S>, chains: &[Chain<S>], diagonal: f64) -> Self {
        let mut slabs = Self {
            walls: Vec::new(),
            from_cells: Vec::new(),
            from_faces: Vec::new(),
            left: Vec::new(),
            capacity: vec![S::zero(); plan.n_cells],
            ratio: (1.0 - diagonal) / diagonal,
            begun: false,
        };
        let zero = [S::zero(); ROWS];
        let constant = plan.walls.iter().enumerate().filter(|(_, wall)| !wall.nonlinear && !wall.is_empty());
        for (wall, of_plan) in constant {
            let cells = of_plan.first_cell..of_plan.first_cell + of_plan.len();
            let of_cells = numbers.walls[wall].cells.iter().zip(&chains[wall].storage);
            for (capacity, (cell, storage)) in slabs.capacity[cells.clone()].iter_mut().zip(of_cells) {
                *capacity = numbers.walls[wall].area * cell.thickness * storage.capacity;
            }
            let nothing = [S::zero(); 2];
            let blocks = [2, 0].map(|more| (of_plan.len() + more).div_ceil(ROWS));
            slabs.from_cells.resize(slabs.from_cells.len() + blocks[0] * of_plan.len(), zero);
            slabs.from_faces.resize(slabs.from_faces.len() + blocks[1], [zero; 4]);
            slabs.left.resize(slabs.left.len() + blocks[0], zero);
            let carried = [nothing; 2];
            slabs.walls.push(Slab { wall, cells, blocks, ends: nothing, carried, first: nothing });
        }
        slabs
    }

    /// Works out all maps for a stage length [s].
    #[cold]
    #[inline(never)]
    pub(crate) fn factor(&mut self, chains: &[Chain<S>]) {
        let (mut from_cells, mut from_faces) = (&mut self.from_cells[..], &mut self.from_faces[..]);
        for slab in &mut self.walls {
            let [all, tall] = slab.blocks;
            let (own_cells, own_faces);
            (own_cells, from_cells) = from_cells.split_at_mut(all * slab.cells.len());
            (own_faces, from_faces) = from_faces.split_at_mut(tall);
            slab.map(&chains[slab.wall], self.ratio, own_cells, own_faces);
        }
        self.begun = false;
    }

    /// A step begins at another state.
    #[inline(always)]
    pub(crate) fn begin(&mut self) {
        self.begun = false;
    }

    /// Heat into the faces [W/m2] in the first stage of a step that starts from cells.
    #[inline(always)]
    pub(crate) fn first_sources(&mut self, cells: &[S], sources: &mut [[S; 2]]) {
        side_by_side::<S, _>(
            #[inline(always)]
            || self.set_out(cells, sources),
        );
    }

    #[inline(always)]
    fn set_out(&mut self, cells: &[S], sources: &mut [[S; 2]]) {
        let (mut maps, mut left) = (&self.from_cells[..], &mut self.left[..]);
        for slab in &self.walls {
            let x = &cells[slab.cells.clone()];
            let n = x.len();
            let own;
            (own, left) = left.split_at_mut(slab.blocks[0]);
            if !self.begun {
                for rows in &mut *own {
                    let map;
                    (map, maps) = maps.split_at(n);
                    *rows = multiply([S::zero(); ROWS], map, x);
                }
            }
            let own = own.as_flattened();
            sources[slab.wall] = [own[n], own[n + 1]];
        }
        self.begun = true;
    }

    /// Takes over the faces that the first stage reached.
    #[inline(always)]
    pub(crate) fn hold_over(&mut self, faces: &[S]) {
        let (pairs, _) = faces.as_chunks::<2>();
        for slab in &mut self.walls {
            slab.first = pairs[slab.wall];
        }
    }

    /// Heat into the faces [W/m2] in the second stage.
    #[inline(always)]
    pub(crate) fn second_sources(&self, sources: &mut [[S; 2]]) {
        let mut left = &self.left[..];
        for slab in &self.walls {
            let own;
            (own, left) = left.split_at(slab.blocks[0]);
            let [outside, inside] = slab.first;
            let [into_outside, into_inside] = slab.carried;
            let ends = [own[0][0], own.as_flattened()[slab.cells.len() - 1]];
            sources[slab.wall] = [
                slab.ends[0] * ends[0] + into_outside[0] * outside + into_outside[1] * inside,
                slab.ends[1] * ends[1] + into_inside[0] * outside + into_inside[1] * inside,
            ];
        }
    }

    /// What a degree more at each face of a wall in the first stage sends into its faces in the second [W/(m2 K)]:
    /// wall, heat into face e by face o.
    pub(crate) fn carried(&self) -> impl Iterator<Item = (usize, [[S; 2]; 2])> + '_ {
        self.walls.iter().map(|slab| (slab.wall, slab.carried))
    }

    /// Ends a step at the faces of its last stage: the cells in place of where they started, and the heat stored [J].
    #[inline(always)]
    pub(crate) fn finish(&self, faces: &[S], cells: &mut [S]) -> S {
        side_by_side::<S, _>(
            #[inline(always)]
            || self.arrive(faces, cells),
        )
    }

    #[inline(always)]
    fn arrive(&self, faces: &[S], cells: &mut [S]) -> S {
        // Sums that do not wait for each other.
        let mut stored = [S::zero(); ROWS];
        let (mut maps, mut left) = (&self.from_faces[..], &self.left[..]);
        let (pairs, _) = faces.as_chunks::<2>();
        for slab in &self.walls {
            let [all, tall] = slab.blocks;
            let (own, map);
            (own, left) = left.split_at(all);
            (map, maps) = maps.split_at(tall);
            let [a, b] = slab.first;
            let [c, d] = pairs[slab.wall];
            let mut reached = own.iter().zip(map).map(
                #[inline(always)]
                |(&left, map)| multiply(left, map, &[a, b, c, d]),
            );
            let (cells, capacity) = (&mut cells[slab.cells.clone()], &self.capacity[slab.cells.clone()]);
            let ((whole, rest), (whole_capacity, rest_capacity)) =
                (cells.as_chunks_mut::<ROWS>(), capacity.as_chunks::<ROWS>());
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
        (stored[0] + stored[1]) + (stored[2] + stored[3])
    }
}
