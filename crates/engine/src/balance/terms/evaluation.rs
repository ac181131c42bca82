//! Terms evaluated at temperatures: heat flows [W].

use crate::balance::energy_balance::Flow;
use crate::building::ids::{BySide, SideId};
use crate::linear::wall::{Link, Storage};
use crate::number::line::Line;
use crate::number::real::Real;

use super::{End, Held, Node, Origin, OutdoorRadiation, Sink};

/// Takes heat flows.
pub(crate) trait HeatSink<S: Real> {
    /// Heat [W] into a node, and the area, share or 1 that it was multiplied by.
    #[inline(always)]
    fn add_to_node(&mut self, _node: Node, _size: S, _heat: S) {}

    /// Heat from the environment into the building [W].
    #[inline(always)]
    fn add_to_building(&mut self, _flow: Flow, _heat: S) {}

    /// A surface is held at a temperature [degC].
    #[inline(always)]
    fn impose(&mut self, _surface: SideId, _area: S, _temperature: S) {}
}

/// The temperatures that terms are evaluated at [degC], and where their heat goes.
pub(crate) struct Evaluation<'a, S, H> {
    pub(crate) cells: &'a [S],
    pub(crate) surfaces: &'a BySide<S>,
    pub(crate) air: &'a [S],
    pub(crate) heat: H,
}

impl<S: Real, H: HeatSink<S>> Evaluation<'_, S, H> {
    #[inline(always)]
    fn temperature(&self, node: Node) -> S {
        match node {
            Node::Cell(cell) => self.cells[cell],
            Node::Surface(surface) => self.surfaces[surface],
            Node::Air(zone) => self.air[zone],
        }
    }

    /// Heat from one zone to another.
    #[inline(always)]
    fn interzone(&mut self, heat: S) {
        self.heat.add_to_building(Flow::Interzone, heat);
        self.heat.add_to_building(Flow::Interzone, -heat);
    }

    /// Heat from one node to another.
    #[inline(always)]
    fn between(&mut self, [from, to]: [Node; 2], size: S, heat: S) {
        self.heat.add_to_node(from, size, -heat);
        self.heat.add_to_node(to, size, heat);
    }
}

impl<S: Real, H: HeatSink<S>> Sink<S> for Evaluation<'_, S, H> {
    #[inline(always)]
    fn store_heat(&mut self, node: Node, [area, thickness]: [S; 2], capacity: S, held: Held<S>) {
        let rise = self.temperature(node) - held.value();
        let heat = area * thickness * capacity * rise.scale(1.0 / held.length);
        self.heat.add_to_node(node, area, -heat);
    }

    #[inline(always)]
    fn store_enthalpy(
        &mut self,
        cell: usize,
        [area, thickness]: [S; 2],
        enthalpy: &Storage<S>,
        held: Held<S>,
    ) {
        let reached = enthalpy.offset + enthalpy.capacity * (self.cells[cell] - enthalpy.reference);
        let heat = area * thickness * (reached - held.value()).scale(1.0 / held.length);
        self.heat.add_to_node(Node::Cell(cell), area, -heat);
    }

    #[inline(always)]
    fn conduct(&mut self, ends: [Node; 2], area: S, conductance: S) {
        let [from, to] = ends.map(|node| self.temperature(node));
        let heat = area * (conductance * (from - to));
        self.between(ends, area, heat);
        if let [Node::Air(_), Node::Air(_)] = ends {
            self.interzone(heat);
        }
    }

    #[inline(always)]
    fn carry(&mut self, ends: [Node; 2], conductance: S, reference: S) {
        let heat = conductance * (self.temperature(ends[0]) - reference);
        self.between(ends, S::one(), heat);
        self.interzone(heat);
    }

    #[inline(always)]
    fn conduct_linearised(&mut self, ends: [Node; 2], area: S, link: &Link<S>, places: [S; 2]) {
        let left = self.temperature(ends[0]) - places[0];
        let right = self.temperature(ends[1]) - places[1];
        self.between(ends, area, area * link.flux(left, right));
    }

    #[inline(always)]
    fn exchange(&mut self, ends: [End<S>; 2], area: S, law: &Line<S>) {
        let temperature = |end: End<S>| match end {
            End::Node(node) => self.temperature(node),
            End::Environment { temperature, .. } => temperature,
        };
        let heat = area * law.at(temperature(ends[0]) - temperature(ends[1]));
        for (end, heat) in ends.into_iter().zip([-heat, heat]) {
            match end {
                End::Node(node) => self.heat.add_to_node(node, area, heat),
                // Heat that leaves the environment enters the building.
                End::Environment { flow, .. } => self.heat.add_to_building(flow, -heat),
            }
        }
        if let [End::Node(Node::Air(_)), End::Node(Node::Air(_))] = ends {
            self.interzone(heat);
        }
    }

    #[inline(always)]
    fn radiate(&mut self, surfaces: [SideId; 2], area: S, [from, to]: [&Line<S>; 2]) {
        let [a, b] = surfaces.map(|surface| self.surfaces[surface]);
        self.between(surfaces.map(Node::Surface), area, area * (from.at(a) - to.at(b)));
    }

    #[inline(always)]
    fn radiate_outdoors(&mut self, surface: SideId, area: S, radiation: &OutdoorRadiation<'_, S>) {
        let emitted = radiation.emissivity * radiation.emission.at(self.surfaces[surface]);
        let heat = area * (radiation.arriving - emitted);
        self.heat.add_to_node(Node::Surface(surface), area, heat);
        self.heat.add_to_building(Flow::Longwave, heat);
    }

    #[inline(always)]
    fn release(&mut self, node: Node, size: S, heat: S, origin: Origin<S>) {
        let heat = size * heat;
        self.heat.add_to_node(node, size, heat);
        match origin {
            Origin::Sun { .. } => self.heat.add_to_building(Flow::Solar, heat),
            Origin::HeatFlux => self.heat.add_to_building(Flow::Boundary, heat),
            Origin::HeatSource => self.heat.add_to_building(Flow::Sources, heat),
            Origin::IdealLoad => {
                self.heat.add_to_building(Flow::Heating, heat.max(S::zero()));
                self.heat.add_to_building(Flow::Cooling, heat.min(S::zero()));
            }
            Origin::Window | Origin::ConvectiveGains { .. } | Origin::RadiantGains { .. } => {}
        }
    }

    #[inline(always)]
    fn impose(&mut self, surface: SideId, area: S, temperature: S) {
        self.heat.impose(surface, area, temperature);
    }

    #[inline(always)]
    fn count(&mut self, flow: Flow, heat: S) {
        self.heat.add_to_building(flow, heat);
    }
}
