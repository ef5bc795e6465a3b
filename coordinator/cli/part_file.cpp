#include "coordinator/cli/part_file.h"

#include <cerrno>
#include <filesystem>
#include <fstream>

#include "absl/strings/str_cat.h"
#include "renderlib/base/atomic_file.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

absl::StatusOr<std::vector<std::byte>> read_file(const std::string& path) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error) {
    return errno_status(error.value(), path);
  }
  std::vector<std::byte> bytes(size);
  std::ifstream file(path, std::ios::binary);
  file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  if (!file) {
    return errno_status(errno == 0 ? EIO : errno, path);
  }
  return bytes;
}

}  // namespace

absl::Status write_part(const std::string& path, const std::vector<BandRecord>& records) {
  std::vector<std::byte> bytes;
  for (const BandRecord& record : records) {
    ASSIGN_OR_RETURN(const std::vector<std::byte> encoded, encode_band_record(record));
    bytes.insert(bytes.end(), encoded.begin(), encoded.end());
  }
  return write_file_atomically(path, bytes);
}

absl::Status read_part(const std::string& path,
                       const std::function<absl::Status(const BandRecord&)>& record) {
  ASSIGN_OR_RETURN(const std::vector<std::byte> bytes, read_file(path));
  if (bytes.empty()) {
    return absl::DataLossError(absl::StrCat(path, ": is empty, not a part of an image"));
  }
  for (std::uint64_t offset = 0; offset < bytes.size();) {
    const auto decoded = decode_band_record(bytes, offset);
    if (!decoded.ok()) {
      return absl::DataLossError(
          absl::StrCat(path, ": not a whole part of an image: ", decoded.status().message()));
    }
    RETURN_IF_ERROR(record(decoded->record));
    offset += decoded->size;
  }
  return absl::OkStatus();
}

}  // namespace bandsaw::coordinator
