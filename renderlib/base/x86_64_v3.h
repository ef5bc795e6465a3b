#pragma once

namespace bandsaw {

/// Returns true if this processor and its operating system can run code compiled for
/// -march=x86-64-v3 (Haswell, Zen and later): they have the features that the x86-64 psABI lists
/// for levels 2 and 3, and save AVX registers. False on other architectures.
bool runs_x86_64_v3();

}  // namespace bandsaw
