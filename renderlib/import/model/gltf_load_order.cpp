#include "renderlib/import/model/gltf_load_order.h"

#include <map>
#include <set>
#include <utility>

namespace bandsaw {
namespace {

using gltf::extension;
using gltf::item;
using gltf::item_of;
using gltf::list;
using gltf::ListValue;
using gltf::name_in;
using gltf::number;
using gltf::Struct;

constexpr char kLights[] = "KHR_lights_punctual";

// The tree is walked with a stack of its own; a node that is met again is not entered.
class Walk {
 public:
  explicit Walk(const Struct& root) : root_(root) {}

  void run() {
    const Struct* scene = item(root_, "scenes", number(root_, "scene").value_or(0));
    const ListValue* roots = scene == nullptr ? nullptr : list(*scene, "nodes");
    // Assimp puts a node above several.
    const std::size_t above = roots != nullptr && roots->values_size() == 1 ? 0 : 1;
    push_all(roots);
    while (!stack_.empty()) {
      const auto [node, is_entered] = stack_.back();
      stack_.pop_back();
      if (is_entered) {
        const Struct* mesh = item_of(root_, "meshes", *node, "mesh");
        add_mesh(mesh);
        if (const Struct* skin = item_of(root_, "skins", *node, "skin"); skin && mesh) {
          skins_[mesh] = skin;  // Assimp keeps the last
        }
        add(item_of(root_, "cameras", *node, "camera"), numbers_[node], cameras_, order.cameras);
        if (const Struct* light = extension(*node, kLights);
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
  }

  GltfLoadOrder order;

 private:
  void push_all(const ListValue* nodes) {
    for (int i = nodes == nullptr ? 0 : nodes->values_size(); i-- > 0;) {
      if (const Struct* node = item(root_, "nodes", nodes->values(i).number_value())) {
        stack_.emplace_back(node, false);
      }
    }
  }
  void add_mesh(const Struct* mesh) {
    const ListValue* primitives = mesh == nullptr ? nullptr : list(*mesh, "primitives");
    if (primitives != nullptr && first_meshes_.emplace(mesh, meshes_).second) {
      meshes_ += static_cast<std::size_t>(primitives->values_size());
    }
    for (int i = 0; primitives != nullptr && i < primitives->values_size(); ++i) {
      const Struct& primitive = primitives->values(i).struct_value();
      const Struct* material = item_of(root_, "materials", primitive, "material");
      if (material != nullptr && seen_.insert(material).second) {
        order.materials.push_back(material);
      }
    }
  }
  // Joints may lie behind the meshes that they hold.
  void add_bones() {
    for (const auto& [mesh, skin] : skins_) {
      const ListValue* joints = list(*skin, "joints");
      std::vector<std::size_t> nodes;
      for (int i = 0; joints != nullptr && i < joints->values_size(); ++i) {
        const auto node = numbers_.find(item(root_, "nodes", joints->values(i).number_value()));
        if (node == numbers_.end()) {
          nodes.clear();
          break;
        }
        nodes.push_back(node->second);
      }
      const ListValue* primitives = list(*mesh, "primitives");
      for (int i = 0; primitives != nullptr && i < primitives->values_size(); ++i) {
        order.bones[first_meshes_[mesh] + static_cast<std::size_t>(i)] = nodes;
      }
    }
  }

  using Loaded = std::map<const Struct*, std::size_t>;
  static void add(const Struct* what, std::size_t node, Loaded& loaded,
                  std::vector<GltfAtNode>& to) {
    if (what != nullptr) {
      to.push_back({node, loaded.emplace(what, loaded.size()).first->second, name_in(*what)});
    }
  }

  const Struct& root_;
  const Struct* lights_in_ = extension(root_, kLights);
  std::vector<std::pair<const Struct*, bool>> stack_;  ///< and whether its children are done
  std::map<const Struct*, std::size_t> numbers_;       ///< of the nodes, parents first
  std::set<const Struct*> seen_;
  Loaded cameras_;  ///< and the how manieth each is
  Loaded lights_;
  Loaded first_meshes_;                           ///< and Assimp's mesh of their first primitive
  std::size_t meshes_ = 0;                        ///< of Assimp's
  std::map<const Struct*, const Struct*> skins_;  ///< of meshes
};

}  // namespace

GltfLoadOrder load_order(const Struct& root) {
  Walk walk(root);
  walk.run();
  return std::move(walk.order);
}

}  // namespace bandsaw
