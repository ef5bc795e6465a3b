// Defines the function table of one kernel. A kernel is the render code, compiled for one
// instruction set. This file is compiled once for each kernel, with the compiler flags of the
// kernel's instruction set.

#include "renderlib/base/simd.h"
#include "renderlib/render/kernel.h"
#include "renderlib/render/kernel_code.h"

namespace bandsaw {

#if defined(BANDSAW_IN_AVX2_KERNEL)
constinit const Kernel Kernel::kAvx2 = {
#else
constinit const Kernel Kernel::kBase = {
#endif
    .name = kSimdName,
    .build = &Scene::build_with,
    .render_band = &render_band_with_kernel,
    .fit = &bandsaw::fit,
    .add_elementary_functions = &bandsaw::add_elementary_functions,
};

}  // namespace bandsaw
