//! A linear building as matrices: `dx/dt = A x + B u`, `y = C x + D u`.
//!
//! States are cell and air temperatures; surfaces hold no heat and are eliminated. Only models whose every law is
//! linear and constant have such a form; the first law that is not is named.

use crate::building::coefficients::{Boundary, Coefficients, SurfaceCoefficients};
use crate::building::ids::SurfaceId;
use crate::building::plan::Plan;
use crate::error::EngineError;
use crate::input::description::{Infiltration, Material};
use crate::linear::wall::Chain;
use crate::physics::air_flow::AirFlow;
use crate::physics::convection::SurfaceConvection;
use crate::physics::longwave::Emission;

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
    let mut network = Network::new(plan, &coefficients);
    for wall in 0..plan.walls.len() {
        network.add_wall(wall);
    }
    for surface in plan.surfaces.ids() {
        network.add_boundary(surface);
    }
    for zone in 0..plan.zones.len() {
        network.add_zone(zone);
    }
    network.add_paths();
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

/// Coefficient of a constant film over plane area, zero where there is none [W/(m2 K)].
fn convection_coefficient(surface: &SurfaceCoefficients<f64>) -> f64 {
    surface.convection.as_ref().and_then(SurfaceConvection::constant).map_or(0.0, |h| h * surface.area_factor)
}

/// Nodes: cells, airs, then surfaces. Rows are heat balances [W].
struct Network<'a> {
    plan: &'a Plan,
    coefficients: &'a Coefficients<f64>,
    n_nodes: usize,
    n_states: usize,
    conductance: Vec<f64>,
    capacity: Vec<f64>,
    drive: Vec<Vec<f64>>,
    inputs: Vec<String>,
}

impl<'a> Network<'a> {
    fn new(plan: &'a Plan, coefficients: &'a Coefficients<f64>) -> Self {
        let n_states = plan.n_cells + plan.zones.len();
        let n_nodes = n_states + plan.surfaces.len();
        Self {
            plan,
            coefficients,
            n_nodes,
            n_states,
            conductance: vec![0.0; n_nodes * n_nodes],
            capacity: vec![0.0; n_states],
            drive: vec![Vec::new(); n_nodes],
            inputs: Vec::new(),
        }
    }

    fn surface(&self, surface: SurfaceId) -> usize {
        self.n_states + surface.index()
    }

    fn add(&mut self, row: usize, column: usize, value: f64) {
        self.conductance[row * self.n_nodes + column] += value;
    }

    fn couple(&mut self, a: usize, b: usize, conductance: f64) {
        self.add(a, a, -conductance);
        self.add(b, b, -conductance);
        self.add(a, b, conductance);
        self.add(b, a, conductance);
    }

    /// Heat into a node per unit of a named input.
    fn drive(&mut self, node: usize, input: &str, gain: f64) {
        let index = self.inputs.iter().position(|name| name == input).unwrap_or_else(|| {
            self.inputs.push(input.to_owned());
            self.inputs.len() - 1
        });
        let row = &mut self.drive[node];
        row.resize(row.len().max(index + 1), 0.0);
        row[index] += gain;
    }

    fn add_wall(&mut self, index: usize) {
        let wall = &self.coefficients.walls[index];
        let first = self.plan.walls[index].first_cell;
        let chain = Chain::new(wall);
        let n = wall.cells.len();
        let node = |i: usize, network: &Self| match i {
            0 => network.surface(SurfaceId::outside(index)),
            i if i == n + 1 => network.surface(SurfaceId::inside(index)),
            i => first + i - 1,
        };
        for (i, link) in chain.links.iter().enumerate() {
            let (left, right) = (node(i, self), node(i + 1, self));
            self.couple(left, right, wall.area * link.left);
        }
        for (i, cell) in wall.cells.iter().enumerate() {
            self.capacity[first + i] = wall.area * cell.thickness * chain.storage[i].capacity;
        }
    }

    fn add_boundary(&mut self, index: SurfaceId) {
        let surface = &self.coefficients.surfaces[index];
        let area = self.coefficients.walls[index.wall()].area;
        let node = self.surface(index);
        let wall = &self.plan.description.surfaces[index.wall()].name;
        let side = if index.is_outside() { "outside" } else { "inside" };
        let convection = convection_coefficient(surface) * area;
        if surface.irradiance.is_some() || matches!(surface.boundary, Boundary::Outdoors(_)) {
            self.drive(node, &format!("{wall}.{side}_irradiance"), area * surface.absorptance);
        }
        match &surface.boundary {
            Boundary::Outdoors(outdoors) => {
                self.add(node, node, -convection);
                self.drive(node, "outdoor_air_temperature", convection);
                if let Some(emission) = &outdoors.emission {
                    // Linear emission: offset + slope T for surface and air alike.
                    let (offset, slope) = (emission.at(0.0).0, emission.at(0.0).1);
                    let (to_sky, gain) = (outdoors.to_sky, area * surface.emissivity);
                    self.add(node, node, -gain * slope);
                    self.drive(node, "sky_emission", gain * to_sky);
                    self.drive(node, "outdoor_air_temperature", gain * (1.0 - to_sky) * slope);
                    self.drive(node, "one", -gain * to_sky * offset);
                }
            }
            Boundary::Imposed(imposed) => {
                let input = match imposed {
                    crate::building::coefficients::Imposed::Channel(channel) => {
                        self.plan.description.channels[channel - crate::input::forcing::CLIMATE_CHANNELS]
                            .clone()
                    }
                    crate::building::coefficients::Imposed::Annual { .. } => {
                        format!("{wall}.{side}_ground_temperature")
                    }
                };
                // A surface held at a temperature: a film too strong to matter would spoil the matrix, so the
                // balance of the surface is replaced by T = input.
                if surface.convection.is_none() {
                    for column in 0..self.n_nodes {
                        self.conductance[node * self.n_nodes + column] = 0.0;
                    }
                    self.add(node, node, -1.0);
                    self.drive(node, &input, 1.0);
                } else {
                    self.add(node, node, -convection);
                    self.drive(node, &input, convection);
                }
            }
            Boundary::Zone | Boundary::Adiabatic => {}
        }
    }

