// Converts pbrt's media of the kinds homogeneous and uniformgrid. A grid becomes a volume file.
// Media of other kinds are left out with a warning.

#include <algorithm>
#include <cmath>
#include <cstring>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/pbrt/builder.h"

namespace bandsaw::pbrt {
namespace {

/// A medium and what is needed to convert it. Of `state`, only the colour space is used.
struct MediumParts {
  const MediumSource& medium;
  State state;
  Builder& builder;
  const Parameters& parameters() const { return medium.parameters; }
  /// Returns the colour of the parameter `name`; `otherwise` if the parameter is absent.
  absl::StatusOr<Rgb3> read(const std::string& name, const Rgb3& otherwise) const {
    return color(parameters(), name, ColorUse::kUnbounded, otherwise, state, builder);
  }
};

Rgb3 times(const Rgb3& rgb, double factor) {
  return {rgb[0] * factor, rgb[1] * factor, rgb[2] * factor};
}

/// Sets absorption, scattering, phase function and emission, which all media have. `absorption` and
/// `scattering` are pbrt's defaults of these coefficients.
absl::Status read_common(const MediumParts& from, const Rgb3& absorption, const Rgb3& scattering,
                         scene::Medium& to) {
  const Parameters& in = from.parameters();
  ASSIGN_OR_RETURN(const double scale, in.number("scale", 1));
  ASSIGN_OR_RETURN(const Rgb3 sigma_a, from.read("sigma_a", absorption));
  ASSIGN_OR_RETURN(const Rgb3 sigma_s, from.read("sigma_s", scattering));
  ASSIGN_OR_RETURN(const double g, in.number("g", 0));
  if (!(scale >= 0)) {
    return error_at(in.place, "the scale of a medium must not be negative");
  }
  set_rgb(times(sigma_a, scale), to.mutable_absorption());
  set_rgb(times(sigma_s, scale), to.mutable_scattering());
  to.set_anisotropy(std::clamp(g, -0.999, 0.999));
  if (const Parameter* emitted = in.find("Le")) {
    ASSIGN_OR_RETURN(const Rgb3 le,
                     color_of(*emitted, ColorUse::kLight, from.state.color_space, from.builder));
    const Parameter* scales = in.find("Lescale");
    double le_scale = 1;
    if (scales != nullptr && scales->numbers.size() > 1) {
      from.builder.warn(in.place, "the grid Lescale is left out");
    } else {
      ASSIGN_OR_RETURN(le_scale, in.number("Lescale", 1));
    }
    // pbrt multiplies "Le" by the absorption when it renders; Bandsaw's emission is the product.
    Rgb3 emission = {};
    for (std::size_t c = 0; c < 3; ++c) {
      emission[c] = le[c] * le_scale * sigma_a[c] * scale * from.builder.light_factor;
    }
    set_rgb(emission, to.mutable_emission());
  }
  return absl::OkStatus();
}

/// Returns a grid as a file of Mitsuba's format (*.vol): a header of 48 bytes, then float32 values.
std::string volume_file(const std::vector<double>& values, const int size[3], int channels) {
  std::string out = "VOL\x03";
  const auto add = [&out](const auto& value) {
    out.append(reinterpret_cast<const char*>(&value), sizeof(value));
  };
  add(std::int32_t{1});
  for (int k = 0; k < 3; ++k) {
    add(static_cast<std::int32_t>(size[k]));
  }
  add(static_cast<std::int32_t>(channels));
  for (const float corner : {0.0F, 0.0F, 0.0F, 1.0F, 1.0F, 1.0F}) {
    add(corner);
  }
  out.reserve(out.size() + values.size() * sizeof(float));
  for (const double value : values) {
    add(static_cast<float>(value));
  }
  return out;
}

/// Adds the grid `name` of nx x ny x nz numbers in the box from p0 to p1. `to_shape` maps the world
/// to the space of the shape that the medium fills.
absl::Status read_grid(const MediumParts& from, const std::string& name, const Transform& to_shape,
                       scene::VolumeGrid* to) {
  const Parameters& in = from.parameters();
  int size[3] = {};
  const char* names[3] = {"nx", "ny", "nz"};
  for (int k = 0; k < 3; ++k) {
    ASSIGN_OR_RETURN(size[k], in.integer(names[k], 1));
    if (size[k] < 1 || size[k] > 4096) {
      return error_at(in.place, absl::StrCat("\"", names[k], "\" must be in [1, 4096]"));
    }
  }
  ASSIGN_OR_RETURN(const std::vector<double> values, in.numbers(name, {"float"}));
  const std::size_t count = std::size_t{1} * static_cast<std::size_t>(size[0]) *
                            static_cast<std::size_t>(size[1]) * static_cast<std::size_t>(size[2]);
  if (values.size() != count) {
    return error_at(in.place, absl::StrCat("\"", name, "\" must have nx x ny x nz = ", count,
                                           " numbers, has ", values.size()));
  }
  ASSIGN_OR_RETURN(const Vec3 p0, in.point("p0", {0, 0, 0}));
  ASSIGN_OR_RETURN(const Vec3 p1, in.point("p1", {1, 1, 1}));
  to->set_file(from.builder.made.add("volume", ".vol", volume_file(values, size, /*channels=*/1)));
  to->set_unit_box(true);
  const Transform box = translation(p0) * scaling(p1 - p0);
  set_matrix(to_shape * from.medium.to_world * box, to->mutable_matrix());
  return absl::OkStatus();
}

/// Reads a medium whose density is a grid.
absl::Status read_uniform_grid(const MediumParts& from, const Transform& to_shape,
                               scene::Medium& to) {
  RETURN_IF_ERROR(read_common(from, {1, 1, 1}, {1, 1, 1}, to));
  RETURN_IF_ERROR(read_grid(from, "density", to_shape, to.mutable_density_grid()));
  const Parameters& in = from.parameters();
  if (in.find("temperature") != nullptr) {
    RETURN_IF_ERROR(read_grid(from, "temperature", to_shape, to.mutable_temperature_grid()));
    from.builder.warn(in.place, "the grid's emission by temperature is not normalised as in pbrt");
  }
  in.ignore({"temperaturescale", "temperatureoffset"});
  return absl::OkStatus();
}

/// Marks all parameters as used, so that none of them causes a further warning.
void use_all(const Parameters& parameters) {
  for (const Parameter& parameter : parameters.list) {
    parameter.is_used = true;
  }
}

}  // namespace

absl::StatusOr<std::string> medium_name(const std::string& name, const Place& place,
                                        const Transform& to_shape, Builder& builder) {
  const auto found = builder.media.find(name);
  if (found == builder.media.end()) {
    return error_at(place, absl::StrCat("no medium is called \"", name, "\""));
  }
  MediumParts from{found->second, {}, builder};
  from.state.color_space = found->second.color_space;
  const Parameters& in = from.parameters();
  scene::Medium medium;
  if (from.medium.type == "homogeneous") {
    if (in.find("preset") != nullptr) {
      builder.warn_once(in.place, "presets of media are not known here; pbrt's default is taken");
    }
    RETURN_IF_ERROR(read_common(from, {0.0011, 0.0024, 0.014}, {2.55, 3.21, 3.77}, medium));
  } else if (from.medium.type == "uniformgrid") {
    RETURN_IF_ERROR(read_uniform_grid(from, to_shape, medium));
  } else {
    builder.warn_once(in.place,
                      absl::StrCat("the medium \"", name, "\" of kind \"", from.medium.type,
                                   "\" has no counterpart and is left out"));
    use_all(in);
    return std::string();
  }
  // A medium is converted for each shape that it fills. Its unused parameters cause warnings only
  // the first time.
  if (builder.warned.insert(absl::StrCat("medium ", name)).second) {
    builder.warn_of_unused(in);
  }
  const std::string key = absl::StrCat(name, "\n", medium.SerializeAsString());
  const auto [made, is_new] = builder.made_media.emplace(key, name);
  if (is_new) {
    for (int number = 2; !builder.taken_media.insert(made->second).second; ++number) {
      made->second = absl::StrCat(name, "_", number);
    }
    medium.set_name(made->second);
    *builder.out.add_medium() = std::move(medium);
  }
  return made->second;
}

}  // namespace bandsaw::pbrt
