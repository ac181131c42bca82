//! Coefficients of a wall: its area, the thermal properties of its cells and the resistances between them.

use crate::building::cell::{Cell, Matter};
use crate::building::glazing::{Glass, GlassWall, rated_resistance};
use crate::building::layout::SurfacePlan;
use crate::building::plan::Plan;
use crate::input::description::{Material, Soil, Surface};
use crate::input::values::Values;
use crate::number::real::Real;
use crate::physics::formula::function::Function;
use crate::physics::pcm::PcmCoefficients;

/// Both surface resistances of a rated U value [m2 K/W] (ISO 6946:2017, table 7: 0.13 inside, 0.04 outside).
const RATED_SURFACE_RESISTANCES: f64 = 0.17;
/// Conductivity of cells of soil, whose resistance is all in the links between them [W/(m K)].
const RESISTS_NOTHING: f64 = 1e12;

/// A wall.
#[derive(Debug, Clone)]
pub struct WallCoefficients<S> {
    /// Area without openings [m2].
    pub area: S,
    /// Cells, outside to inside.
    pub cells: Vec<Cell<S>>,
    /// Massless resistance in each link [m2 K/W].
    pub extra: Vec<S>,
    /// Whether a massless layer lies in a link.
    pub massless: Vec<bool>,
    /// Phase-change laws of its layers.
    pub pcm: Vec<PcmCoefficients<S>>,
    /// Resistance of each massless layer, zero for the others [m2 K/W].
    pub layer_resistance: Vec<S>,
    /// Whether heat sources lie between its layers, one of which is linearised or takes heat with its temperature.
    pub planes: bool,
    /// Optics and gaps of a window.
    pub glass: Option<Glass<S>>,
}

impl<S: Real> WallCoefficients<S> {
    pub(crate) fn new(plan: &Plan, index: usize, values: &Values<'_, S>) -> Self {
        let description = &plan.description;
        let described = &description.surfaces[index];
        let construction = &description.constructions[described.construction];
        let wall: &SurfacePlan = &plan.walls[index];
        let area = net_area(described, values);
        if let (Some(glazing), Some(glass)) = (&construction.glazing, &wall.glass) {
            let GlassWall { cells, extra, glass } =
                GlassWall::new(values, (glazing, construction.blind.as_ref()), glass, described);
            let massless = vec![true; extra.len()];
            let (pcm, layer_resistance) = (Vec::new(), Vec::new());
            let planes = false;
            return Self { area, cells, extra, massless, pcm, layer_resistance, planes, glass: Some(glass) };
        }
        let mut pcm = Vec::new();
        let mut cells = Vec::with_capacity(wall.len());
        let soil = described.soil.as_ref();
        cells.extend(soil.iter().flat_map(|soil| soil_cells::<S>(soil)));
        let layer_resistance: Vec<S> =
            construction.layers.iter().map(|layer| resistance(plan, layer.material, values)).collect();
        for (layer, &(start, end)) in construction.layers.iter().zip(&wall.layer_cells) {
            if wall.planes.iter().any(|&(_, plane)| plane == cells.len()) {
                cells.push(plane_of_sources());
            }
            let thickness = values.get_or(layer.thickness, 0.0);
            let matter = match &description.materials[layer.material] {
                Material::Resistance { .. } | Material::Rated { .. } => continue,
                Material::Solid { conductivity, density, specific_heat } => Matter::Solid {
                    conductivity: values.get(*conductivity),
                    capacity: values.get(*density) * values.get(*specific_heat),
                },
                Material::Variable { conductivity, density, specific_heat } => {
                    let heat = values.get(*density) * values.get(*specific_heat);
                    let law = Function::of("conductivity", conductivity, values);
                    pcm.push(PcmCoefficients::without_melting(law, heat));
                    Matter::Pcm(pcm.len() - 1)
                }
                Material::Pcm { conductivity, density, specific_heat, law } => {
                    pcm.push(PcmCoefficients::new(values, *conductivity, *density, *specific_heat, law));
                    Matter::Pcm(pcm.len() - 1)
                }
            };
            let share = 1.0 / (end - start) as f64;
            for _ in start..end {
                cells.push(Cell { thickness: thickness.scale(share), matter: matter.clone() });
            }
        }
        let extra = wall
            .link_layers
            .iter()
            .map(|layers| layers.iter().fold(S::zero(), |sum, &layer| sum + layer_resistance[layer]));
        let mut extra: Vec<S> = extra.collect();
        for (extra, resistance) in extra.iter_mut().zip(soil.iter().flat_map(|soil| soil_links(soil))) {
            *extra += S::constant(resistance);
        }
        let links = wall.link_layers.iter().enumerate();
        let massless = links.map(|(link, layers)| link < wall.soil || !layers.is_empty()).collect();
        let planes = wall.nonlinear && !wall.planes.is_empty();
        Self { area, extra, massless, cells, pcm, layer_resistance, planes, glass: None }
    }
}

impl<S: Real> WallCoefficients<S> {
    /// Resistance behind its first cells, without that of layers whose properties change [m2 K/W].
    pub(crate) fn resistance_behind(&self, cells: usize) -> S {
        let massless = self.extra[cells..].iter().fold(S::zero(), |sum, &resistance| sum + resistance);
        let solid = |cell: &Cell<S>| match cell.matter {
            Matter::Solid { conductivity, .. } => cell.thickness / conductivity,
            Matter::Pcm(_) => S::zero(),
        };
        self.cells[cells..].iter().fold(massless, |sum, cell| sum + solid(cell))
    }
}

