#pragma once

// Reads options of textures from MTL files, because Assimp skips them.

#include <map>
#include <set>
#include <string>
#include <utility>

#include "absl/strings/string_view.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {

/// Options of the textures of a model.
struct MtlOptions {
  /// Scale and offset (-s, -o) of textures, keyed by the name of the material and the name of the
  /// image in the file. A texture that has neither is left out.
  std::map<std::pair<std::string, std::string>, UvTransform> transforms;
  std::set<std::string> ignored;  ///< options that are not supported, such as "-mm"
};

/// Adds the options in the text of an MTL file. If an option has too few numbers, the missing ones
/// are 1 for -s and 0 for -o. Lines that are not understood are skipped.
void add_mtl_options(absl::string_view text, MtlOptions& to);

}  // namespace bandsaw
