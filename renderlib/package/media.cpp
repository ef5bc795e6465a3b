#include "renderlib/package/media.h"

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/package/decode_surface.h"
#include "renderlib/package/placements.h"

namespace bandsaw {
namespace {

void encode(const Rgb& color, package::Rgb& to) {
  for (const float channel : {color.r, color.g, color.b}) {
    to.add_rgb(channel);
  }
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
  if (media.has_boundaries()) {
    encode_placements(media.boundaries, *manifest.mutable_boundaries()->mutable_frame(),
                      *manifest.mutable_boundaries()->mutable_instance());
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
  RETURN_IF_ERROR(decode_placements(manifest.boundaries().frame(), manifest.boundaries().instance(),
                                    "boundaries.", media.boundaries));
  if (manifest.has_fog()) {
    media.fog = MediumId{manifest.fog()};
  }
  return media;
}

}  // namespace bandsaw
