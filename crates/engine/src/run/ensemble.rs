//! Ensembles: members in lanes, packs of members on threads.
//!
//! A member's bits do not depend on its neighbours, the lane width or the number of threads. A pack takes as long as some four
//! members one after the other (`docs/speed.md`): fewer members than that run by themselves, as all do on machines without registers for
//! lanes. In single precision the members of a short pack stay in lanes: alone they would have other bits.

use rayon::prelude::*;

use crate::building::plan::Plan;
use crate::error::EngineError;
use crate::input::forcing::Forcing;
use crate::number::real::{Mask, Real};
use crate::number::simd::{LaneTask, Level, SINGLE_WIDTH, WIDTH, run, run_single};
use crate::run::options::Options;
use crate::run::simulate::{Run, simulate_in};
use crate::step::control::RunControl;
use crate::weather::conditions::Weather;

/// Members behind the last full pack that run by themselves.
const FEW: usize = 3;
/// Relative residual of the energy balance from which a member in single precision is run again in double precision [-]. Rounding alone
/// gives 1e-6 to 2e-5.
const CLOSES: f64 = 1e-4;

/// Precision of the numbers of an ensemble.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Precision {
    /// Eight members in the lanes of a pack.
    Double,
    /// Sixteen members.
    Single,
}

impl Precision {
    /// Members in a pack.
    fn width(self) -> usize {
        match self {
            Self::Double => WIDTH,
            Self::Single => SINGLE_WIDTH,
        }
    }
}

/// Results of an ensemble, by member.
#[derive(Debug)]
pub struct Ensemble {
    /// Members x rows x outputs; NaN for a member that failed.
    pub records: Vec<f64>,
    /// Relative residual of the energy balance of each member, or of its vapour balance if that is larger [-]; NaN for one that failed.
    pub closure: Vec<f64>,
    /// How far temperatures of each member were outside of their causes by more than the scheme's overshoot [K]; NaN for one that failed.
    /// See [`physical_limits`](crate::run::physical_limits).
    pub outside: Vec<f64>,
    /// Steps of each member at whose end a law written as text did not hold, of the law that holds least often; NaN for one that failed.
    pub beyond_validity: Vec<f64>,
    /// Members that failed, with the reason.
    pub failures: Vec<(usize, EngineError)>,
}

/// By what a member is judged, as in [`Ensemble`]; NaN for one that failed.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Judgement {
    closure: f64,
    outside: f64,
    beyond_validity: f64,
}

impl Judgement {
    const FAILED: Self = Self { closure: f64::NAN, outside: f64::NAN, beyond_validity: f64::NAN };

    /// That of a lane of a run.
    fn of<S: Real>(run: &Run<S>, lane: usize) -> Self {
        Self {
            closure: run.energy_balance.worst_closure().lane(lane),
            outside: run.outside.lane(lane),
            beyond_validity: run.beyond_validity.lane(lane),
        }
    }
}

/// Memory of the weather of one stage, which all members share [B].
#[must_use]
pub fn stage_bytes(plan: &Plan) -> usize {
    Weather::bytes_of_stage(plan)
}

/// Runs members given as rows of `numbers` (members x parameters).
///
/// # Errors
/// [`EngineError::Interrupted`] and [`EngineError::Input`]; failures of single members are reported in the result.
pub fn ensemble(
    plan: &Plan,
    numbers: &[f64],
    forcing: &Forcing<'_>,
    options: &Options,
    control: &RunControl,
) -> Result<Ensemble, EngineError> {
    run_all(Precision::Double, plan, numbers, forcing, options, control)
}

/// Runs members in single precision, sixteen in a pack, to screen many of them: results differ from those of [`ensemble`] by rounding,
/// and energy balances close within it only. Members whose iteration fails, or whose energy balance does not close, run again alone in
/// double precision; so do all members on machines without registers for lanes.
///
/// # Errors
/// As those of [`ensemble`].
pub fn screening(
    plan: &Plan,
    numbers: &[f64],
    forcing: &Forcing<'_>,
    options: &Options,
    control: &RunControl,
) -> Result<Ensemble, EngineError> {
    run_all(Precision::Single, plan, numbers, forcing, options, control)
}

fn run_all(
    precision: Precision,
    plan: &Plan,
    numbers: &[f64],
    forcing: &Forcing<'_>,
    options: &Options,
    control: &RunControl,
) -> Result<Ensemble, EngineError> {
    let width = plan.description.parameters.len();
    if width == 0 || !numbers.len().is_multiple_of(width) {
        return Err(EngineError::Input(format!("member rows must hold {width} parameters")));
    }
    let level = options.check(plan, width, forcing)?;
    let weather = Weather::new(plan, forcing);
    let members = numbers.len() / width;
    let row = options.rows(forcing.steps()) * options.outputs.len();
    let mut records = vec![f64::NAN; members * row];
    let mut judgements = vec![Judgement::FAILED; members];
    let lanes = precision.width();
    let alone = precision == Precision::Double && members % lanes <= FEW;
    let few = if alone { members % lanes } else { 0 };
    let (in_packs, alone) = judgements.split_at_mut(members - few);
    let (mut first, mut rest) = (0, &mut records[..]);
    let packs = in_packs.chunks_mut(lanes).chain(alone.chunks_mut(1)).map(|judgements| {
        let records;
        (records, rest) = core::mem::take(&mut rest).split_at_mut(row * judgements.len());
        first += judgements.len();
        (first - judgements.len(), Target { records, judgements, row })
    });
    let packs: Vec<_> = packs.collect();
    let failures: Result<Vec<_>, EngineError> = packs
        .into_par_iter()
        .map(|(first, mut target)| {
            let members = target.judgements.len();
            let numbers = &numbers[first * width..(first + members) * width];
            let pack = Pack { plan, numbers, members, weather: &weather, options, control };
            let failed = pack.run_into(level, precision, &mut target)?;
            Ok(failed.into_iter().map(|(member, error)| (first + member, error)).collect::<Vec<_>>())
        })
        .collect();
    let failures = failures?.into_iter().flatten().collect();
    let all = |number: fn(&Judgement) -> f64| judgements.iter().map(number).collect();
    let (closure, outside) = (all(|member| member.closure), all(|member| member.outside));
    Ok(Ensemble {
        records,
        closure,
        outside,
        beyond_validity: all(|member| member.beyond_validity),
        failures,
    })
}

