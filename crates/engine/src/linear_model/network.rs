//! The heat balances of a linear building as a network: conductances, heat capacities and inputs.

use crate::balance::energy_balance::Flow;
use crate::balance::terms::{End, Held, Node, Origin, OutdoorRadiation, Sink};
use crate::building::coefficients::{Boundary, Coefficients, Imposed};
use crate::building::ids::SideId;
use crate::building::plan::Plan;
use crate::error::EngineError;
use crate::input::forcing::CLIMATE_CHANNELS;
use crate::linear::wall::{Link, Storage};
use crate::number::dense::solve_many_while;
use crate::number::line::Line;
use crate::step::control::RunControl;

use super::matrices::{StateSpace, output_names, state_names};

/// Position of an input among all: the surface (or, after all surfaces, the zone) that names it first, and its rank there.
type InputOrder = (usize, usize);

/// Nodes: cells, airs, then surfaces. Rows are heat balances [W].
pub(super) struct Network<'a> {
    plan: &'a Plan,
    coefficients: &'a Coefficients<f64>,
    n_nodes: usize,
    n_states: usize,
    /// Heat into a row per degree of a column [W/K].
    conductance: Vec<f64>,
    /// Of the states [J/K].
    capacity: Vec<f64>,
    /// Heat into a node per unit of each input.
    drive: Vec<Vec<f64>>,
    inputs: Vec<(InputOrder, String)>,
    /// Surfaces that are held at an input.
    held: Vec<(usize, usize)>,
}

