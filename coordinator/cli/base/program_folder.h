#pragma once

// Where this program lies, and with it the others.

#include <string>

namespace bandsaw::coordinator {

/// The folder of the program that runs, links resolved: beside it lie bandsaw-import and
/// bandsaw-worker, the gallery in ../share, workers of other architectures in ../lib.
std::string program_folder();

/// Of the scenes that come with it, installed or in a build folder: bin beside share.
std::string gallery_folder();

}  // namespace bandsaw::coordinator
