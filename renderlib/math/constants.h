#pragma once

// Mathematical constants in double.

namespace bandsaw {

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kInvPi = 0.31830988618379067154;
inline constexpr double kInfinity = __builtin_huge_val();
/// The largest double below 1.
inline constexpr double kOneMinusEpsilon = 0x1.fffffffffffffp-1;

}  // namespace bandsaw
