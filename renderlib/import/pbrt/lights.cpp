// Converts the lights of pbrt that have no shape: distant, point, spot, goniometric, projection and
// infinite.

#include <algorithm>
#include <cmath>
#include <span>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/image/write_image.h"
#include "renderlib/import/image/decode_image.h"
#include "renderlib/import/pbrt/builder.h"
#include "renderlib/import/pbrt/octahedral.h"
#include "renderlib/math/constants.h"
#include "renderlib/math/elementary.h"

namespace bandsaw::pbrt {
namespace {

/// A LightSource directive.
struct LightSource {
  const Parameters& parameters;
  const State& state;
  Builder& builder;

  const Place& place() const { return parameters.place; }
  const Transform& to_world() const { return state.transforms[0]; }
  /// Returns the colour `name` times the light's scale, `factor` and the film's factor.
  absl::StatusOr<Rgb3> light(const std::string& name, double factor = 1) const {
    ASSIGN_OR_RETURN(Rgb3 rgb,
                     color(parameters, name, ColorUse::kLight, {1, 1, 1}, state, builder));
    ASSIGN_OR_RETURN(const double scale, parameters.number("scale", 1));
    for (double& channel : rgb) {
      channel = std::max(0.0, channel * scale * factor * builder.light_factor);
    }
    return rgb;
  }
  /// The parameter `wanted` ("power" or "illuminance") states the power or illuminance of the
  /// light. Returns the factor that scales the light to this value; 1 if the parameter is absent.
  /// `own` is the power or illuminance that the light has if its luminance is 1.
  absl::StatusOr<double> factor_for(const std::string& wanted, double own) const {
    ASSIGN_OR_RETURN(const double value, parameters.number(wanted, -1));
    if (!(value > 0)) {
      return 1;
    }
    // The power or illuminance of an RGB light is proportional to the luminance of its colour.
    const Parameter* rgb =
        parameters.find("I") != nullptr ? parameters.find("I") : parameters.find("L");
    if (rgb != nullptr && rgb->type == "rgb" && rgb->numbers.size() == 3) {
      const double y = spectrum::luminance({rgb->numbers[0], rgb->numbers[1], rgb->numbers[2]});
      own *= y > 0 ? y : 1;
    }
    return value / own;
  }
};

/// Returns the image as the bytes of an EXR file; "" if it cannot be encoded.
std::string encoded(const Image& image) {
  const auto bytes = encode_image(image, ImageFormat::kExr);
  return bytes.ok() ? std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size())
                    : std::string();
}

/// Returns the image in `file`. If the file is missing, returns std::nullopt after a warning that
/// ends with `instead`.
absl::StatusOr<std::optional<Image>> read_picture(const std::string& file, const LightSource& from,
                                                  absl::string_view instead) {
  ASSIGN_OR_RETURN(const auto bytes, read_or_warn(file, from.place(), instead, from.builder));
  if (!bytes) {
    return std::nullopt;
  }
  auto picture = decode_picture(*bytes);
  if (!picture.ok()) {
    return error_at(from.place(), absl::StrCat("\"", file, "\": ", picture.status().message()));
  }
  return *std::move(picture);
}

/// Returns the point of the parameter `name`, in world space.
absl::StatusOr<Vec3> point(const LightSource& from, const std::string& name,
                           const Vec3& otherwise) {
  ASSIGN_OR_RETURN(const Vec3 p, from.parameters.point(name, otherwise));
  return from.to_world().point(p);
}

absl::Status distant(const LightSource& from) {
  ASSIGN_OR_RETURN(const Vec3 start, point(from, "from", {0, 0, 0}));
  ASSIGN_OR_RETURN(const Vec3 end, point(from, "to", {0, 0, 1}));
  ASSIGN_OR_RETURN(const double factor, from.factor_for("illuminance", 1));
  ASSIGN_OR_RETURN(const Rgb3 irradiance, from.light("L", factor));
  if (start == end) {
    return error_at(from.place(), "\"from\" and \"to\" must differ");
  }
  auto* light = from.builder.out.add_light()->mutable_directional();
  set_vec3(end - start, light->mutable_direction());
  set_rgb(irradiance, light->mutable_irradiance());
  return absl::OkStatus();
}

/// Adds a point light. The intensity is multiplied by `mean_of_image`, the mean of the image of a
/// goniometric light (1 for a point light). `own_power` is the power of the light if the parameter
/// I has luminance 1.
absl::Status point_light(const LightSource& from, double mean_of_image, double own_power) {
  ASSIGN_OR_RETURN(const Vec3 position, point(from, "from", {0, 0, 0}));
  ASSIGN_OR_RETURN(const double factor, from.factor_for("power", own_power));
  ASSIGN_OR_RETURN(const Rgb3 intensity, from.light("I", factor * mean_of_image));
  auto* light = from.builder.out.add_light()->mutable_point();
  set_vec3(position, light->mutable_position());
  set_rgb(intensity, light->mutable_intensity());
  return absl::OkStatus();
}

absl::Status spot(const LightSource& from) {
  ASSIGN_OR_RETURN(const Vec3 position, point(from, "from", {0, 0, 0}));
  ASSIGN_OR_RETURN(const Vec3 target, point(from, "to", {0, 0, 1}));
  ASSIGN_OR_RETURN(double cone, from.parameters.number("coneangle", 30));
  ASSIGN_OR_RETURN(const double delta, from.parameters.number("conedeltaangle", 5));
  if (position == target) {
    return error_at(from.place(), "\"from\" and \"to\" must differ");
  }
  if (!(cone > 0 && cone <= 90)) {
    from.builder.warn(from.place(), "the cone of a spot is at most 90 degrees here");
    cone = std::clamp(cone, 1e-3, 90.0);
  }
  const double inner = std::clamp(cone - delta, 0.0, cone);
  const double cos_inner = sincos_degrees(inner).cos;
  const double cos_outer = sincos_degrees(cone).cos;
  // The power for intensity 1 within the inner cone. Between the two cones the intensity falls to
  // 0; its mean there is 1/2.
  const double own = 2 * kPi * ((1 - cos_inner) + (cos_inner - cos_outer) / 2);
  ASSIGN_OR_RETURN(const double factor, from.factor_for("power", own));
  ASSIGN_OR_RETURN(const Rgb3 intensity, from.light("I", factor));
  auto* light = from.builder.out.add_light()->mutable_spot();
  set_vec3(position, light->mutable_position());
  set_vec3(target, light->mutable_look_at());
  set_rgb(intensity, light->mutable_intensity());
  light->set_inner_angle(inner);
  light->set_outer_angle(cone);
  light->set_falloff(scene::SpotLight::FALLOFF_SMOOTH);
  return absl::OkStatus();
}

/// Returns the mean colour of the pixels.
Rgb3 mean_of(const Image& image) {
  Rgb3 sum = {};
  for (const Rgb& pixel : image.pixels) {
    sum[0] += pixel.r;
    sum[1] += pixel.g;
    sum[2] += pixel.b;
  }
  const auto count = static_cast<double>(std::max<std::size_t>(image.pixels.size(), 1));
  return {sum[0] / count, sum[1] / count, sum[2] / count};
}

absl::Status goniometric(const LightSource& from) {
  ASSIGN_OR_RETURN(const std::string file, from.parameters.text("filename", ""));
  double mean = 1;
  if (!file.empty()) {
    ASSIGN_OR_RETURN(const auto image,
                     read_picture(file, from, "the light is the same in all directions"));
    mean = image ? spectrum::luminance(mean_of(*image)) : 1;
    from.builder.warn(from.place(),
                      "a goniometric light shines with its mean intensity in all directions");
  }
  return point_light(from, mean, 4 * kPi * mean);
}

/// A light that projects an image. In pbrt the radiant intensity in each direction is the image; in
/// Bandsaw it is the image times 1 / cos^3 of the angle to the axis. So the image is multiplied by
/// cos^3.
absl::Status projection(const LightSource& from) {
  const Parameters& in = from.parameters;
  ASSIGN_OR_RETURN(const std::string file, in.text("filename", ""));
  ASSIGN_OR_RETURN(const double fov, in.number("fov", 90));
  if (!(fov > 0 && fov < 180)) {
    return error_at(from.place(), "\"fov\" must be in (0, 180)");
  }
  ASSIGN_OR_RETURN(auto image, read_picture(file, from, "the light is left out"));
  if (!image) {
    in.ignore({"I", "scale", "power"});
    return absl::OkStatus();
  }
  const double half = tan_degrees(fov / 2);
  const double width = image->width;
  const double height = image->height;
  const double side = std::min(width, height);
  const double half_height = half * height / side;
  double power = 0;
  // `cell` is the area of a pixel at distance 1. Times cos^3 of the angle to the axis, it is the
  // solid angle of the pixel.
  const double cell = 4 * half * half / (side * side);
  for (std::size_t y = 0; y < image->height; ++y) {
    for (std::size_t x = 0; x < image->width; ++x) {
      const double px = (2 * (static_cast<double>(x) + 0.5) - width) / side * half;
      const double py = (2 * (static_cast<double>(y) + 0.5) - height) / side * half;
      const double cosine = 1 / std::sqrt(1 + px * px + py * py);
      const auto factor = static_cast<float>(cosine * cosine * cosine);
      Rgb& pixel = image->pixels[y * image->width + x];
      pixel = {pixel.r * factor, pixel.g * factor, pixel.b * factor};
      power += spectrum::luminance({pixel.r, pixel.g, pixel.b}) * cell;
    }
  }
  ASSIGN_OR_RETURN(const double factor, from.factor_for("power", std::max(power, 1e-12)));
  ASSIGN_OR_RETURN(const Rgb3 intensity, from.light("I", factor));
  auto* light = from.builder.out.add_light()->mutable_projector();
  const Transform& to_world = from.to_world();
  set_vec3(to_world.point({0, 0, 0}), light->mutable_position());
  set_vec3(to_world.point({0, 0, 1}), light->mutable_look_at());
  // The top of the image is towards +y of the light, and the right side towards +x. Without a
  // mirror the right side would be towards cross(z, y) = -x.
  set_vec3(to_world.direction({0, 1, 0}), light->mutable_up());
  light->set_mirrored(determinant(to_world) > 0);
  light->set_vertical_fov(2 * atan2(half_height, 1) * 180 / kPi);
  set_rgb(intensity, light->mutable_intensity());
  auto* texture = light->mutable_image()->mutable_image();
  texture->set_file(from.builder.made.add("projection", ".exr", encoded(*image)));
  texture->set_wrap(scene::ImageTexture::WRAP_CLAMP);
  return absl::OkStatus();
}

/// Adds light from everywhere to the background. If the background is an image, leaves the light
/// out, with a warning.
void add_constant(const Rgb3& radiance, const LightSource& from) {
  scene::Background& background = *from.builder.out.mutable_background();
  if (background.has_environment()) {
    from.builder.warn(from.place(),
                      "another infinite light has an image; this infinite light is left out");
    return;
  }
  Rgb3 sum = radiance;
  for (int c = 0; c < background.constant().rgb_size(); ++c) {
    sum[static_cast<std::size_t>(c)] += background.constant().rgb(c);
  }
  set_rgb(sum, background.mutable_constant());
}

absl::Status infinite(const LightSource& from) {
  const Parameters& in = from.parameters;
  ASSIGN_OR_RETURN(const std::string file, in.text("filename", ""));
  if (in.find("portal") != nullptr) {
    from.builder.warn(from.place(), "light comes from everywhere, not through the portal alone");
  }
  std::optional<Image> image;
  if (!file.empty()) {
    ASSIGN_OR_RETURN(image, read_picture(file, from, "a uniform sky of radiance 1 stands for it"));
  }
  if (!image) {
    ASSIGN_OR_RETURN(const double factor, from.factor_for("illuminance", kPi));
    ASSIGN_OR_RETURN(const Rgb3 radiance, from.light("L", factor));
    add_constant(radiance, from);
    return absl::OkStatus();
  }
  const bool is_square = image->width == image->height;
  if (!is_square) {
    from.builder.warn(from.place(), absl::StrCat("\"", file,
                                                 "\" is not square: it is taken as longitude and "
                                                 "latitude around z"));
  }
  const Sky sky{*image, is_square};
  ASSIGN_OR_RETURN(const double factor, from.factor_for("illuminance", illuminance_of(sky)));
  const auto to_light = inverse(from.to_world());
  if (!to_light) {
    return error_at(from.place(), "the light's transformation is singular");
  }
  ASSIGN_OR_RETURN(const Rgb3 scale, from.light("L", factor));
  scene::Background& background = *from.builder.out.mutable_background();
  if (background.kind_case() != scene::Background::KIND_NOT_SET) {
    from.builder.warn(from.place(), "of several infinite lights only the last is shown");
  }
  auto* environment = background.mutable_environment();
  environment->set_file(
      from.builder.made.add("environment", ".exr", encoded(equirectangular(sky, *to_light))));
  environment->set_strength(std::clamp(spectrum::luminance(scale), 0.0, 1e6));
  return absl::OkStatus();
}

}  // namespace

absl::Status add_light(const std::string& type, const Parameters& parameters, const State& state,
                       Builder& builder) {
  const LightSource from{parameters, state, builder};
  absl::Status status = absl::OkStatus();
  if (builder.group != nullptr) {
    builder.warn(parameters.place, "a light within an object is placed once, where it is written");
  }
  if (type == "distant") {
    status = distant(from);
  } else if (type == "point") {
    status = point_light(from, /*mean_of_image=*/1, /*own_power=*/4 * kPi);
  } else if (type == "spot") {
    status = spot(from);
  } else if (type == "infinite") {
    status = infinite(from);
  } else if (type == "goniometric") {
    status = goniometric(from);
  } else if (type == "projection") {
    status = projection(from);
  } else {
    return error_at(parameters.place, absl::StrCat("the light \"", type, "\" is not known"));
  }
  RETURN_IF_ERROR(status);
  builder.warn_of_unused(parameters);
  return absl::OkStatus();
}

}  // namespace bandsaw::pbrt
