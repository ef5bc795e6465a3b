#pragma once

// Float8 for NEON (AArch64), as two vectors of four. renderlib/base/simd_plain.h defines the
// operations.

#include <arm_neon.h>

#include <cstdint>
#include <type_traits>

namespace bandsaw::simd_neon {

class Mask8 {
 public:
  /// In each lane all bits are 1 or all are 0. `low` holds lanes 0 to 3.
  Mask8(uint32x4_t low, uint32x4_t high) : low_(low), high_(high) {}
  /// Returns the mask as bits; bit i is lane i.
  unsigned bits() const {
    static constexpr std::uint32_t kLow[] = {1, 2, 4, 8};
    static constexpr std::uint32_t kHigh[] = {16, 32, 64, 128};
    return vaddvq_u32(
        vorrq_u32(vandq_u32(low_, vld1q_u32(kLow)), vandq_u32(high_, vld1q_u32(kHigh))));
  }
  friend Mask8 operator&(Mask8 a, Mask8 b) {
    return {vandq_u32(a.low_, b.low_), vandq_u32(a.high_, b.high_)};
  }
  friend Mask8 operator|(Mask8 a, Mask8 b) {
    return {vorrq_u32(a.low_, b.low_), vorrq_u32(a.high_, b.high_)};
  }

 private:
  uint32x4_t low_;
  uint32x4_t high_;
};

class Float8 {
 public:
  Float8() = default;
  explicit Float8(float all) : low_(vdupq_n_f32(all)), high_(low_) {}
  static Float8 load(const float* from) { return {vld1q_f32(from), vld1q_f32(from + 4)}; }
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
  void store(float* to) const {
    vst1q_f32(to, low_);
    vst1q_f32(to + 4, high_);
  }
  void store_truncated(std::int32_t* to) const {
    vst1q_s32(to, vcvtq_s32_f32(low_));
    vst1q_s32(to + 4, vcvtq_s32_f32(high_));
  }

  friend Float8 operator+(Float8 a, Float8 b) {
    return {vaddq_f32(a.low_, b.low_), vaddq_f32(a.high_, b.high_)};
  }
  friend Float8 operator-(Float8 a, Float8 b) {
    return {vsubq_f32(a.low_, b.low_), vsubq_f32(a.high_, b.high_)};
  }
  friend Float8 operator*(Float8 a, Float8 b) {
    return {vmulq_f32(a.low_, b.low_), vmulq_f32(a.high_, b.high_)};
  }
  friend Float8 operator/(Float8 a, Float8 b) {
    return {vdivq_f32(a.low_, b.low_), vdivq_f32(a.high_, b.high_)};
  }
  friend Float8 fused(Float8 a, Float8 b, Float8 c) {
    return {vfmaq_f32(c.low_, a.low_, b.low_), vfmaq_f32(c.high_, a.high_, b.high_)};
  }
  friend Float8 fused_minus(Float8 a, Float8 b, Float8 c) {
    return {vfmaq_f32(vnegq_f32(c.low_), a.low_, b.low_),
            vfmaq_f32(vnegq_f32(c.high_), a.high_, b.high_)};
  }
  friend Float8 about_fused(Float8 a, Float8 b, Float8 c) { return fused(a, b, c); }
  friend Float8 about_fused_minus(Float8 a, Float8 b, Float8 c) { return fused_minus(a, b, c); }
  /// min() and max() must return b if either operand is NaN, and if both are zeros (simd_plain.h).
  /// So vminq_f32 and vmaxq_f32 are not used: they return NaN if either operand is NaN, and they
  /// treat -0 as less than +0.
  friend Float8 min(Float8 a, Float8 b) {
    return {vbslq_f32(vcltq_f32(a.low_, b.low_), a.low_, b.low_),
            vbslq_f32(vcltq_f32(a.high_, b.high_), a.high_, b.high_)};
  }
  friend Float8 max(Float8 a, Float8 b) {
    return {vbslq_f32(vcgtq_f32(a.low_, b.low_), a.low_, b.low_),
            vbslq_f32(vcgtq_f32(a.high_, b.high_), a.high_, b.high_)};
  }
  friend Float8 swap_halves(Float8 a) { return {a.high_, a.low_}; }
  friend Float8 abs(Float8 a) { return {vabsq_f32(a.low_), vabsq_f32(a.high_)}; }
  friend Float8 flip_by_sign(Float8 a, Float8 sign) {
    return {flipped(a.low_, sign.low_), flipped(a.high_, sign.high_)};
  }
  friend Mask8 operator<(Float8 a, Float8 b) {
    return {vcltq_f32(a.low_, b.low_), vcltq_f32(a.high_, b.high_)};
  }
  friend Mask8 operator<=(Float8 a, Float8 b) {
    return {vcleq_f32(a.low_, b.low_), vcleq_f32(a.high_, b.high_)};
  }

 private:
  Float8(float32x4_t low, float32x4_t high) : low_(low), high_(high) {}
  template <class Object>
  static void check_bytes() {
    static_assert(sizeof(Object) == 2 * sizeof(float32x4_t) &&
                  std::is_trivially_copyable_v<Object>);
  }
  static float32x4_t flipped(float32x4_t a, float32x4_t sign) {
    const uint32x4_t change = vandq_u32(vreinterpretq_u32_f32(sign), vdupq_n_u32(0x80000000u));
    return vreinterpretq_f32_u32(veorq_u32(vreinterpretq_u32_f32(a), change));
  }
  float32x4_t low_;   ///< lanes 0 to 3
  float32x4_t high_;  ///< lanes 4 to 7
};

}  // namespace bandsaw::simd_neon
