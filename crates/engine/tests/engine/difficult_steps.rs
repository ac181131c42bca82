//! Halved steps and the nested iteration: what they find, and slopes along them.

use crate::common::difficult::{jumps, outputs, sharp, steps};
use crate::common::{forcing, options, position, try_run, values};
use mascarin_engine::RunControl;
use mascarin_engine::Scheme;
use mascarin_engine::derivatives::Trajectory;
use mascarin_engine::derivatives::jacobian;
use mascarin_engine::forcing::Forcing;
use mascarin_engine::plan::Plan;
use mascarin_engine::run::ensemble::ensemble;
use mascarin_engine::run::simulate;

const SCHEMES: [Scheme; 2] = [Scheme::Sdirk2, Scheme::BackwardEuler];
/// Parameters of the slopes.
const PARAMETERS: [&str; 3] = ["law.melting_temperature", "surfaces.north.area", "tarp.factor"];

/// The energy balance closes over halved steps and over stages of the nested iteration.
#[test]
fn energy_balance_closes() {
    let [mut nested, mut heated_and_halved] = [0; 2];
    for scheme in SCHEMES {
        let mut halved = 0;
        for (heated, step) in [false, true]
            .into_iter()
            .flat_map(|heated| steps(scheme, heated).into_iter().map(move |step| (heated, step)))
        {
            assert!(step.run.records.iter().all(|record| record.is_finite()), "{}", step.name);
            let closure = step.run.energy_balance.closure();
            assert!(closure < 1e-10, "{}: {closure:e}", step.name);
            let (air, load) = (step.run.state.air[0], step.run.state.load[0]);
            let was_halved = step.run.counters.halvings > 0;
            halved += usize::from(was_halved);
            nested += usize::from(step.run.counters.nested > 0);
            heated_and_halved += usize::from(was_halved && load > 0.0);
            // A heated zone is at its set point at the end; of a halved step, only where its last part is heated.
            let set_point = step.rows[step.rows.len() - 1];
            let free = !heated || load == 0.0 || was_halved;
            assert!(free || (air - set_point).abs() < 1e-7, "{}: {air}", step.name);
        }
        assert!(halved > 5, "{halved} steps are halved, {scheme:?}");
    }
    // The nested iteration is accepted only where it leaves no residual: in few steps.
    assert!(nested > 5 && heated_and_halved > 0, "{nested} nested, {heated_and_halved} heated and halved");
}

/// A step that was halved once is two steps of half its length.
#[test]
fn a_halved_step_is_two_steps() {
    for scheme in SCHEMES {
        let mut compared = 0;
        for step in [false, true].into_iter().flat_map(|heated| steps(scheme, heated)) {
            let halves =
                try_run(&step.plan, &values(&step.plan), &step.rows.repeat(2), &step.options(2)).unwrap();
            // What the nested iteration finds is not yet to be relied on, see tests/nested_iteration.rs.
            let nested = step.run.counters.nested + halves.counters.nested > 0;
            if step.run.counters.halvings != 1 || halves.counters.halvings != 0 || nested {
                continue;
            }
            compared += 1;
            let apart = |a: &[f64], b: &[f64]| {
                a.iter().zip(b).map(|(a, b): (&f64, &f64)| (a - b).abs()).fold(0.0, f64::max)
            };
            let (one, two) = (&step.run.state, &halves.state);
            let temperature = apart(&one.cells, &two.cells).max(apart(&one.air, &two.air));
            // Each stage is found to within 1e-8 K; what melts passes on ten times that from half to half.
            assert!(temperature < 1e-6, "{}: {temperature} K", step.name);
            let heat = apart(&step.run.energy_balance.into, &halves.energy_balance.into)
                / halves.energy_balance.total_exchanged;
            assert!(heat < 1e-7, "{}: flows differ by {heat:e} of all heat", step.name);
        }
        assert!(compared > 3, "{compared} steps, {scheme:?}");
    }
}

/// Slopes across halved steps and nested stages are the same forward and in reverse.
#[test]
fn slopes_forward_are_slopes_in_reverse() {
    for scheme in SCHEMES {
        // Some of them are enough.
        for step in [false, true].into_iter().flat_map(|heated| steps(scheme, heated).into_iter().take(2)) {
            let (plan, numbers, watch) = (&step.plan, values(&step.plan), RunControl::default());
            let which = PARAMETERS.map(|path| position(plan, path));
            let (options, width) = (step.options(1), outputs().len());
            let drive = Forcing::new(&step.rows, scheme.weights().len(), plan.n_channels()).unwrap();
            let forward = jacobian(plan, &numbers, &which, &drive, &options, &watch).unwrap();
            let trajectory = Trajectory::new(plan, &numbers, &drive, &options, &watch, 1 << 30).unwrap();
            for reading in [width, width + 1] {
                let mut weights = vec![0.0; 2 * width];
                weights[reading] = 1.0;
                let reverse = trajectory.pull(plan, &numbers, &drive, &options, &watch, &weights).unwrap();
                for (k, &parameter) in which.iter().enumerate() {
                    let slope = forward.slopes[2 * k * width + reading];
                    let least = 1e-12 * step.run.records[reading].abs().max(1.0) / numbers[parameter];
                    let difference = (slope - reverse[parameter]).abs();
                    assert!(
                        difference <= 1e-9 * slope.abs() + least,
                        "{}, reading {reading} by {}: {slope:e}, {difference:e} apart",
                        step.name,
                        PARAMETERS[k]
                    );
                }
            }
        }
    }
}

