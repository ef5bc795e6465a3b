// Converts pbrt's metals. The spectra of eta and k become RGB values that keep the colour of the
// reflectance at normal incidence.

#include "renderlib/import/pbrt/metals.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::pbrt {
namespace {

/// Returns eta and k of a metal for each channel, from the parameters eta and k. Their names begin
/// with `prefix`, which is "conductor." or "". An absent parameter has the value of copper.
absl::StatusOr<spectrum::Metal> read_metal(const MaterialSource& from, const std::string& prefix) {
  const Parameter* eta = from.parameters.find(prefix + "eta");
  const Parameter* k = from.parameters.find(prefix + "k");
  std::optional<spectrum::Sampled> spectra[2] = {spectrum::named("metal-Cu-eta"),
                                                 spectrum::named("metal-Cu-k")};
  std::optional<Rgb3> colors[2];
  const Parameter* given[2] = {eta, k};
  for (int i = 0; i < 2; ++i) {
    if (given[i] == nullptr) {
      continue;
    }
    ASSIGN_OR_RETURN(spectra[i], spectrum_of(*given[i], from.builder));
    if (!spectra[i]) {
      ASSIGN_OR_RETURN(colors[i], color_of(*given[i], ColorUse::kUnbounded, from.state.color_space,
                                           from.builder));
    }
  }
  if (spectra[0] && spectra[1]) {
    return spectrum::metal_rgb(*spectra[0], *spectra[1]);
  }
  spectrum::Metal metal;
  metal.eta = colors[0] ? *colors[0] : spectrum::factor_rgb(*spectra[0]);
  metal.k = colors[1] ? *colors[1] : spectrum::factor_rgb(*spectra[1]);
  return metal;
}

/// Returns the reflectance of a metal at normal incidence in a medium with the index of refraction
/// `outside`.
Rgb3 reflectance_of(const spectrum::Metal& metal, double outside) {
  Rgb3 out = {};
  for (std::size_t c = 0; c < 3; ++c) {
    const double n = metal.eta[c] / outside;
    const double k = metal.k[c] / outside;
    out[c] = ((n - 1) * (n - 1) + k * k) / ((n + 1) * (n + 1) + k * k);
  }
  return out;
}

/// Returns the roughness as glTF defines it: the square root of alpha. If `roughness` is a texture,
/// warns and takes an alpha of 0.5 instead. `what` is the surface that has the roughness.
double gltf_roughness(const MaterialSource& from, const Roughness& roughness,
                      absl::string_view what) {
  if (roughness.texture) {
    from.builder.warn(from.place(), absl::StrCat("the texture of the ", what,
                                                 "'s roughness is left out; an alpha of 0.5 "
                                                 "stands for it"));
    return std::sqrt(0.5);
  }
  return std::sqrt(roughness.mean());
}

}  // namespace

absl::Status conductor(const MaterialSource& from, Surface& to) {
  ASSIGN_OR_RETURN(const Roughness roughness, read_roughness(from, "", 0));
  if (from.parameters.find("reflectance") != nullptr) {
    ASSIGN_OR_RETURN(scene::Texture reflectance, from.reflectance("reflectance", 0.5));
    if (!reflectance.has_color()) {
      from.builder.warn(from.place(), "the metal's reflectance is the texture at every angle");
      scene::Conductor& metal = *to.material.mutable_conductor();
      *metal.mutable_specular_texture() = std::move(reflectance);
      if (!roughness.is_smooth()) {
        set_microfacets(roughness, metal.mutable_surface());
      }
      return absl::OkStatus();
    }
    // With eta = 1 the reflectance r at normal incidence is k^2 / (4 + k^2).
    Rgb3 k = {};
    for (int c = 0; c < 3; ++c) {
      const double r = std::min(reflectance.color().rgb(c), 0.9999);
      k[static_cast<std::size_t>(c)] = std::min(2 * std::sqrt(r) / std::sqrt(1 - r), 100.0);
    }
    set_rgb({1, 1, 1}, to.material.mutable_conductor()->mutable_eta());
    set_rgb(k, to.material.mutable_conductor()->mutable_k());
  } else {
    ASSIGN_OR_RETURN(spectrum::Metal metal, read_metal(from, ""));
    for (std::size_t c = 0; c < 3; ++c) {
      metal.eta[c] = std::clamp(metal.eta[c], 1e-6, 100.0);
      metal.k[c] = std::clamp(metal.k[c], 0.0, 100.0);
    }
    set_rgb(metal.eta, to.material.mutable_conductor()->mutable_eta());
    set_rgb(metal.k, to.material.mutable_conductor()->mutable_k());
  }
  if (!roughness.is_smooth()) {
    set_microfacets(roughness, to.material.mutable_conductor()->mutable_surface());
  }
  return absl::OkStatus();
}

absl::Status coated_conductor(const MaterialSource& from, Surface& to) {
  ASSIGN_OR_RETURN(const Roughness coat, read_roughness(from, "interface.", 0));
  ASSIGN_OR_RETURN(const Roughness metal, read_roughness(from, "conductor.", 0));
  ASSIGN_OR_RETURN(const double index, read_index(from, "interface.eta", 1.5));
  scene::Gltf& gltf = *to.material.mutable_gltf();
  if (from.parameters.find("reflectance") != nullptr) {
    ASSIGN_OR_RETURN(scene::Texture reflectance, from.reflectance("reflectance", 0.5));
    if (reflectance.has_color()) {
      *gltf.mutable_base_color() = std::move(*reflectance.mutable_color());
    } else {
      *gltf.mutable_base_color_texture() = std::move(reflectance);
    }
  } else {
    ASSIGN_OR_RETURN(const spectrum::Metal measured, read_metal(from, "conductor."));
    set_rgb(reflectance_of(measured, index), gltf.mutable_base_color());
  }
  gltf.set_metallic(1);
  gltf.set_roughness(gltf_roughness(from, metal, "metal"));
  gltf.set_clearcoat(1);
  gltf.set_clearcoat_roughness(gltf_roughness(from, coat, "coat"));
  from.builder.warn_once(from.place(),
                         "coatedconductor is shown as a metal with a clear coat of index 1.5, "
                         "without light that is reflected between coat and metal");
  from.parameters.ignore(
      {"thickness", "interface.thickness", "g", "albedo", "maxdepth", "nsamples"});
  return absl::OkStatus();
}

}  // namespace bandsaw::pbrt
