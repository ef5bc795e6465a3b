#pragma once

namespace bandsaw {

/// Whether this processor and its operating system run code that a compiler made for
/// -march=x86-64-v3 (Haswell, Zen and later): the features that the x86-64 psABI lists for
/// levels 2 and 3, and the saving of AVX registers. False on other architectures.
bool runs_x86_64_v3();

}  // namespace bandsaw