/// Where a pack writes.
struct Target<'a> {
    records: &'a mut [f64],
    judgements: &'a mut [Judgement],
    row: usize,
}

impl Target<'_> {
    /// Writes the records of a pack, one after the other, and the judgement of each member.
    fn write<S: Real>(&mut self, run: &Run<S>) {
        let mut rows: Vec<_> = self.records.chunks_mut(self.row.max(1)).collect();
        for (k, record) in run.records.iter().enumerate() {
            for (member, row) in rows.iter_mut().enumerate() {
                row[k] = record.lane(member);
            }
        }
        for (member, own) in self.judgements.iter_mut().enumerate() {
            *own = Judgement::of(run, member);
        }
    }
}

/// A pack to be run in lanes.
#[derive(Clone, Copy)]
struct Pack<'a, 'w> {
    plan: &'a Plan,
    numbers: &'a [f64],
    members: usize,
    weather: &'a Weather<'w>,
    options: &'a Options,
    control: &'a RunControl,
}

/// A pack, and where it writes.
struct InLanes<'t, 'a, 'w> {
    pack: Pack<'a, 'w>,
    target: &'t mut Target<'a>,
}

impl LaneTask for InLanes<'_, '_, '_> {
    /// Members that have no results yet.
    type Output = Result<Vec<usize>, EngineError>;

    fn run<S: Real>(self, pack: impl Fn(&[f64]) -> S + Copy) -> Self::Output {
        let Pack { plan, numbers, members, weather, options, control } = self.pack;
        let width = plan.description.parameters.len();
        // A short pack repeats its last member.
        let of = |p: usize| (0..S::LANES).map(move |lane| numbers[lane.min(members - 1) * width + p]);
        let lanes: Vec<S> = (0..width).map(|p| pack(&of(p).collect::<Vec<_>>())).collect();
        let run = simulate_in(plan, &lanes, weather, options, control)?;
        let closure = run.energy_balance.worst_closure();
        self.target.write(&run);
        let closed = closure.lt(S::constant(CLOSES)) | S::Mask::splat(!S::SINGLE);
        let lost = |lane: usize| run.failed.lane(lane) || !closed.lane(lane);
        Ok((0..members).filter(|&member| lost(member)).collect())
    }

    fn without_lanes(self) -> Self::Output {
        Ok((0..self.pack.members).collect())
    }
}

impl<'a> Pack<'a, '_> {
    /// Runs the pack in lanes, or its only member alone; members without results in lanes are run again alone.
    fn run_into(
        self,
        level: Level,
        precision: Precision,
        target: &mut Target<'a>,
    ) -> Result<Vec<(usize, EngineError)>, EngineError> {
        let left = match self.run_in_lanes(level, precision, target) {
            Err(
                EngineError::NotConverged { .. }
                | EngineError::WarmUpNotConverged { .. }
                | EngineError::Impossible { .. },
            ) => (0..self.members).collect(),
            other => other?,
        };
        let mut failures = Vec::new();
        for member in left {
            match self.run_alone(member, target) {
                Ok(()) => {}
                Err(EngineError::Interrupted) => return Err(EngineError::Interrupted),
                Err(error) => failures.push((member, error)),
            }
        }
        self.control.count(self.members);
        Ok(failures)
    }

    /// Runs the pack in lanes. Gives the members that have no results.
    fn run_in_lanes(
        self,
        level: Level,
        precision: Precision,
        target: &mut Target<'a>,
    ) -> Result<Vec<usize>, EngineError> {
        let task = InLanes { pack: self, target };
        match precision {
            Precision::Double if self.members == 1 => task.without_lanes(),
            Precision::Double => run(level, task),
            Precision::Single => run_single(level, task),
        }
    }

    /// Runs a member by itself. Its results are NaN where that fails.
    fn run_alone(self, member: usize, target: &mut Target<'_>) -> Result<(), EngineError> {
        let width = self.plan.description.parameters.len();
        let numbers = &self.numbers[member * width..(member + 1) * width];
        let found = simulate_in(self.plan, numbers, self.weather, self.options, self.control);
        let records = &mut target.records[member * target.row..(member + 1) * target.row];
        match found {
            Ok(run) => {
                records.copy_from_slice(&run.records);
                target.judgements[member] = Judgement::of(&run, 0);
                Ok(())
            }
            Err(error) => {
                records.fill(f64::NAN);
                target.judgements[member] = Judgement::FAILED;
                Err(error)
            }
        }
    }
}
