// Decoder fetches the blobs (flat arrays) that the manifest of a scene package names, checks their
// sizes, and makes shapes, meshes and textures of them. If an earlier package has an equal part
// that is still in use, the part is taken from DecodedParts.

#include "renderlib/package/package.h"

#include <algorithm>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "proto/package.pb.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/package/arrays.h"
#include "renderlib/package/decode_enum.h"
#include "renderlib/package/decode_surface.h"
#include "renderlib/package/lights.h"
#include "renderlib/package/manifest.h"
#include "renderlib/package/materials.h"
#include "renderlib/package/media.h"
#include "renderlib/package/placements.h"
#include "renderlib/scene/validate.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {
namespace {

// In the calls of decode_enum(), the number after the value is the first valid value of the
// protocol's enum: 0, or 1 if 0 means "unspecified".

absl::StatusOr<UvSet> uv_set(int value, const std::string& field) {
  return decode_enum<UvSet>(value, 0, package::UvSet_MAX, field + ".uv_set");
}

absl::StatusOr<Space> space(int value, const std::string& field) {
  return decode_enum<Space>(value, 0, package::Space_MAX, field + ".space");
}

absl::StatusOr<Vec3> vec3(const google::protobuf::RepeatedField<double>& list,
                          const std::string& field) {
  if (list.size() != 3) {
    return manifest_error(field, absl::StrCat("must have 3 numbers, has ", list.size()));
  }
  return Vec3{list[0], list[1], list[2]};
}

// image(), checker(), noise() and ramp() decode one kind of texture each.

absl::StatusOr<ImageTexture> image(const package::ImageTexture& from, const std::string& field) {
  using Proto = package::ImageTexture;
  using Ours = ImageTexture;
  ImageTexture to;
  to.width = from.width();
  to.height = from.height();
  ASSIGN_OR_RETURN(
      to.format, decode_enum<Ours::Format>(from.format(), 1, Proto::Format_MAX, field + ".format"));
  ASSIGN_OR_RETURN(to.wrap,
                   decode_enum<Ours::Wrap>(from.wrap(), 1, Proto::Wrap_MAX, field + ".wrap"));
  if (from.wrap_v() != Proto::WRAP_UNSPECIFIED) {
    ASSIGN_OR_RETURN(to.wrap_v,
                     decode_enum<Ours::Wrap>(from.wrap_v(), 1, Proto::Wrap_MAX, field + ".wrap_v"));
  }
  ASSIGN_OR_RETURN(
      to.filter, decode_enum<Ours::Filter>(from.filter(), 1, Proto::Filter_MAX, field + ".filter"));
  if (from.channels() > 3 || from.channels() == 2) {
    return manifest_error(field + ".channels",
                          absl::StrCat("must be 0, 1 or 3, is ", from.channels()));
  }
  to.channels = from.channels() == 1 ? 1 : 3;
  ASSIGN_OR_RETURN(to.uv_set, uv_set(from.uv_set(), field));
  if (from.uv_transform_size() != 0 && from.uv_transform_size() != 6) {
    return manifest_error(field + ".uv_transform",
                          absl::StrCat("must have 0 or 6 numbers, has ", from.uv_transform_size()));
  }
  std::copy(from.uv_transform().begin(), from.uv_transform().end(), to.uv_transform.m.begin());
  return to;
}

absl::StatusOr<CheckerTexture> checker(const package::CheckerTexture& from,
                                       const std::string& field) {
  CheckerTexture to;
  to.even = TextureId{from.even()};
  to.odd = TextureId{from.odd()};
  ASSIGN_OR_RETURN(
      to.mapping, decode_enum<CheckerTexture::Mapping>(
                      from.mapping(), 0, package::CheckerTexture::Mapping_MAX, field + ".mapping"));
  ASSIGN_OR_RETURN(to.size, vec3(from.size(), field + ".size"));
  ASSIGN_OR_RETURN(to.uv_set, uv_set(from.uv_set(), field));
  ASSIGN_OR_RETURN(to.space, space(from.space(), field));
  return to;
}

absl::StatusOr<NoiseTexture> noise(const package::NoiseTexture& from, const std::string& field) {
  NoiseTexture to;
  ASSIGN_OR_RETURN(to.kind, decode_enum<NoiseTexture::Kind>(
                                from.kind(), 0, package::NoiseTexture::Kind_MAX, field + ".kind"));
  ASSIGN_OR_RETURN(to.space, space(from.space(), field));
  to.octaves = from.octaves();
  to.scale = from.scale();
  to.strength = from.strength();
  to.turbulence_scale = from.turbulence_scale();
  ASSIGN_OR_RETURN(to.axis, vec3(from.axis(), field + ".axis"));
  ASSIGN_OR_RETURN(to.low, decode_rgb(from.low().rgb(), field + ".low"));
  ASSIGN_OR_RETURN(to.high, decode_rgb(from.high().rgb(), field + ".high"));
  return to;
}

absl::StatusOr<RampTexture> ramp(const package::RampTexture& from, const std::string& field) {
  RampTexture to;
  ASSIGN_OR_RETURN(to.over, decode_enum<RampTexture::Over>(
                                from.over(), 0, package::RampTexture::Over_MAX, field + ".over"));
  to.texture = TextureId{from.texture()};
  ASSIGN_OR_RETURN(to.uv_set, uv_set(from.uv_set(), field));
  ASSIGN_OR_RETURN(to.space, space(from.space(), field));
  to.steps = from.steps();
  if (from.color_size() != 3 * from.at_size()) {
    return manifest_error(field + ".color",
                          absl::StrCat("must have 3 numbers for each stop, has ", from.color_size(),
                                       " for ", from.at_size(), " stops"));
  }
  for (int i = 0; i < from.at_size(); ++i) {
    to.stops.push_back(
        {from.at(i), {from.color(3 * i), from.color(3 * i + 1), from.color(3 * i + 2)}});
  }
  return to;
}

// Appends `texture`, the result of one of the functions above, to `textures`, or returns its error.
template <class T>
absl::Status append(absl::StatusOr<T> texture, std::vector<Texture>& textures) {
  RETURN_IF_ERROR(texture.status());
  textures.emplace_back(*std::move(texture));
  return absl::OkStatus();
}

/// Appends the texture that `from` describes, without its texels. Checks only the form, not the
/// values (scene/validate.h). Returns INVALID_ARGUMENT for an unknown kind, an enum out of range,
/// or a list of a wrong length.
absl::Status decode_texture(const package::Texture& from, const std::string& field,
                            std::vector<Texture>& textures) {
  switch (from.kind_case()) {
    case package::Texture::kConstant: {
      ASSIGN_OR_RETURN(const Rgb value, decode_rgb(from.constant().rgb(), field + ".constant.rgb"));
      textures.emplace_back(ConstantTexture{value});
      return absl::OkStatus();
    }
    case package::Texture::kImage:
      return append(image(from.image(), field + ".image"), textures);
    case package::Texture::kChecker:
      return append(checker(from.checker(), field + ".checker"), textures);
    case package::Texture::kNoise:
      return append(noise(from.noise(), field + ".noise"), textures);
    case package::Texture::kRamp:
      return append(ramp(from.ramp(), field + ".ramp"), textures);
    case package::Texture::kMix:
      textures.emplace_back(MixTexture{TextureId{from.mix().a()}, TextureId{from.mix().b()},
                                       TextureId{from.mix().amount()}});
      return absl::OkStatus();
    case package::Texture::kProduct:
      textures.emplace_back(
          ProductTexture{TextureId{from.product().a()}, TextureId{from.product().b()}});
      return absl::OkStatus();
    case package::Texture::KIND_NOT_SET:
      break;
  }
  return manifest_error(field, "is of no kind that this program knows");
}

/// Reads the parts of one package. For error messages, `field` is the name of the decoded field,
/// and `prefix` the beginning of such names.
class Decoder {
 public:
  Decoder(BlobSource& blobs, DecodedParts* parts) : blobs_(blobs), parts_(parts) {}

