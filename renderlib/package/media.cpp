#include "renderlib/package/media.h"

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/package/decode_surface.h"
#include "renderlib/package/manifest.h"

namespace bandsaw {
namespace {

void encode(const Rgb& color, package::Rgb& to) {
  for (const float channel : {color.r, color.g, color.b}) {
    to.add_rgb(channel);
  }
}

absl::StatusOr<Instance> decode_boundary(const package::Instance& from, const std::string& field) {
  if (from.transform_size() != 12) {
    return manifest_error(field + ".transform",
                          absl::StrCat("must have 12 numbers, has ", from.transform_size()));
  }
  if (from.has_group() || from.has_frame()) {
    return manifest_error(field, "must be a mesh that rests");
  }
  Instance instance;
  instance.mesh = MeshId{from.mesh()};
  instance.material = MaterialId{from.material()};
  for (int i = 0; i < 12; ++i) {
    instance.to_world.m[i / 4][i % 4] = from.transform(i);
  }
  return instance;
}

}  // namespace

void encode_media(const Media& media, package::Manifest& manifest) {
  for (const Medium& medium : media.media) {
    auto& to = *manifest.add_medium();
    encode(medium.absorption, *to.mutable_absorption());
    encode(medium.scattering, *to.mutable_scattering());
    encode(medium.emission, *to.mutable_emission());
    to.set_g(medium.g);
  }
  for (const Instance& instance : media.boundaries.instances) {
    auto& to = *manifest.mutable_boundaries()->add_instance();
    to.set_mesh(static_cast<std::uint32_t>(instance.mesh));
    to.set_material(static_cast<std::uint32_t>(instance.material));
    for (const auto& row : instance.to_world.m) {
      to.mutable_transform()->Add(row.begin(), row.end());
    }
  }
  if (media.fog) {
    manifest.set_fog(static_cast<std::uint32_t>(*media.fog));
  }
}

absl::StatusOr<Media> decode_media(const package::Manifest& manifest) {
  Media media;
  for (int i = 0; i < manifest.medium_size(); ++i) {
    const package::Medium& from = manifest.medium(i);
    const std::string field = absl::StrCat("medium[", i, "]");
    Medium medium;
    ASSIGN_OR_RETURN(medium.absorption,
                     decode_rgb(from.absorption().rgb(), field + ".absorption.rgb"));
    ASSIGN_OR_RETURN(medium.scattering,
                     decode_rgb(from.scattering().rgb(), field + ".scattering.rgb"));
    ASSIGN_OR_RETURN(medium.emission, decode_rgb(from.emission().rgb(), field + ".emission.rgb"));
    medium.g = from.g();
    media.media.push_back(medium);
  }
  for (int i = 0; i < manifest.boundaries().instance_size(); ++i) {
    ASSIGN_OR_RETURN(const Instance instance,
                     decode_boundary(manifest.boundaries().instance(i),
                                     absl::StrCat("boundaries.instance[", i, "]")));
    media.boundaries.instances.push_back(instance);
  }
  if (manifest.has_fog()) {
    media.fog = MediumId{manifest.fog()};
  }
  return media;
}

}  // namespace bandsaw
