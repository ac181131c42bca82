//! The normal distribution, without a branch.

use crate::number::real::Real;

/// Chebyshev coefficients of `(1 + 2 z) exp(z^2) erfc(z)` over `(z - 3)/(z + 3)`, z >= 0; relative error below 2e-15.
/// The variable is that of Shepherd & Laframboise (1981), Math. Comp. 36, doi:10.1090/S0025-5718-1981-0595058-X.
const SCALED: [f64; 23] = [
    1.177_562_574_196_560_7,
    0.005_353_904_539_615_733,
    -0.093_775_503_422_842_02,
    0.054_366_525_557_443_306,
    -0.018_976_596_707_845_19,
    0.004_453_426_061_462_762,
    -0.000_633_553_171_055_298_4,
    1.766_171_952_319_882e-5,
    1.284_153_286_410_116_4e-5,
    -2.007_228_565_874_811e-6,
    -1.807_522_789_939_195_8e-7,
    7.549_828_349_146_546e-8,
    1.885_668_530_989_469_3e-9,
    -2.699_519_007_113_041_8e-9,
    -1.460_074_485_570_607_5e-11,
    1.036_160_996_192_255_1e-10,
    1.475_779_691_757_087_9e-12,
    -4.277_292_425_453_765_5e-12,
    -2.078_091_906_338_630_5e-13,
    1.813_631_176_897_100_6e-13,
    1.978_892_944_039_658_6e-14,
    -7.205_702_080_531_01e-15,
    -1.438_200_480_040_934e-15,
];

/// Distribution and density of the standard normal distribution.
#[inline(always)]
pub(super) fn normal<S: Real>(u: S) -> (S, S) {
    let z = u.abs().scale(core::f64::consts::FRAC_1_SQRT_2);
    let fading = (-(z * z)).exp();
    let y = (z - S::constant(3.0)) / (z + S::constant(3.0));
    let twice = y.scale(2.0);
    // Clenshaw's recurrence.
    let (mut last, mut before) = (S::zero(), S::zero());
    for &coefficient in SCALED[1..].iter().rev() {
        let next = twice * last - before + S::constant(coefficient);
        before = last;
        last = next;
    }
    let scaled = y * last - before + S::constant(SCALED[0]);
    let tail = (fading * scaled / (S::one() + z.scale(2.0))).scale(0.5);
    let distribution = S::select(u.lt(S::zero()), tail, S::one() - tail);
    // 1/sqrt(2 pi)
    (distribution, fading.scale(0.398_942_280_401_432_7))
}
