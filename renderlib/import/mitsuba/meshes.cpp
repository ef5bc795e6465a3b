// Converts the mesh files of a Mitsuba scene. Reads a mesh as Mitsuba would, and changes the
// properties that Bandsaw's importer would read differently (orientation, normals, uvs). Attributes
// of vertices or triangles become an image with four texels for each triangle.

#include "renderlib/import/mitsuba/meshes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/image/exr.h"
#include "renderlib/math/vec.h"

namespace bandsaw::mitsuba {
namespace {

/// Returns true if every triangle faces the side of its vertices' normals.
bool is_oriented(const PlyMesh& mesh) {
  PlyMesh other;
  other.positions = mesh.positions;
  other.normals = mesh.normals;
  other.triangles = mesh.triangles;
  orient_by_normals(other);
  return other.triangles == mesh.triangles;
}

/// Gives each triangle vertices of its own, with positions and normals only.
void split_vertices(PlyMesh& mesh) {
  PlyMesh out;
  for (const auto& triangle : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(out.positions.size());
    for (const std::uint32_t vertex : triangle) {
      out.positions.push_back(mesh.positions[vertex]);
      if (!mesh.normals.empty()) {
        out.normals.push_back(mesh.normals[vertex]);
      }
    }
    out.triangles.push_back({first, first + 1, first + 2});
  }
  mesh = std::move(out);
}

/// Layout of an image with 2 x 2 texels for each triangle.
struct Atlas {
  explicit Atlas(std::size_t triangles)
      : columns(static_cast<std::uint32_t>(std::ceil(std::sqrt(static_cast<double>(triangles))))),
        rows(static_cast<std::uint32_t>((triangles + columns - 1) / columns)) {}
  std::uint32_t columns;
  std::uint32_t rows;

  /// x() and y() return the left column and the upper row of a triangle's texels.
  std::uint32_t x(std::size_t triangle) const {
    return 2 * static_cast<std::uint32_t>(triangle % columns);
  }
  std::uint32_t y(std::size_t triangle) const {
    return 2 * static_cast<std::uint32_t>(triangle / columns);
  }
  /// Returns the uv of the centre of a texel.
  std::array<float, 2> uv(std::uint32_t column, std::uint32_t row) const {
    return {(static_cast<float>(column) + 0.5f) / static_cast<float>(2 * columns),
            1 - (static_cast<float>(row) + 0.5f) / static_cast<float>(2 * rows)};
  }
};

/// Sets uvs so that the corners of a triangle are the centres of three of its four texels. Between
/// these centres, the bilinear interpolation of the image equals the linear interpolation over the
/// triangle, because image_of() chooses the fourth texel accordingly.
void set_atlas_uvs(const Atlas& atlas, PlyMesh& split) {
  for (std::size_t i = 0; i < split.triangles.size(); ++i) {
    const std::uint32_t x = atlas.x(i);
    const std::uint32_t y = atlas.y(i);
    for (const auto& uv : {atlas.uv(x, y), atlas.uv(x + 1, y), atlas.uv(x, y + 1)}) {
      split.uvs.push_back(uv);
    }
  }
}

/// Returns the value of the attribute at the vertex or triangle `index`. A single channel is grey.
Rgb value_of(const MeshAttribute& attribute, std::size_t index) {
  const float* at = attribute.values.data() + index * attribute.channels;
  return attribute.channels == 1 ? gray(at[0]) : Rgb{at[0], at[1], at[2]};
}

/// Bounds the channels of an extrapolated texel, so that a reflectance stays in [0, 1].
Rgb bounded(const Rgb& c, const std::array<Rgb, 3>& corner) {
  float most = 1;
  for (const Rgb& value : corner) {
    most = std::max({most, value.r, value.g, value.b});
  }
  const auto channel = [&](float value) { return std::clamp(value, 0.0f, most); };
  return {channel(c.r), channel(c.g), channel(c.b)};
}

/// Returns the image of an attribute. Three texels of a triangle are the values a, b and c at its
/// corners. The fourth texel is b + c - a, which makes the interpolation linear. Where bounded()
/// clamps this texel, the colours near the edge from b to c are not linear.
Image image_of(const MeshAttribute& attribute, const PlyMesh& mesh, const Atlas& atlas) {
  Image image{2 * atlas.columns, 2 * atlas.rows, {}};
  image.pixels.resize(std::size_t{image.width} * image.height);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    std::array<Rgb, 3> corner;
    for (std::size_t c = 0; c < 3; ++c) {
      corner[c] = value_of(attribute, attribute.per_face ? i : mesh.triangles[i][c]);
    }
    const std::size_t at = std::size_t{atlas.y(i)} * image.width + atlas.x(i);
    image.pixels[at] = corner[0];
    image.pixels[at + 1] = corner[1];
    image.pixels[at + image.width] = corner[2];
    image.pixels[at + image.width + 1] = bounded(corner[1] + corner[2] + corner[0] * -1.0f, corner);
  }
  return image;
}

}  // namespace

