// Decodes meshes of glTF's extension KHR_draco_mesh_compression. libdraco decodes the stream to
// quantised integers, and Dequantizer converts these integers to floats.

#include "renderlib/import/gltf/draco_mesh.h"

#include <draco/attributes/attribute_octahedron_transform.h>
#include <draco/attributes/attribute_quantization_transform.h>
#include <draco/compression/decode.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::gltf {
namespace {

constexpr int kMaxComponents = 4;
using Raw = std::array<std::int64_t, kMaxComponents>;

/// Sets `to` to the components of the value at `at`. The components may be integers of any size.
/// Returns false if libdraco cannot convert the value.
bool load(const draco::PointAttribute& from, draco::AttributeValueIndex at, Raw& to) {
  return from.ConvertValue<std::int64_t>(at, from.num_components(), to.data());
}

/// Converts an attribute's integers to floats. libdraco does this too, but its floats depend on how
/// it was compiled (fused multiply-add on some architectures).
class Dequantizer {
 public:
  /// Reads the quantisation of the attribute `from`. Integers without quantisation are converted as
  /// `shape` says. `place` begins the message of an error.
  static absl::StatusOr<Dequantizer> of(const draco::PointAttribute& from,
                                        const AccessorShape& shape, const std::string& place) {
    Dequantizer out(from, shape);
    const draco::AttributeTransformData* data = from.GetAttributeTransformData();
    const bool is_octahedron =
        data != nullptr && data->transform_type() == draco::ATTRIBUTE_OCTAHEDRON_TRANSFORM;
    const bool is_quantized =
        data != nullptr && data->transform_type() == draco::ATTRIBUTE_QUANTIZATION_TRANSFORM;
    draco::AttributeQuantizationTransform quantized;
    draco::AttributeOctahedronTransform octahedron;
    if (is_quantized && quantized.InitFromAttribute(from) &&
        static_cast<int>(quantized.min_values().size()) >= from.num_components()) {
      const int bits = std::clamp(quantized.quantization_bits(), 1, 31);
      out.least_ = quantized.min_values();
      out.step_ = quantized.range() / static_cast<float>((1u << bits) - 1);
    } else if (is_octahedron && octahedron.InitFromAttribute(from) &&
               octahedron.quantization_bits() >= 2 && octahedron.quantization_bits() <= 30 &&
               from.num_components() == 2) {
      out.largest_ = (1 << octahedron.quantization_bits()) - 2;
    } else if (is_octahedron || is_quantized) {
      return damaged(place, "has an attribute whose quantisation is not valid");
    }
    return out;
  }

  /// Returns the number of floats of a value.
  std::size_t components() const {
    return largest_ > 0 ? 3 : static_cast<std::size_t>(from_.num_components());
  }

  /// Sets `to` to the value at `at`; returns false if libdraco cannot convert it.
  bool read(draco::AttributeValueIndex at, std::array<float, kMaxComponents>& to) const {
    Raw raw{};
    if (from_.data_type() == draco::DT_FLOAT32) {
      return from_.ConvertValue<float>(at, from_.num_components(), to.data());
    }
    if (!load(from_, at, raw)) {
      return false;
    }
    if (largest_ > 0) {
      to = direction(static_cast<float>(raw[0]), static_cast<float>(raw[1]));
      return true;
    }
    for (std::size_t c = 0; c < components(); ++c) {
      to[c] = least_.empty() ? value_of(raw[c], shape_.component, shape_.normalized)
                             : static_cast<float>(raw[c]) * step_ + least_[c];
    }
    return true;
  }

 private:
  Dequantizer(const draco::PointAttribute& from, const AccessorShape& shape)
      : from_(from), shape_(shape) {}

  /// Returns the unit vector of the octahedral coordinates (s, t) in [0, largest_]^2. The middle of
  /// this square is the direction +x (Cigolle et al. 2014, "A Survey of Efficient Representations
  /// for Independent Unit Vectors").
  std::array<float, kMaxComponents> direction(float s, float t) const {
    const float scale = 2.0f / static_cast<float>(largest_);
    float y = s * scale - 1;
    float z = t * scale - 1;
    const float x = 1 - std::abs(y) - std::abs(z);
    const float folded = std::max(-x, 0.0f);
    y += y < 0 ? folded : -folded;
    z += z < 0 ? folded : -folded;
    const float size = std::sqrt(x * x + y * y + z * z);
    return size > 0 ? std::array<float, kMaxComponents>{x / size, y / size, z / size}
                    : std::array<float, kMaxComponents>{};
  }

  const draco::PointAttribute& from_;
  const AccessorShape& shape_;
  std::vector<float> least_;  ///< minima of a quantised attribute; empty for other attributes
  float step_ = 0;            ///< size of one quantisation step
  int largest_ = 0;           ///< maximum of octahedral coordinates; 0 for other attributes
};

}  // namespace

DracoMesh::DracoMesh(std::unique_ptr<draco::Mesh> mesh, std::string place)
    : mesh_(std::move(mesh)), place_(std::move(place)) {}
DracoMesh::DracoMesh(DracoMesh&&) noexcept = default;
DracoMesh& DracoMesh::operator=(DracoMesh&&) noexcept = default;
DracoMesh::~DracoMesh() = default;

