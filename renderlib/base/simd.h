#pragma once

// Selects Float8, a vector of eight floats, for the instruction set of the compilation. All
// versions compute the same bits, except about_fused() and about_fused_minus().
// renderlib/base/simd_plain.h defines the operations.

#if defined(__AVX2__) && defined(__FMA__)
#include "renderlib/base/simd_avx2.h"
namespace bandsaw {
using simd_avx2::Float8;
using simd_avx2::Mask8;
inline constexpr const char* kSimdName = "avx2";
}  // namespace bandsaw
#elif defined(__aarch64__) && defined(__ARM_NEON)
#include "renderlib/base/simd_neon.h"
namespace bandsaw {
using simd_neon::Float8;
using simd_neon::Mask8;
inline constexpr const char* kSimdName = "neon";
}  // namespace bandsaw
#elif defined(__wasm_simd128__)
#include "renderlib/base/simd_wasm.h"
namespace bandsaw {
using simd_wasm::Float8;
using simd_wasm::Mask8;
inline constexpr const char* kSimdName = "wasm";
}  // namespace bandsaw
#else
#include "renderlib/base/simd_plain.h"
namespace bandsaw {
using simd_plain::Float8;
using simd_plain::Mask8;
inline constexpr const char* kSimdName = "plain";
}  // namespace bandsaw
#endif
