//! SIMD of WebAssembly: eight numbers in four registers.

#![allow(
    unused_unsafe,
    reason = "safe to call in a module that is compiled with them; `registers` is written for all instruction sets"
)]

#[allow(clippy::wildcard_imports, reason = "intrinsics carry their own prefix")]
use core::arch::wasm32::*;

type Vector = [v128; 4];
type Flags = [v128; 4];

/// An operation on each of four registers.
macro_rules! each {
    ($i:ident => $operation:expr) => {
        [0, 1, 2, 3].map(
            #[inline(always)]
            |$i: usize| $operation,
        )
    };
}
macro_rules! operations {
    ($(fn $name:ident $([$shift:ident])? ($($argument:ident: $kind:ty),*) -> $result:ty $body:block)*) => {
        $(#[inline] #[target_feature(enable = "simd128")]
        fn $name $(<const $shift: u32>)? ($($argument: $kind),*) -> $result $body)*
    };
}
operations! {
    fn add(a: Vector, b: Vector) -> Vector { each!(i => f64x2_add(a[i], b[i])) }
    fn sub(a: Vector, b: Vector) -> Vector { each!(i => f64x2_sub(a[i], b[i])) }
    fn mul(a: Vector, b: Vector) -> Vector { each!(i => f64x2_mul(a[i], b[i])) }
    fn div(a: Vector, b: Vector) -> Vector { each!(i => f64x2_div(a[i], b[i])) }
    fn sqrt(a: Vector) -> Vector { each!(i => f64x2_sqrt(a[i])) }
    // pmin(x, y) is y where it is smaller than x, else x: with both turned round, the second where the first is not the smaller one, as
    // a plain number selects.
    fn smaller(a: Vector, b: Vector) -> Vector { each!(i => f64x2_pmin(b[i], a[i])) }
    fn larger(a: Vector, b: Vector) -> Vector { each!(i => f64x2_pmax(b[i], a[i])) }
    fn magnitude(a: Vector) -> Vector { each!(i => f64x2_abs(a[i])) }
    fn splat(value: f64) -> Vector { [f64x2_splat(value); 4] }
    fn negate(a: Vector) -> Vector { each!(i => f64x2_neg(a[i])) }
    fn less(a: Vector, b: Vector) -> Flags { each!(i => f64x2_lt(a[i], b[i])) }
    fn choose(mask: Flags, yes: Vector, no: Vector) -> Vector { each!(i => v128_bitselect(yes[i], no[i], mask[i])) }
    fn flags(value: bool) -> Flags { [i64x2_splat(if value { -1 } else { 0 }); 4] }
    fn both(a: Flags, b: Flags) -> Flags { each!(i => v128_and(a[i], b[i])) }
    fn either(a: Flags, b: Flags) -> Flags { each!(i => v128_or(a[i], b[i])) }
    fn not(a: Flags) -> Flags { each!(i => v128_not(a[i])) }
    fn packed(a: Flags) -> u64 {
        let pair = |i: usize| u64::from(i64x2_bitmask(a[i]));
        pair(0) | pair(1) << 2 | pair(2) << 4 | pair(3) << 6
    }
    fn bits(value: u64) -> Vector { [u64x2_splat(value); 4] }
    fn plus(a: Vector, b: u64) -> Vector { each!(i => i64x2_add(a[i], u64x2_splat(b))) }
    fn minus(a: Vector, b: Vector) -> Vector { each!(i => i64x2_sub(a[i], b[i])) }
    fn times(a: Vector, b: u64) -> Vector { each!(i => i64x2_mul(a[i], u64x2_splat(b))) }
    fn shift_left[BY](a: Vector) -> Vector { each!(i => i64x2_shl(a[i], BY)) }
    fn shift_right[BY](a: Vector) -> Vector { each!(i => u64x2_shr(a[i], BY)) }
}
super::registers::registers!(Eight, EightMask of WIDTH f64: super::token::Simd128, "simd128", double);
super::registers::double_bits!(Eight);
