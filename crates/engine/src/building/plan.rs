//! The building compiled to flat arrays and indices: everything that does not depend on a parameter's value.

use std::sync::Arc;

use super::formulas;
use super::humidity::HumidityPlan;
use super::ids::{BySide, SideId};
use super::layout::SOIL;
pub use super::layout::{SidePlan, SideRole, SurfacePlan, ZonePlan};
use super::order::{Order, number_unknowns};
use super::passages::Passage;
use super::pattern::Pattern;
use super::solar_geometry::SolarGeometry;
use super::thick_walls;
use super::vents::VentPlan;
use crate::error::EngineError;
use crate::input::check::check;
use crate::input::description::{Description, Facing, Side, Zone};
use crate::input::forcing::CLIMATE_CHANNELS;
use crate::physics::convection::formula_text::FormulaText;
use crate::physics::diffuse::DiffuseSky;

/// A compiled description.
#[derive(Debug, Clone)]
pub struct Plan {
    /// The description it came from.
    pub description: Description,
    /// Walls.
    pub walls: Vec<SurfacePlan>,
    /// The two surfaces of each wall.
    pub surfaces: BySide<SidePlan>,
    /// Zones.
    pub zones: Vec<ZonePlan>,
    /// Zones with ideal heating or cooling.
    pub ideal_loads: Vec<usize>,
    /// Walls that are windows.
    pub windows: Vec<usize>,
    /// Ways of the sun through windows between zones.
    pub passages: Vec<Passage>,
    /// Geometry of sun and shade.
    pub solar_geometry: SolarGeometry,
    /// Convection at each surface where it is written as text.
    pub(crate) formulas: BySide<Option<Arc<FormulaText>>>,
    /// Model of the diffuse radiation of the sky.
    pub(crate) diffuse: DiffuseSky,
    /// Vapour balance of the zones.
    pub(crate) humidity: Option<HumidityPlan>,
    /// Pressure network of its openings.
    pub(crate) vents: Option<VentPlan>,
    /// Number of finite volumes in all walls.
    pub n_cells: usize,
    /// Number of the first rows of the coupled system: surfaces of walls of constant properties and of windows whose other surface
    /// is in no zone, zone by zone.
    pub own_rows: usize,
    /// The matrix of the later rows, counted from the first of them: the other surfaces in contact with zones and the air of the
    /// zones.
    pub(crate) pattern: Pattern,
    /// Number of the first of these rows: the other surfaces of walls of constant properties, where they come before the rest.
    pub constant_rows: usize,
}

impl Plan {
    /// Compiles a description.
    ///
    /// # Errors
    /// [`EngineError::Description`] when references or required parts are missing.
    pub fn new(description: Description) -> Result<Self, EngineError> {
        Self::compile(description, thick_walls::LEAST_DEPTH, false)
    }

    /// The same with all walls of some depth treated as thick.
    #[cfg(test)]
    pub(crate) fn with_thick_walls(description: Description, least_depth: f64) -> Result<Self, EngineError> {
        Self::compile(description, least_depth, true)
    }

    fn compile(description: Description, least_depth: f64, always: bool) -> Result<Self, EngineError> {
        check(&description)?;
        formulas::check_curves(&description)?;
        formulas::check_texts(&description)?;
        formulas::check_published(&description)?;
        let diffuse = formulas::diffuse_sky(&description)?;
        let formulas = formulas::read(&description)?;
        let mut first_cell = 0;
        let mut walls = Vec::with_capacity(description.surfaces.len());
        for (index, wall) in description.surfaces.iter().enumerate() {
            let construction = &description.constructions[wall.construction];
            let wall = SurfacePlan::new(&description, (index, construction), first_cell);
            first_cell += wall.cell_layers.len();
            walls.push(wall);
        }
        let thick = thick_walls::find(&description, &walls, least_depth);
        let (surfaces, mut zones, order) = number_unknowns(&description, &walls, (thick, always));
        let Order { own_rows, pattern, constant_rows, thick } = order;
        for (wall, thick) in walls.iter_mut().zip(thick) {
            wall.thick = thick;
        }
        for surface in &surfaces {
            if let SideRole::Zone { row, .. } = surface.role {
                walls[surface.wall].condensed_in_zone |= row < own_rows;
            }
        }
        let conditioned = |zone: &Zone| zone.heating.is_some() || zone.cooling.is_some();
        let ideal_loads = (0..zones.len()).filter(|&zone| conditioned(&description.zones[zone])).collect();
        let windows: Vec<usize> = (0..walls.len()).filter(|&w| walls[w].glass.is_some()).collect();
        for (position, &window) in windows.iter().enumerate() {
            walls[window].window = Some(position);
        }
        for zone in &mut zones {
            let place = |surface: SideId| zone.surfaces.iter().position(|&other| other == surface);
            let sides = windows.iter().enumerate().flat_map(|(k, &w)| SideId::pair(w).map(|side| (k, side)));
            zone.windows = sides.filter_map(|(k, side)| place(side).map(|at| (k, at))).collect();
        }
        let passages = Passage::all(&windows, &zones);
        let solar_geometry = SolarGeometry::new(&description, &windows, &zones);
        let (humidity, vents) = (HumidityPlan::new(&description), VentPlan::new(&description));
        Ok(Self {
            diffuse,
            formulas,
            humidity,
            vents,
            description,
            walls,
            surfaces: surfaces.into(),
            zones,
            ideal_loads,
            passages,
            windows,
            solar_geometry,
            n_cells: first_cell,
            own_rows,
            pattern,
            constant_rows,
        })
    }

