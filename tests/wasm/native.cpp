// Prints the canary (the hash of a small image that every program renders) and the hash of fused
// operations (fused_hash.h). bandsaw_test.wasm must compute the same values.

#include <cstdio>

#include "renderlib/render/canary.h"
#include "tests/wasm/fused_hash.h"

int main() {
  std::printf("%016llx %016llx\n", static_cast<unsigned long long>(bandsaw::canary()),
              static_cast<unsigned long long>(bandsaw::test::fused_hash()));
}
