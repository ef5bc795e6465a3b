// Traces the path of each pixel of a group. The primary vertex of a path is its first vertex whose
// BSDF has a pdf; before it, there may be mirrors and smooth glass. If the vertex after the primary
// vertex is diffuse, the light that leaves it is shared: it is connected with the primary vertices
// of all pixels of the group, with balance-heuristic weights (path_reuse.h has the formulas).

#include "renderlib/integrate/path_reuse.h"

#include <array>
#include <cmath>
#include <optional>

#include "renderlib/base/check.h"
#include "renderlib/integrate/path_steps.h"
#include "renderlib/integrate/through_lens.h"

namespace bandsaw {
namespace {

/// The first vertex of a pixel's path whose BSDF has a pdf, so that light from the shared vertices
/// of other pixels can be scattered there.
struct PrimaryVertex {
  SurfacePoint point;
  Vec3 normal;  ///< geometric normal on the viewer's side
  Bsdf bsdf;
  const GuidingCones* cones;  ///< directions from which path guiding expects light
  Rgb throughput;             ///< from this vertex to the camera
  /// Number of scatterings that may follow the one at this vertex.
  std::uint32_t scatterings_left;
};

/// The vertex after the primary vertex of a pixel's path, if all pixels may use it.
struct SharedVertex {
  SurfacePoint point;
  Vec3 normal;   ///< geometric normal on the side from which the path arrived
  Rgb radiance;  ///< radiance that leaves the vertex, the same in all directions
};

/// Returns true if the radiance that leaves the material is the same in all directions of one side,
/// and all of it is scattered light.
bool is_only_diffuse(const Material& material) {
  return std::holds_alternative<Diffuse>(material.kind) &&
         is_black(material.emission.radiance.factor);
}

/// Traces the path from the camera to the first surface whose BSDF has a pdf. Returns the number of
/// the scattering that may happen there, and sets `point` and `bsdf`; returns std::nullopt if the
/// path ends before.
std::optional<std::uint32_t> trace_to_primary(const PathContext& context, PathState& path,
                                              SurfacePoint& point, Bsdf& bsdf) {
  for (std::uint32_t depth = 0;; ++depth) {
    const std::optional<SurfacePoint> hit = next_surface(context, depth, path);
    if (!hit) {
      add_background(context, path);
      return std::nullopt;
    }
    add_emission(context, *hit, depth, path);
    const std::optional<Bsdf> found = make_bsdf(context, *hit, depth, path);
    if (!found) {
      return std::nullopt;
    }
    if (has_pdf(*found)) {
      point = *hit;
      bsdf = *found;
      return depth;
    }
    if (!scatter(context, *hit, *found, {}, depth, path)) {
      return std::nullopt;
    }
  }
}

/// Traces a pixel's path and leaves in `path` the radiance that belongs to this pixel alone. Sets
/// `primary` if the pixel can receive light from shared vertices. Sets `shared` if the vertex after
/// the primary vertex is shared. Then the light that leaves this vertex is in `shared` and not in
/// `path`. `cones` is empty memory of the caller, in which the cones of `primary` are stored.
void trace_own_path(const PathContext& context, PathState& path, GuidingCones& cones,
                    std::optional<PrimaryVertex>& primary, std::optional<SharedVertex>& shared) {
  SurfacePoint first;
  Bsdf bsdf;
  const std::optional<std::uint32_t> depth = trace_to_primary(context, path, first, bsdf);
  if (!depth) {
    return;
  }
  const Vec3 wo = -path.ray.direction;
  if (context.options.guiding != nullptr) {
    cones = cones_at(context, first, bsdf, wo);
  }
  primary = PrimaryVertex{first,  facing_normal(first, wo), bsdf,
                          &cones, path.throughput,          context.scatterings_left(path, *depth)};
  if (!scatter(context, first, bsdf, cones, *depth, path)) {
    return;
  }
  const std::optional<SurfacePoint> second = next_surface(context, *depth + 1, path);
  if (!second) {
    add_background(context, path);
    return;
  }
  const Rgb own = path.radiance;
  // If the path passes through the primary surface, its light stays with its own pixel.
  const bool is_shared = !path.previous.delta && dot(path.ray.direction, primary->normal) > 0 &&
                         is_only_diffuse(context.scene.material(second->material));
  if (is_shared) {
    shared = SharedVertex{*second, facing_normal(*second, -path.ray.direction), {}};
    path.radiance = {};
    path.throughput = gray(1);
    path.compression = 1;
  }
  if (scatter_at(context, *second, *depth + 1, path)) {
    trace_path(context, *depth + 2, path);
  }
  if (is_shared) {
    shared->radiance = path.radiance;
    path.radiance = own;
  }
}

using PrimaryVertices = std::array<std::optional<PrimaryVertex>, kMaxReusePixels>;

/// The connection of a primary vertex to a shared vertex. All numbers are zero if one vertex is
/// behind the surface of the other vertex. They are also zero if the BSDF at the primary vertex
/// scatters no light from the shared vertex, even if the pdf of this direction is above 0: a path
/// that samples this direction ends at once, because its throughput is black.
struct Connection {
  BsdfValue scattered;              ///< at the primary vertex; the pdf is by solid angle
  double solid_angle_per_area = 0;  ///< converts pdfs by solid angle to pdfs by area
};

/// Returns the connection of the two vertices. Whether they see each other is not tested.
Connection connect(const PrimaryVertex& primary, const SharedVertex& shared) {
  const Vec3 to_shared = shared.point.position - primary.point.position;
  const double cosine = -dot(to_shared, shared.normal);  // times the distance
  if (!(dot(to_shared, primary.normal) > 0) || !(cosine > 0)) {
    return {};
  }
  const double distance2 = length_squared(to_shared);
  const double distance = std::sqrt(distance2);
  const BsdfValue scattered = evaluate(primary.bsdf, *primary.cones, to_shared / distance);
  return is_black(scattered.value) ? Connection{}
                                   : Connection{scattered, cosine / (distance2 * distance)};
}

/// Adds the light of the shared vertex of pixel `owner` to all pixels whose primary vertex sees it,
/// with balance-heuristic weights. With `max_depth`, the light of the vertex depends on the number
/// of scatterings before it, so only pixels in whose paths this number is equal receive the light.
void distribute(const Scene& scene, const PrimaryVertices& primary, const SharedVertex& shared,
                std::size_t owner, absl::Span<ReusePixel> pixels) {
  std::array<Connection, kMaxReusePixels> connections;
  double pdf_sum = 0;  // over all pixels, by area
  for (std::size_t j = 0; j < pixels.size(); ++j) {
    if (!primary[j] || primary[j]->scatterings_left != primary[owner]->scatterings_left) {
      continue;
    }
    const Connection connection = connect(*primary[j], shared);
    if (j != owner && connection.scattered.pdf > 0) {
      ++pixels[owner].counts.rays;
      if (scene.accel().occluded(spawn_ray_to(primary[j]->point, shared.point))) {
        continue;
      }
    }
    connections[j] = connection;
    pdf_sum += connection.scattered.pdf * connection.solid_angle_per_area;
  }
  for (std::size_t j = 0; pdf_sum > 0 && j < pixels.size(); ++j) {
    if (connections[j].solid_angle_per_area > 0) {
      pixels[j].radiance += primary[j]->throughput * connections[j].scattered.value *
                            shared.radiance *
                            static_cast<float>(connections[j].solid_angle_per_area / pdf_sum);
    }
  }
}

}  // namespace

void radiance_with_reuse(const Scene& scene, absl::Span<ReusePixel> pixels, std::uint64_t sample,
                         const PathOptions& options) {
  BANDSAW_CHECK(pixels.size() <= kMaxReusePixels, "more pixels than can reuse paths together");
  PrimaryVertices primary;
  // The cones are not members of `primary`, because std::optional zeroes its memory, and cones need
  // much memory.
  std::array<GuidingCones, kMaxReusePixels> cones;
  std::array<std::optional<SharedVertex>, kMaxReusePixels> shared;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    ReusePixel& pixel = pixels[i];
    const PathContext context{scene, pixel.sampler, sample, options, pixel.counts.rays};
    PathState path(pixel.camera_ray.ray);
    if (pixel.camera_ray.lens) {
      sample_light_through_lens(context, *pixel.camera_ray.lens, path);
    }
    trace_own_path(context, path, cones[i], primary[i], shared[i]);
    pixel.radiance = path.radiance;
    pixel.counts.truncated += path.truncated ? 1 : 0;
  }
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (shared[i] && !is_black(shared[i]->radiance)) {
      distribute(scene, primary, *shared[i], i, pixels);
    }
  }
}

}  // namespace bandsaw
