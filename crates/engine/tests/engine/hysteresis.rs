//! Random partial cycles through every model of hysteresis and every pair of curves.

use mascarin_engine::description::{MeltingCurve, ParamId, PcmLaw, Tail};
use mascarin_engine::number::{Lanes, Real};
use mascarin_engine::pcm::{PcmCoefficients, PcmHistory};
use mascarin_engine::values::Values;

const MODELS: [&str; 3] = ["curve_track", "curve_switch", "curve_scale"];
/// Conductivity, density, specific heat by phase; heat of melting; centre and width of both curves.
const NUMBERS: [f64; 11] = [0.22, 0.18, 880.0, 770.0, 3134.0, 2833.0, 71e3, 22.0, 0.7, 19.5, 0.7];
const KELVIN: f64 = 273.15;

struct Draws(u64);

impl Draws {
    /// Uniform within 0 and 1 (Marsaglia's xorshift).
    fn unit(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A temperature about the range, often near its ends and often where it was [degC].
    fn temperature(&mut self, last: f64) -> f64 {
        match self.unit() {
            u if u < 0.1 => last,
            u if u < 0.4 => last + self.unit() - 0.5,
            _ => 12.0 + 18.0 * self.unit(),
        }
    }
}

fn id(number: u32) -> ParamId {
    ParamId(number)
}

/// A curve whose parameters begin at a number.
type Shape = fn(u32) -> MeltingCurve;

/// Curves of one shape about 22 and 19.5 degC, some skewed.
fn shapes() -> Vec<(&'static str, Shape)> {
    vec![
        ("tanh", |k| MeltingCurve::TanhWidth { melting_temperature: id(k), width: id(k + 1) }),
        ("cubic", |k| MeltingCurve::SmoothStep {
            melting_temperature: id(k),
            width: id(k + 1),
            continuity: 1,
        }),
        ("quintic", |k| MeltingCurve::SmoothStep {
            melting_temperature: id(k),
            width: id(k + 1),
            continuity: 2,
        }),
        ("gaussian", |k| MeltingCurve::Gaussian { melting_temperature: id(k), width: id(k + 1) }),
        ("gumbel", |k| MeltingCurve::Gumbel {
            melting_temperature: id(k),
            width: id(k + 1),
            tail: Tail::Low,
        }),
        ("linear", |k| MeltingCurve::Linear { melting_temperature: id(k), width: id(k + 1) }),
        ("triangle", |k| MeltingCurve::Triangle {
            melting_temperature: id(k),
            below: id(k + 1),
            above: id(k + 1),
        }),
        ("fractions", |k| MeltingCurve::Fractions {
            temperatures: vec![-2.0, -0.8, 0.0, 0.5, 1.0],
            fractions: vec![0.0, 0.1, 0.5, 0.9, 1.0],
            temperature_shift: id(k),
        }),
    ]
}

fn material<S: Real>(numbers: &[S], model: &str, shape: Shape) -> PcmCoefficients<S> {
    let curves = vec![shape(7), shape(9)];
    let law = PcmLaw::History { latent_heat: id(6), model: model.to_owned(), curves, numbers: Vec::new() };
    PcmCoefficients::new(&Values::new(numbers), [id(0), id(1)], [id(2), id(3)], [id(4), id(5)], &law)
}

/// Every model with every shape.
fn all(check: impl Fn(&str, &str, fn(u32) -> MeltingCurve)) {
    for model in MODELS {
        for (name, shape) in shapes() {
            check(&format!("{name}, {model}"), model, shape);
        }
    }
}

/// The enthalpy of a temperature and a fraction, written out [J/m3].
fn enthalpy(temperature: f64, fraction: f64, reference: f64) -> f64 {
    let [solid, liquid] = [3134.0, 2833.0].map(|heat| 880.0 * heat);
    let excess = temperature - reference;
    solid * excess + fraction * (880.0 * 71e3 + (liquid - solid) * excess)
}

fn reference(name: &str) -> f64 {
    if name.starts_with("fractions") { 21.5 } else { 22.0 }
}

#[test]
fn enthalpy_follows_from_temperature_and_fraction_alone() {
    all(|name, model, shape| {
        let pcm = material(&NUMBERS, model, shape);
        let mut draws = Draws(7);
        for _ in 0..300 {
            let mut memory = pcm.begin(5.0);
            let cold = pcm.at(5.0, &memory);
            assert_eq!(cold.liquid_fraction, 0.0);
            let mut temperature = 5.0;
            for _ in 0..30 {
                temperature = draws.temperature(temperature);
                let point = pcm.at(temperature, &memory);
                let xi = point.liquid_fraction;
                assert!((0.0..=1.0).contains(&xi), "{name}: fraction {xi} at {temperature}");
                let expected = enthalpy(temperature, xi, reference(name));
                assert!((point.enthalpy - expected).abs() < 1e-7 * 880.0 * 71e3 * 1e-6, "{name}");
                memory = pcm.next(&memory, temperature, xi, 900.0);
                // Who stays stays where he is.
                let again = pcm.at(temperature, &memory);
                assert!(
                    (again.liquid_fraction - xi).abs() < 1e-12,
                    "{name}: drifts from {xi} at {temperature}"
                );
            }
            let solid = pcm.at(5.0, &memory);
            assert_eq!(solid.liquid_fraction, 0.0, "{name}: solid again");
            assert_eq!(
                solid.enthalpy, cold.enthalpy,
                "{name}: a cycle from solid to solid keeps the enthalpy"
            );
        }
    });
}

#[test]
fn enthalpy_rises_with_temperature_whatever_is_remembered() {
    all(|name, model, shape| {
        let pcm = material(&NUMBERS, model, shape);
        let mut draws = Draws(11);
        let mut memory = pcm.begin(5.0);
        let mut temperature = 5.0;
        for _ in 0..400 {
            temperature = draws.temperature(temperature);
            let fraction = pcm.at(temperature, &memory).liquid_fraction;
            memory = pcm.next(&memory, temperature, fraction, 900.0);
            let mut last = f64::NEG_INFINITY;
            for i in 0..200 {
                let t = 12.0 + 0.09 * f64::from(i);
                let point = pcm.at(t, &memory);
                assert!(point.enthalpy > last, "{name}: falls at {t}");
                assert!(point.capacity > 0.0);
                last = point.enthalpy;
            }
        }
    });
}

/// The slope is that of the enthalpy wherever it has one.
#[test]
fn capacity_is_the_slope_of_the_enthalpy() {
    all(|name, model, shape| {
        let pcm = material(&NUMBERS, model, shape);
        let mut draws = Draws(13);
        let mut memory = pcm.begin(5.0);
        let (mut temperature, mut matching) = (5.0, 0);
        for _ in 0..2000 {
            temperature = draws.temperature(temperature);
            let fraction = pcm.at(temperature, &memory).liquid_fraction;
            memory = pcm.next(&memory, temperature, fraction, 900.0);
            let t = 12.0 + 18.0 * draws.unit();
            let [below, above] = [t - 1e-5, t + 1e-5].map(|t| pcm.at(t, &memory).enthalpy);
            let slope = (above - below) / 2e-5;
            matching += i32::from((slope / pcm.at(t, &memory).capacity - 1.0).abs() < 1e-4);
        }
        assert!(matching > 1990, "{name}: {matching} of 2000");
    });
}

/// What a closed cycle takes up it takes up no colder than it gives it back (Clausius): the integral of dH/T over it
/// is never above zero.
#[test]
fn no_closed_cycle_gains_entropy() {
    const PARTS: u32 = 4000;
    all(|name, model, shape| {
        // Curves as measured are in no order of slopes: small cycles of curve_scale are not promised there.
        if name == "fractions, curve_scale" {
            return;
        }
        let pcm = material(&NUMBERS, model, shape);
        let mut draws = Draws(17);
        let (mut least, mut most) = (0.0_f64, f64::NEG_INFINITY);
        for _ in 0..150 {
            let mut memory = pcm.begin(5.0);
            let mut path = vec![5.0];
            for _ in 0..6 {
                path.push(draws.temperature(*path.last().unwrap()));
            }
            path.push(5.0);
            let mut sum = 0.0;
            let mut last = pcm.at(5.0, &memory).enthalpy;
            for pair in path.windows(2) {
                for i in 0..PARTS {
                    let [before, here] =
                        [i, i + 1].map(|i| pair[0] + (pair[1] - pair[0]) * f64::from(i) / f64::from(PARTS));
                    let point = pcm.at(here, &memory);
                    memory = pcm.next(&memory, here, point.liquid_fraction, 900.0);
                    sum += (point.enthalpy - last) / (KELVIN + 0.5 * (before + here));
                    last = point.enthalpy;
                }
            }
            let entropy = sum / (880.0 * 71e3 / (KELVIN + 22.0));
            (least, most) = (least.min(entropy), most.max(entropy));
        }
        // A part of length d, 4.5 mK at most, is wrong by d^2/(8 T^2) times the jump of its slope: 1.2e-8 of it.
        assert!(most < 2e-8, "{name}: a cycle gains {most} of the entropy of melting");
        // A full cycle with the curves 2.5 K apart loses 2.5/295 of it.
        assert!(least < -0.5 * 2.5 / 295.0, "{name}: no cycle loses more than {least}");
    });
}

#[test]
fn the_models_turn_as_they_say() {
    let (_, shape) = shapes()[5];
    let start = |model| {
        let pcm = material(&NUMBERS, model, shape);
        let memory = pcm.begin(5.0);
        // Linear from 21.3 to 22.7: three quarters at 22.35.
        let fraction = pcm.at(22.35, &memory).liquid_fraction;
        assert!((fraction - 0.75).abs() < 1e-12);
        let memory = pcm.next(&memory, 22.35, fraction, 900.0);
        (pcm, memory)
    };
    let fraction =
        |pcm: &PcmCoefficients<f64>, memory: &PcmHistory<f64>, t| pcm.at(t, memory).liquid_fraction;
    let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-12, "{a} is not {b}");
    // Back along the heating curve.
    let (pcm, memory) = start("curve_track");
    near(fraction(&pcm, &memory, 22.0), 0.5);
    // Nothing until the cooling curve, from 18.8 to 20.2, has three quarters.
    let (pcm, memory) = start("curve_switch");
    near(fraction(&pcm, &memory, 20.0), 0.75);
    near(fraction(&pcm, &memory, 19.5), 0.5);
    near(fraction(&pcm, &memory, 22.7), 1.0);
    // Three quarters of the cooling curve, and the last quarter along the heating curve.
    let (pcm, memory) = start("curve_scale");
    near(fraction(&pcm, &memory, 20.2), 0.75);
    near(fraction(&pcm, &memory, 19.5), 0.375);
    near(fraction(&pcm, &memory, 22.525), 0.875);
    let memory = pcm.next(&memory, 19.5, 0.375, 900.0);
    near(fraction(&pcm, &memory, 21.0), 0.375);
    near(fraction(&pcm, &memory, 22.0), 1.0 - 0.625 * 0.5);
}

