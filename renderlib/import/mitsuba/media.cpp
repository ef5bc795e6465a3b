// Converts the media of a Mitsuba scene. MediumReader reads the coefficients of a medium, each a
// colour or a grid, and its phase function. Media::medium_of() makes each medium once, or once for
// each placement if it has a grid.

#include "renderlib/import/mitsuba/media.h"

#include <algorithm>
#include <optional>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/mitsuba/textures.h"

namespace bandsaw::mitsuba {
namespace {

/// A coefficient: a colour, or a grid of numbers.
struct Coefficient {
  Rgb color{1, 1, 1};
  std::optional<scene::VolumeGrid> grid = std::nullopt;
};

/// Reads one medium inside a shape.
class MediumReader {
 public:
  /// `to_world` is the placement of the shape around the medium.
  MediumReader(const Transform& to_world, Conversion& to) : to_world_(to_world), to_(to) {}

  /// Fills `medium` from the parameters `from` of Mitsuba's medium.
  absl::Status read(const Parameters& from, scene::Medium& medium) {
    ASSIGN_OR_RETURN(const double scale, from.number("scale", 1));
    from.ignore({"sample_emitters", "has_spectral_extinction", "majorant_resolution_factor",
                 "majorant_factor", "method", "step_size"});
    RETURN_IF_ERROR(read_phase(from, medium));
    if (from.has("sigma_a") || from.has("sigma_s")) {
      ASSIGN_OR_RETURN(const Coefficient absorbs, coefficient(from, "sigma_a", 0));
      ASSIGN_OR_RETURN(const Coefficient scatters, coefficient(from, "sigma_s", 0));
      if (absorbs.grid || scatters.grid) {
        return error_at(from.place(),
                        "sigma_a and sigma_s cannot be grids; write sigma_t and albedo instead");
      }
      return set_colors(absorbs.color, scatters.color, scale, medium);
    }
    const char* name = from.has("density") ? "density" : "sigma_t";  // "density": version 0.x
    ASSIGN_OR_RETURN(const Coefficient extinction, coefficient(from, name, 1));
    ASSIGN_OR_RETURN(const Coefficient albedo, coefficient(from, "albedo", 0.75f));
    if (!extinction.grid && !albedo.grid) {
      const Rgb scatters = extinction.color * albedo.color;
      return set_colors(extinction.color + scatters * -1.0f, scatters, scale, medium);
    }
    return set_grids(from, extinction, albedo, scale, medium);
  }

 private:
  /// Sets absorption and scattering as colours, both multiplied by `scale`.
  static absl::Status set_colors(const Rgb& absorbs, const Rgb& scatters, double scale,
                                 scene::Medium& medium) {
    const auto not_negative = [](float c) { return std::max(c, 0.0f); };
    set_color({not_negative(absorbs.r), not_negative(absorbs.g), not_negative(absorbs.b)},
              medium.mutable_absorption());
    set_color(scatters, medium.mutable_scattering());
    medium.set_density(scale);
    return absl::OkStatus();
  }

  /// Sets the density and the albedo, of which at least one is a grid. A density without a grid
  /// is one number, so a coloured extinction becomes its mean, with a warning.
  absl::Status set_grids(const Parameters& from, const Coefficient& extinction,
                         const Coefficient& albedo, double scale, scene::Medium& medium) {
    double density = scale;
    if (extinction.grid) {
      *medium.mutable_density_grid() = *extinction.grid;
    } else {
      const Rgb& c = extinction.color;
      if (c.r != c.g || c.g != c.b) {
        to_.warn(from.place(),
                 "the coloured extinction of a medium with an albedo grid is shown as its mean");
      }
      density *= (double{c.r} + c.g + c.b) / 3;
    }
    if (albedo.grid) {
      *medium.mutable_albedo_grid() = *albedo.grid;
    } else {
      set_color(albedo.color, medium.mutable_albedo());
    }
    medium.set_density(density);
    return absl::OkStatus();
  }

  /// Reads the phase function. Any type except hg becomes isotropic, with a warning for an unknown
  /// type.
  absl::Status read_phase(const Parameters& from, scene::Medium& medium) {
    for (const Property* property : from.objects("phase")) {
      const Object& phase = **std::get_if<const Object*>(&property->value);
      const Parameters parameters(phase);
      if (phase.type == "hg") {
        ASSIGN_OR_RETURN(const double g, parameters.number("g", 0.8));
        medium.set_anisotropy(std::clamp(g, -0.999, 0.999));
      } else if (phase.type != "isotropic") {
        to_.warn(phase.place,
                 absl::StrCat("phase function \"", phase.type, "\" is shown as \"isotropic\""));
        continue;
      }
      to_.warn_of_unused(parameters);
    }
    return absl::OkStatus();
  }

