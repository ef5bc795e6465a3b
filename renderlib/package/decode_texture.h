#pragma once

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "proto/package.pb.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {

/// Appends the texture that `from` describes, without its texels. Form only: check_materials judges
/// the values. INVALID_ARGUMENT: of no kind, an enum out of range, a list of the wrong length.
absl::Status decode_texture(const package::Texture& from, const std::string& field,
                            std::vector<Texture>& textures);

}  // namespace bandsaw
