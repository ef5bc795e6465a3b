#include "renderlib/package/decode_texture.h"

#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/package/decode_enum.h"
#include "renderlib/package/decode_surface.h"
#include "renderlib/package/manifest.h"

namespace bandsaw {
namespace {

absl::StatusOr<UvSet> uv_set(int value, const std::string& field) {
  return decode_enum<UvSet>(value, 0, package::UvSet_MAX, field + ".uv_set");
}

absl::StatusOr<Space> space(int value, const std::string& field) {
  return decode_enum<Space>(value, 0, package::Space_MAX, field + ".space");
}

absl::StatusOr<Vec3> vec3(const google::protobuf::RepeatedField<double>& list,
                          const std::string& field) {
  if (list.size() != 3) {
    return manifest_error(field, absl::StrCat("must have 3 numbers, has ", list.size()));
  }
  return Vec3{list[0], list[1], list[2]};
}

absl::StatusOr<ImageTexture> image(const package::ImageTexture& from, const std::string& field) {
  using Proto = package::ImageTexture;
  using Ours = ImageTexture;
  ImageTexture to;
  to.width = from.width();
  to.height = from.height();
  ASSIGN_OR_RETURN(
      to.format, decode_enum<Ours::Format>(from.format(), 1, Proto::Format_MAX, field + ".format"));
  ASSIGN_OR_RETURN(to.wrap,
                   decode_enum<Ours::Wrap>(from.wrap(), 1, Proto::Wrap_MAX, field + ".wrap"));
  if (from.wrap_v() != Proto::WRAP_UNSPECIFIED) {
    ASSIGN_OR_RETURN(to.wrap_v,
                     decode_enum<Ours::Wrap>(from.wrap_v(), 1, Proto::Wrap_MAX, field + ".wrap_v"));
  }
  ASSIGN_OR_RETURN(
      to.filter, decode_enum<Ours::Filter>(from.filter(), 1, Proto::Filter_MAX, field + ".filter"));
  if (from.channels() > 3 || from.channels() == 2) {
    return manifest_error(field + ".channels",
                          absl::StrCat("must be 0, 1 or 3, is ", from.channels()));
  }
  to.channels = from.channels() == 1 ? 1 : 3;
  ASSIGN_OR_RETURN(to.uv_set, uv_set(from.uv_set(), field));
  if (from.uv_transform_size() != 0 && from.uv_transform_size() != 6) {
    return manifest_error(field + ".uv_transform",
                          absl::StrCat("must have 0 or 6 numbers, has ", from.uv_transform_size()));
  }
  std::copy(from.uv_transform().begin(), from.uv_transform().end(), to.uv_transform.m.begin());
  return to;
}

absl::StatusOr<CheckerTexture> checker(const package::CheckerTexture& from,
                                       const std::string& field) {
  CheckerTexture to;
  to.even = TextureId{from.even()};
  to.odd = TextureId{from.odd()};
  ASSIGN_OR_RETURN(
      to.mapping, decode_enum<CheckerTexture::Mapping>(
                      from.mapping(), 0, package::CheckerTexture::Mapping_MAX, field + ".mapping"));
  ASSIGN_OR_RETURN(to.size, vec3(from.size(), field + ".size"));
  ASSIGN_OR_RETURN(to.uv_set, uv_set(from.uv_set(), field));
  ASSIGN_OR_RETURN(to.space, space(from.space(), field));
  return to;
}

absl::StatusOr<NoiseTexture> noise(const package::NoiseTexture& from, const std::string& field) {
  NoiseTexture to;
  ASSIGN_OR_RETURN(to.kind, decode_enum<NoiseTexture::Kind>(
                                from.kind(), 0, package::NoiseTexture::Kind_MAX, field + ".kind"));
  ASSIGN_OR_RETURN(to.space, space(from.space(), field));
  to.octaves = from.octaves();
  to.scale = from.scale();
  to.strength = from.strength();
  to.turbulence_scale = from.turbulence_scale();
  ASSIGN_OR_RETURN(to.axis, vec3(from.axis(), field + ".axis"));
  ASSIGN_OR_RETURN(to.low, decode_rgb(from.low().rgb(), field + ".low"));
  ASSIGN_OR_RETURN(to.high, decode_rgb(from.high().rgb(), field + ".high"));
  return to;
}

absl::StatusOr<RampTexture> ramp(const package::RampTexture& from, const std::string& field) {
  RampTexture to;
  ASSIGN_OR_RETURN(to.over, decode_enum<RampTexture::Over>(
                                from.over(), 0, package::RampTexture::Over_MAX, field + ".over"));
  to.texture = TextureId{from.texture()};
  ASSIGN_OR_RETURN(to.uv_set, uv_set(from.uv_set(), field));
  ASSIGN_OR_RETURN(to.space, space(from.space(), field));
  to.steps = from.steps();
  if (from.color_size() != 3 * from.at_size()) {
    return manifest_error(field + ".color",
                          absl::StrCat("must have 3 numbers a stop, has ", from.color_size(),
                                       " for ", from.at_size(), " stops"));
  }
  for (int i = 0; i < from.at_size(); ++i) {
    to.stops.push_back(
        {from.at(i), {from.color(3 * i), from.color(3 * i + 1), from.color(3 * i + 2)}});
  }
  return to;
}

// Each kind's reader, appended.
template <class T>
absl::Status append(absl::StatusOr<T> texture, std::vector<Texture>& textures) {
  RETURN_IF_ERROR(texture.status());
  textures.emplace_back(*std::move(texture));
  return absl::OkStatus();
}

}  // namespace

absl::Status decode_texture(const package::Texture& from, const std::string& field,
                            std::vector<Texture>& textures) {
  switch (from.kind_case()) {
    case package::Texture::kConstant: {
      ASSIGN_OR_RETURN(const Rgb value, decode_rgb(from.constant().rgb(), field + ".constant.rgb"));
      textures.emplace_back(ConstantTexture{value});
      return absl::OkStatus();
    }
    case package::Texture::kImage:
      return append(image(from.image(), field + ".image"), textures);
    case package::Texture::kChecker:
      return append(checker(from.checker(), field + ".checker"), textures);
    case package::Texture::kNoise:
      return append(noise(from.noise(), field + ".noise"), textures);
    case package::Texture::kRamp:
      return append(ramp(from.ramp(), field + ".ramp"), textures);
    case package::Texture::kMix:
      textures.emplace_back(MixTexture{TextureId{from.mix().a()}, TextureId{from.mix().b()},
                                       TextureId{from.mix().amount()}});
      return absl::OkStatus();
    case package::Texture::kProduct:
      textures.emplace_back(
          ProductTexture{TextureId{from.product().a()}, TextureId{from.product().b()}});
      return absl::OkStatus();
    case package::Texture::KIND_NOT_SET:
      break;
  }
  return manifest_error(field, "is of no kind that this program knows");
}

}  // namespace bandsaw
