#pragma once

// A ConvertedScene is a scene of another renderer in the form of a Bandsaw scene file. The
// converters of pbrt and Mitsuba scenes return it. The importer reads it as it reads a scene file;
// `bandsaw import` writes it to disk.

#include <map>
#include <string>
#include <vector>

#include "proto/scene.pb.h"

namespace bandsaw {

struct ConvertedScene {
  scene::Scene scene;
  /// Files that the scene names and that the converter made (meshes, images): name -> bytes. All
  /// other files that the scene names are below the folder of the original scene.
  std::map<std::string, std::string> made_files;
  /// Features without a counterpart and their substitutes, each with its place in the source:
  /// "kitchen.pbrt:17: texture \"windy\" is shown as its mean colour".
  std::vector<std::string> warnings;
};

}  // namespace bandsaw
