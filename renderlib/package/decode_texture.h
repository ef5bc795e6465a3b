#pragma once

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "proto/package.pb.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {

/// Appends the texture that `from` describes, without its texels. Checks only the
/// form, not the values (scene/validate.h). Returns INVALID_ARGUMENT for an unknown kind, an enum
/// out of range, or a list of a wrong length.
absl::Status decode_texture(const package::Texture& from, const std::string& field,
                            std::vector<Texture>& textures);

}  // namespace bandsaw
