//! What holds for every building, tried on random ones.
//!
//! `MASCARIN_PROPERTY_CASES` sets the number of buildings of each test; `MASCARIN_PROPERTY_SEED` runs one building only.

use std::panic::{AssertUnwindSafe, catch_unwind};

use crate::common::random::{Case, Contents, Random, of_surface, of_zone, outputs, reordered};
use crate::common::{relative, try_run, values};
use mascarin_engine::RunControl;
use mascarin_engine::Scheme;
use mascarin_engine::derivatives::Trajectory;
use mascarin_engine::derivatives::jacobian;
use mascarin_engine::forcing::Forcing;
use mascarin_engine::plan::Plan;
use mascarin_engine::run::ensemble::{ensemble, screening};
use mascarin_engine::run::outputs::Output;
use mascarin_engine::run::{Options, simulate};

/// Buildings of each test, unless the environment asks for another number.
const CASES: u64 = 40;

/// Makes a test with many seeds; reports each seed that fails, with its reason.
fn for_each_seed(first: u64, test: impl Fn(u64) -> Result<(), String>) {
    let asked = |name: &str| std::env::var(name).ok().map(|text| text.parse::<u64>().unwrap());
    let seeds = match asked("MASCARIN_PROPERTY_SEED") {
        Some(seed) => seed..seed + 1,
        None => first..first + asked("MASCARIN_PROPERTY_CASES").unwrap_or(CASES),
    };
    let count = seeds.end - seeds.start;
    let mut failed = Vec::new();
    for seed in seeds {
        let text = |panic: Box<dyn core::any::Any + Send>| {
            let text = panic.downcast_ref::<String>().cloned();
            text.or_else(|| panic.downcast_ref::<&str>().map(|&text| text.to_owned())).unwrap_or_default()
        };
        let result = catch_unwind(AssertUnwindSafe(|| test(seed)));
        if let Err(reason) = result.unwrap_or_else(|panic| Err(format!("panic: {}", text(panic)))) {
            failed.push(format!("MASCARIN_PROPERTY_SEED={seed}: {reason}"));
        }
    }
    assert!(failed.is_empty(), "{} of {count} buildings:\n{}", failed.len(), failed.join("\n"));
}

fn check(holds: bool, reason: impl FnOnce() -> String) -> Result<(), String> {
    if holds { Ok(()) } else { Err(reason()) }
}

fn drive<'a>(case: &Case, plan: &Plan, rows: &'a [f64]) -> Forcing<'a> {
    Forcing::new(rows, case.scheme.weights().len(), plan.n_channels()).unwrap()
}

/// Every run is solved, all its numbers are finite and its energy balance has no residual.
#[test]
fn runs_are_finite_and_keep_their_energy_balance() {
    for_each_seed(1, |seed| {
        let case = Case::new(seed, Contents::All);
        let plan = case.plan();
        let run = try_run(&plan, &values(&plan), &case.rows(&plan), &case.options())
            .map_err(|error| error.to_string())?;
        check(run.records.iter().all(|record| record.is_finite()), || "a record is not finite".to_owned())?;
        let closure = run.energy_balance.closure();
        check(closure < 1e-10, || format!("relative energy-balance residual {closure:e}"))?;
        let sum: f64 = run.energy_balance.into.iter().sum();
        let difference = (sum - run.energy_balance.stored).abs() / run.energy_balance.total_exchanged;
        check(difference < 1e-10, || format!("sum of all steps: relative residual {difference:e}"))
    });
}

