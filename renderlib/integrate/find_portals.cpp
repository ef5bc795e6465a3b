// Traces paths in a fixed number of chunks, and fits portals (openings through which the background
// lights a room) to the rays that surfaces scatter. A few chunks already tell whether the scene is
// so open that it needs no portals.

#include "renderlib/integrate/find_portals.h"

#include "renderlib/integrate/fit_portals.h"
#include "renderlib/integrate/guided_bsdf.h"
#include "renderlib/integrate/path_steps.h"
#include "renderlib/integrate/training_paths.h"

namespace bandsaw {
namespace {

/// Number of chunks.
constexpr std::uint32_t kChunks = 64;
/// Number of the chunks that are traced first, to find out whether the scene needs portals.
constexpr std::uint32_t kFirstChunks = 8;
constexpr std::uint64_t kPathsOfChunk = 128;
/// Maximum number of scatterings of a path. Later scatterings would find the same openings.
constexpr std::uint32_t kMaxScatterings = 6;

/// Traces one path. Appends the rays that leave surfaces which scatter into a wide range of
/// directions, and notes for each ray whether it escapes. Rays from mirrors and glass are left out.
void add_rays(const PathContext& context, PathState path, std::vector<ScatteredRay>& to) {
  const Scene& scene = context.scene;
  std::optional<ScatteredRay> open;  // a ray of which it is not yet known whether it escapes
  for (std::uint32_t depth = 0; depth < kMaxScatterings; ++depth) {
    const std::optional<SurfacePoint> hit = next_surface(context, depth, path);
    if (open) {
      open->escapes =
          !hit && !is_black(radiance(scene.background(), scene.textures(), path.ray.direction));
      to.push_back(*open);
      open.reset();
    }
    if (!hit) {
      return;
    }
    const std::optional<Bsdf> bsdf = make_bsdf(context, *hit, depth, path);
    if (!bsdf) {
      return;
    }
    const Vec3 wo = -path.ray.direction;
    if (!scatter(context, *hit, *bsdf, {}, depth, path)) {
      return;
    }
    if (can_be_guided(*bsdf) && !path.previous.delta) {
      open = ScatteredRay{hit->position, facing_normal(*hit, wo), path.ray.direction};
    }
  }
}

/// Returns the rays of a chunk of paths.
Traced<ScatteredRay> rays_of_chunk(const Scene& scene, const GuidingKey& key,
                                   std::uint32_t number) {
  // Selects the random numbers. The training of path guiding uses the rounds 0 to 2.
  constexpr std::uint32_t kRound = 3;
  const RayGenerator camera(scene.camera(), static_cast<int>(key.width),
                            static_cast<int>(key.height), scene.camera_at_close());
  const PathOptions options{.technique = Technique::kScatteringOnly, .russian_roulette = false};
  const PixelSampler sampler = training_sampler({kRound, number, kPathsOfChunk});
  Traced<ScatteredRay> out;
  for (std::uint64_t sample = 0; sample < kPathsOfChunk; ++sample) {
    const PathContext context{scene, sampler, sample, options, out.rays};
    add_rays(context, PathState(training_ray(scene, camera, key, sampler, sample)), out.items);
  }
  return out;
}

}  // namespace

std::optional<Portals> find_portals(const Scene& scene, const GuidingKey& key,
                                    const Preparation& preparation, std::uint64_t& traced) {
  if (is_black(scene.background())) {
    return Portals();
  }
  Traced<ScatteredRay> rays;
  std::uint32_t done = 0;
  for (const std::uint32_t until : {kFirstChunks, kChunks}) {
    if (!append_chunks(done, until, preparation, rays,
                       [&](std::uint32_t number) { return rays_of_chunk(scene, key, number); })) {
      return std::nullopt;
    }
    done = until;
    if (escaping_part(rays.items) > kMaxEscaping) {
      break;
    }
  }
  traced += rays.rays;
  return portals_of(rays.items);
}

}  // namespace bandsaw
