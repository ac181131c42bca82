//! What no building can do, looked for after every step of a run: an energy balance closes for nonsense, too.
//!
//! *Impossible* are temperatures below absolute zero or above 2000 degC, negative humidity, ideal loads above their capacity, a calculated irradiance above
//! the extraterrestrial one and what the ground reflects of it, and recorded fractions outside of 0 to 1 (`run/output_limits.rs`): the run ends with an error that names time and place; a member in lanes is marked as failed and run
//! again alone, where it ends in the same way.
//!
//! *Outside of its causes* is a temperature below the lowest, or above the highest, of the start of the run and of all temperatures that
//! have acted on the building since (outdoor air, sky, imposed temperatures, supplied air). Sun, gains and heating raise the upper bound to
//! what the building has reached while they act; cooling lowers the lower bound likewise. In exact arithmetic conduction, convection,
//! radiation and air flow keep temperatures within these bounds (the maximum principle). A scheme may overshoot them, see `OVERSHOOT`.

use crate::building::coefficients::{Boundary, BridgeEnd, Imposed};
use crate::building::ids::SideId;
use crate::building::plan::Plan;
use crate::error::EngineError;
use crate::input::forcing::channel;
use crate::number::real::{ByPrecision, Mask, Real};
use crate::physics::constants::KELVIN;
use crate::physics::solar::greatest_irradiance;
use crate::run::action::Action;
use crate::step::scheme::Scheme;
use crate::step::state::State;
use crate::step::stepper::Stepper;
use crate::weather::index::IrradianceSource;

/// Largest part of a difference of temperatures by which a step of SDIRK2 leaves the range of its causes [-].
///
/// A network of heat conductances has the solution `exp(t Q) T`, an average of the temperatures of its nodes and boundaries: `exp(t Q)` is
/// not negative and its rows add up to one. With `W = (1 - g h Q)^-1`, the average of `exp(s g h Q)` over `exp(-s) ds`, a step of SDIRK2
/// is `R = (1 + sqrt 2) W^2 - sqrt 2 W`, the same average over `((1 + sqrt 2) s - sqrt 2) exp(-s) ds`. Its weights are negative up to
/// `s = 2 - sqrt 2`, where they add up to `(1 + sqrt 2) exp(sqrt 2 - 2) - 1 = 0.3439`: no network overshoots by more. One node alone
/// overshoots by `(sqrt 2 - 1)/2 = 0.2071` at most. Backward Euler averages by `W`, which has no negative weights.
const OVERSHOOT: f64 = 0.343_91;
/// What rounding and the tolerances of the solver may add [K].
const ROUNDING: ByPrecision = ByPrecision { double: 1e-3, single: 0.1 };
/// Humidity ratios from this on are rounding of zero [kg/kg].
const NO_VAPOUR: ByPrecision = ByPrecision { double: -1e-12, single: -1e-6 };
/// What rounding and the tolerances of the solver may add to a load, as a part of its capacity [-].
const CAPACITY: ByPrecision = ByPrecision { double: 1e-6, single: 1e-2 };

/// No part of a building is hotter [degC]: steel melts at 1500, gypsum and concrete are decomposed long before (EN 1993-1-2, EN 1992-1-2), and
/// no law of the engine holds there.
const HOTTEST: f64 = 2000.0;
/// What rounding may add to an irradiance, and a change of the extraterrestrial one within a step, as a part of the limit [-].
const IRRADIANCE: f64 = 1e-3;
/// The temperature of a run of one member that is farthest outside of its causes.
#[derive(Debug, Clone, PartialEq)]
pub struct Outlier {
    /// Step that ends with it, or begins with it where it is the first.
    pub step: usize,
    /// Name of the part.
    pub place: String,
    /// The temperature [degC].
    pub temperature: f64,
    /// The bound that it lies beyond [degC], without overshoot.
    pub bound: f64,
}

