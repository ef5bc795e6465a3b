// Reads bandsaw.wasm, and bandsaw.wasm.br if that file exists (the same program compressed by
// Brotli).

#include "coordinator/web/browser_program.h"

#include "proto/wire/digest.h"
#include "renderlib/base/file.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

constexpr std::size_t kMaxProgramBytes = 256 << 20;  // the module has about 1 MB

}  // namespace

absl::StatusOr<BrowserProgram> load_browser_program(const std::string& folder) {
  BrowserProgram program;
  ASSIGN_OR_RETURN(program.bytes, read_whole_file(folder + "/bandsaw.wasm", kMaxProgramBytes));
  auto compressed = read_whole_file(folder + "/bandsaw.wasm.br", kMaxProgramBytes);
  if (compressed.ok()) {
    program.compressed = *std::move(compressed);
  } else if (!absl::IsNotFound(compressed.status())) {
    return compressed.status();
  }
  program.tag = wire::sha256(program.bytes).hex();
  return program;
}

}  // namespace bandsaw::coordinator
