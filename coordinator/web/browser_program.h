#pragma once

// The renderer for browsers: a WebAssembly program that the page /join loads. `bandsaw serve` reads
// the program's files once, when the server starts.

#include <string>

#include "absl/status/statusor.h"

namespace bandsaw::coordinator {

/// Held in memory, so that `tag` always describes the bytes that are handed out, even if the files
/// change. It contains no secret.
struct BrowserProgram {
  std::string bytes;       ///< bandsaw.wasm; empty: it is not installed
  std::string compressed;  ///< bandsaw.wasm.br, `bytes` compressed by Brotli; empty: not installed
  std::string tag;         ///< SHA-256 of `bytes` in hexadecimal
};

/// Reads the files in the folder. NOT_FOUND: there is no bandsaw.wasm. Other errors: a file cannot
/// be read.
absl::StatusOr<BrowserProgram> load_browser_program(const std::string& folder);

}  // namespace bandsaw::coordinator
