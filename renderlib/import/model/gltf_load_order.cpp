// Repeats the traversal of Assimp's glTF loader on the JSON, and notes the order in which Assimp
// loads materials, cameras, lights and nodes.

#include "renderlib/import/model/gltf_load_order.h"

#include <map>
#include <set>
#include <utility>

namespace bandsaw {
namespace {

using gltf::extension;
using gltf::item;
using gltf::item_of;
using gltf::items;
using gltf::Json;
using gltf::list;
using gltf::name_in;
using gltf::number;
using gltf::object;

constexpr char kLights[] = "KHR_lights_punctual";

/// Repeats the traversal of Assimp's glTF loader: nodes depth first, the objects of a node after
/// its children. Uses an explicit stack; a node that is reached again is not entered.
class Walk {
 public:
  explicit Walk(const Json& root) : root_(root) {}

  /// Visits the nodes of the default scene and fills `order`.
  void run() {
    const Json* scene = item(root_, "scenes", number(root_, "scene").value_or(0));
    const Json* roots = scene == nullptr ? nullptr : list(*scene, "nodes");
    // The number of nodes above the root nodes: Assimp adds a root if there are several root nodes.
    const std::size_t above = roots != nullptr && roots->size() == 1 ? 0 : 1;
    push_all(roots);
    while (!stack_.empty()) {
      const auto [node, is_entered] = stack_.back();
      stack_.pop_back();
      if (is_entered) {
        const Json* mesh = item_of(root_, "meshes", *node, "mesh");
        add_mesh(mesh);
        if (const Json* skin = item_of(root_, "skins", *node, "skin"); skin && mesh) {
          skins_[mesh] = skin;  // a mesh has one skin in a document of gltf/plain_gltf.h
        }
        add(item_of(root_, "cameras", *node, "camera"), numbers_[node], cameras_, order.cameras);
        if (const Json* light = extension(*node, kLights);
            light != nullptr && lights_in_ != nullptr) {
          add(item_of(*lights_in_, "lights", *light, "light"), numbers_[node], lights_,
              order.lights);
        }
      } else if (numbers_.emplace(node, above + numbers_.size()).second) {
        stack_.emplace_back(node, true);
        push_all(list(*node, "children"));
      }
    }
    add_bones();
    const Json& nodes = items(root_, "nodes");
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (const auto found = numbers_.find(&nodes[i]); found != numbers_.end()) {
        order.nodes.emplace(i, found->second);
      }
    }
  }

  GltfLoadOrder order;

 private:
  /// Pushes the nodes of a JSON array of node indices, the first on top of the stack.
  void push_all(const Json* nodes) {
    for (std::size_t i = nodes == nullptr ? 0 : nodes->size(); i-- > 0;) {
      if (const Json* node = item(root_, "nodes", (*nodes)[i].get<double>())) {
        stack_.emplace_back(node, false);
      }
    }
  }
  /// Numbers the primitives of the mesh, each of which is a mesh of Assimp, and adds its materials.
  void add_mesh(const Json* mesh) {
    const Json* primitives = mesh == nullptr ? nullptr : list(*mesh, "primitives");
    if (primitives != nullptr && first_meshes_.emplace(mesh, meshes_).second) {
      meshes_ += primitives->size();
    }
    for (std::size_t i = 0; primitives != nullptr && i < primitives->size(); ++i) {
      const Json& primitive = (*primitives)[i];
      const Json* material = item_of(root_, "materials", primitive, "material");
      if (material != nullptr && seen_.insert(material).second) {
        order.materials.push_back(material);
      }
    }
  }
  // Bones are added after the traversal, because joints may come after the meshes that use them.
  void add_bones() {
    for (const auto& [mesh, skin] : skins_) {
      std::vector<std::size_t> nodes;
      for (const Json& joint : items(*skin, "joints")) {
        const auto node = numbers_.find(item(root_, "nodes", joint.get<double>()));
        if (node == numbers_.end()) {
          nodes.clear();  // a bone outside of the default scene
          break;
        }
        nodes.push_back(node->second);
      }
      for (std::size_t i = 0; i < items(*mesh, "primitives").size(); ++i) {
        order.bones[first_meshes_[mesh] + i] = nodes;
      }
    }
  }

  using Loaded = std::map<const Json*, std::size_t>;
  /// Adds a camera or light at Assimp's node number `node`. Several nodes may share one object.
  static void add(const Json* what, std::size_t node, Loaded& loaded, std::vector<GltfAtNode>& to) {
    if (what != nullptr) {
      const Json* perspective = object(*what, "perspective");
      to.push_back({node, loaded.emplace(what, loaded.size()).first->second, name_in(*what),
                    perspective == nullptr ? std::nullopt : number(*perspective, "yfov")});
    }
  }

  const Json& root_;
  const Json* lights_in_ = extension(root_, kLights);
  /// Nodes to visit. The flag is true if the children of the node have been pushed.
  std::vector<std::pair<const Json*, bool>> stack_;
  std::map<const Json*, std::size_t> numbers_;  ///< indices of the nodes, parents first
  std::set<const Json*> seen_;                  ///< materials that were added
  Loaded cameras_;                              ///< cameras that were added, with their indices
  Loaded lights_;
  Loaded first_meshes_;     ///< meshes, with Assimp's number of their first primitive
  std::size_t meshes_ = 0;  ///< number of Assimp's meshes
  std::map<const Json*, const Json*> skins_;  ///< meshes with a skin, and their skins
};

}  // namespace

GltfLoadOrder load_order(const Json& root) {
  Walk walk(root);
  walk.run();
  return std::move(walk.order);
}

}  // namespace bandsaw