#[test]
fn a_lane_has_the_bits_of_its_member() {
    all(|name, model, shape| {
        let members: Vec<Vec<f64>> = (0..4u32)
            .map(|m| {
                let mut numbers = NUMBERS.to_vec();
                numbers[7] += 0.3 * f64::from(m);
                numbers[10] *= 1.0 + 0.1 * f64::from(m);
                numbers
            })
            .collect();
        let lanes: Vec<Lanes<4>> =
            (0..NUMBERS.len()).map(|p| Lanes(core::array::from_fn(|m| members[m][p]))).collect();
        let pack = material(&lanes, model, shape);
        let alone: Vec<_> = members.iter().map(|numbers| material(numbers, model, shape)).collect();
        let mut draws = Draws(23);
        let mut memory = pack.begin(Lanes([5.0; 4]));
        let mut memories: Vec<_> = alone.iter().map(|pcm| pcm.begin(5.0)).collect();
        let mut temperatures = [5.0; 4];
        for _ in 0..500 {
            temperatures = temperatures.map(|last| draws.temperature(last));
            let point = pack.at(Lanes(temperatures), &memory);
            memory = pack.next(&memory, Lanes(temperatures), point.liquid_fraction, 900.0);
            for m in 0..4 {
                let single = alone[m].at(temperatures[m], &memories[m]);
                memories[m] = alone[m].next(&memories[m], temperatures[m], single.liquid_fraction, 900.0);
                for (a, b) in [
                    (point.enthalpy.0[m], single.enthalpy),
                    (point.capacity.0[m], single.capacity),
                    (point.conductivity.0[m], single.conductivity),
                    (memory.model_state[0].0[m], memories[m].model_state[0]),
                    (memory.model_state[1].0[m], memories[m].model_state[1]),
                ] {
                    assert_eq!(a.to_bits(), b.to_bits(), "{name}");
                }
            }
        }
    });
}
