// Reads the textures of a scene file. read_kind() calls one function for each kind of texture. A
// texture that is referred to by name is looked up. Any other texture is added to the draft, which
// is the scene that is being read.

#include "renderlib/import/scene_file/read_textures.h"

#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "proto/scene.pb.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/draft/color_limits.h"
#include "renderlib/import/draft/named_file.h"
#include "renderlib/import/draft/scene_draft.h"
#include "renderlib/import/image/decode_image.h"
#include "renderlib/import/scene_file/field.h"
#include "renderlib/import/scene_file/numbers.h"
#include "renderlib/import/scene_file/suggest.h"
#include "renderlib/math/elementary.h"

namespace bandsaw {
namespace {

/// Returns a number of the file as an enum with the values 0 to `last`. Returns INVALID_ARGUMENT
/// for any other number, because the file may contain any number.
template <class Ours>
absl::StatusOr<Ours> read_enum(const Field& in, const std::string& name, int value, int last) {
  if (value < 0 || value > last) {
    return in.error(name, "is none of the values that it can have");
  }
  return static_cast<Ours>(value);
}

// Reads two finite numbers. If `one_for_both`, the list may also have a single number, which is
// returned twice. Returns `otherwise` twice if the list is empty.
absl::StatusOr<Vec2> read_vec2(const Field& in, const std::string& name, const Numbers& list,
                               bool one_for_both, double otherwise) {
  if (list.empty()) {
    return Vec2{otherwise, otherwise};
  }
  if (list.size() > 2 || (list.size() == 1 && !one_for_both)) {
    return in.error(name, absl::StrCat("must be ", one_for_both ? "1 or 2" : "2", " numbers, has ",
                                       list.size()));
  }
  for (int i = 0; i < list.size(); ++i) {
    if (!std::isfinite(list[i])) {
      return in.error(name, absl::StrCat("must be finite, is ", list[i]), i);
    }
  }
  return Vec2{list[0], list[list.size() - 1]};
}

/// Reads the transform of texture coordinates, which first scales, then rotates, then translates.
absl::StatusOr<UvTransform> read_uv_transform(const Field& in, const scene::ImageTexture& from) {
  ASSIGN_OR_RETURN(const Vec2 scale,
                   read_vec2(in, "uv_scale", from.uv_scale(), /*one_for_both=*/true, 1));
  ASSIGN_OR_RETURN(const Vec2 offset,
                   read_vec2(in, "uv_offset", from.uv_offset(), /*one_for_both=*/false, 0));
  if (!std::isfinite(from.uv_rotate())) {
    return in.error("uv_rotate", absl::StrCat("must be finite, is ", from.uv_rotate()));
  }
  const SinCos turn = sincos_degrees(from.uv_rotate());
  return UvTransform{{turn.cos * scale.x, -turn.sin * scale.y, offset.x, turn.sin * scale.x,
                      turn.cos * scale.y, offset.y}};
}

/// Reads how a texture uses its image: wrapping, filter, encoding, uv set and uv transform.
absl::StatusOr<TextureStore::Use> read_use(const Field& in, const scene::ImageTexture& from) {
  using Proto = scene::ImageTexture;
  TextureStore::Use use;
  ASSIGN_OR_RETURN(const auto wrap, read_enum<int>(in, "wrap", from.wrap(), Proto::Wrap_MAX));
  ASSIGN_OR_RETURN(const auto filter,
                   read_enum<int>(in, "filter", from.filter(), Proto::Filter_MAX));
  // The enums of ImageTexture count from 0. Those of the file have the same order, but their 0
  // means "unspecified".
  if (wrap != Proto::WRAP_UNSPECIFIED) {
    use.wrap = static_cast<ImageTexture::Wrap>(wrap - 1);
  }
  ASSIGN_OR_RETURN(const auto wrap_v, read_enum<int>(in, "wrap_v", from.wrap_v(), Proto::Wrap_MAX));
  if (wrap_v != Proto::WRAP_UNSPECIFIED) {
    use.wrap_v = static_cast<ImageTexture::Wrap>(wrap_v - 1);
  }
  if (filter != Proto::FILTER_UNSPECIFIED) {
    use.filter = static_cast<ImageTexture::Filter>(filter - 1);
  }
  ASSIGN_OR_RETURN(const auto encoding,
                   read_enum<int>(in, "encoding", from.encoding(), Proto::Encoding_MAX));
  use.linear = encoding == Proto::ENCODING_LINEAR;
  ASSIGN_OR_RETURN(use.uv_set, read_enum<UvSet>(in, "uv_set", from.uv_set(), scene::UvSet_MAX));
  ASSIGN_OR_RETURN(use.uv_transform, read_uv_transform(in, from));
  return use;
}

/// Reads the image texture `in`. Returns INVALID_ARGUMENT, with the name of the field, if a field
/// is invalid or the image file cannot be read.
absl::StatusOr<TextureId> read_image_texture(const Field& in, const scene::ImageTexture& from,
                                             SceneDraft& draft) {
  ASSIGN_OR_RETURN(const TextureStore::Use use, read_use(in, from));
  if (from.file().empty()) {
    return in.error("file", "is required: the name of an image file");
  }
  const auto file = find_named_file(from.file(), draft);
  if (!file.ok()) {
    return in.error("file", file.status().message());
  }
  auto texture = draft.textures.image(file->key, from.file(), use,
                                      [&] { return file->read(kMaxImageFileBytes); });
  if (!texture.ok()) {
    return in.error("file", texture.status().message());
  }
  return texture;
}

using MaybeId = absl::StatusOr<TextureId>;

// Reads the texture `name` that the texture `in` contains. If it is absent, returns a constant grey
// of `otherwise`. A negative `otherwise` means that the texture is required, so its absence is
// INVALID_ARGUMENT.
MaybeId read_part(const Field& in, const std::string& name, const scene::Texture& from, float most,
                  float otherwise, SceneDraft& draft) {
  if (in.has(name)) {
    return read_texture(in.child(name), from, most, draft);
  }
  if (otherwise < 0) {
    return in.error(name, "is required");
  }
  return draft.textures.constant(gray(otherwise));
}

// Reads the size of a checker's cells along each axis. The checker has `axes` axes, 2 or 3. The
// file gives a number for each axis, or one number for all axes. The sizes are 1 if the file gives
// none. The size along z is also 1 if there are 2 axes.
absl::StatusOr<Vec3> read_size(const Field& in, const scene::CheckerTexture& from, int axes) {
  const Numbers& list = from.size();
  if (list.size() > 1 && list.size() != axes) {
    return in.error("size", absl::StrCat("must be 1 or ", axes, " numbers, has ", list.size()));
  }
  for (int i = 0; i < list.size(); ++i) {
    if (!(std::isfinite(list[i]) && list[i] > 0)) {
      return in.error("size", absl::StrCat("must be finite and > 0, is ", list[i]), i);
    }
  }
  const auto at = [&](int i) { return list.empty() ? 1 : list.size() == 1 ? list[0] : list[i]; };
  return Vec3{at(0), at(1), axes == 3 ? at(2) : 1};
}

MaybeId read_checker(const Field& in, const scene::CheckerTexture& from, float most,
                     SceneDraft& draft) {
  CheckerTexture to;
  ASSIGN_OR_RETURN(to.mapping,
                   read_enum<CheckerTexture::Mapping>(in, "mapping", from.mapping(),
                                                      scene::CheckerTexture::Mapping_MAX));
  const bool solid = to.mapping == CheckerTexture::Mapping::kPosition;
  ASSIGN_OR_RETURN(to.size, read_size(in, from, solid ? 3 : 2));
  ASSIGN_OR_RETURN(to.uv_set, read_enum<UvSet>(in, "uv_set", from.uv_set(), scene::UvSet_MAX));
  ASSIGN_OR_RETURN(to.space, read_enum<Space>(in, "space", from.space(), scene::Space_MAX));
  ASSIGN_OR_RETURN(to.even, read_part(in, "even", from.even(), most, 1, draft));
  ASSIGN_OR_RETURN(to.odd, read_part(in, "odd", from.odd(), most, 0, draft));
  return draft.textures.add(to);
}

MaybeId read_noise(const Field& in, const scene::NoiseTexture& from, float most,
                   SceneDraft& draft) {
  constexpr double kMax = 1e30;
  NoiseTexture to;
  ASSIGN_OR_RETURN(to.kind, read_enum<NoiseTexture::Kind>(in, "kind", from.kind(),
                                                          scene::NoiseTexture::Kind_MAX));
  ASSIGN_OR_RETURN(to.space, read_enum<Space>(in, "space", from.space(), scene::Space_MAX));
  if (from.has_octaves()) {
    to.octaves = from.octaves();
  }
  RETURN_IF_ERROR(check_range(in, "octaves", to.octaves, 1, 16));
  for (const auto& [name, written, value, ours] :
       {std::tuple("scale", from.has_scale(), from.scale(), &to.scale),
        std::tuple("strength", from.has_strength(), from.strength(), &to.strength),
        std::tuple("turbulence_scale", from.has_turbulence_scale(), from.turbulence_scale(),
                   &to.turbulence_scale)}) {
    if (written) {
      RETURN_IF_ERROR(check_range(in, name, value, -kMax, kMax));
      *ours = value;
    }
  }
  ASSIGN_OR_RETURN(to.axis, read_vec3(in, "axis", from.axis(), to.axis));
  if (from.has_low()) {
    ASSIGN_OR_RETURN(to.low, read_color(in.child("low"), from.low(), most));
  }
  if (from.has_high()) {
    ASSIGN_OR_RETURN(to.high, read_color(in.child("high"), from.high(), most));
  }
  return draft.textures.add(to);
}

absl::StatusOr<RampTexture::Stop> read_stop(const Field& in, const scene::RampTexture::Stop& from,
                                            float most) {
  RETURN_IF_ERROR(check_range(in, "at", from.at(), -1e30, 1e30));
  ASSIGN_OR_RETURN(const Vec3 color, read_vec3(in, "color", from.color()));
  for (int i = 0; i < 3; ++i) {
    const double channel = from.color(i);
    if (!(channel >= 0 && channel <= most)) {
      return in.error("color", absl::StrCat("must lie in [0, ", most, "], is ", channel), i);
    }
  }
  return RampTexture::Stop{
      from.at(),
      {static_cast<float>(color.x), static_cast<float>(color.y), static_cast<float>(color.z)}};
}

MaybeId read_ramp(const Field& in, const scene::RampTexture& from, float most, SceneDraft& draft) {
  RampTexture to;
  to.steps = from.steps();
  ASSIGN_OR_RETURN(to.uv_set, read_enum<UvSet>(in, "uv_set", from.uv_set(), scene::UvSet_MAX));
  ASSIGN_OR_RETURN(to.space, read_enum<Space>(in, "space", from.space(), scene::Space_MAX));
  for (int i = 0; i < from.stop_size(); ++i) {
    const Field stop = in.child("stop", i);
    ASSIGN_OR_RETURN(const RampTexture::Stop read, read_stop(stop, from.stop(i), most));
    if (i > 0 && !(read.at > to.stops.back().at)) {
      return stop.error("at", absl::StrCat("must be above ", to.stops.back().at,
                                           ", the position of the stop before; it is ", read.at));
    }
    to.stops.push_back(read);
  }
  if (to.stops.empty() || to.stops.size() > 256) {
    return in.error("stop", absl::StrCat("must have 1 to 256 stops; it has ", to.stops.size()));
  }
  if (from.has_texture()) {
    ASSIGN_OR_RETURN(to.texture,
                     read_texture(in.child("texture"), from.texture(), kMaxRadiance, draft));
    return draft.textures.add(std::move(to));
  }
  // Both enums have the same order. The value 0 is kTexture here, and "unspecified" in the file.
  ASSIGN_OR_RETURN(to.over, read_enum<RampTexture::Over>(in, "coordinate", from.coordinate(),
                                                         scene::RampTexture::Coordinate_MAX));
  if (to.over == RampTexture::Over::kTexture) {
    return in.error("has no input: write texture or coordinate");
  }
  return draft.textures.add(std::move(to));
}

MaybeId read_mix(const Field& in, const scene::MixTexture& from, float most, SceneDraft& draft) {
  MixTexture to;
  ASSIGN_OR_RETURN(to.a, read_part(in, "a", from.a(), most, /*otherwise=*/-1, draft));
  ASSIGN_OR_RETURN(to.b, read_part(in, "b", from.b(), most, /*otherwise=*/-1, draft));
  ASSIGN_OR_RETURN(to.amount, read_part(in, "amount", from.amount(), kMaxRadiance, 0.5f, draft));
  return draft.textures.add(to);
}

// The factors may be above the limit of the product. read_texture() checks the product.
MaybeId read_product(const Field& in, const scene::ProductTexture& from, SceneDraft& draft) {
  ProductTexture to;
  ASSIGN_OR_RETURN(to.a, read_part(in, "a", from.a(), kMaxRadiance, /*otherwise=*/-1, draft));
  ASSIGN_OR_RETURN(to.b, read_part(in, "b", from.b(), kMaxRadiance, /*otherwise=*/-1, draft));
  return draft.textures.add(to);
}

MaybeId find_texture(const Field& in, const std::string& name, const SceneDraft& draft) {
  const auto found = draft.named_textures.find(name);
  if (found != draft.named_textures.end()) {
    return found->second;
  }
  std::vector<std::string> known;
  for (const auto& [other, id] : draft.named_textures) {
    known.push_back(other);
  }
  return in.error("use", absl::StrCat("no texture before this is called \"", name, "\"",
                                      known.empty() ? "" : did_you_mean(name, known)));
}

MaybeId read_kind(const Field& in, const scene::Texture& from, float most, SceneDraft& draft) {
  switch (from.kind_case()) {
    case scene::Texture::kColor: {
      ASSIGN_OR_RETURN(const Rgb color, read_color(in.child("color"), from.color(), most));
      return draft.textures.constant(color);
    }
    case scene::Texture::kImage:
      return read_image_texture(in.child("image"), from.image(), draft);
    case scene::Texture::kChecker:
      return read_checker(in.child("checker"), from.checker(), most, draft);
    case scene::Texture::kNoise:
      return read_noise(in.child("noise"), from.noise(), most, draft);
    case scene::Texture::kRamp:
      return read_ramp(in.child("ramp"), from.ramp(), most, draft);
    case scene::Texture::kMix:
      return read_mix(in.child("mix"), from.mix(), most, draft);
    case scene::Texture::kProduct:
      return read_product(in.child("product"), from.product(), draft);
    case scene::Texture::kUse:
      return find_texture(in, from.use(), draft);
    case scene::Texture::KIND_NOT_SET:
      break;
  }
  return in.error("is empty: write color, image, checker, noise, ramp, mix, product or use");
}

// Returns true for the kinds whose colours read_kind() does not compare with `most`. These colours
// are in an image file or in another texture, or are products.
bool colors_need_check(const scene::Texture& from) {
  return from.has_image() || from.has_product() || from.kind_case() == scene::Texture::kUse;
}

}  // namespace

absl::StatusOr<TextureId> read_texture(const Field& in, const scene::Texture& from, float most,
                                       SceneDraft& draft) {
  if (!from.name().empty()) {
    return in.error("name", "is for the textures of the scene; write it there and use it here");
  }
  ASSIGN_OR_RETURN(const TextureId id, read_kind(in, from, most, draft));
  if (colors_need_check(from)) {
    if (const float found = draft.textures.max_value(id); found > most) {
      const std::string place = from.has_image() ? "image" : from.has_product() ? "product" : "use";
      const std::string what =
          absl::StrCat(most == kMaxReflectance ? "a reflectance must lie in [0, 1], "
                                               : absl::StrCat("must be at most ", most, ", "),
                       from.has_image() ? "the image holds " : "it reaches ", found);
      return from.has_image() ? in.child("image").error("file", what) : in.error(place, what);
    }
  }
  return id;
}

absl::Status read_textures(const Field& root, const scene::Scene& from, SceneDraft& draft) {
  for (int i = 0; i < from.texture_size(); ++i) {
    const Field in = root.child("texture", i);
    const std::string& name = from.texture(i).name();
    if (name.empty()) {
      return in.error("name", "is required, so that a material can use it");
    }
    ASSIGN_OR_RETURN(const TextureId id, read_kind(in, from.texture(i), kMaxRadiance, draft));
    if (!draft.named_textures.emplace(name, id).second) {
      return in.error("name", absl::StrCat("\"", name, "\" is the name of another texture"));
    }
  }
  return absl::OkStatus();
}

}  // namespace bandsaw
