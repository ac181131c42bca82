//! AVX2: eight numbers in two registers.

#[allow(clippy::wildcard_imports, reason = "intrinsics carry their own prefix")]
use core::arch::x86_64::*;

type Vector = [__m256d; 2];
type Flags = [__m256d; 2];

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
super::registers::registers!(Eight, EightMask of WIDTH f64: super::token::Avx2, "avx2", double);
super::registers::double_bits!(Eight);
