#pragma once

// Directional albedo of GGX reflection, for glTF's metallic-roughness material. Layers below a
// reflection receive the light that is not reflected, so that energy is conserved.

#include <array>

namespace bandsaw {

/// For the Fresnel reflectance f0 + (1 - f0) (1 - cos)^5, the albedo is f0 white + (1 - f0) rim.
struct GgxAlbedo {
  double white = 0;  ///< for F = 1
  double rim = 0;    ///< for F = (1 - cos)^5

  double operator()(double f0) const { return f0 * white + (1 - f0) * rim; }
};

/// Interpolated table over cosine and roughness. Its values differ from the integral by at most
/// 2e-3, as tests check.
class GgxAlbedoTable {
 public:
  GgxAlbedoTable();
  /// Returns the albedo for a direction with this cosine to the normal. Cosine and roughness are in
  /// [0, 1]; roughness is the square root of alpha.
  GgxAlbedo at(double cos_theta, double roughness) const;
  /// Returns the cosine-weighted mean over all directions.
  GgxAlbedo mean(double roughness) const;

 private:
  static constexpr int kCosines = 32;
  static constexpr int kRoughnesses = 24;
  std::array<std::array<GgxAlbedo, kCosines + 1>, kRoughnesses + 1> values_;
  std::array<GgxAlbedo, kRoughnesses + 1> means_;
};

/// Returns the table. It is computed on the first call, and has the same bits in every process.
const GgxAlbedoTable& ggx_albedo_table();

}  // namespace bandsaw
