// Converts the tree of nodes of a model to placements. Walk visits the nodes, parents first,
// multiplies their transforms, and adds the instances, cameras and lights of each. A node that
// moves during the shutter interval becomes a frame, a moving coordinate system (geometry/frame.h),
// in which its subtree is placed.

#include "renderlib/import/model/model_nodes.h"

#include <assimp/scene.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "renderlib/import/model/model_lights.h"
#include "renderlib/math/constants.h"
#include "renderlib/math/elementary.h"

namespace bandsaw {
namespace {

constexpr std::size_t kMaxInstances = 1'000'000;

Vec3 vector_of(const aiVector3D& v) { return {v.x, v.y, v.z}; }

/// A camera of Assimp with the values of its lens that the file gives. `name` is set for glTF.
struct CameraAtNode {
  const aiCamera* camera = nullptr;
  std::string name = {};                              ///< the camera's own name
  std::optional<double> vertical_fov = std::nullopt;  ///< in radians; none: use Assimp's angle
  std::optional<double> height = std::nullopt;        ///< if orthographic; in units of the node
};

// Returns the vertical field of view in degrees. Assimp's reader of glTF 1 stores the vertical
// angle times the aspect ratio, or the vertical angle itself if the file has no ratio; other
// readers store the horizontal angle.
double vertical_fov_degrees(const CameraAtNode& found, bool gltf) {
  if (found.vertical_fov) {
    return *found.vertical_fov * 180 / kPi;
  }
  const aiCamera& camera = *found.camera;
  const double aspect = camera.mAspect > 0 ? camera.mAspect : 1;
  if (gltf) {
    return camera.mHorizontalFOV / aspect * 180 / kPi;
  }
  const SinCos half = sincos_turns(camera.mHorizontalFOV / (4 * kPi));
  return atan2(half.sin, half.cos * aspect) * 360 / kPi;
}

// Returns the camera in the space to which `node` transforms; std::nullopt if the camera is
// invalid.
std::optional<Camera> camera_of(const CameraAtNode& found, const Transform& node, bool gltf) {
  const aiCamera& camera = *found.camera;
  View view;
  // The camera is at the node's origin. Assimp's position is not used, because Assimp 5.2 copies
  // the node's translation into the camera of some files.
  view.position = node.point({0, 0, 0});
  view.look_at = view.position + node.direction(vector_of(camera.mLookAt));
  view.up = node.direction(vector_of(camera.mUp));
  Camera out =
      PerspectiveCamera{view.position, view.look_at, view.up, vertical_fov_degrees(found, gltf)};
  if (camera.mOrthographicWidth > 0) {
    // glTF's xmag is half of the width; the aspect ratio is xmag over ymag.
    const double aspect = camera.mAspect > 0 ? camera.mAspect : 1;
    out = OrthographicCamera{view.position, view.look_at, view.up,
                             2 * camera.mOrthographicWidth / aspect};
  }
  if (found.height) {
    const double scale = length(view.up) / length(vector_of(camera.mUp));
    out = OrthographicCamera{view.position, view.look_at, view.up, *found.height * scale};
  }
  return validate(out).ok() ? std::optional(out) : std::nullopt;
}

// Returns false for 3DS and similar files, whose cameras look at a target that Assimp does not pass
// on.
bool has_usable_cameras(const ModelFile& file) {
  return file.kind != ModelKind::kOther || file.is_collada() ||
         absl::EndsWithIgnoreCase(file.path, ".fbx");
}

/// Returns the keys of a node's motion during the shutter interval. If a key flattens the node, or
/// if only some of the keys mirror it, the keys cannot be interpolated and the result is empty.
std::vector<Key> keys_of(const NodeMotion& motion, const Shutter& shutter) {
  std::vector<double> times = motion.times_between(shutter.open, shutter.close);
  if (!motion.is_linear()) {
    // Interpolation between keys only approximates a curve that is not linear, so such a motion
    // gets more keys.
    constexpr int kParts = 16;
    for (int i = 1; i < kParts; ++i) {
      times.push_back(shutter.open + (shutter.close - shutter.open) * i / kParts);
    }
    std::sort(times.begin(), times.end());
  }
  times.insert(times.begin(), shutter.open);
  times.push_back(shutter.close);
  times.erase(std::unique(times.begin(), times.end()), times.end());
  std::vector<Key> keys;
  bool mirrored = false;
  for (const double time : times) {
    const Transform at = motion.at(time);
    if (!decompose(at) || (!keys.empty() && (determinant(at) < 0) != mirrored)) {
      return {};
    }
    mirrored = determinant(at) < 0;
    keys.emplace_back(time, at);
  }
  return keys;
}

// Visits all nodes of the file's tree and collects instances, cameras and lights in `model`.
// `flattened` counts the instances that are left out because their transform has no inverse and
// would make them flat. The traversal uses an explicit stack, because a file can nest nodes so
// deeply that recursion would exhaust the call stack.
class Walk {
 public:
  Walk(ModelFile& file, const ModelMeshes& meshes) : file_(file), meshes_(meshes) {
    const aiScene& scene = file.scene;
    for (const GltfAtNode& camera : file.gltf.cameras) {
      if (camera.loaded < scene.mNumCameras) {
        gltf_cameras_[camera.node] = {scene.mCameras[camera.loaded], camera.name,
                                      camera.vertical_fov};
      }
    }
    for (const GltfAtNode& light : file.gltf.lights) {
      if (light.loaded < scene.mNumLights) {
        gltf_lights_[light.node] = scene.mLights[light.loaded];
      }
    }
    const bool by_name = file.gltf.cameras.empty() && has_usable_cameras(file);
    for (unsigned i = 0; by_name && i < scene.mNumCameras; ++i) {
      add_by_name(*scene.mCameras[i]);
    }
    for (unsigned i = 0; file.gltf.lights.empty() && i < scene.mNumLights; ++i) {
      named_lights_.emplace(scene.mLights[i]->mName.C_Str(), scene.mLights[i]);
    }
    stack_.push_back({scene.mRootNode, {}});
  }

