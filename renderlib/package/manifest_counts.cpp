#include "renderlib/package/manifest_counts.h"

#include <array>
#include <cstdint>
#include <string>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/geometry/shapes.h"
#include "renderlib/scene/check_counts.h"

namespace bandsaw {
namespace {

/// How many entries of the type T a blob has.
template <class T>
std::uint64_t entries(const package::Blob& blob) {
  return blob.size() / sizeof(T);
}

/// The shapes of the manifest or of a group.
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

}  // namespace

absl::Status check_counts(const package::Manifest& manifest) {
  const absl::Status good = check_all(manifest);
  return good.ok() ? good
                   : absl::InvalidArgumentError(absl::StrCat("scene package: ", good.message()));
}

}  // namespace bandsaw
