#pragma once

// Reads the options of textures in MTL files that Assimp skips.

#include <map>
#include <set>
#include <string>
#include <utility>

#include "absl/strings/string_view.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {

struct MtlOptions {
  /// Scale and offset (-s, -o) of textures, keyed by the names of the material and of the image.
  std::map<std::pair<std::string, std::string>, UvTransform> transforms;
  std::set<std::string> ignored;  ///< options that have no effect, such as "-mm"
};

/// Adds the options of an MTL file. A number that is missing keeps its default.
void add_mtl_options(absl::string_view text, MtlOptions& to);

}  // namespace bandsaw
