#pragma once

// Reads zip archives whose entries are stored or deflated (APPNOTE.TXT of PKWARE, with zip64).
// bandsaw-import uses it to unpack a scene that is sent as one file.

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

namespace bandsaw {

/// Bounds of an archive that is read.
inline constexpr std::size_t kMaxZipEntries = 20'000;
inline constexpr std::uint64_t kMaxUnzippedBytes = std::uint64_t{4} << 30;

class ZipArchive {
 public:
  /// A file in the archive; folders are left out.
  struct Entry {
    std::string name;  ///< safe: relative, with slashes, below the folder where it is unpacked
    std::uint64_t packed_bytes = 0;
    std::uint64_t bytes = 0;
    std::uint64_t header_at = 0;  ///< offset of its local header
    std::uint32_t crc = 0;
    bool is_deflated = false;
  };

  /// Reads the directory of the archive. `bytes` MUST outlive the object. Returns INVALID_ARGUMENT
  /// if the archive is not a zip file, is damaged or encrypted, or has an unknown compression, two
  /// files of one name, a name that is not safe (is_safe_name) or a symbolic link. Returns
  /// RESOURCE_EXHAUSTED if one of the bounds above is exceeded.
  static absl::StatusOr<ZipArchive> open(absl::string_view bytes);

  const std::vector<Entry>& entries() const { return entries_; }

  /// Returns the bytes of an entry. The error is INVALID_ARGUMENT if they are damaged, or if their
  /// size or checksum differs from the one in the archive's directory, and RESOURCE_EXHAUSTED if a
  /// deflated entry has more bytes than the directory says.
  absl::StatusOr<std::string> read(const Entry& entry) const;

 private:
  explicit ZipArchive(absl::string_view bytes) : bytes_(bytes) {}
  absl::string_view bytes_;
  std::vector<Entry> entries_;
};

/// Returns true if a file of this name, joined to a folder, lies below the folder. Such a name is
/// relative and not empty. It has no empty parts, no parts "." or "..", no backslashes and no
/// control characters. It has at most 1,000 bytes, each part at most 255.
bool is_safe_name(absl::string_view name);

}  // namespace bandsaw
