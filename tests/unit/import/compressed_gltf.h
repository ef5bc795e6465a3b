#pragma once

// Makes glTF files with compressed meshes, for tests of their decoding. The encoders are those of
// libdraco (KHR_draco_mesh_compression) and libmeshoptimizer (EXT_meshopt_compression). The mesh is
// a WavySquare, a square of triangles that is bent to a wave.

#include <draco/compression/encode.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <string>

#include "tests/unit/import/gltf_writer.h"

namespace bandsaw::test {

/// Adds a buffer view that is compressed by meshopt: `stream` decodes to `count` elements of
/// `stride` bytes. The uncompressed data of the view would be in buffer 1, which has no data, so a
/// reader must decode `stream`. `mode` and `filter` are those that the extension defines. Returns
/// the index of the view.
inline std::size_t add_view(GltfWriter& file, const std::string& stream, std::size_t count,
                            std::size_t stride, const char* mode, const char* filter = "NONE") {
  const std::size_t at = file.view(stream);
  Json& view = file.root["bufferViews"][at];
  Json compressed = view;
  compressed.update({{"count", count}, {"byteStride", stride}, {"mode", mode}, {"filter", filter}});
  view = {{"buffer", 1}, {"byteLength", count * stride}};
  view["extensions"]["EXT_meshopt_compression"] = compressed;
  if (mode == std::string("ATTRIBUTES")) {
    view["byteStride"] = stride;
  }
  return at;
}

/// Returns vertices of `stride` bytes, encoded by meshopt.
inline std::string encoded_vertices(const std::string& bytes, std::size_t stride) {
  const std::size_t count = bytes.size() / stride;
  std::string out(meshopt_encodeVertexBufferBound(count, stride), '\0');
  meshopt_encodeVertexVersion(0);
  out.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(out.data()), out.size(),
                                        bytes.data(), count, stride));
  return out;
}

/// Adds an accessor over vertices that are encoded by meshopt. `members`: the accessor's component
/// type and type. Returns the index of the accessor.
inline std::size_t add_attribute(GltfWriter& file, const std::string& bytes, std::size_t stride,
                                 const Json& members, const char* filter = "NONE") {
  const std::size_t count = bytes.size() / stride;
  Json whole = members;
  whole["bufferView"] =
      add_view(file, encoded_vertices(bytes, stride), count, stride, "ATTRIBUTES", filter);
  whole["count"] = count;
  return file.accessor(whole);
}

inline const Json kFloats3 = {{"componentType", 5126}, {"type", "VEC3"}};
inline const Json kFloats2 = {{"componentType", 5126}, {"type", "VEC2"}};

/// Returns the indices of the square, encoded by meshopt as a sequence or as triangles.
inline std::string encoded_indices(const WavySquare& square, bool as_sequence) {
  const auto& indices = square.indices;
  meshopt_encodeIndexVersion(1);
  std::string out(as_sequence ? meshopt_encodeIndexSequenceBound(indices.size(), square.vertices())
                              : meshopt_encodeIndexBufferBound(indices.size(), square.vertices()),
                  '\0');
  auto* to = reinterpret_cast<unsigned char*>(out.data());
  out.resize(as_sequence
                 ? meshopt_encodeIndexSequence(to, out.size(), indices.data(), indices.size())
                 : meshopt_encodeIndexBuffer(to, out.size(), indices.data(), indices.size()));
  return out;
}

/// Returns a file of the square that is encoded by meshopt. `index_size`: bytes of a decoded index,
/// 2 or 4.
inline GltfWriter with_meshopt(const WavySquare& square, bool as_sequence, std::size_t index_size) {
  GltfWriter file;
  file.attributes() = {{"POSITION", add_attribute(file, bytes_of(square.positions), 12, kFloats3)},
                       {"NORMAL", add_attribute(file, bytes_of(square.normals), 12, kFloats3)},
                       {"TEXCOORD_0", add_attribute(file, bytes_of(square.uvs), 8, kFloats2)}};
  const std::size_t view =
      add_view(file, encoded_indices(square, as_sequence), square.indices.size(), index_size,
               as_sequence ? "INDICES" : "TRIANGLES");
  file.primitive()["indices"] = file.accessor({{"bufferView", view},
                                               {"componentType", index_size == 2 ? 5123 : 5125},
                                               {"type", "SCALAR"},
                                               {"count", square.indices.size()}});
  file.root["buffers"] = {{{"uri", "m.gltf.bin"}, {"byteLength", file.bytes.size()}},
                          {{"byteLength", 1'000'000}}};
  file.root["extensionsUsed"] = {"EXT_meshopt_compression"};
  file.root["extensionsRequired"] = {"EXT_meshopt_compression"};
  return file;
}

