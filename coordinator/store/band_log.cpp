// Appends records and syncs them. The reader finds the next record after a damaged one by the magic
// bytes with which each record begins.

#include "coordinator/store/band_log.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <utility>

#include "absl/strings/str_cat.h"
#include "proto/wire/limits.h"
#include "renderlib/base/mapped_file.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

static_assert(std::endian::native == std::endian::little, "the file is little-endian");

/// Bytes of the magic and the size, with which a record begins (renderlib/render/band_file.h).
constexpr std::size_t kSizeEnd = kBandRecordMagic.size() + sizeof(std::uint64_t);
/// The largest band that a worker may send, plus the other fields of a record.
constexpr std::uint64_t kMaxRecordBytes = wire::kBandBytes + 4096;

/// Returns the offset of the next magic at or after `offset`, where a record may begin; the end of
/// the file if there is none.
std::uint64_t next_magic(absl::Span<const std::byte> bytes, std::uint64_t offset) {
  const auto* magic = reinterpret_cast<const std::byte*>(kBandRecordMagic.data());
  const auto found = std::search(bytes.begin() + static_cast<std::ptrdiff_t>(offset), bytes.end(),
                                 magic, magic + kBandRecordMagic.size());
  return static_cast<std::uint64_t>(found - bytes.begin());
}

/// Calls `each` with every complete record and returns the end of the last one.
std::uint64_t read_records(absl::Span<const std::byte> bytes,
                           absl::FunctionRef<void(BandRecord, std::uint64_t)> each,
                           BandLogReport& report) {
  std::uint64_t offset = 0;
  std::uint64_t sound_end = 0;
  while (offset < bytes.size()) {
    absl::StatusOr<DecodedBandRecord> decoded = decode_band_record(bytes, offset);
    if (!decoded.ok()) {
      const std::uint64_t next = next_magic(bytes, offset + 1);
      report.damaged_bytes += next - offset;
      offset = next;
      continue;
    }
    ++report.records;
    each(std::move(decoded->record), offset);
    offset += decoded->size;
    sound_end = offset;
  }
  return sound_end;
}

}  // namespace

absl::StatusOr<BandLog> BandLog::open(const std::string& folder, const std::string& path,
                                      absl::FunctionRef<void(BandRecord, std::uint64_t)> each,
                                      BandLogReport& report) {
  ASSIGN_OR_RETURN(File file, File::open(path, O_RDWR | O_CREAT | O_APPEND));
  RETURN_IF_ERROR(sync_folder(folder));
  std::uint64_t sound_end = 0;
  std::uint64_t size = 0;
  {
    ASSIGN_OR_RETURN(const MappedFile mapped, MappedFile::open(path));
    size = mapped.bytes().size();
    sound_end = read_records(mapped.bytes(), each, report);
  }
  if (size != sound_end) {
    RETURN_IF_ERROR(file.truncate(sound_end));
    RETURN_IF_ERROR(file.sync());
  }
  return BandLog(std::move(file), sound_end);
}

absl::StatusOr<std::uint64_t> BandLog::append(const BandRecord& record) {
  if (torn_) {
    RETURN_IF_ERROR(take_back(size_));
  }
  ASSIGN_OR_RETURN(const std::vector<std::byte> bytes, encode_band_record(record));
  const absl::Status written = file_.write(bytes);
  if (!written.ok()) {
    torn_ = true;
    take_back(size_).IgnoreError();  // otherwise tried again before the next append
    return written;
  }
  return std::exchange(size_, size_ + bytes.size());
}

absl::Status BandLog::sync() {
  if (size_ == synced_) {
    return absl::OkStatus();
  }
  const absl::Status synced = file_.sync();
  if (!synced.ok()) {
    // After a failed fdatasync the kernel may mark the pages as clean although they were not
    // written. So the log is truncated, and the callers, which still have the bytes, send them
    // again.
    size_ = synced_;
    torn_ = true;
    take_back(synced_).IgnoreError();
    return synced;
  }
  synced_ = size_;
  return absl::OkStatus();
}

absl::Status BandLog::take_back(std::uint64_t size) {
  RETURN_IF_ERROR(file_.truncate(size));
  torn_ = false;
  return absl::OkStatus();
}

absl::StatusOr<BandRecord> read_band(const std::string& path, std::uint64_t offset) {
  ASSIGN_OR_RETURN(const File file, File::open(path, O_RDONLY));
  // The file is not mapped: an unreadable sector is then an error for one band, whereas in a
  // mapping it would end the process.
  std::array<std::byte, kSizeEnd> head{};
  RETURN_IF_ERROR(file.read(offset, absl::MakeSpan(head)));
  std::uint64_t size = 0;
  std::memcpy(&size, head.data() + kBandRecordMagic.size(), sizeof size);
  if (size < head.size() || size > kMaxRecordBytes) {
    return absl::DataLossError(absl::StrCat(path, ": no record begins at byte ", offset,
                                            ": it would have ", size, " bytes"));
  }
  std::vector<std::byte> bytes(size);
  RETURN_IF_ERROR(file.read(offset, absl::MakeSpan(bytes)));
  ASSIGN_OR_RETURN(DecodedBandRecord decoded, decode_band_record(bytes));
  return std::move(decoded.record);
}

}  // namespace bandsaw::coordinator
