//! The vapour balances of a step, stage by stage; equations in the module above.

use crate::balance::vapour::{VapourFlow, VapourLedger};
use crate::building::coefficients::HumidityCoefficients;
use crate::building::humidity::HumidityPlan;
use crate::building::model::Model;
use crate::linear::coupled::CoupledSystem;
use crate::linear::unknowns::Temperatures;
use crate::number::real::{Mask, Real};
use crate::physics::psychrometrics::{LATENT_HEAT, vapour_pressure};
use crate::step::scheme::Tableau;
use crate::step::state::State;
use crate::weather::conditions::Conditions;

use super::flows::StageFlows;
use super::plants::{Limits, Mode};
use super::saturation::Saturation;
use super::surfaces::{Tangent, Uptake};

/// Solutions of a stage at most: plants and saturation begin or end in some zones from one to the next.
const MAX_SOLUTIONS: usize = 30;

/// Solves the vapour balances.
#[derive(Debug, Clone)]
pub(crate) struct VapourBalances<'a, S: Real> {
    plan: &'a HumidityPlan,
    /// Of each stage of the step.
    flows: Vec<StageFlows<S>>,
    saturation: Saturation<S>,
    system: CoupledSystem<'a, S>,
    /// At the end of the first stage, and of the last one; as in [`State::vapour`].
    first: Vec<S>,
    reached: Vec<S>,
    /// Of the balance of each zone: what multiplies its own humidity ratio [kg/s], and what does not depend on any [kg/s].
    diagonal: Vec<S>,
    right: Vec<S>,
    /// Of the vapour pressure of each zone by its humidity ratio, on the tangent at the start of the step: at zero, and the slope [Pa].
    pressures: Vec<(S, S)>,
    /// Of the sorption of each surface at the start of the step.
    tangents: Vec<[Tangent<S>; 2]>,
    uptakes: Vec<Uptake<S>>,
    limits: Vec<Limits<S>>,
    modes: Vec<Mode<S>>,
    /// Taken away by plants and saturation [kg/s].
    removed: Vec<S>,
    /// Vapour that drying has taken and humidifying has added since the step began [kg], and the time since then [s].
    plants: Vec<[S; 2]>,
    elapsed: f64,
}

impl<'a, S: Real> VapourBalances<'a, S> {
    /// For a building; none without vapour balances.
    pub(crate) fn new(model: &Model<'a, S>, stages: usize) -> Option<Self> {
        let (plan, humidity) = (model.plan.humidity.as_ref()?, model.coefficients.humidity.as_ref()?);
        let (zones, zero) = (humidity.zones.len(), S::zero());
        let size = zones + 2 * humidity.surfaces.len();
        Some(Self {
            plan,
            flows: vec![StageFlows::new(humidity, plan.carries.len()); stages],
            saturation: Saturation::new(zones + humidity.surfaces.len(), stages),
            system: CoupledSystem::new(&plan.pattern, 0, 0),
            first: vec![zero; size],
            reached: vec![zero; size],
            diagonal: vec![zero; zones],
            right: vec![zero; zones],
            pressures: vec![(zero, zero); zones],
            tangents: vec![[Tangent::none(); 2]; humidity.surfaces.len()],
            uptakes: vec![Uptake::none(); humidity.surfaces.len()],
            limits: vec![Limits::none(); zones],
            modes: vec![Mode::idle(); zones],
            removed: vec![zero; zones],
            plants: vec![[zero; 2]; zones],
            elapsed: 0.0,
        })
    }

    /// Notes the flows of a stage, in its conditions and at its temperatures.
    #[inline(always)]
    pub(crate) fn note(
        &mut self,
        model: &Model<'_, S>,
        conditions: &Conditions<S>,
        at: Temperatures<'_, S>,
        stage: usize,
    ) {
        let temperatures = self.saturation.temperatures(stage);
        self.flows[stage].note(self.plan, model, conditions, at, temperatures);
    }

    /// A step begins: plants have done nothing yet.
    #[inline(always)]
    pub(crate) fn begin(&mut self) {
        self.plants.fill([S::zero(); 2]);
        self.elapsed = 0.0;
    }

    /// Latent heat that drying takes away and humidifying adds in a zone, mean over the step [W].
    pub(crate) fn latent(&self, zone: usize, humidifying: bool) -> S {
        let per_second = if self.elapsed > 0.0 { LATENT_HEAT / self.elapsed } else { 0.0 };
        self.plants[zone][usize::from(humidifying)].scale(per_second)
    }

