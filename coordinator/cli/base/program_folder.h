#pragma once

// Where this program lies, and with it the others.

#include <string>

namespace bandsaw::coordinator {

/// The folder of the program that runs, links resolved: beside it lie bandsaw-import and
/// bandsaw-worker, the gallery in ../share, workers of other architectures in ../lib.
std::string program_folder();

/// Returns the folder of the scenes that come with the program: share/bandsaw/gallery beside the
/// program's bin folder, both installed and in a build folder.
std::string gallery_folder();

}  // namespace bandsaw::coordinator
