// Integrates reflection and transmission of facets numerically, for tables over alphas and cosines.
// That takes about 10 ms for each coat.

#include "renderlib/material/plastic_coat.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "renderlib/material/fresnel.h"
#include "renderlib/material/microfacets.h"

namespace bandsaw {
namespace {

/// Number of alphas in the table if alpha has a map.
constexpr std::size_t kMappedRows = 17;

/// Shares of the light that arrives at the coat.
struct Shares {
  double reflected = 0;
  double transmitted = 0;
};

/// Returns the reflected and the transmitted share of light that meets a rough boundary from a
/// direction with this cosine. They are integrated by the midpoint rule over the unit square of the
/// numbers (u, v) with which sample_facet() chooses a facet. Values of v near 1 sample the tail of
/// the distribution, so points are denser near v = 1.
Shares shares_of(double cos_theta, double eta, const Facets& facets) {
  constexpr int kTurns = 16;
  constexpr int kHeights = 64;
  const Vec3 o{std::sqrt(1 - cos_theta * cos_theta), 0, cos_theta};
  Shares sum;
  for (int a = 0; a < kTurns; ++a) {
    for (int b = 0; b < kHeights; ++b) {
      const double left = 1 - (b + 0.5) / kHeights;
      // Half a turn suffices: the surface is isotropic.
      const Vec3 h = sample_facet(o, facets, 0.5 * (a + 0.5) / kTurns, 1 - left * left);
      const double o_h = std::min(1.0, dot(o, h));
      if (o_h <= 0) {
        continue;
      }
      const double weight = 2 * left * facet_ratio(o, h, facets) / (kTurns * kHeights);
      const double reflected = fresnel(o_h, eta);
      const Vec3 i = mirrored(o, h);
      if (i.z > 0) {
        sum.reflected += weight * reflected * facet_shadowing(o, i, facets);
      }
      if (const auto cos_t = refracted_cos(o_h, eta)) {
        const Vec3 t = refracted(o, h, *cos_t, eta);
        sum.transmitted += t.z < 0 ? weight * (1 - reflected) * facet_shadowing(o, t, facets) : 0;
      }
    }
  }
  return sum;
}

/// Returns the mean reflectance r of a smooth boundary for diffuse light from the denser side. It
/// is computed from the mean reflectance s for light from outside, by r = 1 - (1 - s) / index^2.
/// The integrand of s is smooth, while the integrand of r has a kink at the angle of total
/// reflection.
double internal_smooth(double index) {
  constexpr int kSteps = 256;
  double outside = 0;
  for (int i = 0; i < kSteps; ++i) {
    // The cosines are denser at grazing angles, where the reflectance changes most.
    const double root = (i + 0.5) / kSteps;
    const double cos_theta = root * root;
    outside += fresnel(cos_theta, index) * 2 * cos_theta * 2 * root / kSteps;
  }
  return 1 - (1 - outside) / (index * index);
}

}  // namespace

PlasticCoat::PlasticCoat(const Microfacets& surface, double index_of_refraction)
    : index_(index_of_refraction),
      most_(surface.alpha_u),
      internal_smooth_(internal_smooth(index_of_refraction)) {
  if (most_ < kMinAlpha) {
    return;
  }
  const std::size_t rows = surface.alpha_u_map ? kMappedRows : 1;
  for (std::size_t i = 0; i < rows; ++i) {
    const double root = rows == 1 ? 1 : static_cast<double>(i) / (kMappedRows - 1);
    rows_.push_back(row_of(surface, most_ * root * root));
  }
}

PlasticCoat::Row PlasticCoat::row_of(const Microfacets& surface, double alpha) const {
  const double used = std::max(kMinAlpha, alpha);
  const Facets facets{used, used, surface.distribution, surface.masking};
  Row row;
  for (std::size_t i = 0; i < kCosines; ++i) {
    const double cos_theta = std::max(1e-6, static_cast<double>(i) / (kCosines - 1));
    row.passing.push_back(shares_of(cos_theta, index_, facets).transmitted);
    // `internal` is a mean over diffuse light from inside, in which directions are weighted by
    // their cosine.
    row.internal += shares_of(cos_theta, 1 / index_, facets).reflected * 2 * cos_theta / kCosines;
  }
  return row;
}

PlasticCoat::At PlasticCoat::at(double alpha) const {
  if (alpha < kMinAlpha || rows_.empty()) {
    return {this, 0, 0, true};
  }
  if (rows_.size() == 1) {
    return {this, 0, 0};
  }
  const double place =
      std::sqrt(std::clamp(alpha / most_, 0.0, 1.0)) * static_cast<double>(rows_.size() - 1);
  const std::size_t row = std::min(static_cast<std::size_t>(place), rows_.size() - 2);
  return {this, row, place - static_cast<double>(row)};
}

double PlasticCoat::between(std::size_t row, double cos_theta) const {
  const double place = std::clamp(cos_theta, 0.0, 1.0) * (kCosines - 1);
  const std::size_t left = std::min(static_cast<std::size_t>(place), kCosines - 2);
  const std::vector<double>& values = rows_[row].passing;
  return values[left] + (values[left + 1] - values[left]) * (place - static_cast<double>(left));
}

double PlasticCoat::At::passing(double cos_theta) const {
  if (smooth) {
    return 1 - fresnel(cos_theta, coat->index_);
  }
  const double value = coat->between(row, cos_theta);
  return next > 0 ? value + (coat->between(row + 1, cos_theta) - value) * next : value;
}

double PlasticCoat::At::internal_reflectance() const {
  if (smooth) {
    return coat->internal_smooth_;
  }
  const double value = coat->rows_[row].internal;
  return next > 0 ? value + (coat->rows_[row + 1].internal - value) * next : value;
}

void prepare_materials(absl::Span<Material> materials) {
  const auto same = [](const Plastic& a, const Plastic& b) {
    const bool both_or_neither_mapped =
        a.surface.alpha_u_map.has_value() == b.surface.alpha_u_map.has_value();
    return a.index_of_refraction == b.index_of_refraction && both_or_neither_mapped &&
           a.surface.alpha_u == b.surface.alpha_u && a.surface.masking == b.surface.masking &&
           a.surface.distribution == b.surface.distribution;
  };
  std::vector<const Plastic*> known;
  for (Material& material : materials) {
    auto* plastic = std::get_if<Plastic>(&material.kind);
    if (plastic == nullptr) {
      continue;
    }
    const auto found = std::find_if(known.begin(), known.end(),
                                    [&](const Plastic* other) { return same(*other, *plastic); });
    if (found != known.end()) {
      plastic->coat = (*found)->coat;
      continue;
    }
    plastic->coat =
        std::make_shared<const PlasticCoat>(plastic->surface, plastic->index_of_refraction);
    known.push_back(plastic);
  }
}

}  // namespace bandsaw
