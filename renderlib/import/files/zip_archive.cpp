// Reads a zip archive: finds the directory at its end, reads the entries with all checks, and
// inflates an entry on request. The records are those of APPNOTE.TXT, section 4.3.

#include "renderlib/import/files/zip_archive.h"

#include <zlib.h>

#include <algorithm>
#include <optional>
#include <set>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/files/inflate.h"

namespace bandsaw {
namespace {

// Signatures of the records, and their sizes without fields of variable length.
constexpr std::uint32_t kLocalHeader = 0x04034b50;
constexpr std::uint32_t kDirectoryEntry = 0x02014b50;
constexpr std::uint32_t kDirectoryEnd = 0x06054b50;
constexpr std::uint32_t kDirectoryEnd64 = 0x06064b50;
constexpr std::uint32_t kLocator64 = 0x07064b50;
constexpr std::size_t kLocalHeaderBytes = 30;
constexpr std::size_t kEndBytes = 22;
constexpr std::size_t kEnd64Bytes = 56;
constexpr std::size_t kLocator64Bytes = 20;
constexpr std::uint32_t kIn64 = 0xffffffff;  // means that the number is in the zip64 extra field
constexpr std::uint64_t kMaxNameBytes = 1000;

absl::Status damaged(absl::string_view what) {
  return absl::InvalidArgumentError(absl::StrCat("is not a zip file that can be read: ", what));
}

/// Reads little-endian numbers, from the byte `at` on. A number beyond the end is 0, and `past_end`
/// is set.
class Reader {
 public:
  Reader(absl::string_view bytes, std::uint64_t at) : bytes_(bytes), at_(at) {}
  /// Reads the next number, which has `size` bytes.
  std::uint64_t number(std::size_t size) {
    std::uint64_t value = 0;
    const absl::string_view part = text(size);
    for (std::size_t i = part.size(); i-- > 0;) {
      value = value << 8 | static_cast<unsigned char>(part[i]);
    }
    return value;
  }
  std::uint32_t u16() { return static_cast<std::uint32_t>(number(2)); }
  std::uint32_t u32() { return static_cast<std::uint32_t>(number(4)); }
  /// Returns the next `size` bytes and moves past them.
  absl::string_view text(std::uint64_t size) {
    if (at_ > bytes_.size() || size > bytes_.size() - at_) {
      past_end = true;
      return {};
    }
    const absl::string_view part =
        bytes_.substr(static_cast<std::size_t>(at_), static_cast<std::size_t>(size));
    at_ += size;
    return part;
  }
  std::uint64_t at() const { return at_; }
  bool past_end = false;

