//! The heat balances of a building, term by term: each equation is written here and nowhere else.
//!
//! Unknowns are the temperatures of the cells of walls, of surfaces and of zone airs. In the balance of each, the heat
//! that flows in is the heat stored; surfaces store none:
//!
//! - cell: storage, conduction to its neighbours, sun absorbed in panes, heat sources in planes between layers;
//! - surface: conduction into its wall, convection, emission and exchange of long-wave radiation, absorbed sun, radiant
//!   gains and radiated ideal loads; or an imposed temperature in place of a balance; an adiabatic surface has only what is left;
//! - zone air: storage, convection from surfaces, infiltration, ventilation and openings, air paths and doors, fans, thermal
//!   bridges, convective gains, sun, ideal load.
//!
//! Nonlinear laws are replaced by their tangents. [`Balances`] goes through all terms and passes each of them to a [`Sink`]:
//! the residual ([`residual`]), the slopes of the equations (`derivatives`), the linear model (`linear_model`), the energy
//! ledger ([`heat_flows`]). The run itself solves the same balances by a fast elimination (`linear`, `step`): the only
//! second copy; a test compares it with this one.

pub(crate) mod evaluation;
pub(crate) mod heat_flows;
pub(crate) mod residual;
#[cfg(test)]
mod tests;

use crate::balance::energy_balance::Flow;
use crate::balance::flow_index::FlowIndex;
use crate::building::coefficients::{BridgeEnd, Matter};
use crate::building::ids::SideId;
use crate::building::model::Model;
use crate::linear::laws::LinearisedLaws;
use crate::linear::wall::{Link, Storage, WallSystem};
use crate::number::line::Line;
use crate::number::real::Real;
use crate::weather::conditions::Conditions;

/// What a temperature, and a balance, belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Node {
    /// A cell, counted through all walls.
    Cell(usize),
    Surface(SideId),
    /// The air of a zone.
    Air(usize),
}

/// One end of an exchange of heat.
#[derive(Debug, Clone, Copy)]
pub(crate) enum End<S> {
    Node(Node),
    /// The environment, at a temperature [degC]. For [`Flow::Boundary`] it is the one imposed on the surface at the other
    /// end, else that of the outdoor air.
    Environment {
        flow: Flow,
        temperature: S,
    },
}

/// Where released heat comes from.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Origin<S> {
    /// The sun, by the irradiance of the surface and its absorptance [-].
    Sun {
        absorptance: S,
    },
    /// The sun through windows or in their panes; it is counted where it enters, see [`Sink::count`].
    Window,
    /// A heat flux that is given at a surface.
    HeatFlux,
    /// A heat source in a wall.
    HeatSource,
    /// Gains of a zone; counted by zone.
    ConvectiveGains {
        zone: usize,
    },
    RadiantGains {
        zone: usize,
    },
    /// Ideal heating or cooling.
    IdealLoad,
}

/// Long-wave radiation between a surface and what it sees outdoors, `arriving - emissivity emission(T)` [W/m2];
/// `arriving = sky_factor E_sky + air_factor E_air` with the black emissions of sky and outdoor air.
#[derive(Debug, Clone, Copy)]
pub(crate) struct OutdoorRadiation<'a, S> {
    pub(crate) emissivity: S,
    /// Black emission of the surface.
    pub(crate) emission: &'a Line<S>,
    pub(crate) arriving: S,
    /// Absorbed parts of the emission of the sky and of the outdoor air [-].
    pub(crate) sky_factor: S,
    pub(crate) air_factor: S,
}

/// A quantity at the start of a stage: `start + ratio (first - start)`; `first` is its value at the end of the first stage.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Held<S> {
    pub(crate) start: S,
    pub(crate) first: S,
    /// Zero in the first stage.
    pub(crate) ratio: f64,
    /// Length of the stage [s].
    pub(crate) length: f64,
}

impl<S: Real> Held<S> {
    #[inline(always)]
    pub(crate) fn value(&self) -> S {
        // In the first stage `first` has no meaning yet, and may be no number.
        if self.ratio == 0.0 { self.start } else { self.start + (self.first - self.start).scale(self.ratio) }
    }
}