absl::StatusOr<std::shared_ptr<const SourceMesh>> Meshes::read(const MeshRequest& request) {
  const Key key{request.file.path, request.index, request.flip_v};
  if (last_ != nullptr && key == last_key_) {
    return last_;
  }
  last_ = nullptr;
  ASSIGN_OR_RETURN(const std::string bytes, Files::read(request.file, kMaxMeshBytes));
  auto mesh = request.type == "obj"   ? read_obj(bytes, request.flip_v)
              : request.type == "ply" ? read_ply(bytes, request.flip_v)
                                      : read_serialized(bytes, request.index, request.flip_v);
  if (!mesh.ok()) {
    return absl::Status(mesh.status().code(),
                        absl::StrCat("\"", request.file.name, "\" ", mesh.status().message()));
  }
  last_key_ = key;
  last_ = std::make_shared<const SourceMesh>(*std::move(mesh));
  return last_;
}

absl::StatusOr<MeshFile> Meshes::file_of(const MeshRequest& request) {
  const MadeKey key{request.file.path,    request.index,  request.flip_v,
                    request.face_normals, request.turned, request.mirrored,
                    request.handed,       request.closed, request.attributes};
  if (const auto known = known_.find(key); known != known_.end()) {
    return known->second;
  }
  ASSIGN_OR_RETURN(const std::shared_ptr<const SourceMesh> mesh, read(request));
  const bool has_normals = !mesh->mesh.normals.empty();
  const bool faceted = request.face_normals || mesh->faceted;
  // Mitsuba computes the normals itself for a mesh with face normals and for a mesh without
  // normals. A mirroring placement turns the computed normals to the other side.
  const bool turned = request.turned != (request.mirrored && (faceted || !has_normals));
  // Describes the uvs that Bandsaw's importer reads from the unchanged file. Their v is Mitsuba's v
  // (kSame) or 1 - Mitsuba's v (kFlipped).
  const UvFrame natural =
      request.type == "obj" && request.flip_v ? UvFrame::kFlipped : UvFrame::kSame;
  // True if the file is used unchanged. Then Bandsaw's importer and Mitsuba read the same normals
  // and sides from the file, and `natural` describes the uvs. A file is always made if `handed` is
  // set (u, v and the normal must be right-handed) or if `closed` is set (a medium is inside of the
  // mesh, so the file must have a single mesh).
  const bool as_it_is = request.type != "serialized" && has_normals != faceted && !turned &&
                        !request.handed && !request.closed && request.attributes.empty() &&
                        (request.type == "obj" || !request.flip_v) && is_oriented(mesh->mesh);
  MeshFile file;
  if (as_it_is) {
    file = {request.file.name, {natural, {}}};
  } else {
    MeshRequest adjusted = request;
    adjusted.turned = turned;
    adjusted.face_normals = faceted;
    ASSIGN_OR_RETURN(file, made_of(*mesh, adjusted));
  }
  known_.emplace(key, file);
  return file;
}

absl::StatusOr<MeshFile> Meshes::made_of(SourceMesh source, const MeshRequest& request) {
  PlyMesh& mesh = source.mesh;
  if (request.face_normals) {
    mesh.normals.clear();
  } else if (mesh.normals.empty()) {
    add_smooth_normals(mesh);
  }
  if (request.turned) {
    turn_over(mesh);
  }
  orient_by_normals(mesh);
  MeshFile file;
  std::vector<const MeshAttribute*> used;
  for (const MeshAttribute& attribute : source.attributes) {
    if (request.attributes.count(attribute.name) > 0) {
      used.push_back(&attribute);
    }
  }
  if (!used.empty()) {
    const Atlas atlas(mesh.triangles.size());
    for (const MeshAttribute* attribute : used) {
      ASSIGN_OR_RETURN(const std::vector<std::byte> bytes,
                       encode_exr(image_of(*attribute, mesh, atlas), /*half=*/false));
      file.surface.attributes[attribute->name] =
          to_.made.add(attribute->name, ".exr",
                       std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
    }
    split_vertices(mesh);
    set_atlas_uvs(atlas, mesh);
  } else if (has_left_handed_uvs(mesh) != request.mirrored) {
    // v is flipped, so that u, v and the normal are right-handed after the placement.
    file.surface.frame = UvFrame::kFlipped;
    for (auto& uv : mesh.uvs) {
      uv[1] = 1 - uv[1];
    }
  }
  file.name = to_.made.add("mesh", ".ply", write_ply(mesh));
  return file;
}

}  // namespace bandsaw::mitsuba
