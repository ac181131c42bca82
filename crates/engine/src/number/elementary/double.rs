//! Functions in double precision.

use super::{Bits, polynomial};
use crate::number::real::{Logistic, Real};

pub(crate) use super::inverse_cbrt;

// ln 2 in two parts (Cody & Waite): the first has trailing zeros, so that k * LN2_HIGH is exact.
const LN2_HIGH: f64 = 6.931_471_803_691_238e-1;
const LN2_LOW: f64 = 1.908_214_929_270_587_7e-10;

/// 1.5 * 2^52: adding it rounds to an integer that can be read from the low bits.
const ROUND: f64 = 6_755_399_441_055_744.0;

/// e^x by reduction to |r| <= ln2/2 and its Taylor series to r^13 (truncation below 1e-17).
#[inline(always)]
pub(crate) fn exp<S: Bits>(x: S) -> S {
    let x = x.max(S::constant(-708.0)).min(S::constant(709.0));
    let shifted = x.scale(core::f64::consts::LOG2_E) + S::constant(ROUND);
    let k = shifted - S::constant(ROUND);
    let r = (x - k.scale(LN2_HIGH)) - k.scale(LN2_LOW);
    let series = polynomial(
        r,
        [
            1.0 / 6_227_020_800.0,
            1.0 / 479_001_600.0,
            1.0 / 39_916_800.0,
            1.0 / 3_628_800.0,
            1.0 / 362_880.0,
            1.0 / 40_320.0,
            1.0 / 5_040.0,
            1.0 / 720.0,
            1.0 / 120.0,
            1.0 / 24.0,
            1.0 / 6.0,
            0.5,
            1.0,
            1.0,
        ],
    );
    series * S::power_of_two(shifted)
}

/// ln x of a positive normal number: x = m 2^e, ln m = 2 atanh((m-1)/(m+1)).
#[inline(always)]
pub(crate) fn ln<S: Bits>(x: S) -> S {
    let (m, e) = x.split();
    let s = (m - S::one()) / (m + S::one());
    let z = s * s;
    let series = polynomial(
        z,
        [
            1.0 / 23.0,
            1.0 / 21.0,
            1.0 / 19.0,
            1.0 / 17.0,
            1.0 / 15.0,
            1.0 / 13.0,
            1.0 / 11.0,
            1.0 / 9.0,
            1.0 / 7.0,
            1.0 / 5.0,
            1.0 / 3.0,
        ],
    );
    let twice = s.scale(2.0);
    e.scale(LN2_HIGH) + (twice + (twice * (series * z) + e.scale(LN2_LOW)))
}

/// The logistic function and its integral by one division.
///
/// `2^t = 2^k (R + r)/(R - r)` with `r = t - k`, `R = r coth(r ln2/2)`; with `p = R - r` and `n = 2^k (R + r)` the sum
/// `1 + 2^t` is `(p + n)/p`, and its logarithm `ln2/2 + 2 atanh s`, `s = (p + n - p sqrt2)/(p + n + p sqrt2)`. `R` and
/// what `2 atanh s` is beyond `2 s` are polynomials by Remez' exchange in 50 digits, within 3e-19 of their range for
/// |r| <= 1/2 and within 4e-17 for `2^t` <= 1.
#[inline(always)]
pub(crate) fn logistic<S: Bits>(x: S) -> Logistic<S> {
    use core::f64::consts::{LN_2, SQRT_2};
    // Below this `2^t` is zero in the sum.
    const LEAST: f64 = -1000.0;
    let t = (-x.abs()).max(S::constant(LEAST));
    let shifted = t + S::constant(ROUND);
    let r = t - (shifted - S::constant(ROUND));
    let coefficients = [
        2.885_390_081_777_926_8,
        1.155_245_300_933_235_9e-1,
        -9.250_684_777_172_66e-4,
        1.058_218_849_683_516_3e-5,
        -1.271_021_899_702_776e-7,
        1.528_150_536_433_382_1e-9,
    ];
    let even = quintic(r * r, coefficients);
    let (p, n) = (even - r, (even + r) * S::power_of_two(shifted));
    let (sum, root) = (p + n, p.scale(SQRT_2));
    let larger = sum + root;
    let inverse = S::one() / (sum * larger);
    let small = n * larger * inverse;
    let s = (sum - root) * sum * inverse;
    let z = s * s;
    let coefficients = [
        6.666_666_666_651_384e-1,
        4.000_000_008_106_152_6e-1,
        2.857_141_319_217_035e-1,
        2.222_361_597_446_944_6e-1,
        1.811_659_808_322_080_8e-1,
        1.689_658_382_252_984_8e-1,
    ];
    let tail = S::constant(0.5 * LN_2) + (s.scale(2.0) + s * (z * quintic(z, coefficients)));
    let (falls, large) = (x.lt(S::zero()), S::one() - small);
    Logistic { rise: S::select(falls, small, large), rest: S::select(falls, large, small), tail }
}

