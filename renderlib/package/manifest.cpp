// A manifest describes a scene package and names the blobs, which are flat arrays, by their
// digests. This file checks the head of a manifest (its settings and texts), and the counts of
// shapes, which follow from the sizes of the blobs. for_each_blob() visits all blobs in a fixed
// order.

#include "renderlib/package/manifest.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <string>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "proto/package.pb.h"
#include "proto/wire/limits.h"
#include "proto/wire/versions.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/geometry/shapes.h"
#include "renderlib/package/limits.h"
#include "renderlib/render/settings.h"
#include "renderlib/scene/check_counts.h"

namespace bandsaw {
namespace {

/// Returns the number of entries of type T in a blob.
template <class T>
std::uint64_t entries(const package::Blob& blob) {
  return blob.size() / sizeof(T);
}

/// Returns how many shapes of each kind a group has, or a manifest has outside of its groups.
template <class Message>
ShapeCounts counts_of(const Message& from) {
  return {.spheres = entries<Vec3>(from.spheres().centers()),
          .quads = entries<Vec3>(from.quads().corners()),
          .triangles = entries<std::array<Vec3, 3>>(from.triangles().vertices()),
          .disks = entries<Vec3>(from.disks().centers())};
}

template <class Meshes>
absl::Status check_meshes(const std::string& prefix, const Meshes& meshes) {
  for (int i = 0; i < meshes.size(); ++i) {
    RETURN_IF_ERROR(check_mesh_counts(absl::StrCat(prefix, "mesh[", i, "]"),
                                      entries<std::array<std::uint32_t, 3>>(meshes[i].indices()),
                                      entries<std::array<float, 3>>(meshes[i].positions())));
  }
  return absl::OkStatus();
}

template <class Groups>
absl::Status check_groups(const std::string& prefix, const Groups& groups) {
  for (int i = 0; i < groups.size(); ++i) {
    RETURN_IF_ERROR(
        check_shape_counts(absl::StrCat(prefix, "group[", i, "]"), counts_of(groups[i])));
  }
  return absl::OkStatus();
}

/// Checks that no mesh, no group, and no list of shapes outside of groups has more shapes than a
/// BVH can hold. The messages lack the prefix "scene package: ".
absl::Status check_all(const package::Manifest& manifest) {
  ShapeCounts loose = counts_of(manifest);
  loose.instances = static_cast<std::uint64_t>(manifest.instance_size());
  RETURN_IF_ERROR(check_shape_counts("shapes", loose));
  RETURN_IF_ERROR(check_groups("", manifest.group()));
  RETURN_IF_ERROR(check_meshes("", manifest.mesh()));
  const package::Boundaries& boundaries = manifest.boundaries();
  const ShapeCounts spheres = {.spheres = entries<Vec3>(boundaries.spheres().centers()),
                               .instances = static_cast<std::uint64_t>(boundaries.instance_size())};
  RETURN_IF_ERROR(check_shape_counts("boundaries.shapes", spheres));
  RETURN_IF_ERROR(check_groups("boundaries.", boundaries.group()));
  return check_meshes("boundaries.", boundaries.mesh());
}

/// Returns INVALID_ARGUMENT if there are more shapes in a mesh, in a group, or outside of all
/// groups than a BVH can hold (scene/check_counts.h). The counts follow from the sizes of the
/// blobs, so no blob is read and no memory is allocated.
absl::Status check_counts(const package::Manifest& manifest) {
  const absl::Status good = check_all(manifest);
  return good.ok() ? good
                   : absl::InvalidArgumentError(absl::StrCat("scene package: ", good.message()));
}

absl::Status check_range(const std::string& field, std::uint64_t value, std::uint64_t most) {
  if (value >= 1 && value <= most) {
    return absl::OkStatus();
  }
  return manifest_error(field, absl::StrCat("must lie in [1, ", most, "], is ", value));
}

/// Checks that there are at most `most` texts, and that none has more than `most_bytes` bytes.
absl::Status check_texts(const std::string& field,
                         const google::protobuf::RepeatedPtrField<std::string>& texts,
                         std::size_t most, std::size_t most_bytes) {
  if (texts.size() > static_cast<int>(most)) {
    return manifest_error(field, absl::StrCat("has ", texts.size(), " entries, at most ", most));
  }
  for (const std::string& text : texts) {
    if (text.size() > most_bytes) {
      return manifest_error(field,
                            absl::StrCat("has ", text.size(), " bytes, at most ", most_bytes));
    }
  }
  return absl::OkStatus();
}

absl::Status check_head(const package::Manifest& manifest) {
  if (manifest.format() != wire::kPackageFormat) {
    return manifest_error("format", absl::StrCat("is ", manifest.format(), ", this program reads ",
                                                 wire::kPackageFormat));
  }
  if (manifest.name().size() > wire::kJobNameBytes) {
    return manifest_error("name", absl::StrCat("has ", manifest.name().size(), " bytes, at most ",
                                               wire::kJobNameBytes, " are allowed"));
  }
  RETURN_IF_ERROR(check_range("width", manifest.width(), kMaxSide));
  RETURN_IF_ERROR(check_range("height", manifest.height(), kMaxSide));
  const std::uint64_t pixels = std::uint64_t{manifest.width()} * manifest.height();
  RETURN_IF_ERROR(check_range("width x height", pixels, kMaxPixels));
  RETURN_IF_ERROR(check_range("max_depth", manifest.max_depth(), kMaxDepth));
  if (manifest.integrator() > static_cast<std::uint32_t>(kLastIntegrator)) {
    return manifest_error("integrator", absl::StrCat("must lie in [0, ", kLastIntegrator, "], is ",
                                                     manifest.integrator()));
  }
  if (!(std::abs(manifest.exposure()) <= kMaxExposure)) {
    return manifest_error("exposure", absl::StrCat("must lie in [-", kMaxExposure, ", ",
                                                   kMaxExposure, "], is ", manifest.exposure()));
  }
  if (manifest.tone() > static_cast<std::uint32_t>(kLastTone)) {
    return manifest_error("tone",
                          absl::StrCat("must lie in [0, ", kLastTone, "], is ", manifest.tone()));
  }
  RETURN_IF_ERROR(check_texts("warning", manifest.warning(), kMaxWarnings, kMaxWarningBytes));
  return check_texts("model_camera", manifest.model_camera(), kMaxCameraNames, kMaxCameraNameBytes);
}

template <class Visit>
absl::Status for_each_sphere_blob(const package::Spheres& spheres, const std::string& path,
                                  Visit& visit) {
  RETURN_IF_ERROR(visit(spheres.centers(), path + ".centers"));
  RETURN_IF_ERROR(visit(spheres.radii(), path + ".radii"));
  return visit(spheres.material(), path + ".material");
}

template <class Meshes, class Visit>
absl::Status for_each_mesh_blob(const Meshes& meshes, const std::string& name, Visit& visit) {
  for (int i = 0; i < meshes.size(); ++i) {
    const package::Mesh& mesh = meshes[i];
    const std::string path = absl::StrCat(name, "[", i, "].");
    RETURN_IF_ERROR(visit(mesh.positions(), path + "positions"));
    RETURN_IF_ERROR(visit(mesh.indices(), path + "indices"));
    if (mesh.has_normals()) {
      RETURN_IF_ERROR(visit(mesh.normals(), path + "normals"));
    }
    if (mesh.has_uvs()) {
      RETURN_IF_ERROR(visit(mesh.uvs(), path + "uvs"));
    }
    if (mesh.has_uvs2()) {
      RETURN_IF_ERROR(visit(mesh.uvs2(), path + "uvs2"));
    }
    if (mesh.has_colors()) {
      RETURN_IF_ERROR(visit(mesh.colors(), path + "colors"));
    }
    if (mesh.has_positions_at_close()) {
      RETURN_IF_ERROR(visit(mesh.positions_at_close(), path + "positions_at_close"));
    }
    if (mesh.has_normals_at_close()) {
      RETURN_IF_ERROR(visit(mesh.normals_at_close(), path + "normals_at_close"));
    }
  }
  return absl::OkStatus();
}

// Calls visit(blob, path of its field) for each blob of the shapes in a manifest or a group, until
// a call returns an error.
template <class Message, class Visit>
absl::Status for_each_shape_blob(const Message& m, const std::string& prefix, Visit& visit) {
  if (m.has_spheres()) {
    RETURN_IF_ERROR(for_each_sphere_blob(m.spheres(), prefix + "spheres", visit));
  }
  if (m.has_quads()) {
    RETURN_IF_ERROR(visit(m.quads().corners(), prefix + "quads.corners"));
    RETURN_IF_ERROR(visit(m.quads().u(), prefix + "quads.u"));
    RETURN_IF_ERROR(visit(m.quads().v(), prefix + "quads.v"));
    RETURN_IF_ERROR(visit(m.quads().material(), prefix + "quads.material"));
  }
  if (m.has_triangles()) {
    RETURN_IF_ERROR(visit(m.triangles().vertices(), prefix + "triangles.vertices"));
    RETURN_IF_ERROR(visit(m.triangles().material(), prefix + "triangles.material"));
  }
  if (m.has_disks()) {
    RETURN_IF_ERROR(visit(m.disks().centers(), prefix + "disks.centers"));
    RETURN_IF_ERROR(visit(m.disks().normals(), prefix + "disks.normals"));
    RETURN_IF_ERROR(visit(m.disks().radii(), prefix + "disks.radii"));
    RETURN_IF_ERROR(visit(m.disks().material(), prefix + "disks.material"));
  }
  return absl::OkStatus();
}

// Calls visit(blob, path of its field) for all blobs of a manifest, in a fixed order, until a call
// returns an error.
template <class Visit>
absl::Status for_each_blob(const package::Manifest& m, Visit visit) {
  for (int i = 0; i < m.texture_size(); ++i) {
    if (m.texture(i).has_image()) {
      RETURN_IF_ERROR(
          visit(m.texture(i).image().texels(), absl::StrCat("texture[", i, "].image.texels")));
    }
  }
  RETURN_IF_ERROR(for_each_shape_blob(m, "", visit));
  for (int i = 0; i < m.group_size(); ++i) {
    RETURN_IF_ERROR(for_each_shape_blob(m.group(i), absl::StrCat("group[", i, "]."), visit));
  }
  RETURN_IF_ERROR(for_each_mesh_blob(m.mesh(), "mesh", visit));
  for (int i = 0; i < m.boundaries().group_size(); ++i) {
    RETURN_IF_ERROR(for_each_shape_blob(m.boundaries().group(i),
                                        absl::StrCat("boundaries.group[", i, "]."), visit));
  }
  if (m.boundaries().has_spheres()) {
    RETURN_IF_ERROR(for_each_sphere_blob(m.boundaries().spheres(), "boundaries.spheres", visit));
  }
  RETURN_IF_ERROR(for_each_mesh_blob(m.boundaries().mesh(), "boundaries.mesh", visit));
  for (int i = 0; i < m.grid_size(); ++i) {
    RETURN_IF_ERROR(visit(m.grid(i).index(), absl::StrCat("grid[", i, "].index")));
    RETURN_IF_ERROR(visit(m.grid(i).values(), absl::StrCat("grid[", i, "].values")));
  }
  return absl::OkStatus();
}

}  // namespace

absl::Status manifest_error(const std::string& field, const std::string& what) {
  return absl::InvalidArgumentError(absl::StrCat("scene package: ", field, ": ", what));
}

absl::StatusOr<package::Manifest> parse_manifest(const std::string& bytes) {
  if (bytes.size() > wire::kManifestBytes) {
    return absl::InvalidArgumentError(absl::StrCat("scene package: the manifest has ", bytes.size(),
                                                   " bytes, at most ", wire::kManifestBytes,
                                                   " are allowed"));
  }
  package::Manifest manifest;
  if (!manifest.ParseFromString(bytes)) {
    return absl::InvalidArgumentError("scene package: the manifest is damaged: it cannot be read");
  }
  RETURN_IF_ERROR(check_head(manifest));
  RETURN_IF_ERROR(check_counts(manifest));
  return manifest;
}

absl::StatusOr<BlobRef> blob_ref(const package::Blob& blob, const std::string& field) {
  const auto digest = wire::digest_from_raw(blob.sha256());
  if (!digest.ok()) {
    return manifest_error(field + ".sha256", std::string(digest.status().message()));
  }
  if (blob.size() > wire::kBlobBytes) {
    return manifest_error(field + ".size", absl::StrCat("is ", blob.size(), " bytes, at most ",
                                                        wire::kBlobBytes, " are allowed"));
  }
  return BlobRef{*digest, blob.size()};
}

absl::StatusOr<PackageInfo> package_info(const std::string& manifest_bytes) {
  ASSIGN_OR_RETURN(const package::Manifest manifest, parse_manifest(manifest_bytes));
  PackageInfo info;
  info.name = manifest.name();
  info.width = manifest.width();
  info.height = manifest.height();
  info.max_depth = manifest.max_depth();
  info.integrator = static_cast<Integrator>(manifest.integrator());
  info.display = {manifest.exposure(), static_cast<Tone>(manifest.tone())};
  info.warnings.assign(manifest.warning().begin(), manifest.warning().end());
  info.model_cameras.assign(manifest.model_camera().begin(), manifest.model_camera().end());
  return info;
}

absl::StatusOr<std::vector<BlobRef>> package_blobs(const std::string& manifest_bytes) {
  ASSIGN_OR_RETURN(const package::Manifest manifest, parse_manifest(manifest_bytes));
  std::vector<BlobRef> blobs;
  std::map<wire::Digest, std::uint64_t> sizes;
  std::uint64_t total = 0;
  RETURN_IF_ERROR(for_each_blob(manifest, [&](const package::Blob& blob, const std::string& field) {
    auto ref = blob_ref(blob, field);
    if (!ref.ok()) {
      return ref.status();
    }
    // A blob counts each time it is named, because a reader may copy it each time.
    total += ref->size;
    if (total > wire::kPackageBytes) {
      return manifest_error(field, absl::StrCat("exceeds the limit of ", wire::kPackageBytes,
                                                " bytes for all blobs of a package"));
    }
    const auto [known, is_new] = sizes.try_emplace(ref->digest, ref->size);
    if (known->second != ref->size) {
      return manifest_error(field + ".size", absl::StrCat("is ", ref->size, ", elsewhere ",
                                                          known->second, " for the same digest"));
    }
    if (is_new) {
      blobs.push_back(*ref);
    }
    if (blobs.size() > wire::kBlobsPerPackage) {
      return manifest_error(
          field, absl::StrCat("is one blob more than the ", wire::kBlobsPerPackage, " allowed"));
    }
    return absl::OkStatus();
  }));
  return blobs;
}

absl::StatusOr<std::vector<BlobRef>> missing_blobs(const std::string& manifest_bytes,
                                                   const DecodedParts& parts) {
  ASSIGN_OR_RETURN(std::vector<BlobRef> blobs, package_blobs(manifest_bytes));
  ASSIGN_OR_RETURN(package::Manifest manifest, parse_manifest(manifest_bytes));
  const auto remove_known = [&](google::protobuf::RepeatedPtrField<package::Mesh>& meshes) {
    const auto known = std::remove_if(meshes.begin(), meshes.end(), [&](const auto& mesh) {
      return parts.mesh(mesh.SerializeAsString()) != nullptr;
    });
    meshes.erase(known, meshes.end());
  };
  // A mesh that `parts` has needs no blobs. Only the remaining meshes are searched for blobs.
  remove_known(*manifest.mutable_mesh());
  remove_known(*manifest.mutable_boundaries()->mutable_mesh());
  std::set<std::string> missing;
  RETURN_IF_ERROR(for_each_blob(manifest, [&](const package::Blob& blob, const std::string&) {
    missing.insert(blob.sha256());
    return absl::OkStatus();
  }));
  std::erase_if(blobs, [&](const BlobRef& blob) {
    return !missing.contains(blob.digest.raw()) || parts.blob(blob.digest) != nullptr;
  });
  return blobs;
}

}  // namespace bandsaw
