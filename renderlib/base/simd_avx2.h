#pragma once

// Float8 for AVX2 with FMA. renderlib/base/simd_plain.h defines the operations.

#include <immintrin.h>

#include <cstdint>
#include <type_traits>

namespace bandsaw::simd_avx2 {

class Mask8 {
 public:
  explicit Mask8(__m256 v) : v_(v) {}
  unsigned bits() const { return static_cast<unsigned>(_mm256_movemask_ps(v_)); }
  friend Mask8 operator&(Mask8 a, Mask8 b) { return Mask8(_mm256_and_ps(a.v_, b.v_)); }
  friend Mask8 operator|(Mask8 a, Mask8 b) { return Mask8(_mm256_or_ps(a.v_, b.v_)); }

 private:
  __m256 v_;
};

class Float8 {
 public:
  Float8() = default;
  explicit Float8(float all) : v_(_mm256_set1_ps(all)) {}
  explicit Float8(__m256 v) : v_(v) {}
  static Float8 load(const float* from) { return Float8(_mm256_loadu_ps(from)); }
  template <class Object>
  static Float8 from_bytes(const Object& object) {
    check_bytes<Object>();
    return load(reinterpret_cast<const float*>(&object));
  }
  template <class Object>
  void to_bytes(Object& object) const {
    check_bytes<Object>();
    store(reinterpret_cast<float*>(&object));
  }
  void store(float* to) const { _mm256_storeu_ps(to, v_); }
  void store_truncated(std::int32_t* to) const {
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), _mm256_cvttps_epi32(v_));
  }

  friend Float8 operator+(Float8 a, Float8 b) { return Float8(_mm256_add_ps(a.v_, b.v_)); }
  friend Float8 operator-(Float8 a, Float8 b) { return Float8(_mm256_sub_ps(a.v_, b.v_)); }
  friend Float8 operator*(Float8 a, Float8 b) { return Float8(_mm256_mul_ps(a.v_, b.v_)); }
  friend Float8 operator/(Float8 a, Float8 b) { return Float8(_mm256_div_ps(a.v_, b.v_)); }
  friend Float8 fused(Float8 a, Float8 b, Float8 c) {
    return Float8(_mm256_fmadd_ps(a.v_, b.v_, c.v_));
  }
  friend Float8 fused_minus(Float8 a, Float8 b, Float8 c) {
    return Float8(_mm256_fmsub_ps(a.v_, b.v_, c.v_));
  }
  friend Float8 about_fused(Float8 a, Float8 b, Float8 c) { return fused(a, b, c); }
  friend Float8 about_fused_minus(Float8 a, Float8 b, Float8 c) { return fused_minus(a, b, c); }
  friend Float8 min(Float8 a, Float8 b) { return Float8(_mm256_min_ps(a.v_, b.v_)); }
  friend Float8 max(Float8 a, Float8 b) { return Float8(_mm256_max_ps(a.v_, b.v_)); }
  friend Float8 swap_halves(Float8 a) { return Float8(_mm256_permute2f128_ps(a.v_, a.v_, 1)); }
  friend Float8 abs(Float8 a) { return Float8(_mm256_andnot_ps(_mm256_set1_ps(-0.0f), a.v_)); }
  friend Float8 flip_by_sign(Float8 a, Float8 sign) {
    return Float8(_mm256_xor_ps(a.v_, _mm256_and_ps(_mm256_set1_ps(-0.0f), sign.v_)));
  }
  friend Mask8 operator<(Float8 a, Float8 b) {
    return Mask8(_mm256_cmp_ps(a.v_, b.v_, _CMP_LT_OQ));
  }
  friend Mask8 operator<=(Float8 a, Float8 b) {
    return Mask8(_mm256_cmp_ps(a.v_, b.v_, _CMP_LE_OQ));
  }

 private:
  template <class Object>
  static void check_bytes() {
    static_assert(sizeof(Object) == sizeof(__m256) && std::is_trivially_copyable_v<Object>);
  }
  __m256 v_;
};

}  // namespace bandsaw::simd_avx2
