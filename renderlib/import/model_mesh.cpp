#include "renderlib/import/model_mesh.h"

#include <assimp/mesh.h>
#include <assimp/scene.h>

#include <cmath>
#include <cstdint>
#include <utility>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/mend_mesh.h"

namespace bandsaw {
namespace {

struct Counts {
  std::size_t other_faces = 0;  ///< points and lines
  std::size_t not_finite = 0;   ///< triangles with a vertex that is not
};

std::vector<std::array<float, 3>> vectors(const aiVector3D* from, std::size_t count) {
  std::vector<std::array<float, 3>> to(count);
  for (std::size_t i = 0; i < count; ++i) {
    to[i] = {from[i].x, from[i].y, from[i].z};
  }
  return to;
}

absl::Status add_triangles(const aiMesh& from, const std::string& title, Mesh& mesh,
                           Counts& counts) {
  const auto finite = [&](std::uint32_t index) {
    const auto& p = mesh.positions[index];
    return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
  };
  for (unsigned i = 0; i < from.mNumFaces; ++i) {
    const aiFace& face = from.mFaces[i];
    if (face.mNumIndices != 3) {
      ++counts.other_faces;
      continue;
    }
    const std::array<std::uint32_t, 3> corners{face.mIndices[0], face.mIndices[1],
                                               face.mIndices[2]};
    for (const std::uint32_t corner : corners) {
      if (corner >= mesh.positions.size()) {
        return absl::InvalidArgumentError(absl::StrCat(title, ": is damaged: triangle ", i,
                                                       " refers to vertex ", corner, " of ",
                                                       mesh.positions.size()));
      }
    }
    if (finite(corners[0]) && finite(corners[1]) && finite(corners[2])) {
      mesh.triangles.push_back(corners);
    } else {
      ++counts.not_finite;
    }
  }
  return absl::OkStatus();
}

std::vector<std::array<float, 2>> uvs(const aiMesh& from, unsigned uv_set) {
  if (uv_set >= AI_MAX_NUMBER_OF_TEXTURECOORDS || !from.HasTextureCoords(uv_set)) {
    return {};
  }
  // Assimp's v = 0 is the image's bottom row for every format, and so is ours.
  std::vector<std::array<float, 2>> to(from.mNumVertices);
  for (unsigned i = 0; i < from.mNumVertices; ++i) {
    const aiVector3D& uv = from.mTextureCoords[uv_set][i];
    to[i] = {uv.x, uv.y};
  }
  return to;
}

absl::StatusOr<Mesh> read_mesh(const aiMesh& from, const ModelMaterial& material,
                               const std::string& title, std::vector<std::string>& warnings) {
  Mesh mesh;
  Counts counts;
  mesh.positions = vectors(from.mVertices, from.HasPositions() ? from.mNumVertices : 0);
  RETURN_IF_ERROR(add_triangles(from, title, mesh, counts));
  if (from.HasNormals()) {
    mesh.normals = vectors(from.mNormals, from.mNumVertices);
  }
  mesh.uvs = uvs(from, material.uv_set);
  mesh.uvs2 = uvs(from, material.second_uv_set);
  if (counts.other_faces > 0) {
    warnings.push_back(
        absl::StrCat(title, ": ", counts.other_faces, " points and lines are left out"));
  }
  if (counts.not_finite > 0) {
    warnings.push_back(absl::StrCat(title, ": ", counts.not_finite, " of ",
                                    counts.not_finite + mesh.triangles.size(),
                                    " triangles have a vertex that is not a finite number and are "
                                    "left out"));
  }
  drop_unused_vertices(mesh);
  if (const std::size_t mended = mend_normals(mesh); mended > 0) {
    warnings.push_back(
        absl::StrCat(title, ": ", mended, " normals are zero or not finite and are made anew"));
  }
  if (const std::size_t mended = mend_uvs(mesh); mended > 0) {
    warnings.push_back(absl::StrCat(title, ": ", mended, " uvs are not finite and become 0"));
  }
  return mesh;
}

}  // namespace

absl::StatusOr<ModelMeshes> add_meshes(const aiScene& scene,
                                       const std::vector<ModelMaterial>& materials,
                                       const std::string& model_name, SceneDraft& draft) {
  ModelMeshes meshes(scene.mNumMeshes);
  std::vector<Mesh>& out = draft.out.scene.geometry.meshes;
  for (unsigned i = 0; i < scene.mNumMeshes; ++i) {
    const aiMesh& from = *scene.mMeshes[i];
    const std::string called =
        from.mName.length == 0 ? absl::StrCat(i) : absl::StrCat("\"", from.mName.C_Str(), "\"");
    const ModelMaterial material =
        from.mMaterialIndex < materials.size() ? materials[from.mMaterialIndex] : ModelMaterial{};
    ASSIGN_OR_RETURN(Mesh mesh,
                     read_mesh(from, material, absl::StrCat(model_name, ": mesh ", called),
                               draft.out.info.warnings));
    if (mesh.triangles.empty()) {
      continue;
    }
    meshes[i] = ModelMesh{MeshId{static_cast<std::uint32_t>(out.size())}, material.id};
    out.push_back(std::move(mesh));
  }
  return meshes;
}

}  // namespace bandsaw
