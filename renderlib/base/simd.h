#pragma once

// Eight floats at a time on whatever the build is for (-DBANDSAW_ARCH). Every choice computes the
// same bits.

#if defined(__AVX2__) && defined(__FMA__)
#include "renderlib/base/simd_avx2.h"
namespace bandsaw {
using simd_avx2::Float8;
using simd_avx2::Mask8;
}  // namespace bandsaw
#else
#include "renderlib/base/simd_plain.h"
namespace bandsaw {
using simd_plain::Float8;
using simd_plain::Mask8;
}  // namespace bandsaw
#endif