/// Follows a run and judges each of its steps.
#[derive(Debug, Clone)]
pub(crate) struct PhysicalLimits<S: Real> {
    /// Lowest and highest temperature of the causes so far [degC].
    bounds: [S; 2],
    /// Lanes where heat was supplied in the last step, beside what flows from the surroundings.
    supplied: S::Mask,
    /// Part of the range of the causes that the scheme may overshoot [-].
    overshoot: f64,
    /// How far temperatures were outside of their causes by more than the scheme's overshoot [K].
    pub(crate) excess: S,
    /// Where that was, in a run of one member.
    pub(crate) outlier: Option<Outlier>,
}

impl<S: Real> PhysicalLimits<S> {
    /// Begins with the state that a run starts from.
    pub(crate) fn new(state: &State<S>, scheme: Scheme) -> Self {
        let overshoot = if scheme.weights().len() > 1 { OVERSHOOT } else { 0.0 };
        Self {
            bounds: state.extremes(),
            supplied: S::Mask::splat(true),
            overshoot,
            excess: S::zero(),
            outlier: None,
        }
    }

    /// Judges the state after an action in the forcing rows of its first and of its last stage; `step` is that of the run. Loads are those
    /// of a step: a balance of the surfaces keeps those of the step before, of another time.
    ///
    /// # Errors
    /// [`EngineError::Impossible`]; with lanes those that it holds for are marked as failed.
    #[inline(always)]
    pub(crate) fn judge(
        &mut self,
        stepper: &mut Stepper<'_, S>,
        state: &State<S>,
        rows: [&[f64]; 2],
        (action, step): (Action, usize),
    ) -> Result<(), EngineError> {
        let (ends, row) = (state.extremes(), rows[1]);
        let [coldest, hottest] = ends;
        let mut impossible = coldest.lt(S::constant(-KELVIN)) | S::constant(HOTTEST).lt(hottest);
        for &vapour in &state.vapour[..state.vapour.len().min(state.air.len())] {
            impossible = impossible | vapour.lt(S::constant(NO_VAPOUR.of::<S>()));
        }
        if action != Action::Balance {
            for &zone in &stepper.model.plan.ideal_loads {
                impossible = impossible | beyond_capacity(stepper, state, row, zone);
            }
        }
        impossible = impossible | too_bright(stepper, row);
        if impossible.any() {
            if const { S::LANES == 1 } {
                return Err(name_impossible(stepper, state, row, (action, step)));
            }
            stepper.mark_failed(impossible);
        }
        self.compare_with_causes(stepper, state, rows, ends, step);
        Ok(())
    }

    /// Widens the bounds by what acts on the building, and compares the state with them.
    #[inline(always)]
    fn compare_with_causes(
        &mut self,
        stepper: &Stepper<'_, S>,
        state: &State<S>,
        rows: [&[f64]; 2],
        [coldest, hottest]: [S; 2],
        step: usize,
    ) {
        self.widen(stepper, rows);
        let [heated, cooled] = supplied(stepper, state);
        self.bounds[0] = S::select(cooled, self.bounds[0].min(coldest), self.bounds[0]);
        let slack = (self.bounds[1] - self.bounds[0]).scale(self.overshoot) + S::constant(ROUNDING.of::<S>());
        let mut excess = (self.bounds[0] - slack) - coldest;
        // What follows changes the lanes that are not heated only, so that a lane does not depend on the others.
        if (!heated).any() {
            // The heat that was supplied in the step before is still on its way.
            let settling = self.supplied & !heated;
            self.bounds[1] = S::select(settling, self.bounds[1].max(hottest), self.bounds[1]);
            excess = S::select(heated, excess, excess.max(hottest - (self.bounds[1] + slack)));
        }
        self.supplied = heated;
        if const { S::LANES == 1 } && excess.lane(0) > self.excess.lane(0).max(0.0) {
            self.name_outlier(stepper.model.plan, state, step);
        }
        self.excess = self.excess.max(excess);
    }

