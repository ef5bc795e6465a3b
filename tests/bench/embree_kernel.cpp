// Ray tracing by Intel's Embree 3, for kernel_bench. A build without Embree has only stubs.

#include "tests/bench/embree_kernel.h"

#ifdef BANDSAW_EMBREE
#include <embree3/rtcore.h>
#endif

#include <atomic>
#include <chrono>
#include <cstring>
#include <limits>

namespace bandsaw::bench {

#ifdef BANDSAW_EMBREE

struct EmbreeKernel::State {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  std::atomic<long long> bytes{0};
  double build_seconds = 0;
};

namespace {

/// Embree's memory monitor: adds `bytes`, which is negative for freed memory, to the counter at
/// `state`.
bool count_bytes(void* state, ssize_t bytes, bool) {
  *static_cast<std::atomic<long long>*>(state) += bytes;
  return true;
}

RTCRay to_embree(const Ray& ray) {
  RTCRay r = {};
  r.org_x = static_cast<float>(ray.origin.x);
  r.org_y = static_cast<float>(ray.origin.y);
  r.org_z = static_cast<float>(ray.origin.z);
  r.dir_x = static_cast<float>(ray.direction.x);
  r.dir_y = static_cast<float>(ray.direction.y);
  r.dir_z = static_cast<float>(ray.direction.z);
  r.tfar = static_cast<float>(ray.t_max);
  r.mask = 0xffffffffu;
  return r;
}

}  // namespace

std::unique_ptr<EmbreeKernel> EmbreeKernel::create(const Mesh& mesh, bool robust,
                                                   const char* config) {
  auto state = std::make_unique<State>();
  state->device = rtcNewDevice(config);
  rtcSetDeviceMemoryMonitorFunction(state->device, count_bytes, &state->bytes);
  state->scene = rtcNewScene(state->device);
  rtcSetSceneFlags(state->scene, robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
  rtcSetSceneBuildQuality(state->scene, RTC_BUILD_QUALITY_MEDIUM);
  RTCGeometry geometry = rtcNewGeometry(state->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                           12, mesh.positions.size());
  std::memcpy(vertices, mesh.positions.data(), 12 * mesh.positions.size());
  void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12,
                                          mesh.triangles.size());
  std::memcpy(indices, mesh.triangles.data(), 12 * mesh.triangles.size());
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(state->scene, geometry);
  rtcReleaseGeometry(geometry);
  const long long before = state->bytes;
  const auto start = std::chrono::steady_clock::now();
  rtcCommitScene(state->scene);
  state->build_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  state->bytes -= before;
  return std::unique_ptr<EmbreeKernel>(new EmbreeKernel(std::move(state)));
}

EmbreeKernel::EmbreeKernel(std::unique_ptr<State> state) : state_(std::move(state)) {}

EmbreeKernel::~EmbreeKernel() {
  rtcReleaseScene(state_->scene);
  rtcReleaseDevice(state_->device);
}

bool EmbreeKernel::closest(const Ray& ray) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit hit;
  hit.ray = to_embree(ray);
  hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(state_->scene, &context, &hit);
  return hit.hit.geomID != RTC_INVALID_GEOMETRY_ID;
}

bool EmbreeKernel::occluded(const Ray& ray) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRay r = to_embree(ray);
  rtcOccluded1(state_->scene, &context, &r);
  return r.tfar < 0;
}

double EmbreeKernel::build_seconds() const { return state_->build_seconds; }
long long EmbreeKernel::bytes() const { return state_->bytes; }

#else

struct EmbreeKernel::State {};
std::unique_ptr<EmbreeKernel> EmbreeKernel::create(const Mesh&, bool, const char*) {
  return nullptr;
}
EmbreeKernel::EmbreeKernel(std::unique_ptr<State> state) : state_(std::move(state)) {}
EmbreeKernel::~EmbreeKernel() = default;
bool EmbreeKernel::closest(const Ray&) const { return false; }
bool EmbreeKernel::occluded(const Ray&) const { return false; }
double EmbreeKernel::build_seconds() const { return 0; }
long long EmbreeKernel::bytes() const { return 0; }

#endif

}  // namespace bandsaw::bench
