//! Every level gives the bits of a plain number, for every operation.

use super::{LaneTask, Level, SINGLE_WIDTH, WIDTH, in_chunks_at, run, run_single};
use crate::number::lanes::Lanes;
use crate::number::real::{Chunk, ChunkTask, Mask, Real};

/// Numbers of many sizes, with zeros of both signs, subnormal numbers, infinities and no number at all.
fn samples() -> Vec<[f64; WIDTH]> {
    let mut all: Vec<[f64; WIDTH]> = [1e-200, 1e-9, 0.07, 1.0, 23.4, 3e8]
        .iter()
        .map(|start| core::array::from_fn(|lane| start * (1.0 + 0.61 * lane as f64)))
        .collect();
    all.push([0.0, -0.0, 1.0, -1.0, 5e-324, -5e-324, f64::MIN_POSITIVE, -f64::MAX]);
    all.push([f64::INFINITY, f64::NEG_INFINITY, f64::NAN, 1e300, -1e-300, 0.0, -0.0, 2.0]);
    all
}

/// Operations on any numbers.
fn operations<S: Real>(x: S, y: S) -> Vec<S> {
    let mut sum = x;
    sum += y;
    vec![
        sum,
        x + y,
        x - y,
        x * y,
        x / y,
        -x,
        x.sqrt(),
        x.abs(),
        x.min(y),
        x.max(y),
        y.min(x),
        y.max(x),
        x.scale(3.7),
        x.pow4(),
        x.smooth_abs(0.5),
        x.fixed(),
        S::zero(),
        S::one(),
    ]
}

/// Functions of positive normal numbers x and of any y.
fn functions<S: Real>(x: S, y: S) -> Vec<S> {
    let [of_x, of_y] = [x, y].map(S::logistic);
    vec![
        x.ln(),
        x.inverse_cbrt(),
        x.cbrt(),
        x.powf(y),
        y.exp(),
        (-y).exp(),
        y.sin(),
        y.cos(),
        of_x.rise,
        of_x.rest,
        of_x.tail,
        of_y.rise,
        of_y.rest,
        of_y.tail,
    ]
}

/// Choices by masks: each relation and each operation on masks.
fn choices<S: Real>(x: S, y: S) -> Vec<S> {
    let (less, small) = (x.lt(y), S::zero().lt(x) & x.lt(S::one()));
    [less, y.lt(x), less & small, less | small, !less, S::Mask::splat(true), S::Mask::splat(false)]
        .map(|mask| S::select(mask, x, y))
        .into()
}

/// What some numbers give with lanes of a kind, lane by lane.
struct Bits<F>([[f64; WIDTH]; 2], F);

/// A function of two numbers, of any kind.
trait Of: Copy {
    fn of<S: Real>(self, x: S, y: S) -> Vec<S>;
}

macro_rules! of {
    ($name:ident, $function:ident) => {
        #[derive(Clone, Copy)]
        struct $name;
        impl Of for $name {
            fn of<S: Real>(self, x: S, y: S) -> Vec<S> {
                $function(x, y)
            }
        }
    };
}
of!(Operations, operations);
of!(Functions, functions);
of!(Choices, choices);

impl<F: Of> LaneTask for Bits<F> {
    type Output = Vec<Vec<u64>>;

    fn run<S: Real>(self, pack: impl Fn(&[f64]) -> S + Copy) -> Self::Output {
        // In sixteen lanes the numbers stand twice.
        let [x, y] = self.0.map(|numbers| pack(&numbers.repeat(S::LANES / WIDTH)));
        S::vectorised(|| self.1.of(x, y))
            .into_iter()
            .map(|value| (0..S::LANES).map(|lane| bits(value.lane(lane))).collect())
            .collect()
    }
    fn without_lanes(self) -> Self::Output {
        self.run(Lanes::<WIDTH>::of)
    }
}

/// Bits of a number; of what is no number it is not defined which ones it has.
fn bits(value: f64) -> u64 {
    if value.is_nan() { f64::NAN.to_bits() } else { value.to_bits() }
}

fn hold_to_plain_numbers<F: Of>(f: F, numbers: [[f64; WIDTH]; 2]) {
    for level in Level::available() {
        hold_to::<f64>(f, numbers, &run(level, Bits(numbers, f)), level);
        // Arrays have double precision only.
        if level != Level::Array {
            hold_to::<f32>(f, numbers, &run_single(level, Bits(numbers, f)), level);
        }
    }
}

