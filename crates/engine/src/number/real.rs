//! The one number trait of the engine, and the three numbers that implement it.
//!
//! Physics is written once over [`Real`] and runs as a plain `f64`, as [`Lanes`] (one
//! ensemble member per lane) and with forward derivatives ([`Dual`]).
//!
//! A member must give the same bits alone and in a lane. Therefore elementary functions
//! are our own (branch-free, built from `+ - * /` and bit operations, each correctly
//! rounded by IEEE 754), lanes apply them element by element, nothing is contracted to
//! fused operations, and code on lane values selects instead of branching.

use core::fmt::Debug;
use core::ops::{Add, AddAssign, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

use crate::number::equations::{EquationSlopes, Equations};

/// A truth value per lane.
pub trait Mask: Copy + Debug + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self> {
    /// The same answer in every lane.
    fn splat(value: bool) -> Self;
    /// True when any lane is true.
    fn any(self) -> bool;
    /// Answer of one lane.
    fn lane(self, lane: usize) -> bool;
}

impl Mask for bool {
    #[inline(always)]
    fn splat(value: bool) -> Self {
        value
    }
    #[inline(always)]
    fn any(self) -> bool {
        self
    }
    #[inline(always)]
    fn lane(self, _lane: usize) -> bool {
        self
    }
}

/// The logistic function of x, to the base 2.
#[derive(Debug, Clone, Copy)]
pub struct Logistic<S> {
    /// `1/(1 + 2^-x)`.
    pub rise: S,
    /// `1/(1 + 2^x)`, which is what `rise` lacks of 1.
    pub rest: S,
    /// `ln(1 + 2^-|x|)`, within 4e-16.
    pub tail: S,
}

impl<S: Real> Logistic<S> {
    /// The slopes of all parts at the x that they belong to.
    #[inline(always)]
    pub(crate) fn slopes(&self, x: S) -> Self {
        let rise = (self.rise * self.rest).scale(core::f64::consts::LN_2);
        let tail = S::select(x.lt(S::zero()), self.rise, -self.rest).scale(core::f64::consts::LN_2);
        Self { rise, rest: -rise, tail }
    }
}

/// A number the physics can be run with.
pub trait Real:
    Copy
    + Debug
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
{
    /// Comparison results.
    type Mask: Mask;
    /// Number of ensemble members carried.
    const LANES: usize;
    /// What the number needs to know of equations that it is solved from.
    type Equations: Equations<Self>;
    /// True when the number carries derivatives (Newton then adds one iteration, so that they converge too).
    const DERIVATIVES: bool;
    /// How many of them that stand side by side in memory are computed with together, see [`Abreast`].
    const SIDE: usize = 1;
    /// Whether it lies in a register or two, so that a row of numbers may stay there.
    const REGISTERS: bool = false;

    /// Does a task with as many numbers at once as the machine has room for.
    #[inline(always)]
    fn abreast<T: Task<Self>>(task: T) -> T::Output {
        task.run::<Self>()
    }

    /// The same constant in every lane.
    fn constant(value: f64) -> Self;
    /// Value of one lane, without derivatives.
    fn lane(self, lane: usize) -> f64;
    /// The value alone, without derivatives.
    #[inline(always)]
    #[must_use]
    fn fixed(self) -> Self {
        self
    }
    /// Whether it has derivatives that are not zero.
    #[inline(always)]
    fn carries(self) -> bool {
        false
    }
    /// Square root.
    #[must_use]
    fn sqrt(self) -> Self;
    /// Exponential; the argument is clamped to \[-708, 709\].
    #[must_use]
    fn exp(self) -> Self;
    /// Natural logarithm of a positive normal number.
    #[must_use]
    fn ln(self) -> Self;
    /// `x^(-1/3)` of a positive normal number.
    #[must_use]
    fn inverse_cbrt(self) -> Self;
    /// The logistic function to the base 2, and its integral.
    #[must_use]
    fn logistic(self) -> Logistic<Self>;
    /// Sine of an angle in rad.
    #[must_use]
    fn sin(self) -> Self;
    /// Cosine of an angle in rad.
    #[must_use]
    fn cos(self) -> Self;
    /// True where self < other.
    fn lt(self, other: Self) -> Self::Mask;
    /// `yes` where the mask is true, else `no`.
    #[must_use]
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;

    /// Runs `work` with the vector instructions that this number is made of, if any.
    ///
    /// What is to run vectorised must be inlined into `work`: hence the `inline(always)` on all physics.
    #[inline(always)]
    fn vectorised<R>(work: impl FnOnce() -> R) -> R {
        work()
    }
    /// Cube root of a positive normal number.
    #[inline(always)]
    #[must_use]
    fn cbrt(self) -> Self {
        let inverse = self.inverse_cbrt();
        self * inverse * inverse
    }
    /// Power of a positive base.
    #[inline(always)]
    #[must_use]
    fn powf(self, exponent: Self) -> Self {
        (exponent * self.ln()).exp()
    }
    /// The smaller one.
    #[inline(always)]
    #[must_use]
    fn min(self, other: Self) -> Self {
        Self::select(other.lt(self), other, self)
    }
    /// The larger one.
    #[inline(always)]
    #[must_use]
    fn max(self, other: Self) -> Self {
        Self::select(self.lt(other), other, self)
    }
    /// Magnitude.
    #[inline(always)]
    #[must_use]
    fn abs(self) -> Self {
        Self::select(self.lt(Self::zero()), -self, self)
    }
    /// `|self|` rounded off within `radius` of zero, so that its powers keep a finite slope there.
    #[inline(always)]
    #[must_use]
    fn smooth_abs(self, radius: f64) -> Self {
        (self * self + Self::constant(radius * radius)).sqrt()
    }
    /// Zero.
    #[inline(always)]
    #[must_use]
    fn zero() -> Self {
        Self::constant(0.0)
    }
    /// One.
    #[inline(always)]
    #[must_use]
    fn one() -> Self {
        Self::constant(1.0)
    }
    /// Product with a constant.
    #[inline(always)]
    #[must_use]
    fn scale(self, factor: f64) -> Self {
        self * Self::constant(factor)
    }
    /// Fourth power.
    #[inline(always)]
    #[must_use]
    fn pow4(self) -> Self {
        let square = self * self;
        square * square
    }
}

/// Whether two numbers have the same bits in all lanes; of slopes nothing is known.
pub(crate) fn same<S: Real>(a: S, b: S) -> bool {
    !S::DERIVATIVES && (0..S::LANES).all(|lane| a.lane(lane).to_bits() == b.lane(lane).to_bits())
}

/// [`Real::SIDE`] numbers that stand side by side in memory, computed with together: of a plain number as many as fit a
/// register, of all others one. Each gets the bits that it would get alone.
pub trait Abreast<S: Real>: Real {
    /// The first numbers of a slice.
    fn load(numbers: &[S]) -> Self;
    /// To the first places of a slice.
    fn store(self, numbers: &mut [S]);
    /// The same number in all places.
    fn everywhere(number: S) -> Self;
    /// A number in one place and zero in all others.
    fn alone(number: S, place: usize) -> Self;
    /// What stands in one place, in all of them.
    #[must_use]
    fn spread(self, place: usize) -> Self;
    /// What stands in the first place.
    fn first(self) -> S;
    /// Numbers by their places in a slice.
    fn pick(numbers: &[S], places: &[usize]) -> Self;
}

impl<S: Real> Abreast<S> for S {
    #[inline(always)]
    fn load(numbers: &[S]) -> Self {
        numbers[0]
    }
    #[inline(always)]
    fn store(self, numbers: &mut [S]) {
        numbers[0] = self;
    }
    #[inline(always)]
    fn everywhere(number: S) -> Self {
        number
    }
    #[inline(always)]
    fn alone(number: S, _place: usize) -> Self {
        number
    }
    #[inline(always)]
    fn spread(self, _place: usize) -> Self {
        self
    }
    #[inline(always)]
    fn first(self) -> S {
        self
    }
    #[inline(always)]
    fn pick(numbers: &[S], places: &[usize]) -> Self {
        numbers[places[0]]
    }
}

/// Work on numbers side by side.
pub trait Task<S: Real> {
    /// What it leaves behind.
    type Output;
    /// Does the work with registers of one kind.
    fn run<V: Abreast<S>>(self) -> Self::Output;
}

// ---------------------------------------------------------------- elementary functions

/// What elementary functions need to know of the bits of a number, by lane.
pub(crate) trait Bits: Real {
    /// `2^k` of the integer k that stands in the low bits of `1.5 * 2^52 + k`.
    fn power_of_two(shifted: Self) -> Self;
    /// (m, e) with x = m 2^e and m in \[sqrt(1/2), sqrt 2).
    fn split(self) -> (Self, Self);
    /// `x^(-1/3)` within 4 %, from a third of the exponent.
    fn inverse_cbrt_guess(self) -> Self;
}

// ln 2 in two parts (Cody & Waite): the first has trailing zeros, so that k * LN2_HIGH is exact.
const LN2_HIGH: f64 = 6.931_471_803_691_238e-1;
const LN2_LOW: f64 = 1.908_214_929_270_587_7e-10;

/// 1.5 * 2^52: adding it rounds to an integer that can be read from the low bits.
const ROUND: f64 = 6_755_399_441_055_744.0;

/// Value of a polynomial whose highest coefficient comes first.
#[inline(always)]
fn polynomial<S: Real, const N: usize>(x: S, coefficients: [f64; N]) -> S {
    let mut sum = S::constant(coefficients[0]);
    for &coefficient in &coefficients[1..] {
        sum = sum * x + S::constant(coefficient);
    }
    sum
}

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
    // Below this nothing is left of `2^t`.
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

/// A polynomial of degree 5 whose lowest coefficient comes first, in parts that do not wait for each other.
#[inline(always)]
fn quintic<S: Real>(x: S, c: [f64; 6]) -> S {
    let pair = |i: usize| S::constant(c[i]) + x.scale(c[i + 1]);
    let square = x * x;
    pair(0) + square * (pair(2) + square * pair(4))
}

/// x^(-1/3) of a positive normal number: two steps of `y (1 + r/3 + 2 r^2/9 + 14 r^3/81)`,
/// r = 1 - x y^3, each of which takes the error to its fourth power; no division.
#[inline(always)]
pub(crate) fn inverse_cbrt<S: Bits>(x: S) -> S {
    let mut y = x.inverse_cbrt_guess();
    for _ in 0..2 {
        let r = S::one() - x * (y * y * y);
        y = y + y * (r * polynomial(r, [14.0 / 81.0, 2.0 / 9.0, 1.0 / 3.0]));
    }
    y
}

// Bit patterns shared by all implementations of `Bits`.
pub(crate) const EXPONENT_BIAS: u64 = 1023;
/// Brings the exponent of a number above sqrt(1/2) of its binade to its own: `1023 * 2^52 - bits(sqrt(1/2))`.
pub(crate) const SPLIT: u64 = (EXPONENT_BIAS << 52) - 0x3FE6_A09E_667F_3BCD;
/// Bits of 2^52: a small integer added to them reads as 2^52 + integer.
pub(crate) const TWO_52: u64 = 0x4330_0000_0000_0000;
/// A third of 2^32, rounded up.
pub(crate) const THIRD: u64 = 0x5555_5556;
/// High word of the guess of `x^(-1/3)` before a third of the high word of x is taken off.
pub(crate) const INVERSE_CBRT: u64 = 0x553F_0000;

impl Bits for f64 {
    #[inline(always)]
    fn power_of_two(shifted: Self) -> Self {
        Self::from_bits(shifted.to_bits().wrapping_add(EXPONENT_BIAS) << 52)
    }
    #[inline(always)]
    fn split(self) -> (Self, Self) {
        let bits = self.to_bits();
        let exponent = bits.wrapping_add(SPLIT) >> 52;
        let m = Self::from_bits(bits.wrapping_add(EXPONENT_BIAS << 52).wrapping_sub(exponent << 52));
        let e = Self::from_bits(exponent | TWO_52) - (4_503_599_627_370_496.0 + EXPONENT_BIAS as f64);
        (m, e)
    }
    #[inline(always)]
    fn inverse_cbrt_guess(self) -> Self {
        let third = ((self.to_bits() >> 32) * THIRD) >> 32;
        Self::from_bits(INVERSE_CBRT.wrapping_sub(third) << 32)
    }
}

// ---------------------------------------------------------------- f64

impl Real for f64 {
    type Mask = bool;
    type Equations = ();
    const LANES: usize = 1;
    const DERIVATIVES: bool = false;
    const SIDE: usize = crate::number::simd::WIDTH;
    const REGISTERS: bool = true;

    #[inline(always)]
    fn abreast<T: Task<Self>>(task: T) -> T::Output {
        crate::number::simd::abreast(task)
    }

    #[inline(always)]
    fn constant(value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn lane(self, _lane: usize) -> f64 {
        self
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    #[inline(always)]
    fn exp(self) -> Self {
        exp(self)
    }
    #[inline(always)]
    fn ln(self) -> Self {
        ln(self)
    }
    #[inline(always)]
    fn inverse_cbrt(self) -> Self {
        inverse_cbrt(self)
    }
    #[inline(always)]
    fn logistic(self) -> Logistic<Self> {
        logistic(self)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        f64::abs(self)
    }
    #[inline(always)]
    fn sin(self) -> Self {
        f64::sin(self)
    }
    #[inline(always)]
    fn cos(self) -> Self {
        f64::cos(self)
    }
    #[inline(always)]
    fn lt(self, other: Self) -> bool {
        self < other
    }
    #[inline(always)]
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }
}

// ---------------------------------------------------------------- lanes

/// `N` members side by side.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(align(64))]
pub struct Lanes<const N: usize>(pub [f64; N]);

/// Truth of `N` members.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LaneMask<const N: usize>([bool; N]);

impl<const N: usize> Lanes<N> {
    #[inline(always)]
    fn map(self, f: impl Fn(f64) -> f64) -> Self {
        Self(core::array::from_fn(|i| f(self.0[i])))
    }
    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        Self(core::array::from_fn(|i| f(self.0[i], other.0[i])))
    }
}

impl<const N: usize> Add for Lanes<N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.zip(other, |a, b| a + b)
    }
}
impl<const N: usize> Sub for Lanes<N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.zip(other, |a, b| a - b)
    }
}
impl<const N: usize> Mul for Lanes<N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.zip(other, |a, b| a * b)
    }
}
impl<const N: usize> Div for Lanes<N> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        self.zip(other, |a, b| a / b)
    }
}
impl<const N: usize> Neg for Lanes<N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.map(|a| -a)
    }
}
impl<const N: usize> AddAssign for Lanes<N> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}
impl<const N: usize> BitAnd for LaneMask<N> {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        Self(core::array::from_fn(|i| self.0[i] & other.0[i]))
    }
}
impl<const N: usize> BitOr for LaneMask<N> {
    type Output = Self;
    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        Self(core::array::from_fn(|i| self.0[i] | other.0[i]))
    }
}
impl<const N: usize> Not for LaneMask<N> {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Self(core::array::from_fn(|i| !self.0[i]))
    }
}
impl<const N: usize> Mask for LaneMask<N> {
    #[inline(always)]
    fn splat(value: bool) -> Self {
        Self([value; N])
    }
    #[inline(always)]
    fn any(self) -> bool {
        self.0.iter().any(|&lane| lane)
    }
    #[inline(always)]
    fn lane(self, lane: usize) -> bool {
        self.0[lane]
    }
}