  // Returns the whole blob without copying it: a mapped file stays mapped. Returns INVALID_ARGUMENT
  // if the size of the blob is not that in the manifest.
  absl::StatusOr<SharedBytes> bytes(const package::Blob& blob, const std::string& field) {
    ASSIGN_OR_RETURN(const BlobRef ref, blob_ref(blob, field));
    ASSIGN_OR_RETURN(std::shared_ptr<const BlobBytes> held, blob_of(ref.digest));
    const absl::Span<const std::byte> bytes = held->bytes();
    if (bytes.size() != ref.size) {
      return manifest_error(field + ".size", absl::StrCat("is ", ref.size, ", the blob has ",
                                                          bytes.size(), " bytes"));
    }
    return SharedBytes(std::move(held), bytes);
  }

  // Returns the whole blob as an array of T.
  template <class T>
  absl::StatusOr<std::vector<T>> array(const package::Blob& blob, const std::string& field) {
    if (blob.size() % sizeof(T) != 0) {
      return manifest_error(field + ".size", absl::StrCat("must be a multiple of ", sizeof(T),
                                                          " bytes, is ", blob.size()));
    }
    ASSIGN_OR_RETURN(const SharedBytes whole, bytes(blob, field));
    return from_bytes<T>(whole.span());
  }

