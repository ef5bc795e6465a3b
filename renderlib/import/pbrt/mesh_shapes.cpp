// Converts shapes of pbrt to triangle meshes: one function for each kind. Quadrics and curved
// patches become grids of vertices (add_grid).

#include "renderlib/import/pbrt/mesh_shapes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/convert/read_ply.h"
#include "renderlib/import/files/inflate.h"
#include "renderlib/math/constants.h"
#include "renderlib/math/elementary.h"
#include "renderlib/math/float3.h"

namespace bandsaw::pbrt {
namespace {

constexpr double kMaxCoordinate = 1e30;
constexpr int kAround = 128;  // segments of a whole turn of a quadric
constexpr std::uint64_t kMaxPlyBytes = std::uint64_t{4} << 30;

/// Reads the numbers of the parameter `name`, which has one of `types`, in groups of n.
template <std::size_t n>
absl::StatusOr<std::vector<std::array<float, n>>> tuples(const Parameters& in,
                                                         const std::string& name,
                                                         std::initializer_list<const char*> types) {
  ASSIGN_OR_RETURN(const std::vector<double> numbers, in.numbers(name, types, n));
  std::vector<std::array<float, n>> out(numbers.size() / n);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (std::abs(numbers[i]) > kMaxCoordinate) {
      return error_at(in.find(name)->place,
                      absl::StrCat("\"", name, "\" has a number beyond 1e30"));
    }
    out[i / n][i % n] = static_cast<float>(numbers[i]);
  }
  return out;
}

/// Reads the indices of faces with `group` corners each. Each index must be below `vertices`, the
/// number of vertices. If the indices are missing, a mesh of `group` vertices is one face.
absl::StatusOr<std::vector<std::uint32_t>> indices(const Parameters& in, std::size_t group,
                                                   std::size_t vertices) {
  ASSIGN_OR_RETURN(const std::vector<double> numbers, in.numbers("indices", {"integer"}, group));
  std::vector<std::uint32_t> out;
  out.reserve(numbers.size());
  for (const double number : numbers) {
    if (!(number >= 0 && number < static_cast<double>(vertices)) || number != std::floor(number)) {
      return error_at(in.find("indices")->place,
                      absl::StrCat("the index ", number, " must be a whole number below ", vertices,
                                   ", the number of points"));
    }
    out.push_back(static_cast<std::uint32_t>(number));
  }
  if (out.empty() && vertices == group) {
    for (std::uint32_t i = 0; i < group; ++i) {
      out.push_back(i);
    }
  }
  if (out.empty()) {
    return error_at(in.place, "\"integer indices\" are missing");
  }
  return out;
}

/// Reads the points, normals and uvs of a mesh.
absl::StatusOr<PlyMesh> read_vertices(const Parameters& in) {
  PlyMesh mesh;
  ASSIGN_OR_RETURN(mesh.positions, tuples<3>(in, "P", {"point3"}));
  ASSIGN_OR_RETURN(mesh.normals, tuples<3>(in, "N", {"normal", "vector3"}));
  ASSIGN_OR_RETURN(mesh.uvs, tuples<2>(in, "uv", {"point2", "float", "vector2"}));
  const std::size_t count = mesh.positions.size();
  if (count == 0) {
    return error_at(in.place, "\"point3 P\" is missing");
  }
  if ((!mesh.normals.empty() && mesh.normals.size() != count) ||
      (!mesh.uvs.empty() && mesh.uvs.size() != count)) {
    return error_at(in.place, "\"P\", \"N\" and \"uv\" must have the same number of points");
  }
  return mesh;
}

/// Makes triangles face to the side of their normals, as pbrt does.
void face_normals(PlyMesh& mesh) {
  if (mesh.normals.empty()) {
    return;
  }
  for (auto& t : mesh.triangles) {
    const Vec3 a = vec3(mesh.positions[t[0]]);
    const Vec3 n = cross(vec3(mesh.positions[t[1]]) - a, vec3(mesh.positions[t[2]]) - a);
    const Vec3 shading =
        vec3(mesh.normals[t[0]]) + vec3(mesh.normals[t[1]]) + vec3(mesh.normals[t[2]]);
    if (dot(n, shading) < 0) {
      std::swap(t[1], t[2]);
    }
  }
}

absl::StatusOr<PlyMesh> triangle_mesh(const Parameters& in) {
  ASSIGN_OR_RETURN(PlyMesh mesh, read_vertices(in));
  ASSIGN_OR_RETURN(const auto corners, indices(in, 3, mesh.positions.size()));
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    mesh.triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
  }
  if (in.find("S") != nullptr) {
    in.ignore({"S"});  // tangents
  }
  in.ignore({"faceIndices"});
  face_normals(mesh);
  return mesh;
}

