//! The building compiled to flat arrays and indices: everything that does not depend on a parameter's value.

use core::ops::Range;
use std::collections::BTreeSet;

use super::glazing::GlassPlan;
use super::ids::{BySurface, SurfaceId};
use crate::error::EngineError;
use crate::geometry::daylight::Daylight;
use crate::input::check::check;
use crate::input::description::{Construction, Description, Facing, Glazing, Material, Side, ZoneLongwave};
use crate::input::forcing::CLIMATE_CHANNELS;

/// A compiled description.
#[derive(Debug, Clone)]
pub struct Plan {
    /// The description it came from.
    pub description: Description,
    /// One wall per surface.
    pub walls: Vec<WallPlan>,
    /// Two surfaces per surface.
    pub surfaces: BySurface<SurfacePlan>,
    /// Zones.
    pub zones: Vec<ZonePlan>,
    /// Zones with ideal heating or cooling.
    pub ideal_loads: Vec<usize>,
    /// Walls that are windows.
    pub windows: Vec<usize>,
    /// Geometry of sun and shade.
    pub daylight: Daylight,
    /// Number of finite volumes in all walls.
    pub n_cells: usize,
    /// Number of the first rows of the room block: surfaces of walls of constant properties whose other surface is in no zone,
    /// zone by zone.
    pub own_rows: usize,
    /// For each zone surface and zone air that comes after them, in the order of elimination, the later ones that it meets,
    /// as runs of neighbours, all counted from the first of them.
    pub reach: Vec<Vec<Range<usize>>>,
    /// Number of the first of these: the other surfaces of walls of constant properties.
    pub constant_rows: usize,
}

/// A wall as a chain of cells between two surfaces.
#[derive(Debug, Clone)]
pub struct WallPlan {
    /// Index of its first cell in the flat cell arrays.
    pub first_cell: usize,
    /// Layer (or pane) of each cell.
    pub cell_layers: Vec<usize>,
    /// Massless layers in front of each link (`cells + 1` lists).
    pub link_layers: Vec<Vec<usize>>,
    /// First and one past the last cell of each layer.
    pub layer_cells: Vec<(usize, usize)>,
    /// True when its properties depend on temperature, or its panes take up sun.
    pub nonlinear: bool,
    /// A window's panes.
    pub glass: Option<GlassPlan>,
}

/// How a surface takes part in the solution.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SurfaceRole {
    /// Unknown `row` of the room block, in contact with a zone.
    Zone {
        /// Index of the zone.
        zone: usize,
        /// Row in the room block.
        row: usize,
    },
    /// Eliminated inside its wall.
    Exterior,
}

/// A surface.
#[derive(Debug, Clone)]
pub struct SurfacePlan {
    /// Surface it belongs to.
    pub wall: usize,
    /// 0 outside, 1 inside.
    pub side: usize,
    /// Its part in the solution.
    pub role: SurfaceRole,
}

/// A zone.
#[derive(Debug, Clone)]
pub struct ZonePlan {
    /// Its surfaces, in the order of the surfaces.
    pub surfaces: Vec<SurfaceId>,
    /// Row of each surface in the room block.
    pub surface_rows: Vec<usize>,
    /// Row of its air in the room block.
    pub air_row: usize,
    /// Its windows: position in [`Plan::windows`] and among its surfaces.
    pub windows: Vec<(usize, usize)>,
}

impl Plan {
    /// Compiles a description.
    ///
    /// # Errors
    /// [`EngineError::Description`] when references or required parts are missing.
    pub fn new(description: Description) -> Result<Self, EngineError> {
        check(&description)?;
        let mut first_cell = 0;
        let mut walls = Vec::with_capacity(description.surfaces.len());
        for wall in &description.surfaces {
            let wall = WallPlan::new(&description, &description.constructions[wall.construction], first_cell);
            first_cell += wall.cell_layers.len();
            walls.push(wall);
        }
        let (mut surfaces, mut zones) = name_unknowns(&description);
        let Order { own_rows, reach, constant_rows } =
            order_unknowns(&description, &walls, &mut surfaces, &mut zones);
        let conditioned =
            |zone: &crate::input::description::Zone| zone.heating.is_some() || zone.cooling.is_some();
        let ideal_loads = (0..zones.len()).filter(|&zone| conditioned(&description.zones[zone])).collect();
        let windows: Vec<usize> = (0..walls.len()).filter(|&w| walls[w].glass.is_some()).collect();
        for zone in &mut zones {
            let place = |w: usize| zone.surfaces.iter().position(|&surface| surface == SurfaceId::inside(w));
            zone.windows =
                windows.iter().enumerate().filter_map(|(k, &w)| place(w).map(|at| (k, at))).collect();
        }
        let daylight = Daylight::new(&description, &windows, &zones);
        Ok(Self {
            description,
            walls,
            surfaces: surfaces.into(),
            zones,
            ideal_loads,
            windows,
            daylight,
            n_cells: first_cell,
            own_rows,
            reach,
            constant_rows,
        })
    }

