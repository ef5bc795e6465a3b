#pragma once

// Adds textures to the imported scene. The same image with the same use is decoded and stored once.

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
#include "renderlib/base/kept_values.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {

class TextureStore {
  /// Identifies an image with its use: the key of image(), followed by the members of Use that
  /// change the texture.
  using Key = std::tuple<std::string, int, int, std::array<float, 3>, int, UvSet,
                         std::array<double, 6>, std::optional<ImageTexture::Wrap>, double>;
  struct Decoded {
    ImageTexture image;
    std::vector<std::string> warnings;  ///< warnings of the decoder
  };

 public:
  /// Images of earlier imports of the same files.
  using Memory = KeptValues<Key, Decoded>;
  /// All arguments MUST outlive this object. Decoded images are kept in `memory` for the stores of
  /// later imports. They are not kept if `memory` is nullptr.
  TextureStore(std::vector<Texture>& textures, std::vector<std::string>& warnings,
               Memory* memory = nullptr)
      : textures_(textures), warnings_(warnings), memory_(memory) {}

  /// Returns a texture that is `value` everywhere. All requests of one value get the same texture.
  TextureId constant(const Rgb& value);
  /// Adds the texture, even if an equal one is already stored.
  TextureId add(Texture texture);

  /// How a material uses an image.
  struct Use {
    ImageTexture::Wrap wrap = ImageTexture::Wrap::kRepeat;
    ImageTexture::Filter filter = ImageTexture::Filter::kBilinear;
    Rgb factor{1, 1, 1};  ///< multiplied with the texels; each channel in [0, 1]
    bool linear = false;  ///< 8-bit texels are numbers, not sRGB colours
    bool alpha = false;   ///< use only the image's alpha, as a grey value
    UvSet uv_set = UvSet::kFirst;
    UvTransform uv_transform;
    std::optional<ImageTexture::Wrap> wrap_v = std::nullopt;  ///< set if it differs from `wrap`
    /// The values that the texels are converted to.
    enum class Become {
      kThemselves,  ///< no conversion
      kNormals,     ///< the texels are heights; `by` is the strength of the bumps
      kIndexMap,    ///< the texels scale the reflectance F0 of the index of refraction `by`
    } become = Become::kThemselves;
    double by = 1;  ///< parameter of the conversion (see Become)
    /// True if the material says what the alpha channel is. Then no warning says that the channel
    /// is left out.
    bool alpha_is_known = false;
  };
  /// Adds an image unless it is already stored, and returns its texture. `key` identifies the
  /// image, and `name` is its name in errors and warnings. `read` returns the bytes of its file,
  /// and is called only if the decoded image is not known yet. Errors are those of `read` and of
  /// decode_image().
  absl::StatusOr<TextureId> image(const std::string& key, const std::string& name, const Use& use,
                                  absl::FunctionRef<absl::StatusOr<std::string>()> read);

  const Texture& operator[](TextureId id) const { return textures_[index_of(id)]; }
  float max_value(TextureId id) const { return bandsaw::max_value(textures_, id); }

 private:
  /// Returns the image `whole` from the memory, or decodes it and adds it to the memory.
  absl::StatusOr<Decoded> decoded(const Key& whole, const std::string& name, const Use& use,
                                  absl::FunctionRef<absl::StatusOr<std::string>()> read);

  std::vector<Texture>& textures_;
  std::vector<std::string>& warnings_;
  Memory* memory_;
  std::map<Key, TextureId> images_;
  std::map<std::tuple<float, float, float>, TextureId> constants_;
};

}  // namespace bandsaw