impl<'a> Network<'a> {
    pub(super) fn new(plan: &'a Plan, coefficients: &'a Coefficients<f64>) -> Self {
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
            held: Vec::new(),
        }
    }

    fn row(&self, node: Node) -> usize {
        match node {
            Node::Cell(cell) => cell,
            Node::Air(zone) => self.plan.n_cells + zone,
            Node::Surface(surface) => self.n_states + surface.index(),
        }
    }

    fn add(&mut self, row: usize, column: usize, value: f64) {
        self.conductance[row * self.n_nodes + column] += value;
    }

    /// Heat `left T_from - right T_to + offset` [W] from one node to another.
    fn couple(&mut self, ends: [Node; 2], [left, right]: [f64; 2], offset: f64) {
        let [from, to] = ends.map(|node| self.row(node));
        self.add(from, from, -left);
        self.add(from, to, right);
        self.add(to, to, -right);
        self.add(to, from, left);
        if offset != 0.0 {
            for (node, sign) in ends.into_iter().zip([-1.0, 1.0]) {
                self.drive(node, (0, 3), "one", sign * offset);
            }
        }
    }

    fn input(&mut self, order: InputOrder, name: &str) -> usize {
        if let Some(index) = self.inputs.iter().position(|(_, known)| known == name) {
            let first = &mut self.inputs[index].0;
            *first = order.min(*first);
            return index;
        }
        self.inputs.push((order, name.to_owned()));
        self.inputs.len() - 1
    }

    /// Heat into a node per unit of a named input.
    fn drive(&mut self, node: Node, order: InputOrder, name: &str, gain: f64) {
        let (index, row) = (self.input(order, name), self.row(node));
        let row = &mut self.drive[row];
        row.resize(row.len().max(index + 1), 0.0);
        row[index] += gain;
    }

    /// The surface or zone that a node counts with in the order of inputs.
    fn place(&self, node: Node) -> usize {
        match node {
            Node::Surface(surface) => surface.index(),
            Node::Air(zone) => self.plan.surfaces.len() + zone,
            Node::Cell(_) => 0,
        }
    }

    /// `<wall>.<side>_<quantity>`.
    fn surface_input(&self, surface: SideId, quantity: &str) -> String {
        let wall = &self.plan.description.surfaces[surface.wall()].name;
        let side = if surface.is_outside() { "outside" } else { "inside" };
        format!("{wall}.{side}_{quantity}")
    }

    /// Name of the temperature imposed on a surface.
    fn imposed_input(&self, surface: SideId) -> String {
        match &self.coefficients.surfaces[surface].boundary {
            Boundary::Imposed(Imposed::Channel(channel)) => {
                self.plan.description.channels[channel - CLIMATE_CHANNELS].clone()
            }
            _ => self.surface_input(surface, "ground_temperature"),
        }
    }

    /// Heat by the outdoor air into a cell of soil, a channel for each cell that has some.
    fn drive_soil(&mut self, cell: usize, area: f64) {
        let plan = self.plan;
        for (w, surface) in plan.description.surfaces.iter().enumerate() {
            let Some(soil) = &surface.soil else { continue };
            let innermost = plan.walls[w].first_cell + soil.capacities.len() - 1;
            let heated = soil.heat.iter().enumerate().find(|(next, _)| innermost - next == cell);
            if let Some((_, &channel)) = heated {
                let order = (SideId::outside(w).index(), 0);
                self.drive(Node::Cell(cell), order, &plan.description.channels[channel], area);
            }
        }
    }

    /// Gains of a zone into a node: a share of the convective (0) or radiant (1) part of each of them.
    fn drive_by_gains(&mut self, node: Node, zone: usize, part: usize, share: f64) {
        let (plan, coefficients) = (self.plan, self.coefficients);
        let definition = &plan.description.zones[zone];
        let gains = coefficients.zones[zone].gains.iter().zip(&definition.gains);
        for (rank, (gain, defined)) in gains.enumerate() {
            let name = format!("{}.{}_gain", definition.name, defined.name);
            let order = (plan.surfaces.len() + zone, 1 + rank);
            self.drive(node, order, &name, share * gain.parts()[part]);
        }
    }

    /// Replaces the balances of surfaces held at a temperature by `0 = input - T`.
    fn hold_surfaces(&mut self) {
        for &(row, input) in &self.held {
            self.conductance[row * self.n_nodes..(row + 1) * self.n_nodes].fill(0.0);
            self.conductance[row * self.n_nodes + row] = -1.0;
            self.drive[row] = vec![0.0; input + 1];
            self.drive[row][input] = 1.0;
        }
    }

    /// Inputs in the order of the surfaces and zones that name them first.
    fn sort_inputs(&mut self) {
        let mut order: Vec<usize> = (0..self.inputs.len()).collect();
        order.sort_by_key(|&input| self.inputs[input].0);
        for row in &mut self.drive {
            *row = order.iter().map(|&input| row.get(input).copied().unwrap_or(0.0)).collect();
        }
        self.inputs = order.iter().map(|&input| self.inputs[input].clone()).collect();
    }

    /// Solves the massless surfaces out and divides by the capacities.
    ///
    /// # Errors
    /// [`EngineError::Interrupted`].
    pub(super) fn eliminate_surfaces(mut self, control: &RunControl) -> Result<StateSpace, EngineError> {
        self.hold_surfaces();
        self.sort_inputs();
        let (n, f, m) = (self.n_states, self.plan.surfaces.len(), self.inputs.len());
        let at = |row: usize, column: usize| self.conductance[row * self.n_nodes + column];
        let gain = |row: usize, input: usize| self.drive[row][input];
        // Surfaces: -M_ff y = [M_fx | N_f] (x, u). What leaves a surface to other surfaces is a part of what leaves it to all
        // nodes, and rows of held surfaces are those of the unit matrix: the matrix is diagonally dominant.
        let width = n + m;
        let mut matrix: Vec<f64> = (0..f * f).map(|k| -at(n + k / f, n + k % f)).collect();
        let mut response: Vec<f64> = (0..f * width)
            .map(|k| {
                let (row, column) = (n + k / width, k % width);
                if column < n { at(row, column) } else { gain(row, column - n) }
            })
            .collect();
        solve_many_while(|| control.check(), &mut matrix, &mut response, width)?;
        let mut rows = vec![0.0; n * width];
        for i in 0..n {
            control.check()?;
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
        Ok(StateSpace {
            a: split(&rows, true),
            b: split(&rows, false),
            c: split(&outputs, true),
            d: split(&outputs, false),
            states: state_names(self.plan),
            outputs: output_names(self.plan),
            inputs: self.inputs.into_iter().map(|(_, name)| name).collect(),
        })
    }
}