    /// Widens the bounds by the temperatures around the building in the stages of the step.
    #[inline(always)]
    fn widen(&mut self, stepper: &Stepper<'_, S>, rows: [&[f64]; 2]) {
        let (conditions, numbers) = (&stepper.weather.conditions, &stepper.model.coefficients);
        let [low, high] = &mut self.bounds;
        let mut act = |temperature: S| {
            *low = low.min(temperature);
            *high = high.max(temperature);
        };
        if !stepper.weather.index.emissions.is_empty() {
            act(stepper.weather.sky_temperature());
        }
        for row in rows {
            let air = S::constant(row[channel::AIR_TEMPERATURE]);
            act(air);
            for &surface in &stepper.weather.index.imposed {
                if let Boundary::Imposed(Imposed::Channel(channel)) = numbers.surfaces[surface].boundary {
                    act(S::constant(row[channel]));
                }
            }
            for bridge in &numbers.bridges {
                if let BridgeEnd::Imposed(Imposed::Channel(channel)) = bridge.to {
                    act(S::constant(row[channel]));
                }
            }
            for unit in &numbers.mechanical_air.units {
                act(air + unit.excess(row, air));
            }
        }
        for &surface in &stepper.weather.index.imposed {
            act(conditions.surfaces[surface].temperature);
        }
        for &bridge in conditions.bridges.iter().flatten() {
            act(bridge);
        }
        for (source, at) in numbers.heat_sources.iter().zip(&conditions.heat_sources) {
            if let Some(water) = &source.water {
                for row in rows {
                    act(water.supply.at(row));
                }
                act(at.supply);
            }
        }
    }

    /// Notes the temperature that is farthest outside of its causes so far.
    #[cold]
    #[inline(never)]
    fn name_outlier(&mut self, plan: &Plan, state: &State<S>, step: usize) {
        let [low, high] = self.bounds.map(|bound| bound.lane(0));
        let (cold, coldest) = extreme(plan, state, |a, b| a < b);
        let (hot, hottest) = extreme(plan, state, |a, b| a > b);
        let (place, temperature, bound) =
            if low - coldest > hottest - high { (cold, coldest, low) } else { (hot, hottest, high) };
        self.outlier = Some(Outlier { step, place, temperature, bound });
    }
}

/// What an irradiance cannot exceed in a forcing row, on a plane that sees nothing but the ground [W/m2].
#[inline(always)]
fn greatest<S: Real>(stepper: &Stepper<'_, S>, row: &[f64]) -> S {
    let reflectance = stepper.model.coefficients.ground_reflectance;
    greatest_irradiance(row[channel::DIRECT_NORMAL_EXTRA], reflectance, S::one())
}

/// Lanes where a calculated irradiance is above what can be; none where the extraterrestrial one is unknown.
#[inline(always)]
fn too_bright<S: Real>(stepper: &Stepper<'_, S>, row: &[f64]) -> S::Mask {
    if row[channel::DIRECT_NORMAL_EXTRA] <= 0.0 {
        return S::Mask::splat(false);
    }
    let weather = &stepper.weather;
    let mut brightest = S::zero();
    for (source, &sun) in weather.index.irradiance_sources.iter().zip(&weather.sun.irradiances) {
        if let IrradianceSource::Uniform(..) | IrradianceSource::Varied(..) = source {
            brightest = brightest.max(sun);
        }
    }
    greatest(stepper, row).scale(1.0 + IRRADIANCE).lt(brightest)
}

/// The error about the first impossible number of a state.
#[cold]
#[inline(never)]
fn name_impossible<S: Real>(
    stepper: &Stepper<'_, S>,
    state: &State<S>,
    row: &[f64],
    (action, step): (Action, usize),
) -> EngineError {
    let plan = stepper.model.plan;
    let zone_name = |zone: usize| format!("zone {}", plan.description.zones[zone].name);
    let impossible = |place: String, what: String| EngineError::Impossible { step, place, what };
    for zone in 0..state.air.len() {
        if let Some(vapour) = state.vapour.get(zone).map(|vapour| vapour.lane(0))
            && vapour < NO_VAPOUR.of::<S>()
        {
            let what = format!("a humidity ratio of {vapour:.3e} kg/kg, expected none below zero");
            return impossible(zone_name(zone), what);
        }
    }
    for &zone in &plan.ideal_loads {
        if action != Action::Balance && beyond_capacity(stepper, state, row, zone).lane(0) {
            let load = state.load[zone].lane(0);
            let [most_heating, most_cooling] = capacities(stepper, row, zone);
            let most = if load > 0.0 { most_heating } else { most_cooling }.lane(0);
            let what = format!("an ideal load of {load:.6} W, expected {most:.6} W at most");
            return impossible(zone_name(zone), what);
        }
    }
    if too_bright(stepper, row).lane(0) {
        let most = greatest(stepper, row).lane(0);
        let sources = stepper.weather.index.irradiance_sources.iter().zip(&stepper.weather.sun.irradiances);
        for (source, sun) in sources {
            if let IrradianceSource::Uniform(.., surface) | IrradianceSource::Varied(.., surface) = source
                && sun.lane(0) > most
            {
                let sun = sun.lane(0);
                let what = format!("an irradiance of {sun:.0} W/m2, expected {most:.0} W/m2 at most");
                return impossible(plan.surface_name(*surface), what);
            }
        }
    }
    let (place, hottest) = extreme(plan, state, |a, b| a > b);
    if hottest > HOTTEST {
        return impossible(place, format!("{hottest:.1} degC, expected no temperature above {HOTTEST} degC"));
    }
    let (place, coldest) = extreme(plan, state, |a, b| a < b);
    impossible(place, format!("{coldest:.1} degC, expected no temperature below -273.15 degC"))
}

