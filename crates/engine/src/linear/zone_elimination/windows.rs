//! The windows of zones side by side: gaps linearised and panes eliminated, one number of all windows at a place at once.
//!
//! These are units of panes without heat capacity and one gap of gas, the interior surface on the inside. All other windows are
//! linearised and eliminated one by one ([`WallSystem`]), with the same bits.

use core::ops::Range;

use crate::building::coefficients::{Boundary, Coefficients};
use crate::building::glazing::{Glass, GlassPlan};
use crate::building::ids::SideId;
use crate::building::plan::Plan;
use crate::linear::wall::{Link, WallSystem};
use crate::number::real::{Chunk, Real};
use crate::physics::window_gaps::{GapTangent, radiating_tangent};
use crate::weather::conditions::Conditions;

use super::exterior::Exterior;
use super::layout::Layout;

/// The windows at one place in a front.
#[derive(Debug, Clone)]
struct Register<S> {
    /// Their places in the front.
    places: Range<usize>,
    /// The windows, by their walls, and their positions among all windows.
    walls: Vec<usize>,
    windows: Vec<usize>,
    /// Number of cells of each, and their places among all cells, cell by cell.
    cells: usize,
    cell_places: Vec<usize>,
    /// Number of the link across the gap; conductances of the other links, link by link [W/(m2 K)].
    gap: usize,
    conductances: Vec<S>,
    /// Long-wave exchange factors of the gaps [-].
    exchange: Vec<S>,
    /// In a stage: conductance of the gas [W/(m2 K)], and sun absorbed in the cells, cell by cell [W/m2].
    convection: Vec<S>,
    sun: Vec<S>,
    /// In an iteration: the tangents of the gaps, and of each cell `known + to_outside T_outside + next T_behind`.
    tangent: [Vec<S>; 3],
    known: Vec<S>,
    to_outside: Vec<S>,
    next: Vec<S>,
}

/// The windows of a front that are computed together.
#[derive(Debug, Clone)]
pub(super) struct Windows<S> {
    registers: Vec<Register<S>>,
    /// Places of the windows that are computed one by one.
    singles: Vec<usize>,
}

/// The numbers of a register, of an array that has some registers.
macro_rules! number {
    ($numbers:expr, $i:expr) => {
        V::load(&$numbers[$i * S::CHUNK..($i + 1) * S::CHUNK])
    };
}

impl<S: Real> Register<S> {
    /// A link that conducts the same way in both directions.
    #[inline(always)]
    fn constant_link<V: Chunk<S>>(&self, i: usize) -> Link<V> {
        let conductance = number!(self.conductances, i);
        Link { left: conductance, right: conductance, offset: V::zero() }
    }
}

impl<S: Real> Windows<S> {
    /// No window.
    pub(super) fn none() -> Self {
        Self { registers: Vec::new(), singles: Vec::new() }
    }

    /// Those of a front. Without `together` all are computed one by one.
    pub(super) fn new(plan: &Plan, numbers: &Coefficients<S>, layout: &Layout, together: bool) -> Self {
        let mut all = Self::none();
        if together && S::CHUNK > 1 && layout.step() > 1 {
            let places = layout.window_places().step_by(S::CHUNK);
            all.registers = places.filter_map(|start| register(plan, numbers, layout, start)).collect();
        }
        let in_register =
            |place: &usize| all.registers.iter().any(|register| register.places.contains(place));
        all.singles = layout.window_places().filter(|place| !in_register(place)).collect();
        all
    }

    /// Places of the windows that are computed one by one.
    #[inline(always)]
    pub(super) fn singles(&self) -> &[usize] {
        &self.singles
    }

