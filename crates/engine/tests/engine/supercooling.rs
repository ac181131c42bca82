//! The law of supercooling: what it says at a temperature, its slopes, its events, and what it becomes without supercooling.

use mascarin_engine::description::{FormulaNumber, MeltingCurve, ParamId, PcmLaw};
use mascarin_engine::number::{Lanes, Real};
use mascarin_engine::pcm::{PcmCoefficients, PcmHistory, StageStart};
use mascarin_engine::values::Values;

/// Conductivity, density, specific heat by phase; heat of melting; melting temperature, half-width; degree, kinetics.
const NUMBERS: [f64; 11] = [1.0, 0.5, 1700.0, 1530.0, 1400.0, 2100.0, 190e3, 29.0, 0.5, 8.0, 600.0];
const LATENT: f64 = 1700.0 * 190e3;
const STEP: f64 = 300.0;
/// One stage of backward Euler.
const WHOLE: StageStart<f64> = StageStart { step: STEP, diagonal: 1.0, first: None };

fn id(number: u32) -> ParamId {
    ParamId(number)
}

fn material<S: Real>(numbers: &[S], kinetics: &str) -> PcmCoefficients<S> {
    let number = |name: &str, at| FormulaNumber { name: name.to_owned(), value: id(at) };
    let law = PcmLaw::History {
        latent_heat: id(6),
        model: "supercooling".to_owned(),
        curves: vec![MeltingCurve::Linear { melting_temperature: id(7), width: id(8) }],
        numbers: vec![number("degree", 9), number(kinetics, 10)],
    };
    PcmCoefficients::new(&Values::new(numbers), [id(0), id(1)], [id(2), id(3)], [id(4), id(5)], &law)
}

fn with(kinetics: &str, value: f64) -> PcmCoefficients<f64> {
    let mut numbers = NUMBERS;
    numbers[10] = value;
    material(&numbers, kinetics)
}

/// Both kinetics, with numbers of about the same speed 8 K below the melting range.
fn both() -> [PcmCoefficients<f64>; 2] {
    [with("time_constant", 600.0), with("rate", 1.0 / (600.0 * 8.0))]
}

/// A step that ends at a temperature.
fn step(pcm: &PcmCoefficients<f64>, history: &PcmHistory<f64>, temperature: f64) -> PcmHistory<f64> {
    let stage = pcm.in_stage(history, &WHOLE);
    pcm.next(history, temperature, pcm.at(temperature, &stage).liquid_fraction, STEP)
}

/// Liquid stays so down to the nucleation, 8 K below the melting temperature; solid that has not melted wholly does not supercool.
#[test]
fn only_what_has_melted_wholly_supercools() {
    for pcm in both() {
        let mut history = pcm.begin(40.0);
        for temperature in [35.0, 29.0, 25.0, 21.001] {
            history = step(&pcm, &history, temperature);
            assert_eq!(history.liquid_fraction, 1.0, "at {temperature}");
        }
        // The step that nucleates is still liquid, the next one freezes.
        let nucleated = step(&pcm, &history, 20.9);
        assert_eq!(nucleated.liquid_fraction, 1.0);
        let later = step(&pcm, &nucleated, 20.9);
        assert!(later.liquid_fraction < 0.8);
        // Nine tenths liquid, then colder: it freezes at once, though far above the nucleation.
        let mut partly = pcm.begin(29.4);
        assert!((partly.liquid_fraction - 0.9).abs() < 1e-12);
        partly = step(&pcm, &partly, 27.0);
        assert!(partly.liquid_fraction < 0.8);
    }
}

