#pragma once

// How much light a GGX surface reflects in all: what lies below a clear coat gets the rest, so that
// nothing shines more than it receives.

#include <array>

namespace bandsaw {

/// The reflected share for Fresnel reflectance f0 + (1 - f0) (1 - cos)^5 is f0 white + (1 - f0)
/// rim.
struct GgxAlbedo {
  double white = 0;  ///< of F = 1
  double rim = 0;    ///< of F = (1 - cos)^5

  double operator()(double f0) const { return f0 * white + (1 - f0) * rim; }
};

/// A table over cosine and roughness, interpolated; within 2e-3 of the integral (tests).
class GgxAlbedoTable {
 public:
  GgxAlbedoTable();
  /// Seen along a direction of this cosine in [0, 1]; roughness = sqrt(alpha) in [0, 1].
  GgxAlbedo at(double cos_theta, double roughness) const;
  /// The same over all directions, weighed by the cosine.
  GgxAlbedo mean(double roughness) const;

 private:
  static constexpr int kCosines = 32;
  static constexpr int kRoughnesses = 24;
  std::array<std::array<GgxAlbedo, kCosines + 1>, kRoughnesses + 1> values_;
  std::array<GgxAlbedo, kRoughnesses + 1> means_;
};

/// Made on the first call, the same in every process.
const GgxAlbedoTable& ggx_albedo_table();

}  // namespace bandsaw
