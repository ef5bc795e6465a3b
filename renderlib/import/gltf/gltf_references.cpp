// Checks the indices by which the objects of a glTF file refer to each other. Each entry of the
// table kReferences names a list, the member of its objects that is an index, and the list to which
// this index refers. Textures of materials, lights of nodes, primitives, the tree of nodes and the
// scenes are checked by functions of their own.

#include "renderlib/import/gltf/gltf_references.h"

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::gltf {
namespace {

/// Maximum depth of nodes. It is limited because Assimp's functions are recursive.
constexpr std::size_t kMaxNodeDepth = 1000;
constexpr char kLights[] = "KHR_lights_punctual";

/// The lists of the root, all of which contain objects.
constexpr const char* kLists[] = {"accessors", "buffers",   "bufferViews", "cameras",
                                  "images",    "materials", "meshes",      "nodes",
                                  "samplers",  "scenes",    "skins",       "textures"};

/// A member of the objects of `list` that is an index in the list `target`, or a list of such
/// indices. A Reference with an empty `list` is for a single object, which is passed to
/// check_member().
struct Reference {
  const char* list;
  const char* member;
  const char* target;
};
constexpr Reference kReferences[] = {{"nodes", "camera", "cameras"},
                                     {"nodes", "mesh", "meshes"},
                                     {"nodes", "skin", "skins"},
                                     {"nodes", "children", "nodes"},
                                     {"scenes", "nodes", "nodes"},
                                     {"skins", "joints", "nodes"},
                                     {"skins", "skeleton", "nodes"},
                                     {"skins", "inverseBindMatrices", "accessors"},
                                     {"textures", "source", "images"},
                                     {"textures", "sampler", "samplers"},
                                     {"images", "bufferView", "bufferViews"}};

/// Checks that each member of the root in kLists is a list of objects.
absl::Status check_lists(const Json& root) {
  for (const char* name : kLists) {
    const Json* found = find(root, name);
    if (found == nullptr) {
      continue;
    }
    if (!found->is_array()) {
      return damaged(name, "is not a list");
    }
    for (std::size_t i = 0; i < found->size(); ++i) {
      if (!(*found)[i].is_object()) {
        return damaged(absl::StrCat(name, "[", i, "]"), "is not an object");
      }
    }
  }
  return absl::OkStatus();
}

/// Checks that `index` is a number below the size of `of`, whose name is `target`.
absl::Status check_index(const Json& index, const Json& of, absl::string_view target,
                         const std::string& place) {
  const auto number = whole(index);
  if (!number) {
    return damaged(place, "is not a whole number >= 0");
  }
  return *number < of.size()
             ? absl::OkStatus()
             : damaged(place, absl::StrCat(target, "[", *number, "] does not exist; there are ",
                                           of.size()));
}

/// Checks the member `reference.member` of the object `in`, which is an index or a list of indices
/// of objects in `reference.target`. The member may be missing. `place` names `in` in messages.
absl::Status check_member(const Json& root, const Json& in, const Reference& reference,
                          const std::string& place) {
  const Json* value = find(in, reference.member);
  if (value == nullptr) {
    return absl::OkStatus();
  }
  const Json& target = items(root, reference.target);
  const std::string member = absl::StrCat(place, ".", reference.member);
  if (!value->is_array()) {
    return check_index(*value, target, reference.target, member);
  }
  for (std::size_t i = 0; i < value->size(); ++i) {
    RETURN_IF_ERROR(
        check_index((*value)[i], target, reference.target, absl::StrCat(member, "[", i, "]")));
  }
  return absl::OkStatus();
}

/// Checks that every member "…Texture" at any depth refers to a texture. The recursion is as deep
/// as the JSON, whose depth parse_json() limits.
absl::Status check_textures(const Json& root, const Json& in, const std::string& place) {
  if (!in.is_object()) {
    return absl::OkStatus();
  }
  for (const auto& [name, value] : in.items()) {
    const std::string member = absl::StrCat(place, ".", name);
    if (absl::EndsWith(name, "Texture") && value.is_object()) {
      RETURN_IF_ERROR(check_member(root, value, {"", "index", "textures"}, member));
    }
    RETURN_IF_ERROR(check_textures(root, value, member));
  }
  return absl::OkStatus();
}

/// Checks that the light of a node is in the list of lights, which is in the root's extension.
absl::Status check_light(const Json& root, const Json& node, const std::string& place) {
  const Json* used = extension(node, kLights);
  const Json* given = extension(root, kLights);
  static const Json kNone = Json::object();
  return used == nullptr
             ? absl::OkStatus()
             : check_member(given == nullptr ? kNone : *given, *used, {"", "light", "lights"},
                            absl::StrCat(place, ".extensions.", kLights));
}

/// Checks the index of the material of each primitive of each mesh.
absl::Status check_primitives(const Json& root) {
  const Json& meshes = items(root, "meshes");
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    const Json& primitives = items(meshes[m], "primitives");
    for (std::size_t p = 0; p < primitives.size(); ++p) {
      RETURN_IF_ERROR(check_member(root, primitives[p], {"", "material", "materials"},
                                   absl::StrCat("meshes[", m, "].primitives[", p, "]")));
    }
  }
  return absl::OkStatus();
}

/// Checks that each node is the child of at most one node, that no nodes are children of each other
/// in a circle, and that the trees have at most kMaxNodeDepth levels.
absl::Status check_tree(const Json& root) {
  const Json& nodes = items(root, "nodes");
  std::vector<bool> is_child(nodes.size(), false);
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    for (const Json& child : items(nodes[n], "children")) {
      const std::size_t number = *whole(child);
      if (is_child[number]) {
        return damaged(absl::StrCat("nodes[", n, "].children"),
                       absl::StrCat("nodes[", number, "] is the child of two nodes"));
      }
      is_child[number] = true;
    }
  }
  std::vector<std::size_t> level;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    if (!is_child[n]) {
      level.push_back(n);
    }
  }
  std::size_t reached = 0;
  for (std::size_t depth = 0; !level.empty(); ++depth) {
    if (depth == kMaxNodeDepth) {
      return damaged("nodes", absl::StrCat("are nested deeper than ", kMaxNodeDepth, " levels"));
    }
    reached += level.size();
    std::vector<std::size_t> next;
    for (const std::size_t n : level) {
      for (const Json& child : items(nodes[n], "children")) {
        next.push_back(*whole(child));
      }
    }
    level = std::move(next);
  }
  return reached == nodes.size() ? absl::OkStatus()
                                 : damaged("nodes", "are children of each other in a circle");
}

