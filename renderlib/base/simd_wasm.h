#pragma once

// Float8 for WebAssembly's SIMD, as two vectors of four. renderlib/base/simd_plain.h defines the
// operations. Relaxed SIMD is not used: its results differ between machines.

#include <wasm_simd128.h>

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "renderlib/base/simd_plain.h"

namespace bandsaw::simd_wasm {

class Mask8 {
 public:
  /// In each lane all bits are 1 or all are 0. `low` holds lanes 0 to 3.
  Mask8(v128_t low, v128_t high) : low_(low), high_(high) {}
  /// Returns the mask as bits; bit i is lane i.
  unsigned bits() const { return wasm_i32x4_bitmask(low_) | wasm_i32x4_bitmask(high_) << 4; }
  friend Mask8 operator&(Mask8 a, Mask8 b) {
    return {wasm_v128_and(a.low_, b.low_), wasm_v128_and(a.high_, b.high_)};
  }
  friend Mask8 operator|(Mask8 a, Mask8 b) {
    return {wasm_v128_or(a.low_, b.low_), wasm_v128_or(a.high_, b.high_)};
  }

 private:
  v128_t low_;
  v128_t high_;
};

class Float8 {
 public:
  Float8() = default;
  explicit Float8(float all) : low_(wasm_f32x4_splat(all)), high_(low_) {}
  static Float8 load(const float* from) { return {wasm_v128_load(from), wasm_v128_load(from + 4)}; }
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
    wasm_v128_store(to, low_);
    wasm_v128_store(to + 4, high_);
  }
  void store_truncated(std::int32_t* to) const {
    wasm_v128_store(to, wasm_i32x4_trunc_sat_f32x4(low_));
    wasm_v128_store(to + 4, wasm_i32x4_trunc_sat_f32x4(high_));
  }

  friend Float8 operator+(Float8 a, Float8 b) {
    return {wasm_f32x4_add(a.low_, b.low_), wasm_f32x4_add(a.high_, b.high_)};
  }
  friend Float8 operator-(Float8 a, Float8 b) {
    return {wasm_f32x4_sub(a.low_, b.low_), wasm_f32x4_sub(a.high_, b.high_)};
  }
  friend Float8 operator*(Float8 a, Float8 b) {
    return {wasm_f32x4_mul(a.low_, b.low_), wasm_f32x4_mul(a.high_, b.high_)};
  }
  friend Float8 operator/(Float8 a, Float8 b) {
    return {wasm_f32x4_div(a.low_, b.low_), wasm_f32x4_div(a.high_, b.high_)};
  }
  /// There is no instruction that rounds a b + c once, so this function is slow. Only the corners
  /// of meshes that deform need the exact bits.
  friend Float8 fused(Float8 a, Float8 b, Float8 c) {
    float p[simd_plain::kLanes];
    float q[simd_plain::kLanes];
    float r[simd_plain::kLanes];
    a.store(p);
    b.store(q);
    c.store(r);
    for (std::size_t i = 0; i < simd_plain::kLanes; ++i) {
      r[i] = simd_plain::fused(p[i], q[i], r[i]);
    }
    return load(r);
  }
  friend Float8 fused_minus(Float8 a, Float8 b, Float8 c) {
    return fused(a, b, Float8{wasm_f32x4_neg(c.low_), wasm_f32x4_neg(c.high_)});
  }
  friend Float8 about_fused(Float8 a, Float8 b, Float8 c) { return a * b + c; }
  friend Float8 about_fused_minus(Float8 a, Float8 b, Float8 c) { return a * b - c; }
  /// pmin and pmax return their first operand in lanes where either operand is NaN. min() and max()
  /// must return b there (simd_plain.h), so b is passed first.
  friend Float8 min(Float8 a, Float8 b) {
    return {wasm_f32x4_pmin(b.low_, a.low_), wasm_f32x4_pmin(b.high_, a.high_)};
  }
  friend Float8 max(Float8 a, Float8 b) {
    return {wasm_f32x4_pmax(b.low_, a.low_), wasm_f32x4_pmax(b.high_, a.high_)};
  }
  friend Float8 swap_halves(Float8 a) { return {a.high_, a.low_}; }
  friend Float8 abs(Float8 a) { return {wasm_f32x4_abs(a.low_), wasm_f32x4_abs(a.high_)}; }
  friend Float8 flip_by_sign(Float8 a, Float8 sign) {
    return {flipped(a.low_, sign.low_), flipped(a.high_, sign.high_)};
  }
  friend Mask8 operator<(Float8 a, Float8 b) {
    return {wasm_f32x4_lt(a.low_, b.low_), wasm_f32x4_lt(a.high_, b.high_)};
  }
  friend Mask8 operator<=(Float8 a, Float8 b) {
    return {wasm_f32x4_le(a.low_, b.low_), wasm_f32x4_le(a.high_, b.high_)};
  }

 private:
  Float8(v128_t low, v128_t high) : low_(low), high_(high) {}
  template <class Object>
  static void check_bytes() {
    static_assert(sizeof(Object) == 2 * sizeof(v128_t) && std::is_trivially_copyable_v<Object>);
  }
  static v128_t flipped(v128_t a, v128_t sign) {
    return wasm_v128_xor(a, wasm_v128_and(sign, wasm_f32x4_const_splat(-0.0f)));
  }
  v128_t low_;   ///< lanes 0 to 3
  v128_t high_;  ///< lanes 4 to 7
};

}  // namespace bandsaw::simd_wasm