/// Temperatures of a state.
#[inline(always)]
fn temperatures<S: Real>(state: &State<S>) -> impl Iterator<Item = S> {
    state.cells.iter().chain(state.surfaces.iter()).chain(&state.air).copied()
}

/// Lanes where sun, gains or heating warm the building in the last stage of a step, and lanes where it is cooled.
#[inline(always)]
fn supplied<S: Real>(stepper: &Stepper<'_, S>, state: &State<S>) -> [S::Mask; 2] {
    let (zero, weather) = (S::zero(), &stepper.weather);
    let mut heat = zero;
    for &sun in weather.sun.irradiances.iter().chain(&weather.sun.windows) {
        heat = heat.max(sun);
    }
    let mut cooling = zero;
    for zone in &weather.conditions.zones {
        heat = heat.max(zone.convective).max(zone.radiant);
        cooling = cooling.min(zone.convective).min(zone.radiant);
        // Air that is stated to be warmer above than below carries heat by itself.
        heat = heat.max(zone.gradient.abs());
        cooling = cooling.min(-zone.gradient.abs());
    }
    let laws = weather.index.beside.then_some(&weather.index.imposed).into_iter().flatten();
    let boundary = |surface: SideId| &stepper.model.coefficients.surfaces[surface].boundary;
    let warmed = laws.filter(|&&surface| boundary(surface).gives_heat());
    for &surface in weather.index.heated.iter().map(|(surface, ..)| surface).chain(warmed) {
        let flux = weather.conditions.surfaces[surface].longwave;
        (heat, cooling) = (heat.max(flux), cooling.min(flux));
    }
    for at in &weather.conditions.heat_sources {
        (heat, cooling) = (heat.max(at.heat), cooling.min(at.heat));
    }
    for &zone in &stepper.model.plan.ideal_loads {
        heat = heat.max(state.load[zone]);
        cooling = cooling.min(state.load[zone]);
    }
    [zero.lt(heat), cooling.lt(zero)]
}

/// Largest ideal heating and cooling of a zone in a forcing row [W].
#[inline(always)]
fn capacities<S: Real>(stepper: &Stepper<'_, S>, row: &[f64], zone: usize) -> [S; 2] {
    let numbers = &stepper.model.coefficients.zones[zone];
    [&numbers.heating, &numbers.cooling].map(|plant| match plant {
        Some(plant) => plant.at(row).1,
        None => S::zero(),
    })
}

/// Lanes where the ideal load of a zone is larger than its plant.
#[inline(always)]
fn beyond_capacity<S: Real>(stepper: &Stepper<'_, S>, state: &State<S>, row: &[f64], zone: usize) -> S::Mask {
    let load = state.load[zone];
    let [heating, cooling] = capacities(stepper, row, zone);
    let slack = (heating + cooling).scale(CAPACITY.of::<S>()) + S::constant(CAPACITY.of::<S>());
    (heating + slack).lt(load) | load.lt(-(cooling + slack))
}