    /// Walls of those that are computed together.
    pub(super) fn walls(&self) -> impl Iterator<Item = usize> + '_ {
        self.registers.iter().flat_map(|register| register.walls.iter().copied())
    }

    /// Reads what stays in a stage; `convection`: expected conductance of the gas in the gap of a wall [W/(m2 K)].
    #[inline(always)]
    pub(super) fn begin(&mut self, conditions: &Conditions<S>, convection: impl Fn(usize) -> S) {
        for register in &mut self.registers {
            for (lane, (&wall, &window)) in register.walls.iter().zip(&register.windows).enumerate() {
                register.convection[lane] = convection(wall);
                let sun = register.sun.iter_mut().skip(lane).step_by(S::CHUNK);
                for (mine, &heat) in sun.zip(&conditions.sun.windows[window].cells) {
                    *mine = heat;
                }
            }
        }
    }

    /// Linearises the gaps about an iterate of all cells, and eliminates the cells.
    #[inline(always)]
    pub(super) fn condense<V: Chunk<S>>(
        &mut self,
        (layout, cells): (&Layout, &[S]),
        exterior: &mut Exterior<S>,
        interior_heat: &mut [S],
    ) {
        for register in &mut self.registers {
            let (gap, places) = (register.gap, &register.cell_places);
            let outer = V::gather(cells, &places[(gap - 1) * S::CHUNK..gap * S::CHUNK]);
            let inner = V::gather(cells, &places[gap * S::CHUNK..(gap + 1) * S::CHUNK]);
            let (exchange, convection) = (V::load(&register.exchange), V::load(&register.convection));
            let GapTangent { left, right, offset } = radiating_tangent(exchange, convection, outer, inner);
            let [of_left, of_right, of_offset] = &mut register.tangent;
            left.store(of_left);
            right.store(of_right);
            offset.store(of_offset);
            // The elimination of `tridiagonal` for cells that store nothing.
            let (mut known, mut to_outside, mut first) = (V::zero(), V::one(), V::zero());
            let mut before: Link<V> = register.constant_link(0);
            let mut path = before.right;
            for i in 0..register.cells {
                let after =
                    if i + 1 == gap { Link { left, right, offset } } else { register.constant_link(i + 1) };
                let inverse = V::one() / (path + after.left);
                let heat = number!(register.sun, i) + before.offset - after.offset;
                known = (heat + before.left * known) * inverse;
                first += path * known;
                let next = after.right * inverse;
                to_outside = before.left * to_outside * inverse;
                known.store(&mut register.known[i * S::CHUNK..]);
                to_outside.store(&mut register.to_outside[i * S::CHUNK..]);
                next.store(&mut register.next[i * S::CHUNK..]);
                path = path * next;
                before = after;
            }
            let across = [before.left * to_outside, path];
            let sources = [first, before.left * known];
            exterior.set_window_register(layout, register.places.start, (across, sources), interior_heat);
        }
    }

    /// Temperatures of the cells among those of the building, from the surfaces at all places of the front.
    #[inline(always)]
    pub(super) fn write_cells<V: Chunk<S>>(&self, [interior, exterior]: [&[S]; 2], cells: &mut [S]) {
        for register in &self.registers {
            let outside: V = V::load(&exterior[register.places.clone()]);
            let mut change = V::load(&interior[register.places.clone()]);
            for i in (0..register.cells).rev() {
                change = number!(register.known, i)
                    + number!(register.to_outside, i) * outside
                    + number!(register.next, i) * change;
                let places = &register.cell_places[i * S::CHUNK..(i + 1) * S::CHUNK];
                change.scatter(cells, places);
            }
        }
    }

    /// Writes the tangents of the gaps, and the cells of the building, to the walls.
    pub(super) fn write_walls(&self, cells: &[S], walls: &mut [WallSystem<S>]) {
        for register in &self.registers {
            let [left, right, offset] = &register.tangent;
            for (lane, &wall) in register.walls.iter().enumerate() {
                let (left, right, offset) = (left[lane], right[lane], offset[lane]);
                walls[wall].links[register.gap] = Link { left, right, offset };
                let first = register.cell_places[lane];
                walls[wall].set_solution(&cells[first..first + register.cells]);
            }
        }
    }
}

/// The windows at a place of a front; none where they cannot be computed together.
fn register<S: Real>(
    plan: &Plan,
    numbers: &Coefficients<S>,
    layout: &Layout,
    start: usize,
) -> Option<Register<S>> {
    let surfaces: &[SideId] = &layout.walls[start..start + S::CHUNK];
    let walls: Vec<usize> = surfaces.iter().map(|surface| surface.wall()).collect();
    let cells = plan.walls[walls[0]].len();
    let glass: Option<Vec<_>> = walls.iter().map(|&wall| numbers.walls[wall].glass.as_ref()).collect();
    let gaps: Option<Vec<_>> = glass?.into_iter().map(Glass::only_gap).collect();
    let gaps = gaps?;
    let gap = gaps[0].0;
    let empty = |wall: usize| {
        let of_plan = &plan.walls[wall];
        of_plan.len() == cells && of_plan.glass.as_ref().is_some_and(GlassPlan::stores_nothing)
    };
    let held = |surface: SideId| {
        let opposite = &numbers.surfaces[surface.opposite()];
        opposite.convection.is_none() && matches!(opposite.boundary, Boundary::Imposed(_))
    };
    let together = surfaces.iter().all(|&surface| !surface.is_outside() && !held(surface))
        && walls.iter().all(|&wall| empty(wall))
        && gaps.iter().all(|(link, _)| *link == gap);
    if !together {
        return None;
    }
    let chains: Vec<_> = walls.iter().map(|&wall| WallSystem::new(&numbers.walls[wall])).collect();
    let zeros = |count: usize| vec![S::zero(); count * S::CHUNK];
    Some(Register {
        places: start..start + S::CHUNK,
        windows: walls.iter().filter_map(|&wall| plan.walls[wall].window).collect(),
        cells,
        cell_places: (0..cells)
            .flat_map(|i| walls.iter().map(move |&wall| plan.walls[wall].first_cell + i))
            .collect(),
        gap,
        conductances: (0..=cells).flat_map(|i| chains.iter().map(move |chain| chain.links[i].left)).collect(),
        exchange: gaps.iter().map(|(_, gap)| gap.exchange()).collect(),
        convection: zeros(1),
        sun: zeros(cells),
        tangent: [zeros(1), zeros(1), zeros(1)],
        known: zeros(cells),
        to_outside: zeros(cells),
        next: zeros(cells),
        walls,
    })
}
