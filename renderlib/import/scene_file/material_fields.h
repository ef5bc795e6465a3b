#pragma once

// Reads fields that several kinds of materials in a scene file have. In each function `in` is the
// place of the message of the material's kind, such as `metal`, and `from` is the value that is
// read.

#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "proto/scene.pb.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/draft/color_limits.h"
#include "renderlib/import/draft/scene_draft.h"
#include "renderlib/import/scene_file/field.h"
#include "renderlib/import/scene_file/numbers.h"
#include "renderlib/import/scene_file/read_textures.h"

namespace bandsaw {

/// Reads the texture `name` if it is `given`; otherwise returns a white one. No channel may be
/// above `most`.
inline absl::StatusOr<TextureId> texture_or_white(const Field& in, const std::string& name,
                                                  bool given, const scene::Texture& from,
                                                  float most, SceneDraft& draft) {
  return given ? read_texture(in.child(name), from, most, draft)
               : draft.textures.constant({1, 1, 1});
}

/// Reads the texture `name` that gives a number, or returns std::nullopt if it is not `given`.
inline absl::StatusOr<std::optional<TextureId>> read_map(const Field& in, const std::string& name,
                                                         bool given, const scene::Texture& from,
                                                         SceneDraft& draft) {
  if (!given) {
    return std::optional<TextureId>();
  }
  ASSIGN_OR_RETURN(const TextureId id, read_texture(in.child(name), from, kMaxReflectance, draft));
  return std::optional(id);
}

/// A reflectance that is written as a texture or as a colour, with the names of the two fields.
struct ReflectanceFields {
  const char* texture_name;
  bool textured;  ///< the field `texture` is present
  const scene::Texture& texture;
  const char* color_name;
  bool colored;  ///< the field `color` is present
  const scene::Color& color;
  float otherwise;  ///< the reflectance if both fields are absent
};

/// Returns the reflectance as a texture. Returns INVALID_ARGUMENT if both fields are present.
inline absl::StatusOr<TextureId> read_reflectance(const Field& in, const ReflectanceFields& from,
                                                  SceneDraft& draft) {
  if (from.textured && from.colored) {
    return in.error(from.color_name, absl::StrCat("write ", from.texture_name, " or ",
                                                  from.color_name, ", not both"));
  }
  if (from.textured) {
    return read_texture(in.child(from.texture_name), from.texture, kMaxReflectance, draft);
  }
  if (from.colored) {
    ASSIGN_OR_RETURN(const Rgb color,
                     read_color(in.child(from.color_name), from.color, kMaxReflectance));
    return draft.textures.constant(color);
  }
  return draft.textures.constant(gray(from.otherwise));
}

/// Returns the reflectance of `from`, a message with the fields `texture` and `color`. If both
/// fields are absent, the reflectance is `otherwise`.
template <class From>
absl::StatusOr<TextureId> read_reflectance(const Field& in, const From& from, float otherwise,
                                           SceneDraft& draft) {
  return read_reflectance(in,
                          {"texture", from.has_texture(), from.texture(), "color", from.has_color(),
                           from.color(), otherwise},
                          draft);
}

}  // namespace bandsaw
