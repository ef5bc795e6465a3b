// Converts the textures of Mitsuba scenes. texture_of() converts an object of type bitmap,
// checkerboard, mesh attribute or scale to a texture of our scene file. in_our_frame() converts uv
// transforms from Mitsuba's convention, in which v = 0 is the top row of an image, to Bandsaw's.

#include "renderlib/import/mitsuba/textures.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/mitsuba/read_values.h"
#include "renderlib/import/mitsuba/spectra.h"
#include "renderlib/math/elementary.h"

namespace bandsaw::mitsuba {
namespace {

constexpr double kDegreesPerRadian = 180 / 3.14159265358979323846;

/// An affine map of the plane. Each row (a, b, c) gives a coordinate a u + b v + c of the result.
using Affine = std::array<std::array<double, 3>, 2>;

const Object* object_in(const Value& value) {
  const auto* const* object = std::get_if<const Object*>(&value);
  return object != nullptr ? *object : nullptr;
}

/// Returns the map from Mitsuba's uv to the coordinates of the texture.
absl::StatusOr<Affine> to_uv_of(const Parameters& from) {
  ASSIGN_OR_RETURN(const Transform t, from.transform("to_uv"));
  // Version 0.x has the following numbers instead of to_uv.
  ASSIGN_OR_RETURN(const double u_scale, from.number("uscale", 1));
  ASSIGN_OR_RETURN(const double v_scale, from.number("vscale", 1));
  ASSIGN_OR_RETURN(const double u_offset, from.number("uoffset", 0));
  ASSIGN_OR_RETURN(const double v_offset, from.number("voffset", 0));
  const Transform whole = t * translation({u_offset, v_offset, 0}) * scaling({u_scale, v_scale, 1});
  return Affine{{{whole.m[0][0], whole.m[0][1], whole.m[0][3]},
                 {whole.m[1][0], whole.m[1][1], whole.m[1][3]}}};
}

/// `m` maps Mitsuba's uv to Mitsuba's texture coordinates, in which v = 0 is the top row of the
/// image. Returns the map from our uv to our texture coordinates, in which v = 0 is the bottom row.
/// `frame` states whether our v is Mitsuba's v or 1 - v.
Affine in_our_frame(const Affine& m, UvFrame frame) {
  Affine to = {{m[0], {-m[1][0], -m[1][1], 1 - m[1][2]}}};
  if (frame == UvFrame::kFlipped) {
    for (auto& row : to) {
      row[2] += row[1];
      row[1] = -row[1];
    }
  }
  return to;
}

/// Writes the map as scale, rotation and offset. Its linear part is R M, where R is the rotation
/// and M has the rows (u_scale, shear) and (0, v_scale). Returns false if the map shears; the shear
/// is left out.
bool set_uv(const Affine& m, scene::ImageTexture& to) {
  const bool turned = m[1][0] != 0;
  const double angle = turned ? atan2(m[1][0], m[0][0]) : 0;
  const SinCos turn = turned ? sincos_degrees(angle * kDegreesPerRadian) : SinCos{0, 1};
  const double u_scale = turned ? std::sqrt(m[0][0] * m[0][0] + m[1][0] * m[1][0]) : m[0][0];
  const double v_scale = m[1][1] * turn.cos - m[0][1] * turn.sin;
  const double shear = m[0][1] * turn.cos + m[1][1] * turn.sin;
  if (u_scale != 1 || v_scale != 1) {
    to.add_uv_scale(u_scale);
    to.add_uv_scale(v_scale);
  }
  if (m[0][2] != 0 || m[1][2] != 0) {
    to.add_uv_offset(m[0][2]);
    to.add_uv_offset(m[1][2]);
  }
  if (turned) {
    to.set_uv_rotate(angle * kDegreesPerRadian);
  }
  return std::abs(shear) <= 1e-9 * (std::abs(u_scale) + std::abs(v_scale));
}

/// Sets the uv placement of the image texture `to`. Warns if the placement shears.
absl::Status place_texture(const Parameters& from, UvFrame frame, scene::ImageTexture& to,
                           Conversion& conversion) {
  ASSIGN_OR_RETURN(const Affine to_uv, to_uv_of(from));
  if (!set_uv(in_our_frame(to_uv, frame), to)) {
    conversion.warn(from.place(), "the shear of to_uv is left out");
  }
  return absl::OkStatus();
}

absl::StatusOr<scene::ImageTexture::Wrap> wrap_of(const Parameters& from) {
  ASSIGN_OR_RETURN(const std::string name, from.text("wrap_mode", "repeat"));
  return name == "clamp"    ? scene::ImageTexture::WRAP_CLAMP
         : name == "mirror" ? scene::ImageTexture::WRAP_MIRROR
                            : scene::ImageTexture::WRAP_REPEAT;
}

/// Converts an image texture. If the file is missing, returns grey, with a warning.
absl::StatusOr<scene::Texture> bitmap(const Parameters& from, const TexturedSurface& surface,
                                      Conversion& to) {
  ASSIGN_OR_RETURN(const std::string name, from.text("filename", ""));
  const auto file = to.files.find(name);
  if (!file.ok()) {
    if (!absl::IsNotFound(file.status())) {
      return at_place(from.place(), file.status());
    }
    to.warn(from.place(), absl::StrCat(file.status().message(), "; grey stands in its place"));
    from.ignore({"raw", "filter_type", "wrap_mode", "to_uv", "format", "accel", "gamma"});
    return constant_texture(gray(0.5f));
  }
  scene::Texture out;
  scene::ImageTexture& image = *out.mutable_image();
  image.set_file(file->name);
  ASSIGN_OR_RETURN(const auto wrap, wrap_of(from));
  if (wrap != scene::ImageTexture::WRAP_REPEAT) {
    image.set_wrap(wrap);
  }
  ASSIGN_OR_RETURN(const std::string filter, from.text("filter_type", "bilinear"));
  if (filter == "nearest") {
    image.set_filter(scene::ImageTexture::FILTER_NEAREST);
  }
  ASSIGN_OR_RETURN(bool raw, from.boolean("raw", false));
  // Version 0.x has a gamma: 1 means linear texels, and 0 leaves the encoding to the file.
  ASSIGN_OR_RETURN(const double gamma, from.number("gamma", 0));
  raw = raw || gamma == 1;
  if (raw) {
    image.set_encoding(scene::ImageTexture::ENCODING_LINEAR);
  }
  from.ignore({"format", "accel"});
  RETURN_IF_ERROR(place_texture(from, surface.frame, image, to));
  return out;
}

/// Returns a parameter as a texture; a grey of `otherwise` if it is absent.
absl::StatusOr<scene::Texture> part_of(const Parameters& from, const char* name, float otherwise,
                                       ColorOf of, const TexturedSurface& surface, Conversion& to) {
  const Property* property = from.find(name);
  return property == nullptr ? absl::StatusOr<scene::Texture>(constant_texture(gray(otherwise)))
                             : texture_of(*property, of, surface, to);
}

/// Returns a PGM file of 2 x 2 grey texels, top row first: white, black; black, white.
std::string checker_image() { return std::string("P5 2 2 255\n") + "\xff" + '\0' + '\0' + "\xff"; }

/// Converts a checkerboard. In Mitsuba, each cell has a side of half a unit, and the cell at (0, 0)
/// has color0.
absl::StatusOr<scene::Texture> checkerboard(const Parameters& from, ColorOf of,
                                            const TexturedSurface& surface, Conversion& to) {
  // In a checkerboard of numbers, Mitsuba exchanges the two values.
  const bool number = of == ColorOf::kNumber;
  ASSIGN_OR_RETURN(const scene::Texture color0,
                   number ? part_of(from, "color1", 0.2f, of, surface, to)
                          : part_of(from, "color0", 0.4f, of, surface, to));
  ASSIGN_OR_RETURN(const scene::Texture color1,
                   number ? part_of(from, "color0", 0.4f, of, surface, to)
                          : part_of(from, "color1", 0.2f, of, surface, to));
  ASSIGN_OR_RETURN(const Affine m, to_uv_of(from));
  const bool upright =
      m[0][1] == 0 && m[1][0] == 0 && m[0][2] == 0 && m[1][2] == 0 && m[0][0] > 0 && m[1][1] > 0;
  const double rows = 2 * m[1][1];
  const bool whole = rows == std::floor(rows);
  scene::Texture out;
  if (upright && (surface.frame == UvFrame::kSame || whole)) {
    // If v is flipped, Mitsuba's last row of cells is our first row. If the number of rows is even,
    // our first row begins with color1.
    const bool swap = surface.frame == UvFrame::kFlipped && std::fmod(rows, 2) == 0;
    *out.mutable_checker()->mutable_even() = swap ? color1 : color0;
    *out.mutable_checker()->mutable_odd() = swap ? color0 : color1;
    out.mutable_checker()->add_size(0.5 / m[0][0]);
    out.mutable_checker()->add_size(0.5 / m[1][1]);
    return out;
  }
  // An image of four texels can be rotated and offset, which our checker texture cannot.
  *out.mutable_mix()->mutable_a() = color1;
  *out.mutable_mix()->mutable_b() = color0;
  scene::ImageTexture& image = *out.mutable_mix()->mutable_amount()->mutable_image();
  image.set_file(to.made.add("checker", ".pgm", checker_image()));
  image.set_filter(scene::ImageTexture::FILTER_NEAREST);
  image.set_encoding(scene::ImageTexture::ENCODING_LINEAR);
  RETURN_IF_ERROR(place_texture(from, surface.frame, image, to));
  return out;
}

/// Returns the image of a mesh attribute. If the shape has no such attribute, returns grey, with a
/// warning.
absl::StatusOr<scene::Texture> mesh_attribute(const Parameters& from,
                                              const TexturedSurface& surface, Conversion& to) {
  ASSIGN_OR_RETURN(const std::string name, from.text("name", ""));
  ASSIGN_OR_RETURN(const double scale, from.number("scale", 1));
  const auto found = surface.attributes.find(name);
  if (found == surface.attributes.end()) {
    to.warn(from.place(),
            absl::StrCat("the shape has no attribute \"", name, "\"; grey stands in its place"));
    return constant_texture(gray(0.5f));
  }
  scene::Texture image;
  image.mutable_image()->set_file(found->second);
  image.mutable_image()->set_wrap(scene::ImageTexture::WRAP_CLAMP);
  if (scale == 1) {
    return image;
  }
  scene::Texture out;
  *out.mutable_product()->mutable_a() = image;
  *out.mutable_product()->mutable_b() = constant_texture(gray(static_cast<float>(scale)));
  return out;
}

/// Returns the colour of an object that has one colour; std::nullopt for others.
absl::StatusOr<std::optional<Rgb>> constant_of(const Parameters& from, ColorOf of) {
  const std::string& type = from.object().type;
  if (type == "uniform" || type == "rawconstant" || type == "srgb" || type == "srgb_d65" ||
      type == "d65") {
    const char* name = type == "d65" ? "scale" : from.has("color") ? "color" : "value";
    const Property* value = from.find(name);
    if (value == nullptr) {
      return std::optional<Rgb>(gray(1));
    }
    if (const auto* vector = std::get_if<Vec3>(&value->value)) {
      return std::optional<Rgb>({static_cast<float>(vector->x), static_cast<float>(vector->y),
                                 static_cast<float>(vector->z)});
    }
    return constant_color(*value, of);
  }
  if (type == "blackbody") {
    ASSIGN_OR_RETURN(const double kelvin, from.number("temperature", 6500));
    ASSIGN_OR_RETURN(const double scale, from.number("scale", 1));
    from.ignore({"wavelength_min", "wavelength_max"});
    return std::optional<Rgb>(rgb_of(BlackBody{kelvin, scale}));
  }
  if (type == "regular" || type == "irregular") {
    ASSIGN_OR_RETURN(const Spectrum spectrum, sampled_spectrum(from));
    return std::optional<Rgb>(rgb_of(spectrum, of));
  }
  return std::optional<Rgb>();
}

/// Converts an object. An object of unknown type becomes grey, with a warning.
absl::StatusOr<scene::Texture> object_texture(const Object& object, ColorOf of,
                                              const TexturedSurface& surface, Conversion& to) {
  const Parameters from(object);
  ASSIGN_OR_RETURN(const std::optional<Rgb> constant, constant_of(from, of));
  absl::StatusOr<scene::Texture> out;
  if (constant) {
    out = constant_texture(*constant);
  } else if (object.type == "bitmap") {
    out = bitmap(from, surface, to);
  } else if (object.type == "checkerboard") {
    out = checkerboard(from, of, surface, to);
  } else if (object.type == "mesh_attribute") {
    out = mesh_attribute(from, surface, to);
  } else if (object.type == "scale" && !from.objects("texture").empty()) {  // version 0.x
    out = texture_of(*from.objects("texture").front(), of, surface, to);
    ASSIGN_OR_RETURN(const double scale, from.number("scale", 1));
    if (out.ok() && scale != 1) {
      scene::Texture product;
      *product.mutable_product()->mutable_a() = *out;
      *product.mutable_product()->mutable_b() = constant_texture(gray(static_cast<float>(scale)));
      out = product;
    }
  } else {
    to.warn(object.place,
            absl::StrCat("texture \"", object.type, "\" is not known; grey stands in its place"));
    return constant_texture(gray(0.5f));
  }
  if (out.ok()) {
    to.warn_of_unused(from);
  }
  return out;
}

}  // namespace

void set_color(const Rgb& color, scene::Color* to) {
  to->clear_rgb();
  for (const float channel : {color.r, color.g, color.b}) {
    to->add_rgb(channel);
  }
}

scene::Texture constant_texture(const Rgb& color) {
  scene::Texture texture;
  set_color(color, texture.mutable_color());
  return texture;
}

absl::StatusOr<std::optional<Rgb>> constant_color(const Property& property, ColorOf of) {
  const Value& value = property.value;
  if (const Object* object = object_in(value)) {
    return constant_of(Parameters(*object), of);
  }
  if (const auto* number = std::get_if<double>(&value)) {
    return std::optional<Rgb>(gray(static_cast<float>(*number)));
  }
  if (const auto* number = std::get_if<std::int64_t>(&value)) {
    return std::optional<Rgb>(gray(static_cast<float>(*number)));
  }
  if (const auto* rgb = std::get_if<Rgb>(&value)) {
    return std::optional<Rgb>(*rgb);
  }
  if (const auto* spectrum = std::get_if<Spectrum>(&value)) {
    return std::optional<Rgb>(rgb_of(*spectrum, of));
  }
  if (const auto* body = std::get_if<BlackBody>(&value)) {
    return std::optional<Rgb>(rgb_of(*body));
  }
  return error_at(property.place,
                  absl::StrCat("parameter \"", property.name, "\" must be a colour or a texture"));
}

absl::StatusOr<scene::Texture> texture_of(const Property& property, ColorOf of,
                                          const TexturedSurface& surface, Conversion& to) {
  if (const Object* object = object_in(property.value)) {
    return object_texture(*object, of, surface, to);
  }
  ASSIGN_OR_RETURN(const std::optional<Rgb> color, constant_color(property, of));
  return constant_texture(*color);
}

absl::StatusOr<Varying> varying_of(const Parameters& from, const std::string& name,
                                   double otherwise, const TexturedSurface& surface,
                                   Conversion& to) {
  const Property* property = from.find(name);
  if (property == nullptr) {
    return Varying{otherwise};
  }
  ASSIGN_OR_RETURN(const std::optional<Rgb> constant, constant_color(*property, ColorOf::kNumber));
  if (constant) {
    const bool is_gray = constant->r == constant->g && constant->g == constant->b;
    if (const auto* number = std::get_if<double>(&property->value)) {
      return Varying{*number};  // not rounded to a float
    }
    return Varying{is_gray ? constant->r : luminance(*constant)};
  }
  ASSIGN_OR_RETURN(scene::Texture texture, texture_of(*property, ColorOf::kNumber, surface, to));
  return Varying{1, std::move(texture)};
}

bool uses_uv(const Value& value) {
  const Object* object = object_in(value);
  if (object == nullptr) {
    return false;
  }
  if (object->type == "bitmap" || object->type == "checkerboard" ||
      object->type == "mesh_attribute") {
    return true;
  }
  return std::any_of(object->properties.begin(), object->properties.end(),
                     [](const Property& p) { return uses_uv(p.value); });
}

void find_attributes(const Object& object, std::set<std::string>& names) {
  if (object.type == "mesh_attribute") {
    const auto name = Parameters(object).text("name", "");
    if (name.ok()) {
      names.insert(*name);
    }
  }
  for (const Property& property : object.properties) {
    if (const Object* child = object_in(property.value)) {
      find_attributes(*child, names);
    }
  }
}

}  // namespace bandsaw::mitsuba