/// Returns the square as a Draco mesh, whose attributes 0 to 2 are positions, normals and uvs.
/// `bits`: size of a quantised number; 0: numbers are not quantised. `edgebreaker`: the encoding is
/// Draco's edgebreaker, otherwise the sequential one.
inline std::string draco_stream(const WavySquare& square, int bits, bool edgebreaker) {
  draco::Mesh mesh;
  mesh.set_num_points(static_cast<std::uint32_t>(square.vertices()));
  const auto add = [&](draco::GeometryAttribute::Type type, int components,
                       const std::vector<float>& values) {
    draco::GeometryAttribute attribute;
    attribute.Init(type, nullptr, static_cast<std::int8_t>(components), draco::DT_FLOAT32, false,
                   4 * components, 0);
    const int id = mesh.AddAttribute(attribute, true, mesh.num_points());
    for (std::uint32_t i = 0; i < mesh.num_points(); ++i) {
      mesh.attribute(id)->SetAttributeValue(
          draco::AttributeValueIndex(i), values.data() + i * static_cast<std::size_t>(components));
    }
  };
  add(draco::GeometryAttribute::POSITION, 3, square.positions);
  add(draco::GeometryAttribute::NORMAL, 3, square.normals);
  add(draco::GeometryAttribute::TEX_COORD, 2, square.uvs);
  for (std::size_t i = 0; i < square.indices.size(); i += 3) {
    mesh.AddFace({draco::PointIndex(square.indices[i]), draco::PointIndex(square.indices[i + 1]),
                  draco::PointIndex(square.indices[i + 2])});
  }
  draco::Encoder encoder;
  encoder.SetEncodingMethod(edgebreaker ? draco::MESH_EDGEBREAKER_ENCODING
                                        : draco::MESH_SEQUENTIAL_ENCODING);
  for (const auto type : {draco::GeometryAttribute::POSITION, draco::GeometryAttribute::NORMAL,
                          draco::GeometryAttribute::TEX_COORD}) {
    if (bits > 0) {
      encoder.SetAttributeQuantization(type, bits);
    }
  }
  draco::EncoderBuffer out;
  EXPECT_TRUE(encoder.EncodeMeshToBuffer(mesh, &out).ok());
  return std::string(out.data(), out.size());
}

/// Returns a file of one mesh, which is stored as this Draco stream. `vertices` and `indices` are
/// the numbers that the file states, right or wrong.
inline GltfWriter with_draco(const std::string& stream, std::size_t vertices, std::size_t indices) {
  GltfWriter file;
  const auto accessor = [&](Json members, std::size_t count) {
    members["count"] = count;
    return file.accessor(members);
  };
  file.attributes() = {{"POSITION", accessor(kFloats3, vertices)},
                       {"NORMAL", accessor(kFloats3, vertices)},
                       {"TEXCOORD_0", accessor(kFloats2, vertices)}};
  file.primitive()["indices"] = accessor({{"componentType", 5125}, {"type", "SCALAR"}}, indices);
  file.primitive()["extensions"]["KHR_draco_mesh_compression"] = {
      {"bufferView", file.view(stream)},
      {"attributes", {{"POSITION", 0}, {"NORMAL", 1}, {"TEXCOORD_0", 2}}}};
  file.root["extensionsUsed"] = {"KHR_draco_mesh_compression"};
  file.root["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  return file;
}
/// Returns a file of the square as a Draco stream. The parameters are those of draco_stream().
inline GltfWriter with_draco(const WavySquare& square, int bits, bool edgebreaker) {
  return with_draco(draco_stream(square, bits, edgebreaker), square.vertices(),
                    square.indices.size());
}

}  // namespace bandsaw::test
