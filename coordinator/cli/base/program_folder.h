#pragma once

// Locates this program and the files that are installed with it.

#include <string>

namespace bandsaw::coordinator {

/// Returns the folder of the running program, with symbolic links resolved. It also contains
/// bandsaw-import and bandsaw-worker; the gallery is in ../share, workers of other architectures
/// are in ../lib.
std::string program_folder();

/// Returns the folder of the scenes that come with the program: share/bandsaw/gallery beside the
/// program's bin folder. A build folder has the same layout as an installation.
std::string gallery_folder();

/// Returns the folder of the WebAssembly renderer that `serve` hands out to browsers:
/// share/bandsaw/browser beside the program's bin folder.
std::string browser_folder();

}  // namespace bandsaw::coordinator