/// Half of the resistance of the cells of soil, which is none but that of the innermost one: its inner half is all that lies between it
/// and the construction, as far as the link behind it is as large [m2 K/W].
fn half_of_soil(soil: &Soil) -> f64 {
    let cells = soil.capacities.len();
    soil.resistances[cells].min(0.5 * soil.resistances[cells - 1])
}

/// Cells of soil: of one metre, with the heat capacity of the whole cell.
fn soil_cells<S: Real>(soil: &Soil) -> impl Iterator<Item = Cell<S>> {
    let (last, half) = (soil.capacities.len() - 1, half_of_soil(soil));
    soil.capacities.iter().enumerate().map(move |(cell, &capacity)| {
        let conductivity = if cell == last { 0.5 / half } else { RESISTS_NOTHING };
        let matter =
            Matter::Solid { conductivity: S::constant(conductivity), capacity: S::constant(capacity) };
        Cell { thickness: S::one(), matter }
    })
}

/// Resistances of the links of soil beside those of its cells [m2 K/W].
fn soil_links(soil: &Soil) -> impl Iterator<Item = f64> {
    let (cells, half) = (soil.capacities.len(), half_of_soil(soil));
    let within = move |link: usize| if link + 1 < cells { 0.0 } else { half };
    soil.resistances.iter().enumerate().map(move |(link, &resistance)| resistance - within(link))
}

/// A plane between two layers in which heat is released: it stores none and resists none.
fn plane_of_sources<S: Real>() -> Cell<S> {
    let matter = Matter::Solid { conductivity: S::one(), capacity: S::zero() };
    Cell { thickness: S::zero(), matter }
}

/// Area of a wall without its openings, of a window without its frame, or of the frame [m2].
pub(crate) fn net_area<S: Real>(wall: &Surface, values: &Values<'_, S>) -> S {
    let whole = values.get(wall.area);
    if let Some(frame) = &wall.frame {
        let fraction = values.get(frame.fraction);
        return whole * if frame.is_frame { fraction } else { S::one() - fraction };
    }
    wall.openings.iter().fold(whole, |rest, opening| rest - values.get(*opening))
}

/// Resistance of a massless material, zero for others [m2 K/W].
fn resistance<S: Real>(plan: &Plan, material: usize, values: &Values<'_, S>) -> S {
    match &plan.description.materials[material] {
        Material::Resistance { resistance } => values.get(*resistance),
        Material::Rated { u_value } => {
            rated_resistance(values.get(*u_value), S::constant(RATED_SURFACE_RESISTANCES))
        }
        Material::Solid { .. } | Material::Variable { .. } | Material::Pcm { .. } => S::zero(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::building::coefficients::Coefficients;
    use crate::building::plan::Plan;
    use crate::building::test_buildings::{WINDOW, glazed_zone, values};

    /// Cells and links of soil have the resistances that are given, the innermost cell what lies between it and the construction.
    #[test]
    fn soil_behind_a_wall() {
        let soil =
            Soil { capacities: vec![4e5, 2e5, 1e5], resistances: vec![0.1, 0.4, 0.2, 0.03], heat: [0, 1] };
        let cells: Vec<Cell<f64>> = soil_cells(&soil).collect();
        let half = |cell: &Cell<f64>| match cell.matter {
            Matter::Solid { conductivity, .. } => 0.5 * cell.thickness / conductivity,
            Matter::Pcm(_) => panic!("soil"),
        };
        let links: Vec<f64> = soil_links(&soil).collect();
        for (link, &resistance) in soil.resistances.iter().enumerate() {
            let before = if link > 0 { half(&cells[link - 1]) } else { 0.0 };
            let after = cells.get(link).map_or(0.0, half);
            assert!((before + links[link] + after - resistance).abs() < 1e-11, "link {link}");
        }
        assert!((half(&cells[2]) - 0.03).abs() < 1e-15);
    }

    /// 5 cm of board in two cells; the area of the window is not part of the south wall.
    #[test]
    fn a_wall_and_its_window() {
        let plan = Plan::new(glazed_zone("area", false)).unwrap();
        let walls = Coefficients::new(&plan, &values(&plan.description)).walls;
        assert!((walls[0].area - 15.6).abs() < 1e-12 && walls[WINDOW].area == 6.0);
        assert!(walls[0].cells.iter().all(|cell| cell.thickness == 0.025));
        let Matter::Solid { conductivity, capacity } = walls[0].cells[0].matter else { panic!("board") };
        assert_eq!((conductivity, capacity), (0.16, 8e5));
        assert_eq!(
            (walls[0].extra.as_slice(), walls[0].massless.as_slice()),
            ([0.0; 3].as_slice(), [false; 3].as_slice())
        );
        // Two panes of 4 mm; the gap between them is in the glass.
        assert_eq!((walls[WINDOW].extra[0], walls[WINDOW].extra[2]), (0.004, 0.004));
        assert!(walls[WINDOW].glass.is_some() && walls[WINDOW].massless == [true; 3]);
    }
}