impl Sink<f64> for Network<'_> {
    fn store_heat(&mut self, node: Node, [area, thickness]: [f64; 2], capacity: f64, _held: Held<f64>) {
        let row = self.row(node);
        self.capacity[row] = area * thickness * capacity;
    }

    fn store_enthalpy(
        &mut self,
        cell: usize,
        [area, thickness]: [f64; 2],
        enthalpy: &Storage<f64>,
        _held: Held<f64>,
    ) {
        self.capacity[cell] = area * thickness * enthalpy.capacity;
    }

    fn conduct(&mut self, ends: [Node; 2], area: f64, conductance: f64) {
        self.couple(ends, [area * conductance; 2], 0.0);
    }

    fn carry(&mut self, ends: [Node; 2], conductance: f64, _reference: f64) {
        self.couple(ends, [conductance, 0.0], 0.0);
        for (node, sign) in ends.into_iter().zip([1.0, -1.0]) {
            self.drive(node, (self.place(node), 1), "outdoor_air_temperature", sign * conductance);
        }
    }

    fn conduct_linearised(&mut self, ends: [Node; 2], area: f64, link: &Link<f64>, places: [f64; 2]) {
        let offset = link.flux(-places[0], -places[1]);
        self.couple(ends, [area * link.left, area * link.right], area * offset);
    }

    fn exchange(&mut self, ends: [End<f64>; 2], area: f64, law: &Line<f64>) {
        let (slope, offset) = (area * law.slope, area * law.offset);
        let (node, flow, offset) = match ends {
            [End::Node(from), End::Node(to)] => return self.couple([from, to], [slope; 2], offset),
            [End::Node(node), End::Environment { flow, .. }] => (node, flow, -offset),
            [End::Environment { flow, .. }, End::Node(node)] => (node, flow, offset),
            [End::Environment { .. }, End::Environment { .. }] => return,
        };
        let (row, place) = (self.row(node), self.place(node));
        self.add(row, row, -slope);
        match (flow, node) {
            (Flow::Boundary, Node::Surface(surface)) => {
                let name = self.imposed_input(surface);
                self.drive(node, (place, 1), &name, slope);
            }
            _ => self.drive(node, (place, 1), "outdoor_air_temperature", slope),
        }
        if offset != 0.0 {
            self.drive(node, (place, 3), "one", offset);
        }
    }

    fn radiate(&mut self, surfaces: [SideId; 2], area: f64, [from, to]: [&Line<f64>; 2]) {
        let offset = area * (from.offset - to.offset);
        self.couple(surfaces.map(Node::Surface), [area * from.slope, area * to.slope], offset);
    }

    fn radiate_outdoors(&mut self, surface: SideId, area: f64, radiation: &OutdoorRadiation<'_, f64>) {
        let (node, place) = (Node::Surface(surface), surface.index());
        let (row, OutdoorRadiation { emissivity, emission, sky_factor, air_factor, .. }) =
            (self.row(node), radiation);
        // Surface and outdoor air emit by one linear law, `offset + slope T`.
        self.add(row, row, -(area * emissivity) * emission.slope);
        self.drive(node, (place, 1), "outdoor_air_temperature", area * air_factor * emission.slope);
        self.drive(node, (place, 2), "sky_emission", area * sky_factor);
        self.drive(node, (place, 3), "one", area * (air_factor - emissivity) * emission.offset);
    }

    fn release(&mut self, node: Node, size: f64, _heat: f64, origin: Origin<f64>) {
        match (origin, node) {
            (Origin::Sun { absorptance }, Node::Surface(surface)) => {
                let name = self.surface_input(surface, "irradiance");
                self.drive(node, (surface.index(), 0), &name, size * absorptance);
            }
            (Origin::ConvectiveGains { zone }, _) => self.drive_by_gains(node, zone, 0, size),
            (Origin::RadiantGains { zone }, _) => self.drive_by_gains(node, zone, 1, size),
            (Origin::HeatFlux, Node::Surface(surface)) => {
                let name = self.surface_input(surface, "heat_flux");
                self.drive(node, (surface.index(), 0), &name, size);
            }
            // The only heat sources of a linear building.
            (Origin::HeatSource, Node::Cell(cell)) => self.drive_soil(cell, size),
            // A linear building has neither windows nor ideal loads.
            (
                Origin::Sun { .. }
                | Origin::Window
                | Origin::HeatFlux
                | Origin::HeatSource
                | Origin::IdealLoad,
                _,
            ) => {}
        }
    }

    fn impose(&mut self, surface: SideId, _area: f64, _temperature: f64) {
        let name = self.imposed_input(surface);
        let input = self.input((surface.index(), 1), &name);
        self.held.push((self.n_states + surface.index(), input));
    }
}