    fn add_zone(&mut self, zone: usize) {
        let numbers = &self.coefficients.zones[zone];
        let air = self.plan.n_cells + zone;
        let surfaces = &self.plan.zones[zone].surfaces;
        self.capacity[air] = numbers.capacity;
        for (i, &index) in surfaces.iter().enumerate() {
            let surface = &self.coefficients.surfaces[index];
            self.couple(self.surface(index), air, convection_coefficient(surface) * numbers.areas[i]);
            for (j, &other) in surfaces.iter().enumerate().skip(i + 1) {
                if let Some(&exchange) = numbers.exchange.get(i * surfaces.len() + j) {
                    let slope = numbers.emission.at(0.0).1;
                    self.couple(self.surface(index), self.surface(other), exchange * slope);
                }
            }
        }
        let ventilation: f64 = numbers.ventilation.iter().filter_map(AirFlow::whole).sum();
        let inflow = numbers.air_capacity * numbers.infiltration[0] / 3600.0 + ventilation;
        self.add(air, air, -inflow);
        self.drive(air, "outdoor_air_temperature", inflow);
        let definition = &self.plan.description.zones[zone];
        for (gain, defined) in numbers.gains.iter().zip(&definition.gains) {
            let input = format!("{}.{}_gain", definition.name, defined.name);
            self.drive(air, &input, 1.0 - gain.radiative);
            for (&surface, share) in surfaces.iter().zip(&numbers.radiant_shares) {
                self.drive(self.surface(surface), &input, gain.radiative * share);
            }
        }
    }

    fn add_paths(&mut self) {
        for path in &self.coefficients.paths {
            let [a, b] = path.between.map(|zone| self.plan.n_cells + zone);
            self.couple(a, b, path.whole().unwrap_or_default());
        }
    }

    /// Solves the massless surfaces out and divides by the capacities.
    fn eliminate_surfaces(self) -> StateSpace {
        let (n, f, m) = (self.n_states, self.plan.surfaces.len(), self.inputs.len());
        let at = |row: usize, column: usize| self.conductance[row * self.n_nodes + column];
        let gain = |row: usize, input: usize| self.drive[row].get(input).copied().unwrap_or(0.0);
        // Surfaces: -M_ff y = [M_fx | N_f] (x, u).
        let width = n + m;
        let mut matrix: Vec<f64> = (0..f * f).map(|k| -at(n + k / f, n + k % f)).collect();
        let mut response: Vec<f64> = (0..f * width)
            .map(|k| {
                let (row, column) = (n + k / width, k % width);
                if column < n { at(row, column) } else { gain(row, column - n) }
            })
            .collect();
        solve(&mut matrix, &mut response, f, width);
        let mut rows = vec![0.0; n * width];
        for i in 0..n {
            for j in 0..width {
                let direct = if j < n { at(i, j) } else { gain(i, j - n) };
                let through: f64 = (0..f).map(|k| at(i, n + k) * response[k * width + j]).sum();
                rows[i * width + j] = (direct + through) / self.capacity[i];
            }
        }
        let zones = self.plan.zones.len();
        let mut outputs = vec![0.0; zones * width];
        for zone in 0..zones {
            outputs[zone * width + self.plan.n_cells + zone] = 1.0;
        }
        outputs.extend(&response);
        let split = |all: &[f64], first: bool| -> Vec<f64> {
            all.chunks(width).flat_map(|row| if first { &row[..n] } else { &row[n..] }.to_vec()).collect()
        };
        StateSpace {
            a: split(&rows, true),
            b: split(&rows, false),
            c: split(&outputs, true),
            d: split(&outputs, false),
            states: state_names(self.plan),
            outputs: output_names(self.plan),
            inputs: self.inputs,
        }
    }
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

/// Gaussian elimination with row pivoting, `width` right-hand sides in place.
fn solve(matrix: &mut [f64], right: &mut [f64], n: usize, width: usize) {
    for k in 0..n {
        let pivot =
            (k..n).max_by(|&a, &b| matrix[a * n + k].abs().total_cmp(&matrix[b * n + k].abs())).unwrap_or(k);
        for column in 0..n {
            matrix.swap(k * n + column, pivot * n + column);
        }
        for column in 0..width {
            right.swap(k * width + column, pivot * width + column);
        }
        for i in (0..n).filter(|&i| i != k) {
            let factor = matrix[i * n + k] / matrix[k * n + k];
            if factor != 0.0 {
                for column in k..n {
                    matrix[i * n + column] -= factor * matrix[k * n + column];
                }
                for column in 0..width {
                    right[i * width + column] -= factor * right[k * width + column];
                }
            }
        }
    }
    for i in 0..n {
        for column in 0..width {
            right[i * width + column] /= matrix[i * n + i];
        }
    }
}