absl::StatusOr<PlyMesh> loop_mesh(const Parameters& in) {
  ASSIGN_OR_RETURN(const auto points, tuples<3>(in, "P", {"point3"}));
  ASSIGN_OR_RETURN(const auto corners, indices(in, 3, points.size()));
  ASSIGN_OR_RETURN(const int levels, in.integer("levels", 3));
  in.ignore({"scheme"});
  if (levels < 0 || levels > 8) {
    return error_at(in.place, absl::StrCat("\"levels\" must be in [0, 8], is ", levels));
  }
  std::vector<Vec3> positions;
  for (const auto& p : points) {
    positions.push_back(vec3(p));
  }
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
  }
  auto mesh = subdivided(positions, triangles, levels);
  return mesh.ok() ? std::move(mesh)
                   : absl::StatusOr<PlyMesh>(absl::Status(
                         mesh.status().code(),
                         absl::StrCat(text_of(in.place), ": ", mesh.status().message())));
}

/// Adds a grid of (columns + 1) x (rows + 1) vertices. `f(u, v, mesh)` appends the vertex at u and
/// v, which are in [0, 1]. The triangles face along dP/du x dP/dv.
template <class F>
void add_grid(int columns, int rows, const F& f, PlyMesh& mesh) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  const auto stride = static_cast<std::uint32_t>(columns + 1);
  for (int j = 0; j <= rows; ++j) {
    for (int i = 0; i <= columns; ++i) {
      f(static_cast<double>(i) / columns, static_cast<double>(j) / rows, mesh);
    }
  }
  for (std::uint32_t j = 0; j < static_cast<std::uint32_t>(rows); ++j) {
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(columns); ++i) {
      const std::uint32_t a = first + j * stride + i;
      mesh.triangles.push_back({a, a + 1, a + stride + 1});
      mesh.triangles.push_back({a, a + stride + 1, a + stride});
    }
  }
}

/// Appends a vertex at `p` with the normal `n`, if there is one, and the uv coordinates u and v.
void add_vertex(const Vec3& p, const std::optional<Vec3>& n, double u, double v, PlyMesh& mesh) {
  mesh.positions.push_back(float3(p));
  if (n) {
    mesh.normals.push_back(float3(*n));
  }
  mesh.uvs.push_back({static_cast<float>(u), static_cast<float>(v)});
}

absl::StatusOr<PlyMesh> bilinear_mesh(const Parameters& in) {
  constexpr int kCells = 16;  // cells along each side of a patch that is not flat
  ASSIGN_OR_RETURN(const PlyMesh from, read_vertices(in));
  ASSIGN_OR_RETURN(const auto corners, indices(in, 4, from.positions.size()));
  in.ignore({"faceIndices"});
  PlyMesh mesh;
  for (std::size_t i = 0; i < corners.size(); i += 4) {
    const std::uint32_t* c = &corners[i];
    const auto mixed = [&](const auto& list, double u, double v, std::size_t k) {
      return (1 - u) * (1 - v) * list[c[0]][k] + u * (1 - v) * list[c[1]][k] +
             (1 - u) * v * list[c[2]][k] + u * v * list[c[3]][k];
    };
    // The twist is 0 for a parallelogram, which is flat.
    const Vec3 twist = vec3(from.positions[c[0]]) - vec3(from.positions[c[1]]) -
                       vec3(from.positions[c[2]]) + vec3(from.positions[c[3]]);
    const double size = length(vec3(from.positions[c[3]]) - vec3(from.positions[c[0]]));
    const int cells = length(twist) <= 1e-6 * size ? 1 : kCells;
    if (corners.size() / 4 * static_cast<std::size_t>(cells * cells) > 50'000'000) {
      return error_at(in.place, "the mesh has too many patches");
    }
    add_grid(
        cells, cells,
        [&](double u, double v, PlyMesh& to) {
          const Vec3 p{mixed(from.positions, u, v, 0), mixed(from.positions, u, v, 1),
                       mixed(from.positions, u, v, 2)};
          std::optional<Vec3> n;
          if (!from.normals.empty()) {
            n = Vec3{mixed(from.normals, u, v, 0), mixed(from.normals, u, v, 1),
                     mixed(from.normals, u, v, 2)};
          }
          const bool has_uvs = !from.uvs.empty();
          add_vertex(p, n, has_uvs ? mixed(from.uvs, u, v, 0) : u,
                     has_uvs ? mixed(from.uvs, u, v, 1) : v, to);
        },
        mesh);
  }
  face_normals(mesh);
  return mesh;
}

