//! The matrices of a linear model, and the names of their rows and columns.

use crate::building::plan::Plan;

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

    /// Name of each input: temperatures [degC], irradiances, emissions and heat fluxes [W/m2], gains [W].
    pub inputs: Vec<String>,

    /// Name of each output, a temperature [degC].
    pub outputs: Vec<String>,
}

/// Names of the states.
pub(super) fn state_names(plan: &Plan) -> Vec<String> {
    let mut names = Vec::with_capacity(plan.n_cells + plan.zones.len());
    for (wall, described) in plan.walls.iter().zip(&plan.description.surfaces) {
        let layers = &plan.description.constructions[described.construction].layers;
        for (i, &layer) in wall.cell_layers.iter().enumerate() {
            if i < wall.soil {
                names.push(format!("{}.soil_{}_temperature", described.name, wall.soil - i));
                continue;
            }
            let number = i - wall.layer_cells[layer].0 + 1;
            names.push(format!("{}.{}_{number}_temperature", described.name, layers[layer].name));
        }
    }
    names.extend(plan.description.zones.iter().map(|zone| format!("{}.air_temperature", zone.name)));
    names
}

/// Names of the outputs.
pub(super) fn output_names(plan: &Plan) -> Vec<String> {
    let airs = plan.description.zones.iter().map(|zone| format!("{}.air_temperature", zone.name));
    let surfaces = plan.description.surfaces.iter().flat_map(|described| {
        ["outside", "inside"].map(|side| format!("{}.{side}_temperature", described.name))
    });
    airs.chain(surfaces).collect()
}
