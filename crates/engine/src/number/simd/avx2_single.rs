//! AVX2: sixteen numbers of single precision in two registers.

#[allow(clippy::wildcard_imports, reason = "intrinsics carry their own prefix")]
use core::arch::x86_64::*;

type Vector = [__m256; 2];
type Flags = [__m256; 2];

macro_rules! operations {
    ($(fn $name:ident $([$shift:ident])? ($($argument:ident: $kind:ty),*) -> $result:ty $body:block)*) => {
        $(#[inline] #[target_feature(enable = "avx2")]
        fn $name $(<const $shift: i32>)? ($($argument: $kind),*) -> $result $body)*
    };
}
operations! {
    fn add(a: Vector, b: Vector) -> Vector { [_mm256_add_ps(a[0], b[0]), _mm256_add_ps(a[1], b[1])] }
    fn sub(a: Vector, b: Vector) -> Vector { [_mm256_sub_ps(a[0], b[0]), _mm256_sub_ps(a[1], b[1])] }
    fn mul(a: Vector, b: Vector) -> Vector { [_mm256_mul_ps(a[0], b[0]), _mm256_mul_ps(a[1], b[1])] }
    fn div(a: Vector, b: Vector) -> Vector { [_mm256_div_ps(a[0], b[0]), _mm256_div_ps(a[1], b[1])] }
    fn sqrt(a: Vector) -> Vector { [_mm256_sqrt_ps(a[0]), _mm256_sqrt_ps(a[1])] }
    fn smaller(a: Vector, b: Vector) -> Vector { [_mm256_min_ps(a[0], b[0]), _mm256_min_ps(a[1], b[1])] }
    fn larger(a: Vector, b: Vector) -> Vector { [_mm256_max_ps(a[0], b[0]), _mm256_max_ps(a[1], b[1])] }
    fn magnitude(a: Vector) -> Vector {
        let sign = _mm256_set1_ps(-0.0);
        [_mm256_andnot_ps(sign, a[0]), _mm256_andnot_ps(sign, a[1])]
    }
    fn splat(value: f32) -> Vector { [_mm256_set1_ps(value); 2] }
    fn negate(a: Vector) -> Vector {
        let sign = _mm256_set1_ps(-0.0);
        [_mm256_xor_ps(a[0], sign), _mm256_xor_ps(a[1], sign)]
    }
    fn less(a: Vector, b: Vector) -> Flags {
        [_mm256_cmp_ps::<_CMP_LT_OQ>(a[0], b[0]), _mm256_cmp_ps::<_CMP_LT_OQ>(a[1], b[1])]
    }
    fn choose(mask: Flags, yes: Vector, no: Vector) -> Vector {
        [_mm256_blendv_ps(no[0], yes[0], mask[0]), _mm256_blendv_ps(no[1], yes[1], mask[1])]
    }
    fn flags(value: bool) -> Flags { bits(if value { u32::MAX } else { 0 }) }
    fn both(a: Flags, b: Flags) -> Flags { [_mm256_and_ps(a[0], b[0]), _mm256_and_ps(a[1], b[1])] }
    fn either(a: Flags, b: Flags) -> Flags { [_mm256_or_ps(a[0], b[0]), _mm256_or_ps(a[1], b[1])] }
    fn not(a: Flags) -> Flags {
        let all = flags(true);
        [_mm256_xor_ps(a[0], all[0]), _mm256_xor_ps(a[1], all[1])]
    }
    fn packed(a: Flags) -> i32 { _mm256_movemask_ps(a[0]) | _mm256_movemask_ps(a[1]) << 8 }
    fn bits(value: u32) -> Vector { [_mm256_castsi256_ps(_mm256_set1_epi32(value.cast_signed())); 2] }
    fn plus(a: Vector, b: u32) -> Vector {
        let b = bits(b);
        [0, 1].map(|i| {
            _mm256_castsi256_ps(_mm256_add_epi32(_mm256_castps_si256(a[i]), _mm256_castps_si256(b[i])))
        })
    }
    fn minus(a: Vector, b: Vector) -> Vector {
        [0, 1].map(|i| {
            _mm256_castsi256_ps(_mm256_sub_epi32(_mm256_castps_si256(a[i]), _mm256_castps_si256(b[i])))
        })
    }
    fn third(a: Vector) -> Vector {
        let third = _mm256_set1_ps(1.0 / 3.0);
        [0, 1].map(|i| {
            let third = _mm256_mul_ps(_mm256_cvtepi32_ps(_mm256_castps_si256(a[i])), third);
            _mm256_castsi256_ps(_mm256_cvttps_epi32(third))
        })
    }
    fn shift_left[BY](a: Vector) -> Vector {
        [0, 1].map(|i| _mm256_castsi256_ps(_mm256_slli_epi32::<BY>(_mm256_castps_si256(a[i]))))
    }
    fn shift_right[BY](a: Vector) -> Vector {
        [0, 1].map(|i| _mm256_castsi256_ps(_mm256_srli_epi32::<BY>(_mm256_castps_si256(a[i]))))
    }
}
super::registers::registers!(Sixteen, SixteenMask of SINGLE_WIDTH f32: super::token::Avx2, "avx2", single);
super::registers::single_bits!(Sixteen);