/// At a constant temperature below the melting range the fraction falls exponentially, `exp(-K t)`, with `K` by either kinetics;
/// implicit steps approach it with their first order, the stages of SDIRK2 with the second.
#[test]
fn kinetics_are_of_first_order() {
    let undercooling = 29.5 - 20.0;
    for (pcm, rate) in
        [(with("time_constant", 600.0), 1.0 / 600.0), (with("rate", 2e-4), 2e-4 * undercooling)]
    {
        let duration = 1200.0;
        let exact = Real::exp(-rate * duration);
        let gamma = 1.0 - f64::sqrt(0.5);
        let run = |steps: u32, two_stages: bool| {
            let dt = duration / f64::from(steps);
            let mut history = step(&pcm, &pcm.begin(40.0), 20.999_999_999);
            history.model_state[1] = 0.0;
            for _ in 0..steps {
                let diagonal = if two_stages { gamma } else { 1.0 };
                let start = StageStart { step: dt, diagonal, first: None };
                let mut fraction = pcm.at(20.0, &pcm.in_stage(&history, &start)).liquid_fraction;
                if two_stages {
                    let first = Some((fraction, (1.0 - gamma) / gamma));
                    let second = pcm.in_stage(&history, &StageStart { first, ..start });
                    fraction = pcm.at(20.0, &second).liquid_fraction;
                }
                history = pcm.next(&history, 20.0, fraction, dt);
            }
            (history.liquid_fraction - exact).abs()
        };
        // Half of the step: half of the error, or a quarter.
        for (two_stages, order) in [(false, 2.0), (true, 4.0)] {
            let reached = run(40, two_stages) / run(80, two_stages);
            assert!((reached / order - 1.0).abs() < 0.07, "{reached} times smaller, expected {order}");
        }
        assert!(run(1000, true) < 1e-6);
    }
}

/// What is left of a step after the nucleation is made up for in the next one: by the straight line of the temperature.
#[test]
fn the_nucleation_falls_into_a_step() {
    let pcm = with("time_constant", 600.0);
    let before = step(&pcm, &pcm.begin(40.0), 22.0);
    let nucleated = step(&pcm, &before, 18.0);
    // From 22 to 18 degC it passes 21 degC after a quarter.
    assert!((nucleated.model_state[1] - 0.75 * STEP).abs() < 1e-9);
    let stage = pcm.in_stage(&nucleated, &WHOLE);
    let expected = 600.0 / (600.0 + 1.75 * STEP);
    assert!((pcm.at(18.0, &stage).liquid_fraction - expected).abs() < 1e-12);
    // Once only.
    assert_eq!(step(&pcm, &nucleated, 18.0).model_state[1], 0.0);
    // Where no time passes nothing freezes.
    let still = pcm.in_stage(&nucleated, &StageStart { step: 0.0, diagonal: 1.0, first: None });
    assert_eq!(pcm.at(18.0, &still).liquid_fraction, 1.0);
}

/// All heat of melting is set free, whatever the way: from liquid to solid and back the enthalpy is that of the same temperature.
#[test]
fn a_cycle_conserves_the_enthalpy() {
    for pcm in both() {
        let mut history = pcm.begin(40.0);
        let hot = pcm.at(40.0, &history).enthalpy;
        for temperature in [30.0, 25.0, 20.0, 25.0, 28.9, 28.0, 20.0] {
            history = step(&pcm, &history, temperature);
        }
        for _ in 0..200 {
            history = step(&pcm, &history, 15.0);
        }
        assert!(history.liquid_fraction < 1e-12);
        let cold = pcm.at(15.0, &history).enthalpy;
        // Liquid from 40 to 29 degC, the heat of melting, solid from 29 to 15 degC.
        let expected = LATENT + 1700.0 * (2100.0 * 11.0 + 1400.0 * 14.0);
        assert!(((hot - cold) / expected - 1.0).abs() < 1e-11, "{} of {expected}", hot - cold);
        history = step(&pcm, &history, 40.0);
        assert_eq!(pcm.at(40.0, &history).enthalpy, hot);
    }
}

/// The enthalpy rises with temperature in every stage, and the capacity is its slope away from the corners.
#[test]
fn the_capacity_is_the_slope_of_the_enthalpy() {
    for pcm in both() {
        let (mut history, mut matching, mut count) = (pcm.begin(40.0), 0, 0);
        let mut seed = 7_u64;
        for _ in 0..200 {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let temperature = 17.0 + 16.0 * ((seed >> 11) as f64 / (1u64 << 53) as f64);
            history = step(&pcm, &history, temperature);
            let stage = pcm.in_stage(&history, &WHOLE);
            let mut last = f64::NEG_INFINITY;
            for i in 0..90 {
                let t = 15.03 + 0.2 * f64::from(i);
                let point = pcm.at(t, &stage);
                assert!(point.enthalpy > last && (0.0..=1.0).contains(&point.liquid_fraction));
                last = point.enthalpy;
                let [below, above] = [t - 1e-5, t + 1e-5].map(|t| pcm.at(t, &stage).enthalpy);
                count += 1;
                matching += i32::from(((above - below) / 2e-5 / point.capacity - 1.0).abs() < 1e-4);
            }
        }
        assert!(matching + 40 > count, "{matching} of {count}");
    }
}

