#pragma once

// Reads the parameters that several kinds of pbrt's materials share (materials.cpp, metals.cpp).

#include <optional>
#include <string>
#include <utility>

#include "renderlib/base/status_macros.h"
#include "renderlib/import/pbrt/builder.h"

namespace bandsaw::pbrt {

/// The parameters of a pbrt material, and what is needed to convert them.
struct MaterialSource {
  const Parameters& parameters;
  const State& state;
  Builder& builder;

  const Place& place() const { return parameters.place; }
  /// Returns the reflectance of the parameter `name`, at most 1. If the parameter is absent,
  /// returns the constant `otherwise`.
  absl::StatusOr<scene::Texture> reflectance(const std::string& name, double otherwise) const {
    ASSIGN_OR_RETURN(scene::Texture texture,
                     color_texture(parameters, name, ColorUse::kReflectance,
                                   {otherwise, otherwise, otherwise}, state, builder));
    return limited(std::move(texture), place(), builder);
  }
};

/// The roughness along u and v, as alpha of the GGX distribution.
struct Roughness {
  double alpha[2] = {0, 0};
  std::optional<scene::Texture> texture;  ///< texture of alpha, if alpha varies
  /// Returns true if the surface is perfectly smooth: alpha is constant and less than 0.001.
  bool is_smooth() const;
  /// Returns the mean alpha of both directions; 1 if alpha is a texture.
  double mean() const { return texture ? 1 : (alpha[0] + alpha[1]) / 2; }
};

/// Reads the parameters roughness, uroughness and vroughness, whose names begin with `prefix`
/// ("interface.", or ""). `otherwise` is the roughness if none is given.
absl::StatusOr<Roughness> read_roughness(const MaterialSource& from, const std::string& prefix,
                                         double otherwise);

/// Writes the roughness of a surface that is not smooth to `to`.
void set_microfacets(const Roughness& roughness, scene::Microfacets* to);

/// Returns the index of refraction that the parameter `name` gives, clamped to [1, 5]. It is a
/// number, the luminance of a colour, or the value of a spectrum at the d line (588 nm). Returns
/// `otherwise` if the parameter is absent.
absl::StatusOr<double> read_index(const MaterialSource& from, const std::string& name,
                                  double otherwise);

}  // namespace bandsaw::pbrt
