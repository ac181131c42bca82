//! Walls between zones that are so thick that next to no heat crosses them within a stage.
//!
//! Their surfaces are eliminated each with its own zone, as if the other surface of the wall were held at a temperature, and
//! the little that the other surface adds is found by iteration ([`ThickWalls`](crate::linear::thick_walls::ThickWalls)). In a
//! building of many rooms this leaves few unknowns that belong to several zones. A temperature swing that lasts a stage of
//! `t` seconds falls off by `exp(-depth)` across a wall of `depth = sum d sqrt(rho c / (k t))`. The nominal values decide how a
//! building is solved, never what the solution is.

use super::layout::SurfacePlan;
use crate::input::description::{Description, Facing, Material, ParamId};

/// Length of a stage of a step of 15 min [s].
const STAGE: f64 = 264.0;
/// Least depth of a thick wall [-]: less than a thousandth of what happens at one surface reaches the other.
pub(crate) const LEAST_DEPTH: f64 = 7.0;

/// Whether each wall has at least this depth, constant properties and both surfaces in zones.
pub(crate) fn find(description: &Description, walls: &[SurfacePlan], least_depth: f64) -> Vec<bool> {
    let described = description.surfaces.iter().zip(walls);
    described
        .map(|(surface, wall)| {
            let sides = [&surface.outside, &surface.inside];
            let between_zones = sides.iter().all(|side| matches!(side.facing, Facing::Zone { .. }));
            between_zones && !wall.nonlinear && depth(description, surface.construction) >= least_depth
        })
        .collect()
}

/// Depth of a construction of constant properties for a stage [-].
fn depth(description: &Description, construction: usize) -> f64 {
    let value = |id: ParamId| description.parameters[id.0 as usize].value;
    let layers = description.constructions[construction].layers.iter();
    layers
        .map(|layer| match (&description.materials[layer.material], layer.thickness) {
            (Material::Solid { conductivity, density, specific_heat }, Some(thickness)) => {
                let capacity = value(*density) * value(*specific_heat);
                value(thickness) * (capacity / (value(*conductivity) * STAGE)).sqrt()
            }
            _ => 0.0,
        })
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::building::plan::Plan;
    use crate::building::test_buildings::zones_in_a_row;

    /// Board of 5 cm: 0.05 sqrt(800 1000 / (0.16 264)) = 6.88. Of 6 cm it is thick.
    #[test]
    fn the_depth_decides() {
        let mut description = zones_in_a_row(3);
        assert!((depth(&description, 0) - 0.05 * (8e5_f64 / (0.16 * 264.0)).sqrt()).abs() < 1e-12);
        let plan = Plan::new(description.clone()).unwrap();
        assert!(!find(&description, &plan.walls, LEAST_DEPTH).contains(&true));
        let thickness = description.constructions[0].layers[0].thickness.unwrap();
        description.parameters[thickness.0 as usize].value = 0.06;
        let thick = find(&description, &plan.walls, LEAST_DEPTH);
        for (w, surface) in description.surfaces.iter().enumerate() {
            let sides = [&surface.outside, &surface.inside];
            assert_eq!(thick[w], sides.iter().all(|side| matches!(side.facing, Facing::Zone { .. })));
        }
        assert!(thick.contains(&true));
    }
}
