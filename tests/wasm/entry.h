#pragma once

// The functions that bandsaw_test.wasm, the renderer as WebAssembly, exports for tests in node
// (module.mjs). The module holds one scene at a time.

#include <stddef.h>
#include <stdint.h>

extern "C" {

/// Returns memory of `size` bytes. The caller puts the bytes for the next call into it.
void* bandsaw_memory(size_t size);
/// Returns the canary: the hash of a small image that every program renders.
uint64_t bandsaw_canary(void);
/// Returns a hash of the results of many fused operations (fused_hash.h).
uint64_t bandsaw_fused_hash(void);

/// Adds a blob of the next scene; copies the bytes.
void bandsaw_add_blob(const void* bytes, size_t size);
/// Builds a scene from its manifest, the serialised description of the scene, and from the blobs
/// that were added. Then forgets the blobs. Returns 1, or 0 for an error.
uint32_t bandsaw_build(const void* manifest, size_t size);
/// Renders the first `samples` samples of all pixels. The scene must have been built. The samples
/// are summed in a binary tree over blocks of 8 samples. They must be one node of this tree, so the
/// number of blocks must be a power of two. The last block may be shorter. Returns width x height x
/// 3 sums, which are valid until the next call; null for an error.
const double* bandsaw_render(uint32_t width, uint32_t height, uint32_t max_depth,
                             uint32_t integrator, uint64_t seed, uint64_t samples);
/// Returns the hash of the sums that were rendered last.
uint64_t bandsaw_sums_hash(void);
/// Returns the error text of the last bandsaw_build or bandsaw_render, ended by a zero byte. It is
/// empty if there was no error.
const char* bandsaw_error(void);

}  // extern "C"
