#pragma once

// Converts colours and textures of Mitsuba scenes to those of our scene files.

#include <map>
#include <optional>
#include <set>
#include <string>

#include "absl/status/statusor.h"
#include "proto/scene.pb.h"
#include "renderlib/import/mitsuba/conversion.h"
#include "renderlib/import/mitsuba/parameters.h"

namespace bandsaw::mitsuba {

/// How our uv coordinates of a surface relate to Mitsuba's. In Mitsuba, v = 0 is the top row of an
/// image.
enum class UvFrame {
  kSame,
  kFlipped,  ///< our v is 1 - Mitsuba's v
};

/// The properties of a surface that its textures depend on.
struct TexturedSurface {
  UvFrame frame = UvFrame::kSame;
  /// Images of the mesh's attributes: name -> file. They are looked up by the surface's uvs.
  std::map<std::string, std::string> attributes = {};
};

/// The use of a value. It decides how a spectrum becomes RGB: as the reflectance of a surface
/// or as the radiance of a light. kNumber is used for numbers, such as a roughness. In a
/// checkerboard of numbers, Mitsuba exchanges the two values, and so does this converter.
enum class ColorOf { kSurface, kLight, kNumber };

/// A number that may vary over a surface. It is the luminance of the texture if there is a texture,
/// and `value` otherwise.
struct Varying {
  double value = 0;
  std::optional<scene::Texture> texture = std::nullopt;
};

/// Sets the three channels of `to`.
void set_color(const Rgb& color, scene::Color* to);
/// Returns a texture of one colour.
scene::Texture constant_texture(const Rgb& color);

/// Returns the constant colour of the property's value; std::nullopt if the value is a texture that
/// varies.
absl::StatusOr<std::optional<Rgb>> constant_color(const Property& property, ColorOf of);

/// Converts a value to a texture. Returns INVALID_ARGUMENT with the place of the property if the
/// value is neither a colour nor a texture.
absl::StatusOr<scene::Texture> texture_of(const Property& property, ColorOf of,
                                          const TexturedSurface& surface, Conversion& to);

/// Returns a parameter that is a number or a texture; `otherwise` if there is none.
absl::StatusOr<Varying> varying_of(const Parameters& from, const std::string& name,
                                   double otherwise, const TexturedSurface& surface,
                                   Conversion& to);

/// Returns true if the texture of the value depends on uv coordinates.
bool uses_uv(const Value& value);
/// Adds the names of the mesh attributes that textures in the object use.
void find_attributes(const Object& object, std::set<std::string>& names);

}  // namespace bandsaw::mitsuba
