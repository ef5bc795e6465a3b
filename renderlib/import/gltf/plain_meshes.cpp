// Rewrites the meshes of a glTF file (plain_gltf.h): reads each attribute and index of a primitive,
// from its accessor or from a Draco stream, and adds it to the new buffer as floats, 16-bit joints
// or 32-bit indices.

#include "renderlib/import/gltf/plain_meshes.h"

#include <algorithm>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/strip.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::gltf {
namespace {

constexpr char kDraco[] = "KHR_draco_mesh_compression";
constexpr int kTriangles = 4;  // glTF's mode of a primitive that is a list of triangles

/// An attribute of glTF 2.0, 3.7.2.1. If `name` ends in "_", a number follows it in the file.
struct Semantic {
  const char* name;
  std::size_t least_components;
  std::size_t most_components;
};
constexpr Semantic kSemantics[] = {{"POSITION", 3, 3}, {"NORMAL", 3, 3},   {"TEXCOORD_", 2, 2},
                                   {"COLOR_", 3, 4},   {"WEIGHTS_", 4, 4}, {"JOINTS_", 4, 4}};

/// Returns the entry of kSemantics for an attribute of this name; nullptr if the attribute is left
/// out of the result.
const Semantic* semantic_of(absl::string_view attribute) {
  const auto found =
      std::find_if(std::begin(kSemantics), std::end(kSemantics), [&](const Semantic& semantic) {
        const absl::string_view name = semantic.name;
        return absl::EndsWith(name, "_") ? absl::StartsWith(attribute, name) : attribute == name;
      });
  return found == std::end(kSemantics) ? nullptr : found;
}

/// Returns INVALID_ARGUMENT if the accessor's vectors are too short or too long for the attribute.
absl::Status check_shape(const std::string& attribute, const AccessorShape& shape) {
  const Semantic& semantic = *semantic_of(attribute);
  return shape.components >= semantic.least_components &&
                 shape.components <= semantic.most_components
             ? absl::OkStatus()
             : damaged(shape.place, absl::StrCat("has ", shape.components, " components, ",
                                                 attribute, " needs ", semantic.least_components));
}

/// Adds an alpha of 1 to colours of three channels. Without it, each program that reads the
/// document would use its own default of alpha.
std::vector<float> with_alpha(const std::vector<float>& rgb) {
  std::vector<float> rgba;
  rgba.reserve(rgb.size() / 3 * 4);
  for (std::size_t i = 0; i + 2 < rgb.size(); i += 3) {
    rgba.insert(rgba.end(), {rgb[i], rgb[i + 1], rgb[i + 2], 1.0f});
  }
  return rgba;
}

}  // namespace

/// Returns the values of the attribute `name`, from the Draco stream if the attribute is in it,
/// otherwise from the accessor.
absl::StatusOr<std::vector<float>> PlainMeshes::float_values(const std::string& name,
                                                             std::size_t accessor,
                                                             const AccessorShape& shape,
                                                             const Stream& stream) {
  if (stream.attributes == nullptr || find(*stream.attributes, name) == nullptr) {
    return read_floats(root_, accessor, shape, buffers_);
  }
  ASSIGN_OR_RETURN(const std::size_t id, whole_of(*stream.attributes, name, kDraco));
  RETURN_IF_ERROR(buffers_.take(shape.values() * sizeof(float), shape.place));
  return stream.mesh->floats(id, shape);
}

/// Adds the attribute `name` to the buffer as floats. Colours get four components.
absl::StatusOr<PlainMeshes::Added> PlainMeshes::floats(const std::string& name,
                                                       std::size_t accessor, const Stream& stream,
                                                       const std::string& place) {
  const bool is_color = absl::StartsWith(name, "COLOR_");
  const bool can_be_shared = stream.attributes == nullptr;
  if (const auto known = floats_.find({accessor, is_color});
      can_be_shared && known != floats_.end()) {
    return known->second;
  }
  ASSIGN_OR_RETURN(AccessorShape shape, accessor_shape(root_, accessor, place));
  RETURN_IF_ERROR(check_shape(name, shape));
  // Integer colours are always normalised, whatever the file says: glTF has no other integer
  // colours.
  shape.normalized |= is_color;
  ASSIGN_OR_RETURN(std::vector<float> values, float_values(name, accessor, shape, stream));
  if (is_color && shape.components == 3) {
    values = with_alpha(values);
  }
  const Added added{out_.add(values, is_color ? 4 : shape.components), shape.count};
  if (can_be_shared) {
    floats_[{accessor, is_color}] = added;
  }
  return added;
}

