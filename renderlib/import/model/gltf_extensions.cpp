#include "renderlib/import/model/gltf_extensions.h"

#include <google/protobuf/struct.pb.h>
#include <google/protobuf/util/json_util.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <set>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/string_view.h"
#include "renderlib/base/file.h"
#include "renderlib/math/elementary.h"

namespace bandsaw {
namespace {

using google::protobuf::ListValue;
using google::protobuf::Struct;
using google::protobuf::Value;

constexpr std::uint64_t kMostBytes = std::uint64_t{8} << 30;
/// More JSON than this is not searched: data URIs, mostly.
constexpr std::size_t kMostJson = std::size_t{256} << 20;

/// Extensions whose meaning reaches the scene, or that say nothing about how it looks.
constexpr absl::string_view kKnown[] = {
    "KHR_materials_clearcoat",    "KHR_materials_emissive_strength",
    "KHR_materials_ior",          "KHR_materials_specular",
    "KHR_materials_transmission", "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_unlit",        "KHR_texture_transform",
    "KHR_lights_punctual",        "KHR_xmp_json_ld",
    "KHR_draco_mesh_compression"};

const Value* find(const Struct& in, const std::string& name) {
  const auto found = in.fields().find(name);
  return found == in.fields().end() ? nullptr : &found->second;
}
const Struct* object(const Struct& in, const std::string& name) {
  const Value* value = find(in, name);
  return value != nullptr && value->has_struct_value() ? &value->struct_value() : nullptr;
}
const ListValue* list(const Struct& in, const std::string& name) {
  const Value* value = find(in, name);
  return value != nullptr && value->has_list_value() ? &value->list_value() : nullptr;
}
std::optional<double> number(const Struct& in, const std::string& name) {
  const Value* value = find(in, name);
  return value != nullptr && value->kind_case() == Value::kNumberValue
             ? std::optional(value->number_value())
             : std::nullopt;
}
const Struct* extension(const Struct& in, const std::string& name) {
  const Struct* extensions = object(in, "extensions");
  return extensions == nullptr ? nullptr : object(*extensions, name);
}

// Two numbers, or what stands there.
void read_pair(const Struct& in, const std::string& name, double& x, double& y) {
  const ListValue* values = list(in, name);
  if (values != nullptr && values->values_size() == 2) {
    x = values->values(0).number_value();
    y = values->values(1).number_value();
  }
}

// offset + rotation (scale uv) with the image's top at v = 0, seen from uvs whose v = 0 is the
// bottom: v -> 1 - v before and after. The rotation is counter-clockwise as the image is seen.
UvTransform transform_of(const Struct& from) {
  double offset_u = 0;
  double offset_v = 0;
  double scale_u = 1;
  double scale_v = 1;
  read_pair(from, "offset", offset_u, offset_v);
  read_pair(from, "scale", scale_u, scale_v);
  constexpr double kTurn = 6.283185307179586;
  const SinCos turn = sincos_turns(number(from, "rotation").value_or(0) / kTurn);
  return {{turn.cos * scale_u, -turn.sin * scale_v, offset_u + turn.sin * scale_v,
           turn.sin * scale_u, turn.cos * scale_v, 1 - offset_v - turn.cos * scale_v}};
}

GltfTexture texture_of(const Struct& from) {
  GltfTexture to;
  double uv_set = number(from, "texCoord").value_or(0);
  if (const Struct* placed = extension(from, "KHR_texture_transform"); placed != nullptr) {
    to.transform = transform_of(*placed);
    uv_set = number(*placed, "texCoord").value_or(uv_set);
  }
  const bool finite = std::all_of(to.transform.m.begin(), to.transform.m.end(),
                                  [](double v) { return std::isfinite(v); });
  to.transform = finite ? to.transform : UvTransform{};
  to.uv_set = uv_set >= 0 && uv_set < 64 ? static_cast<unsigned>(uv_set) : 0;
  return to;
}

void read_textures_of(const Struct& from, GltfMaterial& to) {
  for (const auto& [name, value] : from.fields()) {
    if (absl::EndsWith(name, "Texture") && value.has_struct_value()) {
      to.textures[name] = texture_of(value.struct_value());
    }
  }
}

GltfSpecular specular_of(const Struct& from) {
  GltfSpecular to;
  to.factor = number(from, "specularFactor").value_or(1);
  const ListValue* color = list(from, "specularColorFactor");
  for (int i = 0; color != nullptr && color->values_size() == 3 && i < 3; ++i) {
    to.color[static_cast<std::size_t>(i)] = color->values(i).number_value();
  }
  to.has_maps =
      object(from, "specularTexture") != nullptr || object(from, "specularColorTexture") != nullptr;
  return to;
}

std::string name_in(const Struct& from) {
  const Value* called = find(from, "name");
  return called == nullptr ? "" : called->string_value();
}

GltfMaterial material_of(const Struct& from) {
  GltfMaterial to;
  to.name = name_in(from);
  read_textures_of(from, to);
  if (const Struct* base = object(from, "pbrMetallicRoughness"); base != nullptr) {
    read_textures_of(*base, to);
  }
  for (const char* name : {"KHR_materials_clearcoat", "KHR_materials_transmission",
                           "KHR_materials_pbrSpecularGlossiness"}) {
    if (const Struct* layer = extension(from, name); layer != nullptr) {
      read_textures_of(*layer, to);
    }
  }
  if (const Struct* coat = extension(from, "KHR_materials_clearcoat"); coat != nullptr) {
    const Struct* normal = object(*coat, "clearcoatNormalTexture");
    to.coat_normal_scale = normal == nullptr ? 1 : number(*normal, "scale").value_or(1);
  }
  if (const Struct* glow = extension(from, "KHR_materials_emissive_strength"); glow != nullptr) {
    to.emissive_strength = number(*glow, "emissiveStrength");
  }
  if (const Struct* specular = extension(from, "KHR_materials_specular"); specular != nullptr) {
    to.specular = specular_of(*specular);
  }
  if (const Struct* ior = extension(from, "KHR_materials_ior"); ior != nullptr) {
    to.index_of_refraction = number(*ior, "ior").value_or(1.5);
  }
  return to;
}

// An item of a list of the file, by a number that the file gives.
const Struct* item(const Struct& root, const std::string& name, double index) {
  const ListValue* items = list(root, name);
  return items != nullptr && index >= 0 && index < items->values_size() &&
                 items->values(static_cast<int>(index)).has_struct_value()
             ? &items->values(static_cast<int>(index)).struct_value()
             : nullptr;
}

// The materials of the default scene's meshes and the cameras at its nodes, in the order in which
// Assimp loads them. The tree is walked with a stack of its own; a node that is met again is not
// entered.
class LoadOrder {
 public:
  explicit LoadOrder(const Struct& root) : root_(root) {}

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
        add_mesh(item(root_, "meshes", number(*node, "mesh").value_or(-1)));
        add_camera(item(root_, "cameras", number(*node, "camera").value_or(-1)), numbers_[node]);
      } else if (numbers_.emplace(node, above + numbers_.size()).second) {
        stack_.emplace_back(node, true);
        push_all(list(*node, "children"));
      }
    }
  }

  std::vector<const Struct*> materials;
  std::vector<GltfCamera> cameras;

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
    for (int i = 0; primitives != nullptr && i < primitives->values_size(); ++i) {
      const Struct& primitive = primitives->values(i).struct_value();
      const Struct* material = item(root_, "materials", number(primitive, "material").value_or(-1));
      if (material != nullptr && seen_.insert(material).second) {
        materials.push_back(material);
      }
    }
  }
  void add_camera(const Struct* camera, std::size_t node) {
    if (camera != nullptr) {
      const std::size_t loaded = loaded_.emplace(camera, loaded_.size()).first->second;
      cameras.push_back({node, loaded, name_in(*camera)});
    }
  }

  const Struct& root_;
  std::vector<std::pair<const Struct*, bool>> stack_;  ///< and whether its children are done
  std::map<const Struct*, std::size_t> numbers_;       ///< of the nodes, parents first
  std::set<const Struct*> seen_;
  std::map<const Struct*, std::size_t> loaded_;  ///< cameras, and the how manieth each is
};

