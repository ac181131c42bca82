//! Walls, surfaces and zones of a compiled building: how cells, layers and rows of unknowns are laid out.

use super::glazing::GlassPlan;
use super::ids::SideId;
use crate::input::description::{
    Construction, Description, HeatSource, HeatingMeans, Material, Zone, ZoneLongwave,
};

/// A wall as a chain of cells between two surfaces.
#[derive(Debug, Clone)]
pub struct SurfacePlan {
    /// Index of its first cell in the flat cell arrays.
    pub first_cell: usize,
    /// Layer (or pane) of each cell.
    pub cell_layers: Vec<usize>,
    /// Massless layers in each link, from the outside surface to the inside surface (`cells + 1` lists).
    pub link_layers: Vec<Vec<usize>>,
    /// First and one past the last cell of each layer.
    pub layer_cells: Vec<(usize, usize)>,
    /// True when its properties depend on temperature, its panes absorb sun, or water flows in it.
    pub nonlinear: bool,
    /// Heat sources in it, and the cell that is the plane of each: of no thickness, between two layers.
    pub planes: Vec<(usize, usize)>,
    /// Number of its first cells that are soil.
    pub(crate) soil: usize,
    /// The panes of a window.
    pub glass: Option<GlassPlan>,
    /// Position in [`Plan::windows`](crate::building::plan::Plan::windows); none for a wall.
    pub window: Option<usize>,
    /// Whether its surfaces are eliminated each with its own zone, see the module `thick_walls`.
    pub thick: bool,
    /// Whether the front of a zone eliminates it, see `eliminated_in_front`.
    pub condensed_in_zone: bool,
}

/// How a surface takes part in the solution.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SideRole {
    /// Unknown `row` of the coupled system, in contact with a zone.
    Zone {
        /// Index of the zone.
        zone: usize,
        /// Row in the coupled system.
        row: usize,
    },
    /// In contact with no zone: eliminated with its wall.
    Exterior,
}

/// A surface.
#[derive(Debug, Clone)]
pub struct SidePlan {
    /// Wall it belongs to.
    pub wall: usize,
    /// 0 outside, 1 inside.
    pub side: usize,
    /// Its part in the solution.
    pub role: SideRole,
}

/// A zone.
#[derive(Debug, Clone)]
pub struct ZonePlan {
    /// Its surfaces, in the order of all surfaces.
    pub surfaces: Vec<SideId>,
    /// Row of each of its surfaces in the coupled system.
    pub surface_rows: Vec<usize>,
    /// Row of its air in the coupled system.
    pub air_row: usize,
    /// Its windows: position in [`Plan::windows`](crate::building::plan::Plan::windows) and among its surfaces.
    pub windows: Vec<(usize, usize)>,
}

/// Layer of the cells of soil: none of the construction.
pub(crate) const SOIL: usize = usize::MAX;

/// Index of the first of the two heats by the outdoor air into the soil of a surface: those of all soil follow the heat sources.
pub(crate) fn soil_source(description: &Description, surface: usize) -> usize {
    let before = description.surfaces[..surface].iter().filter(|other| other.soil.is_some()).count();
    description.heat_sources.len() + 2 * before
}

/// Whether water flows in some planes: what it takes and gives changes with its flow. Other heat is known when a stage begins.
fn has_water(description: &Description, planes: &[(usize, usize)]) -> bool {
    let sources = planes.iter().filter_map(|&(source, _)| description.heat_sources.get(source));
    sources.into_iter().any(|source| matches!(source.means, HeatingMeans::Water { .. }))
}

impl SurfacePlan {
    /// Lays out a construction in cells; `first_cell` is its place in the flat cell arrays.
    pub(crate) fn new(
        description: &Description,
        (surface, construction): (usize, &Construction),
        first_cell: usize,
    ) -> Self {
        if let Some(glazing) = &construction.glazing {
            return Self::of_glass(GlassPlan::new(glazing, construction.blind.as_ref()), first_cell);
        }
        let soil = description.surfaces[surface].soil.as_ref().map_or(0, |soil| soil.capacities.len());
        let mut cell_layers = vec![SOIL; soil];
        let mut link_layers = vec![Vec::new(); soil + 1];
        let mut layer_cells = Vec::new();
        let mut planes = Vec::new();
        if soil > 0 {
            let source = soil_source(description, surface);
            planes.extend([(source, soil - 1), (source + 1, soil - 2)]);
        }
        let mut nonlinear = false;
        for (index, layer) in construction.layers.iter().enumerate() {
            let start = cell_layers.len();
            match description.materials[layer.material] {
                Material::Resistance { .. } | Material::Rated { .. } => {
                    if let Some(link) = link_layers.last_mut() {
                        link.push(index);
                    }
                }
                Material::Solid { .. } | Material::Variable { .. } | Material::Pcm { .. } => {
                    nonlinear |= !matches!(description.materials[layer.material], Material::Solid { .. });
                    for _ in 0..layer.nodes {
                        cell_layers.push(index);
                        link_layers.push(Vec::new());
                    }
                }
            }
            layer_cells.push((start, cell_layers.len()));
            let sources = description.heat_sources.iter().enumerate();
            let here = |source: &HeatSource| source.surface == surface && source.layer == index;
            let here: Vec<_> = sources.filter(|(_, source)| here(source)).map(|(k, _)| k).collect();
            if !here.is_empty() {
                planes.extend(here.into_iter().map(|k| (k, cell_layers.len())));
                cell_layers.push(index);
                link_layers.push(Vec::new());
            }
        }
        Self {
            first_cell,
            cell_layers,
            link_layers,
            layer_cells,
            nonlinear: nonlinear || has_water(description, &planes),
            planes,
            soil,
            glass: None,
            window: None,
            thick: false,
            condensed_in_zone: false,
        }
    }

    fn of_glass(glass: GlassPlan, first_cell: usize) -> Self {
        Self {
            first_cell,
            cell_layers: glass.cell_panes.clone(),
            link_layers: vec![Vec::new(); glass.cell_panes.len() + 1],
            layer_cells: Vec::new(),
            nonlinear: true,
            planes: Vec::new(),
            soil: 0,
            glass: Some(glass),
            window: None,
            thick: false,
            condensed_in_zone: false,
        }
    }

    /// Whether a wall with exactly one surface in a zone is eliminated with the zone's own surfaces: walls of constant properties,
    /// and windows of zones whose exact long-wave exchange is eliminated in each iteration anyway.
    pub(crate) fn eliminated_in_front(&self, zone: &Zone) -> bool {
        !self.nonlinear || (self.glass.is_some() && matches!(zone.longwave, ZoneLongwave::Radiosity))
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