/// Slopes of the air temperature across halved steps lie between the difference quotients of both sides, see
/// `tests/properties.rs`. (Of stages that the nested iteration solves and of heated zones they do not, see
/// `tests/slopes_of_stages.rs`.)
#[test]
fn slopes_across_halved_steps_are_differences() {
    for scheme in SCHEMES {
        let mut compared = 0;
        let halved = steps(scheme, false).into_iter().filter(|step| step.run.counters.nested == 0);
        for step in halved.take(6) {
            let (plan, numbers, watch) = (&step.plan, values(&step.plan), RunControl::default());
            let which = PARAMETERS.map(|path| position(plan, path));
            let (options, width) = (step.options(1), outputs().len());
            let drive = Forcing::new(&step.rows, scheme.weights().len(), plan.n_channels()).unwrap();
            let slopes = jacobian(plan, &numbers, &which, &drive, &options, &watch).unwrap().slopes;
            for (k, &parameter) in which.iter().enumerate() {
                let at = |change: f64| {
                    let mut numbers = numbers.clone();
                    numbers[parameter] += change;
                    step.at(&numbers).state.air[0]
                };
                let quotient = |h: f64| {
                    let (low, middle, high) = (at(-h), at(0.0), at(h));
                    ((high - low) / (2.0 * h), ((high - middle) - (middle - low)).abs() / h + 1e-8 / h)
                };
                let (slope, h) = (slopes[2 * k * width + width], 1e-5 * numbers[parameter]);
                let (difference, allowed) = quotient(h);
                // A perturbed step need not be halved, and then ends somewhere else: nothing is to be compared.
                if allowed > 0.05 * difference.abs() || (quotient(0.5 * h).0 - difference).abs() > allowed {
                    continue;
                }
                compared += 1;
                assert!(
                    (slope - difference).abs() <= allowed,
                    "{} by {}: slope {slope:e}, difference {difference:e}, allowed {allowed:e}",
                    step.name,
                    PARAMETERS[k]
                );
            }
        }
        assert!(compared > 10, "{compared} slopes compared, {scheme:?}");
    }
}

/// A member that needs halved steps or the nested iteration has the bits of its single run.
#[test]
fn members_with_difficult_steps_have_the_bits_of_single_runs() {
    let (dt, mut difficult) = (10_800.0, 0);
    for heated in [false, true] {
        let plan = Plan::new(sharp(1e-3, 0.006, 6, heated)).unwrap();
        let (width, count) = (position(&plan, "law.width"), plan.description.parameters.len());
        let mut numbers = Vec::new();
        for member in 0..11 {
            let mut one = values(&plan);
            // The wide ones are solved in lanes.
            one[width] = if member % 2 == 0 { 1e-3 * (1.0 + f64::from(member)) } else { f64::from(member) };
            numbers.extend(one);
        }
        for scheme in SCHEMES {
            let rows = forcing(&plan, scheme, 30, dt, |time, row| jumps(time, dt, row));
            let (options, watch) = (options(scheme, dt, outputs()), RunControl::default());
            let drive = Forcing::new(&rows, scheme.weights().len(), plan.n_channels()).unwrap();
            let together = ensemble(&plan, &numbers, &drive, &options, &watch).unwrap();
            assert!(together.failures.is_empty(), "{:?}", together.failures);
            let row = together.records.len() / 11;
            for (member, numbers) in numbers.chunks(count).enumerate() {
                let alone = simulate(&plan, numbers, &drive, &options, &watch).unwrap();
                difficult += usize::from(alone.counters.halvings + alone.counters.nested > 0);
                for (i, (a, b)) in alone.records.iter().zip(&together.records[member * row..]).enumerate() {
                    assert_eq!(a.to_bits(), b.to_bits(), "{a} is not {b}: member {member}, record {i}");
                }
                assert_eq!(alone.energy_balance.closure().to_bits(), together.closure[member].to_bits());
            }
        }
    }
    assert!((8..40).contains(&difficult), "{difficult} of 44 members");
}
