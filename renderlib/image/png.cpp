// Encodes PNG by stb_image_write, which is compiled here and nowhere else.

#include "renderlib/image/png.h"

#include "absl/strings/str_cat.h"
#include "renderlib/base/check.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpragmas"
#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"
#pragma GCC diagnostic ignored "-Wpedantic"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wnull-dereference"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#define STBI_WRITE_NO_STDIO
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb_image_write.h>
#pragma GCC diagnostic pop

namespace bandsaw {
namespace {

// Maximum size of the codes, in bytes. stb counts bytes in int, and its compressor doubles the size
// of its buffer. Up to kMaxBytes the count cannot overflow.
constexpr std::uint64_t kMaxBytes = std::uint64_t{1} << 29;

/// Called by stb with parts of the file; `context` is the vector to which they are appended.
void append(void* context, void* data, int size) {
  auto& bytes = *static_cast<std::vector<std::byte>*>(context);
  const auto* begin = static_cast<const std::byte*>(data);
  bytes.insert(bytes.end(), begin, begin + size);
}

}  // namespace

absl::StatusOr<std::vector<std::byte>> encode_png(std::uint32_t width, std::uint32_t height,
                                                  absl::Span<const std::uint8_t> codes) {
  const std::uint64_t size = std::uint64_t{width} * height * 3;
  BANDSAW_CHECK(codes.size() == size, "three codes a pixel");
  std::vector<std::byte> bytes;
  if (size > kMaxBytes ||
      stbi_write_png_to_func(append, &bytes, static_cast<int>(width), static_cast<int>(height), 3,
                             codes.data(), static_cast<int>(3 * width)) == 0) {
    return absl::ResourceExhaustedError(
        absl::StrCat("a PNG of ", width, " x ", height, " pixels is too large; write PPM or PFM"));
  }
  return bytes;
}

}  // namespace bandsaw
