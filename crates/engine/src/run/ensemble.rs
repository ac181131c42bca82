//! Ensembles: members in lanes, packs of members on threads.
//!
//! A member's bits do not depend on its neighbours, the lane width or the number of threads. A pack takes as long as some four
//! members one after the other (`docs/speed.md`): fewer members than that run by themselves, as all do on machines without registers for lanes.

use rayon::prelude::*;

use crate::building::plan::Plan;
use crate::error::EngineError;
use crate::input::forcing::Forcing;
use crate::number::real::{Mask, Real};
use crate::number::simd::{LaneTask, Level, WIDTH, run};
use crate::run::march::march_in;
use crate::run::options::Options;
use crate::step::control::RunControl;
use crate::weather::conditions::Weather;

/// Members behind the last full pack that run by themselves.
const FEW: usize = 3;

/// Results of an ensemble, by member.
#[derive(Debug)]
pub struct Ensemble {
    /// Members x rows x outputs; NaN for a member that failed.
    pub records: Vec<f64>,
    /// Relative residual of the energy balance of each member, or of its vapour balance if that is larger [-]; NaN for one that failed.
    pub closure: Vec<f64>,
    /// Members that failed, with the reason.
    pub failures: Vec<(usize, EngineError)>,
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
    let width = plan.description.parameters.len();
    if width == 0 || !numbers.len().is_multiple_of(width) {
        return Err(EngineError::Input(format!("member rows must hold {width} parameters")));
    }
    let level = options.check(plan, width, forcing)?;
    let weather = Weather::new(plan, forcing);
    let members = numbers.len() / width;
    let row = options.rows(forcing.steps()) * options.probes.len();
    let mut result = Ensemble {
        records: vec![f64::NAN; members * row],
        closure: vec![f64::NAN; members],
        failures: Vec::new(),
    };
    let few = if members % WIDTH <= FEW { members % WIDTH } else { 0 };
    let (in_packs, alone) = result.closure.split_at_mut(members - few);
    let (mut first, mut rest) = (0, &mut result.records[..]);
    let packs = in_packs.chunks_mut(WIDTH).chain(alone.chunks_mut(1)).map(|closure| {
        let records;
        (records, rest) = core::mem::take(&mut rest).split_at_mut(row * closure.len());
        first += closure.len();
        (first - closure.len(), Target { records, closure, row })
    });
    let packs: Vec<_> = packs.collect();
    let failures: Result<Vec<_>, EngineError> = packs
        .into_par_iter()
        .map(|(first, mut target)| {
            let members = &numbers[first * width..(first + target.closure.len()) * width];
            let failed = run_pack(level, plan, members, &weather, options, control, &mut target)?;
            Ok(failed.into_iter().map(|(member, error)| (first + member, error)).collect::<Vec<_>>())
        })
        .collect();
    result.failures = failures?.into_iter().flatten().collect();
    Ok(result)
}

/// Where a pack writes.
struct Target<'a> {
    records: &'a mut [f64],
    closure: &'a mut [f64],
    row: usize,
}

/// A pack to be run in lanes.
struct Pack<'a, 'w> {
    plan: &'a Plan,
    numbers: &'a [f64],
    members: usize,
    weather: &'a Weather<'w>,
    options: &'a Options,
    control: &'a RunControl,
}

impl LaneTask for Pack<'_, '_> {
    /// Records and closure of each member; none for one whose iteration failed.
    type Output = Result<Vec<Option<(Vec<f64>, f64)>>, EngineError>;

    fn run<S: Real>(self, pack: impl Fn([f64; WIDTH]) -> S + Copy) -> Self::Output {
        let width = self.plan.description.parameters.len();
        let lanes: Vec<S> = (0..width)
            // A short pack repeats its last member.
            .map(|p| pack(core::array::from_fn(|lane| self.numbers[lane.min(self.members - 1) * width + p])))
            .collect();
        let run = march_in(self.plan, &lanes, self.weather, self.options, self.control)?;
        let closure = run.ledger.worst_closure();
        let of = |member| (run.records.iter().map(|r| r.lane(member)).collect(), closure.lane(member));
        Ok((0..self.members).map(|member| (!run.failed.lane(member)).then(|| of(member))).collect())
    }

    fn without_lanes(self) -> Self::Output {
        Ok(vec![None; self.members])
    }
}

/// Runs a pack in lanes, or its only member alone; members whose iteration fails in lanes are run again alone.
fn run_pack(
    level: Level,
    plan: &Plan,
    numbers: &[f64],
    weather: &Weather<'_>,
    options: &Options,
    control: &RunControl,
    target: &mut Target<'_>,
) -> Result<Vec<(usize, EngineError)>, EngineError> {
    let width = plan.description.parameters.len();
    let members = target.closure.len();
    let mut failures = Vec::new();
    let none = vec![None; members];
    let results = if members == 1 {
        none
    } else {
        match run(level, Pack { plan, numbers, members, weather, options, control }) {
            Err(EngineError::NotConverged { .. } | EngineError::WarmUpNotConverged { .. }) => none,
            other => other?,
        }
    };
    for (member, result) in results.into_iter().enumerate() {
        let alone = || {
            let numbers = &numbers[member * width..(member + 1) * width];
            march_in(plan, numbers, weather, options, control)
                .map(|run| (run.records, run.ledger.worst_closure()))
        };
        match result.map_or_else(alone, Ok) {
            Ok((records, closure)) => {
                target.records[member * target.row..(member + 1) * target.row].copy_from_slice(&records);
                target.closure[member] = closure;
            }
            Err(EngineError::Interrupted) => return Err(EngineError::Interrupted),
            Err(error) => failures.push((member, error)),
        }
    }
    control.count(members);
    Ok(failures)
}
