#pragma once

// Transmittance of the dielectric coat of the material Plastic. It is computed once for each coat,
// when the scene is built.

#include <vector>

#include "absl/types/span.h"
#include "renderlib/material/material.h"

namespace bandsaw {

/// Two tables: the transmittance of the coat for light from outside, which depends on the cosine,
/// and the mean reflectance of the coat for light from inside. The tables are for the alpha of
/// Plastic::surface. If alpha has a map, they are for all alphas up to this value. Scattering is
/// single: light that meets another facet is lost, as in the coat's reflection. The transmittance
/// of a rough coat is interpolated linearly between 64 cosines, as in Mitsuba 3's roughplastic. The
/// transmittance of a smooth coat is exact.
class PlasticCoat {
 public:
  PlasticCoat(const Microfacets& surface, double index_of_refraction);

  /// The coat at a point where its alpha is `alpha`.
  struct At {
    const PlasticCoat* coat;
    std::size_t row;      ///< last row whose alpha is at most `alpha`
    double next = 0;      ///< weight of the row after `row`
    bool smooth = false;  ///< the coat is smooth here; no row is used

    /// Returns the share of light that passes into the coat; the cosine is in [0, 1].
    double passing(double cos_theta) const;
    /// Returns the mean share of diffuse light from below that the coat reflects back.
    double internal_reflectance() const;
  };
  At at(double alpha) const;

 private:
  static constexpr std::size_t kCosines = 64;
  /// The table for one alpha.
  struct Row {
    double internal = 0;          ///< At::internal_reflectance()
    std::vector<double> passing;  ///< At::passing() for cosine i / (kCosines - 1)
  };
  /// Computes the table for one alpha by numerical integration.
  Row row_of(const Microfacets& surface, double alpha) const;
  /// Interpolates Row::passing of a row.
  double between(std::size_t row, double cos_theta) const;

  double index_;
  double most_;  ///< alpha of the last row
  double internal_smooth_ = 0;
  /// The alpha of row i is most_ (i / (number of rows - 1))^2. There is one row, for most_, if
  /// alpha has no map, and no row if the coat is smooth.
  std::vector<Row> rows_;
};

/// Sets Plastic::coat of all materials of the kind Plastic. Materials with equal coats share one
/// object.
void prepare_materials(absl::Span<Material> materials);

}  // namespace bandsaw
