// The functions that bandsaw_test.wasm exports: load a package, render a band, hash the result.

#include "tests/wasm/entry.h"

#include <atomic>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "renderlib/package/blob_source.h"
#include "renderlib/package/package.h"
#include "renderlib/render/canary.h"
#include "renderlib/render/hash64.h"
#include "renderlib/render/render_band.h"
#include "tests/wasm/fused_hash.h"

namespace {

using bandsaw::Scene;

/// The state between two calls: blobs for the next scene, the scene, the last pixels, the last
/// error, and the bytes for the next call.
struct State {
  std::unique_ptr<bandsaw::BlobMap> blobs = std::make_unique<bandsaw::BlobMap>();
  std::shared_ptr<const Scene> scene;
  bandsaw::BandPixels pixels;
  std::string error;
  std::vector<std::byte> argument;
};

State& state() {
  static State only;
  return only;
}

bandsaw::Pool& pool() {
  static bandsaw::Pool only(1);
  return only;
}

/// Builds the scene of a manifest from the blobs that were added, and forgets these blobs.
absl::Status build(const std::string& manifest) {
  const auto blobs = std::exchange(state().blobs, std::make_unique<bandsaw::BlobMap>());
  auto description = bandsaw::decode_package(manifest, *blobs);
  if (!description.ok()) {
    return description.status();
  }
  auto scene = Scene::build(*std::move(description), pool());
  if (scene.ok()) {
    state().scene = *std::move(scene);
  }
  return scene.status();
}

}  // namespace

void* bandsaw_memory(size_t size) {
  state().argument.resize(size);
  return state().argument.data();
}
uint64_t bandsaw_canary() { return bandsaw::canary(); }
uint64_t bandsaw_fused_hash() { return bandsaw::test::fused_hash(); }

void bandsaw_add_blob(const void* bytes, size_t size) {
  const auto* const first = static_cast<const std::byte*>(bytes);
  state().blobs->put(std::vector<std::byte>(first, first + size));
}

uint32_t bandsaw_build(const void* manifest, size_t size) {
  const absl::Status status = build(std::string(static_cast<const char*>(manifest), size));
  state().error = std::string(status.message());
  return status.ok() ? 1 : 0;
}

const double* bandsaw_render(uint32_t width, uint32_t height, uint32_t max_depth,
                             uint32_t integrator, uint64_t seed, uint64_t samples) {
  const std::atomic<bool> stop = false;
  auto pixels = bandsaw::render_band(*state().scene,
                                     {.width = width,
                                      .height = height,
                                      .max_depth = max_depth,
                                      .seed = seed,
                                      .integrator = static_cast<bandsaw::Integrator>(integrator)},
                                     {/*samples=*/{0, samples}, /*rows=*/{0, height}}, pool(), stop,
                                     /*progress=*/{});
  state().error = std::string(pixels.status().message());
  if (!pixels.ok()) {
    return nullptr;
  }
  state().pixels = *std::move(pixels);
  return state().pixels.sums.data();
}

uint64_t bandsaw_sums_hash() {
  bandsaw::Hash64 hash;
  for (const double sum : state().pixels.sums) {
    hash.add(sum);
  }
  return hash.value();
}

const char* bandsaw_error() { return state().error.c_str(); }
