//! Eight members side by side in the vector registers of the machine at hand.
//!
//! The only file with `unsafe` code. Each type below holds eight numbers and computes with the vector instructions of
//! one level; it is handed out only where the machine has them. No operation is contracted or reordered: every level
//! gives the bits of a plain `f64`.

#![allow(unsafe_code, reason = "vector instructions are unsafe to call where the machine may not have them")]

use crate::error::EngineError;
use crate::number::lanes::Lanes;
use crate::number::real::{Abreast, Real, Task};

/// Members in one pack.
pub const WIDTH: usize = 8;

/// Work that can be done with any kind of eight lanes.
pub trait Packed {
    /// What it leaves behind.
    type Output;
    /// Does the work with one kind.
    fn run<S: Real>(self, pack: fn([f64; WIDTH]) -> S) -> Self::Output;
}

/// What lanes are made of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Level {
    /// Arrays, on every machine.
    Array,
    /// Two registers.
    Avx2,
    /// One register.
    Avx512,
}

impl Level {
    /// Environment variable that asks for narrower lanes than the machine has: to measure them, or to check that they give
    /// the same bits.
    pub const VARIABLE: &str = "MASCARIN_LANES";

    /// The widest lanes that this machine has and the environment allows.
    ///
    /// # Errors
    /// [`EngineError::Input`] when the environment names no level.
    pub fn widest() -> Result<Self, EngineError> {
        let asked = std::env::var(Self::VARIABLE).unwrap_or_default();
        let allowed = match asked.as_str() {
            "" | "avx512" => Self::Avx512,
            "avx2" => Self::Avx2,
            "array" => Self::Array,
            other => {
                return Err(EngineError::Input(format!(
                    "environment variable {}: found '{other}', expected avx512, avx2 or array",
                    Self::VARIABLE
                )));
            }
        };
        Ok(allowed.min(Self::available()))
    }

    fn available() -> Self {
        #[cfg(target_arch = "x86_64")]
        {
            if avx512::available() {
                return Self::Avx512;
            }
            if avx2::available() {
                return Self::Avx2;
            }
        }
        Self::Array
    }
}

/// Does the work with lanes of a level that [`Level::widest`] has found.
pub fn run<W: Packed>(level: Level, work: W) -> W::Output {
    match level {
        #[cfg(target_arch = "x86_64")]
        Level::Avx512 => work.run(avx512::Eight::new),
        #[cfg(target_arch = "x86_64")]
        Level::Avx2 => work.run(avx2::Eight::new),
        _ => run_plain(work),
    }
}

/// Does work on plain numbers that stand side by side, such as slopes, with wider instructions where the machine has them.
#[inline(always)]
pub(crate) fn widened<R>(work: impl FnOnce() -> R) -> R {
    #[cfg(target_arch = "x86_64")]
    {
        #[target_feature(enable = "avx2")]
        unsafe fn inside<R>(work: impl FnOnce() -> R) -> R {
            work()
        }
        if avx2::available() {
            // SAFETY: the machine has these instructions.
            return unsafe { inside(work) };
        }
    }
    work()
}

/// Does a task on plain numbers in the widest registers of the machine.
#[inline(always)]
pub(crate) fn abreast<T: Task<f64>>(task: T) -> T::Output {
    #[cfg(target_arch = "x86_64")]
    {
        if avx512::available() {
            return avx512::Eight::vectorised(
                #[inline(always)]
                || task.run::<avx512::Eight>(),
            );
        }
        if avx2::available() {
            return avx2::Eight::vectorised(
                #[inline(always)]
                || task.run::<avx2::Eight>(),
            );
        }
    }
    task.run::<Lanes<WIDTH>>()
}

/// One in one place, zero in all others.
static ALONE: [[f64; WIDTH]; WIDTH] = {
    let mut rows = [[0.0; WIDTH]; WIDTH];
    let mut place = 0;
    while place < WIDTH {
        rows[place][place] = 1.0;
        place += 1;
    }
    rows
};