absl::StatusOr<DracoMesh> DracoMesh::decode(absl::string_view bytes, std::string place) {
  draco::DecoderBuffer buffer;
  buffer.Init(bytes.data(), bytes.size());
  draco::Decoder decoder;
  for (const auto type : {draco::GeometryAttribute::POSITION, draco::GeometryAttribute::NORMAL,
                          draco::GeometryAttribute::TEX_COORD, draco::GeometryAttribute::COLOR,
                          draco::GeometryAttribute::GENERIC}) {
    decoder.SetSkipAttributeTransform(type);
  }
  auto mesh = decoder.DecodeMeshFromBuffer(&buffer);
  if (!mesh.ok()) {
    return damaged(place, absl::StrCat("its Draco stream cannot be decoded (",
                                       mesh.status().error_msg_string(), ")"));
  }
  DracoMesh out(std::move(mesh).value(), std::move(place));
  const std::uint32_t vertices = out.mesh_->num_points();
  for (draco::FaceIndex f(0); f < out.mesh_->num_faces(); ++f) {
    for (const draco::PointIndex& corner : out.mesh_->face(f)) {
      if (corner.value() >= vertices) {
        return damaged(out.place_, absl::StrCat("triangle ", f.value(), " of its Draco stream",
                                                " refers to vertex ", corner.value(),
                                                "; the number of vertices is ", vertices));
      }
    }
  }
  return out;
}

std::size_t DracoMesh::vertices() const { return mesh_->num_points(); }

std::vector<std::uint32_t> DracoMesh::indices() const {
  std::vector<std::uint32_t> out;
  out.reserve(std::size_t{3} * mesh_->num_faces());
  for (draco::FaceIndex f(0); f < mesh_->num_faces(); ++f) {
    for (const draco::PointIndex& corner : mesh_->face(f)) {
      out.push_back(corner.value());
    }
  }
  return out;
}

absl::StatusOr<const draco::PointAttribute*> DracoMesh::attribute(
    std::size_t id, const AccessorShape& shape) const {
  const draco::PointAttribute* found =
      id <= UINT32_MAX ? mesh_->GetAttributeByUniqueId(static_cast<std::uint32_t>(id)) : nullptr;
  if (found == nullptr) {
    return damaged(place_, absl::StrCat("its Draco stream has no attribute ", id));
  }
  if (shape.count != vertices()) {
    return damaged(shape.place,
                   absl::StrCat("count is ", shape.count, ", but its Draco stream has ", vertices(),
                                " vertices"));
  }
  if (found->num_components() < 1 || found->num_components() > kMaxComponents) {
    return damaged(place_, absl::StrCat("attribute ", id, " of its Draco stream has ",
                                        static_cast<int>(found->num_components()), " components"));
  }
  return found;
}

absl::StatusOr<std::vector<float>> DracoMesh::floats(std::size_t id,
                                                     const AccessorShape& shape) const {
  ASSIGN_OR_RETURN(const draco::PointAttribute* from, attribute(id, shape));
  ASSIGN_OR_RETURN(const Dequantizer dequantizer, Dequantizer::of(*from, shape, place_));
  if (dequantizer.components() < shape.components) {
    return damaged(shape.place,
                   absl::StrCat("has ", shape.components, " components, but attribute ", id,
                                " of its Draco stream has ", dequantizer.components()));
  }
  std::vector<float> out(shape.values());
  std::array<float, kMaxComponents> value{};
  for (draco::PointIndex p(0); p < mesh_->num_points(); ++p) {
    const draco::AttributeValueIndex at = from->mapped_index(p);
    if (at.value() >= from->size() || !dequantizer.read(at, value)) {
      return damaged(place_, absl::StrCat("vertex ", p.value(), " of its Draco stream has no value",
                                          " of attribute ", id));
    }
    std::copy_n(value.begin(), shape.components, &out[p.value() * shape.components]);
  }
  return out;
}

absl::StatusOr<std::vector<std::uint32_t>> DracoMesh::whole_numbers(
    std::size_t id, const AccessorShape& shape) const {
  ASSIGN_OR_RETURN(const draco::PointAttribute* from, attribute(id, shape));
  const auto components = static_cast<std::size_t>(from->num_components());
  if (components < shape.components || from->data_type() == draco::DT_FLOAT32) {
    return damaged(shape.place, absl::StrCat("needs ", shape.components,
                                             " integers for each vertex, but attribute ", id,
                                             " of its Draco stream has fewer, or has floats"));
  }
  std::vector<std::uint32_t> out(shape.values());
  Raw raw{};
  for (draco::PointIndex p(0); p < mesh_->num_points(); ++p) {
    const draco::AttributeValueIndex at = from->mapped_index(p);
    if (at.value() >= from->size() || !load(*from, at, raw)) {
      return damaged(place_, absl::StrCat("vertex ", p.value(), " of its Draco stream has no value",
                                          " of attribute ", id));
    }
    for (std::size_t c = 0; c < shape.components; ++c) {
      out[p.value() * shape.components + c] =
          static_cast<std::uint32_t>(std::clamp<std::int64_t>(raw[c], 0, UINT32_MAX));
    }
  }
  return out;
}

}  // namespace bandsaw::gltf