/// Part of a turn around z.
struct Sweep {
  double turns = 1;       ///< share of a whole turn
  int columns = kAround;  ///< number of segments
};

/// Reads the angle phimax of a quadric.
absl::StatusOr<Sweep> read_sweep(const Parameters& in) {
  ASSIGN_OR_RETURN(const double degrees, in.number("phimax", 360));
  Sweep sweep;
  sweep.turns = std::clamp(degrees, 0.01, 360.0) / 360;
  sweep.columns = std::max(1, static_cast<int>(std::ceil(kAround * sweep.turns)));
  return sweep;
}

/// Returns the parameter `name`, which must be above 0; `otherwise` if it is absent.
absl::StatusOr<double> positive(const Parameters& in, const std::string& name, double otherwise) {
  ASSIGN_OR_RETURN(const double value, in.number(name, otherwise));
  if (!(value > 0 && value < kMaxCoordinate)) {
    return error_at(in.place, absl::StrCat("\"", name, "\" must be > 0, is ", value));
  }
  return value;
}

absl::StatusOr<PlyMesh> sphere_mesh(const Parameters& in) {
  ASSIGN_OR_RETURN(const double r, positive(in, "radius", 1));
  ASSIGN_OR_RETURN(const double zmin, in.number("zmin", -r));
  ASSIGN_OR_RETURN(const double zmax, in.number("zmax", r));
  ASSIGN_OR_RETURN(const Sweep sweep, read_sweep(in));
  const double low = acos(std::min(zmin, zmax) / r);
  const double high = acos(std::max(zmin, zmax) / r);
  PlyMesh mesh;
  add_grid(
      sweep.columns, kAround / 2,
      [&](double u, double v, PlyMesh& to) {
        const double theta = low + v * (high - low);
        const SinCos down = sincos_turns(theta / (2 * kPi));
        const SinCos around = sincos_turns(u * sweep.turns);
        const bool is_pole = down.sin < 1e-12;
        const Vec3 n{is_pole ? 0 : down.sin * around.cos, is_pole ? 0 : down.sin * around.sin,
                     down.cos};
        add_vertex(n * r, n, u, v, to);
      },
      mesh);
  return mesh;
}

absl::StatusOr<PlyMesh> cylinder_mesh(const Parameters& in) {
  ASSIGN_OR_RETURN(const double r, positive(in, "radius", 1));
  ASSIGN_OR_RETURN(const double zmin, in.number("zmin", -1));
  ASSIGN_OR_RETURN(const double zmax, in.number("zmax", 1));
  ASSIGN_OR_RETURN(const Sweep sweep, read_sweep(in));
  const double low = std::min(zmin, zmax);
  const double high = std::max(zmin, zmax);
  if (!(low < high)) {
    return error_at(in.place, "\"zmin\" and \"zmax\" must differ");
  }
  PlyMesh mesh;
  add_grid(
      sweep.columns, 1,
      [&](double u, double v, PlyMesh& to) {
        const SinCos around = sincos_turns(u * sweep.turns);
        const Vec3 n{around.cos, around.sin, 0};
        add_vertex({n.x * r, n.y * r, low + v * (high - low)}, n, u, v, to);
      },
      mesh);
  return mesh;
}

absl::StatusOr<PlyMesh> disk_mesh(const Parameters& in) {
  ASSIGN_OR_RETURN(const double r, positive(in, "radius", 1));
  ASSIGN_OR_RETURN(const double inner, in.number("innerradius", 0));
  ASSIGN_OR_RETURN(const double height, in.number("height", 0));
  ASSIGN_OR_RETURN(const Sweep sweep, read_sweep(in));
  const double hole = std::clamp(inner, 0.0, r * 0.999999);
  PlyMesh mesh;
  add_grid(
      sweep.columns, 1,
      [&](double u, double v, PlyMesh& to) {
        // v runs inwards, so that the normal is +z.
        const double at = r + v * (hole - r);
        const SinCos around = sincos_turns(u * sweep.turns);
        add_vertex({at * around.cos, at * around.sin, height}, Vec3{0, 0, 1}, u, v, to);
      },
      mesh);
  return mesh;
}

