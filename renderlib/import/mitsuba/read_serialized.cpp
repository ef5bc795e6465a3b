// Reads one mesh of Mitsuba's *.serialized format. Finds the offset of the mesh in the table at the
// end of the file, decompresses the data at this offset, and reads vertices and triangles.

#include <zlib.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/mitsuba/source_mesh.h"

namespace bandsaw::mitsuba {
namespace {

static_assert(std::endian::native == std::endian::little, "the format is little-endian");

constexpr std::uint16_t kMagic = 0x041c;
constexpr std::uint16_t kVersion3 = 3;
constexpr std::uint16_t kVersion4 = 4;
// Flags of a mesh.
constexpr std::uint32_t kHasNormals = 0x0001;
constexpr std::uint32_t kHasUvs = 0x0002;
constexpr std::uint32_t kHasColors = 0x0008;
constexpr std::uint32_t kFaceNormals = 0x0010;
constexpr std::uint32_t kDouble = 0x2000;

absl::Status damaged(absl::string_view why) {
  return absl::InvalidArgumentError(absl::StrCat("is damaged: ", why));
}

/// Returns the number of type T at `offset`.
template <class T>
absl::StatusOr<T> value_at(absl::string_view bytes, std::uint64_t offset) {
  if (offset > bytes.size() || bytes.size() - offset < sizeof(T)) {
    return damaged("it ends too early");
  }
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof(T));
  return value;
}

/// Decompresses a stream. Memory grows with the data that arrive, not with the size that a header
/// claims.
class Inflater {
 public:
  explicit Inflater(absl::string_view bytes) : rest_(bytes) {
    stream_.next_in = nullptr;
    good_ = inflateInit(&stream_) == Z_OK;
  }
  ~Inflater() { inflateEnd(&stream_); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  /// Returns the next `size` bytes.
  absl::StatusOr<std::string> take(std::uint64_t size) {
    constexpr std::uint64_t kStep = std::uint64_t{1} << 20;
    if (size > kMaxMeshBytes - taken_) {
      return absl::InvalidArgumentError("is too large: a mesh may have 4 GB");
    }
    std::string out;
    while (out.size() < size) {
      const std::size_t before = out.size();
      const std::uint64_t step = std::min(kStep, size - before);
      out.resize(before + step);
      const std::uint64_t got = fill(out.data() + before, step);
      if (got < step) {
        return damaged("its compressed data end too early");
      }
    }
    taken_ += size;
    return out;
  }

  /// Returns the next sizeof(T) bytes as a number of type T.
  template <class T>
  absl::StatusOr<T> number() {
    ASSIGN_OR_RETURN(const std::string bytes, take(sizeof(T)));
    return value_at<T>(bytes, 0);
  }

 private:
  /// Decompresses up to `size` bytes to `to`. Returns the number of decompressed bytes. It is
  /// smaller than `size` if the stream ends or is damaged.
  std::uint64_t fill(char* to, std::uint64_t size) {
    constexpr std::size_t kMaxPiece = std::size_t{1} << 30;
    stream_.next_out = reinterpret_cast<Bytef*>(to);
    stream_.avail_out = static_cast<uInt>(size);
    while (good_ && stream_.avail_out > 0) {
      if (stream_.avail_in == 0 && !rest_.empty()) {
        const std::size_t piece = std::min(kMaxPiece, rest_.size());
        stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(rest_.data()));
        stream_.avail_in = static_cast<uInt>(piece);
        rest_.remove_prefix(piece);
      }
      const uInt before = stream_.avail_out;
      good_ = inflate(&stream_, Z_NO_FLUSH) == Z_OK;
      if (before == stream_.avail_out && stream_.avail_in == 0) {
        break;
      }
    }
    return size - stream_.avail_out;
  }

  absl::string_view rest_;
  z_stream stream_ = {};
  bool good_ = false;
  std::uint64_t taken_ = 0;
};

/// Returns the offset of a mesh in the file. The end of the file is a table with the offset of each
/// mesh, followed by the number of meshes.
absl::StatusOr<std::uint64_t> offset_of(absl::string_view bytes, std::int64_t index,
                                        std::uint16_t version) {
  if (index == 0) {
    return 0;
  }
  if (bytes.size() < sizeof(std::uint32_t)) {
    return damaged("it ends too early");
  }
  ASSIGN_OR_RETURN(const std::uint32_t count,
                   value_at<std::uint32_t>(bytes, bytes.size() - sizeof(std::uint32_t)));
  if (index < 0 || index >= count) {
    return absl::InvalidArgumentError(
        absl::StrCat("has no mesh ", index, ": it has ", count, " meshes, counted from 0"));
  }
  const std::uint64_t entry = version == kVersion4 ? 8 : 4;
  const std::uint64_t from_end = sizeof(std::uint32_t) + entry * (count - index);
  if (from_end > bytes.size()) {
    return damaged("the table of its meshes is longer than the file");
  }
  const std::uint64_t at = bytes.size() - from_end;
  if (version == kVersion4) {
    return value_at<std::uint64_t>(bytes, at);
  }
  ASSIGN_OR_RETURN(const std::uint32_t offset, value_at<std::uint32_t>(bytes, at));
  return offset;
}

/// Reads `count` vectors, each of `n` finite numbers of type From, and converts them to floats.
template <class From, std::size_t n>
absl::Status read_vectors(Inflater& in, std::uint64_t count,
                          std::vector<std::array<float, n>>& to) {
  if (count > kMaxMeshBytes / (n * sizeof(From))) {
    return absl::InvalidArgumentError("is too large: a mesh may have 4 GB");
  }
  ASSIGN_OR_RETURN(const std::string bytes, in.take(count * n * sizeof(From)));
  to.resize(count);
  for (std::uint64_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < n; ++k) {
      From value;
      std::memcpy(&value, bytes.data() + (i * n + k) * sizeof(From), sizeof(From));
      to[i][k] = static_cast<float>(value);
      if (!std::isfinite(to[i][k])) {
        return damaged("it has a number that is not finite");
      }
    }
  }
  return absl::OkStatus();
}

