// Computes the vertices of a mesh in a pose: adds morph targets to the vertices, then transforms
// each vertex by the weighted mean of the transforms of its bones.

#include "renderlib/import/model/model_pose.h"

#include <assimp/scene.h>

#include <cmath>
#include <utility>
#include <vector>

#include "renderlib/import/model/model_nodes.h"
#include "renderlib/math/float3.h"

namespace bandsaw {
namespace {

Vec3 vec(const aiVector3D& v) { return {v.x, v.y, v.z}; }

std::vector<Float3> vectors(const aiVector3D* from, std::size_t count) {
  std::vector<Float3> to(count);
  for (std::size_t i = 0; i < count; ++i) {
    to[i] = {from[i].x, from[i].y, from[i].z};
  }
  return to;
}

/// Adds `weight` times the difference between `target` and `base` to each vector of `to`.
void add_target(const aiVector3D* target, const aiVector3D* base, double weight,
                std::vector<Float3>& to) {
  for (std::size_t i = 0; i < to.size(); ++i) {
    to[i] = float3(vec3(to[i]) + weight * (vec(target[i]) - vec(base[i])));
  }
}

/// Adds `by` times the matrix of `t` to `sum`.
void add_scaled(const Transform& t, double by, Transform& sum) {
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 4; ++column) {
      sum.m[row][column] += by * t.m[row][column];
    }
  }
}

/// Adds the targets whose weight is not 0. If `weights` is empty, the targets have the weights of
/// the file.
void add_morph_targets(const aiMesh& from, const std::vector<double>& weights, Vertices& to) {
  for (unsigned i = 0; i < from.mNumAnimMeshes; ++i) {
    const aiAnimMesh& target = *from.mAnimMeshes[i];
    const double weight = i < weights.size() ? weights[i] : weights.empty() ? target.mWeight : 0;
    if (weight == 0 || !std::isfinite(weight) || target.mNumVertices != from.mNumVertices) {
      continue;
    }
    if (target.HasPositions()) {
      add_target(target.mVertices, from.mVertices, weight, to.positions);
    }
    if (target.HasNormals() && from.HasNormals()) {
      add_target(target.mNormals, from.mNormals, weight, to.normals);
    }
  }
}

/// Transforms vertices and normals to the model's space. `bones` are the transforms of the mesh's
/// bones to the model's space. `place` is the transform of the vertices that have no bone.
void add_skin(const aiMesh& from, const std::vector<Transform>& bones, const Transform& place,
              Vertices& to) {
  Transform zero;
  zero.m = {};
  std::vector<Transform> blended(to.positions.size(), zero);
  std::vector<double> weights(to.positions.size(), 0);
  for (unsigned i = 0; i < from.mNumBones; ++i) {
    const aiBone& bone = *from.mBones[i];
    const Transform to_model = bones[i] * transform_of(bone.mOffsetMatrix);
    for (unsigned w = 0; w < bone.mNumWeights; ++w) {
      const aiVertexWeight& weight = bone.mWeights[w];
      if (weight.mVertexId < blended.size() && std::isfinite(weight.mWeight)) {
        add_scaled(to_model, weight.mWeight, blended[weight.mVertexId]);
        weights[weight.mVertexId] += weight.mWeight;
      }
    }
  }
  for (std::size_t i = 0; i < blended.size(); ++i) {
    Transform to_model = place;
    if (weights[i] > 0) {
      to_model = zero;
      add_scaled(blended[i], 1 / weights[i], to_model);
    }
    to.positions[i] = float3(to_model.point(vec3(to.positions[i])));
    if (const auto back = inverse(to_model); back && !to.normals.empty()) {
      const Vec3 normal = normal_to_world(*back, vec3(to.normals[i]));
      const double size = length(normal);
      to.normals[i] = float3(size > 0 ? normal / size : normal);
    }
  }
}

}  // namespace

NodePlaces node_places(const aiScene& scene, const Animation* animation, double time) {
  NodePlaces places;
  std::vector<std::pair<const aiNode*, Transform>> stack{{scene.mRootNode, Transform{}}};
  while (!stack.empty()) {
    const auto [node, parent] = stack.back();
    stack.pop_back();
    const std::size_t number = places.by_number.size();
    const NodeMotion* motion = motion_of(animation, number);
    const Transform place =
        parent * (motion == nullptr ? transform_of(node->mTransformation) : motion->at(time));
    places.by_number.push_back(place);
    places.by_name.emplace(node->mName.C_Str(), number);
    for (unsigned i = 0; i < node->mNumMeshes; ++i) {
      places.of_meshes.emplace(node->mMeshes[i], number);
    }
    for (unsigned i = node->mNumChildren; i-- > 0;) {
      stack.emplace_back(node->mChildren[i], place);
    }
  }
  return places;
}

Vertices posed_vertices(const aiMesh& from, const MeshPose& pose) {
  Vertices to;
  if (from.HasPositions()) {
    to.positions = vectors(from.mVertices, from.mNumVertices);
  }
  if (from.HasNormals()) {
    to.normals = vectors(from.mNormals, from.mNumVertices);
  }
  add_morph_targets(from, pose.weights, to);
  if (pose.bones) {
    add_skin(from, *pose.bones, pose.place, to);
  }
  return to;
}

}  // namespace bandsaw
