//! Lengths of steps that follow the weather and the building: chosen along a run, by an estimate of the error of each step.
//!
//! A step of length `h` is compared with two of `h/2` from the same state: for a scheme of second order the former is wrong by 4/3 of the
//! difference (Richardson's extrapolation; Hairer, Norsett & Wanner, Solving Ordinary Differential Equations I (1993), sec. II.4,
//! doi:10.1007/978-3-540-78862-1). An embedded formula of SDIRK2 would see only what its two stages see of the weather; the halves see as much
//! again. A step is accepted where the estimate is within the tolerance, and the choice goes on from the end of its halves. Lengths are the
//! record interval halved some times, and each step starts at a multiple of its length.

use crate::balance::energy_balance::EnergyBalance;
use crate::building::ids::SideId;
use crate::building::plan::Plan;
use crate::error::EngineError;
use crate::input::forcing::Forcing;
use crate::run::action::Action;
use crate::run::options::{Options, Warmup};
use crate::run::step_lengths::{MOST_HALVINGS, halved};
use crate::run::warm_up::warm_up;
use crate::step::control::RunControl;
use crate::step::halving::Part;
use crate::step::history::History;
use crate::step::state::State;
use crate::step::stepper::Stepper;
use crate::weather::conditions::Weather;

/// Error of a step as a part of its difference from its two halves, for a scheme of second order [-].
const ERROR_OF_DIFFERENCE: f64 = 4.0 / 3.0;
/// The error of a step grows by this factor with twice its length, for a scheme of second order [-].
const GROWTH: f64 = 8.0;
/// Steps in which a control changes its mind are no longer than this, where they can be: controls decide at the beginning of a step [s].
const OF_DECISION: f64 = 60.0;
/// A change of a humidity ratio as a change of temperature, by the latent heat over the specific heat of air [K].
const RATIO_AS_KELVIN: f64 = 2500.0;

/// Steps that were chosen.
#[derive(Debug, Clone)]
pub struct StepChoice {
    /// How often the record interval is halved for each step.
    pub halvings: Vec<u8>,
    /// Estimated error of each step [K].
    pub errors: Vec<f64>,
}

/// What steps are chosen by.
#[derive(Debug, Clone, Copy)]
pub struct Criterion {
    /// Largest estimated error of a step [K].
    pub tolerance: f64,
    /// How often a record interval may be halved.
    pub most_halvings: u8,
}