/// Reads `count` vertices of numbers of type From. `flags` says what a vertex has besides its
/// position.
template <class From>
absl::Status read_vertices(Inflater& in, std::uint32_t flags, std::uint64_t count, PlyMesh& mesh) {
  RETURN_IF_ERROR((read_vectors<From, 3>(in, count, mesh.positions)));
  if ((flags & kHasNormals) != 0) {
    RETURN_IF_ERROR((read_vectors<From, 3>(in, count, mesh.normals)));
  }
  if ((flags & kHasUvs) != 0) {
    RETURN_IF_ERROR((read_vectors<From, 2>(in, count, mesh.uvs)));
  }
  if ((flags & kHasColors) != 0) {
    RETURN_IF_ERROR((read_vectors<From, 3>(in, count, mesh.colors)));
  }
  return absl::OkStatus();
}

/// Reads `count` triangles and checks the indices of their vertices.
absl::Status read_triangles(Inflater& in, std::uint64_t count, PlyMesh& mesh) {
  // A triangle has three 32-bit indices, which are 12 bytes.
  if (count == 0 || count > kMaxMeshBytes / 12) {
    return damaged(absl::StrCat("it has ", count, " triangles"));
  }
  if (mesh.positions.size() > std::numeric_limits<std::uint32_t>::max()) {
    return absl::InvalidArgumentError("has more vertices than 32 bits can count");
  }
  ASSIGN_OR_RETURN(const std::string bytes, in.take(count * 12));
  mesh.triangles.resize(count);
  std::memcpy(mesh.triangles.data(), bytes.data(), bytes.size());
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t index : triangle) {
      if (index >= mesh.positions.size()) {
        return damaged(absl::StrCat("a triangle refers to vertex ", index,
                                    "; the number of vertices is ", mesh.positions.size()));
      }
    }
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<SourceMesh> read_serialized(absl::string_view bytes, std::int64_t index,
                                           bool flip_v) {
  ASSIGN_OR_RETURN(const std::uint16_t magic, value_at<std::uint16_t>(bytes, 0));
  ASSIGN_OR_RETURN(const std::uint16_t version, value_at<std::uint16_t>(bytes, 2));
  if (magic != kMagic || (version != kVersion3 && version != kVersion4)) {
    return absl::InvalidArgumentError("is not a *.serialized file of version 3 or 4");
  }
  ASSIGN_OR_RETURN(const std::uint64_t offset, offset_of(bytes, index, version));
  if (offset > bytes.size() || bytes.size() - offset < 4) {
    return damaged("a mesh begins behind the end of the file");
  }
  // The compressed data follow the magic number and the version, which have 2 bytes each.
  Inflater in(bytes.substr(offset + 4));
  ASSIGN_OR_RETURN(const std::uint32_t flags, in.number<std::uint32_t>());
  if (version == kVersion4) {
    for (char name = 1; name != 0;) {  // skips the mesh's name, which ends with a zero byte
      ASSIGN_OR_RETURN(name, in.number<char>());
    }
  }
  ASSIGN_OR_RETURN(const std::uint64_t vertices, in.number<std::uint64_t>());
  ASSIGN_OR_RETURN(const std::uint64_t triangles, in.number<std::uint64_t>());
  SourceMesh out;
  RETURN_IF_ERROR((flags & kDouble) != 0 ? read_vertices<double>(in, flags, vertices, out.mesh)
                                         : read_vertices<float>(in, flags, vertices, out.mesh));
  RETURN_IF_ERROR(read_triangles(in, triangles, out.mesh));
  out.faceted = (flags & kFaceNormals) != 0;
  if (!out.mesh.colors.empty()) {
    MeshAttribute color{"vertex_color", /*per_face=*/false, /*channels=*/3, {}};
    for (const auto& c : out.mesh.colors) {
      color.values.insert(color.values.end(), c.begin(), c.end());
    }
    out.attributes.push_back(std::move(color));
    out.mesh.colors.clear();
  }
  for (auto& uv : out.mesh.uvs) {
    uv[1] = flip_v ? 1 - uv[1] : uv[1];
  }
  return out;
}

}  // namespace bandsaw::mitsuba
