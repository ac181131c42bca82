//! The building compiled to flat arrays and indices: everything that does not depend on a parameter's value.

use core::ops::Range;
use std::collections::BTreeSet;

use super::glazing::GlassPlan;
use super::ids::{BySurface, SurfaceId};
use crate::error::EngineError;
use crate::geometry::daylight::Daylight;
use crate::input::description::{
    Construction, Convection, Description, Facing, Glazing, Material, SetPoint, Side, ZoneLongwave, ZoneSun,
};
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

/// Everything that indexing below relies on. The description language checks the same with better words.
fn check(description: &Description) -> Result<(), EngineError> {
    let fail = |text: String| Err(EngineError::Description(text));
    for construction in &description.constructions {
        if construction.layers.is_empty() == construction.glazing.is_none() {
            return fail(format!("construction {} needs either layers or a glazing", construction.name));
        }
        if let Some(glazing) = &construction.glazing {
            check_glazing(&construction.name, glazing)?;
        }
        for layer in &construction.layers {
            let Some(material) = description.materials.get(layer.material) else {
                return fail(format!("layer {} of {} has no material", layer.name, construction.name));
            };
            let massless = matches!(material, Material::Resistance { .. } | Material::Rated { .. });
            if massless != (layer.nodes == 0) || massless == layer.thickness.is_some() {
                return fail(format!(
                    "layer {} of {}: a resistance has no thickness and no nodes, every other layer both",
                    layer.name, construction.name
                ));
            }
        }
    }
    for wall in &description.surfaces {
        if wall.construction >= description.constructions.len() {
            return fail(format!("surface {} has no construction", wall.name));
        }
        let glazed = description.constructions[wall.construction].glazing.is_some();
        for side in [&wall.outside, &wall.inside] {
            check_side(description, &wall.name, side, glazed)?;
        }
        if glazed
            && !matches!((&wall.outside.facing, &wall.inside.facing), (Facing::Outdoors, Facing::Zone { .. }))
        {
            return fail(format!("window {} does not lie between outdoors and a zone", wall.name));
        }
    }
    for zone in &description.zones {
        if !zone.view_weights.is_empty()
            && zone.view_weights.iter().any(|r| r.len() != zone.view_weights.len())
        {
            return fail(format!("zone {}: view weights are not square", zone.name));
        }
        check_zone(description, zone)?;
    }
    for path in &description.air_paths {
        let [a, b] = path.between;
        if a == b || a.max(b) >= description.zones.len() {
            return fail(format!("air path {} does not join two zones", path.name));
        }
        check_schedule(description, &path.name, path.schedule)?;
    }
    for opening in &description.openings {
        if opening.zone >= description.zones.len() {
            return fail(format!("opening {} is in no zone", opening.name));
        }
        check_schedule(description, &opening.name, opening.schedule)?;
    }
    for (index, zone) in description.zones.iter().enumerate() {
        let sides = description.surfaces.iter().flat_map(|wall| [&wall.outside, &wall.inside]);
        let surfaces = sides.filter(|side| side.facing == Facing::Zone { zone: index }).count();
        let drawn = |zone: usize| {
            description.surfaces.iter().all(|wall| {
                let surfaces = [&wall.outside, &wall.inside];
                let inside = surfaces.iter().any(|side| side.facing == Facing::Zone { zone });
                !inside || wall.vertices.len() > 2 || wall.frame.as_ref().is_some_and(|f| f.is_frame)
            })
        };
        if zone.sun == ZoneSun::Geometry && !drawn(index) {
            return fail(format!("zone {}: the sun is followed between faces with vertices only", zone.name));
        }
        if let ZoneSun::Shares { faces: given, .. } = &zone.sun
            && given.len() != surfaces
        {
            return fail(format!(
                "zone {}: {} shares of the sun for {surfaces} surfaces",
                zone.name,
                given.len()
            ));
        }
    }
    if description.sensors.iter().any(|sensor| sensor.surface >= description.surfaces.len()) {
        return fail("a sensor is in no surface".to_owned());
    }
    Ok(())
}

