#include "renderlib/import/model_nodes.h"

#include <assimp/scene.h>

#include <cmath>
#include <map>

#include "absl/strings/str_cat.h"
#include "renderlib/math/constants.h"
#include "renderlib/math/elementary.h"

namespace bandsaw {
namespace {

constexpr std::size_t kMostInstances = 1'000'000;

Transform transform_of(const aiMatrix4x4& m) {
  return {{{{m.a1, m.a2, m.a3, m.a4}, {m.b1, m.b2, m.b3, m.b4}, {m.c1, m.c2, m.c3, m.c4}}}};
}

Vec3 vector_of(const aiVector3D& v) { return {v.x, v.y, v.z}; }

// Assimp keeps "half the horizontal angle times two" in radians, except that its glTF reader stores
// the vertical angle times the aspect ratio, and the vertical angle itself where the file gives no
// ratio. Models that are read here with a camera are glTF.
double vertical_fov_degrees(const aiCamera& camera) {
  const double aspect = camera.mAspect > 0 ? camera.mAspect : 1;
  return camera.mHorizontalFOV / aspect * 180 / kPi;
}

std::optional<PerspectiveCamera> camera_of(const aiCamera& camera, const Transform& node) {
  PerspectiveCamera out;
  // Assimp 5.2 copies the node's translation into the camera of a glTF file, whose cameras stand at
  // their node's origin.
  out.position = node.point({0, 0, 0});
  const Vec3 forward = node.direction(vector_of(camera.mLookAt));
  out.look_at = out.position + forward;
  out.up = node.direction(vector_of(camera.mUp));
  out.vertical_fov = vertical_fov_degrees(camera);
  const bool orthographic = camera.mOrthographicWidth > 0;
  return !orthographic && validate(Camera(out)).ok() ? std::optional(out) : std::nullopt;
}

// The tree is walked with a stack of its own: its depth comes from the file.
class Walk {
 public:
  Walk(const aiScene& scene, const ModelMeshes& meshes) : meshes_(meshes) {
    for (unsigned i = 0; i < scene.mNumCameras; ++i) {
      cameras_.emplace(scene.mCameras[i]->mName.C_Str(), scene.mCameras[i]);
    }
    stack_.push_back({scene.mRootNode, Transform{}});
  }

  void run() {
    while (!stack_.empty() && model.instances.size() <= kMostInstances) {
      const auto [node, parent] = stack_.back();
      stack_.pop_back();
      visit(*node, parent * transform_of(node->mTransformation));
    }
  }

  Model model;
  std::size_t flattened = 0;

 private:
  struct Entry {
    const aiNode* node;
    Transform parent;
  };

  void visit(const aiNode& node, const Transform& to_model) {
    const bool regular = inverse(to_model).has_value();
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
      const unsigned number = node.mMeshes[i];
      if (number >= meshes_.size() || !meshes_[number]) {
        continue;
      }
      if (!regular) {
        ++flattened;
        continue;
      }
      model.instances.push_back({meshes_[number]->mesh, meshes_[number]->material, to_model});
    }
    if (const auto found = cameras_.find(node.mName.C_Str());
        found != cameras_.end() && !model.camera) {
      model.camera = camera_of(*found->second, to_model);
    }
    // Backwards, so that children are visited in the order of the file.
    for (unsigned i = node.mNumChildren; i-- > 0;) {
      stack_.push_back({node.mChildren[i], to_model});
    }
  }

  const ModelMeshes& meshes_;
  std::map<std::string, const aiCamera*> cameras_;
  std::vector<Entry> stack_;
};

}  // namespace

absl::StatusOr<Model> read_nodes(const aiScene& scene, const ModelMeshes& meshes,
                                 const std::string& model_name,
                                 std::vector<std::string>& warnings) {
  Walk walk(scene, meshes);
  walk.run();
  if (walk.model.instances.size() > kMostInstances) {
    return absl::ResourceExhaustedError(
        absl::StrCat(model_name, ": has more than ", kMostInstances, " placements of meshes"));
  }
  if (walk.flattened > 0) {
    warnings.push_back(absl::StrCat(model_name, ": ", walk.flattened,
                                    " placements are left out: their transform flattens them"));
  }
  return std::move(walk.model);
}

}  // namespace bandsaw