/// Other numbers of zones and surfaces give the same temperatures and loads.
#[test]
fn order_of_zones_and_surfaces_does_not_matter() {
    for_each_seed(1001, |seed| {
        let case = Case::new(seed, Contents::All);
        let mut random = Random::new(seed ^ 0xabcd);
        let d = &case.description;
        let (zones, surfaces) = (random.permutation(d.zones.len()), random.permutation(d.surfaces.len()));
        let other = Plan::new(reordered(d, &zones, &surfaces)).unwrap();
        let plan = case.plan();
        let position = |order: &[usize], old: usize| order.iter().position(|&k| k == old).unwrap();
        let places = (0..d.zones.len()).flat_map(|zone| of_zone(position(&zones, zone)));
        let same = places
            .chain((0..d.surfaces.len()).flat_map(|surface| of_surface(position(&surfaces, surface))))
            .collect();
        let (rows, options) = (case.rows(&plan), case.options());
        let first = try_run(&plan, &values(&plan), &rows, &options).map_err(|error| error.to_string())?;
        let options = Options { outputs: same, ..options };
        let second = try_run(&other, &values(&other), &rows, &options).map_err(|error| error.to_string())?;
        let outputs = outputs(d);
        let (mut temperature, mut load) = (0.0, 0.0);
        for (i, (a, b)) in first.records.iter().zip(&second.records).enumerate() {
            let difference: f64 = (a - b).abs();
            if matches!(outputs[i % outputs.len()], Output::HeatingLoad { .. } | Output::CoolingLoad { .. }) {
                load = f64::max(load, difference / a.abs().max(1.0));
            } else {
                temperature = f64::max(temperature, difference);
            }
        }
        // The time of a nucleation is that of a temperature over the speed of cooling, which may be small.
        let supercools = format!("{:?}", d.materials).contains("supercooling");
        check(temperature < if supercools { 1e-6 } else { 1e-8 } && load < 1e-6, || {
            format!("temperatures differ by {temperature:e} K, loads by {load:e} of theirs")
        })
    });
}

/// The bits of a member do not depend on its neighbours.
#[test]
fn members_of_an_ensemble_have_the_bits_of_single_runs() {
    for_each_seed(2001, |seed| {
        let mut case = Case::new(seed, Contents::All);
        case.steps = 16;
        let (plan, mut random) = (case.plan(), Random::new(seed ^ 0xbeef));
        let width = plan.description.parameters.len();
        let members = 1 + random.below(12);
        let mut numbers = Vec::new();
        for _ in 0..members {
            let some = random.between(0.0, 0.02);
            numbers.extend(values(&plan).iter().map(|value| value * (1.0 + random.between(-some, some))));
        }
        let (rows, options, watch) = (case.rows(&plan), case.options(), RunControl::default());
        let drive = drive(&case, &plan, &rows);
        let together =
            ensemble(&plan, &numbers, &drive, &options, &watch).map_err(|error| error.to_string())?;
        let row = together.records.len() / members;
        for (member, numbers) in numbers.chunks(width).enumerate() {
            let alone = simulate(&plan, numbers, &drive, &options, &watch);
            let failure = together.failures.iter().find(|(failed, _)| *failed == member);
            check(alone.is_err() == failure.is_some(), || {
                format!(
                    "member {member} of {members}: alone {:?}, together {failure:?}",
                    alone.as_ref().err()
                )
            })?;
            let Ok(alone) = alone else { continue };
            let part = &together.records[member * row..(member + 1) * row];
            for (i, (a, b)) in alone.records.iter().zip(part).enumerate() {
                check(a.to_bits() == b.to_bits(), || {
                    format!("member {member} of {members}, record {i}: alone {a:e}, together {b:e}")
                })?;
            }
            let (a, b) = (alone.energy_balance.closure(), together.closure[member]);
            check(a.to_bits() == b.to_bits(), || format!("member {member}: residual {a:e} and {b:e}"))?;
        }
        Ok(())
    });
}

/// In single precision, members are near those in double precision. (A cell that has nearly molten counts as molten by rounding: with
/// `curve_track` it then freezes along the other curve, with supercooling it has no crystals.)
#[test]
fn members_in_single_precision_are_near_double_precision() {
    for_each_seed(9001, |seed| {
        let case = Case::new(seed, Contents::All);
        let materials = format!("{:?}", case.description.materials);
        if materials.contains("curve_track") || materials.contains("supercooling") {
            return Ok(());
        }
        let plan = case.plan();
        let (rows, options, watch) = (case.rows(&plan), case.options(), RunControl::default());
        let (drive, numbers) = (drive(&case, &plan, &rows), values(&plan).repeat(2));
        let [single, double] =
            [screening, ensemble].map(|run| run(&plan, &numbers, &drive, &options, &watch));
        let (single, double) =
            (single.map_err(|error| error.to_string())?, double.map_err(|error| error.to_string())?);
        check(single.failures.len() == double.failures.len(), || "other failures".to_owned())?;
        check(single.closure.iter().all(|&closure| closure < 1e-4), || format!("{:?}", single.closure))?;
        let outputs = &options.outputs;
        for (i, (a, b)) in single.records.iter().zip(&double.records).enumerate() {
            let output = &outputs[i % outputs.len()];
            let load = matches!(output, Output::HeatingLoad { .. } | Output::CoolingLoad { .. });
            let limit = if load { 0.02 * b.abs().max(500.0) } else { 0.1 };
            check((a - b).abs() < limit, || format!("record {i}, {output:?}: {a} in place of {b}"))?;
        }
        Ok(())
    });
}