/// Checks the index of the default scene, and that no scene names a node twice.
absl::Status check_scenes(const Json& root) {
  RETURN_IF_ERROR(check_member(root, root, {"", "scene", "scenes"}, "the file"));
  const Json& scenes = items(root, "scenes");
  for (std::size_t s = 0; s < scenes.size(); ++s) {
    std::vector<bool> seen(items(root, "nodes").size(), false);
    for (const Json& node : items(scenes[s], "nodes")) {
      if (seen[*whole(node)]) {
        return damaged(absl::StrCat("scenes[", s, "].nodes"),
                       absl::StrCat("names nodes[", *whole(node), "] twice"));
      }
      seen[*whole(node)] = true;
    }
  }
  return absl::OkStatus();
}

}  // namespace

absl::Status check_references(const Json& root) {
  RETURN_IF_ERROR(check_lists(root));
  for (const Reference& reference : kReferences) {
    const Json& of = items(root, reference.list);
    for (std::size_t i = 0; i < of.size(); ++i) {
      RETURN_IF_ERROR(
          check_member(root, of[i], reference, absl::StrCat(reference.list, "[", i, "]")));
    }
  }
  const Json& nodes = items(root, "nodes");
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    RETURN_IF_ERROR(check_light(root, nodes[i], absl::StrCat("nodes[", i, "]")));
  }
  const Json& materials = items(root, "materials");
  for (std::size_t i = 0; i < materials.size(); ++i) {
    RETURN_IF_ERROR(check_textures(root, materials[i], absl::StrCat("materials[", i, "]")));
  }
  RETURN_IF_ERROR(check_primitives(root));
  RETURN_IF_ERROR(check_tree(root));
  return check_scenes(root);
}

}  // namespace bandsaw::gltf