    /// The side that a surface stands for.
    #[must_use]
    #[inline(always)]
    pub fn side(&self, surface: SurfaceId) -> &Side {
        let wall = &self.description.surfaces[surface.wall()];
        if surface.is_outside() { &wall.outside } else { &wall.inside }
    }

    /// Row of a zone surface in the room block.
    ///
    /// # Panics
    /// When the surface is not in a zone: a fault of the engine.
    #[must_use]
    #[inline(always)]
    pub fn row(&self, surface: SurfaceId) -> usize {
        match self.surfaces[surface].role {
            SurfaceRole::Zone { row, .. } => row,
            SurfaceRole::Exterior => unreachable!("{} is in no zone", self.surface_name(surface)),
        }
    }

    /// Number of rows of the room block.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.own_rows + self.reach.len()
    }

    /// Number of channels that the forcing must have.
    #[must_use]
    pub fn n_channels(&self) -> usize {
        CLIMATE_CHANNELS + self.description.channels.len()
    }

    /// Name of a surface for messages.
    #[must_use]
    pub fn surface_name(&self, surface: SurfaceId) -> String {
        let side = if surface.is_outside() { "outside" } else { "inside" };
        format!("surface {} ({side} face)", self.description.surfaces[surface.wall()].name)
    }
}

impl WallPlan {
    fn new(description: &Description, construction: &Construction, first_cell: usize) -> Self {
        if let Some(glazing) = &construction.glazing {
            return Self::of_glass(glazing, first_cell);
        }
        let mut cell_layers = Vec::new();
        let mut link_layers = vec![Vec::new()];
        let mut layer_cells = Vec::new();
        let mut nonlinear = false;
        for (index, layer) in construction.layers.iter().enumerate() {
            let start = cell_layers.len();
            match description.materials[layer.material] {
                Material::Resistance { .. } | Material::Rated { .. } => {
                    if let Some(link) = link_layers.last_mut() {
                        link.push(index);
                    }
                }
                Material::Solid { .. } | Material::Pcm { .. } => {
                    nonlinear |= matches!(description.materials[layer.material], Material::Pcm { .. });
                    for _ in 0..layer.nodes {
                        cell_layers.push(index);
                        link_layers.push(Vec::new());
                    }
                }
            }
            layer_cells.push((start, cell_layers.len()));
        }
        Self { first_cell, cell_layers, link_layers, layer_cells, nonlinear, glass: None }
    }

    fn of_glass(glazing: &Glazing, first_cell: usize) -> Self {
        let glass = GlassPlan::new(glazing);
        Self {
            first_cell,
            cell_layers: glass.cell_panes.clone(),
            link_layers: vec![Vec::new(); glass.cell_panes.len() + 1],
            layer_cells: Vec::new(),
            nonlinear: true,
            glass: Some(glass),
        }
    }

    /// Number of cells.
    #[must_use]
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.cell_layers.len()
    }

    /// True for a wall of resistances only.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.cell_layers.is_empty()
    }
}

/// Numbers the surfaces in contact with zones first, then the airs.
fn name_unknowns(description: &Description) -> (Vec<SurfacePlan>, Vec<ZonePlan>) {
    let mut zones: Vec<ZonePlan> = description
        .zones
        .iter()
        .map(|_| ZonePlan { surfaces: Vec::new(), surface_rows: Vec::new(), air_row: 0, windows: Vec::new() })
        .collect();
    let mut surfaces = Vec::with_capacity(2 * description.surfaces.len());
    let mut row = 0;
    for (wall, definition) in description.surfaces.iter().enumerate() {
        for (side, part) in [&definition.outside, &definition.inside].into_iter().enumerate() {
            let role = if let Facing::Zone { zone } = part.facing {
                zones[zone].surfaces.push(SurfaceId::new(wall, side));
                zones[zone].surface_rows.push(row);
                row += 1;
                SurfaceRole::Zone { zone, row: row - 1 }
            } else {
                SurfaceRole::Exterior
            };
            surfaces.push(SurfacePlan { wall, side, role });
        }
    }
    for zone in &mut zones {
        zone.air_row = row;
        row += 1;
    }
    (surfaces, zones)
}

