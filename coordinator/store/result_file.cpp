// A result is a header with size and SHA-256, followed by the pixels. It is written to a file with
// a temporary name. The file gets its final name when all of it is on disk.

#include "coordinator/store/result_file.h"

#include <bit>
#include <cstring>
#include <span>

#include "absl/strings/str_cat.h"
#include "coordinator/store/staged_file.h"
#include "renderlib/base/check.h"
#include "renderlib/base/file.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/render/settings.h"

namespace bandsaw::coordinator {
namespace {

static_assert(std::endian::native == std::endian::little, "the file is little-endian");
static_assert(sizeof(Rgb) == 3 * sizeof(float), "pixels lie in memory as in the file");

constexpr char kMagic[8] = {'B', 'S', 'W', 'R', 'E', 'S', '0', '1'};

struct Header {
  char magic[8] = {};
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  unsigned char digest[32] = {};
};
static_assert(sizeof(Header) == 48, "no padding");

absl::Status damaged(const std::string& path, const std::string& how) {
  return absl::DataLossError(
      absl::StrCat("the result ", path, " is damaged: ", how, "; submit the job again"));
}

}  // namespace

absl::Status write_result(const Image& image, const std::string& folder, const std::string& path) {
  BANDSAW_CHECK(image.pixels.size() == std::size_t{image.width} * image.height,
                "an image has width x height pixels");
  const absl::Span<const std::byte> pixels = std::as_bytes(std::span(image.pixels));
  Header header{.width = image.width, .height = image.height};
  std::memcpy(header.magic, kMagic, sizeof kMagic);
  const wire::Digest digest = wire::sha256(pixels);
  std::memcpy(header.digest, digest.bytes.data(), sizeof header.digest);

  const std::string staging = path + ".incoming";
  RETURN_IF_ERROR(remove_file(staging));
  ASSIGN_OR_RETURN(StagedFile file, StagedFile::create(staging, sizeof header + pixels.size()));
  RETURN_IF_ERROR(file.append(std::as_bytes(std::span(&header, 1))));
  RETURN_IF_ERROR(file.append(pixels));
  return file.commit(folder, path);
}

absl::StatusOr<StoredResult> read_result(const std::string& path) {
  ASSIGN_OR_RETURN(const File file, File::open(path, O_RDONLY));
  ASSIGN_OR_RETURN(const std::uint64_t size, file.size());
  Header header;
  RETURN_IF_ERROR(file.read(0, {reinterpret_cast<std::byte*>(&header), sizeof header}));
  const std::uint64_t pixels = std::uint64_t{header.width} * header.height;
  if (std::memcmp(header.magic, kMagic, sizeof kMagic) != 0 || pixels > kMaxPixels ||
      size != sizeof header + pixels * sizeof(Rgb)) {
    return damaged(path, "its header or length is wrong");
  }
  StoredResult result;
  result.image = {
      .width = header.width, .height = header.height, .pixels = std::vector<Rgb>(pixels)};
  const auto bytes = absl::MakeSpan(reinterpret_cast<std::byte*>(result.image.pixels.data()),
                                    pixels * sizeof(Rgb));
  RETURN_IF_ERROR(file.read(sizeof header, bytes));
  result.digest = wire::sha256(bytes);
  if (std::memcmp(header.digest, result.digest.bytes.data(), sizeof header.digest) != 0) {
    return damaged(path, "its pixels do not have the digest in its header");
  }
  return result;
}

}  // namespace bandsaw::coordinator