impl<const N: usize> Real for Lanes<N> {
    type Mask = LaneMask<N>;
    type Equations = ();
    const LANES: usize = N;
    const DERIVATIVES: bool = false;

    #[inline(always)]
    fn constant(value: f64) -> Self {
        Self([value; N])
    }
    #[inline(always)]
    fn lane(self, lane: usize) -> f64 {
        self.0[lane]
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        self.map(f64::sqrt)
    }
    // Not inlined, for the compiler's sake.
    #[inline(never)]
    fn exp(self) -> Self {
        exp(self)
    }
    // Not inlined, for the compiler's sake.
    #[inline(never)]
    fn ln(self) -> Self {
        ln(self)
    }
    // Not inlined, for the compiler's sake.
    #[inline(never)]
    fn inverse_cbrt(self) -> Self {
        inverse_cbrt(self)
    }
    #[inline(always)]
    fn logistic(self) -> Logistic<Self> {
        logistic(self)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        self.map(f64::abs)
    }
    #[inline(always)]
    fn sin(self) -> Self {
        self.map(f64::sin)
    }
    #[inline(always)]
    fn cos(self) -> Self {
        self.map(f64::cos)
    }
    #[inline(always)]
    fn lt(self, other: Self) -> LaneMask<N> {
        LaneMask(core::array::from_fn(|i| self.0[i] < other.0[i]))
    }
    #[inline(always)]
    fn select(mask: LaneMask<N>, yes: Self, no: Self) -> Self {
        Self(core::array::from_fn(|i| if mask.0[i] { yes.0[i] } else { no.0[i] }))
    }
}

