//! Whether all laws of a building are linear and constant.

use crate::building::coefficients::{Boundary, Bridge, BridgeEnd, Coefficients};
use crate::building::plan::Plan;
use crate::error::EngineError;
use crate::input::description::{Infiltration, Material};
use crate::physics::gains::Gain;
use crate::physics::longwave::Emission;

fn refuse(what: &str, remedy: &str) -> Result<(), EngineError> {
    Err(EngineError::Input(format!("no state space: {what} is not linear and constant; {remedy}")))
}

/// Names the first law that is not linear and constant.
pub(super) fn require_linear(
    plan: &Plan,
    numbers: &[f64],
    coefficients: &Coefficients<f64>,
) -> Result<(), EngineError> {
    for material in &plan.description.materials {
        if let Material::Variable { density, .. } = material {
            let path = &plan.description.parameters[density.0 as usize].path;
            let name = path.split('.').nth(1).unwrap_or(path);
            return refuse(&format!("materials.{name} (conductivity by temperature)"), "give it a number");
        }
        if let Material::Pcm { law: _, conductivity, .. } = material {
            let path = &plan.description.parameters[conductivity[0].0 as usize].path;
            let name = path.split('.').nth(1).unwrap_or(path);
            return refuse(&format!("materials.{name} (phase change)"), "replace it by a solid");
        }
    }
    if let Some(&window) = plan.windows.first() {
        let name = &plan.description.surfaces[window].name;
        return refuse(&format!("window {name}"), "replace it by a wall of a resistance");
    }
    if let Some(source) = plan.description.heat_sources.first() {
        return refuse(&format!("heat source {}", source.name), "use a heat flux on a side");
    }
    require_linear_surfaces(plan, coefficients)?;
    require_linear_zones(plan, numbers, coefficients)?;
    if let Some(opening) = plan.description.openings.first() {
        return refuse(&format!("opening {}", opening.name), "use ventilation without a schedule");
    }
    if let Some(vent) = plan.description.vents.first() {
        return refuse(&format!("vent {}", vent.name), "use ventilation without a schedule");
    }
    if let Some(door) = plan.description.doors.first() {
        return refuse(&format!("door {}", door.name), "give the air path a flow");
    }
    if let Some(unit) = plan.description.ventilation_units.first() {
        return refuse(&format!("ventilation unit {}", unit.name), "use the ventilation of zones");
    }
    let flows = coefficients.mechanical_air.directed.iter().zip(&plan.description.directed_flows);
    if let Some((_, flow)) = flows.into_iter().find(|(flow, _)| flow.whole().is_none()) {
        return refuse(&format!("air path {}", flow.name), "remove its schedule, and a density that varies");
    }
    let bridges = coefficients.bridges.iter().zip(&plan.description.thermal_bridges);
    let imposed = |bridge: &Bridge<f64>| matches!(bridge.to, BridgeEnd::Imposed(_));
    if let Some((_, bridge)) = bridges.into_iter().find(|(bridge, _)| imposed(bridge)) {
        return refuse(
            &format!("thermal bridge {} to a given temperature", bridge.name),
            "let it end outdoors or in a zone",
        );
    }
    let paths = coefficients.paths.iter().zip(&plan.description.air_paths);
    if let Some((_, path)) = paths.into_iter().find(|(path, _)| path.whole().is_none()) {
        return refuse(&format!("air path {}", path.name), "remove schedule, control, varying density");
    }
    Ok(())
}

fn require_linear_surfaces(plan: &Plan, coefficients: &Coefficients<f64>) -> Result<(), EngineError> {
    for (index, surface) in coefficients.surfaces.entries() {
        let name = plan.surface_name(index);
        if surface.boundary.gives_heat() || surface.boundary.gives_coefficient() {
            return refuse(&format!("the law of heat or a coefficient at {name}"), "use a given temperature");
        }
        if surface.convection.as_ref().is_some_and(|convection| convection.constant().is_none()) {
            return refuse(&format!("convection at {name}"), "use a constant coefficient");
        }
        if let Boundary::Outdoors(outdoors) = &surface.boundary
            && matches!(outdoors.emission, Some(Emission::Exact))
        {
            return refuse(
                &format!("long-wave exchange at {name}"),
                "use `longwave: {kind: linearised, ...}`",
            );
        }
    }
    Ok(())
}

fn require_linear_zones(
    plan: &Plan,
    numbers: &[f64],
    coefficients: &Coefficients<f64>,
) -> Result<(), EngineError> {
    for (zone, definition) in coefficients.zones.iter().zip(&plan.description.zones) {
        if !zone.exchange.is_empty() && matches!(zone.emission, Emission::Exact) {
            return refuse(
                &format!("long-wave exchange in zone {}", definition.name),
                "use `longwave: {kind: linearised, ...}`",
            );
        }
        let Infiltration { temperature, wind, .. } = &definition.infiltration;
        let varies = [temperature, wind].iter().any(|id| numbers[id.0 as usize] != 0.0);
        if varies || zone.leakage.is_some() || zone.infiltration_law.is_some() {
            return refuse(
                &format!("infiltration of zone {}", definition.name),
                "keep only its constant part",
            );
        }
        if zone.gradient.is_some() {
            return refuse(
                &format!("the stratified air of zone {}", definition.name),
                "remove `air_gradient`",
            );
        }
        if zone.gains.iter().any(Gain::of_people) {
            return refuse(
                &format!("heat of people in zone {}", definition.name),
                "write the sensible heat as `power`, without `activity`",
            );
        }
        let varies = zone.infiltrated_capacity.as_ref().is_some_and(|capacity| capacity.whole().is_none());
        if varies || zone.infiltration_control.is_some() {
            return refuse(
                &format!(
                    "infiltration of zone {}, that a density, a schedule or a control changes",
                    definition.name
                ),
                "write `density: site`, or a number, and remove schedule and control",
            );
        }
        if definition.heating.is_some() || definition.cooling.is_some() {
            return refuse(
                &format!("heating or cooling of zone {}", definition.name),
                "remove heating and cooling",
            );
        }
        let flows = zone.ventilation.iter().zip(&definition.ventilation);
        if let Some((_, flow)) =
            flows.into_iter().find(|(flow, given)| flow.whole().is_none() || given.control.is_some())
        {
            return refuse(
                &format!("ventilation {} of zone {}", flow.name, definition.name),
                "remove its schedule and its control, and a density that varies",
            );
        }
    }
    Ok(())
}
