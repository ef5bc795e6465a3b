#pragma once

// Tables of the CIE in steps of 10 nm: the standard observer of 1931 (2 degrees) and the illuminant
// D65 (CIE 15:2004, tables T.4 and T.1). Values between the steps are interpolated linearly.

#include <cstddef>

namespace bandsaw::spectrum {

inline constexpr int kFirstNm = 380;
inline constexpr int kLastNm = 780;

/// Returns the colour matching function x, y or z (k = 0, 1, 2) at a wavelength in [kFirstNm,
/// kLastNm].
double observer(std::size_t k, int nm);
/// Returns the relative power of D65 at a wavelength in [kFirstNm, kLastNm]; 100 at 560 nm.
double daylight(int nm);

}  // namespace bandsaw::spectrum
