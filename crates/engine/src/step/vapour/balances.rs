//! The vapour balances of a step, stage by stage; equations in the module above.

use crate::balance::vapour::VapourLedger;
use crate::building::coefficients::HumidityCoefficients;
use crate::building::humidity::HumidityPlan;
use crate::building::model::Model;
use crate::linear::coupled::CoupledSystem;
use crate::linear::unknowns::Temperatures;
use crate::number::real::{ByPrecision, Mask, Real};
use crate::physics::psychrometrics::{LATENT_HEAT, vapour_pressure};
use crate::step::scheme::Tableau;
use crate::step::state::State;
use crate::weather::conditions::Conditions;

use super::bounds::Bounds;
use super::counting::{Counted, count};
use super::flows::StageFlows;
use super::plants::{Limits, Mode};
use super::saturation::Saturation;
use super::surfaces::{Tangent, Uptake};

/// How far the line of a vapour pressure may be from it at the solution [Pa].
const PRESSURE: ByPrecision = ByPrecision { double: 1e-6, single: 0.1 };

/// A stage of a step, as it is solved.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    pub(super) stage: usize,
    /// It starts from `start + ratio (first - start)`: the start of the step and the end of its first stage.
    pub(super) ratio: f64,
    /// Effective length [s].
    pub(super) length: f64,
}

