// Converts the meshes of a model. MeshReader converts one mesh of Assimp and repairs it. A mesh
// with a skin or morph targets is posed at both ends of the shutter interval.

#include "renderlib/import/model/model_mesh.h"

#include <assimp/mesh.h>
#include <assimp/scene.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/geometry/deforming_mesh.h"
#include "renderlib/image/srgb.h"
#include "renderlib/import/model/model_pose.h"
#include "renderlib/import/model/repair_mesh.h"
#include "renderlib/math/float3.h"

namespace bandsaw {
namespace {

/// Numbers of faces that are left out.
struct Counts {
  std::size_t other_faces = 0;  ///< points and lines
  std::size_t not_finite = 0;   ///< triangles with a vertex that is not finite
};

/// The poses of a mesh when the shutter opens and when it closes.
struct Poses {
  MeshPose at_open;
  MeshPose at_close;
};

/// Sets mesh.positions and mesh.normals, which belong to the opening of the shutter. If the
/// vertices differ at the closing, also sets mesh.positions_at_close and mesh.normals_at_close.
void add_vertices(const aiMesh& from, const Poses& poses, Mesh& mesh) {
  Vertices open = posed_vertices(from, poses.at_open);
  if (!(poses.at_close == poses.at_open)) {
    if (Vertices close = posed_vertices(from, poses.at_close); !(close == open)) {
      mesh.positions_at_close = std::move(close.positions);
      mesh.normals_at_close = std::move(close.normals);
    }
  }
  mesh.positions = std::move(open.positions);
  mesh.normals = std::move(open.normals);
}

/// Adds the faces of `from` that are triangles with finite vertices, and counts the others. Returns
/// INVALID_ARGUMENT, with `title` before the message, if an index is out of range.
absl::Status add_triangles(const aiMesh& from, const std::string& title, Mesh& mesh,
                           Counts& counts) {
  const auto finite = [&](std::uint32_t index) {
    return is_finite(vec3(mesh.positions[index])) &&
           (!deforms(mesh) || is_finite(vec3(mesh.positions_at_close[index])));
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
        return absl::InvalidArgumentError(
            absl::StrCat(title, ": is damaged: triangle ", i, " refers to vertex ", corner,
                         "; the number of vertices is ", mesh.positions.size()));
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

/// Returns the uvs of Assimp's uv set `uv_set`; an empty list if the mesh does not have the set.
std::vector<std::array<float, 2>> uvs(const aiMesh& from, unsigned uv_set) {
  if (uv_set >= AI_MAX_NUMBER_OF_TEXTURECOORDS || !from.HasTextureCoords(uv_set)) {
    return {};
  }
  // Assimp converts the uvs of all formats so that v = 0 is the bottom row of an image, as in this
  // renderer.
  std::vector<std::array<float, 2>> to(from.mNumVertices);
  for (unsigned i = 0; i < from.mNumVertices; ++i) {
    const aiVector3D& uv = from.mTextureCoords[uv_set][i];
    to[i] = {uv.x, uv.y};
  }
  return to;
}

// Returns the vertex colours in linear RGB; in formats other than glTF the colours of the file are
// sRGB. The result is empty if there are no colours, or if all are white or unset.
std::vector<std::array<float, 3>> colors(const aiMesh& from, ModelKind kind) {
  if (!from.HasVertexColors(0)) {
    return {};
  }
  const auto channel = [&](float value) {
    const float valid = std::isfinite(value) ? std::max(value, 0.0f) : 0.0f;
    return kind == ModelKind::kGltf ? valid
                                    : static_cast<float>(srgb_decode(std::min(valid, 1.0f)));
  };
  std::vector<std::array<float, 3>> to(from.mNumVertices);
  for (unsigned i = 0; i < from.mNumVertices; ++i) {
    const aiColor4D& c = from.mColors[0][i];
    to[i] = {channel(c.r), channel(c.g), channel(c.b)};
  }
  const std::array<float, 3> white{1, 1, 1};
  const auto* rgba = from.mColors[0];
  const bool unset = std::all_of(rgba, rgba + from.mNumVertices,
                                 [](const aiColor4D& c) { return c == aiColor4D(0, 0, 0, 0); });
  const bool all_white =
      std::all_of(to.begin(), to.end(), [&](const auto& c) { return c == white; });
  return all_white || unset ? std::vector<std::array<float, 3>>() : to;
}

// Reads one mesh of the file; messages begin with `title`.
class MeshReader {
 public:
  MeshReader(const aiMesh& from, std::string title, std::vector<std::string>& warnings)
      : from_(from), title_(std::move(title)), warnings_(warnings) {}

  /// Returns the mesh with the uv sets of its material, without vertex colours and repairs.
  absl::StatusOr<Mesh> read(const ModelMaterial& material, const Poses& poses) {
    Mesh mesh;
    add_vertices(from_, poses, mesh);
    mesh.uvs = uvs(from_, material.uv_set);
    mesh.uvs2 = uvs(from_, material.second_uv_set);
    Counts counts;
    RETURN_IF_ERROR(add_triangles(from_, title_, mesh, counts));
    warn_of_dropped(counts, mesh);
    return mesh;
  }

  /// Repairs the mesh (repair_mesh.h), with warnings.
  void repair(Mesh& mesh) {
    drop_unused_vertices(mesh);
    if (const std::size_t repaired = repair_normals(mesh); repaired > 0) {
      warn(absl::StrCat(repaired, " normals are zero or not finite and are recomputed"));
    }
    if (const std::size_t repaired = repair_uvs(mesh); repaired > 0) {
      warn(absl::StrCat(repaired, " uvs are not finite and become 0"));
    }
  }

  void warn(const std::string& what) { warnings_.push_back(absl::StrCat(title_, ": ", what)); }

 private:
  void warn_of_dropped(const Counts& counts, const Mesh& mesh) {
    if (counts.other_faces > 0) {
      warn(absl::StrCat(counts.other_faces, " points and lines are left out"));
    }
    if (counts.not_finite > 0) {
      warn(absl::StrCat(counts.not_finite, " of ", counts.not_finite + mesh.triangles.size(),
                        " triangles have a vertex that is not a finite number and are left out"));
    }
  }

  const aiMesh& from_;
  std::string title_;
  std::vector<std::string>& warnings_;
};

// Returns true if a vertex colour is transparent. If every alpha is 0, the file has no alpha:
// Assimp gives colours of three channels an alpha of 0.
bool has_clear_colors(const aiMesh& from) {
  const auto any = [&](auto has) {
    return from.HasVertexColors(0) &&
           std::any_of(from.mColors[0], from.mColors[0] + from.mNumVertices, has);
  };
  return any([](const aiColor4D& c) { return c.a < 1; }) &&
         any([](const aiColor4D& c) { return c.a != 0; });
}

// Returns the transforms of a mesh's bones; std::nullopt if a bone has no node. If
// GltfExtensions::bones has the numbers of the bones' nodes, the nodes are found by number.
// Otherwise they are found by name, although names need not be unique.
std::optional<std::vector<Transform>> bone_places(const ModelFile& file, unsigned number,
                                                  const NodePlaces& places) {
  const aiMesh& mesh = *file.scene.mMeshes[number];
  const auto known = file.gltf.bones.find(number);
  std::vector<Transform> bones;
  for (unsigned i = 0; i < mesh.mNumBones; ++i) {
    if (known != file.gltf.bones.end() && known->second.size() == mesh.mNumBones &&
        known->second[i] < places.by_number.size()) {
      bones.push_back(places.by_number[known->second[i]]);
      continue;
    }
    const auto named = places.by_name.find(mesh.mBones[i]->mName.C_Str());
    if (named == places.by_name.end()) {
      return std::nullopt;
    }
    bones.push_back(places.by_number[named->second]);
  }
  return bones;
}

/// Returns the weights of a mesh's morph targets at a time. Returns an empty list if they are not
/// animated; then the weights in the file are used.
std::vector<double> weights_of(const ModelFile& file, unsigned mesh, const NodePlaces& places,
                               double time) {
  const auto node = places.of_meshes.find(mesh);
  if (!file.animation || node == places.of_meshes.end()) {
    return {};
  }
  const auto curve = file.animation->weights.find(node->second);
  return curve == file.animation->weights.end() ? std::vector<double>() : curve->second.at(time);
}

/// Returns the pose of a mesh at a time; `places` are the places of the nodes at this time. In a
/// mesh with a skin, the vertices without a bone follow the node of the mesh.
MeshPose pose_of(const ModelFile& file, unsigned number, const NodePlaces& places, double time) {
  MeshPose pose{.weights = weights_of(file, number, places, time)};
  if (file.scene.mMeshes[number]->HasBones()) {
    pose.bones = bone_places(file, number, places);
  }
  const auto node = places.of_meshes.find(number);
  if (pose.bones && node != places.of_meshes.end()) {
    pose.place = places.by_number[node->second];
  }
  return pose;
}

/// Reads and repairs the mesh with Assimp's number `number`. `with_colors` says whether its vertex
/// colours are read.
absl::StatusOr<Mesh> read_mesh(ModelFile& file, unsigned number, const ModelMaterial& material,
                               bool with_colors, const Poses& poses) {
  const aiMesh& from = *file.scene.mMeshes[number];
  const std::string called =
      from.mName.length == 0 ? absl::StrCat(number) : absl::StrCat("\"", from.mName.C_Str(), "\"");
  MeshReader reader(from, absl::StrCat(file.name(), ": mesh ", called),
                    file.draft.out.info.warnings);
  ASSIGN_OR_RETURN(Mesh mesh, reader.read(material, poses));
  if (with_colors) {
    mesh.colors = colors(from, file.kind);
    if (has_clear_colors(from)) {
      reader.warn("the alpha of its vertex colours is left out");
    }
  }
  if (from.HasBones() && !poses.at_open.bones) {
    reader.warn("its skin is left out: a bone has no node");
  }
  reader.repair(mesh);
  return mesh;
}

/// Returns a mesh that no animation changes. It is kept for further frames, which share it.
absl::StatusOr<std::shared_ptr<const Mesh>> still_mesh(ModelFile& file, unsigned number,
                                                       const ModelMaterial& material,
                                                       bool with_colors) {
  std::vector<std::string>& warnings = file.draft.out.info.warnings;
  StillMesh& known =
      file.still_meshes[{number, with_colors, material.uv_set, material.second_uv_set}];
  if (known.mesh == nullptr) {
    const std::size_t before = warnings.size();
    ASSIGN_OR_RETURN(Mesh mesh, read_mesh(file, number, material, with_colors, {}));
    known.mesh = std::make_shared<Mesh>(std::move(mesh));
    known.warnings.assign(warnings.begin() + static_cast<std::ptrdiff_t>(before), warnings.end());
  } else {
    warnings.insert(warnings.end(), known.warnings.begin(), known.warnings.end());
  }
  return known.mesh;
}

}  // namespace

absl::StatusOr<ModelMeshes> add_meshes(ModelFile& file, const std::vector<ModelMaterial>& materials,
                                       bool with_colors) {
  const aiScene& scene = file.scene;
  const Animation* animation = file.animation ? &*file.animation : nullptr;
  const Shutter& shutter = file.draft.shutter;
  const NodePlaces at_open = node_places(scene, animation, shutter.open);
  const NodePlaces at_close = node_places(scene, animation, shutter.close);
  ModelMeshes meshes(scene.mNumMeshes);
  MeshList& out = file.draft.out.scene.geometry.meshes;
  for (unsigned i = 0; i < scene.mNumMeshes; ++i) {
    const aiMesh& from = *scene.mMeshes[i];
    const ModelMaterial material =
        from.mMaterialIndex < materials.size() ? materials[from.mMaterialIndex] : ModelMaterial{};
    const Poses poses = {pose_of(file, i, at_open, shutter.open),
                         pose_of(file, i, at_close, shutter.close)};
    const bool skinned = poses.at_open.bones.has_value();
    std::shared_ptr<const Mesh> mesh;
    if (skinned || !poses.at_open.weights.empty()) {
      ASSIGN_OR_RETURN(Mesh posed, read_mesh(file, i, material, with_colors, poses));
      mesh = std::make_shared<Mesh>(std::move(posed));
    } else {
      ASSIGN_OR_RETURN(mesh, still_mesh(file, i, material, with_colors));
    }
    if (mesh->triangles.empty()) {
      continue;
    }
    meshes[i] = ModelMesh{MeshId{static_cast<std::uint32_t>(out.size())}, material.id, skinned};
    out.share(std::move(mesh));
  }
  return meshes;
}

}  // namespace bandsaw
