// Writes a mesh as a binary PLY file, in the form that Assimp reads without errors. The converters
// of other renderers' scenes pass meshes to the importer as such files.

#include "renderlib/import/convert/ply_mesh.h"

#include <bit>
#include <cstddef>
#include <cstring>

#include "absl/strings/str_cat.h"

namespace bandsaw {
namespace {

static_assert(std::endian::native == std::endian::little);

/// Appends the numbers of vertex i, unless the list is empty.
template <std::size_t n>
void append(const std::vector<std::array<float, n>>& list, std::size_t i, std::string& to) {
  if (!list.empty()) {
    to.append(reinterpret_cast<const char*>(list[i].data()), n * sizeof(float));
  }
}

/// Returns the header, which lists the properties of vertices for which the mesh has numbers.
std::string header_of(const PlyMesh& mesh) {
  std::string header = absl::StrCat("ply\nformat binary_little_endian 1.0\nelement vertex ",
                                    mesh.positions.size(), "\n");
  const auto properties = [&header](bool are_there, std::initializer_list<const char*> names) {
    for (const char* name : names) {
      absl::StrAppend(&header, are_there ? absl::StrCat("property float ", name, "\n") : "");
    }
  };
  properties(true, {"x", "y", "z"});
  properties(!mesh.normals.empty(), {"nx", "ny", "nz"});
  properties(!mesh.uvs.empty(), {"u", "v"});
  properties(!mesh.colors.empty(), {"red", "green", "blue"});
  absl::StrAppend(&header, "element face ", mesh.triangles.size(),
                  "\nproperty list uchar int vertex_indices\nend_header\n");
  return header;
}

/// Returns true if Assimp would take the first byte after the header as white space. Assimp skips
/// white space there, although a number may begin with such a byte.
bool begins_with_space(const PlyMesh& mesh) {
  unsigned char first = 0;
  std::memcpy(&first, mesh.positions[0].data(), 1);
  return first <= ' ' && first != 0;
}

/// Returns the mesh with one more vertex in front, which no triangle uses. This vertex lies close
/// to the first vertex of `mesh`, and its first byte is 0, which is no white space.
PlyMesh with_plain_front(PlyMesh mesh) {
  const auto repeat_first = [](auto& list) {
    if (!list.empty()) {
      list.insert(list.begin(), list.front());
    }
  };
  repeat_first(mesh.positions);
  repeat_first(mesh.normals);
  repeat_first(mesh.uvs);
  repeat_first(mesh.colors);
  constexpr std::uint32_t kLowByte = 0xff;
  float& x = mesh.positions[0][0];
  x = std::bit_cast<float>(std::bit_cast<std::uint32_t>(x) & ~kLowByte);
  for (auto& triangle : mesh.triangles) {
    triangle = {triangle[0] + 1, triangle[1] + 1, triangle[2] + 1};
  }
  return mesh;
}

}  // namespace

std::string write_ply(const PlyMesh& mesh) {
  if (begins_with_space(mesh)) {
    return write_ply(with_plain_front(mesh));
  }
  std::string out = header_of(mesh);
  const std::size_t per_vertex = (3 + 3 + 2 + 3) * sizeof(float);
  out.reserve(out.size() + mesh.positions.size() * per_vertex + mesh.triangles.size() * 13);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    append(mesh.positions, i, out);
    append(mesh.normals, i, out);
    append(mesh.uvs, i, out);
    append(mesh.colors, i, out);
  }
  for (const auto& triangle : mesh.triangles) {
    out.push_back(3);
    out.append(reinterpret_cast<const char*>(triangle.data()), sizeof(triangle));
  }
  return out;
}

}  // namespace bandsaw