impl<const N: usize> Bits for Lanes<N> {
    #[inline(always)]
    fn power_of_two(shifted: Self) -> Self {
        shifted.map(f64::power_of_two)
    }
    #[inline(always)]
    fn split(self) -> (Self, Self) {
        (self.map(|x| x.split().0), self.map(|x| x.split().1))
    }
    #[inline(always)]
    fn inverse_cbrt_guess(self) -> Self {
        self.map(f64::inverse_cbrt_guess)
    }
}

// ---------------------------------------------------------------- duals

/// A number with `K` forward derivatives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dual<const K: usize> {
    /// Value.
    pub value: f64,
    /// Derivatives of the value.
    pub slope: [f64; K],
}

impl<const K: usize> Dual<K> {
    /// The variable whose derivative number `which` is one.
    #[inline(always)]
    #[must_use]
    pub fn variable(value: f64, which: usize) -> Self {
        let mut dual = Self::constant(value);
        dual.slope[which] = 1.0;
        dual
    }
    /// f(self) from the value and slope of f.
    #[inline(always)]
    fn chain(self, value: f64, slope: f64) -> Self {
        Self { value, slope: self.slope.map(|s| s * slope) }
    }
}

impl<const K: usize> Add for Dual<K> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self {
            value: self.value + other.value,
            slope: core::array::from_fn(|i| self.slope[i] + other.slope[i]),
        }
    }
}
impl<const K: usize> Sub for Dual<K> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self {
            value: self.value - other.value,
            slope: core::array::from_fn(|i| self.slope[i] - other.slope[i]),
        }
    }
}
impl<const K: usize> Mul for Dual<K> {
    type Output = Self;
    #[allow(clippy::suspicious_arithmetic_impl, reason = "the product rule is a sum")]
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self {
            value: self.value * other.value,
            slope: core::array::from_fn(|i| self.slope[i] * other.value + self.value * other.slope[i]),
        }
    }
}
impl<const K: usize> Div for Dual<K> {
    type Output = Self;
    #[allow(clippy::suspicious_arithmetic_impl, reason = "the quotient rule has a product and a difference")]
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        Self {
            value,
            slope: core::array::from_fn(|i| (self.slope[i] - value * other.slope[i]) / other.value),
        }
    }
}
impl<const K: usize> Neg for Dual<K> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { value: -self.value, slope: self.slope.map(|s| -s) }
    }
}
impl<const K: usize> AddAssign for Dual<K> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<const K: usize> Real for Dual<K> {
    type Mask = bool;
    type Equations = EquationSlopes<K>;
    const LANES: usize = 1;
    const DERIVATIVES: bool = true;

