// Decompresses by zlib, piece by piece, up to a limit. A gzip file may consist of several members,
// one after the other.

#include "renderlib/import/files/inflate.h"

#include <zlib.h>

#include <algorithm>
#include <limits>

#include "absl/cleanup/cleanup.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"

namespace bandsaw {
namespace {

constexpr std::size_t kPiece = std::size_t{1} << 18;
// Values of zlib's windowBits. 15 is the largest window. Adding 32 makes zlib detect the kind of
// header, and a negative number means that there is no header.
constexpr int kGzipOrZlib = 15 + 32;
constexpr int kRaw = -15;

/// Inflates the member at the front of the stream's input and appends the bytes to `out`. Returns
/// RESOURCE_EXHAUSTED if `out` then has more than `max_bytes`, and INVALID_ARGUMENT if the data are
/// damaged.
absl::Status inflate_member(z_stream& stream, std::uint64_t max_bytes, std::string& out) {
  int result = Z_OK;
  while (result != Z_STREAM_END) {
    const std::size_t size = out.size();
    out.resize(size + kPiece);
    stream.next_out = reinterpret_cast<Bytef*>(out.data() + size);
    stream.avail_out = kPiece;
    result = ::inflate(&stream, Z_NO_FLUSH);
    out.resize(size + kPiece - stream.avail_out);
    if (out.size() > max_bytes) {
      return absl::ResourceExhaustedError(
          absl::StrCat("is larger than ", max_bytes, " bytes when it is decompressed"));
    }
    // All input is there from the start. So if zlib reports that it needs more, the data are
    // truncated.
    if (result != Z_OK && result != Z_STREAM_END) {
      return absl::InvalidArgumentError("its compressed data are damaged or truncated");
    }
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<std::string> inflate(absl::string_view bytes, DeflateKind kind,
                                    std::uint64_t max_bytes) {
  if (bytes.size() > std::numeric_limits<uInt>::max()) {
    return absl::ResourceExhaustedError("has more than 4 GiB of compressed data");
  }
  z_stream stream = {};
  if (inflateInit2(&stream, kind == DeflateKind::kRaw ? kRaw : kGzipOrZlib) != Z_OK) {
    return absl::ResourceExhaustedError("cannot be decompressed: there is no memory");
  }
  const absl::Cleanup end = [&stream] { inflateEnd(&stream); };
  // zlib does not write to its input, but has no const in its interface.
  stream.next_in = const_cast<Bytef*>(reinterpret_cast<const Bytef*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  std::string out;
  do {
    const absl::Status status = inflate_member(stream, max_bytes, out);
    if (!status.ok()) {
      return status;
    }
  } while (kind == DeflateKind::kGzip && stream.avail_in > 0 && inflateReset(&stream) == Z_OK);
  if (stream.avail_in > 0) {
    return absl::InvalidArgumentError("bytes follow the end of its compressed data");
  }
  return out;
}

bool is_gzip(absl::string_view bytes) { return absl::StartsWith(bytes, "\x1f\x8b"); }

}  // namespace bandsaw