/// Adds the attribute `name` ("JOINTS_0") to the buffer as 16-bit joints. A joint of weight 0
/// becomes joint 0, because files may have any number for such a joint. Raises `joints` to 1 + the
/// largest joint of a weight other than 0.
absl::StatusOr<PlainMeshes::Added> PlainMeshes::joints_with_weight(const Json& attributes,
                                                                   const std::string& name,
                                                                   const Stream& stream,
                                                                   const std::string& place,
                                                                   std::uint32_t& joints) {
  const std::string weights_name = absl::StrCat("WEIGHTS_", absl::StripPrefix(name, "JOINTS_"));
  ASSIGN_OR_RETURN(const std::size_t accessor, whole_of(attributes, name, place));
  ASSIGN_OR_RETURN(const std::size_t weights_accessor, whole_of(attributes, weights_name, place));
  ASSIGN_OR_RETURN(const AccessorShape shape, accessor_shape(root_, accessor, place));
  ASSIGN_OR_RETURN(const AccessorShape weights_shape,
                   accessor_shape(root_, weights_accessor, place));
  RETURN_IF_ERROR(check_shape(name, shape));
  RETURN_IF_ERROR(check_shape(weights_name, weights_shape));
  if (weights_shape.count != shape.count) {
    return damaged(place, absl::StrCat("has ", shape.count, " ", name, " and ", weights_shape.count,
                                       " ", weights_name));
  }
  ASSIGN_OR_RETURN(const std::vector<float> weights,
                   float_values(weights_name, weights_accessor, weights_shape, stream));
  const bool is_compressed =
      stream.attributes != nullptr && find(*stream.attributes, name) != nullptr;
  std::vector<std::uint32_t> values;
  if (is_compressed) {
    ASSIGN_OR_RETURN(const std::size_t id, whole_of(*stream.attributes, name, place));
    ASSIGN_OR_RETURN(values, stream.mesh->whole_numbers(id, shape));
  } else {
    ASSIGN_OR_RETURN(values, read_whole_numbers(root_, accessor, shape, buffers_));
  }
  std::vector<std::uint16_t> narrow(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (weights[i] == 0) {
      continue;
    }
    if (values[i] > UINT16_MAX) {
      return damaged(shape.place, absl::StrCat("names joint ", values[i]));
    }
    joints = std::max(joints, values[i] + 1);
    narrow[i] = static_cast<std::uint16_t>(values[i]);
  }
  return Added{out_.add(narrow, shape.components), shape.count};
}

/// Adds the attributes of a primitive or morph target to the buffer and returns their new
/// accessors. `vertices` is the number of vertices, which is set by the first attribute. Raises
/// `joints` as joints_with_weight() does.
absl::StatusOr<Json> PlainMeshes::attributes(const Json& from, const Stream& stream,
                                             const std::string& place,
                                             std::optional<std::size_t>& vertices,
                                             std::uint32_t& joints) {
  Json to = Json::object();
  for (const auto& [name, index] : from.items()) {
    if (semantic_of(name) == nullptr) {
      continue;
    }
    Added added;
    if (absl::StartsWith(name, "JOINTS_")) {
      ASSIGN_OR_RETURN(added, joints_with_weight(from, name, stream, place, joints));
    } else {
      ASSIGN_OR_RETURN(const std::size_t accessor, whole_of(from, name, place));
      ASSIGN_OR_RETURN(added, floats(name, accessor, stream, absl::StrCat(place, ".", name)));
    }
    if (vertices.value_or(added.count) != added.count) {
      return damaged(place, absl::StrCat("has ", added.count, " values of ", name, ", but ",
                                         *vertices, " values of another attribute"));
    }
    vertices = added.count;
    to[name] = added.accessor;
  }
  return to;
}

