//! AVX-512: sixteen numbers of single precision in one register.

#[allow(clippy::wildcard_imports, reason = "intrinsics carry their own prefix")]
use core::arch::x86_64::*;

type Vector = __m512;
type Flags = __mmask16;

macro_rules! operations {
    ($($(#[$meta:meta])* fn $name:ident $([$shift:ident])? ($($argument:ident: $kind:ty),*) -> $result:ty $body:block)*) => {
        $($(#[$meta])* #[inline] #[target_feature(enable = "avx512f")]
        fn $name $(<const $shift: u32>)? ($($argument: $kind),*) -> $result $body)*
    };
}
operations! {
    fn add(a: Vector, b: Vector) -> Vector { _mm512_add_ps(a, b) }
    fn sub(a: Vector, b: Vector) -> Vector { _mm512_sub_ps(a, b) }
    fn mul(a: Vector, b: Vector) -> Vector { _mm512_mul_ps(a, b) }
    fn div(a: Vector, b: Vector) -> Vector { _mm512_div_ps(a, b) }
    fn sqrt(a: Vector) -> Vector { _mm512_sqrt_ps(a) }
    // The second where the first is not the smaller, or larger, one: as a plain number selects.
    fn smaller(a: Vector, b: Vector) -> Vector { _mm512_min_ps(a, b) }
    fn larger(a: Vector, b: Vector) -> Vector { _mm512_max_ps(a, b) }
    fn magnitude(a: Vector) -> Vector { _mm512_abs_ps(a) }
    fn splat(value: f32) -> Vector { _mm512_set1_ps(value) }
    fn negate(a: Vector) -> Vector {
        let sign = _mm512_set1_epi32(i32::MIN);
        _mm512_castsi512_ps(_mm512_xor_si512(_mm512_castps_si512(a), sign))
    }
    fn less(a: Vector, b: Vector) -> Flags { _mm512_cmp_ps_mask::<_CMP_LT_OQ>(a, b) }
    fn choose(mask: Flags, yes: Vector, no: Vector) -> Vector { _mm512_mask_blend_ps(mask, no, yes) }
    fn flags(value: bool) -> Flags { if value { 0xFFFF } else { 0 } }
    fn both(a: Flags, b: Flags) -> Flags { a & b }
    fn either(a: Flags, b: Flags) -> Flags { a | b }
    fn not(a: Flags) -> Flags { !a }
    fn packed(a: Flags) -> u16 { a }
    fn bits(value: u32) -> Vector { _mm512_castsi512_ps(_mm512_set1_epi32(value.cast_signed())) }
    fn plus(a: Vector, b: u32) -> Vector {
        _mm512_castsi512_ps(_mm512_add_epi32(_mm512_castps_si512(a), _mm512_castps_si512(bits(b))))
    }
    fn minus(a: Vector, b: Vector) -> Vector {
        _mm512_castsi512_ps(_mm512_sub_epi32(_mm512_castps_si512(a), _mm512_castps_si512(b)))
    }
    fn third(a: Vector) -> Vector {
        let third = _mm512_mul_ps(_mm512_cvtepi32_ps(_mm512_castps_si512(a)), splat(1.0 / 3.0));
        _mm512_castsi512_ps(_mm512_cvttps_epi32(third))
    }
    fn shift_left[BY](a: Vector) -> Vector {
        _mm512_castsi512_ps(_mm512_slli_epi32::<BY>(_mm512_castps_si512(a)))
    }
    fn shift_right[BY](a: Vector) -> Vector {
        _mm512_castsi512_ps(_mm512_srli_epi32::<BY>(_mm512_castps_si512(a)))
    }
}
super::registers::registers!(Sixteen, SixteenMask of SINGLE_WIDTH f32: super::token::Avx512, "avx512f", single);
super::registers::single_bits!(Sixteen);