/// Temperatures of cells [degC], enthalpies of the cells of nonlinear walls [J/m3], temperatures of airs [degC].
#[derive(Debug, Clone, Copy)]
pub(crate) struct Contents<'a, S> {
    pub(crate) cells: &'a [S],
    pub(crate) enthalpy: &'a [S],
    pub(crate) air: &'a [S],
}

/// A stage of a step: its effective length [s], and what was stored when it began, see [`Held`].
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stage<'a, S> {
    pub(crate) length: f64,
    pub(crate) ratio: f64,
    pub(crate) start: Contents<'a, S>,
    pub(crate) first: Contents<'a, S>,
}

impl<S: Real> Stage<'_, S> {
    #[inline(always)]
    fn held(&self, start: S, first: S) -> Held<S> {
        Held { start, first, ratio: self.ratio, length: self.length }
    }
}

/// Takes the terms of all balances. Heat counts as positive from the first end to the second, and into a node.
pub(crate) trait Sink<S: Real> {
    /// The terms that follow, up to the next call, belong to a wall.
    #[inline(always)]
    fn begin_wall(&mut self, _wall: usize) {}

    /// The terms that follow, up to the next call, belong to a zone.
    #[inline(always)]
    fn begin_zone(&mut self, _zone: usize) {}

    /// Whether the sink takes the terms of a wall.
    #[inline(always)]
    fn takes_wall(&self, _wall: usize) -> bool {
        true
    }

    /// Whether the sink counts the heat that enters the building, see [`Self::count`].
    #[inline(always)]
    fn counts(&self) -> bool {
        true
    }

    /// Whether the sink takes the radiation between the surfaces of the zone: their pairs are many.
    #[inline(always)]
    fn takes_radiation(&self) -> bool {
        true
    }

    /// A node of constant heat capacity stores `area thickness capacity (T - held) / length` [W].
    fn store_heat(&mut self, node: Node, sizes: [S; 2], capacity: S, held: Held<S>);

    /// A cell stores `area thickness (enthalpy(T) - held) / length` [W].
    fn store_enthalpy(&mut self, cell: usize, sizes: [S; 2], enthalpy: &Storage<S>, held: Held<S>);

    /// `area conductance (T_from - T_to)` [W].
    fn conduct(&mut self, ends: [Node; 2], area: S, conductance: S);

    /// `area (left (T_from - place_from) - right (T_to - place_to) + offset)` [W].
    fn conduct_linearised(&mut self, ends: [Node; 2], area: S, link: &Link<S>, places: [S; 2]);

    /// `conductance (T_from - reference)` [W], carried with air from one zone to another.
    fn carry(&mut self, ends: [Node; 2], conductance: S, reference: S);

    /// `area law(T_from - T_to)` [W].
    fn exchange(&mut self, ends: [End<S>; 2], area: S, law: &Line<S>);

    /// `area (emission_from(T_from) - emission_to(T_to))` [W]; all surfaces of a zone follow one law.
    fn radiate(&mut self, surfaces: [SideId; 2], area: S, emission: [&Line<S>; 2]);

    /// Long-wave radiation into a surface outdoors, times its area [W].
    fn radiate_outdoors(&mut self, surface: SideId, area: S, radiation: &OutdoorRadiation<'_, S>);

    /// `size heat` [W] released in a node: an area [m2] by a heat flow density [W/m2], or a share [-] by a power [W].
    fn release(&mut self, node: Node, size: S, heat: S, origin: Origin<S>);

    /// A surface is held at a temperature [degC]: this takes the place of its balance.
    fn impose(&mut self, surface: SideId, area: S, temperature: S);

    /// Heat that enters the building [W] and is released in several nodes: counted once, where it enters.
    #[inline(always)]
    fn count(&mut self, _flow: Flow, _heat: S) {}
}

/// All that the balances of a stage are made of.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Balances<'a, S: Real> {
    pub(crate) model: &'a Model<'a, S>,
    pub(crate) index: &'a FlowIndex<S>,
    pub(crate) conditions: &'a Conditions<S>,
    /// Linearised walls.
    pub(crate) walls: &'a [WallSystem<S>],
    /// Linearised laws of surfaces and zones.
    pub(crate) laws: &'a LinearisedLaws<S>,
    /// Ideal loads [W].
    pub(crate) load: &'a [S],
}