  // Returns the whole blob as an array of T, which must have one entry for each of `count` shapes.
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

  // Decodes the shapes of the manifest or of a group.
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

  // Adds the mesh to the list. If an earlier package had the same message, its mesh is shared.
  absl::Status add_mesh(const package::Mesh& from, const std::string& field, MeshList& to) {
    const std::string message = parts_ != nullptr ? from.SerializeAsString() : "";
    if (std::shared_ptr<const Mesh> known = parts_ != nullptr ? parts_->mesh(message) : nullptr) {
      // A mesh that occurs twice in this package is known too, but it is not validated yet.
      if (own_.find(known.get()) == own_.end()) {
        shared_.insert(known.get());
      }
      to.share(std::move(known));
      return absl::OkStatus();
    }
    ASSIGN_OR_RETURN(Mesh decoded, mesh(from, field));
    to.push_back(std::move(decoded));
    own_.insert(&to.back());
    if (parts_ != nullptr) {
      parts_->add(message, to.shared(to.size() - 1));
    }
    return absl::OkStatus();
  }

  // Returns true if the mesh was read for an earlier package, and so was validated with it.
  bool is_shared(const Mesh& mesh) const { return shared_.find(&mesh) != shared_.end(); }

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
    if (from.has_positions_at_close()) {
      ASSIGN_OR_RETURN(mesh.positions_at_close,
                       array<F3>(from.positions_at_close(), field + ".positions_at_close"));
    }
    if (from.has_normals_at_close()) {
      ASSIGN_OR_RETURN(mesh.normals_at_close,
                       array<F3>(from.normals_at_close(), field + ".normals_at_close"));
    }
    return mesh;
  }

  // Decodes a texture with its texels and appends it to `textures`. The texture is not returned,
  // because a StatusOr of this variant makes g++ 12 warn of uninitialised memory.
  absl::Status texture(const package::Texture& from, const std::string& field,
                       std::vector<Texture>& textures) {
    RETURN_IF_ERROR(decode_texture(from, field, textures));
    if (auto* image = std::get_if<ImageTexture>(&textures.back())) {
      ASSIGN_OR_RETURN(image->texels, bytes(from.image().texels(), field + ".image.texels"));
    }
    return absl::OkStatus();
  }