    /// Solves a step of a length [s], or a part of one, whose flows have been noted; `load` is the ideal load of each zone [W].
    #[inline(always)]
    pub(crate) fn advance(
        &mut self,
        humidity: &HumidityCoefficients<S>,
        state: &mut State<S>,
        (tableau, length): (&Tableau, f64),
        ledger: &mut VapourLedger<S>,
    ) {
        self.saturation.update();
        self.begin_tangents(humidity, &state.vapour);
        let mut step = VapourLedger::new();
        for (stage, &weight) in tableau.weights.iter().enumerate() {
            let ratio = if stage > 0 { tableau.ratio } else { 0.0 };
            self.assemble(humidity, &state.vapour, (stage, ratio, tableau.diagonal * length));
            self.limit(humidity, state, (stage, tableau.nodes[stage]));
            self.solve(humidity, stage);
            self.finish_stage(humidity, &state.vapour, (ratio, tableau.diagonal * length));
            self.count(humidity, (stage, weight * length), &mut step);
            if stage == 0 {
                self.first.copy_from_slice(&self.reached);
            }
        }
        self.elapsed += length;
        let content = self.content(humidity, &state.vapour, &mut step);
        state.vapour.copy_from_slice(&self.reached);
        ledger.add_step(&step, content);
    }

    /// What a stage starts from: `start + ratio (first - start)`.
    #[inline(always)]
    fn held(&self, start: &[S], k: usize, ratio: f64) -> S {
        if ratio == 0.0 { start[k] } else { start[k] + (self.first[k] - start[k]).scale(ratio) }
    }

    /// Tangents of the sorption at the start of the step.
    #[inline(always)]
    fn begin_tangents(&mut self, humidity: &HumidityCoefficients<S>, start: &[S]) {
        let (_, contents) = start.split_at(humidity.zones.len());
        let surfaces = self.tangents.iter_mut().zip(&humidity.surfaces);
        for ((tangents, surface), contents) in surfaces.zip(contents.as_chunks::<2>().0) {
            Tangent::update(tangents, &surface.layers, contents);
        }
    }

    /// The balances of all zones, layers behind surfaces eliminated.
    #[inline(always)]
    fn assemble(
        &mut self,
        humidity: &HumidityCoefficients<S>,
        start: &[S],
        (stage, ratio, length): (usize, f64, f64),
    ) {
        let (zones, per_second) = (humidity.zones.len(), 1.0 / length);
        for (z, zone) in humidity.zones.iter().enumerate() {
            let storage = zone.air.scale(per_second);
            let (held, flows) = (self.held(start, z, ratio), &self.flows[stage]);
            let at = &flows.zones[z];
            self.diagonal[z] = storage + at.outward;
            self.right[z] = storage * held + at.outward * flows.outdoor + at.gain;
            let (pressure, slope) = vapour_pressure(start[z], flows.pressure);
            self.pressures[z] = (pressure - slope * start[z], slope);
        }
        let flows = &self.flows[stage];
        for (&[from, to], &carried) in self.plan.carries.iter().zip(&flows.carried) {
            if from != to {
                let of_outdoor = carried * flows.outdoor;
                self.diagonal[from] += carried;
                self.right[from] += of_outdoor;
                self.right[to] = self.right[to] - of_outdoor;
            }
        }
        let saturated = &self.saturation.pressures(stage)[zones..];
        for (k, surface) in humidity.surfaces.iter().enumerate() {
            let place = zones + 2 * k;
            let held = [self.held(start, place, ratio), self.held(start, place + 1, ratio)];
            let layers = (&self.tangents[k], surface.layers.two);
            let at_surface = (saturated[k], per_second);
            let pressure = self.pressures[surface.zone];
            let uptake = Uptake::new(layers, &flows.surfaces[k], held, pressure, at_surface);
            self.diagonal[surface.zone] += surface.area * uptake.slope;
            self.right[surface.zone] = self.right[surface.zone] - surface.area * uptake.offset;
            self.uptakes[k] = uptake;
        }
    }

    /// Set points and capacities in a stage at a node of the step.
    #[inline(always)]
    fn limit(&mut self, humidity: &HumidityCoefficients<S>, state: &State<S>, (stage, node): (usize, f64)) {
        for (z, (limits, zone)) in self.limits.iter_mut().zip(&humidity.zones).enumerate() {
            let at = |stage: usize| {
                let flows = &self.flows[stage];
                let pressures = (flows.pressure, self.saturation.pressures(stage)[z]);
                Limits::new(zone, &flows.zones[z], pressures, state.load[z])
            };
            *limits = at(stage);
            if node < 1.0 && zone.has_plants() {
                *limits = limits.on_the_way(&at(self.flows.len() - 1), state.vapour[z], node);
            }
        }
    }

    /// Humidity ratios, and what plants and saturation take away: an active-set method (Hintermueller, Ito & Kunisch 2002,
    /// doi:10.1137/S1052623401383558), which ends after a few solutions for an M-matrix.
    #[inline(always)]
    fn solve(&mut self, humidity: &HumidityCoefficients<S>, stage: usize) {
        self.modes.fill(Mode::idle());
        for _ in 0..MAX_SOLUTIONS {
            self.solve_in_modes(stage);
            let mut changed = S::Mask::splat(false);
            for (z, (limits, zone)) in self.limits.iter().zip(&humidity.zones).enumerate() {
                let plants = zone.has_plants();
                let next = limits.mode(plants, self.reached[z], self.removed[z], self.diagonal[z]);
                changed = changed | next.differs(&self.modes[z]);
                self.modes[z] = next;
            }
            if !changed.any() {
                break;
            }
        }
    }

