//! NEON: eight numbers in four registers.

#[allow(clippy::wildcard_imports, reason = "intrinsics carry their own prefix")]
use core::arch::aarch64::*;

type Vector = [float64x2_t; 4];
type Flags = [uint64x2_t; 4];

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
        $(#[inline] #[target_feature(enable = "neon")]
        fn $name $(<const $shift: i32>)? ($($argument: $kind),*) -> $result $body)*
    };
}
operations! {
    fn add(a: Vector, b: Vector) -> Vector { each!(i => vaddq_f64(a[i], b[i])) }
    fn sub(a: Vector, b: Vector) -> Vector { each!(i => vsubq_f64(a[i], b[i])) }
    fn mul(a: Vector, b: Vector) -> Vector { each!(i => vmulq_f64(a[i], b[i])) }
    fn div(a: Vector, b: Vector) -> Vector { each!(i => vdivq_f64(a[i], b[i])) }
    fn sqrt(a: Vector) -> Vector { each!(i => vsqrtq_f64(a[i])) }
    // The second where the first is not the smaller, or larger, one: as a plain number selects. NEON's own minimum treats
    // signed zeros otherwise.
    fn smaller(a: Vector, b: Vector) -> Vector { each!(i => vbslq_f64(vcltq_f64(a[i], b[i]), a[i], b[i])) }
    fn larger(a: Vector, b: Vector) -> Vector { each!(i => vbslq_f64(vcgtq_f64(a[i], b[i]), a[i], b[i])) }
    fn magnitude(a: Vector) -> Vector { each!(i => vabsq_f64(a[i])) }
    fn splat(value: f64) -> Vector { [vdupq_n_f64(value); 4] }
    fn negate(a: Vector) -> Vector { each!(i => vnegq_f64(a[i])) }
    fn less(a: Vector, b: Vector) -> Flags { each!(i => vcltq_f64(a[i], b[i])) }
    fn choose(mask: Flags, yes: Vector, no: Vector) -> Vector { each!(i => vbslq_f64(mask[i], yes[i], no[i])) }
    fn flags(value: bool) -> Flags { [vdupq_n_u64(if value { u64::MAX } else { 0 }); 4] }
    fn both(a: Flags, b: Flags) -> Flags { each!(i => vandq_u64(a[i], b[i])) }
    fn either(a: Flags, b: Flags) -> Flags { each!(i => vorrq_u64(a[i], b[i])) }
    fn not(a: Flags) -> Flags {
        let all = flags(true);
        each!(i => veorq_u64(a[i], all[i]))
    }
    fn packed(a: Flags) -> u64 {
        let pair = |i: usize| vgetq_lane_u64::<0>(a[i]) & 1 | vgetq_lane_u64::<1>(a[i]) & 2;
        pair(0) | pair(1) << 2 | pair(2) << 4 | pair(3) << 6
    }
    fn whole(a: Vector) -> Flags { each!(i => vreinterpretq_u64_f64(a[i])) }
    fn number(a: Flags) -> Vector { each!(i => vreinterpretq_f64_u64(a[i])) }
    fn bits(value: u64) -> Vector { number([vdupq_n_u64(value); 4]) }
    fn plus(a: Vector, b: u64) -> Vector {
        let a = whole(a);
        number(each!(i => vaddq_u64(a[i], vdupq_n_u64(b))))
    }
    fn minus(a: Vector, b: Vector) -> Vector {
        let (a, b) = (whole(a), whole(b));
        number(each!(i => vsubq_u64(a[i], b[i])))
    }
    // Of the low halves, as on the other instruction sets; the factor fits into one.
    fn times(a: Vector, b: u64) -> Vector {
        let a = whole(a);
        number(each!(i => vmull_u32(vmovn_u64(a[i]), vdup_n_u32(b as u32))))
    }
    fn shift_left[BY](a: Vector) -> Vector {
        let a = whole(a);
        number(each!(i => vshlq_n_u64::<BY>(a[i])))
    }
    fn shift_right[BY](a: Vector) -> Vector {
        let a = whole(a);
        number(each!(i => vshrq_n_u64::<BY>(a[i])))
    }
}
super::registers::registers!(Eight, EightMask of WIDTH f64: super::token::Neon, "neon", double);
super::registers::double_bits!(Eight);