fn check_zone(description: &Description, zone: &crate::input::description::Zone) -> Result<(), EngineError> {
    for gain in &zone.gains {
        check_schedule(description, &gain.name, gain.schedule)?;
    }
    for flow in &zone.ventilation {
        if flow.air_changes.is_some() == flow.flow.is_some() {
            return Err(EngineError::Description(format!(
                "ventilation {} of zone {}: either air changes or a flow",
                flow.name, zone.name
            )));
        }
        check_schedule(description, &flow.name, flow.schedule)?;
    }
    for ideal_load in [&zone.heating, &zone.cooling].into_iter().flatten() {
        check_schedule(description, &zone.name, ideal_load.schedule)?;
        if let SetPoint::Scheduled { channel } = ideal_load.setpoint {
            check_schedule(description, &zone.name, Some(channel))?;
        }
    }
    Ok(())
}

fn check_glazing(name: &str, glazing: &Glazing) -> Result<(), EngineError> {
    let fail = |text: &str| Err(EngineError::Description(format!("glazing {name}: {text}")));
    let Glazing::Panes { panes, gaps, angular } = glazing else { return Ok(()) };
    if panes.is_empty() || gaps.len() + 1 != panes.len() {
        return fail("needs panes, and one gap less than panes");
    }
    let Some(table) = angular else {
        return if panes.iter().all(|pane| pane.optics.is_some()) {
            Ok(())
        } else {
            fail("needs the optics of every pane, or those of the unit")
        };
    };
    let rising = table.angles.windows(2).all(|pair| pair[0] < pair[1]);
    let whole = table.angles.first() == Some(&0.0) && table.angles.last() == Some(&90.0);
    let count = table.angles.len();
    if !rising || !whole || table.transmittance.len() != count {
        return fail("the angles must rise from 0 to 90 deg, with a transmittance each");
    }
    let per_pane = |count: usize| count == panes.len();
    if !per_pane(table.absorptance.len())
        || table.absorptance.iter().any(|pane| pane.len() != count)
        || table.diffuse_absorptance.as_ref().is_some_and(|pane| !per_pane(pane.len()))
    {
        return fail("needs an absorptance for each pane at each angle");
    }
    Ok(())
}

fn check_schedule(description: &Description, name: &str, schedule: Option<usize>) -> Result<(), EngineError> {
    if schedule.is_some_and(|channel| channel >= description.channels.len()) {
        return Err(EngineError::Description(format!("{name}: unknown schedule")));
    }
    Ok(())
}

fn check_side(description: &Description, name: &str, side: &Side, glazed: bool) -> Result<(), EngineError> {
    let fail = |text: &str| Err(EngineError::Description(format!("surface {name}: {text}")));
    let n_channels = description.channels.len();
    match side.facing {
        Facing::Zone { zone } if zone >= description.zones.len() => return fail("faces an unknown zone"),
        Facing::Zone { zone } => {
            let exchanges = !matches!(description.zones[zone].longwave, ZoneLongwave::None);
            if side.convection.is_none() || (exchanges && side.emissivity.is_none()) {
                return fail("a zone side needs convection and emissivity");
            }
        }
        Facing::Outdoors if side.convection.is_none() || side.emissivity.is_none() => {
            return fail("an outdoor side needs convection and emissivity");
        }
        Facing::Outdoors if side.absorptance.is_none() && side.exposure.sun && !glazed => {
            return fail("an outdoor side needs absorptance");
        }
        Facing::Measured { channel } if channel >= n_channels => return fail("unknown channel"),
        _ => {}
    }
    if side.irradiance.is_some_and(|channel| channel >= n_channels) {
        return fail("unknown irradiance channel");
    }
    if glazed && side.absorptance.is_some() {
        return fail("the absorptance of glass is that of its panes");
    }
    if side.irradiance.is_some() && side.absorptance.is_none() {
        return fail("a measured irradiance needs absorptance");
    }
    if matches!(side.facing, Facing::Measured { .. } | Facing::Ground { .. })
        && matches!(
            side.convection,
            Some(Convection::Tarp { .. } | Convection::Mowitt { .. } | Convection::Doe2 { .. })
        )
    {
        return fail("an imposed temperature takes a constant film");
    }
    if side.irradiance.is_some() && side.convection.is_none() && !matches!(side.facing, Facing::Adiabatic) {
        return fail("the sun on a face held at an imposed temperature does nothing");
    }
    Ok(())
}
