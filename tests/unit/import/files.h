#pragma once

// Files for tests of the import: text files that a test writes, a small picture, and the models of
// Assimp's test suite.

#include <fstream>
#include <string>

#include "tests/support/temp_dir.h"

namespace bandsaw::test {

/// Writes a file, and returns its path.
inline std::string write_text(const TempDir& folder, const std::string& name,
                              const std::string& text) {
  std::ofstream(folder / name, std::ios::binary) << text;
  return folder / name;
}

/// A picture of 2 x 2 texels: red and green above blue and white.
inline std::string small_ppm() {
  return std::string("P6 2 2 255\n") + "\xff" + std::string(2, '\0') + std::string(1, '\0') +
         "\xff" + std::string(1, '\0') + std::string(2, '\0') + "\xff" + "\xff\xff\xff";
}

/// Returns the path of a model of the Debian package assimp-testmodels, which may be missing.
inline std::string test_model(const std::string& name) {
  return "/usr/share/assimp/models/" + name;
}
inline bool have_test_models() { return std::ifstream(test_model("OBJ/spider.obj")).good(); }

}  // namespace bandsaw::test