/// Adds the vertex indices in an accessor to the buffer, once for all primitives that share them.
absl::StatusOr<PlainMeshes::Added> PlainMeshes::indices(std::size_t accessor,
                                                        const std::string& place) {
  if (const auto known = indices_.find(accessor); known != indices_.end()) {
    return known->second;
  }
  ASSIGN_OR_RETURN(const AccessorShape shape, accessor_shape(root_, accessor, place));
  if (shape.components != 1) {
    return damaged(shape.place, "holds vectors, but indices are single numbers");
  }
  ASSIGN_OR_RETURN(const auto values, read_whole_numbers(root_, accessor, shape, buffers_));
  const auto largest = std::max_element(values.begin(), values.end());
  const Added added{out_.add(values), values.size(), largest == values.end() ? 0 : *largest};
  indices_[accessor] = added;
  return added;
}

/// Decodes the Draco stream of a primitive. Returns an empty Stream if it has none.
absl::StatusOr<PlainMeshes::Stream> PlainMeshes::stream_of(const Json& primitive,
                                                           const std::string& place) {
  const Json* compressed = extension(primitive, kDraco);
  if (compressed == nullptr) {
    return Stream{};
  }
  ASSIGN_OR_RETURN(const std::size_t view, whole_of(*compressed, "bufferView", place));
  ASSIGN_OR_RETURN(const absl::string_view bytes, buffers_.view(view, place));
  Stream stream;
  ASSIGN_OR_RETURN(stream.mesh, DracoMesh::decode(bytes, place));
  stream.attributes = object(*compressed, "attributes");
  if (stream.attributes == nullptr) {
    return damaged(place, "does not name the attributes of its Draco stream");
  }
  return stream;
}

/// Returns the primitive `from` with accessors of `out`. Raises `joints` as joints_with_weight()
/// does.
absl::StatusOr<Json> PlainMeshes::primitive(const Json& from, const std::string& place,
                                            std::uint32_t& joints) {
  ASSIGN_OR_RETURN(const Stream stream, stream_of(from, place));
  Json to = from;
  std::optional<std::size_t> vertices;
  static const Json kNone = Json::object();
  const Json* given = object(from, "attributes");
  ASSIGN_OR_RETURN(to["attributes"],
                   attributes(given == nullptr ? kNone : *given, stream, place, vertices, joints));
  const Json& targets = items(from, "targets");
  for (std::size_t t = 0; t < targets.size(); ++t) {
    // Morph targets of texture coordinates and colours are not rendered.
    Json kept = Json::object();
    for (const char* name : {"POSITION", "NORMAL"}) {
      if (const Json* index = find(targets[t], name)) {
        kept[name] = *index;
      }
    }
    ASSIGN_OR_RETURN(
        to["targets"][t],
        attributes(kept, {}, absl::StrCat(place, ".targets[", t, "]"), vertices, joints));
  }
  if (stream.mesh) {
    to["indices"] = out_.add(stream.mesh->indices());
    to["mode"] = kTriangles;
    remove_extension(to, kDraco);
  } else if (find(from, "indices") != nullptr) {
    ASSIGN_OR_RETURN(const std::size_t accessor, whole_of(from, "indices", place));
    ASSIGN_OR_RETURN(const Added added, indices(accessor, place + ".indices"));
    if (added.count > 0 && added.largest >= vertices.value_or(0)) {
      return damaged(place + ".indices",
                     absl::StrCat("refers to vertex ", added.largest,
                                  "; the number of vertices is ", vertices.value_or(0)));
    }
    to["indices"] = added.accessor;
  }
  return to;
}

absl::StatusOr<Json> PlainMeshes::mesh(std::size_t index) {
  const Json& from = items(root_, "meshes")[index];
  Json to = from;
  const Json& primitives = items(from, "primitives");
  std::uint32_t& joints = joints_[index];
  for (std::size_t p = 0; p < primitives.size(); ++p) {
    const std::string place = absl::StrCat("meshes[", index, "].primitives[", p, "]");
    if (!primitives[p].is_object()) {
      return damaged(place, "is not an object");
    }
    ASSIGN_OR_RETURN(to["primitives"][p], primitive(primitives[p], place, joints));
  }
  return to;
}

std::uint32_t PlainMeshes::joints_of(std::size_t index) const {
  const auto found = joints_.find(index);
  return found == joints_.end() ? 0 : found->second;
}

}  // namespace bandsaw::gltf