  /// Visits the nodes until there are too many instances.
  void run() {
    while (!stack_.empty() && model.instances.size() <= kMaxInstances) {
      const Entry entry = stack_.back();
      stack_.pop_back();
      visit(*entry.node, place_of(*entry.node, entry.parent));
    }
  }

  Model model;
  std::size_t flattened = 0;

 private:
  /// Adds a camera under the name of its node. A camera of COLLADA whose lens is not known is left
  /// out, with a warning.
  void add_by_name(const aiCamera& camera) {
    CameraAtNode at{&camera};
    if (file_.is_collada()) {
      const auto lens = file_.lenses.find(camera.mName.C_Str());
      if (lens == file_.lenses.end()) {
        file_.warn(absl::StrCat("the camera \"", camera.mName.C_Str(),
                                "\" is left out: it has no valid lens"));
        return;
      }
      at.vertical_fov = lens->second.vertical_fov;
      at.height = lens->second.height;
    }
    named_cameras_.emplace(camera.mName.C_Str(), at);
  }

  /// The place of a node for its instances, and the node's transforms to the model's space at three
  /// times of the shutter interval.
  struct NodePlace {
    Transform in_frame;  ///< transform to `frame`; to the model's space if `frame` is kNoFrame
    FrameId frame = kNoFrame;
    Transform at_open;
    Transform in_middle;
    Transform at_close;
  };
  struct Entry {
    const aiNode* node;
    NodePlace parent;
  };
  /// Returns the place of a node whose parent has the place `parent`. Adds a frame if the node
  /// moves.
  NodePlace place_of(const aiNode& node, const NodePlace& parent) {
    const NodeMotion* motion = motion_of(file_.animation ? &*file_.animation : nullptr, visited_);
    const Shutter& shutter = file_.draft.shutter;
    const auto local = [&](double time) {
      return motion == nullptr ? transform_of(node.mTransformation) : motion->at(time);
    };
    NodePlace place{parent.in_frame * local(middle_of(shutter)), parent.frame,
                    parent.at_open * local(shutter.open),
                    parent.in_middle * local(middle_of(shutter)),
                    parent.at_close * local(shutter.close)};
    // A moving node becomes a frame. If keys_of() returns no keys, the node rests at its place in
    // the middle of the shutter interval.
    if (motion != nullptr && !motion->rests(shutter.open, shutter.close)) {
      if (std::vector<Key> keys = keys_of(*motion, shutter); !keys.empty()) {
        place.in_frame = Transform{};
        place.frame = FrameId{static_cast<std::uint32_t>(model.frames.size())};
        model.frames.push_back({parent.frame, parent.in_frame, std::move(keys)});
      }
    }
    return place;
  }