/// Holds lanes to plain numbers of a kind.
fn hold_to<P: Real>(f: impl Of, numbers: [[f64; WIDTH]; 2], found: &[Vec<u64>], level: Level) {
    for (k, lanes) in found.iter().enumerate() {
        assert!(lanes.len() == if P::SINGLE { SINGLE_WIDTH } else { WIDTH });
        for (lane, &found) in lanes.iter().enumerate() {
            let [x, y] = numbers.map(|numbers| P::constant(numbers[lane % WIDTH]));
            let expected = f.of(x, y)[k].lane(0);
            assert_eq!(
                found,
                bits(expected),
                "{level:?}, {} lanes, operation {k} of {x:?} and {y:?}: {} is not {expected}",
                lanes.len(),
                f64::from_bits(found)
            );
        }
    }
}

#[test]
fn operations_of_all_levels_give_the_bits_of_plain_numbers() {
    for x in samples() {
        for mut y in samples() {
            y.rotate_left(3);
            hold_to_plain_numbers(Operations, [x, y]);
            hold_to_plain_numbers(Choices, [x, y]);
        }
    }
}

#[test]
fn functions_of_all_levels_give_the_bits_of_plain_numbers() {
    for x in samples().into_iter().take(6) {
        hold_to_plain_numbers(Functions, [x, x.map(|x| 17.0 / x - 0.3)]);
        hold_to_plain_numbers(Functions, [x, x.map(|x| 0.3 - x)]);
    }
}

/// Answers of masks about their lanes.
struct Marks;

impl LaneTask for Marks {
    type Output = ();

    fn run<S: Real>(self, pack: impl Fn(&[f64]) -> S + Copy) {
        assert_eq!(S::LANES, if S::SINGLE { SINGLE_WIDTH } else { WIDTH });
        for marked in 0..S::LANES {
            let mut numbers = vec![1.0; S::LANES];
            numbers[marked] = -1.0;
            let mask = pack(&numbers).lt(S::zero());
            assert!(mask.any() && !(mask & !mask).any() && (mask | !mask).lane(0));
            for lane in 0..S::LANES {
                assert_eq!((mask.lane(lane), (!mask).lane(lane)), (lane == marked, lane != marked));
            }
        }
        assert!(!S::constant(f64::NAN).lt(S::one()).any() && !S::one().lt(S::constant(f64::NAN)).any());
    }
    fn without_lanes(self) {
        self.run(Lanes::<WIDTH>::of);
    }
}

#[test]
fn masks_of_all_levels_mark_their_lanes() {
    Level::available().for_each(|level| run(level, Marks));
    Level::available().for_each(|level| run_single(level, Marks));
}

/// Neighbouring numbers, loaded, computed with and stored again; and which type did it.
struct Neighbours<'a>(&'a [f64]);

impl ChunkTask<f64> for Neighbours<'_> {
    type Output = (Vec<u64>, &'static str);

    fn run<V: Chunk<f64>>(self) -> Self::Output {
        let mut stored = Vec::new();
        let mut store = |value: V| {
            let mut numbers = [0.0; WIDTH + 1];
            value.store(&mut numbers);
            assert_eq!(numbers[WIDTH], 0.0, "the number behind stays");
            stored.extend(numbers[..WIDTH].iter().map(|number| number.to_bits()));
        };
        let (here, next) = (V::load(self.0), V::load(&self.0[WIDTH..]));
        store(here);
        store(here * next + V::filled(0.1));
        store(V::single(7.5, 3));
        store(next.broadcast(5));
        store(V::gather(self.0, &[8, 3, 3, 0, 15, 1, 2, 9]));
        assert_eq!(here.first(), self.0[0]);
        (stored, core::any::type_name::<V>())
    }
}

#[test]
fn neighbouring_numbers_get_the_same_bits_on_all_levels() {
    let numbers: Vec<f64> = (0..2 * WIDTH).map(|k| (k as f64 - 3.3) / 7.0).collect();
    let mut expected = numbers[..WIDTH].to_vec();
    expected.extend((0..WIDTH).map(|k| numbers[k] * numbers[WIDTH + k] + 0.1));
    expected.extend([0.0, 0.0, 0.0, 7.5, 0.0, 0.0, 0.0, 0.0]);
    expected.extend([numbers[WIDTH + 5]; WIDTH]);
    expected.extend([8, 3, 3, 0, 15, 1, 2, 9].map(|k| numbers[k]));
    let expected: Vec<_> = expected.iter().map(|number| number.to_bits()).collect();
    let mut types = Vec::new();
    for level in Level::available() {
        let (found, kind) = in_chunks_at(level, Neighbours(&numbers));
        assert_eq!(found, expected, "{level:?}");
        types.push(kind);
    }
    assert_eq!(types[0], core::any::type_name::<Lanes<WIDTH>>(), "the array comes first");
    types.dedup();
    assert_eq!(types.len(), Level::available().count(), "each level has registers of its own");
}
