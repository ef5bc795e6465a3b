#pragma once

// The functions that bandsaw_test.wasm, the renderer as WebAssembly, exports for tests in node
// (module.mjs). The module holds one scene at a time.

#include <stddef.h>
#include <stdint.h>

extern "C" {

/// Returns memory for the bytes of the next call.
void* bandsaw_memory(size_t size);
/// Returns the canary: the hash of a small image that every program renders.
uint64_t bandsaw_canary(void);
/// Returns a hash of sums of products of many numbers, each rounded once.
uint64_t bandsaw_fused_hash(void);

/// Adds a blob of the next scene; copies the bytes.
void bandsaw_add_blob(const void* bytes, size_t size);
/// Builds the scene of this manifest, the serialised description of a scene, from the blobs that
/// were added, and forgets the blobs. Returns 1, or 0 for an error.
uint32_t bandsaw_build(const void* manifest, size_t size);
/// Renders the first `samples` samples of all pixels of the scene, which must have been built. They
/// must be one node of the summation tree, such as 8 times a power of two. Returns width x height x
/// 3 sums, which are valid until the next call; null for an error.
const double* bandsaw_render(uint32_t width, uint32_t height, uint32_t max_depth,
                             uint32_t integrator, uint64_t seed, uint64_t samples);
/// Returns the hash of the sums that were rendered last.
uint64_t bandsaw_sums_hash(void);
/// Returns what was wrong in the last call, ended by a zero byte.
const char* bandsaw_error(void);

}  // extern "C"
