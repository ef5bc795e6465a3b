#pragma once

// Float8, a vector of eight floats, in plain C++. This file defines the operations. The versions
// for other instruction sets compute the same bits (tests/unit/base/simd_test.cpp), except
// about_fused() and about_fused_minus(). renderlib/base/simd.h selects one.

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace bandsaw::simd_plain {

inline constexpr std::size_t kLanes = 8;

/// Returns a b + c, rounded once, without a fused instruction. The product of two floats is exact
/// in double; the sum is rounded to odd in double, which makes the rounding to float right (Boldo,
/// Melquiond 2008, "Emulation of FMA and correctly rounded sums: proved algorithms using rounding
/// to odd").
inline float fused(float a, float b, float c) {
  const double product = double{a} * double{b};
  const double sum = product + double{c};
  const double part = sum - product;
  const double error = (product - (sum - part)) + (double{c} - part);
  auto bits = std::bit_cast<std::uint64_t>(sum);
  if (error != 0 && std::isfinite(sum) && (bits & 1) == 0) {
    // Rounds towards the exact sum: away from zero if the error has the sign of the sum.
    bits += (error > 0) == (sum > 0) ? std::uint64_t{1} : ~std::uint64_t{0};
  }
  return static_cast<float>(std::bit_cast<double>(bits));
}

/// The result of a comparison: true or false for each of the eight lanes.
class Mask8 {
 public:
  explicit Mask8(unsigned bits) : bits_(bits) {}
  /// Returns the mask as bits; bit i is lane i.
  unsigned bits() const { return bits_; }
  friend Mask8 operator&(Mask8 a, Mask8 b) { return Mask8(a.bits_ & b.bits_); }
  friend Mask8 operator|(Mask8 a, Mask8 b) { return Mask8(a.bits_ | b.bits_); }

 private:
  unsigned bits_;
};

class Float8 {
 public:
  Float8() = default;
  explicit Float8(float all) { v_.fill(all); }
  /// Loads eight floats from any address.
  static Float8 load(const float* from) {
    return lanes([from](std::size_t i) { return from[i]; });
  }
  /// Loads the 32 bytes of an object.
  template <class Object>
  static Float8 from_bytes(const Object& object) {
    return Float8(std::bit_cast<std::array<float, kLanes>>(object));
  }
  /// The inverse of from_bytes().
  template <class Object>
  void to_bytes(Object& object) const {
    object = std::bit_cast<Object>(v_);
  }
  void store(float* to) const { std::copy(v_.begin(), v_.end(), to); }
  /// Converts to int32, rounded towards zero. The result is unspecified for NaN, and for numbers
  /// whose absolute value is 2^31 or more.
  void store_truncated(std::int32_t* to) const {
    for (std::size_t i = 0; i < kLanes; ++i) {
      to[i] = std::abs(v_[i]) < 0x1p31f ? static_cast<std::int32_t>(v_[i]) : 0;
    }
  }

  friend Float8 operator+(const Float8& a, const Float8& b) {
    return lanes([&](std::size_t i) { return a.v_[i] + b.v_[i]; });
  }
  friend Float8 operator-(const Float8& a, const Float8& b) {
    return lanes([&](std::size_t i) { return a.v_[i] - b.v_[i]; });
  }
  friend Float8 operator*(const Float8& a, const Float8& b) {
    return lanes([&](std::size_t i) { return a.v_[i] * b.v_[i]; });
  }
  friend Float8 operator/(const Float8& a, const Float8& b) {
    return lanes([&](std::size_t i) { return a.v_[i] / b.v_[i]; });
  }
  /// fused() returns a b + c and fused_minus() a b - c, both rounded once.
  friend Float8 fused(const Float8& a, const Float8& b, const Float8& c) {
    return lanes([&](std::size_t i) { return simd_plain::fused(a.v_[i], b.v_[i], c.v_[i]); });
  }
  friend Float8 fused_minus(const Float8& a, const Float8& b, const Float8& c) {
    return lanes([&](std::size_t i) { return simd_plain::fused(a.v_[i], b.v_[i], -c.v_[i]); });
  }
  /// about_fused() returns a b + c and about_fused_minus() a b - c, rounded once or twice,
  /// whichever is faster. Use them only where the rounding changes no bit of a result.
  friend Float8 about_fused(const Float8& a, const Float8& b, const Float8& c) {
    return fused(a, b, c);
  }
  friend Float8 about_fused_minus(const Float8& a, const Float8& b, const Float8& c) {
    return fused_minus(a, b, c);
  }
  /// min() and max() return b in lanes where a or b is NaN, and in lanes where both are zeros.
  friend Float8 min(const Float8& a, const Float8& b) {
    return lanes([&](std::size_t i) { return a.v_[i] < b.v_[i] ? a.v_[i] : b.v_[i]; });
  }
  friend Float8 max(const Float8& a, const Float8& b) {
    return lanes([&](std::size_t i) { return a.v_[i] > b.v_[i] ? a.v_[i] : b.v_[i]; });
  }
  /// Returns lanes 4 to 7, then 0 to 3.
  friend Float8 swap_halves(const Float8& a) {
    return lanes([&](std::size_t i) { return a.v_[(i + kLanes / 2) % kLanes]; });
  }
  friend Float8 abs(const Float8& a) {
    return lanes([&](std::size_t i) { return std::abs(a.v_[i]); });
  }
  /// Returns -a in the lanes in which `sign` has its sign bit set, otherwise a.
  friend Float8 flip_by_sign(const Float8& a, const Float8& sign) {
    return lanes([&](std::size_t i) { return std::signbit(sign.v_[i]) ? -a.v_[i] : a.v_[i]; });
  }
  /// Comparisons are false in lanes where either operand is NaN.
  friend Mask8 operator<(const Float8& a, const Float8& b) {
    return mask([&](std::size_t i) { return a.v_[i] < b.v_[i]; });
  }
  friend Mask8 operator<=(const Float8& a, const Float8& b) {
    return mask([&](std::size_t i) { return a.v_[i] <= b.v_[i]; });
  }

 private:
  explicit Float8(const std::array<float, kLanes>& v) : v_(v) {}
  template <class Lane>
  static Float8 lanes(Lane lane) {
    Float8 result;
    for (std::size_t i = 0; i < kLanes; ++i) {
      result.v_[i] = lane(i);
    }
    return result;
  }
  template <class Lane>
  static Mask8 mask(Lane lane) {
    unsigned bits = 0;
    for (std::size_t i = 0; i < kLanes; ++i) {
      bits |= (lane(i) ? 1u : 0u) << i;
    }
    return Mask8(bits);
  }
  std::array<float, kLanes> v_;
};

}  // namespace bandsaw::simd_plain