/// The order of elimination, see [`Plan`].
struct Order {
    own_rows: usize,
    reach: Vec<Vec<Range<usize>>>,
    constant_rows: usize,
}

/// Renumbers the unknowns of the room block: zone by zone the surfaces that only their zone and the other surface of a wall of
/// constant properties see; then the others in an order of elimination that keeps them sparse, always the one with the
/// fewest neighbours next (minimum degree), but surfaces of walls of constant properties first: they need not be eliminated
/// again where only the others change. Surfaces of different zones meet only through the walls between them.
fn order_unknowns(
    description: &Description,
    walls: &[WallPlan],
    surfaces: &mut [SurfacePlan],
    zones: &mut [ZonePlan],
) -> Order {
    let mut meets = neighbours(description, surfaces, zones);
    let n = meets.len();
    // Rank of an unknown, and the zone of those that come first.
    let mut rank = vec![(2, 0); n];
    for pair in surfaces.chunks_exact(2) {
        let shared = pair.iter().all(|surface| matches!(surface.role, SurfaceRole::Zone { .. }));
        for surface in pair {
            if let SurfaceRole::Zone { zone, row } = surface.role
                && !walls[surface.wall].nonlinear
            {
                rank[row] = if shared { (1, 0) } else { (0, zone) };
            }
        }
    }
    let ranked = |wanted: usize| rank.iter().filter(|(rank, _)| *rank == wanted).count();
    let (own_rows, constant_rows) = (ranked(0), ranked(1));
    let mut position = vec![usize::MAX; n];
    let mut reach = Vec::with_capacity(n);
    for next in 0..n {
        let waiting = (0..n).filter(|&k| position[k] == usize::MAX);
        let degree = |k: usize| if rank[k].0 == 0 { 0 } else { meets[k].len() };
        let Some(chosen) = waiting.min_by_key(|&k| (rank[k], degree(k))) else { break };
        position[chosen] = next;
        let met = core::mem::take(&mut meets[chosen]);
        // Elimination makes all that it meets meet each other.
        for &k in &met {
            meets[k].extend(met.iter().filter(|&&other| other != k));
            meets[k].remove(&chosen);
        }
        reach.push(met);
    }
    for surface in surfaces {
        if let SurfaceRole::Zone { row, .. } = &mut surface.role {
            *row = position[*row];
        }
    }
    for zone in zones {
        zone.air_row = position[zone.air_row];
        zone.surface_rows = zone.surface_rows.iter().map(|&row| position[row]).collect();
    }
    let later = reach.into_iter().skip(own_rows);
    let reach = later.map(|met| runs(met.into_iter().map(|k| position[k] - own_rows).collect())).collect();
    Order { own_rows, reach, constant_rows }
}

/// Numbers gathered into runs of neighbours.
fn runs(numbers: BTreeSet<usize>) -> Vec<Range<usize>> {
    let mut runs: Vec<Range<usize>> = Vec::new();
    for number in numbers {
        match runs.last_mut() {
            Some(run) if run.end == number => run.end += 1,
            _ => runs.push(number..number + 1),
        }
    }
    runs
}

/// Which unknowns of the room block exchange heat directly.
fn neighbours(
    description: &Description,
    surfaces: &[SurfacePlan],
    zones: &[ZonePlan],
) -> Vec<BTreeSet<usize>> {
    let row = |surface: SurfaceId| match surfaces[surface.index()].role {
        SurfaceRole::Zone { row, .. } => Some(row),
        SurfaceRole::Exterior => None,
    };
    let unknowns = zones.iter().map(|zone| zone.surfaces.len() + 1).sum();
    let mut meets = vec![BTreeSet::new(); unknowns];
    let mut meet = |a: usize, b: usize| {
        meets[a].insert(b);
        meets[b].insert(a);
    };
    for (zone, definition) in zones.iter().zip(&description.zones) {
        let rows = &zone.surface_rows;
        for (i, &a) in rows.iter().enumerate() {
            meet(a, zone.air_row);
            if !matches!(definition.longwave, ZoneLongwave::None) {
                rows[..i].iter().for_each(|&b| meet(a, b));
            }
        }
    }
    for wall in 0..description.surfaces.len() {
        if let (Some(a), Some(b)) = (row(SurfaceId::outside(wall)), row(SurfaceId::inside(wall))) {
            meet(a, b);
        }
    }
    for path in &description.air_paths {
        meet(zones[path.between[0]].air_row, zones[path.between[1]].air_row);
    }
    meets
}