    /// The linear system with each zone held at a humidity ratio, or with a fixed amount taken away.
    #[inline(always)]
    fn solve_in_modes(&mut self, stage: usize) {
        let Self { plan, flows, system, diagonal, right, modes, removed, reached, .. } = self;
        if plan.carries.is_empty() {
            // Zones that exchange no air, such as a single one: with the bits of the system below.
            for (z, mode) in modes.iter().enumerate() {
                let free = S::one() / diagonal[z] * (right[z] - mode.value);
                reached[z] = S::select(mode.held, mode.value, free);
                removed[z] = S::select(mode.held, right[z] - diagonal[z] * reached[z], mode.value);
            }
            return;
        }
        system.clear_matrix();
        for (z, mode) in modes.iter().enumerate() {
            let row = plan.rows[z];
            system.add_diagonal(row, S::select(mode.held, S::one(), diagonal[z]));
            system.right[row] = S::select(mode.held, mode.value, right[z] - mode.value);
        }
        let carried = &flows[stage].carried;
        for ((&[_, to], &place), &carried) in plan.carries.iter().zip(&plan.places).zip(carried) {
            if let Some(place) = place {
                system.add_at(place, -S::select(modes[to].held, S::zero(), carried));
            }
        }
        system.solve_rest();
        for (z, mode) in modes.iter().enumerate() {
            reached[z] = system.right[plan.rows[z]];
            removed[z] = right[z] - diagonal[z] * reached[z];
            // What a held zone is given more than it needs is taken away.
            removed[z] = S::select(mode.held, removed[z], mode.value);
        }
        for (&[from, to], &carried) in plan.carries.iter().zip(carried) {
            if from != to {
                let brought = S::select(modes[to].held, carried * reached[from], S::zero());
                removed[to] += brought;
            }
        }
    }

    /// Moisture contents at the end of a stage.
    #[inline(always)]
    fn finish_stage(&mut self, humidity: &HumidityCoefficients<S>, start: &[S], (ratio, length): (f64, f64)) {
        let zones = humidity.zones.len();
        for (k, (surface, uptake)) in humidity.surfaces.iter().zip(&self.uptakes).enumerate() {
            let place = zones + 2 * k;
            let [first, second] = uptake.flows(self.reached[surface.zone]);
            let held = [self.held(start, place, ratio), self.held(start, place + 1, ratio)];
            self.reached[place] = held[0] + (first - second).scale(length);
            // Without a second layer there is no flow and no content.
            if surface.layers.two {
                self.reached[place + 1] = held[1] + second.scale(length);
            }
        }
    }

    /// Adds the flows of a stage, which counts for a duration [s].
    #[inline(always)]
    fn count(
        &mut self,
        humidity: &HumidityCoefficients<S>,
        (stage, duration): (usize, f64),
        step: &mut VapourLedger<S>,
    ) {
        let flows = &self.flows[stage];
        for (z, (zone, numbers)) in flows.zones.iter().zip(&humidity.zones).enumerate() {
            let fresh = zone.outward * (flows.outdoor - self.reached[z]);
            step.add_flow(VapourFlow::OutdoorAir, fresh.scale(duration));
            step.add_flow(VapourFlow::Gains, zone.gain.scale(duration));
            let [dried, condensed, added] = self.limits[z].shares(self.removed[z]);
            if numbers.has_plants() {
                step.add_flow(VapourFlow::Drying, -dried.scale(duration));
            }
            step.add_flow(VapourFlow::Condensation, -condensed.scale(duration));
            if numbers.has_plants() {
                step.add_flow(VapourFlow::Humidifying, added.scale(duration));
                self.plants[z][0] += dried.scale(duration);
                self.plants[z][1] += added.scale(duration);
            }
        }
        for (&[from, to], &carried) in self.plan.carries.iter().zip(&flows.carried) {
            if from != to {
                let vapour = (carried * (self.reached[from] - flows.outdoor)).scale(duration);
                step.add_flow(VapourFlow::Interzone, vapour);
                step.add_flow(VapourFlow::Interzone, -vapour);
            }
        }
    }

    /// Vapour stored in the step, into `step`; what is contained at its end [kg].
    #[inline(always)]
    fn content(&self, humidity: &HumidityCoefficients<S>, start: &[S], step: &mut VapourLedger<S>) -> S {
        let mut content = S::zero();
        for (z, zone) in humidity.zones.iter().enumerate() {
            step.stored += zone.air * (self.reached[z] - start[z]);
            content += zone.air * self.reached[z];
        }
        for (k, surface) in humidity.surfaces.iter().enumerate() {
            let place = humidity.zones.len() + 2 * k;
            for layer in [place, place + 1].into_iter().take(if surface.layers.two { 2 } else { 1 }) {
                step.stored += surface.area * (self.reached[layer] - start[layer]);
                content += surface.area * self.reached[layer];
            }
        }
        content
    }
}