/// A polynomial of degree 5 whose lowest coefficient comes first, in parts that can be computed at the same time.
#[inline(always)]
fn quintic<S: Real>(x: S, c: [f64; 6]) -> S {
    let pair = |i: usize| S::constant(c[i]) + x.scale(c[i + 1]);
    let square = x * x;
    pair(0) + square * (pair(2) + square * pair(4))
}

// Bit patterns shared by all implementations of `Bits`.
pub(crate) const EXPONENT_BIAS: u64 = 1023;
/// Brings the exponent of a number above sqrt(1/2) of its binade to its own: `1023 * 2^52 - bits(sqrt(1/2))`.
pub(crate) const SPLIT: u64 = (EXPONENT_BIAS << 52) - 0x3FE6_A09E_667F_3BCD;
/// Bits of 2^52: a small integer added to them reads as 2^52 + integer.
pub(crate) const TWO_52: u64 = 0x4330_0000_0000_0000;
/// A third of 2^32, rounded up.
pub(crate) const THIRD: u64 = 0x5555_5556;
/// High word of the guess of `x^(-1/3)` before a third of the high word of x is subtracted.
pub(crate) const INVERSE_CBRT: u64 = 0x553F_0000;

#[cfg(test)]
#[allow(clippy::disallowed_methods, reason = "compared with the functions of the standard library")]
mod tests {
    use super::super::{acos, cos, sin, sincos};
    use super::*;

    fn close(a: f64, b: f64, tolerance: f64) {
        assert!((a - b).abs() <= tolerance * b.abs().max(1e-300), "{a} is not {b}");
    }

    #[test]
    fn elementary_functions_agree_with_the_standard_library() {
        let mut x = -700.0;
        while x < 700.0 {
            close(exp(x), f64::exp(x), 4e-16);
            x += 0.377;
        }
        let mut x = 1e-280;
        while x < 1e280 {
            if (x - 1.0).abs() > 1e-3 {
                close(ln(x), f64::ln(x), 4e-16);
            }
            close(Real::cbrt(x), f64::cbrt(x), 8e-16);
            x *= 1.37;
        }
        let mut x = -1e3_f64;
        while x < 1e3 {
            let Logistic { rise, rest, tail } = logistic(x);
            let power = x.abs().mul_add(-core::f64::consts::LN_2, 0.0).exp();
            let parts = [1.0 / (1.0 + power), power / (1.0 + power)];
            let (large, small) = if x < 0.0 { (rest, rise) } else { (rise, rest) };
            close(large, parts[0], 4e-16);
            // The power itself is known as closely as its argument only.
            close(small, parts[1], 4e-16 + 1.6e-16 * x.abs());
            assert!((tail - power.ln_1p()).abs() < 4e-16, "{tail} at {x}");
            x += 0.0137 + 0.01 * x.abs();
        }
        assert!((exp(0.0) - 1.0).abs() < f64::EPSILON);
        assert!(ln(1.0).abs() < f64::EPSILON);
    }

    /// The standard library's are within about one unit in the last place; so are these.
    #[test]
    fn functions_of_angles_agree_with_the_standard_library() {
        let mut x = 1e-9;
        while x < 1e6 {
            for x in [x, -x] {
                close(sin(x), x.sin(), f64::EPSILON);
                close(cos(x), x.cos(), f64::EPSILON);
                assert_eq!(sincos(x), (sin(x), cos(x)), "both at once at {x}");
            }
            x *= 1.0007;
        }
        for k in 0..=20_000 {
            let x = f64::from(k) * 1e-4 - 1.0;
            close(acos(x), x.acos(), f64::EPSILON);
        }
    }

    /// Bits on any processor: a change here is a numerical change.
    #[test]
    fn functions_have_the_same_bits_on_all_processors() {
        let mut all = 0_u64;
        let mut add = |value: f64| all = all.rotate_left(7) ^ value.to_bits();
        for k in 1..2000 {
            let x = f64::from(k) * 0.00731;
            [sin(x), cos(x), acos((x - 7.0) / 8.0), exp(x), ln(x), inverse_cbrt(x)]
                .into_iter()
                .for_each(&mut add);
            let Logistic { rise, rest, tail } = logistic(x - 7.0);
            [rise, rest, tail, Real::powf(x, 1.3)].into_iter().for_each(&mut add);
        }
        assert_eq!(all, 0xe337_9e38_b2e4_2610, "{all:#x}");
    }
}
