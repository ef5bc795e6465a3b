// Converts the lights and environments of a Mitsuba scene, with one function for each type.
// Environment maps are resampled, because Mitsuba places their first and last row at the poles.

#include "renderlib/import/mitsuba/emitters.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/image/exr.h"
#include "renderlib/import/image/decode_image.h"
#include "renderlib/import/mitsuba/field_of_view.h"
#include "renderlib/import/mitsuba/frame.h"
#include "renderlib/import/mitsuba/textures.h"
#include "renderlib/math/constants.h"
#include "renderlib/math/elementary.h"

namespace bandsaw::mitsuba {
namespace {

/// Appends x, y and z.
void set(const Vec3& v, google::protobuf::RepeatedField<double>* to) {
  to->Add(v.x);
  to->Add(v.y);
  to->Add(v.z);
}

/// Returns the colour of a light from the parameter `name`, each channel >= 0. Returns white if the
/// parameter is absent or, with a warning, a texture.
absl::StatusOr<Rgb> light_color(const Parameters& from, const std::string& name, Conversion& to) {
  const Property* property = from.find(name);
  if (property == nullptr) {
    return gray(1);
  }
  ASSIGN_OR_RETURN(const std::optional<Rgb> color, constant_color(*property, ColorOf::kLight));
  if (!color) {
    to.warn(property->place, absl::StrCat("a texture of \"", name, "\" is shown as white"));
    return gray(1);
  }
  return Rgb{std::max(color->r, 0.0f), std::max(color->g, 0.0f), std::max(color->b, 0.0f)};
}

/// Returns the position and axes of an emitter with the transform `to_world`.
absl::StatusOr<Frame> placed_frame(const Parameters& from) {
  ASSIGN_OR_RETURN(const Transform to_world, from.transform("to_world"));
  if (!inverse(to_world)) {
    return error_at(from.place(), "to_world is singular");
  }
  return frame_of(to_world);
}

// Each function that takes `from`, `scene` and `to` converts the emitter with the parameters
// `from`. It adds a light to `scene` or sets the background. `to` collects warnings and made files.

absl::Status constant(const Parameters& from, scene::Scene& scene, Conversion& to) {
  ASSIGN_OR_RETURN(const Rgb radiance, light_color(from, "radiance", to));
  set_color(radiance, scene.mutable_background()->mutable_constant());
  return absl::OkStatus();
}

absl::Status point(const Parameters& from, scene::Scene& scene, Conversion& to) {
  ASSIGN_OR_RETURN(const Rgb intensity, light_color(from, "intensity", to));
  ASSIGN_OR_RETURN(const Transform to_world, from.transform("to_world"));
  ASSIGN_OR_RETURN(const Vec3 position, from.vector("position", to_world.point({})));
  scene::PointLight& light = *scene.add_light()->mutable_point();
  set(position, light.mutable_position());
  set_color(intensity, light.mutable_intensity());
  return absl::OkStatus();
}

absl::Status directional(const Parameters& from, scene::Scene& scene, Conversion& to) {
  ASSIGN_OR_RETURN(const Rgb irradiance, light_color(from, "irradiance", to));
  ASSIGN_OR_RETURN(const Transform to_world, from.transform("to_world"));
  ASSIGN_OR_RETURN(const Vec3 direction, from.vector("direction", to_world.direction({0, 0, 1})));
  if (!(length(direction) > 0)) {
    return error_at(from.place(), "the direction of a light must not be zero");
  }
  scene::DirectionalLight& light = *scene.add_light()->mutable_directional();
  set(direction, light.mutable_direction());
  set_color(irradiance, light.mutable_irradiance());
  return absl::OkStatus();
}

absl::Status spot(const Parameters& from, scene::Scene& scene, Conversion& to) {
  ASSIGN_OR_RETURN(const Rgb intensity, light_color(from, "intensity", to));
  ASSIGN_OR_RETURN(const Frame frame, placed_frame(from));
  ASSIGN_OR_RETURN(const double cutoff, from.number("cutoff_angle", 20));
  ASSIGN_OR_RETURN(const double beam, from.number("beam_width", cutoff * 3 / 4));
  scene::SpotLight light;
  set(frame.position, light.mutable_position());
  set(frame.ahead, light.mutable_direction());
  set_color(intensity, light.mutable_intensity());
  light.set_inner_angle(std::min(beam, cutoff));
  light.set_outer_angle(cutoff);
  light.set_falloff(scene::SpotLight::FALLOFF_LINEAR_ANGLE);
  if (const Property* image = from.find("texture")) {
    // The frame's x axis points to the left. u increases along x, and v along y.
    const TexturedSurface upright{UvFrame::kSame, {}};
    ASSIGN_OR_RETURN(*light.mutable_image(), texture_of(*image, ColorOf::kLight, upright, to));
    set(frame.up, light.mutable_up());
    light.set_mirrored(!frame.mirrored);
  }
  *scene.add_light()->mutable_spot() = std::move(light);
  return absl::OkStatus();
}

/// Returns width / height of the image of a texture; 1 for other textures, and for an image that
/// cannot be read.
double aspect_of(const scene::Texture& texture, const Files& files) {
  if (!texture.has_image()) {
    return 1;
  }
  const auto file = files.known(texture.image().file());
  std::vector<std::string> ignored;
  const auto bytes = file.ok() ? Files::read(*file, kMaxImageFileBytes) : file.status();
  const auto image = bytes.ok() ? decode_image(*bytes, ignored) : bytes.status();
  return image.ok() ? static_cast<double>(image->width) / image->height : 1;
}

absl::Status projector(const Parameters& from, scene::Scene& scene, Conversion& to) {
  ASSIGN_OR_RETURN(const Frame frame, placed_frame(from));
  ASSIGN_OR_RETURN(const double scale, from.number("scale", 1));
  scene::ProjectorLight light;
  set(frame.position, light.mutable_position());
  set(frame.position + frame.ahead, light.mutable_look_at());
  set(frame.up, light.mutable_up());
  light.set_mirrored(frame.mirrored);
  const TexturedSurface flipped{UvFrame::kFlipped, {}};
  if (const Property* image = from.find("irradiance")) {
    ASSIGN_OR_RETURN(*light.mutable_image(), texture_of(*image, ColorOf::kLight, flipped, to));
  } else {
    *light.mutable_image() = constant_texture(gray(1));
  }
  // The image is seen as from a camera: its top row is up.
  const double aspect = aspect_of(light.image(), to.files);
  ASSIGN_OR_RETURN(const double half_height, half_height_of_view(from, aspect));
  light.set_vertical_fov(vertical_fov(half_height));
  light.set_aspect(aspect);
  // With the factor pi, a white surface perpendicular to the light shows the image.
  set_color(gray(static_cast<float>(kPi * scale)), light.mutable_intensity());
  from.ignore({"near_clip", "far_clip"});
  *scene.add_light()->mutable_projector() = std::move(light);
  return absl::OkStatus();
}

/// Appends the rotation of a transform that only rotates. Appends nothing if the angle is 0.
void add_rotation(const Transform& turn, google::protobuf::RepeatedPtrField<scene::Rotation>* to) {
  const Vec3 twice_sine_axis{turn.m[2][1] - turn.m[1][2], turn.m[0][2] - turn.m[2][0],
                             turn.m[1][0] - turn.m[0][1]};
  const double cosine = (turn.m[0][0] + turn.m[1][1] + turn.m[2][2] - 1) / 2;
  const double sine = length(twice_sine_axis) / 2;
  const double degrees = atan2(sine, cosine) * 180 / kPi;
  if (degrees < 1e-12) {
    return;
  }
  Vec3 axis = twice_sine_axis;
  if (sine < 1e-6) {  // half a turn R around the axis a: R + 1 = 2 a a^T
    const Vec3 columns[] = {{turn.m[0][0] + 1, turn.m[1][0], turn.m[2][0]},
                            {turn.m[0][1], turn.m[1][1] + 1, turn.m[2][1]},
                            {turn.m[0][2], turn.m[1][2], turn.m[2][2] + 1}};
    axis = *std::max_element(std::begin(columns), std::end(columns),
                             [](const Vec3& a, const Vec3& b) { return length(a) < length(b); });
  }
  scene::Rotation& rotation = *to->Add();
  set(normalize(axis), rotation.mutable_axis());
  rotation.set_degrees(degrees);
}

/// Returns the factor by which the number of rows of an environment grows when it is resampled. The
/// new rows lie between those of Mitsuba, so each look-up interpolates twice, which blurs the image
/// by 1 / factor of a row. Large images, whose rows are narrow, get a smaller factor.
std::uint32_t rows_for_one(const Image& image) {
  constexpr std::size_t kTexels = std::size_t{1} << 22;
  return static_cast<std::uint32_t>(
      std::clamp<std::size_t>(kTexels / (std::size_t{image.width} * image.height), 2, 8));
}

/// Resamples the rows of an environment map, which MUST have at least two rows. In Mitsuba, the
/// centres of the first and last row are at the poles. In the result, the outer edges of the first
/// and last row are at the poles. `mirrored` exchanges left and right.
Image with_rows_between_poles(const Image& from, bool mirrored) {
  Image to{from.width, rows_for_one(from) * from.height, {}};
  to.pixels.resize(std::size_t{to.width} * to.height);
  for (std::uint32_t row = 0; row < to.height; ++row) {
    const double at = (row + 0.5) / to.height * (from.height - 1);
    const auto above = std::min(static_cast<std::uint32_t>(at), from.height - 2);
    const auto share = static_cast<float>(at - above);
    for (std::uint32_t column = 0; column < to.width; ++column) {
      const std::uint32_t source = mirrored ? to.width - 1 - column : column;
      const Rgb& a = from.pixels[std::size_t{above} * from.width + source];
      const Rgb& b = from.pixels[std::size_t{above + 1} * from.width + source];
      to.pixels[std::size_t{row} * to.width + column] = a * (1 - share) + b * share;
    }
  }
  return to;
}

absl::Status environment(const Parameters& from, scene::Scene& scene, Conversion& to) {
  ASSIGN_OR_RETURN(const std::string name, from.text("filename", ""));
  ASSIGN_OR_RETURN(const double scale, from.number("scale", 1));
  ASSIGN_OR_RETURN(const Frame frame, placed_frame(from));
  from.ignore({"mis_compensation"});
  const auto file = to.files.find(name);
  if (!file.ok()) {
    if (!absl::IsNotFound(file.status())) {
      return at_place(from.place(), file.status());
    }
    to.warn(from.place(),
            absl::StrCat(file.status().message(), "; a grey environment stands in its place"));
    set_color(gray(static_cast<float>(0.5 * scale)),
              scene.mutable_background()->mutable_constant());
    return absl::OkStatus();
  }
  ASSIGN_OR_RETURN(const std::string bytes, Files::read(*file, kMaxImageFileBytes));
  const auto image = decode_picture(bytes);
  if (!image.ok()) {
    return at_place(from.place(), absl::InvalidArgumentError(absl::StrCat(
                                      "\"", file->name, "\": ", image.status().message())));
  }
  scene::EnvironmentMap& map = *scene.mutable_background()->mutable_environment();
  map.set_file(file->name);
  if (image->height >= 2) {
    ASSIGN_OR_RETURN(const std::vector<std::byte> made,
                     encode_exr(with_rows_between_poles(*image, frame.mirrored), /*half=*/false));
    map.set_file(to.made.add("environment", ".exr",
                             std::string(reinterpret_cast<const char*>(made.data()), made.size())));
  }
  if (scale != 1) {
    map.set_strength(std::clamp(scale, 0.0, 1e6));
  }
  if (frame.skewed) {
    to.warn(from.place(), "an environment with unequal scale or shear is shown without them");
  }
  // In Mitsuba, the centre of the image is in direction z, and its right half in direction -x. In
  // Bandsaw, the centre is in direction x, and the right half in direction z.
  scene::Rotation& ours = *map.add_rotate();
  set({0, 1, 0}, ours.mutable_axis());
  ours.set_degrees(-90);
  // The following axes are always right-handed. If the transform mirrors, x is opposite to the
  // transform's x axis, which is why the image was mirrored.
  const Vec3 z = frame.ahead;
  const Vec3 y = normalize(frame.up - z * dot(frame.up, z));
  const Vec3 x = cross(y, z);
  add_rotation(Transform{{{{x.x, y.x, z.x, 0}, {x.y, y.y, z.y, 0}, {x.z, y.z, z.z, 0}}}},
               map.mutable_rotate());
  return absl::OkStatus();
}

absl::Status sky(const Parameters& from, scene::Scene& scene, Conversion& to) {
  to.warn(from.place(), absl::StrCat("emitter \"", from.object().type,
                                     "\" is shown as a gradient from white to blue, with y "
                                     "as the upward axis instead of z"));
  scene::Gradient& gradient = *scene.mutable_background()->mutable_gradient();
  set_color(gray(1), gradient.mutable_bottom());
  set_color({0.5f, 0.7f, 1}, gradient.mutable_top());
  for (const Property* unused : from.unused()) {
    from.ignore({unused->name.c_str()});
  }
  return absl::OkStatus();
}

}  // namespace

absl::Status add_emitter(const Object& emitter, scene::Scene& scene, Conversion& to) {
  using Add = absl::Status (*)(const Parameters&, scene::Scene&, Conversion&);
  static const std::map<std::string, Add> kinds = {
      {"constant", constant}, {"envmap", environment},
      {"point", point},       {"directional", directional},
      {"spot", spot},         {"projector", projector},
      {"sunsky", sky},        {"sky", sky},
      {"sun", sky},           {"timed_sunsky", sky},
      {"avg_sunsky", sky}};
  const auto kind = kinds.find(emitter.type);
  if (kind == kinds.end()) {
    to.warn(emitter.place,
            absl::StrCat("emitter \"", emitter.type, "\" is not known and is left out"));
    return absl::OkStatus();
  }
  const Parameters from(emitter);
  from.ignore({"sampling_weight"});
  RETURN_IF_ERROR(kind->second(from, scene, to));
  to.warn_of_unused(from);
  return absl::OkStatus();
}

}  // namespace bandsaw::mitsuba