/// Plain numbers side by side in lanes of some kind.
macro_rules! side_by_side {
    ($kind:ty, |$numbers:ident| $make:expr, |$value:ident| $take:expr) => {
        impl Abreast<f64> for $kind {
            #[inline(always)]
            fn load(numbers: &[f64]) -> Self {
                let mut $numbers = [0.0; WIDTH];
                $numbers.copy_from_slice(&numbers[..WIDTH]);
                $make
            }
            #[inline(always)]
            fn store(self, numbers: &mut [f64]) {
                let $value = self;
                numbers[..WIDTH].copy_from_slice(&$take);
            }
            #[inline(always)]
            fn everywhere(number: f64) -> Self {
                Self::constant(number)
            }
            #[inline(always)]
            fn alone(number: f64, place: usize) -> Self {
                Self::load(&ALONE[place]) * Self::constant(number)
            }
            #[inline(always)]
            fn spread(self, place: usize) -> Self {
                Self::constant(self.lane(place))
            }
            #[inline(always)]
            fn first(self) -> f64 {
                self.lane(0)
            }
            #[inline(always)]
            fn pick(numbers: &[f64], places: &[usize]) -> Self {
                let places = &places[..WIDTH];
                let $numbers = core::array::from_fn(
                    #[inline(always)]
                    |i| numbers[places[i]],
                );
                $make
            }
        }
    };
}

side_by_side!(Lanes<WIDTH>, |numbers| Self(numbers), |value| value.0);
#[cfg(target_arch = "x86_64")]
side_by_side!(avx512::Eight, |numbers| Self::of(numbers), |value| value.numbers());
#[cfg(target_arch = "x86_64")]
side_by_side!(avx2::Eight, |numbers| Self::of(numbers), |value| value.numbers());

/// Does the work with the lanes that every machine has.
pub fn run_plain<W: Packed>(work: W) -> W::Output {
    work.run(Lanes)
}

