//! A linear building as matrices: `dx/dt = A x + B u`, `y = C x + D u`.
//!
//! States are cell and air temperatures; surfaces store no heat and are eliminated. The matrices come from the heat
//! balances of [`crate::balance::terms`]. Only buildings whose laws are all linear and constant have such a form; for the
//! others the error names the first law that is not.

mod network;

use crate::balance::terms::{Contents, Stage};
use crate::building::coefficients::{Boundary, Coefficients};
use crate::building::plan::Plan;
use crate::error::EngineError;
use crate::input::description::{Infiltration, Material};
use crate::physics::longwave::Emission;
use crate::step::{Scheme, Stepper};

use network::Network;

/// Matrices in row-major order with names for their rows and columns.
#[derive(Debug, Clone)]
pub struct StateSpace {
    /// States x states [1/s].
    pub a: Vec<f64>,

    /// States x inputs [K/s per unit of the input].
    pub b: Vec<f64>,

    /// Outputs x states [-].
    pub c: Vec<f64>,

    /// Outputs x inputs [K per unit of the input].
    pub d: Vec<f64>,

    /// Name of each state, a temperature [degC].
    pub states: Vec<String>,

    /// Name of each input: temperatures [degC], irradiances and emissions [W/m2], gains [W].
    pub inputs: Vec<String>,

    /// Name of each output, a temperature [degC].
    pub outputs: Vec<String>,
}

/// Writes a plan at a parameter vector as matrices.
///
/// # Errors
/// [`EngineError::Input`] naming the first law that is not linear and constant.
pub fn state_space(plan: &Plan, numbers: &[f64]) -> Result<StateSpace, EngineError> {
    let coefficients = Coefficients::new(plan, numbers);
    require_linear(plan, numbers, &coefficients)?;
    // Laws are linear: their tangents at 0 degC and in calm air are the laws themselves.
    let mut stepper = Stepper::new(plan, numbers, Scheme::BackwardEuler);
    stepper.linearise_at_rest();
    let mut network = Network::new(plan, &coefficients);
    let nothing = vec![0.0; plan.n_cells.max(plan.zones.len())];
    let contents = Contents { cells: &nothing, enthalpy: &nothing, air: &nothing };
    let stage = Stage { length: f64::INFINITY, ratio: 0.0, start: contents, first: contents };
    stepper.balances().visit(&stage, &mut network);
    Ok(network.eliminate_surfaces())
}

fn require_linear(plan: &Plan, numbers: &[f64], coefficients: &Coefficients<f64>) -> Result<(), EngineError> {
    let refuse = |what: String, remedy: &str| {
        Err(EngineError::Input(format!("no state space: {what} is not linear and constant; {remedy}")))
    };
    for material in &plan.description.materials {
        if let Material::Pcm { law: _, conductivity, .. } = material {
            let path = &plan.description.parameters[conductivity[0].0 as usize].path;
            let name = path.split('.').nth(1).unwrap_or(path);
            return refuse(format!("materials.{name} (phase change)"), "replace it by a solid");
        }
    }
    if let Some(&window) = plan.windows.first() {
        let name = &plan.description.surfaces[window].name;
        return refuse(format!("window {name}"), "replace it by a wall of a resistance");
    }
    for (index, surface) in coefficients.surfaces.entries() {
        let name = plan.surface_name(index);
        if surface.convection.as_ref().is_some_and(|convection| convection.constant().is_none()) {
            return refuse(format!("convection at {name}"), "use a constant coefficient");
        }
        if let Boundary::Outdoors(outdoors) = &surface.boundary
            && matches!(outdoors.emission, Some(Emission::Exact))
        {
            return refuse(
                format!("long-wave exchange at {name}"),
                "use `longwave: {kind: linearised, ...}`",
            );
        }
    }
    for (zone, definition) in coefficients.zones.iter().zip(&plan.description.zones) {
        if !zone.exchange.is_empty() && matches!(zone.emission, Emission::Exact) {
            return refuse(
                format!("long-wave exchange in zone {}", definition.name),
                "use `longwave: {kind: linearised, ...}`",
            );
        }
        let Infiltration { temperature, wind, .. } = &definition.infiltration;
        if [temperature, wind].iter().any(|id| numbers[id.0 as usize] != 0.0) {
            return refuse(
                format!("infiltration of zone {}", definition.name),
                "keep only its constant part",
            );
        }
        if definition.heating.is_some() || definition.cooling.is_some() {
            return refuse(format!("the plant of zone {}", definition.name), "remove heating and cooling");
        }
        let flows = zone.ventilation.iter().zip(&definition.ventilation);
        if let Some((_, flow)) = flows.into_iter().find(|(flow, _)| flow.whole().is_none()) {
            return refuse(
                format!("ventilation {} of zone {}", flow.name, definition.name),
                "remove its schedule",
            );
        }
    }
    if let Some(opening) = plan.description.openings.first() {
        return refuse(format!("opening {}", opening.name), "use ventilation without a schedule");
    }
    let paths = coefficients.paths.iter().zip(&plan.description.air_paths);
    if let Some((_, path)) = paths.into_iter().find(|(path, _)| path.whole().is_none()) {
        return refuse(format!("air path {}", path.name), "remove its schedule");
    }
    Ok(())
}

fn state_names(plan: &Plan) -> Vec<String> {
    let mut names = Vec::with_capacity(plan.n_cells + plan.zones.len());
    for (wall, described) in plan.walls.iter().zip(&plan.description.surfaces) {
        let layers = &plan.description.constructions[described.construction].layers;
        for (i, &layer) in wall.cell_layers.iter().enumerate() {
            let number = i - wall.layer_cells[layer].0 + 1;
            names.push(format!("{}.{}_{number}_temperature", described.name, layers[layer].name));
        }
    }
    names.extend(plan.description.zones.iter().map(|zone| format!("{}.air_temperature", zone.name)));
    names
}

fn output_names(plan: &Plan) -> Vec<String> {
    let airs = plan.description.zones.iter().map(|zone| format!("{}.air_temperature", zone.name));
    let surfaces = plan.description.surfaces.iter().flat_map(|described| {
        ["outside", "inside"].map(|side| format!("{}.{side}_temperature", described.name))
    });
    airs.chain(surfaces).collect()
}

#[cfg(test)]
mod tests;
