//! Numbers in vector registers: the parts that are the same for all instruction sets and both precisions.
//!
//! SAFETY of every call below: the operations may run only where the machine has their instructions. The types of a module are
//! private to [`simd`](super). Other code gets them as a type parameter only, from [`super::run`], [`super::run_single`] and
//! [`super::in_chunks`]. All need the token that only detection makes ([`super::token`]). So code that has the type, and
//! with it `constant`, `splat` or any operation, runs on a machine that has the instructions.

/// Operators that are one operation on the registers of a type: trait, method, operation.
macro_rules! operators {
    ($kind:ident: $($operator:ident $method:ident $operation:ident),*) => {$(
        impl $operator for $kind {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                // SAFETY: see the top of this file.
                Self(unsafe { $operation(self.0, other.0) })
            }
        }
    )*};
}
pub(super) use operators;

/// Defines a type of numbers and that of their truth values. The module must define `Vector`, `Flags` and the functions called
/// below on them; it names its token, its target features, and the module of elementary functions of its precision.
macro_rules! registers {
    ($kind:ident, $mask:ident of $width:ident $number:ident: $token:ty, $features:tt, $elementary:ident) => {
        use crate::number::elementary::{cos, sin};
        use crate::number::macros::{add_assign, elementary_functions};
        use crate::number::real::{Logistic, Mask, Real};
        use core::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

        /// Numbers in registers.
        #[derive(Clone, Copy)]
        #[repr(transparent)]
        pub struct $kind(Vector);

        /// Truth values of such numbers.
        #[derive(Clone, Copy)]
        #[repr(transparent)]
        pub struct $mask(Flags);

        impl $kind {
            /// Numbers in registers that the machine has, as the token proves.
            #[inline(always)]
            pub fn new(_token: $token, numbers: &[f64]) -> Self {
                Self::of(core::array::from_fn(|lane| $number::constant(numbers[lane])))
            }
            /// The same, for code that was given this type with a token.
            #[inline(always)]
            pub(super) fn of(numbers: [$number; super::$width]) -> Self {
                // SAFETY: a vector is that many numbers in memory.
                Self(unsafe { core::mem::transmute::<[$number; super::$width], Vector>(numbers) })
            }
            #[inline(always)]
            pub(super) fn numbers(self) -> [$number; super::$width] {
                // SAFETY: a vector is that many numbers in memory.
                unsafe { core::mem::transmute::<Vector, [$number; super::$width]>(self.0) }
            }
        }
        impl core::fmt::Debug for $kind {
            fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                self.numbers().fmt(f)
            }
        }
        impl core::fmt::Debug for $mask {
            fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                core::array::from_fn::<bool, { super::$width }, _>(|lane| self.lane(lane)).fmt(f)
            }
        }
        super::registers::operators!($kind: Add add add, Sub sub sub, Mul mul mul, Div div div);
        impl Neg for $kind {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                // SAFETY: see the top of this file.
                Self(unsafe { negate(self.0) })
            }
        }
        add_assign!([] $kind);
        super::registers::operators!($mask: BitAnd bitand both, BitOr bitor either);
        impl Not for $mask {
            type Output = Self;
            #[inline(always)]
            fn not(self) -> Self {
                // SAFETY: see the top of this file.
                Self(unsafe { not(self.0) })
            }
        }
        impl Mask for $mask {
            #[inline(always)]
            fn splat(value: bool) -> Self {
                // SAFETY: see the top of this file.
                Self(unsafe { flags(value) })
            }
            #[inline(always)]
            fn any(self) -> bool {
                // SAFETY: see the top of this file.
                unsafe { packed(self.0) != 0 }
            }
            #[inline(always)]
            fn lane(self, lane: usize) -> bool {
                // SAFETY: see the top of this file.
                unsafe { packed(self.0) >> lane & 1 == 1 }
            }
        }
        impl Real for $kind {
            type Mask = $mask;
            type Equations = ();
            const LANES: usize = super::$width;
            const DERIVATIVES: bool = false;
            const IN_REGISTERS: bool = true;
            const SINGLE: bool = <$number as Real>::SINGLE;

            #[inline(always)]
            fn vectorised<R>(work: impl FnOnce() -> R) -> R {
                #[target_feature(enable = $features)]
                unsafe fn inside<R>(work: impl FnOnce() -> R) -> R {
                    work()
                }
                // SAFETY: see the top of this file.
                unsafe { inside(work) }
            }
            #[inline(always)]
            fn constant(value: f64) -> Self {
                // SAFETY: see the top of this file.
                Self(unsafe { splat($number::constant(value)) })
            }
            #[inline(always)]
            fn lane(self, lane: usize) -> f64 {
                self.numbers()[lane].lane(0)
            }
            #[inline(always)]
            fn of_lanes(number: impl Fn(usize) -> f64) -> Self {
                Self::of(core::array::from_fn(|lane| $number::constant(number(lane))))
            }
            #[inline(always)]
            fn look_up<const K: usize>(self, find: impl Fn(f64) -> [f64; K]) -> [Self; K] {
                let found = self.numbers().map(|number| find(number.lane(0)));
                core::array::from_fn(|k| Self::of(core::array::from_fn(|lane| $number::constant(found[lane][k]))))
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                // SAFETY: see the top of this file.
                Self(unsafe { sqrt(self.0) })
            }
            elementary_functions!(always $elementary: exp, ln, inverse_cbrt);
            #[inline(always)]
            fn logistic(self) -> Logistic<Self> {
                crate::number::elementary::$elementary::logistic(self)
            }
            #[inline(always)]
            fn min(self, other: Self) -> Self {
                // SAFETY: see the top of this file.
                Self(unsafe { smaller(other.0, self.0) })
            }
            #[inline(always)]
            fn max(self, other: Self) -> Self {
                // SAFETY: see the top of this file.
                Self(unsafe { larger(other.0, self.0) })
            }
            #[inline(always)]
            fn abs(self) -> Self {
                // SAFETY: see the top of this file.
                Self(unsafe { magnitude(self.0) })
            }
            #[inline(always)]
            fn sin(self) -> Self {
                Self::of(self.numbers().map(|angle| $number::constant(sin(angle.lane(0)))))
            }
            #[inline(always)]
            fn cos(self) -> Self {
                Self::of(self.numbers().map(|angle| $number::constant(cos(angle.lane(0)))))
            }
            #[inline(always)]
            fn lt(self, other: Self) -> $mask {
                // SAFETY: see the top of this file.
                $mask(unsafe { less(self.0, other.0) })
            }
            #[inline(always)]
            fn select(mask: $mask, yes: Self, no: Self) -> Self {
                // SAFETY: see the top of this file.
                Self(unsafe { choose(mask.0, yes.0, no.0) })
            }
        }
    };
}
pub(super) use registers;

