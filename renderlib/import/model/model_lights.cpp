// Converts each kind of light that Assimp reads to a delta light (from a point or from one
// direction) at its node.

#include "renderlib/import/model/model_lights.h"

#include <assimp/light.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "renderlib/import/draft/color_limits.h"
#include "renderlib/math/constants.h"
#include "renderlib/math/elementary.h"

namespace bandsaw {
namespace {

Vec3 vector_of(const aiVector3D& v) { return {v.x, v.y, v.z}; }

/// Returns the product of colour and intensity, which is what Assimp stores. glTF's candela and lux
/// become radiant intensity and irradiance unchanged.
Rgb brightness_of(const aiLight& from) {
  const auto channel = [](float value) {
    return std::isfinite(value) ? std::clamp(value, 0.0f, kMaxRadiance) : 0.0f;
  };
  return {channel(from.mColorDiffuse.r), channel(from.mColorDiffuse.g),
          channel(from.mColorDiffuse.b)};
}

/// Returns the intensity of a light at distance 1. In Assimp, the falloff with the distance r is 1
/// / (c + l r + q r^2). If c = l = 0 and q > 0, the light falls off with the square of the
/// distance. Other falloffs are not physical, and few formats have them. They are replaced, with a
/// warning, by a falloff with the square of the distance that has the same intensity at distance 1.
Rgb intensity_of(const aiLight& from, ModelFile& file) {
  const float square = from.mAttenuationQuadratic;
  // `square` is infinite for FBX lights whose decay starts at 0.
  const bool is_square = square > 0 && std::isfinite(square) && from.mAttenuationConstant == 0 &&
                         from.mAttenuationLinear == 0;
  if (is_square) {
    return brightness_of(from) * (1 / square);
  }
  const float at_one = from.mAttenuationConstant + from.mAttenuationLinear + square;
  file.warn(absl::StrCat("the light \"", from.mName.C_Str(),
                         "\" gets a falloff with the square of the distance, with the same ",
                         "intensity at 1 unit"));
  return brightness_of(from) * (at_one > 0 && std::isfinite(at_one) ? 1 / at_one : 1.0f);
}

/// Returns the direction of a light as a unit vector; std::nullopt if the node's transform is
/// singular.
std::optional<Vec3> direction_of(const aiLight& from, const Transform& node) {
  const Vec3 d = node.direction(vector_of(from.mDirection));
  const double size = length(d);
  return size > 0 && std::isfinite(size) ? std::optional(d / size) : std::nullopt;
}

/// Returns the number of directional lights.
std::size_t directional_lights(const Model& model) {
  return static_cast<std::size_t>(std::count_if(
      model.lights.begin(), model.lights.end(),
      [](const DeltaLight& light) { return std::holds_alternative<DirectionalLight>(light); }));
}

/// Returns true if the scene's validation accepts the position (light/check_lights.cpp).
bool is_place(const Vec3& p) { return is_finite(p) && max_abs(p) <= 1e30; }

/// Returns true for formats that measure the angles of a spot light from edge to edge of a cone.
/// Other formats, such as glTF, measure from the axis to the edge. Assimp does not convert the
/// angles.
bool has_whole_angles(const ModelFile& file) {
  constexpr absl::string_view kSuffixes[] = {".fbx", ".dae", ".3ds", ".ase", ".blend"};
  return std::any_of(std::begin(kSuffixes), std::end(kSuffixes), [&](absl::string_view suffix) {
    return absl::EndsWithIgnoreCase(file.path, suffix);
  });
}

/// Makes a spot light. `direction` is a unit vector. The angle from the axis to the edge of each
/// cone is clamped to [0, 90] degrees.
SpotLight spot_of(const aiLight& from, const Vec3& position, const Vec3& direction,
                  const Rgb& intensity, const ModelFile& file) {
  const double share = has_whole_angles(file) ? 0.5 : 1;
  const auto cosine = [&](double angle) {
    return sincos_turns(std::clamp(share * angle, 0.0, kPi / 2) / (2 * kPi)).cos;
  };
  SpotLight spot{position, direction, intensity};
  spot.cos_outer = std::max(0.0, cosine(from.mAngleOuterCone));
  spot.cos_inner = std::max(spot.cos_outer, cosine(from.mAngleInnerCone));
  return spot;
}

}  // namespace

void add_model_light(const aiLight& from, const Transform& node, ModelFile& file, Model& model) {
  const std::optional<Vec3> direction = direction_of(from, node);
  const Vec3 position = node.point(vector_of(from.mPosition));
  const auto leave_out = [&](absl::string_view why) {
    file.warn(absl::StrCat("the light \"", from.mName.C_Str(), "\" is left out: ", why));
  };
  switch (from.mType) {
    case aiLightSource_DIRECTIONAL:
      if (!direction) {
        return leave_out("it has no direction");
      }
      if (directional_lights(model) == kMaxDirectionalLights) {
        return leave_out("there are too many directional lights");
      }
      model.lights.emplace_back(DirectionalLight{*direction, brightness_of(from)});
      return;
    case aiLightSource_POINT:
    case aiLightSource_SPOT:
      if (!is_place(position)) {
        return leave_out("its position is not valid");
      }
      if (from.mType == aiLightSource_POINT) {
        model.lights.emplace_back(PointLight{position, intensity_of(from, file)});
      } else if (direction) {
        model.lights.emplace_back(
            spot_of(from, position, *direction, intensity_of(from, file), file));
      } else {
        leave_out("it has no direction");
      }
      return;
    default:
      return leave_out("it is neither a point, a spot nor a directional light");
  }
}

}  // namespace bandsaw