 private:
  absl::string_view bytes_;
  std::uint64_t at_;
};

struct Directory {
  std::uint64_t at = 0;  ///< offset of the first entry
  std::uint64_t entries = 0;
};

/// Returns the offset of the end record. A comment, whose length has 16 bits, may follow it.
std::optional<std::uint64_t> find_end(absl::string_view bytes) {
  constexpr std::size_t kMaxComment = 65'535;
  if (bytes.size() < kEndBytes) {
    return std::nullopt;
  }
  const std::size_t last = bytes.size() - kEndBytes;
  for (std::size_t back = 0; back <= std::min(last, kMaxComment); ++back) {
    if (Reader(bytes, last - back).u32() == kDirectoryEnd) {
      return last - back;
    }
  }
  return std::nullopt;
}

/// Reads the record at the end of the archive, and the zip64 record if there is one.
absl::StatusOr<Directory> find_directory(absl::string_view bytes) {
  const auto end = find_end(bytes);
  if (!end) {
    return damaged("it has no directory; it is truncated or of another kind");
  }
  Reader in(bytes, *end + 4);
  const std::uint32_t disk = in.u16();
  in.number(2 + 2);  // disk of the directory, number of entries on it
  Directory directory{0, in.u16()};
  in.u32();  // size of the directory
  directory.at = in.u32();
  if (disk != 0 && disk != 0xffff) {
    return damaged("it is one part of an archive that is split into several files");
  }
  if (*end < kLocator64Bytes || Reader(bytes, *end - kLocator64Bytes).u32() != kLocator64) {
    return directory;
  }
  // The locator has the offset of the zip64 record, which has 64-bit numbers.
  const std::uint64_t at64 = Reader(bytes, *end - kLocator64Bytes + 8).number(8);
  if (at64 > bytes.size() || bytes.size() - at64 < kEnd64Bytes ||
      Reader(bytes, at64).u32() != kDirectoryEnd64) {
    return damaged("its zip64 record is missing");
  }
  directory.entries = Reader(bytes, at64 + 32).number(8);
  directory.at = Reader(bytes, at64 + 48).number(8);
  return directory;
}

/// Replaces the entry's numbers that are too large for 32 bits by those of the zip64 extra field.
void read_extra(absl::string_view extra, ZipArchive::Entry& entry) {
  constexpr std::uint32_t kZip64 = 1;
  Reader in(extra, 0);
  while (!in.past_end && in.at() + 4 <= extra.size()) {
    const std::uint32_t kind = in.u16();
    const std::uint32_t size = in.u16();
    if (kind != kZip64) {
      in.text(size);
      continue;
    }
    for (std::uint64_t* number : {&entry.bytes, &entry.packed_bytes, &entry.header_at}) {
      if (*number == kIn64) {
        *number = in.number(8);
      }
    }
    return;
  }
}

/// Returns true if the entry was made on Unix and its file mode is that of a symbolic link.
bool is_link(std::uint32_t made_by, std::uint32_t attributes) {
  constexpr std::uint32_t kUnix = 3;
  constexpr std::uint32_t kKind = 0xf000;
  constexpr std::uint32_t kLink = 0xa000;
  return made_by >> 8 == kUnix && (attributes >> 16 & kKind) == kLink;
}

/// Reads one entry of the directory; std::nullopt for a folder.
absl::StatusOr<std::optional<ZipArchive::Entry>> read_entry(Reader& in) {
  ZipArchive::Entry entry;
  const std::uint32_t signature = in.u32();
  const std::uint32_t made_by = in.u16();
  in.u16();  // version needed
  const std::uint32_t flags = in.u16();
  const std::uint32_t method = in.u16();
  in.u32();  // time and date
  entry.crc = in.u32();
  entry.packed_bytes = in.u32();
  entry.bytes = in.u32();
  const std::uint32_t name_bytes = in.u16();
  const std::uint32_t extra_bytes = in.u16();
  const std::uint32_t comment_bytes = in.u16();
  in.number(2 + 2);  // disk, internal attributes
  const std::uint32_t attributes = in.u32();
  entry.header_at = in.u32();
  entry.name = std::string(in.text(name_bytes));
  read_extra(in.text(extra_bytes), entry);
  in.text(comment_bytes);
  if (in.past_end || signature != kDirectoryEntry) {
    return damaged("its directory is damaged");
  }
  if (absl::EndsWith(entry.name, "/")) {
    return std::nullopt;
  }
  if (!is_safe_name(entry.name)) {
    return absl::InvalidArgumentError(
        absl::StrCat("has a file named \"", entry.name, "\", which is not a path within it"));
  }
  if (is_link(made_by, attributes)) {
    return absl::InvalidArgumentError(
        absl::StrCat("\"", entry.name, "\" in it is a symbolic link; pack the file itself"));
  }
  constexpr std::uint32_t kEncrypted = 1;
  if ((flags & kEncrypted) != 0) {
    return absl::InvalidArgumentError(absl::StrCat("\"", entry.name, "\" in it is encrypted"));
  }
  constexpr std::uint32_t kStored = 0;
  constexpr std::uint32_t kDeflated = 8;
  if (method != kStored && method != kDeflated) {
    return absl::InvalidArgumentError(absl::StrCat(
        "\"", entry.name, "\" in it is compressed by method ", method, "; pack it with deflate"));
  }
  entry.is_deflated = method == kDeflated;
  return entry;
}

}  // namespace

bool is_safe_name(absl::string_view name) {
  if (name.empty() || name.size() > kMaxNameBytes || name.front() == '/') {
    return false;
  }
  if (std::any_of(name.begin(), name.end(), [](char c) {
        return static_cast<unsigned char>(c) < 0x20 || c == '\x7f' || c == '\\';
      })) {
    return false;
  }
  for (const absl::string_view part : absl::StrSplit(name, '/')) {
    if (part.empty() || part == "." || part == ".." || part.size() > 255) {
      return false;
    }
  }
  return true;
}

absl::StatusOr<ZipArchive> ZipArchive::open(absl::string_view bytes) {
  ASSIGN_OR_RETURN(const Directory directory, find_directory(bytes));
  ZipArchive archive(bytes);
  Reader in(bytes, directory.at);
  std::set<std::string> names;
  std::uint64_t total = 0;
  for (std::uint64_t i = 0; i < directory.entries; ++i) {
    ASSIGN_OR_RETURN(std::optional<Entry> entry, read_entry(in));
    if (!entry) {
      continue;
    }
    if (!names.insert(entry->name).second) {
      return damaged(absl::StrCat("it has two files named \"", entry->name, "\""));
    }
    total += std::min(entry->bytes, kMaxUnzippedBytes + 1);
    if (total > kMaxUnzippedBytes || names.size() > kMaxZipEntries) {
      return absl::ResourceExhaustedError(absl::StrCat("holds more than ", kMaxUnzippedBytes >> 30,
                                                       " GiB or more than ", kMaxZipEntries,
                                                       " files"));
    }
    archive.entries_.push_back(*std::move(entry));
  }
  return archive;
}

absl::StatusOr<std::string> ZipArchive::read(const Entry& entry) const {
  Reader in(bytes_, entry.header_at);
  // The local header is needed for two lengths, that of the name and that of the extra field, which
  // may differ from the lengths in the directory.
  const bool has_header = in.u32() == kLocalHeader;
  in.text(kLocalHeaderBytes - 4 - 2 - 2);  // all fields between the signature and the two lengths
  const std::uint32_t name_bytes = in.u16();
  const std::uint32_t extra_bytes = in.u16();
  in.text(std::uint64_t{name_bytes} + extra_bytes);
  const absl::string_view packed = in.text(entry.packed_bytes);
  if (!has_header || in.past_end) {
    return damaged(absl::StrCat("\"", entry.name, "\" in it is truncated"));
  }
  std::string out;
  if (entry.is_deflated) {
    ASSIGN_OR_RETURN(out, inflate(packed, DeflateKind::kRaw, entry.bytes));
  } else {
    out = std::string(packed);
  }
  const auto checksum = crc32_z(0, reinterpret_cast<const Bytef*>(out.data()), out.size());
  if (out.size() != entry.bytes || checksum != entry.crc) {
    return damaged(absl::StrCat("\"", entry.name, "\" in it is damaged (checksum)"));
  }
  return out;
}

}  // namespace bandsaw
