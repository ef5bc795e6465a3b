// Decodes an environment map and repairs its values: infinite or too large ones become the largest
// valid value, NaN and negative ones 0.

#include "renderlib/import/draft/environment_image.h"

#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "renderlib/import/draft/color_limits.h"
#include "renderlib/import/image/decode_image.h"

namespace bandsaw {
namespace {

bool is_light(float value) { return value >= 0 && value <= kMaxRadiance; }

}  // namespace

std::size_t repair_light(ImageTexture& image) {
  if (image.format != ImageTexture::Format::kFloat32) {
    return 0;
  }
  std::vector<float> values(image.texels.size() / sizeof(float));
  std::memcpy(values.data(), image.texels.data(), image.texels.size());
  float most = 0;
  std::size_t altered = 0;
  for (const float value : values) {
    most = is_light(value) ? std::max(most, value) : most;
    altered += is_light(value) ? 0 : 1;
  }
  if (altered == 0) {
    return 0;
  }
  std::vector<std::byte> texels(image.texels.size());
  for (float& value : values) {
    value = is_light(value) ? value : value > 0 ? most : 0;
  }
  std::memcpy(texels.data(), values.data(), texels.size());
  image.texels = std::move(texels);
  return altered;
}

absl::StatusOr<TextureId> add_environment_image(const std::string& bytes, const std::string& name,
                                                SceneDraft& draft) {
  std::vector<std::string> warnings;
  absl::StatusOr<ImageTexture> image = decode_image(bytes, warnings, Gray::kKept);
  if (!image.ok()) {
    return absl::Status(image.status().code(), absl::StrCat(name, ": ", image.status().message()));
  }
  if (const std::size_t repaired = repair_light(*image); repaired > 0) {
    warnings.push_back(absl::StrCat(repaired,
                                    " numbers that no light can have (not finite, negative ",
                                    "or above 1e30) are repaired"));
  }
  for (const std::string& warning : warnings) {
    draft.out.info.warnings.push_back(absl::StrCat(name, ": ", warning));
  }
  return draft.textures.add(*std::move(image));
}

}  // namespace bandsaw
