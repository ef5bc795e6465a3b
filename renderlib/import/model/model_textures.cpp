// Finds an image that a model names, among the images that are embedded in the model or among the
// files of the scene's folder. Several spellings of a file's name are tried.

#include "renderlib/import/model/model_textures.h"

#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/strip.h"
#include "renderlib/base/file.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/files/percent.h"
#include "renderlib/import/image/decode_image.h"

namespace bandsaw {
namespace {

// Returns raw texels as a TGA file with 32 bits a pixel, rows from the top, in Assimp's byte order.
// Returns an empty string if a side has more than 65,535 texels.
std::string tga_of(const aiTexture& raw) {
  constexpr unsigned kMaxImageSide = 0xffff;
  if (raw.mWidth > kMaxImageSide || raw.mHeight > kMaxImageSide) {
    return "";
  }
  const auto low = [](unsigned v) { return static_cast<char>(v & 0xff); };
  const auto high = [](unsigned v) { return static_cast<char>(v >> 8); };
  constexpr char kTrueColor = 2;
  constexpr char kBits = 32;
  constexpr char kFromTheTopWithAlpha = 0x28;
  const std::array<char, 18> header{0,
                                    0,
                                    kTrueColor,
                                    0,
                                    0,
                                    0,
                                    0,
                                    0,
                                    0,
                                    0,
                                    0,
                                    0,
                                    low(raw.mWidth),
                                    high(raw.mWidth),
                                    low(raw.mHeight),
                                    high(raw.mHeight),
                                    kBits,
                                    kFromTheTopWithAlpha};
  std::string file(header.data(), header.size());
  file.append(reinterpret_cast<const char*>(raw.pcData),
              std::size_t{raw.mWidth} * raw.mHeight * sizeof(aiTexel));
  return file;
}

// Returns what follows the last slash.
std::string last_part(const std::string& name) {
  const std::size_t slash = name.rfind('/');
  return slash == std::string::npos ? name : name.substr(slash + 1);
}

// Finds the file by increasingly tolerant interpretations of the name. If none succeeds, returns
// the error for the whole name.
absl::StatusOr<std::string> find_file(const SceneFolder& in, const std::string& file,
                                      const std::string& model_folder) {
  const std::string name = absl::StrReplaceAll(file, {{"\\", "/"}});
  const std::string decoded = percent_decoded(absl::StripPrefix(name, "file://"));
  const std::vector<std::string> names{name, decoded, last_part(name), last_part(decoded)};
  absl::StatusOr<std::string> first;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i].empty()) {
      continue;
    }
    auto path = in.resolve(names[i], model_folder);
    if (!path.ok()) {
      path = i == 0 ? std::move(path) : in.resolve_any_case(names[i], model_folder);
    }
    if (path.ok()) {
      return path;
    }
    first = i == 0 ? std::move(path) : std::move(first);
  }
  return first;
}

}  // namespace

absl::StatusOr<std::string> ModelTextures::Source::bytes(const aiScene& scene) const {
  if (embedded < 0) {
    return read_whole_file(key, kMaxImageFileBytes);
  }
  const aiTexture& texture = *scene.mTextures[embedded];
  return texture.mHeight != 0
             ? tga_of(texture)
             : std::string(reinterpret_cast<const char*>(texture.pcData), texture.mWidth);
}

absl::StatusOr<ModelTextures::Source> ModelTextures::source_of(const std::string& file) const {
  const auto [embedded, index] = scene_.GetEmbeddedTextureAndIndex(file.c_str());
  if (embedded != nullptr && index >= 0) {
    return Source{absl::StrCat(path_, "*", index),
                  absl::StrCat(name_of(path_), ", embedded texture ", index), index};
  }
  auto path = find_file(draft_.folder, file, folder_of(path_));
  if (!path.ok()) {
    return absl::Status(path.status().code(),
                        absl::StrCat("its texture ", path.status().message()));
  }
  return Source{*path, name_of(*path)};
}

absl::StatusOr<TextureId> ModelTextures::find(const std::string& file,
                                              const TextureStore::Use& use) const {
  ASSIGN_OR_RETURN(const Source source, source_of(file));
  return draft_.textures.image(source.key, source.name, use, [&] { return source.bytes(scene_); });
}

absl::StatusOr<ImageTexture> ModelTextures::decoded(const std::string& file) const {
  ASSIGN_OR_RETURN(const Source source, source_of(file));
  ASSIGN_OR_RETURN(const std::string bytes, source.bytes(scene_));
  std::vector<std::string> unused;
  return decode_image(bytes, unused);
}

absl::StatusOr<bool> ModelTextures::is_see_through(const std::string& file) const {
  ASSIGN_OR_RETURN(const Source source, source_of(file));
  ASSIGN_OR_RETURN(const std::string bytes, source.bytes(scene_));
  if (!image_has_alpha(bytes)) {
    return false;
  }
  ASSIGN_OR_RETURN(const ImageTexture alpha, decode_alpha(bytes));
  return std::any_of(alpha.texels.begin(), alpha.texels.end(),
                     [](std::byte texel) { return texel != std::byte{255}; });
}

}  // namespace bandsaw
