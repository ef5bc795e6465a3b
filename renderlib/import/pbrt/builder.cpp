// Helps all parts of the conversion of a pbrt scene: converts colours and spectra of parameters to
// linear RGB, writes values into the protobuf messages of our scene file, and stores warnings.

#include "renderlib/import/pbrt/builder.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "renderlib/base/file.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::pbrt {
namespace {

constexpr std::size_t kMaxWarnings = 1000;
constexpr std::uint64_t kMaxImageBytes = std::uint64_t{1} << 30;

struct ColorSpace {
  const char* name;
  double to_srgb[3][3];  ///< matrix to linear sRGB; maps white to white
};
constexpr ColorSpace kColorSpaces[] = {
    {"srgb", {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
    {"rec2020",
     {{1.6605, -0.5876, -0.0728}, {-0.1246, 1.1329, -0.0083}, {-0.0182, -0.1006, 1.1187}}},
    {"dci-p3", {{1.2249, -0.2247, 0}, {-0.0420, 1.0419, 0}, {-0.0197, -0.0786, 1.0979}}},
    {"aces2065-1",
     {{2.52169, -1.13413, -0.38756},
      {-0.27648, 1.37272, -0.09624},
      {-0.01538, -0.15298, 1.16835}}}};

/// Converts linear RGB from the colour space `space` to linear sRGB.
Rgb3 in_srgb(const Rgb3& rgb, const std::string& space) {
  for (const ColorSpace& known : kColorSpaces) {
    if (space == known.name && space != "srgb") {
      Rgb3 out = {};
      for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t k = 0; k < 3; ++k) {
          out[row] += known.to_srgb[row][k] * rgb[k];
        }
      }
      return out;
    }
  }
  return rgb;
}

/// Returns the colour of a spectrum. For a light, the spectrum is scaled to luminance 1.
Rgb3 of_spectrum(const spectrum::Sampled& sampled, ColorUse use) {
  return use == ColorUse::kLight ? spectrum::light_rgb_of_luminance_1(sampled)
                                 : spectrum::factor_rgb(sampled);
}

/// Clamps each channel to [0, 1] for a reflectance, and to [0, 1e12] for other uses. Warns if a
/// channel is above this range.
Rgb3 clamped(Rgb3 rgb, ColorUse use, const Parameter& parameter, Builder& builder) {
  const double most = use == ColorUse::kReflectance ? 1 : 1e12;
  if (*std::max_element(rgb.begin(), rgb.end()) > most + 1e-6) {
    builder.warn(parameter.place, absl::StrCat("\"", parameter.name, "\" is above ", most, "; ",
                                               most, " is used instead"));
  }
  for (double& channel : rgb) {
    channel = std::clamp(channel, 0.0, most);
  }
  return rgb;
}

}  // namespace

void Extent::add(const Vec3& p) {
  low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
  high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
}

void Builder::warn(const Place& place, absl::string_view what) {
  if (warnings.size() < kMaxWarnings) {
    warnings.push_back(absl::StrCat(text_of(place), ": ", what));
  }
}

void Builder::warn_once(const Place& place, absl::string_view what) {
  if (warned.emplace(what).second) {
    warn(place, what);
  }
}

void Builder::warn_of_unused(const Parameters& parameters) {
  for (const Parameter& parameter : parameters.list) {
    if (!parameter.is_used) {
      warn(parameter.place, absl::StrCat("the parameter \"", parameter.type, " ", parameter.name,
                                         "\" is not known here and is left out"));
    }
  }
}

void set_rgb(const Rgb3& rgb, scene::Color* to) {
  to->clear_rgb();
  for (const double channel : rgb) {
    to->add_rgb(channel);
  }
}

scene::Texture constant_texture(const Rgb3& rgb) {
  scene::Texture texture;
  set_rgb(rgb, texture.mutable_color());
  return texture;
}

void set_matrix(const Transform& t, google::protobuf::RepeatedField<double>* to) {
  to->Clear();
  for (const auto& row : t.m) {
    to->Add(row.begin(), row.end());
  }
}

void set_vec3(const Vec3& v, google::protobuf::RepeatedField<double>* to) {
  to->Clear();
  to->Add(v.x);
  to->Add(v.y);
  to->Add(v.z);
}

