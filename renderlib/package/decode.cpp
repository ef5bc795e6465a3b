#include "renderlib/package/package.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/package/arrays.h"
#include "renderlib/package/decode_surface.h"
#include "renderlib/package/decode_texture.h"
#include "renderlib/package/lights.h"
#include "renderlib/package/manifest.h"
#include "renderlib/package/media.h"
#include "renderlib/package/placements.h"
#include "renderlib/scene/validate.h"

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

  absl::StatusOr<std::vector<Sphere>> spheres(const package::Spheres& from,
                                              const std::string& field) {
    ASSIGN_OR_RETURN(const auto centers, array<Vec3>(from.centers(), field + ".centers"));
    const std::size_t count = centers.size();
    ASSIGN_OR_RETURN(const auto radii, array_of<double>(count, from.radii(), field + ".radii"));
    ASSIGN_OR_RETURN(const auto materials,
                     array_of<MaterialId>(count, from.material(), field + ".material"));
    std::vector<Sphere> spheres(count);
    for (std::size_t i = 0; i < count; ++i) {
      spheres[i] = {centers[i], radii[i], materials[i]};
    }
    return spheres;
  }

  absl::StatusOr<std::vector<Quad>> quads(const package::Quads& from, const std::string& field) {
    ASSIGN_OR_RETURN(const auto corners, array<Vec3>(from.corners(), field + ".corners"));
    const std::size_t count = corners.size();
    ASSIGN_OR_RETURN(const auto us, array_of<Vec3>(count, from.u(), field + ".u"));
    ASSIGN_OR_RETURN(const auto vs, array_of<Vec3>(count, from.v(), field + ".v"));
    ASSIGN_OR_RETURN(const auto materials,
                     array_of<MaterialId>(count, from.material(), field + ".material"));
    std::vector<Quad> quads(count);
    for (std::size_t i = 0; i < count; ++i) {
      quads[i] = {corners[i], us[i], vs[i], materials[i]};
    }
    return quads;
  }

  absl::StatusOr<std::vector<Triangle>> triangles(const package::Triangles& from,
                                                  const std::string& field) {
    using Corners = std::array<Vec3, 3>;
    ASSIGN_OR_RETURN(const auto corners, array<Corners>(from.vertices(), field + ".vertices"));
    ASSIGN_OR_RETURN(const auto materials,
                     array_of<MaterialId>(corners.size(), from.material(), field + ".material"));
    std::vector<Triangle> triangles(corners.size());
    for (std::size_t i = 0; i < corners.size(); ++i) {
      triangles[i] = {corners[i][0], corners[i][1], corners[i][2], materials[i]};
    }
    return triangles;
  }

  absl::StatusOr<std::vector<Disk>> disks(const package::Disks& from, const std::string& field) {
    ASSIGN_OR_RETURN(const auto centers, array<Vec3>(from.centers(), field + ".centers"));
    const std::size_t count = centers.size();
    ASSIGN_OR_RETURN(const auto normals, array_of<Vec3>(count, from.normals(), field + ".normals"));
    ASSIGN_OR_RETURN(const auto radii, array_of<double>(count, from.radii(), field + ".radii"));
    ASSIGN_OR_RETURN(const auto materials,
                     array_of<MaterialId>(count, from.material(), field + ".material"));
    std::vector<Disk> disks(count);
    for (std::size_t i = 0; i < count; ++i) {
      disks[i] = {centers[i], normals[i], radii[i], materials[i]};
    }
    return disks;
  }

  // Those of the manifest or of a group.
  template <class Message>
  absl::Status shapes(const Message& from, const std::string& prefix, Shapes& to) {
    if (from.has_spheres()) {
      ASSIGN_OR_RETURN(to.spheres, spheres(from.spheres(), prefix + "spheres"));
    }
    if (from.has_quads()) {
      ASSIGN_OR_RETURN(to.quads, quads(from.quads(), prefix + "quads"));
    }
    if (from.has_triangles()) {
      ASSIGN_OR_RETURN(to.triangles, triangles(from.triangles(), prefix + "triangles"));
    }
    if (from.has_disks()) {
      ASSIGN_OR_RETURN(to.disks, disks(from.disks(), prefix + "disks"));
    }
    return absl::OkStatus();
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

absl::StatusOr<Geometry> decode_geometry(const package::Manifest& manifest, Decoder& decoder) {
  Geometry geometry;
  RETURN_IF_ERROR(decoder.shapes(manifest, "", geometry));
  for (int i = 0; i < manifest.mesh_size(); ++i) {
    ASSIGN_OR_RETURN(Mesh mesh, decoder.mesh(manifest.mesh(i), absl::StrCat("mesh[", i, "]")));
    geometry.meshes.push_back(std::move(mesh));
  }
  for (int i = 0; i < manifest.group_size(); ++i) {
    Shapes& group = geometry.groups.emplace_back();
    RETURN_IF_ERROR(decoder.shapes(manifest.group(i), absl::StrCat("group[", i, "]."), group));
  }
  RETURN_IF_ERROR(decode_placements(manifest.frame(), manifest.instance(), "", geometry));
  return geometry;
}

absl::StatusOr<Media> media_with_boundaries(const package::Manifest& manifest, Decoder& decoder) {
  ASSIGN_OR_RETURN(Media media, decode_media(manifest));
  const package::Boundaries& from = manifest.boundaries();
  if (from.has_spheres()) {
    ASSIGN_OR_RETURN(media.boundaries.spheres,
                     decoder.spheres(from.spheres(), "boundaries.spheres"));
  }
  for (int i = 0; i < from.mesh_size(); ++i) {
    ASSIGN_OR_RETURN(Mesh mesh,
                     decoder.mesh(from.mesh(i), absl::StrCat("boundaries.mesh[", i, "]")));
    media.boundaries.meshes.push_back(std::move(mesh));
  }
  for (int i = 0; i < from.group_size(); ++i) {
    Shapes& group = media.boundaries.groups.emplace_back();
    RETURN_IF_ERROR(
        decoder.shapes(from.group(i), absl::StrCat("boundaries.group[", i, "]."), group));
  }
  return media;
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
  ASSIGN_OR_RETURN(scene.lights, decode_lights(manifest));
  ASSIGN_OR_RETURN(scene.media, media_with_boundaries(manifest, decoder));
  if (const absl::Status valid = validate(scene, MeshVertices::kFinite); !valid.ok()) {
    return absl::InvalidArgumentError(absl::StrCat("scene package: ", valid.message()));
  }
  return scene;
}

}  // namespace bandsaw
