// Decodes the filters of EXT_meshopt_compression (its appendix B): octahedral normals, quaternions
// without their largest component, and numbers with a separate exponent.

#include "renderlib/import/gltf/meshopt_filters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace bandsaw::gltf {
namespace {

template <class T>
std::array<T, 4> load(const std::string& bytes, std::size_t at) {
  std::array<T, 4> values;
  std::memcpy(values.data(), bytes.data() + at, sizeof values);
  return values;
}
template <class T>
void store(const std::array<T, 4>& values, std::string& bytes, std::size_t at) {
  std::memcpy(bytes.data() + at, values.data(), sizeof values);
}

/// Returns `value` in [-1, 1] as a normalised integer, halves rounded away from zero.
template <class T>
T normalized(double value) {
  const double scaled = value * std::numeric_limits<T>::max();
  return static_cast<T>(scaled + (scaled < 0 ? -0.5 : 0.5));
}

/// Does the same as decode_octahedral() for components of the type T. The third component of an
/// element holds the value that stands for 1. The unit vector replaces the first three components.
template <class T>
void decode_octahedral_of(std::string& bytes) {
  for (std::size_t at = 0; at < bytes.size(); at += sizeof(std::array<T, 4>)) {
    std::array<T, 4> values = load<T>(bytes, at);
    double x = values[0];
    double y = values[1];
    const double z = static_cast<double>(values[2]) - std::abs(x) - std::abs(y);
    const double folded = std::min(z, 0.0);
    x += x < 0 ? -folded : folded;
    y += y < 0 ? -folded : folded;
    const double length = std::sqrt(x * x + y * y + z * z);
    const double by = length > 0 ? 1 / length : 0;
    values[0] = normalized<T>(x * by);
    values[1] = normalized<T>(y * by);
    values[2] = normalized<T>(z * by);
    store(values, bytes, at);
  }
}

}  // namespace

void decode_octahedral(std::string& bytes, std::size_t stride) {
  if (stride == 4) {
    decode_octahedral_of<std::int8_t>(bytes);
  } else {
    decode_octahedral_of<std::int16_t>(bytes);
  }
}

void decode_quaternions(std::string& bytes) {
  constexpr double kRootOfHalf = 0.70710678118654752440;
  for (std::size_t at = 0; at < bytes.size(); at += 8) {
    const std::array<std::int16_t, 4> from = load<std::int16_t>(bytes, at);
    // The fourth component holds the value that stands for 1, except for its two lowest bits, which
    // are the index of the missing component.
    const double one = from[3] | 3;
    const std::size_t missing = static_cast<std::size_t>(from[3] & 3);
    double left = 1;
    std::array<std::int16_t, 4> to{};
    for (std::size_t i = 0; i < 3; ++i) {
      const double value = std::clamp(from[i] / one * kRootOfHalf, -1.0, 1.0);
      left -= value * value;
      to[(missing + 1 + i) % 4] = normalized<std::int16_t>(value);
    }
    to[missing] = normalized<std::int16_t>(std::sqrt(std::max(left, 0.0)));
    store(to, bytes, at);
  }
}

void decode_exponential(std::string& bytes) {
  for (std::size_t at = 0; at < bytes.size(); at += 4) {
    std::uint32_t code = 0;
    std::memcpy(&code, bytes.data() + at, 4);
    // Exponent (8 bits) and mantissa (24 bits) are signed, so both are shifted as signed numbers.
    const auto exponent = static_cast<std::int32_t>(code) >> 24;
    const auto mantissa = static_cast<std::int32_t>(code << 8) >> 8;
    const auto value = static_cast<float>(std::ldexp(static_cast<double>(mantissa), exponent));
    std::memcpy(bytes.data() + at, &value, 4);
  }
}

}  // namespace bandsaw::gltf