/// Solves the vapour balances.
#[derive(Debug, Clone)]
pub(crate) struct VapourBalances<'a, S: Real> {
    pub(super) plan: &'a HumidityPlan,
    /// Of each stage of the step.
    pub(super) flows: Vec<StageFlows<S>>,
    saturation: Saturation<S>,
    pub(super) system: CoupledSystem<'a, S>,
    /// At the end of the first stage, and of the last one; as in [`State::vapour`].
    first: Vec<S>,
    pub(super) reached: Vec<S>,
    /// At the end of the last stage, where it leaves the bounds of the step.
    beyond: Vec<S>,
    bounds: Bounds<S>,
    /// Whether surfaces of a zone take up vapour.
    sorbing: Vec<bool>,
    /// Of the balance of each zone: what multiplies its own humidity ratio [kg/s], and what does not depend on any [kg/s].
    pub(super) diagonal: Vec<S>,
    pub(super) right: Vec<S>,
    /// Tangent of the vapour pressure of each zone by its humidity ratio: at zero, and the slope [Pa].
    pressures: Vec<(S, S)>,
    /// Of the sorption of each surface.
    tangents: Vec<[Tangent<S>; 2]>,
    uptakes: Vec<Uptake<S>>,
    /// In the first stage, and in the last one.
    first_limits: Vec<Limits<S>>,
    pub(super) limits: Vec<Limits<S>>,
    pub(super) modes: Vec<Mode<S>>,
    /// Taken away by plants and saturation in the first stage, and in the last one [kg/s].
    first_removed: Vec<S>,
    pub(super) removed: Vec<S>,
    /// The same of [`Self::beyond`].
    beyond_removed: Vec<S>,
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
        let mut sorbing = vec![false; zones];
        humidity.surfaces.iter().for_each(|surface| sorbing[surface.zone] = true);
        Some(Self {
            plan,
            flows: vec![StageFlows::new(humidity, plan.carries.len()); stages],
            saturation: Saturation::new(zones + humidity.surfaces.len(), stages),
            system: CoupledSystem::new(&plan.pattern, 0, 0),
            first: vec![zero; size],
            reached: vec![zero; size],
            beyond: vec![zero; size],
            bounds: Bounds::new(zones),
            sorbing,
            diagonal: vec![zero; zones],
            right: vec![zero; zones],
            pressures: vec![(zero, zero); zones],
            tangents: vec![[Tangent::none(); 2]; humidity.surfaces.len()],
            uptakes: vec![Uptake::none(); humidity.surfaces.len()],
            first_limits: vec![Limits::none(); zones],
            limits: vec![Limits::none(); zones],
            modes: vec![Mode::idle(); zones],
            first_removed: vec![zero; zones],
            removed: vec![zero; zones],
            beyond_removed: vec![zero; zones],
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
        energy_balance: &mut VapourLedger<S>,
    ) {
        self.saturation.update();
        let (last, first_length) = (tableau.weights.len() - 1, tableau.diagonal * length);
        self.limit(humidity, state, (last, tableau.nodes[0]));
        self.begin_lines(humidity, &state.vapour, 0);
        let mut step = VapourLedger::new();
        if last > 0 {
            let place = Place { stage: 0, ratio: 0.0, length: first_length };
            core::mem::swap(&mut self.limits, &mut self.first_limits);
            self.solve(humidity, &state.vapour, place);
            core::mem::swap(&mut self.limits, &mut self.first_limits);
            self.first.copy_from_slice(&self.reached);
            core::mem::swap(&mut self.removed, &mut self.first_removed);
            self.begin_bounds(humidity, &state.vapour, first_length);
            self.begin_pressures(last);
        }
        let ratio = if last > 0 { tableau.ratio } else { 0.0 };
        self.solve(humidity, &state.vapour, Place { stage: last, ratio, length: first_length });
        if last > 0 {
            let weights = [tableau.weights[0], tableau.weights[1]].map(|weight| weight * length);
            self.bound(humidity, &state.vapour, weights, &mut step);
        } else {
            self.count(humidity, (0, length), &mut step);
        }
        self.elapsed += length;
        let content = self.content(humidity, &state.vapour, &mut step);
        state.vapour.copy_from_slice(&self.reached);
        energy_balance.add_step(&step, content);
    }

    /// What the first stage tells about the bounds of the step; its length [s].
    #[inline(always)]
    fn begin_bounds(&mut self, humidity: &HumidityCoefficients<S>, start: &[S], length: f64) {
        let Self { bounds, flows, first, first_removed, plan, diagonal, saturation, .. } = self;
        bounds.begin(&plan.groups, [start, first], [flows[0].outdoor, flows[1].outdoor]);
        bounds.add_targets(humidity, &plan.groups, [start, first], (first_removed, diagonal, length));
        if !humidity.surfaces.is_empty() {
            let saturated = [0, 1].map(|stage| &saturation.pressures(stage)[humidity.zones.len()..]);
            bounds.add_layers(humidity, &plan.groups, (start, first), saturated, flows[1].pressure);
        }
    }

    /// Keeps the end of the step within its bounds, and counts its flows; `weights` of both stages [s].
    ///
    /// SDIRK2 goes on from the slope of the first stage, beyond what drives it where the air is exchanged faster than 2.41 times in a step. In two
    /// stages of backward Euler, the first of which is the same, nothing leaves the bounds. What leaves them goes back on the straight line
    /// to their end, as far as it must. Both ends are balances, so is what is between them.
    #[inline(always)]
    fn bound(
        &mut self,
        humidity: &HumidityCoefficients<S>,
        start: &[S],
        weights: [f64; 2],
        step: &mut VapourLedger<S>,
    ) {
        let zones = humidity.zones.len();
        let (saturated, pressure) = (&self.saturation.pressures(1)[zones..], self.flows[1].pressure);
        let outside = self.bounds.left(humidity, &self.plan.groups, &self.reached, (saturated, pressure));
        if !outside.any() {
            self.count_first(humidity, |_| S::constant(weights[0]), step);
            self.count(humidity, (1, weights[1]), step);
            return;
        }
        core::mem::swap(&mut self.reached, &mut self.beyond);
        core::mem::swap(&mut self.removed, &mut self.beyond_removed);
        self.begin_lines_of_first(humidity);
        self.solve(humidity, start, Place { stage: 1, ratio: 1.0, length: weights[0] });
        let saturated = &self.saturation.pressures(1)[zones..];
        let ends = [&self.beyond[..], &self.reached];
        let taken = (&self.removed[..], &self.diagonal[..], weights[0]);
        self.bounds.add_targets(humidity, &self.plan.groups, [&self.first, &self.reached], taken);
        self.bounds.share(humidity, &self.plan.groups, ends, (saturated, pressure));
        self.bounds.judge(humidity, ends, (&self.diagonal, weights[0]), step);
        let of_first = |share: S| S::constant(weights[0]) + (S::one() - share).scale(weights[1] - weights[0]);
        let shares = core::mem::take(&mut self.bounds.shares);
        self.count_first(humidity, |z| of_first(shares[z]), step);
        let Self { plan, flows, limits, plants, .. } = self;
        let mut solution = |reached, removed, duration: &dyn Fn(usize) -> S| {
            let counted = Counted { flows: &flows[1], reached, removed, limits };
            count(plan, humidity, &counted, duration, plants, step);
        };
        solution(&self.beyond, &self.beyond_removed, &|z| shares[z].scale(weights[1]));
        solution(&self.reached, &self.removed, &|z| (S::one() - shares[z]).scale(weights[0]));
        for (k, (end, &beyond)) in self.reached.iter_mut().zip(&self.beyond).enumerate() {
            let zone = if k < zones { k } else { humidity.surfaces[(k - zones) / 2].zone };
            *end = beyond + (S::one() - shares[zone]) * (*end - beyond);
        }
        self.bounds.shares = shares;
    }

    /// What a stage starts from: `start + ratio (first - start)`.
    #[inline(always)]
    pub(super) fn held(&self, start: &[S], k: usize, ratio: f64) -> S {
        if ratio == 0.0 { start[k] } else { start[k] + (self.first[k] - start[k]).scale(ratio) }
    }

    /// Tangents of the vapour pressure and of the sorption at some humidity ratios and contents, in a stage.
    #[inline(always)]
    fn begin_lines(&mut self, humidity: &HumidityCoefficients<S>, at: &[S], stage: usize) {
        let zones = humidity.zones.len();
        for (line, &ratio) in self.pressures.iter_mut().zip(&at[..zones]) {
            *line = tangent(ratio, self.flows[stage].pressure);
        }
        let surfaces = self.tangents.iter_mut().zip(&humidity.surfaces);
        for ((tangents, surface), contents) in surfaces.zip(at[zones..].as_chunks::<2>().0) {
            Tangent::update(tangents, &surface.layers, contents);
        }
    }

    /// Tangents at the end of the first stage, for the last one.
    #[inline(always)]
    fn begin_lines_of_first(&mut self, humidity: &HumidityCoefficients<S>) {
        let first = core::mem::take(&mut self.first);
        self.begin_lines(humidity, &first, 1);
        self.first = first;
    }

    /// Tangents of the vapour pressure at the end of the first stage, for the last one.
    #[inline(always)]
    fn begin_pressures(&mut self, stage: usize) {
        for (line, &ratio) in self.pressures.iter_mut().zip(&self.first) {
            *line = tangent(ratio, self.flows[stage].pressure);
        }
    }

    /// Draws the tangents anew at the solution where they are far from their curves there; true where they were.
    #[inline(always)]
    pub(super) fn follow_curves(&mut self, humidity: &HumidityCoefficients<S>, stage: usize) -> S::Mask {
        let mut any = S::Mask::splat(false);
        let near = S::constant(PRESSURE.of::<S>());
        let zones = humidity.zones.len();
        for (z, line) in self.pressures.iter_mut().enumerate().filter(|(z, _)| self.sorbing[*z]) {
            let ratio = self.reached[z];
            let (pressure, slope) = vapour_pressure(ratio, self.flows[stage].pressure);
            let far = near.lt((pressure - (line.0 + line.1 * ratio)).abs());
            line.0 = S::select(far, pressure - slope * ratio, line.0);
            line.1 = S::select(far, slope, line.1);
            any = any | far;
        }
        let surfaces = self.tangents.iter_mut().zip(&humidity.surfaces);
        for ((tangents, surface), contents) in surfaces.zip(self.reached[zones..].as_chunks::<2>().0) {
            any = any | Tangent::follow(tangents, &surface.layers, contents);
        }
        any
    }

    /// Draws the tangents of the sorption anew in some lanes, at a part of the way to the contents reached.
    pub(super) fn redraw_tangents(
        &mut self,
        humidity: &HumidityCoefficients<S>,
        (part, lanes): (f64, S::Mask),
    ) {
        let contents = self.reached[humidity.zones.len()..].as_chunks::<2>().0;
        let surfaces = self.tangents.iter_mut().zip(&humidity.surfaces);
        for ((tangents, surface), contents) in surfaces.zip(contents) {
            Tangent::redraw(tangents, &surface.layers, contents, (part, lanes));
        }
    }

    /// The balances of all zones, layers behind surfaces eliminated.
    #[inline(always)]
    pub(super) fn assemble(
        &mut self,
        humidity: &HumidityCoefficients<S>,
        start: &[S],
        Place { stage, ratio, length }: Place,
    ) {
        let (zones, per_second) = (humidity.zones.len(), 1.0 / length);
        for (z, zone) in humidity.zones.iter().enumerate() {
            let storage = zone.air.scale(per_second);
            let (held, flows) = (self.held(start, z, ratio), &self.flows[stage]);
            let at = &flows.zones[z];
            self.diagonal[z] = storage + at.outward;
            self.right[z] = storage * held + at.outward * flows.outdoor + at.gain;
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

    /// Set points and capacities in the last stage, and in the first one of two at a node of the step.
    #[inline(always)]
    fn limit(&mut self, humidity: &HumidityCoefficients<S>, state: &State<S>, (last, node): (usize, f64)) {
        let Self { limits, first_limits, flows, saturation, .. } = self;
        let both = limits.iter_mut().zip(first_limits);
        for (z, ((end, first), zone)) in both.zip(&humidity.zones).enumerate() {
            let at = |stage: usize| {
                let flows = &flows[stage];
                let pressures = (flows.pressure, saturation.pressures(stage)[z]);
                Limits::new(zone, &flows.zones[z], pressures, state.load[z])
            };
            *end = at(last);
            if last > 0 {
                *first = at(0).on_the_way(end, state.vapour[z], node);
            }
        }
    }

    /// Moisture contents at the end of a stage.
    #[inline(always)]
    pub(super) fn finish_stage(
        &mut self,
        humidity: &HumidityCoefficients<S>,
        start: &[S],
        Place { ratio, length, .. }: Place,
    ) {
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

    /// Adds the flows of the last stage, which counts for a duration [s].
    #[inline(always)]
    fn count(
        &mut self,
        humidity: &HumidityCoefficients<S>,
        (stage, duration): (usize, f64),
        step: &mut VapourLedger<S>,
    ) {
        let Self { plan, flows, reached, removed, limits, plants, .. } = self;
        let counted = Counted { flows: &flows[stage], reached, removed, limits };
        count(plan, humidity, &counted, |_| S::constant(duration), plants, step);
    }

    /// Adds the flows of the first stage, which counts for a duration in each zone [s].
    #[inline(always)]
    fn count_first(
        &mut self,
        humidity: &HumidityCoefficients<S>,
        duration: impl Fn(usize) -> S,
        step: &mut VapourLedger<S>,
    ) {
        let Self { plan, flows, first, first_removed, first_limits, plants, .. } = self;
        let counted =
            Counted { flows: &flows[0], reached: first, removed: first_removed, limits: first_limits };
        count(plan, humidity, &counted, duration, plants, step);
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

/// Tangent of the vapour pressure at a humidity ratio [kg/kg] and a pressure of the air [Pa]: at zero, and the slope [Pa].
#[inline(always)]
fn tangent<S: Real>(ratio: S, pressure: S) -> (S, S) {
    let (vapour, slope) = vapour_pressure(ratio, pressure);
    (vapour - slope * ratio, slope)
}