/// Chooses the steps of a run. `forcings` has the weather in steps of the record interval, of half of it, and so on; within the shortest ones it
/// is a straight line. The repeated first period of the options is counted in record intervals.
///
/// # Errors
/// [`EngineError::NotConverged`], [`EngineError::WarmUpNotConverged`], [`EngineError::Interrupted`], [`EngineError::Input`].
pub fn choose_steps(
    plan: &Plan,
    parameters: &[f64],
    forcings: &[Forcing<'_>],
    options: &Options,
    criterion: Criterion,
    control: &RunControl,
) -> Result<StepChoice, EngineError> {
    let Some((finest, first)) = forcings.last().zip(forcings.first()) else {
        return Err(EngineError::Input("steps are chosen in the weather of one length at least".to_owned()));
    };
    let deepest = forcings.len() - 1;
    if deepest > usize::from(MOST_HALVINGS) || criterion.most_halvings > MOST_HALVINGS {
        return Err(EngineError::Input(format!("a record interval is halved at most {MOST_HALVINGS} times")));
    }
    let mut fixed =
        Options { dt: options.dt / f64::from(1_u32 << deepest), lengths: None, ..options.clone() };
    fixed.warmup = options.warmup.map(|warmup| Warmup { steps: warmup.steps << deepest, ..warmup });
    for (level, forcing) in forcings.iter().enumerate() {
        fixed.check_forcing(plan, forcing)?;
        if forcing.steps() != first.steps() << level {
            return Err(EngineError::Input("weather of steps that are not halves of each other".to_owned()));
        }
    }
    fixed.check(plan, parameters.len(), finest)?;
    let mut stepper = Stepper::new(plan, parameters, options.scheme);
    stepper.keep_factors();
    stepper.set_control(control);
    let weather = |level: usize| {
        let repeated = if level == deepest { fixed.warmup.map_or(0, |warmup| warmup.steps) } else { 0 };
        Weather::for_single_run(plan, &forcings[level], repeated)
    };
    let weathers: Vec<_> = (0..=deepest).map(weather).collect();
    let mut state = stepper.begin(&options.initial, weathers[deepest].row(0, 0));
    warm_up(&mut stepper, &mut state, &weathers[deepest], &fixed, control, &mut |_, _, _| Ok(()))?;
    Action::Balance.take(&mut stepper, &mut state, &weathers[deepest], 0.0, &mut EnergyBalance::new())?;
    let depth = u32::from(criterion.most_halvings).max(u32::try_from(deepest).unwrap_or(0)) + 1;
    let jumps = Action::first(options) == Action::FirstStep;
    let history = stepper.history();
    let start = Reached { state, history, decides: false };
    let mut pilot = Pilot { stepper, weathers, dt: options.dt, depth, jumps, control };
    pilot.choose(start, first.steps() << depth, criterion)
}

/// Where a run is: all that the next step depends on.
#[derive(Debug, Clone)]
struct Reached {
    state: State<f64>,
    history: History<f64>,
    /// Whether a control decides otherwise at its end.
    decides: bool,
}

/// A run along which steps are chosen.
struct Pilot<'a, 'w> {
    stepper: Stepper<'a, f64>,
    /// By how often the record interval is halved.
    weathers: Vec<Weather<'w>>,
    /// Record interval [s].
    dt: f64,
    /// A record interval has 2 to this number of units.
    depth: u32,
    /// Whether the run starts from one temperature everywhere.
    jumps: bool,
    control: &'a RunControl,
}

impl Pilot<'_, '_> {
    /// Chooses step after step up to an end, in units.
    fn choose(
        &mut self,
        start: Reached,
        end: usize,
        criterion: Criterion,
    ) -> Result<StepChoice, EngineError> {
        let mut choice = StepChoice { halvings: Vec::new(), errors: Vec::new() };
        let (mut now, mut at, mut level) = (start, 0_usize, 0_u32);
        // A step that was made before: the first half of one that was not accepted.
        let mut first_half: Option<Reached> = None;
        while at < end {
            self.control.check()?;
            let unit = 1_usize << (self.depth - level);
            let last = level >= u32::from(criterion.most_halvings) || self.is_first_possible(at, level);
            let whole = first_half.take().map_or_else(|| self.step(&now, at, level), Ok);
            let half = self.step(&now, at, level + 1);
            let (whole, half) = match (whole, half) {
                (Ok(whole), Ok(half)) => (whole, half),
                (Err(EngineError::Interrupted), _) | (_, Err(EngineError::Interrupted)) => {
                    return Err(EngineError::Interrupted);
                }
                (Err(error), _) | (_, Err(error)) if last => return Err(error),
                _ => {
                    level += 1;
                    continue;
                }
            };
            let error = match self.step(&half, at + unit / 2, level + 1) {
                Ok(reached) => {
                    let error = self.difference(&whole.state, &reached.state) * ERROR_OF_DIFFERENCE;
                    let hides = self.hides_decision(level, [&whole, &half, &reached]);
                    if (error <= criterion.tolerance && !hides) || last {
                        now = reached;
                        at += unit;
                        choice.halvings.push(u8::try_from(level).unwrap_or(u8::MAX));
                        choice.errors.push(error);
                        level = self.next_level(level, at, error * GROWTH <= criterion.tolerance);
                        continue;
                    }
                    if hides { criterion.tolerance.max(error) } else { error }
                }
                Err(EngineError::Interrupted) => return Err(EngineError::Interrupted),
                Err(error) if last => return Err(error),
                Err(_) => f64::INFINITY,
            };
            level += 1;
            if error <= GROWTH * criterion.tolerance {
                first_half = Some(half);
            } else if level < u32::from(criterion.most_halvings)
                && error.is_finite()
                && !self.is_first_possible(at, level)
            {
                level += 1;
            } else {
                first_half = Some(half);
            }
        }
        Ok(choice)
    }

    /// Whether a step cannot be shorter: the first one of a run that starts from one temperature everywhere is made in parts of its own.
    fn is_first_possible(&self, at: usize, level: u32) -> bool {
        at == 0 && self.jumps && level as usize + 1 >= self.weathers.len()
    }

    /// How often the interval is halved for the step that is tried next.
    fn next_level(&self, level: u32, at: usize, longer: bool) -> u32 {
        let aligned = level > 0 && at.is_multiple_of(1_usize << (self.depth + 1 - level));
        if longer && aligned { level - 1 } else { level }
    }

    /// A step from where a run is, at a time in units.
    fn step(&mut self, from: &Reached, at: usize, level: u32) -> Result<Reached, EngineError> {
        let mut state = from.state.clone();
        self.stepper.set_history(&from.history);
        let deepest = u32::try_from(self.weathers.len() - 1).unwrap_or(0);
        let of_weather = level.min(deepest);
        let (weather, bits) = (&self.weathers[of_weather as usize], self.depth - of_weather);
        let (step, dt) = (at >> bits, self.dt * halved(of_weather));
        let mut unused = EnergyBalance::new();
        if at == 0 && self.jumps && level <= deepest {
            self.stepper.first_step(&mut state, weather, dt, &mut unused)?;
        } else if level == of_weather {
            self.stepper.step(&mut state, weather, step, dt, &mut unused)?;
        } else {
            let within = at - (step << bits);
            let share = halved(level - of_weather);
            let from = within as f64 / (1_usize << bits) as f64;
            let part = Part { step, from, share, halvings: level - of_weather };
            self.stepper.part_of_step(&mut state, weather, part, dt, &mut unused)?;
        }
        let decides = self.decides(&state, weather.row(step, self.stepper.scheme.weights().len() - 1));
        Ok(Reached { state, history: self.stepper.history(), decides })
    }

    /// Whether a control decides otherwise in a state, and in a row of the forcing.
    fn decides(&self, state: &State<f64>, row: &[f64]) -> bool {
        if state.opened.is_empty() {
            return false;
        }
        let mut next = state.clone();
        self.stepper.control_vents(&mut next, row, 0.0);
        next.opened != state.opened
    }

    /// Whether a step has to be shorter, because a control decides otherwise in it or at its end.
    fn hides_decision(&self, level: u32, reached: [&Reached; 3]) -> bool {
        let length = self.dt * halved(level);
        length > OF_DECISION && reached.iter().any(|reached| reached.decides)
    }

    /// Largest difference of two states in airs, their humidity, and means over the surfaces of a zone by area [K]. Single surfaces follow
    /// the weather within seconds, and forget it as fast.
    fn difference(&self, a: &State<f64>, b: &State<f64>) -> f64 {
        let (plan, walls) = (self.stepper.model.plan, &self.stepper.model.coefficients.walls);
        let mean = |surfaces: &[SideId]| {
            let (mut sum, mut areas) = (0.0, 0.0);
            for &surface in surfaces {
                let area = walls[surface.wall()].area;
                sum += area * (a.surfaces[surface] - b.surfaces[surface]);
                areas += area;
            }
            if areas > 0.0 { sum / areas } else { 0.0 }
        };
        let radiant = plan.zones.iter().map(|zone| mean(&zone.surfaces));
        let airs = a.air.iter().zip(&b.air).map(|(a, b)| a - b);
        let ratios = a.vapour.iter().zip(&b.vapour).take(a.air.len());
        let ratios = ratios.map(|(a, b)| (a - b) * RATIO_AS_KELVIN);
        let mut largest = 0.0_f64;
        for difference in airs.chain(radiant).chain(ratios) {
            // What is not a number is no small difference.
            if difference.is_nan() {
                return f64::INFINITY;
            }
            largest = largest.max(difference.abs());
        }
        largest
    }
}
