#pragma once

// Holds the state that all parts of the conversion of a Mitsuba scene share: the files that it may
// read, the files that it has made, and its warnings.

#include <string>
#include <vector>

#include "renderlib/import/convert/made_files.h"
#include "renderlib/import/mitsuba/files.h"
#include "renderlib/import/mitsuba/parameters.h"
#include "renderlib/import/mitsuba/scene_tree.h"

namespace bandsaw::mitsuba {

struct Conversion {
  const Files& files;
  MadeFiles& made;
  std::vector<std::string>& warnings;
  /// The integrator is "volpath" or "volpathmis", which do not count the passage through a thin
  /// pane towards max_depth. "path" does.
  bool passages_are_free = false;
  /// The scene is of version 0.x, some of whose defaults are not those of versions 2 and 3.
  bool is_old = false;

  /// Appends "scene.xml:12: <what>" to `warnings`, unless `warnings` contains this text already.
  void warn(const Place& place, const std::string& what);
  /// Warns of each of `parameters` that was not read.
  void warn_of_unused(const Parameters& parameters);
};

}  // namespace bandsaw::mitsuba