/// Reads a PLY file, which may be compressed. If the file is missing, warns and returns
/// std::nullopt.
absl::StatusOr<std::optional<PlyMesh>> ply_mesh(const Parameters& in, Builder& builder) {
  ASSIGN_OR_RETURN(const std::string file, in.text("filename", ""));
  ASSIGN_OR_RETURN(auto bytes, read_or_warn(file, in.place, "the shape is left out", builder));
  if (!bytes) {
    return std::nullopt;
  }
  const auto failed = [&](const absl::Status& status) {
    return absl::Status(status.code(),
                        absl::StrCat(text_of(in.place), ": \"", file, "\": ", status.message()));
  };
  if (is_gzip(*bytes)) {
    auto plain = inflate(*bytes, DeflateKind::kGzip, kMaxPlyBytes);
    if (!plain.ok()) {
      return failed(plain.status());
    }
    *bytes = *std::move(plain);
  }
  auto read = read_ply(*bytes);
  if (!read.ok()) {
    return failed(read.status());
  }
  face_normals(read->mesh);
  return std::move(read->mesh);
}

/// Removes triangles with two corners at the same position. Quadrics have such triangles at their
/// poles.
void remove_flat(PlyMesh& mesh) {
  std::erase_if(mesh.triangles, [&](const auto& t) {
    return mesh.positions[t[0]] == mesh.positions[t[1]] ||
           mesh.positions[t[1]] == mesh.positions[t[2]] ||
           mesh.positions[t[2]] == mesh.positions[t[0]];
  });
}

}  // namespace

absl::StatusOr<std::optional<PlyMesh>> mesh_of(const std::string& type,
                                               const Parameters& parameters, Builder& builder) {
  if (type == "plymesh") {
    return ply_mesh(parameters, builder);
  }
  using Maker = absl::StatusOr<PlyMesh> (*)(const Parameters&);
  constexpr std::pair<const char*, Maker> kMakers[] = {
      {"trianglemesh", triangle_mesh}, {"loopsubdiv", loop_mesh},   {"bilinearmesh", bilinear_mesh},
      {"sphere", sphere_mesh},         {"cylinder", cylinder_mesh}, {"disk", disk_mesh}};
  for (const auto& [name, make] : kMakers) {
    if (type == name) {
      ASSIGN_OR_RETURN(PlyMesh mesh, make(parameters));
      remove_flat(mesh);
      if (mesh.triangles.empty()) {
        builder.warn(parameters.place, "the shape has no triangle with an area; it is left out");
        return std::nullopt;
      }
      return mesh;
    }
  }
  return error_at(parameters.place, absl::StrCat("the shape \"", type, "\" is not known"));
}

bool is_closed(const PlyMesh& mesh) {
  std::map<std::array<float, 3>, std::uint32_t> ids;
  const auto id_of = [&](std::uint32_t v) {
    std::array<float, 3> p = mesh.positions[v];
    for (float& x : p) {
      x += 0.0F;  // turns -0 into 0, which is the same position
    }
    return ids.emplace(p, static_cast<std::uint32_t>(ids.size())).first->second;
  };
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const auto& t : mesh.triangles) {
    const std::uint32_t c[3] = {id_of(t[0]), id_of(t[1]), id_of(t[2])};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = c[k];
      const std::uint32_t b = c[(k + 1) % 3];
      edges[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
    }
  }
  return std::all_of(edges.begin(), edges.end(), [](const auto& edge) { return edge.second == 0; });
}

double signed_volume(const PlyMesh& mesh) {
  double sum = 0;
  const Vec3 origin = vec3(mesh.positions[0]);
  for (const auto& t : mesh.triangles) {
    sum += dot(vec3(mesh.positions[t[0]]) - origin,
               cross(vec3(mesh.positions[t[1]]) - origin, vec3(mesh.positions[t[2]]) - origin));
  }
  return sum;
}

void reverse(PlyMesh& mesh) {
  for (auto& t : mesh.triangles) {
    std::swap(t[1], t[2]);
  }
  for (auto& n : mesh.normals) {
    n = {-n[0], -n[1], -n[2]};
  }
}

}  // namespace bandsaw::pbrt