  /// Reads the parameter `name`, a colour or a volume. An absent parameter is a grey of
  /// `otherwise`.
  absl::StatusOr<Coefficient> coefficient(const Parameters& from, const std::string& name,
                                          float otherwise) {
    const Property* property = from.find(name);
    if (property == nullptr) {
      return Coefficient{gray(otherwise)};
    }
    const auto* const* object = std::get_if<const Object*>(&property->value);
    if (object != nullptr && (*object)->tag == "volume") {
      return volume(**object);
    }
    ASSIGN_OR_RETURN(const std::optional<Rgb> color, constant_color(*property, ColorOf::kSurface));
    if (!color) {
      return error_at(property->place, absl::StrCat("\"", name, "\" must be a colour or a volume"));
    }
    return Coefficient{*color};
  }

  /// Reads a volume, which is constant or a grid. A volume of unknown type becomes the constant 1,
  /// with a warning.
  absl::StatusOr<Coefficient> volume(const Object& object) {
    const Parameters from(object);
    Coefficient out;
    if (object.type == "constvolume") {
      from.ignore({"to_world"});
      const Property* value = from.find("value");
      if (value != nullptr) {
        ASSIGN_OR_RETURN(const std::optional<Rgb> color, constant_color(*value, ColorOf::kSurface));
        out.color = color.value_or(gray(1));
      }
    } else if (object.type == "gridvolume") {
      ASSIGN_OR_RETURN(out.grid, grid(from));
    } else {
      to_.warn(object.place, absl::StrCat("volume \"", object.type,
                                          "\" is not known; the constant 1 stands in its place"));
      return out;
    }
    to_.warn_of_unused(from);
    return out;
  }

  /// Reads a gridvolume. The matrix of the result maps from the grid to the space of the shape
  /// around the medium.
  absl::StatusOr<scene::VolumeGrid> grid(const Parameters& from) {
    scene::VolumeGrid to;
    ASSIGN_OR_RETURN(const std::string name, from.text("filename", ""));
    const auto file = to_.files.find(name);
    if (!file.ok()) {
      return at_place(from.place(), file.status());
    }
    to.set_file(file->name);
    ASSIGN_OR_RETURN(const bool own_box, from.boolean("use_grid_bbox", false));
    to.set_unit_box(!own_box);
    ASSIGN_OR_RETURN(const std::string filter, from.text("filter_type", "trilinear"));
    if (filter == "nearest") {
      to.set_filter(scene::VolumeGrid::FILTER_NEAREST);
    }
    ASSIGN_OR_RETURN(const std::string wrap, from.text("wrap_mode", "clamp"));
    if (wrap != "clamp") {
      to_.warn(from.place(), absl::StrCat("wrap_mode \"", wrap, "\" of a grid is shown as clamp"));
    }
    to.set_clamp(true);
    from.ignore({"raw", "accel"});
    ASSIGN_OR_RETURN(const Transform placed, from.transform("to_world"));
    const auto to_shape = inverse(to_world_);
    if (!to_shape) {
      return error_at(from.place(), "the shape around the medium has a singular transform");
    }
    const Transform matrix = *to_shape * placed;
    if (!(matrix == Transform{})) {
      for (const auto& row : matrix.m) {
        for (const double entry : row) {
          to.add_matrix(entry);
        }
      }
    }
    return to;
  }

  const Transform& to_world_;
  Conversion& to_;
};

/// Returns true if a parameter of the medium is a volume.
bool has_grid(const Object& medium) {
  return std::any_of(medium.properties.begin(), medium.properties.end(), [](const Property& p) {
    const auto* const* object = std::get_if<const Object*>(&p.value);
    return object != nullptr && (*object)->tag == "volume";
  });
}

}  // namespace

absl::StatusOr<std::string> Media::medium_of(const Object& medium, const Transform& to_world) {
  // Only a medium with a grid depends on the placement of its shape.
  const std::pair key(&medium, has_grid(medium) ? to_world.m : Transform{}.m);
  const auto known = known_.find(key);
  if (known != known_.end()) {
    return known->second;
  }
  if (medium.type != "homogeneous" && medium.type != "heterogeneous") {
    return error_at(medium.place,
                    absl::StrCat("medium \"", medium.type,
                                 "\" is not known; it must be homogeneous or heterogeneous"));
  }
  const Parameters from(medium);
  scene::Medium out;
  RETURN_IF_ERROR(MediumReader(to_world, to_).read(from, out));
  to_.warn_of_unused(from);
  const std::string base = medium.id.empty() ? "medium" : medium.id;
  const int number = ++names_[base];
  out.set_name(number == 1 ? base : absl::StrCat(base, " ", number));
  known_.emplace(key, out.name());
  *scene_.add_medium() = out;
  return out.name();
}

}  // namespace bandsaw::mitsuba
