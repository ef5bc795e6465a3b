// Traces paths from the camera and remembers their vertices. When a path has ended, each vertex
// whose direction can be guided becomes a record: the direction in which the path continued, and
// the light that the path found in this direction.

#include "renderlib/integrate/training_paths.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "renderlib/integrate/path_steps.h"
#include "renderlib/integrate/through_media.h"
#include "renderlib/material/opacity.h"

namespace bandsaw {
namespace {

/// The source of background light is placed at this many times the length of the longest ray of the
/// path. The source is then so far away that it lies in the same direction from all points of a
/// cell of the guiding field (guiding/guiding_cell.h).
constexpr double kFar = 1e6;

/// Maximum number of vertices of a path that are recorded. It bounds the memory of the training.
constexpr std::size_t kMaxVertices = 8;

/// A vertex of a training path.
struct Vertex {
  Vec3 position;
  Vec3 normal;         ///< on the side of the path
  Vec3 direction;      ///< direction of the path from here
  double length = -1;  ///< length of the ray from here; negative or infinite: it left the scene
  Rgb radiance;        ///< PathState::radiance before the ray was traced
  Rgb throughput;      ///< PathState::throughput of the ray
  double cosine_by_pdf = 0;  ///< cosine / pdf of `direction`; 0: the path ended here
};

/// A path and its vertices. The next path uses the memory of the vertices again.
struct TrainingPath {
  explicit TrainingPath(const Ray& from, std::vector<Vertex>& scratch)
      : state(from), vertices(scratch) {
    vertices.clear();
  }
  PathState state;
  std::vector<Vertex>& vertices;
  bool open = false;  ///< the ray of the last vertex has not met anything yet

  /// Notes the length of the ray that left the last vertex.
  void end_ray(double length) {
    if (open) {
      vertices.back().length = length;
      open = false;
    }
  }
};

/// Scatters the path at the surface. Remembers the vertex if its direction can be guided, up to
/// kMaxVertices vertices. Returns false if the path ends.
bool scatter_and_remember(const PathContext& context, const SurfacePoint& point, const Bsdf& bsdf,
                          std::uint32_t depth, TrainingPath& path) {
  PathState& state = path.state;
  const Vec3 wo = -state.ray.direction;
  const GuidingCones cones = cones_at(context, point, bsdf, wo);
  const bool goes_on = scatter(context, point, bsdf, cones, depth, state);
  if (!can_be_guided(bsdf) || (goes_on && state.previous.delta) || state.ends_at_receiver ||
      path.vertices.size() == kMaxVertices) {
    return goes_on;
  }
  Vertex vertex;
  vertex.position = point.position;
  vertex.normal = facing_normal(point, wo);
  if (goes_on) {
    vertex.direction = state.ray.direction;
    vertex.radiance = state.radiance;
    vertex.throughput = state.throughput;
    vertex.cosine_by_pdf =
        std::max(0.0, dot(state.ray.direction, vertex.normal)) / state.previous.pdf;
  }
  path.vertices.push_back(vertex);
  path.open = goes_on;
  return goes_on;
}

/// Traces the path until it ends, and records its vertices. The steps are those of trace_path()
/// (path.cpp), but the path never continues in several directions.
void trace_and_remember(const PathContext& context, TrainingPath& path) {
  const Scene& scene = context.scene;
  PathState& state = path.state;
  for (std::uint32_t depth = 0;; ++depth) {
    const std::optional<SurfacePoint> hit = next_surface(context, depth, state);
    const double length = hit ? distance_along(state.ray, *hit) : kInfinity;
    if (hit) {
      add_emission(context, *hit, depth, state);
    }
    if (scene.features().media) {
      const Vec3 origin = state.ray.origin;
      const MediumEvent event = through_media(context, length, depth, state);
      if (event != MediumEvent::kPassed) {
        path.end_ray(event == MediumEvent::kScattered ? bandsaw::length(state.ray.origin - origin)
                                                      : length);
        if (event == MediumEvent::kScattered) {
          state.chain = kNoChain;
          continue;
        }
        return;
      }
    }
    if (!hit) {
      add_background(context, state);
      return;
    }
    if (scene.features().alpha && is_hidden_lamp(scene.material(hit->material))) {
      state.uncounted += state.uncounted < kMaxUncounted ? 1 : 0;
      state.ray = spawn_ray(*hit, state.ray.direction);
      continue;
    }
    path.end_ray(length);
    const std::optional<Bsdf> bsdf = make_bsdf(context, *hit, depth, state);
    if (!bsdf || !scatter_and_remember(context, *hit, *bsdf, depth, path)) {
      return;
    }
  }
}

/// Appends the records of the vertices. The light that the path found after a vertex, divided by
/// the throughput of the ray, is the radiance that arrives along the ray. This radiance times
/// cosine / pdf estimates the irradiance of the vertex. `camera_distance` is the length of the
/// camera ray.
void add_records(const TrainingPath& path, double camera_distance, std::vector<GuidingRecord>& to) {
  double longest = camera_distance;
  for (const Vertex& vertex : path.vertices) {
    longest = std::max(longest, std::isfinite(vertex.length) ? vertex.length : 0);
  }
  for (const Vertex& vertex : path.vertices) {
    const Rgb found = path.state.radiance + vertex.radiance * -1.0f;
    const double arrives =
        vertex.cosine_by_pdf > 0
            ? luminance(found) / luminance(vertex.throughput) * vertex.cosine_by_pdf
            : 0;
    const bool usable = arrives > 0 && std::isfinite(arrives);
    const bool leaves = vertex.length < 0 || !std::isfinite(vertex.length);
    const double distance = leaves ? kFar * longest : vertex.length;
    to.push_back({.position = float3(vertex.position),
                  .normal = float3(vertex.normal),
                  .source = float3(vertex.position + vertex.direction * distance),
                  .weight = usable ? static_cast<float>(arrives) : 0.0f,
                  .kind = GuidingRecord::Kind::kPath});
  }
}

}  // namespace

PixelSampler training_sampler(const TrainingChunk& chunk) {
  constexpr std::uint64_t kSeed = 0x9d1a5e3c7b2f8641;  // an arbitrary number
  return {kSeed, kBeyondImages + chunk.number, kBeyondImages + chunk.round};
}

Ray training_ray(const Scene& scene, const RayGenerator& camera, const GuidingKey& key,
                 const PixelSampler& sampler, std::uint64_t sample) {
  const Sample4 at = sampler.group(sample, kGroupCamera);
  const double when = scene.features().motion ? sampler.group(sample, kGroupTime)[0] : 0;
  return camera.ray(at[0] * key.width, at[1] * key.height, at[2], at[3], when);
}

TrainingRecords training_paths(const Scene& scene, const GuidingKey& key,
                               const TrainingChunk& chunk, const PathOptions& options) {
  const RayGenerator camera(scene.camera(), static_cast<int>(key.width),
                            static_cast<int>(key.height), scene.camera_at_close());
  const PixelSampler sampler = training_sampler(chunk);
  TrainingRecords out;
  std::vector<Vertex> vertices;
  for (std::uint64_t sample = 0; sample < chunk.count; ++sample) {
    const PathContext context{scene, sampler, sample, options, out.rays};
    const Ray ray = training_ray(scene, camera, key, sampler, sample);
    TrainingPath path(ray, vertices);
    trace_and_remember(context, path);
    if (!vertices.empty()) {
      add_records(path, length(vertices[0].position - ray.origin), out.items);
    }
  }
  return out;
}

}  // namespace bandsaw
