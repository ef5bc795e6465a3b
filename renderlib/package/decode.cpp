#include "renderlib/package/package.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/package/arrays.h"
#include "renderlib/package/check.h"
#include "renderlib/package/decode_surface.h"
#include "renderlib/package/decode_texture.h"
#include "renderlib/package/manifest.h"

namespace bandsaw {
namespace {

class Decoder {
 public:
  explicit Decoder(BlobSource& blobs) : blobs_(blobs) {}

  // The whole blob, where it lies: a mapped file stays mapped. Its size has been compared with what
  // the manifest says.
  absl::StatusOr<SharedBytes> bytes(const package::Blob& blob, const std::string& field) {
    ASSIGN_OR_RETURN(const BlobRef ref, blob_ref(blob, field));
    ASSIGN_OR_RETURN(std::shared_ptr<const BlobBytes> held, blobs_.get(ref.digest));
    const absl::Span<const std::byte> bytes = held->bytes();
    if (bytes.size() != ref.size) {
      return manifest_error(field + ".size", absl::StrCat("is ", ref.size, ", the blob has ",
                                                          bytes.size(), " bytes"));
    }
    return SharedBytes(std::move(held), bytes);
  }

  // The same as an array of T.
  template <class T>
  absl::StatusOr<std::vector<T>> array(const package::Blob& blob, const std::string& field) {
    if (blob.size() % sizeof(T) != 0) {
      return manifest_error(field + ".size", absl::StrCat("must be a multiple of ", sizeof(T),
                                                          " bytes, is ", blob.size()));
    }
    ASSIGN_OR_RETURN(const SharedBytes whole, bytes(blob, field));
    return from_bytes<T>(whole.span());
  }

  // The same, with one entry for each of `count` shapes.
  template <class T>
  absl::StatusOr<std::vector<T>> array_of(std::size_t count, const package::Blob& blob,
                                          const std::string& field) {
    ASSIGN_OR_RETURN(std::vector<T> values, array<T>(blob, field));
    if (values.size() != count) {
      return manifest_error(field,
                            absl::StrCat("has ", values.size(), " entries for ", count, " shapes"));
    }
    return values;
  }

  absl::StatusOr<std::vector<Sphere>> spheres(const package::Spheres& from) {
    ASSIGN_OR_RETURN(const auto centers, array<Vec3>(from.centers(), "spheres.centers"));
    const std::size_t count = centers.size();
    ASSIGN_OR_RETURN(const auto radii, array_of<double>(count, from.radii(), "spheres.radii"));
    ASSIGN_OR_RETURN(const auto materials,
                     array_of<MaterialId>(count, from.material(), "spheres.material"));
    std::vector<Sphere> spheres(count);
    for (std::size_t i = 0; i < count; ++i) {
      spheres[i] = {centers[i], radii[i], materials[i]};
    }
    return spheres;
  }

  absl::StatusOr<std::vector<Quad>> quads(const package::Quads& from) {
    ASSIGN_OR_RETURN(const auto corners, array<Vec3>(from.corners(), "quads.corners"));
    const std::size_t count = corners.size();
    ASSIGN_OR_RETURN(const auto us, array_of<Vec3>(count, from.u(), "quads.u"));
    ASSIGN_OR_RETURN(const auto vs, array_of<Vec3>(count, from.v(), "quads.v"));
    ASSIGN_OR_RETURN(const auto materials,
                     array_of<MaterialId>(count, from.material(), "quads.material"));
    std::vector<Quad> quads(count);
    for (std::size_t i = 0; i < count; ++i) {
      quads[i] = {corners[i], us[i], vs[i], materials[i]};
    }
    return quads;
  }

  absl::StatusOr<std::vector<Triangle>> triangles(const package::Triangles& from) {
    using Corners = std::array<Vec3, 3>;
    ASSIGN_OR_RETURN(const auto corners, array<Corners>(from.vertices(), "triangles.vertices"));
    ASSIGN_OR_RETURN(const auto materials,
                     array_of<MaterialId>(corners.size(), from.material(), "triangles.material"));
    std::vector<Triangle> triangles(corners.size());
    for (std::size_t i = 0; i < corners.size(); ++i) {
      triangles[i] = {corners[i][0], corners[i][1], corners[i][2], materials[i]};
    }
    return triangles;
  }