// The JSON of a .gltf, or the first chunk of a .glb (glTF 2.0, 4.4).
absl::string_view json_of(absl::string_view bytes) {
  if (!absl::StartsWith(bytes, "glTF")) {
    return bytes;
  }
  constexpr std::size_t kHeader = 20;
  std::uint32_t size = 0;
  if (bytes.size() < kHeader) {
    return {};
  }
  std::memcpy(&size, bytes.data() + 12, sizeof size);
  return bytes.substr(kHeader, size);
}

}  // namespace

GltfExtensions read_gltf_extensions(const std::string& path) {
  GltfExtensions out;
  const auto bytes = read_whole_file(path, kMostBytes);
  const absl::string_view json = bytes.ok() ? json_of(*bytes) : absl::string_view();
  Struct root;
  if (json.empty() || json.size() > kMostJson ||
      !google::protobuf::util::JsonStringToMessage({json.data(), json.size()}, &root).ok()) {
    return out;
  }
  if (const ListValue* used = list(root, "extensionsUsed"); used != nullptr) {
    for (const Value& name : used->values()) {
      if (std::find(std::begin(kKnown), std::end(kKnown), name.string_value()) ==
          std::end(kKnown)) {
        out.ignored.push_back(name.string_value());
      }
    }
  }
  LoadOrder order(root);
  order.run();
  for (const Struct* material : order.materials) {
    out.materials.push_back(material_of(*material));
  }
  out.cameras = std::move(order.cameras);
  if (const ListValue* scenes = list(root, "scenes"); scenes != nullptr) {
    out.scenes = static_cast<std::size_t>(scenes->values_size());
  }
  const Struct* punctual = extension(root, "KHR_lights_punctual");
  const ListValue* lights = punctual == nullptr ? nullptr : list(*punctual, "lights");
  for (int i = 0; lights != nullptr && i < lights->values_size(); ++i) {
    out.lights_with_range += find(lights->values(i).struct_value(), "range") != nullptr ? 1 : 0;
  }
  return out;
}

}  // namespace bandsaw