absl::StatusOr<std::optional<std::string>> read_or_warn(const std::string& name, const Place& place,
                                                        absl::string_view instead,
                                                        Builder& builder) {
  const SceneFolder& folder = builder.from.folder;
  const auto path = folder.resolve(name, folder.path());
  if (absl::IsNotFound(path.status())) {
    builder.warn(place, absl::StrCat("the file \"", name, "\" is missing; ", instead));
    return std::nullopt;
  }
  const auto at_place = [&](const absl::Status& status) {
    return absl::Status(status.code(), absl::StrCat(text_of(place), ": ", status.message()));
  };
  if (!path.ok()) {
    return at_place(path.status());
  }
  auto bytes = read_whole_file(*path, kMaxImageBytes);
  if (!bytes.ok()) {
    return at_place(bytes.status());
  }
  return *std::move(bytes);
}

absl::StatusOr<std::optional<spectrum::Sampled>> spectrum_of(const Parameter& parameter,
                                                             Builder& builder) {
  if (parameter.type != "spectrum") {
    return std::nullopt;
  }
  const auto checked = [&](absl::StatusOr<spectrum::Sampled> sampled)
      -> absl::StatusOr<std::optional<spectrum::Sampled>> {
    if (!sampled.ok()) {
      return error_at(parameter.place,
                      absl::StrCat("\"", parameter.name, "\": ", sampled.status().message()));
    }
    return *std::move(sampled);
  };
  if (parameter.texts.empty()) {
    return checked(spectrum::from_pairs(parameter.numbers));
  }
  if (parameter.texts.size() != 1 || !parameter.numbers.empty()) {
    return error_at(parameter.place, absl::StrCat("\"", parameter.name, "\" must be one spectrum"));
  }
  const std::string& name = parameter.texts[0];
  if (const auto known = spectrum::named(name)) {
    return known;
  }
  spectrum::Sampled flat{{1, 1e5}, {1, 1}};  // 1 at all wavelengths
  if (absl::StartsWith(name, "metal-") || absl::StartsWith(name, "glass-") ||
      absl::StartsWith(name, "stdillum-") || absl::StartsWith(name, "illum-")) {
    builder.warn(parameter.place,
                 absl::StrCat("the spectrum \"", name,
                              "\" is not known here; a spectrum of 1 is used instead"));
    return flat;
  }
  ASSIGN_OR_RETURN(const auto bytes,
                   read_or_warn(name, parameter.place, "a spectrum of 1 is used instead", builder));
  return bytes ? checked(spectrum::parse_spd(*bytes)) : flat;
}

absl::StatusOr<Rgb3> color_of(const Parameter& parameter, ColorUse use,
                              const std::string& color_space, Builder& builder) {
  if (parameter.type == "rgb") {
    if (parameter.numbers.size() != 3) {
      return error_at(parameter.place,
                      absl::StrCat("\"rgb ", parameter.name, "\" must be 3 numbers, has ",
                                   parameter.numbers.size()));
    }
    const std::vector<double>& n = parameter.numbers;
    return clamped(in_srgb({n[0], n[1], n[2]}, color_space), use, parameter, builder);
  }
  if (parameter.type == "blackbody") {
    if (parameter.numbers.size() != 1 || !(parameter.numbers[0] >= 1) ||
        !(parameter.numbers[0] <= 1e6)) {
      return error_at(parameter.place, absl::StrCat("\"blackbody ", parameter.name,
                                                    "\" must be a temperature in [1, 1e6] K"));
    }
    return clamped(of_spectrum(spectrum::blackbody(parameter.numbers[0]), use), use, parameter,
                   builder);
  }
  if (parameter.type == "float" && parameter.numbers.size() == 1) {
    const double n = parameter.numbers[0];
    return clamped({n, n, n}, use, parameter, builder);
  }
  ASSIGN_OR_RETURN(const auto sampled, spectrum_of(parameter, builder));
  if (!sampled) {
    return error_at(parameter.place, absl::StrCat("\"", parameter.type, " ", parameter.name,
                                                  "\" must be rgb, spectrum or blackbody"));
  }
  // A spectrum that the scene itself defines is 0 outside of its wavelengths.
  const bool is_named = parameter.texts.size() == 1 && spectrum::named(parameter.texts[0]);
  return clamped(of_spectrum(is_named ? *sampled : spectrum::zero_outside(*sampled), use), use,
                 parameter, builder);
}

absl::StatusOr<Rgb3> color(const Parameters& parameters, const std::string& name, ColorUse use,
                           const Rgb3& otherwise, const State& state, Builder& builder) {
  const Parameter* found = parameters.find(name);
  return found == nullptr ? otherwise : color_of(*found, use, state.color_space, builder);
}

}  // namespace bandsaw::pbrt
