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

/// Name of the empty medium inside of clear glass that lies in a medium.
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

struct Builder {
  explicit Builder(const ForeignScene& scene) : from(scene), made(scene.name) {}

  const ForeignScene& from;
  scene::Scene out;
  MadeFiles made;
  std::vector<std::string> warnings;

  /// Factor of all light: exposure time x ISO / 100 of the film.
  double light_factor = 1;
  double start_time = 0;  ///< seconds, when the motion starts (TransformTimes)
  double end_time = 1;    ///< seconds, when it ends
  bool has_motion = false;
  Extent extent;

  /// Textures by name: those of colours and those of numbers.
  std::map<std::string, scene::Texture> color_textures;
  std::map<std::string, scene::Texture> float_textures;
  std::map<std::string, std::shared_ptr<const Surface>> materials;
  std::map<std::string, MediumSource> media;
  std::map<std::string, std::string> made_media;  ///< serialised medium -> name in our scene
  /// Media that an open surface bounds, on either side -> place of the first such surface.
  std::map<std::string, Place> open_media;
  std::set<std::string> taken_media;  ///< names of media in use
  bool needs_vacuum = false;
  std::map<std::string, std::string> material_names;       ///< serialised material -> name
  std::set<std::string> taken_names;                       ///< names of materials in use
  std::map<std::string, int> name_counts;                  ///< names made from a label
  std::set<std::string> taken_textures;                    ///< names of textures in use
  std::map<std::string, int> texture_counts;               ///< names made from a texture's name
  std::map<std::string, double> largest_of_texture;        ///< by the texture's name in our scene
  std::map<std::string, double> largest_of_image;          ///< by file, for images of floats
  std::map<std::string, scene::Texture> limited_textures;  ///< by the name of the texture above 1
  scene::Group* group = nullptr;                           ///< between ObjectBegin and ObjectEnd
  int helper_groups = 0;  ///< number of groups that add_helper_group() made

  void warn(const Place& place, absl::string_view what);
  /// Adds the warning unless the same text was a warning before.
  void warn_once(const Place& place, absl::string_view what);
  /// Warns of each parameter that was not used.
  void warn_of_unused(const Parameters& parameters);
  std::set<std::string> warned;  ///< texts of warn_once()
};

// Write values into messages of a scene file.
void set_rgb(const Rgb3& rgb, scene::Color* to);
scene::Texture constant_texture(const Rgb3& rgb);
void set_matrix(const Transform& t, google::protobuf::RepeatedField<double>* to);
void set_vec3(const Vec3& v, google::protobuf::RepeatedField<double>* to);

/// Meaning of a colour.
enum class ColorUse {
  kReflectance,  ///< in [0, 1]
  kLight,        ///< RGB is kept, other spectra are scaled to luminance 1
  kUnbounded,    ///< >= 0
};

/// Returns the colour of a parameter of type rgb, spectrum, blackbody or float.
absl::StatusOr<Rgb3> color_of(const Parameter& parameter, ColorUse use,
                              const std::string& color_space, Builder& builder);
/// Returns the colour of a parameter by its name; `otherwise` if there is none.
absl::StatusOr<Rgb3> color(const Parameters& parameters, const std::string& name, ColorUse use,
                           const Rgb3& otherwise, const State& state, Builder& builder);
/// Returns the spectrum of a parameter of type spectrum; std::nullopt for another type.
absl::StatusOr<std::optional<spectrum::Sampled>> spectrum_of(const Parameter& parameter,
                                                             Builder& builder);

/// Returns the bytes of a file of the scene's folder. Returns std::nullopt if it is missing, after
/// a warning that ends with `instead`, which names the substitute. The error is PERMISSION_DENIED
/// if the file lies outside of the folder.
absl::StatusOr<std::optional<std::string>> read_or_warn(const std::string& name, const Place& place,
                                                        absl::string_view instead,
                                                        Builder& builder);

// Each of these converts a directive and adds the result to the builder; make_surface() returns the
// result instead (textures.cpp, materials.cpp, shapes.cpp, lights.cpp). `type` is the type that the
// directive names ("sphere"). For a texture, `type` is "spectrum" or "float", and `kind` is the
// class of the texture ("imagemap"). `label` begins the name of the material.
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

/// Returns a texture of colours by a parameter that is a colour or names a texture.
absl::StatusOr<scene::Texture> color_texture(const Parameters& parameters, const std::string& name,
                                             ColorUse use, const Rgb3& otherwise,
                                             const State& state, Builder& builder);
/// Returns a texture of numbers, or std::nullopt if the parameter is absent.
absl::StatusOr<std::optional<scene::Texture>> float_texture(const Parameters& parameters,
                                                            const std::string& name,
                                                            Builder& builder);
/// Adds the texture to our scene under a name that begins with `name`, and returns a reference to
/// it. A constant texture is not added but returned as it is.
scene::Texture named_texture(const std::string& name, scene::Texture texture, Builder& builder);
/// Returns an upper bound of the values of a texture; `texture` and the textures in it are
/// references to named ones, or have no name yet.
double largest_value(const scene::Texture& texture, const Builder& builder);
/// Returns a texture with 1 in place of the values above 1 of `texture`, which color_texture() or
/// float_texture() returned. Where the parts of a texture cannot be clamped, it is scaled to at
/// most 1 after a warning at `place`. The error is INVALID_ARGUMENT if an image cannot be decoded.
absl::StatusOr<scene::Texture> limited(scene::Texture texture, const Place& place,
                                       Builder& builder);
/// Returns the number of a constant texture; std::nullopt for another.
std::optional<double> constant_of(const scene::Texture& texture);

/// Emission and opacity that a shape adds to its material.
struct ShapeLook {
  std::optional<Rgb3> emission = std::nullopt;
  std::optional<scene::Texture> emission_texture = std::nullopt;
  bool emits_on_both_sides = false;
  std::optional<scene::Texture> opacity = std::nullopt;
};
/// Returns the name, in our scene, of the surface's material with this look; adds it if it is new.
std::string material_name(const Surface& surface, const ShapeLook& look, const Place& place,
                          Builder& builder);

/// Returns the name that the medium has in our scene. `to_shape` maps the world to the space of the
/// shape that the medium fills. Returns an empty name, after a warning, if the medium has no
/// counterpart.
absl::StatusOr<std::string> medium_name(const std::string& name, const Place& place,
                                        const Transform& to_shape, Builder& builder);

}  // namespace bandsaw::pbrt
