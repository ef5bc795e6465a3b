#pragma once

// Converts one bsdf of a Mitsuba scene, with the wrappers around it, to a material. Used by
// Materials (bsdfs.h), which adds emission, blends and a name.

#include <functional>
#include <string>

#include "absl/status/statusor.h"
#include "proto/scene.pb.h"
#include "renderlib/import/mitsuba/conversion.h"
#include "renderlib/import/mitsuba/textures.h"

namespace bandsaw::mitsuba {

/// The unfinished material of a bsdf. The bsdf and each wrapper around it (twosided, mask,
/// normalmap, bumpmap) add their parts.
struct Draft {
  scene::Material material;
  bool two_sided = false;
  /// The geometry must be turned inside out, because the index of refraction is larger outside.
  bool turned = false;
  bool transmits = false;  ///< light passes through the surface, so that neither side is black
};

class BsdfReader {
 public:
  /// `surface` is the surface that shows the bsdf. `to` collects warnings and made files. Both
  /// arguments MUST outlive this object.
  BsdfReader(const TexturedSurface& surface, Conversion& to) : surface_(surface), to_(to) {}

  /// Converts the bsdf and adds it to `draft`. Warns of properties without a counterpart.
  absl::Status read(const Object& bsdf, Draft& draft);

 private:
  // Each function without a comment is named after a type of bsdf. It reads the parameters `from`
  // of such a bsdf and adds them to `draft`.

  /// Calls the function for the bsdf's type. An unknown type becomes grey diffuse, with a warning.
  absl::Status read_kind(const Parameters& from, Draft& draft);
  /// Reads the parameter `name`. Sets color() to a constant colour, or texture() to a texture that
  /// varies. Sets neither if the parameter is absent.
  absl::Status color_or_texture(const Parameters& from, const std::string& name,
                                const std::function<scene::Color*()>& color,
                                const std::function<scene::Texture*()>& texture);
  /// Sets color() to the constant colour of the parameter `name`. For a texture, warns and sets
  /// nothing.
  absl::Status color_only(const Parameters& from, const std::string& name,
                          const std::function<scene::Color*()>& color);
  absl::Status diffuse(const Parameters& from, Draft& draft);
  /// Returns the ratio of the indices of refraction, inside over outside. If the ratio is below
  /// 1, returns its inverse and sets Draft::turned. If the bsdf has no int_ior, the material named
  /// `inside` ("bk7") gives the index inside.
  absl::StatusOr<double> relative_index(const Parameters& from, const char* inside, Draft& draft);
  /// Reads the distribution and the roughness of a rough bsdf. `otherwise` is the alpha if none is
  /// given.
  absl::StatusOr<scene::Microfacets> microfacets(const Parameters& from, double otherwise);
  absl::Status dielectric(const Parameters& from, Draft& draft);
  /// Warns of colours of glass, because the glass of a Bandsaw scene file has none.
  absl::Status warn_of_tints(const Parameters& from);
  absl::Status thin_dielectric(const Parameters& from, Draft& draft);
  /// Sets eta and k of a conductor: from the name of a metal, or else from the parameters eta and
  /// k. If neither a metal nor eta is given, the conductor is a mirror, or copper in a scene of
  /// version 0.x. If eta is given without k, k is 1.
  absl::Status set_metal(const Parameters& from, scene::Conductor& to);
  absl::Status conductor(const Parameters& from, Draft& draft);
  absl::Status plastic(const Parameters& from, Draft& draft);
  absl::Status diffuse_transmission(const Parameters& from, Draft& draft);
  /// Converts a phong or ward bsdf of version 0.x, a diffuse surface with a highlight, to rough
  /// plastic with the given alpha.
  absl::Status highlight(const Parameters& from, double alpha, Draft& draft);
  absl::Status phong(const Parameters& from, Draft& draft);
  absl::Status ward(const Parameters& from, Draft& draft);

  // Defined in principled_bsdfs.cpp:
  /// Sets field() to the parameter `name`: a number clamped to [0, most], or a texture of numbers.
  /// Sets nothing if the parameter is absent.
  absl::Status parameter(const Parameters& from, const std::string& name, double most,
                         const std::function<scene::Parameter*()>& field);
  /// Sets the fields that principled and principledthin share, and `metallic` if `to` has it.
  template <class Message>
  absl::Status common_parameters(const Parameters& from, Message& to);
  absl::Status principled(const Parameters& from, Draft& draft);
  absl::Status thin_principled(const Parameters& from, Draft& draft);

  // Defined in bsdf_wrappers.cpp:
  /// Returns the only bsdf inside a wrapper.
  absl::StatusOr<const Object*> inner(const Parameters& from);
  absl::Status two_sided(const Parameters& from, Draft& draft);
  absl::Status mask(const Parameters& from, Draft& draft);
  absl::Status normal_map(const Parameters& from, Draft& draft);
  absl::Status bump_map(const Parameters& from, Draft& draft);
  absl::Status coating(const Parameters& from, Draft& draft);

  const TexturedSurface& surface_;
  Conversion& to_;
};

}  // namespace bandsaw::mitsuba
