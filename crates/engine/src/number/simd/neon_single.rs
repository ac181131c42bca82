//! NEON: sixteen numbers of single precision in four registers.

#[allow(clippy::wildcard_imports, reason = "intrinsics carry their own prefix")]
use core::arch::aarch64::*;

type Vector = [float32x4_t; 4];
type Flags = [uint32x4_t; 4];

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
    fn add(a: Vector, b: Vector) -> Vector { each!(i => vaddq_f32(a[i], b[i])) }
    fn sub(a: Vector, b: Vector) -> Vector { each!(i => vsubq_f32(a[i], b[i])) }
    fn mul(a: Vector, b: Vector) -> Vector { each!(i => vmulq_f32(a[i], b[i])) }
    fn div(a: Vector, b: Vector) -> Vector { each!(i => vdivq_f32(a[i], b[i])) }
    fn sqrt(a: Vector) -> Vector { each!(i => vsqrtq_f32(a[i])) }
    // The second where the first is not the smaller, or larger, one: as a plain number selects. NEON's own minimum treats
    // what is no number otherwise.
    fn smaller(a: Vector, b: Vector) -> Vector { each!(i => vbslq_f32(vcltq_f32(a[i], b[i]), a[i], b[i])) }
    fn larger(a: Vector, b: Vector) -> Vector { each!(i => vbslq_f32(vcgtq_f32(a[i], b[i]), a[i], b[i])) }
    fn magnitude(a: Vector) -> Vector { each!(i => vabsq_f32(a[i])) }
    fn splat(value: f32) -> Vector { [vdupq_n_f32(value); 4] }
    fn negate(a: Vector) -> Vector { each!(i => vnegq_f32(a[i])) }
    fn less(a: Vector, b: Vector) -> Flags { each!(i => vcltq_f32(a[i], b[i])) }
    fn choose(mask: Flags, yes: Vector, no: Vector) -> Vector { each!(i => vbslq_f32(mask[i], yes[i], no[i])) }
    fn flags(value: bool) -> Flags { [vdupq_n_u32(if value { u32::MAX } else { 0 }); 4] }
    fn both(a: Flags, b: Flags) -> Flags { each!(i => vandq_u32(a[i], b[i])) }
    fn either(a: Flags, b: Flags) -> Flags { each!(i => vorrq_u32(a[i], b[i])) }
    fn not(a: Flags) -> Flags { each!(i => vmvnq_u32(a[i])) }
    fn packed(a: Flags) -> u32 {
        let four = |i: usize| {
            vgetq_lane_u32::<0>(a[i]) & 1
                | vgetq_lane_u32::<1>(a[i]) & 2
                | vgetq_lane_u32::<2>(a[i]) & 4
                | vgetq_lane_u32::<3>(a[i]) & 8
        };
        four(0) | four(1) << 4 | four(2) << 8 | four(3) << 12
    }
    fn whole(a: Vector) -> Flags { each!(i => vreinterpretq_u32_f32(a[i])) }
    fn number(a: Flags) -> Vector { each!(i => vreinterpretq_f32_u32(a[i])) }
    fn bits(value: u32) -> Vector { number([vdupq_n_u32(value); 4]) }
    fn plus(a: Vector, b: u32) -> Vector {
        let a = whole(a);
        number(each!(i => vaddq_u32(a[i], vdupq_n_u32(b))))
    }
    fn minus(a: Vector, b: Vector) -> Vector {
        let (a, b) = (whole(a), whole(b));
        number(each!(i => vsubq_u32(a[i], b[i])))
    }
    fn third(a: Vector) -> Vector {
        let a = whole(a);
        number(each!(i => vcvtq_u32_f32(vmulq_f32(vcvtq_f32_u32(a[i]), vdupq_n_f32(1.0 / 3.0)))))
    }
    fn shift_left[BY](a: Vector) -> Vector {
        let a = whole(a);
        number(each!(i => vshlq_n_u32::<BY>(a[i])))
    }
    fn shift_right[BY](a: Vector) -> Vector {
        let a = whole(a);
        number(each!(i => vshrq_n_u32::<BY>(a[i])))
    }
}
super::registers::registers!(Sixteen, SixteenMask of SINGLE_WIDTH f32: super::token::Neon, "neon", single);
super::registers::single_bits!(Sixteen);
