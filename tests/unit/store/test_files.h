#pragma once

// Reads and writes whole files as strings, for tests that damage files.

#include <fstream>
#include <sstream>
#include <string>

#include "absl/types/span.h"

namespace bandsaw::coordinator {

inline std::string read_all(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

inline void write_all(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary | std::ios::trunc) << text;
}

/// Returns the bytes of `text`, which MUST outlive the result.
inline absl::Span<const std::byte> bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::byte*>(text.data()), text.size()};
}

}  // namespace bandsaw::coordinator
