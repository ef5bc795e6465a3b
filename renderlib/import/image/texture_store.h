#pragma once

// The textures of the scene that is being imported; the same image under the same use is kept once.

#include <array>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "renderlib/base/ids.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {

class TextureStore {
 public:
  /// Both outlive this.
  TextureStore(std::vector<Texture>& textures, std::vector<std::string>& warnings)
      : textures_(textures), warnings_(warnings) {}

  TextureId constant(const Rgb& value);
  TextureId add(Texture texture);

  struct Use {
    ImageTexture::Wrap wrap = ImageTexture::Wrap::kRepeat;
    ImageTexture::Filter filter = ImageTexture::Filter::kBilinear;
    Rgb factor{1, 1, 1};  ///< what the texels are multiplied with, each channel in [0, 1]
    bool linear = false;  ///< 8-bit texels are numbers, not sRGB colours
    bool alpha = false;   ///< of the image its alpha alone, as a grey number
    UvSet uv_set = UvSet::kFirst;
    UvTransform uv_transform;
    std::optional<ImageTexture::Wrap> wrap_v = std::nullopt;  ///< where it differs from `wrap`
    /// What the texels become: themselves, normals of heights by a strength, or index_map of
    /// amounts of reflection by an index (texture_store.cpp).
    enum class Become { kThemselves, kNormals, kIndexMap } become = Become::kThemselves;
    double by = 1;
    bool alpha_is_known = false;  ///< no warning: the material says what becomes of the alpha
  };
  /// `key` tells images apart, `name` is what errors and warnings call it; `read` is called when it
  /// is not here yet.
  absl::StatusOr<TextureId> image(const std::string& key, const std::string& name, const Use& use,
                                  absl::FunctionRef<absl::StatusOr<std::string>()> read);

  const Texture& operator[](TextureId id) const { return textures_[index_of(id)]; }
  float max_value(TextureId id) const { return bandsaw::max_value(textures_, id); }

 private:
  using Key = std::tuple<std::string, int, int, std::array<float, 3>, int, UvSet,
                         std::array<double, 6>, std::optional<ImageTexture::Wrap>, double>;
  std::vector<Texture>& textures_;
  std::vector<std::string>& warnings_;
  std::map<Key, TextureId> images_;
  std::map<std::tuple<float, float, float>, TextureId> constants_;
};

}  // namespace bandsaw
