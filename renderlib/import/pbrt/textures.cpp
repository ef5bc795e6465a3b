// Converts each kind of pbrt texture to the nearest texture of our scene files, with a warning
// where something is lost. A texture that is not a constant colour gets a name, by which materials
// refer to it.

#include <algorithm>
#include <cmath>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/image/write_image.h"
#include "renderlib/import/image/decode_image.h"
#include "renderlib/import/pbrt/builder.h"
#include "renderlib/texture/image_texture.h"

namespace bandsaw::pbrt {
namespace {

scene::Texture gray(double value) { return constant_texture({value, value, value}); }

scene::Texture product(scene::Texture a, scene::Texture b) {
  scene::Texture out;
  *out.mutable_product()->mutable_a() = std::move(a);
  *out.mutable_product()->mutable_b() = std::move(b);
  return out;
}

/// A Texture directive.
struct TextureSource {
  const Parameters& parameters;
  const State& state;
  bool is_color;  ///< the texture has colours (type "spectrum"); false: numbers (type "float")
  Builder& builder;

  const Place& place() const { return parameters.place; }

  /// Returns the texture or constant of a parameter; the constant `otherwise` if it is absent.
  absl::StatusOr<scene::Texture> part(const std::string& name, double otherwise) const {
    if (is_color) {
      return color_texture(parameters, name, ColorUse::kUnbounded,
                           {otherwise, otherwise, otherwise}, state, builder);
    }
    ASSIGN_OR_RETURN(auto texture, float_texture(parameters, name, builder));
    return texture ? *std::move(texture) : gray(otherwise);
  }
};

/// The map from the shape's uvs to those of the texture: scale, then offset.
struct Mapping {
  double scale[2] = {1, 1};
  double offset[2] = {0, 0};
};

/// Reads the mapping of a texture. A mapping of another kind than "uv" becomes "uv", with a
/// warning.
absl::StatusOr<Mapping> read_mapping(const TextureSource& from) {
  const Parameters& in = from.parameters;
  Mapping mapping;
  ASSIGN_OR_RETURN(const std::string kind, in.text("mapping", "uv"));
  if (kind != "uv") {
    from.builder.warn(from.place(), absl::StrCat("the mapping \"", kind,
                                                 "\" has no counterpart; the uvs are used"));
    in.ignore({"v1", "v2"});
  }
  ASSIGN_OR_RETURN(mapping.scale[0], in.number("uscale", 1));
  ASSIGN_OR_RETURN(mapping.scale[1], in.number("vscale", 1));
  ASSIGN_OR_RETURN(mapping.offset[0], in.number("udelta", 0));
  ASSIGN_OR_RETURN(mapping.offset[1], in.number("vdelta", 0));
  return mapping;
}

scene::ImageTexture::Wrap wrap_of(const std::string& wrap) {
  return wrap == "clamp" || wrap == "black" ? scene::ImageTexture::WRAP_CLAMP
         : wrap == "octahedralsphere"       ? scene::ImageTexture::WRAP_CLAMP
                                            : scene::ImageTexture::WRAP_REPEAT;
}

/// Returns true if the image's values are linear, false if they are sRGB. sRGB replaces an encoding
/// with a gamma exponent, with a warning.
absl::StatusOr<bool> is_linear(const TextureSource& from, const std::string& file) {
  ASSIGN_OR_RETURN(const std::string encoding, from.parameters.text("encoding", ""));
  if (absl::StartsWith(encoding, "gamma")) {
    from.builder.warn(from.place(), absl::StrCat("the encoding \"", encoding, "\" of \"", file,
                                                 "\" has no counterpart; sRGB is used instead"));
  }
  return encoding == "linear";
}

/// Returns the name of the image file for a texture of numbers. `bytes` are the contents of `file`.
/// If the image has colours, and an alpha below 1 somewhere, pbrt uses its alpha as the number.
/// Then the result is a made file, a grey image of that alpha that the converter adds to the scene.
/// Otherwise the result is `file` itself. The encoding of the texture holds for alpha too.
std::string file_of_numbers(const std::string& file, const std::string& bytes, Builder& builder) {
  if (!image_has_alpha(bytes)) {
    return file;
  }
  std::vector<std::string> unused;
  const auto colors = decode_image(bytes, unused, Gray::kKept);
  auto alpha = decode_alpha(bytes);
  if (!colors.ok() || !alpha.ok() || colors->channels == 1) {
    return file;
  }
  // The PNG encoder converts linear values to sRGB. So alpha is decoded as sRGB here, and the bytes
  // of the PNG are those of alpha.
  alpha->format = ImageTexture::Format::kSrgb8;
  Image image{alpha->width, alpha->height, {}};
  image.pixels.reserve(std::size_t{image.width} * image.height);
  bool is_opaque = true;
  for (std::uint32_t y = 0; y < image.height; ++y) {
    for (std::uint32_t x = 0; x < image.width; ++x) {
      image.pixels.push_back(texel(*alpha, x, y));
      is_opaque = is_opaque && image.pixels.back().r == 1;
    }
  }
  const auto png = encode_image(image, ImageFormat::kPng);
  if (is_opaque || !png.ok()) {
    return file;
  }
  return builder.made.add("alpha", ".png",
                          std::string(reinterpret_cast<const char*>(png->data()), png->size()));
}

/// Remembers the largest value of an image of floats (EXR or HDR). If such an image cannot be
/// decoded, 1 is remembered. Images of other formats have no values above 1.
void note_largest_value(const std::string& file, const std::string& bytes, Builder& builder) {
  if (!absl::EndsWithIgnoreCase(file, ".exr") && !absl::EndsWithIgnoreCase(file, ".hdr")) {
    return;
  }
  std::vector<std::string> unused;
  const auto image = decode_image(bytes, unused);
  builder.largest_of_image[file] = image.ok() ? max_value(*image) : 1;
}

/// Converts an image file. `scale` becomes a product, and `invert` a ramp from 1 to 0.
absl::StatusOr<scene::Texture> image_map(const TextureSource& from) {
  const Parameters& in = from.parameters;
  ASSIGN_OR_RETURN(const std::string file, in.text("filename", ""));
  ASSIGN_OR_RETURN(const Mapping mapping, read_mapping(from));
  ASSIGN_OR_RETURN(const std::string wrap, in.text("wrap", "repeat"));
  ASSIGN_OR_RETURN(const std::string filter, in.text("filter", "bilinear"));
  ASSIGN_OR_RETURN(const double scale, in.number("scale", 1));
  ASSIGN_OR_RETURN(const bool invert, in.boolean("invert", false));
  ASSIGN_OR_RETURN(const bool linear, is_linear(from, file));
  in.ignore({"maxanisotropy"});
  if (wrap == "black") {
    from.builder.warn(from.place(), "outside of the image its edge is shown instead of black");
  }
  ASSIGN_OR_RETURN(const auto bytes,
                   read_or_warn(file, from.place(), "a grey of 0.5 stands for it", from.builder));
  if (!bytes) {
    return gray(0.5);
  }
  note_largest_value(file, *bytes, from.builder);
  scene::Texture out;
  scene::ImageTexture& image = *out.mutable_image();
  image.set_file(from.is_color ? file : file_of_numbers(file, *bytes, from.builder));
  image.set_wrap(wrap_of(wrap));
  image.set_filter(filter == "point" ? scene::ImageTexture::FILTER_NEAREST
                                     : scene::ImageTexture::FILTER_BILINEAR);
  image.set_encoding(linear ? scene::ImageTexture::ENCODING_LINEAR
                            : scene::ImageTexture::ENCODING_SRGB);
  for (int k = 0; k < 2; ++k) {
    image.add_uv_scale(mapping.scale[k]);
    image.add_uv_offset(mapping.offset[k]);
  }
  if (scale != 1) {
    out = product(std::move(out), gray(std::clamp(scale, 0.0, 1e12)));
  }
  if (invert) {
    if (from.is_color) {
      from.builder.warn(from.place(), "the inverted image is shown in grey");
    }
    scene::Texture inverted;
    *inverted.mutable_ramp()->mutable_texture() = std::move(out);
    for (const double at : {0, 1}) {
      auto* stop = inverted.mutable_ramp()->add_stop();
      stop->set_at(at);
      for (int k = 0; k < 3; ++k) {
        stop->add_color(1 - at);
      }
    }
    return inverted;
  }
  return out;
}

absl::StatusOr<scene::Texture> checkerboard(const TextureSource& from) {
  ASSIGN_OR_RETURN(const int dimension, from.parameters.integer("dimension", 2));
  scene::Texture out;
  scene::CheckerTexture& checker = *out.mutable_checker();
  ASSIGN_OR_RETURN(*checker.mutable_even(), from.part("tex1", 1));
  ASSIGN_OR_RETURN(*checker.mutable_odd(), from.part("tex2", 0));
  if (dimension == 3) {
    checker.set_mapping(scene::CheckerTexture::MAPPING_POSITION);
    checker.set_space(scene::SPACE_WORLD);
    if (!(from.state.transforms[0] == Transform{})) {
      from.builder.warn(from.place(),
                        "the cells of the checkerboard have size 1 and lie along the world's axes");
    }
    return out;
  }
  ASSIGN_OR_RETURN(const Mapping mapping, read_mapping(from));
  double shift = 0;
  for (int k = 0; k < 2; ++k) {
    const double scale = std::abs(mapping.scale[k]);
    checker.add_size(scale > 0 ? std::clamp(1 / scale, 1e-9, 1e9) : 1e9);
    shift += mapping.offset[k];
    if (mapping.offset[k] != std::floor(mapping.offset[k]) || mapping.scale[k] <= 0) {
      from.builder.warn(from.place(), "the checkerboard is not shifted, and not mirrored");
    }
  }
  // Offsets that add up to an odd number of cells exchange the two textures.
  if (std::abs(std::fmod(shift, 2)) == 1) {
    checker.mutable_even()->Swap(checker.mutable_odd());
  }
  return out;
}

absl::StatusOr<scene::Texture> mix(const TextureSource& from) {
  scene::Texture out;
  ASSIGN_OR_RETURN(*out.mutable_mix()->mutable_a(), from.part("tex1", 0));
  ASSIGN_OR_RETURN(*out.mutable_mix()->mutable_b(), from.part("tex2", 1));
  ASSIGN_OR_RETURN(auto amount, float_texture(from.parameters, "amount", from.builder));
  if (amount) {
    *out.mutable_mix()->mutable_amount() = *std::move(amount);
  }
  return out;
}

absl::StatusOr<scene::Texture> scaled(const TextureSource& from) {
  ASSIGN_OR_RETURN(scene::Texture texture, from.part("tex", 1));
  ASSIGN_OR_RETURN(auto scale, float_texture(from.parameters, "scale", from.builder));
  return scale ? product(std::move(texture), *std::move(scale)) : texture;
}

/// Returns the noise that comes nearest to pbrt's fbm, wrinkled, windy and marble.
absl::StatusOr<scene::Texture> noise(const TextureSource& from, const std::string& type) {
  const Parameters& in = from.parameters;
  ASSIGN_OR_RETURN(const int octaves, in.integer("octaves", 8));
  in.ignore({"roughness", "variation"});
  ASSIGN_OR_RETURN(const double scale, in.number("scale", 1));
  scene::Texture out;
  scene::NoiseTexture& to = *out.mutable_noise();
  to.set_kind(type == "marble" ? scene::NoiseTexture::KIND_MARBLE
              : type == "fbm"  ? scene::NoiseTexture::KIND_NOISE
                               : scene::NoiseTexture::KIND_TURBULENCE);
  to.set_octaves(static_cast<std::uint32_t>(std::clamp(octaves, 1, 16)));
  to.set_scale(std::clamp(scale, 1e-9, 1e9));
  from.builder.warn(from.place(), absl::StrCat("the texture \"", type,
                                               "\" is shown by noise of another pattern"));
  return out;
}

/// Converts pbrt's bilerp, which interpolates bilinearly between four corners: v00, v01, v10 and
/// v11. The first digit is the corner's u, the second its v. The result is a mix along v of two
/// mixes along u.
absl::StatusOr<scene::Texture> bilinear(const TextureSource& from) {
  scene::Texture rows[2];
  for (int v = 0; v < 2; ++v) {
    scene::Texture& row = rows[v];
    ASSIGN_OR_RETURN(*row.mutable_mix()->mutable_a(), from.part(absl::StrCat("v0", v), v));
    ASSIGN_OR_RETURN(*row.mutable_mix()->mutable_b(), from.part(absl::StrCat("v1", v), v));
  }
  ASSIGN_OR_RETURN(const Mapping mapping, read_mapping(from));
  // Returns a ramp from 0 to 1 over one coordinate of the texture; `k` is 0 for u, 1 for v.
  const auto ramp = [&](scene::RampTexture::Coordinate coordinate, int k) {
    scene::Texture texture;
    texture.mutable_ramp()->set_coordinate(coordinate);
    const double scale = mapping.scale[k] == 0 ? 1e-9 : mapping.scale[k];
    const double at[2] = {-mapping.offset[k] / scale, (1 - mapping.offset[k]) / scale};
    const int first = at[0] <= at[1] ? 0 : 1;
    for (const int end : {first, 1 - first}) {
      auto* stop = texture.mutable_ramp()->add_stop();
      stop->set_at(at[end]);
      for (int c = 0; c < 3; ++c) {
        stop->add_color(end);
      }
    }
    return texture;
  };
  scene::Texture out;
  for (scene::Texture& row : rows) {
    *row.mutable_mix()->mutable_amount() = ramp(scene::RampTexture::COORDINATE_U, 0);
  }
  *out.mutable_mix()->mutable_a() = std::move(rows[0]);
  *out.mutable_mix()->mutable_b() = std::move(rows[1]);
  *out.mutable_mix()->mutable_amount() = ramp(scene::RampTexture::COORDINATE_V, 1);
  return out;
}

absl::StatusOr<scene::Texture> read_kind(const TextureSource& from, const std::string& type) {
  if (type == "constant") {
    return from.part("value", 1);
  }
  if (type == "imagemap") {
    return image_map(from);
  }
  if (type == "checkerboard") {
    return checkerboard(from);
  }
  if (type == "mix") {
    return mix(from);
  }
  if (type == "scale") {
    return scaled(from);
  }
  if (type == "bilerp") {
    return bilinear(from);
  }
  if (type == "fbm" || type == "wrinkled" || type == "windy" || type == "marble") {
    return noise(from, type);
  }
  if (type == "dots") {
    from.builder.warn(from.place(),
                      "dots have no counterpart; only the texture outside of the dots is shown");
    from.parameters.ignore({"inside"});
    RETURN_IF_ERROR(read_mapping(from).status());
    return from.part("outside", 0);
  }
  if (type == "directionmix") {
    from.builder.warn(from.place(), "a mix by direction has no counterpart; half of both is shown");
    from.parameters.ignore({"dir"});
    return mix(from);
  }
  from.builder.warn(from.place(),
                    absl::StrCat("a texture of kind \"", type,
                                 "\" has no counterpart; a grey of 0.5 stands for it"));
  for (const Parameter& parameter : from.parameters.list) {
    parameter.is_used = true;
  }
  return gray(0.5);
}

/// Returns a name that no other texture has. It begins with `name`.
std::string unique_name(const std::string& name, Builder& builder) {
  std::string candidate = name;
  while (!builder.taken_textures.insert(candidate).second) {
    candidate = absl::StrCat(name, "_", ++builder.texture_counts[name] + 1);
  }
  return candidate;
}

}  // namespace

scene::Texture named_texture(const std::string& name, scene::Texture texture, Builder& builder) {
  if (texture.has_color()) {
    return texture;
  }
  const std::string unique = unique_name(name.empty() ? "texture" : name, builder);
  builder.largest_of_texture[unique] = largest_value(texture, builder);
  texture.set_name(unique);
  *builder.out.add_texture() = std::move(texture);
  scene::Texture reference;
  reference.set_use(unique);
  return reference;
}

std::optional<double> constant_of(const scene::Texture& texture) {
  if (!texture.has_color()) {
    return std::nullopt;
  }
  const auto& rgb = texture.color().rgb();
  if (rgb[0] == rgb[1] && rgb[1] == rgb[2]) {
    return rgb[0];  // luminance() would round: its weights do not add up to exactly 1
  }
  return spectrum::luminance({rgb[0], rgb[1], rgb[2]});
}

absl::StatusOr<scene::Texture> color_texture(const Parameters& parameters, const std::string& name,
                                             ColorUse use, const Rgb3& otherwise,
                                             const State& state, Builder& builder) {
  const Parameter* found = parameters.find(name);
  if (found == nullptr) {
    return constant_texture(otherwise);
  }
  if (found->type != "texture") {
    ASSIGN_OR_RETURN(const Rgb3 rgb, color_of(*found, use, state.color_space, builder));
    return constant_texture(rgb);
  }
  if (found->texts.size() != 1) {
    return error_at(found->place, absl::StrCat("\"", name, "\" must name one texture"));
  }
  const auto texture = builder.color_textures.find(found->texts[0]);
  if (texture == builder.color_textures.end()) {
    return error_at(found->place,
                    absl::StrCat("no spectrum texture is called \"", found->texts[0], "\""));
  }
  return texture->second;
}

absl::StatusOr<std::optional<scene::Texture>> float_texture(const Parameters& parameters,
                                                            const std::string& name,
                                                            Builder& builder) {
  const Parameter* found = parameters.find(name);
  if (found == nullptr) {
    return std::nullopt;
  }
  if (found->type != "texture") {
    ASSIGN_OR_RETURN(const double value, parameters.number(name, 0));
    return gray(std::clamp(value, 0.0, 1e12));
  }
  const auto texture = found->texts.size() == 1 ? builder.float_textures.find(found->texts[0])
                                                : builder.float_textures.end();
  if (texture == builder.float_textures.end()) {
    return error_at(found->place, absl::StrCat("\"", name, "\": no float texture is called \"",
                                               found->texts.empty() ? "" : found->texts[0], "\""));
  }
  return texture->second;
}

absl::Status add_texture(const std::string& name, const std::string& type, const std::string& kind,
                         Parameters parameters, const State& state, Builder& builder) {
  if (type != "spectrum" && type != "float") {
    return error_at(parameters.place,
                    absl::StrCat("a texture is of type spectrum or float, not \"", type, "\""));
  }
  const bool is_color = type == "spectrum";
  auto& textures = is_color ? builder.color_textures : builder.float_textures;
  if (textures.count(name) > 0) {
    return error_at(parameters.place,
                    absl::StrCat("a ", type, " texture called \"", name, "\" exists"));
  }
  ASSIGN_OR_RETURN(scene::Texture texture, read_kind({parameters, state, is_color, builder}, kind));
  builder.warn_of_unused(parameters);
  textures.emplace(name, named_texture(name, std::move(texture), builder));
  return absl::OkStatus();
}

}  // namespace bandsaw::pbrt
