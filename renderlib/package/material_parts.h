#pragma once

// Conversion of the values that describe materials to and from proto/package.proto: colours
// (Rgb), textures with a factor (Channel, Tint) and references to textures by number. Decoding
// checks only the form; scene/validate.h checks the values.

#include <cstdint>
#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "proto/package.pb.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/material/material.h"
#include "renderlib/package/decode_surface.h"

namespace bandsaw {

inline std::uint32_t number_of(TextureId id) { return static_cast<std::uint32_t>(id); }

inline void encode(const Rgb& from, package::Rgb& to) {
  for (const float channel : {from.r, from.g, from.b}) {
    to.add_rgb(channel);
  }
}

inline void encode(const Channel& from, package::Channel& to) {
  to.set_texture(number_of(from.texture));
  to.set_factor(from.factor);
}

inline Channel decode(const package::Channel& from) {
  return {TextureId{from.texture()}, from.factor()};
}

inline void encode(const Tint& from, package::Tint& to) {
  to.set_texture(number_of(from.texture));
  for (const float channel : {from.factor.r, from.factor.g, from.factor.b}) {
    to.add_factor(channel);
  }
}

inline absl::StatusOr<Tint> decode(const package::Tint& from, const std::string& field) {
  ASSIGN_OR_RETURN(const Rgb factor, decode_rgb(from.factor(), field + ".factor"));
  return Tint{TextureId{from.texture()}, factor};
}

/// Returns the texture with number `index` if the optional field is present, otherwise
/// std::nullopt.
inline std::optional<TextureId> texture_if(bool present, std::uint32_t index) {
  return present ? std::optional(TextureId{index}) : std::nullopt;
}

}  // namespace bandsaw
