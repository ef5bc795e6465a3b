// Checks by CPUID whether the processor has all instructions of x86-64-v3, for which the AVX2
// kernel is compiled.

#include "renderlib/base/x86_64_v3.h"

#if defined(__x86_64__)
#include <cpuid.h>
#endif

namespace bandsaw {

#if defined(__x86_64__)
namespace {

// Bits of CPUID (Intel SDM, volume 2A, "CPUID"). Their names differ between compilers.
constexpr unsigned kBasicEcx = 1u << 0 |     // SSE3
                               1u << 9 |     // SSSE3
                               1u << 12 |    // FMA
                               1u << 13 |    // CMPXCHG16B
                               1u << 19 |    // SSE4.1
                               1u << 20 |    // SSE4.2
                               1u << 22 |    // MOVBE
                               1u << 23 |    // POPCNT
                               1u << 27 |    // OSXSAVE
                               1u << 28 |    // AVX
                               1u << 29;     // F16C
constexpr unsigned kExtendedEbx = 1u << 3 |  // BMI1
                                  1u << 5 |  // AVX2
                                  1u << 8;   // BMI2
constexpr unsigned kAmdEcx = 1u << 0 |       // LAHF and SAHF
                             1u << 5;        // LZCNT: older processors silently execute BSR instead

bool has(unsigned found, unsigned wanted) { return (found & wanted) == wanted; }

}  // namespace

bool runs_x86_64_v3() {
  unsigned eax = 0;
  unsigned ebx = 0;
  unsigned ecx = 0;
  unsigned edx = 0;
  if (__get_cpuid(1, &eax, &ebx, &ecx, &edx) == 0 || !has(ecx, kBasicEcx)) {
    return false;
  }
  if (__get_cpuid_count(7, 0, &eax, &ebx, &ecx, &edx) == 0 || !has(ebx, kExtendedEbx)) {
    return false;
  }
  if (__get_cpuid(0x80000001u, &eax, &ebx, &ecx, &edx) == 0 || !has(ecx, kAmdEcx)) {
    return false;
  }
  return __builtin_cpu_supports(
      "avx2");  // also checks with XGETBV that the system saves the registers
}
#else
bool runs_x86_64_v3() { return false; }
#endif

}  // namespace bandsaw
