// Checks the size of an EXR image in its header, then decodes it by tinyexr to three floats for
// each pixel.

#include "renderlib/import/image/decode_exr.h"

#include <tinyexr.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/render/settings.h"
#include "renderlib/texture/check_texture.h"

namespace bandsaw {
namespace {

struct Free {
  void operator()(float* values) const { std::free(values); }
};

/// Returns an error that contains the message `error` of tinyexr, and frees the message. `error` is
/// nullptr if there is no message.
absl::Status failure(const char* error) {
  const absl::Status status = absl::InvalidArgumentError(
      absl::StrCat("is not an EXR file that can be read, or is damaged (",
                   error == nullptr ? "unknown reason" : error, ")"));
  FreeEXRErrorMessage(error);
  return status;
}

/// Properties of the header that determine where the pixels of the file lie in the image.
struct Layout {
  EXRBox2i stored{};    ///< data window: the pixels that the file has
  EXRBox2i shown{};     ///< display window: the pixels that the image has
  bool turned = false;  ///< the line order is not "from the top"
};

// The rows and columns at both limits of a box belong to the box.
std::int64_t width_of(const EXRBox2i& box) { return std::int64_t{box.max_x} - box.min_x + 1; }
std::int64_t height_of(const EXRBox2i& box) { return std::int64_t{box.max_y} - box.min_y + 1; }

/// Returns INVALID_ARGUMENT if the box is empty or has more pixels than are read.
absl::Status check_size(const EXRBox2i& box) {
  const std::int64_t width = width_of(box);
  const std::int64_t height = height_of(box);
  constexpr std::int64_t kMax = kMaxTextureSide;
  if (width < 1 || height < 1 || width > kMax || height > kMax ||
      width * height > static_cast<std::int64_t>(kMaxPixels)) {
    return absl::InvalidArgumentError(
        absl::StrCat("is ", width, " x ", height, " pixels, at most ", kMaxPixels, " are read"));
  }
  return absl::OkStatus();
}

/// Reads the header and checks the size of both windows. Returns INVALID_ARGUMENT if a size is
/// wrong, or if the file is damaged or of a kind that is not read.
absl::StatusOr<Layout> read_layout(const unsigned char* data, std::size_t size) {
  EXRVersion version;
  if (ParseEXRVersionFromMemory(&version, data, size) != TINYEXR_SUCCESS) {
    return failure(nullptr);
  }
  if (version.multipart != 0 || version.non_image != 0) {
    return absl::InvalidArgumentError(
        "is an EXR file of several parts or with deep pixels, which is not supported");
  }
  EXRHeader header;
  InitEXRHeader(&header);
  const char* error = nullptr;
  if (ParseEXRHeaderFromMemory(&header, &version, data, size, &error) != TINYEXR_SUCCESS) {
    return failure(error);
  }
  const Layout layout{header.data_window, header.display_window, header.line_order != 0};
  FreeEXRHeader(&header);
  RETURN_IF_ERROR(check_size(layout.stored));
  RETURN_IF_ERROR(check_size(layout.shown));
  return layout;
}

/// Returns a copy of the file in which the header has the line order "from the top". With any other
/// order, tinyexr mirrors the image, or each of its tiles. The mirrored image is wrong, because
/// tinyexr has already put each row or tile at the place that its number gives.
std::string with_rows_from_the_top(absl::string_view bytes) {
  constexpr absl::string_view kLineOrder("lineOrder\0lineOrder\0\1\0\0\0", 24);
  std::string out(bytes);
  const std::size_t at = bytes.find(kLineOrder);
  if (at != absl::string_view::npos && at + kLineOrder.size() < out.size()) {
    out[at + kLineOrder.size()] = '\0';
  }
  return out;
}

/// Returns the pixels of the display window, three floats for each. Pixels outside of the data
/// window are black. `rgba` has the pixels of the data window, four floats for each.
std::vector<std::byte> shown_texels(const float* rgba, const Layout& layout) {
  const EXRBox2i& from = layout.stored;
  const EXRBox2i& to = layout.shown;
  constexpr std::size_t kTexel = 3 * sizeof(float);
  std::vector<std::byte> texels(static_cast<std::size_t>(width_of(to) * height_of(to)) * kTexel);
  for (std::int64_t y = std::max(from.min_y, to.min_y); y <= std::min(from.max_y, to.max_y); ++y) {
    for (std::int64_t x = std::max(from.min_x, to.min_x); x <= std::min(from.max_x, to.max_x);
         ++x) {
      const std::int64_t source = (y - from.min_y) * width_of(from) + x - from.min_x;
      const std::int64_t target = (y - to.min_y) * width_of(to) + x - to.min_x;
      std::memcpy(texels.data() + static_cast<std::size_t>(target) * kTexel, rgba + 4 * source,
                  kTexel);
    }
  }
  return texels;
}

}  // namespace

bool is_exr(absl::string_view bytes) { return absl::StartsWith(bytes, "\x76\x2f\x31\x01"); }

absl::StatusOr<ImageTexture> decode_exr(absl::string_view bytes) {
  const auto data = [](absl::string_view of) {
    return reinterpret_cast<const unsigned char*>(of.data());
  };
  ASSIGN_OR_RETURN(const Layout layout, read_layout(data(bytes), bytes.size()));
  const std::string turned = layout.turned ? with_rows_from_the_top(bytes) : std::string();
  const absl::string_view file = layout.turned ? absl::string_view(turned) : bytes;
  float* raw = nullptr;
  int width = 0;
  int height = 0;
  const char* error = nullptr;
  const int result = LoadEXRFromMemory(&raw, &width, &height, data(file), file.size(), &error);
  const std::unique_ptr<float, Free> rgba(raw);
  if (result != TINYEXR_SUCCESS || rgba == nullptr || width != width_of(layout.stored) ||
      height != height_of(layout.stored)) {
    return failure(error);
  }
  ImageTexture image;
  image.width = static_cast<std::uint32_t>(width_of(layout.shown));
  image.height = static_cast<std::uint32_t>(height_of(layout.shown));
  image.format = ImageTexture::Format::kFloat32;
  image.texels = shown_texels(rgba.get(), layout);
  return image;
}

}  // namespace bandsaw