/// The split into convex functions, whose first one rises ever more steeply: with the time constant exactly.
#[test]
fn the_first_part_of_the_enthalpy_is_convex() {
    let pcm = with("time_constant", 600.0);
    for start in [28.6, 29.0, 29.3] {
        let stage = pcm.in_stage(&pcm.begin(start), &WHOLE);
        let (mut slope, mut rest) = (0.0, f64::NEG_INFINITY);
        for i in 0..400 {
            let t = 25.0 + 0.02 * f64::from(i);
            let (_, convex) = pcm.rising(t, &stage);
            assert!(convex >= slope * (1.0 - 1e-9), "from {start}: falls at {t}");
            let concave = convex - pcm.at(t, &stage).capacity;
            assert!(concave >= rest - 1e-6 * LATENT, "from {start}: the rest falls at {t}");
            (slope, rest) = (convex, concave);
        }
    }
}

/// With a time constant of zero and a nucleation above the melting range it freezes as it melts, to the bit as with `curve_track` and twice
/// the same curve.
#[test]
fn without_supercooling_it_is_the_curve() {
    let mut numbers = NUMBERS;
    (numbers[9], numbers[10]) = (-2.0, 0.0);
    let pcm = material(&numbers, "time_constant");
    let curve = || MeltingCurve::Linear { melting_temperature: id(7), width: id(8) };
    let law = PcmLaw::History {
        latent_heat: id(6),
        model: "curve_track".to_owned(),
        curves: vec![curve(), curve()],
        numbers: Vec::new(),
    };
    let track: PcmCoefficients<f64> =
        PcmCoefficients::new(&Values::new(&numbers), [id(0), id(1)], [id(2), id(3)], [id(4), id(5)], &law);
    let (mut one, mut other) = (pcm.begin(20.0), track.begin(20.0));
    for i in 0..500 {
        let t = 29.0 + 1.5 * Real::sin(f64::from(i));
        let (here, there) = (pcm.at(t, &pcm.in_stage(&one, &WHOLE)), track.at(t, &other));
        assert_eq!(here.enthalpy.to_bits(), there.enthalpy.to_bits(), "at {t}");
        assert_eq!(here.capacity.to_bits(), there.capacity.to_bits(), "at {t}");
        one = pcm.next(&one, t, here.liquid_fraction, STEP);
        other = track.next(&other, t, there.liquid_fraction, STEP);
    }
}

#[test]
fn a_lane_has_the_bits_of_its_member() {
    for (kinetics, value) in [("time_constant", 600.0), ("rate", 2e-4)] {
        let member = |m: u32| {
            let mut numbers = NUMBERS;
            numbers[9] += 0.7 * f64::from(m);
            numbers[10] = value * (1.0 + 0.3 * f64::from(m));
            numbers
        };
        let members = [0, 1, 2, 3].map(member);
        let lanes: Vec<Lanes<4>> =
            (0..NUMBERS.len()).map(|p| Lanes(core::array::from_fn(|m| members[m][p]))).collect();
        let pack = material(&lanes, kinetics);
        let alone = members.map(|numbers| material(&numbers, kinetics));
        let mut history = pack.begin(Lanes([40.0; 4]));
        let mut histories = [0, 1, 2, 3].map(|m: usize| alone[m].begin(40.0));
        for i in 0..300 {
            let t = 25.0 + 8.0 * Real::sin(0.3 * f64::from(i)) + f64::from(i % 7);
            let start = StageStart { step: STEP, diagonal: 1.0, first: None };
            let point = pack.at(Lanes([t; 4]), &pack.in_stage(&history, &start));
            history = pack.next(&history, Lanes([t; 4]), point.liquid_fraction, STEP);
            for m in 0..4 {
                let single = alone[m].at(t, &alone[m].in_stage(&histories[m], &WHOLE));
                histories[m] = alone[m].next(&histories[m], t, single.liquid_fraction, STEP);
                assert_eq!(point.enthalpy.0[m].to_bits(), single.enthalpy.to_bits());
                assert_eq!(point.capacity.0[m].to_bits(), single.capacity.to_bits());
                assert_eq!(history.model_state[1].0[m].to_bits(), histories[m].model_state[1].to_bits());
            }
        }
    }
}
