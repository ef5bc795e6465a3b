#pragma once

namespace bandsaw {

/// Returns true if this processor and its operating system can run code compiled for
/// -march=x86-64-v3 (Haswell, Zen and later). The processor must have the features that the x86-64
/// psABI lists for levels 2 and 3, and the operating system must save the AVX registers. Returns
/// false on other architectures.
bool runs_x86_64_v3();

}  // namespace bandsaw
