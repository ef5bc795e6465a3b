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
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

static_assert(std::endian::native == std::endian::little, "the file is little-endian");

/// Bytes of the magic and the size, with which a record begins (renderlib/render/band_file.h).
constexpr std::size_t kSizeEnd = kBandRecordMagic.size() + sizeof(std::uint64_t);
/// The largest band that a worker may send, plus the other fields of a record.
constexpr std::uint64_t kMaxRecordBytes = wire::kBandBytes + 4096;

/// Bytes of the first read of a record: more than a record has without its sums.
constexpr std::uint64_t kHeadBytes = 4096;
/// Bytes of each read in the search for the next record.
constexpr std::uint64_t kSearchBytes = 1 << 20;
/// After a failed read, the same bytes are read again in blocks of this size, so that few are lost.
constexpr std::uint64_t kBlockBytes = 4096;

/// The bytes of a log. The file is not mapped, because an access to an unreadable sector of a
/// mapping would end the process.
class LogBytes {
 public:
  /// `file` MUST outlive this object; `size` is the size of the file.
  LogBytes(const File& file, std::uint64_t size) : file_(file), size_(size) {}
  std::uint64_t size() const { return size_; }
  /// Returns true if the disk could not read some bytes in any call of read().
  bool unreadable() const { return unreadable_; }

  /// Returns `most` bytes from `offset` (<= size()) on, or fewer at the end of the log. A block
  /// that the disk cannot read is returned as zeros, so that only records in this block are
  /// damaged. Other errors are those of File::read.
  absl::StatusOr<std::vector<std::byte>> read(std::uint64_t offset, std::uint64_t most) {
    std::vector<std::byte> bytes(std::min(most, size_ - offset));
    const absl::Status status = file_.read(offset, absl::MakeSpan(bytes));
    if (is_unreadable(status)) {
      unreadable_ = true;
      RETURN_IF_ERROR(read_blocks(offset, absl::MakeSpan(bytes)));
      return bytes;
    }
    RETURN_IF_ERROR(status);
    return bytes;
  }

 private:
  /// Fills `bytes` block by block, with zeros for each block that the disk cannot read.
  absl::Status read_blocks(std::uint64_t offset, absl::Span<std::byte> bytes) const {
    while (!bytes.empty()) {
      const auto block = bytes.subspan(0, kBlockBytes - offset % kBlockBytes);
      const absl::Status status = file_.read(offset, block);
      if (is_unreadable(status)) {
        std::fill(block.begin(), block.end(), std::byte{0});
      } else {
        RETURN_IF_ERROR(status);
      }
      offset += block.size();
      bytes.remove_prefix(block.size());
    }
    return absl::OkStatus();
  }

  const File& file_;
  const std::uint64_t size_;
  bool unreadable_ = false;
};

/// Returns the offset of the next magic at or after `offset`, where a record may begin; the end of
/// the log if there is none.
absl::StatusOr<std::uint64_t> next_magic(LogBytes& log, std::uint64_t offset) {
  const auto* magic = reinterpret_cast<const std::byte*>(kBandRecordMagic.data());
  while (offset + kBandRecordMagic.size() <= log.size()) {
    ASSIGN_OR_RETURN(const std::vector<std::byte> bytes, log.read(offset, kSearchBytes));
    const auto found =
        std::search(bytes.begin(), bytes.end(), magic, magic + kBandRecordMagic.size());
    if (found != bytes.end()) {
      return offset + static_cast<std::uint64_t>(found - bytes.begin());
    }
    offset += bytes.size() - (kBandRecordMagic.size() - 1);  // a magic may begin in the last bytes
  }
  return log.size();
}

/// Returns the record at `offset`. DATA_LOSS or OUT_OF_RANGE: no complete record begins there.
/// Other errors: the log cannot be read.
absl::StatusOr<DecodedBandRecord> record_at(LogBytes& log, std::uint64_t offset) {
  ASSIGN_OR_RETURN(const std::vector<std::byte> head, log.read(offset, kHeadBytes));
  absl::StatusOr<DecodedBandRecord> decoded = decode_band_record(head);
  if (!absl::IsOutOfRange(decoded.status()) || head.size() < kSizeEnd) {
    return decoded;
  }
  std::uint64_t size = 0;
  std::memcpy(&size, head.data() + kBandRecordMagic.size(), sizeof size);
  if (size <= head.size() || size > kMaxRecordBytes || size > log.size() - offset) {
    return decoded;
  }
  ASSIGN_OR_RETURN(const std::vector<std::byte> whole, log.read(offset, size));
  return decode_band_record(whole);
}

/// Calls `each` with every complete record and its offset, counts records and damaged bytes in
/// `report`, and returns the end of the last complete record. Fails only if the log cannot be read.
absl::StatusOr<std::uint64_t> read_records(LogBytes& log,
                                           absl::FunctionRef<void(BandRecord, std::uint64_t)> each,
                                           BandLogReport& report) {
  std::uint64_t offset = 0;
  std::uint64_t sound_end = 0;
  while (offset < log.size()) {
    absl::StatusOr<DecodedBandRecord> decoded = record_at(log, offset);
    if (absl::IsDataLoss(decoded.status()) || absl::IsOutOfRange(decoded.status())) {
      ASSIGN_OR_RETURN(const std::uint64_t next, next_magic(log, offset + 1));
      report.damaged_bytes += next - offset;
      offset = next;
      continue;
    }
    RETURN_IF_ERROR(decoded.status());
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
  ASSIGN_OR_RETURN(std::uint64_t size, file.size());
  LogBytes log(file, size);
  ASSIGN_OR_RETURN(const std::uint64_t sound_end, read_records(log, each, report));
  // If the disk could not read some bytes, nothing is cut off: it may read them at the next start.
  if (size != sound_end && !log.unreadable()) {
    RETURN_IF_ERROR(file.truncate(sound_end));
    RETURN_IF_ERROR(file.sync());
    size = sound_end;
  }
  return BandLog(std::move(file), size);
}

absl::StatusOr<std::uint64_t> BandLog::append(const BandRecord& record) {
  if (torn_) {
    RETURN_IF_ERROR(take_back(size_));
  }
  ASSIGN_OR_RETURN(const std::vector<std::byte> bytes, encode_band_record(record));
  const absl::Status written = file_.write(bytes);
  if (!written.ok()) {
    torn_ = true;
    take_back(size_).IgnoreError();  // if this fails, the next append tries it again
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
  // As for LogBytes, the file is read, not mapped. So an unreadable sector is an error of one band,
  // and does not end the process.
  std::array<std::byte, kSizeEnd> head{};
  RETURN_IF_ERROR(file.read(offset, absl::MakeSpan(head)));
  std::uint64_t size = 0;
  std::memcpy(&size, head.data() + kBandRecordMagic.size(), sizeof size);
  if (size < head.size() || size > kMaxRecordBytes) {
    return absl::DataLossError(absl::StrCat(path, ": no record begins at byte ", offset,
                                            ", because it would have ", size, " bytes"));
  }
  std::vector<std::byte> bytes(size);
  RETURN_IF_ERROR(file.read(offset, absl::MakeSpan(bytes)));
  ASSIGN_OR_RETURN(DecodedBandRecord decoded, decode_band_record(bytes));
  return std::move(decoded.record);
}

}  // namespace bandsaw::coordinator
