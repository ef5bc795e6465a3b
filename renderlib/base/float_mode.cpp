// Reads the control register of the floating-point unit: MXCSR on x86-64, FPCR on ARM64.

#include "renderlib/base/float_mode.h"

#include <cstdint>
#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace bandsaw {

bool float_mode_is_default() {
#if defined(__x86_64__)
  constexpr unsigned kFlags = 0x3f;      // status flags, which do not affect rounding
  constexpr unsigned kDefault = 0x1f80;  // exceptions masked, round to nearest, denormals kept
  return (_mm_getcsr() & ~kFlags) == kDefault;
#elif defined(__aarch64__)
  std::uint64_t fpcr = 0;  // Arm Architecture Reference Manual, FPCR: no bit is set by default
  asm volatile("mrs %0, fpcr" : "=r"(fpcr));
  return fpcr == 0;
#else
#error "say how this processor's floating-point mode is read"
#endif
}

}  // namespace bandsaw