/// Maximum principle: without heat sources, no temperature leaves the range of the imposed ones.
#[test]
fn temperatures_stay_within_imposed_temperatures() {
    for_each_seed(3001, |seed| {
        let mut case = Case::new(seed, Contents::ImposedTemperatures);
        case.scheme = Scheme::BackwardEuler;
        let plan = case.plan();
        let rows = case.rows(&plan);
        let run =
            try_run(&plan, &values(&plan), &rows, &case.options()).map_err(|error| error.to_string())?;
        let [low, high] = case.imposed_range(&plan, &rows);
        let outputs = outputs(&case.description);
        for (i, &record) in run.records.iter().enumerate() {
            let output = &outputs[i % outputs.len()];
            let temperature = !matches!(output, Output::HeatingLoad { .. } | Output::CoolingLoad { .. });
            check(!temperature || (low - 1e-7..high + 1e-7).contains(&record), || {
                format!("{record} of {output:?} is outside {low} to {high}")
            })?;
        }
        let cells = run.state.cells.iter().find(|cell| !(low - 1e-7..high + 1e-7).contains(*cell));
        check(cells.is_none(), || format!("a cell at {cells:?} is outside {low} to {high}"))
    });
}

/// A record and its slopes by some parameters, forward and in reverse.
struct Slopes {
    record: usize,
    which: Vec<usize>,
    forward: Vec<f64>,
    reverse: Vec<f64>,
    /// Largest change of this reading over the run, not below 1 in its unit.
    range: f64,
}

fn slopes(case: &Case, plan: &Plan, rows: &[f64], random: &mut Random) -> Result<Slopes, String> {
    let (numbers, watch) = (values(plan), RunControl::default());
    let (options, drive) = (case.options(), drive(case, plan, rows));
    let trajectory = Trajectory::new(plan, &numbers, &drive, &options, &watch, 1 << 30);
    let trajectory = trajectory.map_err(|error| error.to_string())?;
    let records = &trajectory.run.records;
    let (count, width) = (records.len(), options.outputs.len());
    // Among the later ones, which the parameters had time to change.
    let record = count - 1 - random.below(count / 3);
    let mut weights = vec![0.0; count];
    weights[record] = 1.0;
    let reverse = trajectory.pull(plan, &numbers, &drive, &options, &watch, &weights);
    let reverse = reverse.map_err(|error| error.to_string())?;
    let series = records.iter().skip(record % width).step_by(width);
    let (low, high) = series.fold((f64::MAX, f64::MIN), |(low, high), &r| (low.min(r), high.max(r)));
    let range = f64::max(high - low, 1.0);
    // Mostly parameters that matter, and any other ones.
    let matters = |k: usize| (reverse[k] * numbers[k]).abs() > 0.01 * range;
    let matter: Vec<usize> = (0..numbers.len()).filter(|&k| matters(k)).collect();
    let which: Vec<usize> = (0..6)
        .map(|k| if k < 4 && !matter.is_empty() { random.of(&matter) } else { random.below(numbers.len()) })
        .collect();
    let all = jacobian(plan, &numbers, &which, &drive, &options, &watch).map_err(|e| e.to_string())?;
    for (a, b) in all.records.iter().zip(records) {
        check(a.to_bits() == b.to_bits(), || format!("the runs with slopes differ: {a:e} and {b:e}"))?;
    }
    Ok(Slopes {
        record,
        forward: (0..which.len()).map(|k| all.slopes[k * count + record]).collect(),
        reverse: which.iter().map(|&k| reverse[k]).collect(),
        which,
        range,
    })
}

/// Slopes found forward are those found in reverse: after some steps, and after the first one, which is made in seven parts.
#[test]
fn slopes_forward_are_slopes_in_reverse() {
    same_slopes_in_reverse(4001, 12);
    same_slopes_in_reverse(4501, 1);
}

