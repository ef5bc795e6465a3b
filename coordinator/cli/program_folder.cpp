#include "coordinator/cli/program_folder.h"

#include <filesystem>

namespace bandsaw::coordinator {

std::string program_folder() {
  std::error_code error;
  return std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
}

}  // namespace bandsaw::coordinator
