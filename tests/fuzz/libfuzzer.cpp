// The entry point that libFuzzer calls with each input. It calls the target (fuzz.h) that is
// linked.

#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  bandsaw::fuzz::run({data, size});
  return 0;
}
