#pragma once

#include "proto/package.pb.h"
#include "renderlib/package/blob_source.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {

/// Texels go into `blobs`, uncopied.
void encode_texture(const Texture& texture, BlobMap& blobs, package::Texture& to);

}  // namespace bandsaw