/// The parts that are the same on all levels. The module must define `Vector`, `Flags` and the functions below on them.
#[cfg(target_arch = "x86_64")]
macro_rules! eight {
    ($features:tt) => {
        use super::WIDTH;
        use crate::number::elementary::{
            Bits, EXPONENT_BIAS, INVERSE_CBRT, SPLIT, THIRD, TWO_52, exp, inverse_cbrt, ln, logistic,
        };
        use crate::number::real::{Logistic, Mask, Real};
        use core::ops::{Add, AddAssign, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

        /// Eight members.
        #[derive(Clone, Copy)]
        #[repr(transparent)]
        pub struct Eight(Vector);

        /// Truth of eight members.
        #[derive(Clone, Copy)]
        #[repr(transparent)]
        pub struct EightMask(Flags);

        impl Eight {
            /// Packs numbers. Only for machines that pass `available`.
            pub fn new(numbers: [f64; WIDTH]) -> Self {
                assert!(available(), "this machine has no such vector instructions");
                Self::of(numbers)
            }
            /// The same, for code that one of them has reached.
            #[inline(always)]
            pub(super) fn of(numbers: [f64; WIDTH]) -> Self {
                // SAFETY: a vector is eight numbers in memory.
                Self(unsafe { core::mem::transmute::<[f64; WIDTH], Vector>(numbers) })
            }
            #[inline(always)]
            pub(super) fn numbers(self) -> [f64; WIDTH] {
                // SAFETY: a vector is eight numbers in memory.
                unsafe { core::mem::transmute::<Vector, [f64; WIDTH]>(self.0) }
            }
        }
        impl core::fmt::Debug for Eight {
            fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                self.numbers().fmt(f)
            }
        }
        impl core::fmt::Debug for EightMask {
            fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                core::array::from_fn::<bool, WIDTH, _>(|lane| self.lane(lane)).fmt(f)
            }
        }
        // SAFETY of all that follows: an `Eight` or a mask exists only where `Eight::new` has found the
        // instructions, or was made by `constant` and `splat`, which only code handed an `Eight` by `run` reaches.
        impl Add for Eight {
            type Output = Self;
            #[inline(always)]
            fn add(self, other: Self) -> Self {
                Self(unsafe { add(self.0, other.0) })
            }
        }
        impl Sub for Eight {
            type Output = Self;
            #[inline(always)]
            fn sub(self, other: Self) -> Self {
                Self(unsafe { sub(self.0, other.0) })
            }
        }
        impl Mul for Eight {
            type Output = Self;
            #[inline(always)]
            fn mul(self, other: Self) -> Self {
                Self(unsafe { mul(self.0, other.0) })
            }
        }
        impl Div for Eight {
            type Output = Self;
            #[inline(always)]
            fn div(self, other: Self) -> Self {
                Self(unsafe { div(self.0, other.0) })
            }
        }
        impl Neg for Eight {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                Self(unsafe { negate(self.0) })
            }
        }
        impl AddAssign for Eight {
            #[inline(always)]
            fn add_assign(&mut self, other: Self) {
                *self = *self + other;
            }
        }
        impl BitAnd for EightMask {
            type Output = Self;
            #[inline(always)]
            fn bitand(self, other: Self) -> Self {
                Self(unsafe { both(self.0, other.0) })
            }
        }
        impl BitOr for EightMask {
            type Output = Self;
            #[inline(always)]
            fn bitor(self, other: Self) -> Self {
                Self(unsafe { either(self.0, other.0) })
            }
        }
        impl Not for EightMask {
            type Output = Self;
            #[inline(always)]
            fn not(self) -> Self {
                Self(unsafe { not(self.0) })
            }
        }
        impl Mask for EightMask {
            #[inline(always)]
            fn splat(value: bool) -> Self {
                Self(unsafe { flags(value) })
            }
            #[inline(always)]
            fn any(self) -> bool {
                unsafe { packed(self.0) != 0 }
            }
            #[inline(always)]
            fn lane(self, lane: usize) -> bool {
                unsafe { packed(self.0) >> lane & 1 == 1 }
            }
        }
        impl Real for Eight {
            type Mask = EightMask;
            type Equations = ();
            const LANES: usize = WIDTH;
            const DERIVATIVES: bool = false;
            const REGISTERS: bool = true;

            #[inline(always)]
            fn vectorised<R>(work: impl FnOnce() -> R) -> R {
                #[target_feature(enable = $features)]
                unsafe fn inside<R>(work: impl FnOnce() -> R) -> R {
                    work()
                }
                unsafe { inside(work) }
            }
            #[inline(always)]
            fn constant(value: f64) -> Self {
                Self(unsafe { splat(value) })
            }
            #[inline(always)]
            fn lane(self, lane: usize) -> f64 {
                self.numbers()[lane]
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                Self(unsafe { sqrt(self.0) })
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
            fn min(self, other: Self) -> Self {
                Self(unsafe { smaller(other.0, self.0) })
            }
            #[inline(always)]
            fn max(self, other: Self) -> Self {
                Self(unsafe { larger(other.0, self.0) })
            }
            #[inline(always)]
            fn abs(self) -> Self {
                Self(unsafe { magnitude(self.0) })
            }
            #[inline(always)]
            fn sin(self) -> Self {
                Self::new(self.numbers().map(f64::sin))
            }
            #[inline(always)]
            fn cos(self) -> Self {
                Self::new(self.numbers().map(f64::cos))
            }
            #[inline(always)]
            fn lt(self, other: Self) -> EightMask {
                EightMask(unsafe { less(self.0, other.0) })
            }
            #[inline(always)]
            fn select(mask: EightMask, yes: Self, no: Self) -> Self {
                Self(unsafe { choose(mask.0, yes.0, no.0) })
            }
        }
        impl Bits for Eight {
            #[inline(always)]
            fn power_of_two(shifted: Self) -> Self {
                Self(unsafe { shift_left::<52>(plus(shifted.0, EXPONENT_BIAS)) })
            }
            #[inline(always)]
            fn split(self) -> (Self, Self) {
                unsafe {
                    let exponent = shift_right::<52>(plus(self.0, SPLIT));
                    let m = minus(plus(self.0, EXPONENT_BIAS << 52), shift_left::<52>(exponent));
                    // The exponent lies below 2^52: its bits and those of 2^52 do not overlap.
                    let e = plus(exponent, TWO_52);
                    (Self(m), Self(e) - Self::constant(4_503_599_627_370_496.0 + EXPONENT_BIAS as f64))
                }
            }
            #[inline(always)]
            fn inverse_cbrt_guess(self) -> Self {
                unsafe {
                    let third = shift_right::<32>(times(shift_right::<32>(self.0), THIRD));
                    Self(shift_left::<32>(minus(bits(INVERSE_CBRT), third)))
                }
            }
        }
    };
}