/// Name and temperature [degC] of the part that comes first by an order.
fn extreme<S: Real>(plan: &Plan, state: &State<S>, before: impl Fn(f64, f64) -> bool) -> (String, f64) {
    let all: Vec<f64> = temperatures(state).map(|temperature| temperature.lane(0)).collect();
    let first = (1..all.len()).fold(0, |first, k| if before(all[k], all[first]) { k } else { first });
    (name(plan, first), all[first])
}

/// Name of a temperature by its place in [`temperatures`].
fn name(plan: &Plan, k: usize) -> String {
    if let Some(k) = k.checked_sub(plan.n_cells) {
        return match k.checked_sub(plan.surfaces.len()) {
            None => plan.surface_name(SideId::new(k / 2, k % 2)),
            Some(zone) => format!("zone {} (air)", plan.description.zones[zone].name),
        };
    }
    let wall = plan.walls.iter().rposition(|wall| wall.first_cell <= k && !wall.is_empty()).unwrap_or(0);
    plan.cell_name(wall, k - plan.walls[wall].first_cell)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::balance::energy_balance::EnergyBalance;
    use crate::common::conditioned::{conditioned, conditioned_weather};
    use crate::common::{ALL_SCHEMES, cell, cell_outputs, forcing, options, run, set, values};
    use crate::input::forcing::Forcing;
    use crate::run::action::Action;
    use crate::step::state::Initial;
    use crate::weather::conditions::Weather;

    const HOUR: f64 = 3600.0;

    /// Judges a state after its first balance, changed in between, in the first step of some rows.
    fn judged(
        plan: &Plan,
        rows: &[f64],
        change: impl Fn(&mut State<f64>, &mut Stepper<'_, f64>),
    ) -> Result<PhysicalLimits<f64>, EngineError> {
        let (scheme, numbers) = (Scheme::Sdirk2, values(plan));
        let weather = Weather::new(plan, &Forcing::new(rows, 2, plan.n_channels()).unwrap());
        let mut stepper = Stepper::new(plan, &numbers, scheme);
        let mut state = stepper.begin(&Initial::Everywhere(20.0), weather.row(0, 0));
        let mut limits = PhysicalLimits::new(&state, scheme);
        Action::Balance.take(&mut stepper, &mut state, &weather, HOUR, &mut EnergyBalance::new()).unwrap();
        let at = Action::Balance.weather_rows(&weather, scheme);
        limits.judge(&mut stepper, &state, at, (Action::Balance, 0)).unwrap();
        change(&mut state, &mut stepper);
        limits.judge(&mut stepper, &state, at, (Action::Step(0), 7))?;
        Ok(limits)
    }

    /// 20 degC everywhere, dark and calm.
    fn at_rest(plan: &Plan) -> Vec<f64> {
        forcing(plan, Scheme::Sdirk2, 1, HOUR, |_, row| set(row, 0, 20.0))
    }

    #[test]
    fn what_is_impossible_is_an_error_that_names_it() {
        let plan = Plan::new(conditioned(0.04)).unwrap();
        let rows = forcing(&plan, Scheme::Sdirk2, 1, HOUR, conditioned_weather);
        let text = |change: &dyn Fn(&mut State<f64>, &mut Stepper<'_, f64>)| {
            judged(&plan, &rows, change).unwrap_err().to_string()
        };
        let cold = text(&|state, _| state.cells[0] = -273.2);
        assert!(
            cold.contains("step 7") && cold.contains("surface north (layer layer_0) has -273.2 degC"),
            "{cold}"
        );
        let hot = text(&|state, _| state.cells[0] = 2000.1);
        assert!(
            hot.contains("surface north (layer layer_0) has 2000.1 degC, expected no temperature above 2000"),
            "{hot}"
        );
        let surface = text(&|state, _| state.surfaces[SideId::inside(1)] = -764.0);
        assert!(surface.contains("surface east (inside) has -764.0 degC"), "{surface}");
        let air = text(&|state, _| state.air[1] = -300.0);
        assert!(air.contains("zone gap (air) has -300.0 degC"), "{air}");
        // Capacities of 300 W and 80 W.
        for (load, most) in [(300.1, "300"), (-80.1, "80")] {
            let beyond = text(&|state, _| state.load[0] = load);
            assert!(
                beyond.contains(&format!("an ideal load of {load:.6} W, expected {most}.000000 W")),
                "{beyond}"
            );
        }
        assert!(judged(&plan, &rows, |state, _| state.load[0] = 300.0).is_ok());
        // The loads at the start of a run are those of another time.
        let numbers = values(&plan);
        let weather = Weather::new(&plan, &Forcing::new(&rows, 2, plan.n_channels()).unwrap());
        let mut stepper = Stepper::new(&plan, &numbers, Scheme::Sdirk2);
        let mut state = stepper.begin(&Initial::Everywhere(20.0), weather.row(0, 0));
        Action::Balance.take(&mut stepper, &mut state, &weather, HOUR, &mut EnergyBalance::new()).unwrap();
        state.load[0] = 1e6;
        let mut limits = PhysicalLimits::new(&state, Scheme::Sdirk2);
        let at = Action::Balance.weather_rows(&weather, Scheme::Sdirk2);
        limits.judge(&mut stepper, &state, at, (Action::Balance, 0)).unwrap();
        // 1361 W/m2 and a fifth of it from the ground.
        let bright = text(&|_, stepper| stepper.weather.sun.irradiances.fill(1640.0));
        assert!(bright.contains("an irradiance of 1640 W/m2, expected 1633 W/m2 at most"), "{bright}");
    }

    /// At rest at 20 degC every other temperature is without a cause.
    #[test]
    fn a_temperature_without_a_cause_is_found() {
        let plan = Plan::new(cell(0.04)).unwrap();
        let rows = at_rest(&plan);
        let sound = judged(&plan, &rows, |_, _| ()).unwrap();
        assert!(sound.excess <= 0.0 && sound.outlier.is_none(), "{sound:?}");
        // The sky of this weather is colder than 20 degC: it is a cause.
        let [low, high] = sound.bounds;
        assert!((high - 20.0).abs() < 1e-9 && (-30.0..19.0).contains(&low), "{low}, {high}");
        let slack = OVERSHOOT * (high - low) + 1e-3;
        for (temperature, bound) in [(60.0, high), (-60.0, low)] {
            let found = judged(&plan, &rows, |state, _| state.cells[5] = temperature).unwrap();
            let outlier = found.outlier.unwrap();
            assert_eq!((outlier.step, outlier.temperature, outlier.bound), (7, temperature, bound));
            let beyond = (temperature - bound).abs() - slack;
            assert!((found.excess - beyond).abs() < 1e-9, "{} is not {beyond}", found.excess);
        }
    }

    /// Air and soil that jump by 20 K, in steps that are long for the steel of the roof: no scheme is outside of its causes by more than it
    /// may overshoot.
    #[test]
    fn schemes_stay_within_their_overshoot() {
        let plan = Plan::new(cell(0.04)).unwrap();
        for (scheme, step) in ALL_SCHEMES.into_iter().flat_map(|scheme| [(scheme, 0.25), (scheme, 3.0)]) {
            let step = step * HOUR;
            let rows = forcing(&plan, scheme, 24, step, |time, row| {
                let air = if (time / (4.0 * step)).fract() < 0.5 { 20.0 } else { 0.0 };
                row[channel::AIR_TEMPERATURE] = air;
                set(row, 0, air);
            });
            let run = run(&plan, &rows, &options(scheme, step, cell_outputs()));
            assert!(run.outside <= 0.0 && run.outlier.is_none(), "{scheme:?}: {:?}", run.outlier);
        }
    }

    /// The negative weights of SDIRK2 and their sum, by hand and by quadrature.
    #[test]
    fn negative_weights_of_sdirk2() {
        let root = core::f64::consts::SQRT_2;
        let closed = (1.0 + root) * Real::exp(root - 2.0) - 1.0;
        assert!((OVERSHOOT - closed).abs() < 1e-5, "{closed}");
        let (n, end) = (20_000, 2.0 - root);
        let weight = |s: f64| (root - (1.0 + root) * s) * Real::exp(-s);
        let sum: f64 = (0..n).map(|k| weight((f64::from(k) + 0.5) * end / f64::from(n))).sum();
        assert!((sum * end / f64::from(n) - closed).abs() < 1e-8);
    }
}