  /// Adds the instances, the camera and the lights of a node, and pushes its children.
  void visit(const aiNode& node, const NodePlace& place) {
    const bool regular =
        inverse(place.in_frame).has_value() && inverse(place.in_middle).has_value();
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
      const unsigned number = node.mMeshes[i];
      if (number >= meshes_.size() || !meshes_[number]) {
        continue;
      }
      if (meshes_[number]->skinned) {
        if (skinned_.insert(number).second) {
          model.instances.push_back(
              {meshes_[number]->mesh, meshes_[number]->material, Transform{}});
        }
        continue;
      }
      if (!regular) {
        ++flattened;
        continue;
      }
      model.instances.push_back({meshes_[number]->mesh, meshes_[number]->material, place.in_frame});
      model.instances.back().frame = place.frame;
    }
    add_camera(node, place);
    add_lights(node, place.in_middle);
    ++visited_;
    // In reverse order, so that children are visited in the order of the file.
    for (unsigned i = node.mNumChildren; i-- > 0;) {
      stack_.push_back({node.mChildren[i], place});
    }
  }

  void add_camera(const aiNode& node, const NodePlace& place) {
    const auto by_index = gltf_cameras_.find(visited_);
    const auto named = named_cameras_.find(node.mName.C_Str());
    const CameraAtNode found = by_index != gltf_cameras_.end() ? by_index->second
                               : named != named_cameras_.end() ? named->second
                                                               : CameraAtNode{};
    if (found.camera == nullptr) {
      return;
    }
    const bool gltf = file_.kind == ModelKind::kGltf;
    const auto camera = camera_of(found, place.at_open, gltf);
    if (!camera) {
      file_.warn(absl::StrCat("the camera \"", node.mName.C_Str(),
                              "\" is left out: its lens or its place is not valid"));
      return;
    }
    model.cameras.push_back({node.mName.C_Str(), found.name, *camera});
    if (!(place.at_open == place.at_close)) {
      model.cameras.back().at_close = camera_of(found, place.at_close, gltf);
    }
  }

  void add_lights(const aiNode& node, const Transform& to_model) {
    if (const auto by_index = gltf_lights_.find(visited_); by_index != gltf_lights_.end()) {
      add_model_light(*by_index->second, to_model, file_, model);
    }
    const auto [first, last] = named_lights_.equal_range(node.mName.C_Str());
    for (auto light = first; light != last; ++light) {
      add_model_light(*light->second, to_model, file_, model);
    }
  }

  ModelFile& file_;
  const ModelMeshes& meshes_;
  std::size_t visited_ = 0;  ///< number of visited nodes
  /// Cameras of glTF, keyed by the index of their node in Assimp's tree.
  std::map<std::size_t, CameraAtNode> gltf_cameras_;
  /// Other cameras, keyed by the name of their node.
  std::map<std::string, CameraAtNode> named_cameras_;
  /// Lights of glTF, keyed by the index of their node in Assimp's tree.
  std::map<std::size_t, const aiLight*> gltf_lights_;
  /// Other lights, keyed by the name of their node.
  std::multimap<std::string, const aiLight*> named_lights_;
  std::vector<Entry> stack_;
  /// Skinned meshes that have been added. Their bones place them, so each is added only once, even
  /// if several nodes have it.
  std::set<unsigned> skinned_;
};

}  // namespace

Transform transform_of(const aiMatrix4x4& m) {
  return {{{{m.a1, m.a2, m.a3, m.a4}, {m.b1, m.b2, m.b3, m.b4}, {m.c1, m.c2, m.c3, m.c4}}}};
}

absl::StatusOr<Model> read_nodes(ModelFile& file, const ModelMeshes& meshes) {
  Walk walk(file, meshes);
  walk.run();
  if (walk.model.instances.size() > kMaxInstances) {
    return absl::ResourceExhaustedError(
        absl::StrCat(file.name(), ": has more than ", kMaxInstances, " placements of meshes"));
  }
  if (walk.flattened > 0) {
    file.warn(
        absl::StrCat(walk.flattened, " placements are left out: their transform flattens them"));
  }
  if (file.scene.mNumCameras > 0 && !has_usable_cameras(file)) {
    file.warn(absl::StrCat(file.scene.mNumCameras, " cameras are left out"));
  }
  return std::move(walk.model);
}

}  // namespace bandsaw
