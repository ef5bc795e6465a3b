// Reads a Wavefront OBJ line by line. Each combination of position, uv and normal becomes one
// vertex.

#include <array>
#include <cmath>
#include <map>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/mitsuba/source_mesh.h"

namespace bandsaw::mitsuba {
namespace {

constexpr std::uint32_t kNone = 0xffffffffu;
/// The indices of a position, a uv and a normal. A uv or normal that is missing is kNone.
using Corner = std::array<std::uint32_t, 3>;

class ObjReader {
 public:
  /// If `flip_v` is set, each v of the file becomes 1 - v.
  explicit ObjReader(bool flip_v) : flip_v_(flip_v) {}

  absl::StatusOr<SourceMesh> read(absl::string_view bytes) {
    std::size_t number = 0;
    for (const absl::string_view line : absl::StrSplit(bytes, '\n')) {
      ++number;
      if (const absl::Status good = read_line(line); !good.ok()) {
        return absl::InvalidArgumentError(absl::StrCat("line ", number, ": ", good.message()));
      }
    }
    if (out_.mesh.triangles.empty()) {
      return absl::InvalidArgumentError("has no faces");
    }
    finish();
    return std::move(out_);
  }

 private:
  /// Reads a position, normal, uv or face. Ignores lines with other keywords.
  absl::Status read_line(absl::string_view line) {
    const std::vector<absl::string_view> parts =
        absl::StrSplit(line, absl::ByAnyChar(" \t\r"), absl::SkipEmpty());
    if (parts.empty()) {
      return absl::OkStatus();
    }
    if (parts[0] == "v") {
      return read_floats(parts, positions_);
    }
    if (parts[0] == "vn") {
      return read_floats(parts, normals_);
    }
    if (parts[0] == "vt") {
      RETURN_IF_ERROR(read_floats(parts, uvs_));
      uvs_.back()[1] = flip_v_ ? 1 - uvs_.back()[1] : uvs_.back()[1];
      return absl::OkStatus();
    }
    return parts[0] == "f" ? read_face(parts) : absl::OkStatus();
  }

  /// Appends to `to` the n numbers that follow the keyword parts[0].
  template <std::size_t n>
  static absl::Status read_floats(const std::vector<absl::string_view>& parts,
                                  std::vector<std::array<float, n>>& to) {
    if (parts.size() < n + 1) {
      return absl::InvalidArgumentError(absl::StrCat("needs ", n, " numbers"));
    }
    std::array<float, n> numbers;
    for (std::size_t i = 0; i < n; ++i) {
      if (!absl::SimpleAtof(parts[i + 1], &numbers[i]) || !std::isfinite(numbers[i])) {
        return absl::InvalidArgumentError(
            absl::StrCat("\"", parts[i + 1].substr(0, 40), "\" is not a finite number"));
      }
    }
    to.push_back(numbers);
    return absl::OkStatus();
  }

  /// Reads an index of a list of `count` entries. In the file, a positive index counts from 1, and
  /// a negative one counts backwards from the end. The result counts from 0.
  static absl::StatusOr<std::uint32_t> read_index(absl::string_view text, std::size_t count) {
    std::int64_t index = 0;
    if (!absl::SimpleAtoi(text, &index)) {
      return absl::InvalidArgumentError(
          absl::StrCat("\"", text.substr(0, 40), "\" is not an index"));
    }
    const auto size = static_cast<std::int64_t>(count);
    const std::int64_t from_zero = index < 0 ? size + index : index - 1;
    if (from_zero < 0 || from_zero >= size) {
      return absl::InvalidArgumentError(
          absl::StrCat("index ", index, " is out of range: the number of entries is ", count));
    }
    return static_cast<std::uint32_t>(from_zero);
  }

  /// Reads a corner of a face, such as "1/2/3". Returns the number of its vertex, which is new if
  /// no earlier corner has the same indices.
  absl::StatusOr<std::uint32_t> read_corner(absl::string_view text) {
    const std::vector<absl::string_view> indices = absl::StrSplit(text, '/');
    if (indices.size() > 3) {
      return absl::InvalidArgumentError("a corner has more than three indices");
    }
    Corner corner{kNone, kNone, kNone};
    ASSIGN_OR_RETURN(corner[0], read_index(indices[0], positions_.size()));
    if (indices.size() > 1 && !indices[1].empty()) {
      ASSIGN_OR_RETURN(corner[1], read_index(indices[1], uvs_.size()));
    }
    if (indices.size() > 2 && !indices[2].empty()) {
      ASSIGN_OR_RETURN(corner[2], read_index(indices[2], normals_.size()));
    }
    const auto next = static_cast<std::uint32_t>(corners_.size());
    const auto [known, is_new] = known_.emplace(corner, next);
    if (is_new) {
      corners_.push_back(corner);
    }
    return known->second;
  }

  /// Reads a polygon and splits it into a fan of triangles around its first corner.
  absl::Status read_face(const std::vector<absl::string_view>& parts) {
    if (parts.size() < 4) {
      return absl::InvalidArgumentError("a face needs three corners");
    }
    std::array<std::uint32_t, 3> triangle{};
    for (std::size_t i = 1; i < parts.size(); ++i) {
      ASSIGN_OR_RETURN(const std::uint32_t vertex, read_corner(parts[i]));
      triangle[1] = i > 3 ? triangle[2] : triangle[1];
      triangle[i > 3 ? 2 : i - 1] = vertex;
      if (i >= 3) {
        out_.mesh.triangles.push_back(triangle);
      }
    }
    return absl::OkStatus();
  }

  /// Makes the vertices of the mesh. If a corner has no normal, the mesh gets no normals.
  void finish() {
    PlyMesh& mesh = out_.mesh;
    bool all_normals = true;
    for (const Corner& corner : corners_) {
      mesh.positions.push_back(positions_[corner[0]]);
      if (!uvs_.empty()) {
        mesh.uvs.push_back(corner[1] == kNone ? std::array<float, 2>{} : uvs_[corner[1]]);
      }
      all_normals = all_normals && corner[2] != kNone;
      mesh.normals.push_back(corner[2] == kNone ? std::array<float, 3>{} : normals_[corner[2]]);
    }
    if (!all_normals) {
      mesh.normals.clear();
    }
  }

  bool flip_v_;
  SourceMesh out_;
  std::vector<std::array<float, 3>> positions_;
  std::vector<std::array<float, 2>> uvs_;
  std::vector<std::array<float, 3>> normals_;
  std::vector<Corner> corners_;
  std::map<Corner, std::uint32_t> known_;
};

}  // namespace

absl::StatusOr<SourceMesh> read_obj(absl::string_view bytes, bool flip_v) {
  return ObjReader(flip_v).read(bytes);
}

}  // namespace bandsaw::mitsuba
