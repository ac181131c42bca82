//! AVX-512: eight numbers in one register.

#[allow(clippy::wildcard_imports, reason = "intrinsics carry their own prefix")]
use core::arch::x86_64::*;

type Vector = __m512d;
type Flags = __mmask8;

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
super::registers::registers!(Eight, EightMask of WIDTH f64: super::token::Avx512, "avx512f", double);
super::registers::double_bits!(Eight);
