// Adds 200 values of each elementary function to the hash of the canary, a small test render by
// which machines are compared (canary.cpp). So programs whose functions differ in one bit have
// different hashes. The arguments cover the usual range of each function.

#include "renderlib/math/elementary.h"
#include "renderlib/render/kernel_code.h"

namespace bandsaw {

void add_elementary_functions(Hash64& hash) {
  constexpr int kPoints = 200;
  for (int i = 0; i < kPoints; ++i) {
    const double x = (i + 0.5) / kPoints;
    const SinCos turns = sincos_turns(x * 3 - 1);
    const SinCos degrees = sincos_degrees(x * 1000 - 500);
    for (const double value :
         {turns.sin, turns.cos, degrees.sin, degrees.cos, tan_degrees(x * 178 - 89),
          bandsaw::atan2(x - 0.5, x * x - 0.2), bandsaw::asin(2 * x - 1), bandsaw::acos(2 * x - 1),
          bandsaw::exp(x * 80 - 40), bandsaw::expm1(x * 4 - 2), bandsaw::log(x * 1000),
          bandsaw::log1p(x * 4 - 0.9), bandsaw::pow(x * 3, 2.4)}) {
      hash.add(value);
    }
  }
}

}  // namespace bandsaw