 private:
  // Returns the blob with this digest, and remembers it in `parts_`. If `parts_` has the blob from
  // an earlier package, it is not fetched again.
  absl::StatusOr<std::shared_ptr<const BlobBytes>> blob_of(const wire::Digest& digest) {
    if (parts_ != nullptr) {
      if (std::shared_ptr<const BlobBytes> known = parts_->blob(digest)) {
        return known;
      }
    }
    ASSIGN_OR_RETURN(std::shared_ptr<const BlobBytes> blob, blobs_.get(digest));
    if (parts_ != nullptr) {
      parts_->add(digest, blob);
    }
    return blob;
  }

  BlobSource& blobs_;
  DecodedParts* const parts_;     ///< nullptr: none
  std::set<const Mesh*> own_;     ///< meshes that were read for this package
  std::set<const Mesh*> shared_;  ///< meshes of other packages
};

/// Returns the shapes, meshes, groups and instances of the manifest.
absl::StatusOr<Geometry> decode_geometry(const package::Manifest& manifest, Decoder& decoder) {
  Geometry geometry;
  RETURN_IF_ERROR(decoder.shapes(manifest, "", geometry));
  for (int i = 0; i < manifest.mesh_size(); ++i) {
    RETURN_IF_ERROR(
        decoder.add_mesh(manifest.mesh(i), absl::StrCat("mesh[", i, "]"), geometry.meshes));
  }
  for (int i = 0; i < manifest.group_size(); ++i) {
    Shapes& group = geometry.groups.emplace_back();
    RETURN_IF_ERROR(decoder.shapes(manifest.group(i), absl::StrCat("group[", i, "]."), group));
  }
  RETURN_IF_ERROR(decode_placements(manifest.frame(), manifest.instance(), "", geometry));
  return geometry;
}

/// Returns the media of the manifest, with the bytes of their grids and with the shapes that bound
/// the media.
absl::StatusOr<Media> media_with_boundaries(const package::Manifest& manifest, Decoder& decoder) {
  ASSIGN_OR_RETURN(Media media, decode_media(manifest));
  for (int i = 0; i < manifest.grid_size(); ++i) {
    VolumeGrid& grid = media.grids[static_cast<std::size_t>(i)];
    const std::string field = absl::StrCat("grid[", i, "]");
    ASSIGN_OR_RETURN(grid.index, decoder.bytes(manifest.grid(i).index(), field + ".index"));
    ASSIGN_OR_RETURN(grid.values, decoder.bytes(manifest.grid(i).values(), field + ".values"));
  }
  const package::Boundaries& from = manifest.boundaries();
  if (from.has_spheres()) {
    ASSIGN_OR_RETURN(media.boundaries.spheres,
                     decoder.spheres(from.spheres(), "boundaries.spheres"));
  }
  for (int i = 0; i < from.mesh_size(); ++i) {
    RETURN_IF_ERROR(decoder.add_mesh(from.mesh(i), absl::StrCat("boundaries.mesh[", i, "]"),
                                     media.boundaries.meshes));
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
                                                BlobSource& blobs, DecodedParts* parts) {
  // Checks the limits on all blobs together before any of them is read.
  RETURN_IF_ERROR(package_blobs(manifest_bytes).status());
  ASSIGN_OR_RETURN(const package::Manifest manifest, parse_manifest(manifest_bytes));
  Decoder decoder(blobs, parts);
  SceneDescription scene;
  if (!manifest.has_camera()) {
    return manifest_error("camera", "is missing");
  }
  ASSIGN_OR_RETURN(scene.camera, decode_camera(manifest.camera(), "camera"));
  if (manifest.has_camera_at_close()) {
    ASSIGN_OR_RETURN(scene.camera_at_close,
                     decode_camera(manifest.camera_at_close(), "camera_at_close"));
  }
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
  const auto is_checked = [&](const Mesh& mesh) { return decoder.is_shared(mesh); };
  if (const absl::Status valid = validate(scene, MeshVertices::kFinite, is_checked); !valid.ok()) {
    return absl::InvalidArgumentError(absl::StrCat("scene package: ", valid.message()));
  }
  return scene;
}

}  // namespace bandsaw