fn same_slopes_in_reverse(first_seed: u64, steps: usize) {
    for_each_seed(first_seed, |seed| {
        let mut case = Case::new(seed, Contents::All);
        case.steps = steps;
        let (plan, mut random) = (case.plan(), Random::new(seed ^ 0xfeed));
        let rows = case.rows(&plan);
        let found = slopes(&case, &plan, &rows, &mut random)?;
        for (k, &which) in found.which.iter().enumerate() {
            let (forward, reverse) = (found.forward[k], found.reverse[k]);
            let parameter = &plan.description.parameters[which];
            // Below round-off of the reading nothing is left of a slope.
            let least = 1e-12 * found.range / parameter.value.abs().max(1e-3);
            let largest = forward.abs().max(reverse.abs());
            check((forward - reverse).abs() <= 1e-9 * largest + least, || {
                format!(
                    "record {} by {}: forward {forward:e}, reverse {reverse:e}, relative {:e}",
                    found.record,
                    parameter.path,
                    relative(forward, reverse)
                )
            })?;
        }
        Ok(())
    });
}

/// Slopes lie between the difference quotients of both sides.
///
/// With `d` the central difference quotient and `s` the second difference over h, the quotients of the two sides are
/// `d - s/2` and `d + s/2`. Where the reading is smooth, `d` is of the order of h^2 from the slope and `s` of the order of h;
/// where its slope changes at a switch within h, the slope is at most `s/2` from `d`. Where the reading itself jumps, the
/// quotient grows as h is halved: there is nothing to compare.
#[test]
fn slopes_are_differences() {
    slopes_lie_between_differences(5001, 12);
}

/// The same after the first step.
#[test]
fn slopes_of_the_first_step_are_differences() {
    slopes_lie_between_differences(5501, 1);
}

fn slopes_lie_between_differences(first_seed: u64, steps: usize) {
    // A load makes up for an error of an air within the part of a step, whose length is up to 64 times shorter in the first one.
    let noise_of_loads = if steps == 1 { 64e-5 } else { 1e-5 };
    let [compared, sharp, jumps] = [(); 3].map(|()| core::cell::Cell::new(0));
    let add = |counter: &core::cell::Cell<usize>| counter.set(counter.get() + 1);
    for_each_seed(first_seed, |seed| {
        let mut case = Case::new(seed, Contents::All);
        case.steps = steps;
        let (plan, mut random) = (case.plan(), Random::new(seed ^ 0xd1ff));
        let (rows, numbers) = (case.rows(&plan), values(&plan));
        let found = slopes(&case, &plan, &rows, &mut random)?;
        let reading = found.record % outputs(&case.description).len();
        let load = reading < 4 * case.description.zones.len() && reading % 4 > 1;
        for (&which, &slope) in found.which.iter().zip(&found.forward) {
            let parameter = &plan.description.parameters[which];
            let at = |change: f64| {
                let mut numbers = numbers.clone();
                numbers[which] += change;
                let run = try_run(&plan, &numbers, &rows, &case.options());
                run.map(|run| run.records[found.record]).map_err(|error| error.to_string())
            };
            let middle = at(0.0)?;
            let quotient = |h: f64| {
                let (low, high) = (at(-h)?, at(h)?);
                // A run is found to within 1e-8 K, and loads to within what they need for that.
                let noise = if load { noise_of_loads } else { 1e-8 } / h;
                let second = ((high - middle) - (middle - low)).abs() / h;
                Ok::<_, String>(((high - low) / (2.0 * h), second + noise))
            };
            let h = 1e-4 * parameter.value.abs().max(1e-3);
            let (difference, allowed) = quotient(h)?;
            add(&compared);
            if allowed < 0.02 * slope.abs() {
                add(&sharp);
            }
            if (slope - difference).abs() > allowed {
                let (closer, allowed) = quotient(0.5 * h)?;
                if (closer - difference).abs() > 0.5 * difference.abs() {
                    add(&jumps);
                    continue;
                }
                check((slope - closer).abs() <= allowed, || {
                    format!(
                        "record {} by {} = {}: slope {slope:e}, difference {closer:e}, allowed {allowed:e}",
                        found.record, parameter.path, parameter.value
                    )
                })?;
            }
        }
        Ok(())
    });
    let [compared, sharp, jumps] = [compared, sharp, jumps].map(|counter| counter.get());
    println!("{compared} slopes compared, {sharp} of them within 2 %, {jumps} at a jump");
    assert!(3 * sharp > compared && 50 * jumps < compared.max(50), "{sharp} and {jumps} of {compared}");
}
