// Finds the installation from the path of the running program: PREFIX/bin/bandsaw.

#include "coordinator/cli/base/program_folder.h"

#include <filesystem>

namespace bandsaw::coordinator {

std::string program_folder() {
  std::error_code error;
  return std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
}

std::string gallery_folder() {
  return std::filesystem::path(program_folder()).parent_path() / "share/bandsaw/gallery";
}

std::string browser_folder() {
  return std::filesystem::path(program_folder()).parent_path() / "share/bandsaw/browser";
}

}  // namespace bandsaw::coordinator