/// Operations on the bits of numbers in double precision.
macro_rules! double_bits {
    ($kind:ident) => {
        use crate::number::elementary::Bits;
        use crate::number::elementary::double::{EXPONENT_BIAS, INVERSE_CBRT, SPLIT, THIRD, TWO_52};

        impl Bits for $kind {
            #[inline(always)]
            fn power_of_two(shifted: Self) -> Self {
                // SAFETY: see the top of this file.
                Self(unsafe { shift_left::<52>(plus(shifted.0, EXPONENT_BIAS)) })
            }
            #[inline(always)]
            fn split(self) -> (Self, Self) {
                // SAFETY: see the top of this file.
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
                // SAFETY: see the top of this file.
                unsafe {
                    let third = shift_right::<32>(times(shift_right::<32>(self.0), THIRD));
                    Self(shift_left::<32>(minus(bits(INVERSE_CBRT), third)))
                }
            }
        }
    };
}
pub(super) use double_bits;

/// Operations on the bits of numbers in single precision.
#[cfg(feature = "all-lanes")]
macro_rules! single_bits {
    ($kind:ident) => {
        use crate::number::elementary::Bits;
        use crate::number::elementary::single::{EXPONENT_BIAS, INVERSE_CBRT, SPLIT, TWO_23};

        impl Bits for $kind {
            #[inline(always)]
            fn power_of_two(shifted: Self) -> Self {
                // SAFETY: see the top of this file.
                Self(unsafe { shift_left::<23>(plus(shifted.0, EXPONENT_BIAS)) })
            }
            #[inline(always)]
            fn split(self) -> (Self, Self) {
                // SAFETY: see the top of this file.
                unsafe {
                    let exponent = shift_right::<23>(plus(self.0, SPLIT));
                    let m = minus(plus(self.0, EXPONENT_BIAS << 23), shift_left::<23>(exponent));
                    // The exponent lies below 2^23: its bits and those of 2^23 do not overlap.
                    let e = plus(exponent, TWO_23);
                    (Self(m), Self(e) - Self::constant(8_388_608.0 + f64::from(EXPONENT_BIAS)))
                }
            }
            #[inline(always)]
            fn inverse_cbrt_guess(self) -> Self {
                // SAFETY: see the top of this file.
                Self(unsafe { minus(bits(INVERSE_CBRT), third(self.0)) })
            }
        }
    };
}
#[cfg(feature = "all-lanes")]
pub(super) use single_bits;