/// AVX-512: one register.
#[cfg(target_arch = "x86_64")]
mod avx512 {
    #[allow(clippy::wildcard_imports, reason = "intrinsics carry their own prefix")]
    use core::arch::x86_64::*;

    type Vector = __m512d;
    type Flags = __mmask8;

    pub fn available() -> bool {
        is_x86_feature_detected!("avx512f")
    }

    macro_rules! operations {
        ($($(#[$meta:meta])* fn $name:ident $([$shift:ident])? ($($argument:ident: $kind:ty),*) -> $result:ty $body:block)*) => {
            $($(#[$meta])* #[inline] #[target_feature(enable = "avx512f")]
            fn $name $(<const $shift: u32>)? ($($argument: $kind),*) -> $result $body)*
        };
    }
    operations! {
        fn add(a: Vector, b: Vector) -> Vector { _mm512_add_pd(a, b) }
        fn sub(a: Vector, b: Vector) -> Vector { _mm512_sub_pd(a, b) }
        fn mul(a: Vector, b: Vector) -> Vector { _mm512_mul_pd(a, b) }
        fn div(a: Vector, b: Vector) -> Vector { _mm512_div_pd(a, b) }
        fn sqrt(a: Vector) -> Vector { _mm512_sqrt_pd(a) }
        // The second where the first is not the smaller, or larger, one: as a plain number selects.
        fn smaller(a: Vector, b: Vector) -> Vector { _mm512_min_pd(a, b) }
        fn larger(a: Vector, b: Vector) -> Vector { _mm512_max_pd(a, b) }
        fn magnitude(a: Vector) -> Vector { _mm512_abs_pd(a) }
        fn splat(value: f64) -> Vector { _mm512_set1_pd(value) }
        fn negate(a: Vector) -> Vector {
            let sign = _mm512_set1_epi64(i64::MIN);
            _mm512_castsi512_pd(_mm512_xor_si512(_mm512_castpd_si512(a), sign))
        }
        fn less(a: Vector, b: Vector) -> Flags { _mm512_cmp_pd_mask::<_CMP_LT_OQ>(a, b) }
        fn choose(mask: Flags, yes: Vector, no: Vector) -> Vector { _mm512_mask_blend_pd(mask, no, yes) }
        fn flags(value: bool) -> Flags { if value { 0xFF } else { 0 } }
        fn both(a: Flags, b: Flags) -> Flags { a & b }
        fn either(a: Flags, b: Flags) -> Flags { a | b }
        fn not(a: Flags) -> Flags { !a }
        fn packed(a: Flags) -> u8 { a }
        fn bits(value: u64) -> Vector { _mm512_castsi512_pd(_mm512_set1_epi64(value.cast_signed())) }
        fn plus(a: Vector, b: u64) -> Vector {
            _mm512_castsi512_pd(_mm512_add_epi64(_mm512_castpd_si512(a), _mm512_castpd_si512(bits(b))))
        }
        fn minus(a: Vector, b: Vector) -> Vector {
            _mm512_castsi512_pd(_mm512_sub_epi64(_mm512_castpd_si512(a), _mm512_castpd_si512(b)))
        }
        fn times(a: Vector, b: u64) -> Vector {
            _mm512_castsi512_pd(_mm512_mul_epu32(_mm512_castpd_si512(a), _mm512_castpd_si512(bits(b))))
        }
        fn shift_left[BY](a: Vector) -> Vector {
            _mm512_castsi512_pd(_mm512_slli_epi64::<BY>(_mm512_castpd_si512(a)))
        }
        fn shift_right[BY](a: Vector) -> Vector {
            _mm512_castsi512_pd(_mm512_srli_epi64::<BY>(_mm512_castpd_si512(a)))
        }
    }
    eight!("avx512f");
}

/// AVX2: two registers.
#[cfg(target_arch = "x86_64")]
mod avx2 {
    #[allow(clippy::wildcard_imports, reason = "intrinsics carry their own prefix")]
    use core::arch::x86_64::*;

    type Vector = [__m256d; 2];
    type Flags = [__m256d; 2];

    pub fn available() -> bool {
        is_x86_feature_detected!("avx2")
    }

    macro_rules! operations {
        ($(fn $name:ident $([$shift:ident])? ($($argument:ident: $kind:ty),*) -> $result:ty $body:block)*) => {
            $(#[inline] #[target_feature(enable = "avx2")]
            fn $name $(<const $shift: i32>)? ($($argument: $kind),*) -> $result $body)*
        };
    }
    operations! {
        fn add(a: Vector, b: Vector) -> Vector { [_mm256_add_pd(a[0], b[0]), _mm256_add_pd(a[1], b[1])] }
        fn sub(a: Vector, b: Vector) -> Vector { [_mm256_sub_pd(a[0], b[0]), _mm256_sub_pd(a[1], b[1])] }
        fn mul(a: Vector, b: Vector) -> Vector { [_mm256_mul_pd(a[0], b[0]), _mm256_mul_pd(a[1], b[1])] }
        fn div(a: Vector, b: Vector) -> Vector { [_mm256_div_pd(a[0], b[0]), _mm256_div_pd(a[1], b[1])] }
        fn sqrt(a: Vector) -> Vector { [_mm256_sqrt_pd(a[0]), _mm256_sqrt_pd(a[1])] }
        fn smaller(a: Vector, b: Vector) -> Vector { [_mm256_min_pd(a[0], b[0]), _mm256_min_pd(a[1], b[1])] }
        fn larger(a: Vector, b: Vector) -> Vector { [_mm256_max_pd(a[0], b[0]), _mm256_max_pd(a[1], b[1])] }
        fn magnitude(a: Vector) -> Vector {
            let sign = _mm256_set1_pd(-0.0);
            [_mm256_andnot_pd(sign, a[0]), _mm256_andnot_pd(sign, a[1])]
        }
        fn splat(value: f64) -> Vector { [_mm256_set1_pd(value); 2] }
        fn negate(a: Vector) -> Vector {
            let sign = _mm256_set1_pd(-0.0);
            [_mm256_xor_pd(a[0], sign), _mm256_xor_pd(a[1], sign)]
        }
        fn less(a: Vector, b: Vector) -> Flags {
            [_mm256_cmp_pd::<_CMP_LT_OQ>(a[0], b[0]), _mm256_cmp_pd::<_CMP_LT_OQ>(a[1], b[1])]
        }
        fn choose(mask: Flags, yes: Vector, no: Vector) -> Vector {
            [_mm256_blendv_pd(no[0], yes[0], mask[0]), _mm256_blendv_pd(no[1], yes[1], mask[1])]
        }
        fn flags(value: bool) -> Flags { bits(if value { u64::MAX } else { 0 }) }
        fn both(a: Flags, b: Flags) -> Flags { [_mm256_and_pd(a[0], b[0]), _mm256_and_pd(a[1], b[1])] }
        fn either(a: Flags, b: Flags) -> Flags { [_mm256_or_pd(a[0], b[0]), _mm256_or_pd(a[1], b[1])] }
        fn not(a: Flags) -> Flags {
            let all = flags(true);
            [_mm256_xor_pd(a[0], all[0]), _mm256_xor_pd(a[1], all[1])]
        }
        fn packed(a: Flags) -> i32 { _mm256_movemask_pd(a[0]) | _mm256_movemask_pd(a[1]) << 4 }
        fn bits(value: u64) -> Vector { [_mm256_castsi256_pd(_mm256_set1_epi64x(value.cast_signed())); 2] }
        fn plus(a: Vector, b: u64) -> Vector {
            let b = bits(b);
            [0, 1].map(|i| {
                _mm256_castsi256_pd(_mm256_add_epi64(_mm256_castpd_si256(a[i]), _mm256_castpd_si256(b[i])))
            })
        }
        fn minus(a: Vector, b: Vector) -> Vector {
            [0, 1].map(|i| {
                _mm256_castsi256_pd(_mm256_sub_epi64(_mm256_castpd_si256(a[i]), _mm256_castpd_si256(b[i])))
            })
        }
        fn times(a: Vector, b: u64) -> Vector {
            let b = bits(b);
            [0, 1].map(|i| {
                _mm256_castsi256_pd(_mm256_mul_epu32(_mm256_castpd_si256(a[i]), _mm256_castpd_si256(b[i])))
            })
        }
        fn shift_left[BY](a: Vector) -> Vector {
            [0, 1].map(|i| _mm256_castsi256_pd(_mm256_slli_epi64::<BY>(_mm256_castpd_si256(a[i]))))
        }
        fn shift_right[BY](a: Vector) -> Vector {
            [0, 1].map(|i| _mm256_castsi256_pd(_mm256_srli_epi64::<BY>(_mm256_castpd_si256(a[i]))))
        }
    }
    eight!("avx2");
}

#[cfg(test)]
mod tests {
    use super::{Level, Packed, WIDTH, run, run_plain};
    use crate::number::real::{Mask, Real};

    /// Every operation and elementary function on numbers of many sizes.
    struct Everything([f64; WIDTH]);

    impl Packed for Everything {
        type Output = Vec<[u64; WIDTH]>;

        fn run<S: Real>(self, pack: fn([f64; WIDTH]) -> S) -> Self::Output {
            let x = pack(self.0);
            let y = pack(self.0.map(|x| 17.0 / x - 0.3));
            S::vectorised(|| everything(x, y))
                .into_iter()
                .map(|value| core::array::from_fn(|lane| value.lane(lane).to_bits()))
                .collect()
        }
    }

    fn everything<S: Real>(x: S, y: S) -> Vec<S> {
        let mut sum = x;
        sum += y;
        let less = x.lt(y);
        let flags = (less & S::one().lt(x)) | !S::zero().lt(y);
        let marked = if less.any() && less.lane(0) { x } else { y };
        vec![
            sum,
            x - y,
            x * y,
            x / y,
            -x,
            x.sqrt(),
            y.exp(),
            x.ln(),
            x.inverse_cbrt(),
            x.cbrt(),
            x.powf(y),
            y.logistic().rise,
            y.logistic().rest,
            y.logistic().tail,
            y.sin(),
            y.cos(),
            y.abs(),
            x.min(y).max(S::constant(0.1)),
            S::select(flags, x, y),
            S::select(S::Mask::splat(true), marked, y),
        ]
    }

    /// All levels that this machine has give the bits of a plain number, lane by lane.
    #[test]
    fn levels_give_the_bits_of_scalars() {
        for start in [1e-200, 1e-9, 0.07, 1.0, 23.4, 3e8] {
            let numbers: [f64; WIDTH] = core::array::from_fn(|lane| start * (1.0 + 0.61 * lane as f64));
            let scalars: Vec<_> = numbers.iter().map(|&x| everything(x, 17.0 / x - 0.3)).collect();
            let mut levels =
                vec![run(Level::available(), Everything(numbers)), run_plain(Everything(numbers))];
            #[cfg(target_arch = "x86_64")]
            if super::avx2::available() {
                levels.push(Everything(numbers).run(super::avx2::Eight::new));
            }
            for level in levels {
                for (operation, lanes) in level.iter().enumerate() {
                    for (lane, &bits) in lanes.iter().enumerate() {
                        // What is marked depends on the first lane alone.
                        let expected =
                            if operation + 1 == level.len() && lane > 0 { continue } else { &scalars[lane] };
                        assert_eq!(
                            bits,
                            expected[operation].to_bits(),
                            "operation {operation} of {}",
                            numbers[lane]
                        );
                    }
                }
            }
        }
    }
}
