//! Eight numbers in vector registers: the parts that are the same for all instruction sets.
//!
//! SAFETY of every call below: the operations may run only where the machine has their instructions. The type `Eight` of a
//! module is private to [`simd`](super). Other code gets it as a type parameter only, from [`super::run`] and
//! [`super::in_chunks`]. Both need the token that only detection makes ([`super::token`]). So code that has the type, and
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

/// Defines `Eight` and `EightMask`. The module must define `Vector`, `Flags` and the functions called below on them, and
/// names its token and its target features.
macro_rules! eight {
    ($token:ty, $features:tt) => {
        use super::WIDTH;
        use crate::number::elementary::{
            Bits, EXPONENT_BIAS, INVERSE_CBRT, SPLIT, THIRD, TWO_52, cos, logistic, sin,
        };
        use crate::number::macros::{add_assign, elementary_functions};
        use crate::number::real::{Logistic, Mask, Real};
        use core::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

        /// Eight numbers.
        #[derive(Clone, Copy)]
        #[repr(transparent)]
        pub struct Eight(Vector);

        /// Truth values of eight numbers.
        #[derive(Clone, Copy)]
        #[repr(transparent)]
        pub struct EightMask(Flags);

        impl Eight {
            /// Numbers in registers that the machine has, as the token proves.
            #[inline(always)]
            pub fn new(_token: $token, numbers: [f64; WIDTH]) -> Self {
                Self::of(numbers)
            }
            /// The same, for code that was given this type with a token.
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
        super::eight::operators!(Eight: Add add add, Sub sub sub, Mul mul mul, Div div div);
        impl Neg for Eight {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                // SAFETY: see the top of this file.
                Self(unsafe { negate(self.0) })
            }
        }
        add_assign!([] Eight);
        super::eight::operators!(EightMask: BitAnd bitand both, BitOr bitor either);
        impl Not for EightMask {
            type Output = Self;
            #[inline(always)]
            fn not(self) -> Self {
                // SAFETY: see the top of this file.
                Self(unsafe { not(self.0) })
            }
        }
        impl Mask for EightMask {
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
        impl Real for Eight {
            type Mask = EightMask;
            type Equations = ();
            const LANES: usize = WIDTH;
            const DERIVATIVES: bool = false;
            const IN_REGISTERS: bool = true;

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
                Self(unsafe { splat(value) })
            }
            #[inline(always)]
            fn lane(self, lane: usize) -> f64 {
                self.numbers()[lane]
            }
            #[inline(always)]
            fn look_up<const K: usize>(self, find: impl Fn(f64) -> [f64; K]) -> [Self; K] {
                let found = self.numbers().map(find);
                core::array::from_fn(|k| Self::of(core::array::from_fn(|lane| found[lane][k])))
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                // SAFETY: see the top of this file.
                Self(unsafe { sqrt(self.0) })
            }
            elementary_functions!(always: exp, ln, inverse_cbrt);
            #[inline(always)]
            fn logistic(self) -> Logistic<Self> {
                logistic(self)
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
                Self::of(self.numbers().map(sin))
            }
            #[inline(always)]
            fn cos(self) -> Self {
                Self::of(self.numbers().map(cos))
            }
            #[inline(always)]
            fn lt(self, other: Self) -> EightMask {
                // SAFETY: see the top of this file.
                EightMask(unsafe { less(self.0, other.0) })
            }
            #[inline(always)]
            fn select(mask: EightMask, yes: Self, no: Self) -> Self {
                // SAFETY: see the top of this file.
                Self(unsafe { choose(mask.0, yes.0, no.0) })
            }
        }
        impl Bits for Eight {
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
pub(super) use eight;
