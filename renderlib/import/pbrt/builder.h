#pragma once

// The Builder holds the scene file that a pbrt scene is converted to, and the state that all parts
// of the conversion share. "Our scene" is that scene file (proto/scene.proto).

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "proto/scene.pb.h"
#include "renderlib/import/convert/foreign_scene.h"
#include "renderlib/import/convert/made_files.h"
#include "renderlib/import/pbrt/parameters.h"
#include "renderlib/import/pbrt/state.h"
#include "renderlib/import/spectrum/spectrum.h"

namespace bandsaw::pbrt {

using spectrum::Rgb3;

/// Name of the empty medium that fills clear glass if the glass lies in a medium.
inline constexpr char kVacuum[] = "vacuum";

/// A medium as MakeNamedMedium defined it.
struct MediumSource {
  std::string type;
  Parameters parameters;
  std::string color_space;
  Transform to_world;
};

/// The box around all shapes so far, in world space.
struct Extent {
  Vec3 low{1e300, 1e300, 1e300};
  Vec3 high{-1e300, -1e300, -1e300};
  void add(const Vec3& p);
};

/// A PLY file that our scene uses as it is, so that its vertices are not in the Extent yet.
struct UnchangedFile {
  Parameters parameters;  ///< of the plymesh
  Transform to_world;
};

struct Builder {
  explicit Builder(const ForeignScene& scene) : from(scene), made(scene.name) {}

  const ForeignScene& from;
  scene::Scene out;
  MadeFiles made;
  std::vector<std::string> warnings;

  /// Factor of all light: exposure time x ISO / 100 of the film.
  double light_factor = 1;
  double start_time = 0;    ///< seconds, when the motion starts (TransformTimes)
  double end_time = 1;      ///< seconds, when the motion ends
  bool has_motion = false;  ///< something in the scene moves
  Extent extent;
  std::vector<UnchangedFile> unchanged_files;

  /// Textures of colours and textures of numbers, by their names in the pbrt scene.
  std::map<std::string, scene::Texture> color_textures;
  std::map<std::string, scene::Texture> float_textures;
  std::map<std::string, std::shared_ptr<const Surface>> materials;
  std::map<std::string, MediumSource> media;
  std::map<std::string, std::string> made_media;  ///< serialised medium -> name in our scene
  /// Media that an open surface bounds, on either side -> place of the first such surface.
  std::map<std::string, Place> open_media;
  std::set<std::string> taken_media;  ///< names of media in use
  bool needs_vacuum = false;
  std::map<std::string, std::string> material_names;  ///< serialised material -> name
  std::set<std::string> taken_names;                  ///< names of materials in use
  std::map<std::string, int> name_counts;             ///< label -> last number appended to it
  std::set<std::string> taken_textures;               ///< names of textures in use
  std::map<std::string, int> texture_counts;          ///< name -> last number appended to it
  /// Name of a texture in our scene -> upper bound of its values.
  std::map<std::string, double> largest_of_texture;
  /// File of an image of floats -> its largest value.
  std::map<std::string, double> largest_of_image;
  /// Name of a texture with values above 1 -> the texture limited to 1 that limited() made of it.
  std::map<std::string, scene::Texture> limited_textures;
  /// Group of the object between ObjectBegin and ObjectEnd; otherwise nullptr.
  scene::Group* group = nullptr;
  int helper_groups = 0;  ///< number of groups that add_helper_group() made