    #[inline(always)]
    fn constant(value: f64) -> Self {
        Self { value, slope: [0.0; K] }
    }
    #[inline(always)]
    fn lane(self, _lane: usize) -> f64 {
        self.value
    }
    #[inline(always)]
    fn fixed(self) -> Self {
        Self::constant(self.value)
    }
    #[inline(always)]
    fn carries(self) -> bool {
        self.slope != [0.0; K]
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.chain(root, 0.5 / root)
    }
    #[inline(always)]
    fn exp(self) -> Self {
        let value = exp(self.value);
        self.chain(value, value)
    }
    #[inline(always)]
    fn ln(self) -> Self {
        self.chain(ln(self.value), 1.0 / self.value)
    }
    #[inline(always)]
    fn logistic(self) -> Logistic<Self> {
        let at = self.value.logistic();
        let slopes = at.slopes(self.value);
        Logistic {
            rise: self.chain(at.rise, slopes.rise),
            rest: self.chain(at.rest, slopes.rest),
            tail: self.chain(at.tail, slopes.tail),
        }
    }
    #[inline(always)]
    fn vectorised<R>(work: impl FnOnce() -> R) -> R {
        if K > 1 { crate::number::simd::widened(work) } else { work() }
    }
    #[inline(always)]
    fn inverse_cbrt(self) -> Self {
        // d x^(-1/3)/dx = -1/3 x^(-4/3)
        let y = inverse_cbrt(self.value);
        let square = y * y;
        self.chain(y, square * square * (-1.0 / 3.0))
    }
    #[inline(always)]
    fn sin(self) -> Self {
        self.chain(self.value.sin(), self.value.cos())
    }
    #[inline(always)]
    fn cos(self) -> Self {
        self.chain(self.value.cos(), -self.value.sin())
    }
    #[inline(always)]
    fn scale(self, factor: f64) -> Self {
        self.chain(self.value * factor, factor)
    }
    #[inline(always)]
    fn lt(self, other: Self) -> bool {
        self.value < other.value
    }
    #[inline(always)]
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }
}