impl<S: Real> Balances<'_, S> {
    /// All terms of all balances.
    #[inline(always)]
    pub(crate) fn visit(&self, stage: &Stage<'_, S>, sink: &mut impl Sink<S>) {
        self.cells(stage, sink);
        self.heat_sources(sink);
        self.sun_inside(sink);
        self.exterior_surfaces(sink);
        self.imposed_temperatures(sink);
        if sink.counts() {
            self.windows(sink);
            self.gains(sink);
        }
        self.zones(stage, sink);
        self.outdoor_air(sink);
        self.air_paths(sink);
        self.mechanical_air(sink);
        self.bridges(sink);
        self.sun_to_air(sink);
        self.ideal_loads(sink);
    }

    // ------------------------------------------------------------ inside the building

    /// Storage in cells, conduction along walls, sun absorbed in cells of panes.
    #[inline(always)]
    fn cells(&self, stage: &Stage<'_, S>, sink: &mut impl Sink<S>) {
        for (w, (wall, chain)) in self.model.plan.walls.iter().zip(self.walls).enumerate() {
            let (numbers, first, n) = (&self.model.coefficients.walls[w], wall.first_cell, wall.len());
            if !sink.takes_wall(w) {
                continue;
            }
            sink.begin_wall(w);
            for (i, cell) in numbers.cells.iter().enumerate() {
                let (k, sizes) = (first + i, [numbers.area, cell.thickness]);
                if wall.nonlinear {
                    let held = stage.held(stage.start.enthalpy[k], stage.first.enthalpy[k]);
                    sink.store_enthalpy(k, sizes, &chain.storage[i], held);
                } else if let Matter::Solid { capacity, .. } = cell.matter {
                    let held = stage.held(stage.start.cells[k], stage.first.cells[k]);
                    sink.store_heat(Node::Cell(k), sizes, capacity, held);
                }
            }
            let node = |link: usize| match link {
                0 => Node::Surface(SideId::outside(w)),
                link if link == n + 1 => Node::Surface(SideId::inside(w)),
                link => Node::Cell(first + link - 1),
            };
            let place = |link: usize| {
                if link == 0 || link == n + 1 { S::zero() } else { chain.storage[link - 1].reference }
            };
            for (j, link) in chain.links.iter().enumerate() {
                let ends = [node(j), node(j + 1)];
                if wall.nonlinear {
                    sink.conduct_linearised(ends, numbers.area, link, [place(j), place(j + 1)]);
                } else {
                    sink.conduct(ends, numbers.area, link.left);
                }
            }
        }
        for (&w, window) in self.model.plan.windows.iter().zip(&self.conditions.sun.windows) {
            let (area, first) = (self.model.coefficients.walls[w].area, self.model.plan.walls[w].first_cell);
            for (i, &heat) in window.cells.iter().enumerate() {
                sink.release(Node::Cell(first + i), area, heat, Origin::Window);
            }
        }
    }

    /// Heat released between layers of walls.
    #[inline(always)]
    pub(crate) fn heat_sources(&self, sink: &mut impl Sink<S>) {
        for (source, at) in self.model.coefficients.heat_sources.iter().zip(&self.conditions.heat_sources) {
            let (node, area) = (Node::Cell(source.cell), self.model.coefficients.walls[source.wall].area);
            if source.water.is_some() {
                let water = End::Environment { flow: Flow::Sources, temperature: at.supply };
                let law = Line { offset: S::zero(), slope: at.conductance };
                sink.exchange([water, End::Node(node)], area, &law);
            } else {
                sink.release(node, area, at.heat, Origin::HeatSource);
            }
        }
    }

    /// Sun that came through windows, or is absorbed by the outer panes of windows that do not face outdoors.
    #[inline(always)]
    fn sun_inside(&self, sink: &mut impl Sink<S>) {
        for &(surface, area) in &self.index.transmitted_sun {
            let solar = self.conditions.surfaces[surface].solar;
            sink.release(Node::Surface(surface), area, solar, Origin::Window);
        }
    }

    /// Storage in the airs; convection, long-wave exchange and radiant gains at the surfaces of zones.
    #[inline(always)]
    fn zones(&self, stage: &Stage<'_, S>, sink: &mut impl Sink<S>) {
        let one = S::one();
        for (z, (zone, numbers)) in
            self.model.plan.zones.iter().zip(&self.model.coefficients.zones).enumerate()
        {
            sink.begin_zone(z);
            let held = stage.held(stage.start.air[z], stage.first.air[z]);
            sink.store_heat(Node::Air(z), [one; 2], numbers.capacity, held);
            let n = zone.surfaces.len();
            let radiation = !numbers.exchange.is_empty() && sink.takes_radiation();
            for (i, &surface) in zone.surfaces.iter().enumerate() {
                let ends = [End::Node(Node::Surface(surface)), End::Node(Node::Air(z))];
                sink.exchange(ends, numbers.areas[i], &self.laws.surfaces[surface].convection);
                if !radiation {
                    continue;
                }
                for (j, &other) in zone.surfaces.iter().enumerate().skip(i + 1) {
                    let emission =
                        [&self.laws.surfaces[surface].emission, &self.laws.surfaces[other].emission];
                    sink.radiate([surface, other], numbers.exchange[i * n + j], emission);
                }
            }
            let gains = &self.conditions.zones[z];
            for (&surface, &share) in zone.surfaces.iter().zip(&numbers.radiant_shares) {
                let origin = Origin::RadiantGains { zone: z };
                sink.release(Node::Surface(surface), share, gains.radiant, origin);
            }
            sink.release(Node::Air(z), one, gains.convective, Origin::ConvectiveGains { zone: z });
        }
    }

    // ------------------------------------------------------------ with the environment

    /// Sun, convection and long-wave radiation at surfaces outdoors, and the sun on other surfaces that are measured.
    #[inline(always)]
    pub(crate) fn exterior_surfaces(&self, sink: &mut impl Sink<S>) {
        for outside in &self.index.outdoors {
            let surface = outside.surface;
            let (at, laws) = (&self.conditions.surfaces[surface], &self.laws.surfaces[surface]);
            let node = Node::Surface(surface);
            let sun = Origin::Sun { absorptance: outside.absorptance };
            sink.release(node, outside.area, at.solar, if outside.opaque { sun } else { Origin::Window });
            let air = End::Environment { flow: Flow::Convection, temperature: at.temperature };
            sink.exchange([End::Node(node), air], outside.area, &laws.convection);
            if outside.radiates {
                let radiation = OutdoorRadiation {
                    emissivity: outside.emissivity,
                    emission: &laws.emission,
                    arriving: at.longwave,
                    sky_factor: outside.sky_factor,
                    air_factor: outside.air_factor,
                };
                sink.radiate_outdoors(surface, outside.area, &radiation);
            }
        }
        for lit in &self.index.lit {
            let solar = self.conditions.surfaces[lit.surface].solar;
            let sun = Origin::Sun { absorptance: lit.absorptance };
            sink.release(Node::Surface(lit.surface), lit.area, solar, sun);
        }
    }

    /// Surfaces at imposed temperatures, or with convection to one, and heat fluxes that are given.
    #[inline(always)]
    pub(crate) fn imposed_temperatures(&self, sink: &mut impl Sink<S>) {
        for imposed in &self.index.imposed {
            let (surface, area) = (imposed.surface, imposed.area);
            let temperature = self.conditions.surfaces[surface].temperature;
            if imposed.held {
                sink.impose(surface, area, temperature);
            } else {
                let environment = End::Environment { flow: Flow::Boundary, temperature };
                let ends = [End::Node(Node::Surface(surface)), environment];
                sink.exchange(ends, area, &self.laws.surfaces[surface].convection);
            }
        }
        for &(surface, area) in &self.index.heated {
            let heat = self.conditions.surfaces[surface].longwave;
            sink.release(Node::Surface(surface), area, heat, Origin::HeatFlux);
        }
    }

    /// The sun absorbed in panes, and the sun that windows transmit, less what leaves through them again or is absorbed in panes.
    #[inline(always)]
    pub(crate) fn windows(&self, sink: &mut impl Sink<S>) {
        if self.model.plan.windows.is_empty() {
            return;
        }
        for (&w, window) in self.model.plan.windows.iter().zip(&self.conditions.sun.windows) {
            let absorbed = window.panes.iter().fold(S::zero(), |sum, heat| sum + *heat);
            sink.count(Flow::Glass, self.model.coefficients.walls[w].area * absorbed);
        }
        let sun = &self.conditions.sun;
        for (z, zone) in sun.zones.iter().enumerate() {
            let kept = zone.transmitted - zone.lost - zone.in_glass;
            sink.count(Flow::Transmitted, sun.exchanged.get(z).map_or(kept, |exchanged| kept + *exchanged));
        }
    }

    /// Outdoor air that enters zones.
    #[inline(always)]
    pub(crate) fn outdoor_air(&self, sink: &mut impl Sink<S>) {
        let outdoor = |flow| End::Environment { flow, temperature: self.conditions.outdoor_air };
        for (z, line) in self.laws.infiltration.iter().enumerate() {
            let ends = [outdoor(Flow::Infiltration), End::Node(Node::Air(z))];
            sink.exchange(ends, S::one(), line);
        }
        for &z in &self.index.ventilated {
            let ends = [outdoor(Flow::Ventilation), End::Node(Node::Air(z))];
            sink.exchange(ends, S::one(), &self.laws.ventilation[z]);
        }
    }

    /// Gains of the zones, as a whole.
    #[inline(always)]
    pub(crate) fn gains(&self, sink: &mut impl Sink<S>) {
        for &zone in &self.index.gaining {
            let gains = &self.conditions.zones[zone];
            sink.count(Flow::Gains, gains.convective + gains.radiant);
        }
    }

    /// Air exchanged between zones.
    #[inline(always)]
    pub(crate) fn air_paths(&self, sink: &mut impl Sink<S>) {
        for (path, &conductance) in self.model.coefficients.paths.iter().zip(&self.conditions.paths) {
            let [a, b] = path.between;
            sink.conduct([Node::Air(b), Node::Air(a)], S::one(), conductance);
        }
        for (door, line) in self.model.coefficients.doors.iter().zip(&self.laws.doors) {
            sink.exchange(door.between.map(|zone| End::Node(Node::Air(zone))), S::one(), line);
        }
    }

    /// Heat that fans carry from zone to zone, with the air or by heat recovery.
    #[inline(always)]
    pub(crate) fn mechanical_air(&self, sink: &mut impl Sink<S>) {
        let carries = &self.model.coefficients.mechanical_air.carries;
        for (ends, &conductance) in carries.iter().zip(&self.conditions.mechanical_air.carried) {
            sink.carry(ends.map(Node::Air), conductance, self.conditions.outdoor_air);
        }
    }

    /// Thermal bridges.
    #[inline(always)]
    pub(crate) fn bridges(&self, sink: &mut impl Sink<S>) {
        for (bridge, &temperature) in self.model.coefficients.bridges.iter().zip(&self.conditions.bridges) {
            let (air, slope) = (Node::Air(bridge.zone), bridge.conductance);
            if let BridgeEnd::Zone(other) = bridge.to {
                sink.conduct([Node::Air(other), air], S::one(), slope);
            } else if let Some(temperature) = temperature {
                let ends = [End::Environment { flow: Flow::Bridges, temperature }, End::Node(air)];
                sink.exchange(ends, S::one(), &Line { offset: S::zero(), slope });
            }
        }
    }

    /// Sun that the airs of zones get at once; it is counted where it enters, see [`Self::windows`].
    #[inline(always)]
    fn sun_to_air(&self, sink: &mut impl Sink<S>) {
        for (zone, &heat) in self.conditions.sun.to_air.iter().enumerate() {
            sink.release(Node::Air(zone), S::one(), heat, Origin::Window);
        }
    }

    /// Ideal heating and cooling.
    #[inline(always)]
    pub(crate) fn ideal_loads(&self, sink: &mut impl Sink<S>) {
        for &zone in &self.model.plan.ideal_loads {
            let numbers = &self.model.coefficients.zones[zone];
            let [convective, radiant] = numbers.load_parts(self.load[zone]);
            sink.release(Node::Air(zone), S::one(), convective, Origin::IdealLoad);
            if numbers.radiated_loads.is_none() {
                continue;
            }
            let surfaces = &self.model.plan.zones[zone].surfaces;
            for (&surface, &share) in surfaces.iter().zip(&numbers.radiant_shares) {
                sink.release(Node::Surface(surface), share, radiant, Origin::IdealLoad);
            }
        }
    }
}