  /// Adds a warning with the place before `what`. At most 1000 warnings are kept.
  void warn(const Place& place, absl::string_view what);
  /// Adds the warning unless the same text was a warning before.
  void warn_once(const Place& place, absl::string_view what);
  /// Warns of each parameter that was not used.
  void warn_of_unused(const Parameters& parameters);
  /// Texts of warn_once(), and an entry for each medium whose unused parameters caused warnings.
  std::set<std::string> warned;
};

// These functions write values into the protobuf messages of our scene file.
void set_rgb(const Rgb3& rgb, scene::Color* to);
scene::Texture constant_texture(const Rgb3& rgb);
void set_matrix(const Transform& t, google::protobuf::RepeatedField<double>* to);
void set_vec3(const Vec3& v, google::protobuf::RepeatedField<double>* to);

/// Meaning of a colour.
enum class ColorUse {
  kReflectance,  ///< in [0, 1]
  kLight,        ///< an RGB colour is kept, a spectrum is scaled to luminance 1
  kUnbounded,    ///< >= 0
};

/// Returns the colour of a parameter of type rgb, spectrum, blackbody or float.
absl::StatusOr<Rgb3> color_of(const Parameter& parameter, ColorUse use,
                              const std::string& color_space, Builder& builder);
/// Returns the colour of the parameter `name`, or `otherwise` if the parameter is absent.
absl::StatusOr<Rgb3> color(const Parameters& parameters, const std::string& name, ColorUse use,
                           const Rgb3& otherwise, const State& state, Builder& builder);
/// Returns the spectrum of a parameter of type spectrum; std::nullopt for another type.
absl::StatusOr<std::optional<spectrum::Sampled>> spectrum_of(const Parameter& parameter,
                                                             Builder& builder);

/// Returns the bytes of a file of the scene's folder. If the file is missing, returns std::nullopt
/// after a warning. The warning ends with `instead`, which says what is used instead. The error is
/// PERMISSION_DENIED if the file lies outside of the folder.
absl::StatusOr<std::optional<std::string>> read_or_warn(const std::string& name, const Place& place,
                                                        absl::string_view instead,
                                                        Builder& builder);

// Each of these functions converts a directive (textures.cpp, materials.cpp, shapes.cpp,
// lights.cpp). They add the result to the builder, except make_surface(), which returns the result.
// `type` is the type that the directive names ("sphere"). For a texture, `type` is "spectrum" or
// "float", and `kind` is the class of the texture ("imagemap"). The name of the material that
// make_surface() makes begins with `label`.
absl::Status add_texture(const std::string& name, const std::string& type, const std::string& kind,
                         Parameters parameters, const State& state, Builder& builder);
absl::StatusOr<std::shared_ptr<const Surface>> make_surface(const std::string& type,
                                                            const std::string& label,
                                                            const Parameters& parameters,
                                                            const State& state, Builder& builder);
absl::Status add_shape(const std::string& type, const Parameters& parameters, const State& state,
                       Builder& builder);
absl::Status add_light(const std::string& type, const Parameters& parameters, const State& state,
                       Builder& builder);

/// Returns the texture of colours of the parameter `name`, which is a colour or the name of a
/// texture. Returns the constant `otherwise` if the parameter is absent.
absl::StatusOr<scene::Texture> color_texture(const Parameters& parameters, const std::string& name,
                                             ColorUse use, const Rgb3& otherwise,
                                             const State& state, Builder& builder);
/// Returns the texture of numbers of the parameter `name`, which is a number or the name of a
/// texture. Returns std::nullopt if the parameter is absent.
absl::StatusOr<std::optional<scene::Texture>> float_texture(const Parameters& parameters,
                                                            const std::string& name,
                                                            Builder& builder);
/// Adds the texture to our scene under a name that begins with `name`, and returns a reference to
/// it. A constant texture is not added; the function returns it unchanged.
scene::Texture named_texture(const std::string& name, scene::Texture texture, Builder& builder);
/// Returns an upper bound of the values of a texture. The textures to which `texture` refers by
/// name MUST have been added by named_texture().
double largest_value(const scene::Texture& texture, const Builder& builder);
/// Returns `texture` with 1 in place of each value above 1. color_texture() or float_texture() MUST
/// have returned `texture`. A part that cannot be clamped is scaled instead so that it is at most
/// 1, with a warning at `place`. The error is INVALID_ARGUMENT if an image cannot be decoded.
absl::StatusOr<scene::Texture> limited(scene::Texture texture, const Place& place,
                                       Builder& builder);
/// Returns the value of a constant texture, which is its luminance if its channels differ. Returns
/// std::nullopt for a texture that is not constant.
std::optional<double> constant_of(const scene::Texture& texture);

/// Emission and opacity that a shape adds to its material.
struct ShapeLook {
  std::optional<Rgb3> emission = std::nullopt;
  std::optional<scene::Texture> emission_texture = std::nullopt;
  bool emits_on_both_sides = false;
  std::optional<scene::Texture> opacity = std::nullopt;
};
/// Returns the name in our scene of the material that combines the surface and the look. Adds the
/// material to our scene if it is new. `place` is the place of warnings.
std::string material_name(const Surface& surface, const ShapeLook& look, const Place& place,
                          Builder& builder);

/// Returns the name that the medium has in our scene. `to_shape` maps the world to the space of the
/// shape that the medium fills. Returns an empty name, after a warning, if the medium has no
/// counterpart.
absl::StatusOr<std::string> medium_name(const std::string& name, const Place& place,
                                        const Transform& to_shape, Builder& builder);

}  // namespace bandsaw::pbrt