  absl::StatusOr<Mesh> mesh(const package::Mesh& from, const std::string& field) {
    Mesh mesh;
    using F3 = std::array<float, 3>;
    using F2 = std::array<float, 2>;
    using U3 = std::array<std::uint32_t, 3>;
    ASSIGN_OR_RETURN(mesh.positions, array<F3>(from.positions(), field + ".positions"));
    ASSIGN_OR_RETURN(mesh.triangles, array<U3>(from.indices(), field + ".indices"));
    if (from.has_normals()) {
      ASSIGN_OR_RETURN(mesh.normals, array<F3>(from.normals(), field + ".normals"));
    }
    if (from.has_uvs()) {
      ASSIGN_OR_RETURN(mesh.uvs, array<F2>(from.uvs(), field + ".uvs"));
    }
    if (from.has_uvs2()) {
      ASSIGN_OR_RETURN(mesh.uvs2, array<F2>(from.uvs2(), field + ".uvs2"));
    }
    if (from.has_colors()) {
      ASSIGN_OR_RETURN(mesh.colors, array<F3>(from.colors(), field + ".colors"));
    }
    return mesh;
  }

  // Appends: g++ 12 takes a StatusOr of this variant for uninitialised.
  absl::Status texture(const package::Texture& from, const std::string& field,
                       std::vector<Texture>& textures) {
    RETURN_IF_ERROR(decode_texture(from, field, textures));
    if (auto* image = std::get_if<ImageTexture>(&textures.back())) {
      ASSIGN_OR_RETURN(image->texels, bytes(from.image().texels(), field + ".image.texels"));
    }
    return absl::OkStatus();
  }

 private:
  BlobSource& blobs_;
};

absl::StatusOr<Instance> decode_instance(const package::Instance& from, const std::string& field) {
  if (from.transform_size() != 12) {
    return manifest_error(field + ".transform",
                          absl::StrCat("must have 12 numbers, has ", from.transform_size()));
  }
  Instance instance{MeshId{from.mesh()}, MaterialId{from.material()}, {}};
  for (int i = 0; i < 12; ++i) {
    instance.to_world.m[i / 4][i % 4] = from.transform(i);
  }
  return instance;
}

absl::StatusOr<Geometry> decode_geometry(const package::Manifest& manifest, Decoder& decoder) {
  Geometry geometry;
  if (manifest.has_spheres()) {
    ASSIGN_OR_RETURN(geometry.spheres, decoder.spheres(manifest.spheres()));
  }
  if (manifest.has_quads()) {
    ASSIGN_OR_RETURN(geometry.quads, decoder.quads(manifest.quads()));
  }
  if (manifest.has_triangles()) {
    ASSIGN_OR_RETURN(geometry.triangles, decoder.triangles(manifest.triangles()));
  }
  for (int i = 0; i < manifest.mesh_size(); ++i) {
    ASSIGN_OR_RETURN(Mesh mesh, decoder.mesh(manifest.mesh(i), absl::StrCat("mesh[", i, "]")));
    geometry.meshes.push_back(std::move(mesh));
  }
  for (int i = 0; i < manifest.instance_size(); ++i) {
    ASSIGN_OR_RETURN(const Instance instance,
                     decode_instance(manifest.instance(i), absl::StrCat("instance[", i, "]")));
    geometry.instances.push_back(instance);
  }
  return geometry;
}

}  // namespace

absl::StatusOr<SceneDescription> decode_package(const std::string& manifest_bytes,
                                                BlobSource& blobs) {
  // The bounds on the blobs together, before any of them is read.
  RETURN_IF_ERROR(package_blobs(manifest_bytes).status());
  ASSIGN_OR_RETURN(const package::Manifest manifest, parse_manifest(manifest_bytes));
  Decoder decoder(blobs);
  SceneDescription scene;
  ASSIGN_OR_RETURN(scene.camera, decode_camera(manifest));
  ASSIGN_OR_RETURN(scene.filter, decode_filter(manifest));
  ASSIGN_OR_RETURN(scene.local_shading, decode_local_shading(manifest));
  ASSIGN_OR_RETURN(scene.background, decode_background(manifest));
  for (int i = 0; i < manifest.texture_size(); ++i) {
    RETURN_IF_ERROR(
        decoder.texture(manifest.texture(i), absl::StrCat("texture[", i, "]"), scene.textures));
  }
  for (int i = 0; i < manifest.material_size(); ++i) {
    ASSIGN_OR_RETURN(const Material material,
                     decode_material(manifest.material(i), absl::StrCat("material[", i, "]")));
    scene.materials.push_back(material);
  }
  ASSIGN_OR_RETURN(scene.geometry, decode_geometry(manifest, decoder));
  RETURN_IF_ERROR(check_description(scene));
  return scene;
}

}  // namespace bandsaw