#[cfg(test)]
mod tests {
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
        let mut x = -1e3;
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

    #[test]
    fn lanes_give_the_bits_of_the_scalar() {
        let x = Lanes([0.1, 1.7, 23.4, 350.0]);
        for lane in 0..4 {
            let s = x.0[lane];
            assert_eq!(Real::exp(x).0[lane].to_bits(), Real::exp(s).to_bits());
            assert_eq!(Real::ln(x).0[lane].to_bits(), Real::ln(s).to_bits());
            assert_eq!(Real::cbrt(x).0[lane].to_bits(), Real::cbrt(s).to_bits());
            let logistic = [Real::logistic(x).rise, Real::logistic(x).rest, Real::logistic(x).tail];
            let alone = [s.logistic().rise, s.logistic().rest, s.logistic().tail];
            assert_eq!(logistic.map(|part| part.0[lane].to_bits()), alone.map(f64::to_bits));
            assert_eq!(x.powf(Lanes([0.89; 4])).0[lane].to_bits(), Real::powf(s, 0.89).to_bits());
            assert_eq!((x / (x + x * x)).0[lane].to_bits(), (s / (s + s * s)).to_bits());
        }
    }

    #[test]
    fn duals_differentiate() {
        let x: Dual<1> = Dual::variable(1.3, 0);
        let f = |x: Dual<1>| (x * x).exp() / x.sqrt() + x.ln() * x.cbrt() - x.sin() / x.cos();
        let value = |x: f64| (x * x).exp() / x.sqrt() + x.ln() * x.cbrt() - x.tan();
        let step = 1e-6;
        let difference = (value(1.3 + step) - value(1.3 - step)) / (2.0 * step);
        close(f(x).value, value(1.3), 1e-14);
        close(f(x).slope[0], difference, 1e-8);
        for place in [-2.3, -0.4, 0.7, 5.1] {
            let at = Dual::<1>::variable(place, 0).logistic();
            let [after, before] = [step, -step].map(|step| (place + step).logistic());
            let quotient = |after: f64, before: f64| (after - before) / (2.0 * step);
            close(at.rise.slope[0], quotient(after.rise, before.rise), 1e-7);
            close(at.rest.slope[0], quotient(after.rest, before.rest), 1e-7);
            close(at.tail.slope[0], quotient(after.tail, before.tail), 1e-7);
        }
    }
}