    /// The description of a surface.
    #[must_use]
    #[inline(always)]
    pub fn side(&self, surface: SideId) -> &Side {
        let wall = &self.description.surfaces[surface.wall()];
        if surface.is_outside() { &wall.outside } else { &wall.inside }
    }

    /// Whether the measured irradiance of a surface is that of the free plane, and something stands in front of it.
    #[must_use]
    pub(crate) fn takes_from_measured(&self, surface: SideId) -> bool {
        let side = self.side(surface);
        let obstructed = !self.description.site.horizon.is_empty() || self.solar_geometry.shaded(surface);
        side.facing == Facing::Outdoors && side.irradiance.is_some() && !side.behind_obstacles && obstructed
    }

    /// Row of a surface of a zone in the coupled system.
    ///
    /// # Panics
    /// When the surface is not in a zone: a fault of the engine.
    #[must_use]
    #[inline(always)]
    pub fn row(&self, surface: SideId) -> usize {
        match self.surfaces[surface].role {
            SideRole::Zone { row, .. } => row,
            SideRole::Exterior => unreachable!("{} is in no zone", self.surface_name(surface)),
        }
    }

    /// Whether a surface is a side of a window between two zones.
    #[must_use]
    pub(crate) fn lets_pass(&self, surface: SideId) -> bool {
        let in_zone = |side| matches!(self.surfaces[side].role, SideRole::Zone { .. });
        self.walls[surface.wall()].glass.is_some() && in_zone(surface) && in_zone(surface.opposite())
    }

    /// Number of rows of the coupled system.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.own_rows + self.pattern.size()
    }

    /// Number of channels that the forcing must have.
    #[must_use]
    pub fn n_channels(&self) -> usize {
        CLIMATE_CHANNELS + self.description.channels.len()
    }

    /// Name of a surface for messages.
    #[must_use]
    pub fn surface_name(&self, surface: SideId) -> String {
        let side = if surface.is_outside() { "outside" } else { "inside" };
        format!("surface {} ({side})", self.description.surfaces[surface.wall()].name)
    }

    /// Name of the layer, or of the pane, of a cell of a wall, as error messages say it.
    #[must_use]
    pub fn cell_name(&self, wall: usize, cell: usize) -> String {
        let surface = &self.description.surfaces[wall];
        let layers = &self.description.constructions[surface.construction].layers;
        let layer = self.walls[wall].cell_layers[cell];
        if layer == SOIL {
            return format!("surface {} (soil)", surface.name);
        }
        match layers.get(layer) {
            Some(layer) => format!("surface {} (layer {})", surface.name, layer.name),
            None => format!("window {} (pane {})", surface.name, layer + 1),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::building::test_buildings::{WINDOW, glazed_zone, zones_in_a_row};

    /// Three zones in a row: of each the wall outdoors comes first, then the four surfaces of the walls between, then the air.
    #[test]
    fn rows_of_zones_in_a_row() {
        let plan = Plan::new(zones_in_a_row(3)).unwrap();
        assert_eq!((plan.own_rows, plan.constant_rows, plan.rows()), (3, 4, 10));
        for (z, zone) in plan.zones.iter().enumerate() {
            assert_eq!(plan.row(SideId::inside(2 * z)), z);
            assert!(zone.surface_rows.iter().all(|row| *row == z || (3..7).contains(row)));
            assert!((7..10).contains(&zone.air_row));
            for (&surface, &row) in zone.surfaces.iter().zip(&zone.surface_rows) {
                assert_eq!(plan.surfaces[surface].role, SideRole::Zone { zone: z, row });
            }
        }
        // The walls between zones couple their air: the two surfaces of a wall have two later neighbours each, the air of a zone
        // that of the next, and three airs are stored as if all of them met.
        let later: Vec<usize> = plan.pattern.rows(0..7).iter().map(|row| row.later.len()).collect();
        assert_eq!(later, [2, 2, 2, 2, 2, 1, 0]);
    }

    /// Cells are numbered wall by wall; the inner sides of the two panes of a simple window have one each.
    #[test]
    fn a_glazed_zone() {
        let plan = Plan::new(glazed_zone("area", false)).unwrap();
        assert_eq!((plan.n_cells, plan.windows.as_slice()), (14, [WINDOW].as_slice()));
        for (w, wall) in plan.walls.iter().enumerate().take(WINDOW) {
            assert_eq!((wall.first_cell, wall.len(), wall.nonlinear), (2 * w, 2, false));
            assert_eq!((&wall.cell_layers, &wall.layer_cells), (&vec![0, 0], &vec![(0, 2)]));
        }
        assert!(plan.walls[WINDOW].nonlinear && plan.walls[WINDOW].len() == 2);
        assert_eq!(plan.zones[0].windows, [(0, WINDOW)]);
        assert_eq!(plan.surfaces[SideId::outside(WINDOW)].role, SideRole::Exterior);
        assert_eq!(plan.surface_name(SideId::inside(0)), "surface wall (inside)");
    }
}
