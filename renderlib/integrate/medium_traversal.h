#pragma once

// Splits a ray into segments at the boundaries of media (scene/media.h).
//
// The set of media around the ray's origin is computed for each ray from the boundaries ahead of
// it. If the ray leaves a medium more often than it enters this medium, the origin is inside. A
// path carries no medium state. So cameras and lights inside media, surfaces that touch a boundary
// or lie in it, and reflections at a filled glass need no special cases.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "renderlib/medium/region_walk.h"
#include "renderlib/sampling/sampler.h"
#include "renderlib/scene/scene.h"

namespace bandsaw {

/// A part of a ray inside one medium. `begin` and `end` are distances from the ray's origin in
/// scene units; `end` may be infinite.
struct MediumSegment {
  double begin = 0;
  double end = 0;
  const Medium* medium = nullptr;
  /// The same medium prepared for tracking if it varies in space; otherwise nullptr.
  const GridMedium* varying = nullptr;
  /// If the medium varies in space: the instance that is the boundary (Scene::to_medium()).
  std::uint32_t boundary = 0;
};

/// Returns the part of `ray` that lies in the segment, in the space of the medium. The result
/// starts at the begin of the segment. `ray` is the ray that was split, and the medium MUST vary in
/// space.
GridRay in_medium_space(const Scene& scene, const Ray& ray, const MediumSegment& segment);

/// Iterates over the segments of a ray that lie in a medium.
class MediumTraversal {
 public:
  /// Maximum number of different media, or boundaries of media that vary in space, that may
  /// surround a point; further ones are ignored.
  static constexpr std::size_t kMaxOverlappingMedia = 16;

  /// `ray` has a unit direction; only its first `length` (> 0, may be infinite) is split. The scene
  /// MUST have media (`SceneFeatures::media`) and outlive this object. Adds the number of rays
  /// traced to `rays`.
  MediumTraversal(const Scene& scene, const Ray& ray, double length, std::uint64_t& rays);

  /// Returns the next segment inside a medium, in order along the ray; std::nullopt at the end.
  std::optional<MediumSegment> next();

 private:
  /// A point where the ray crosses a boundary.
  struct Crossing {
    double t = 0;
    PrimitiveId shape;  ///< one id for all faces of a shape: the primitive is 0 for an instance
    MediumId medium{};
    std::uint32_t boundary = 0;  ///< instance of the boundary; 0 if the medium does not vary
    bool inwards = false;
    bool on_rim = false;  ///< on an edge or corner of a mesh's triangle
  };
  /// Counts for each region how many of its shapes contain a point. A count may be negative while
  /// boundaries at equal distance are processed.
  class Around {
   public:
    /// The unit of counting: a medium, or one boundary of a medium that varies in space.
    struct Region {
      MediumId medium{};
      std::uint32_t boundary = 0;  ///< instance of the boundary; 0 if the medium does not vary
      friend bool operator==(const Region&, const Region&) = default;
    };
    /// Adds `shapes` (1 or -1) to the region's count; ignored if there are too many regions.
    void add(const Region& region, int shapes);
    /// MUST be called when the region's counts are those of the ray's origin: how often the ray
    /// leaves shapes of the region, minus how often it enters them. Sets negative counts to 0. A
    /// count is negative if a shape is not closed, so that the ray enters it more often than it
    /// leaves it.
    void forget_negative();
    /// Returns the region that fills the point; std::nullopt if there is none. Among the regions
    /// with a positive count it is the one with the largest medium id, and among those of this
    /// medium the one with the largest boundary.
    std::optional<Region> top() const;

   private:
    /// Returns the count of the region, which is 0 if the region is new. Returns nullptr if there
    /// are too many regions.
    int* count_of(const Region& region);
    struct Entry {
      Region region;
      int shapes = 0;
    };
    std::array<Entry, kMaxOverlappingMedia> entries_;
    std::size_t size_ = 0;
  };
  /// State of the search for boundaries along the ray.
  struct Search {
    /// Number of crossings that are kept to recognise repeated hits of one edge.
    static constexpr std::size_t kRecent = 4;
    Hit last;
    std::array<Crossing, kRecent> recent;  ///< crossing number n is at n % kRecent
    std::size_t found = 0;                 ///< number of crossings so far
  };

  /// Number of crossings that are stored: the first ones on the ray.
  static constexpr std::size_t kKept = 8;

  /// Returns true if the hit boundary is an instance of a mesh.
  bool is_of_mesh(const Hit& hit) const;
  /// Returns true if the medium varies in space.
  bool varies(MediumId medium) const;
  /// Returns the next boundary crossing; std::nullopt at the end.
  std::optional<Crossing> find_next(Search& search);
  /// Finds all crossings of the ray, and from them the media around its origin.
  void find_around_origin();
  /// Returns the next crossing of the walk along the ray: a stored one, or one that is found again.
  std::optional<Crossing> take_crossing();
  /// Returns a segment with the medium at the current place. Its begin and end are not set. Its
  /// medium is nullptr if there is no medium or a clear one.
  MediumSegment here() const;

  const Scene& scene_;
  Ray ray_;
  double length_;
  std::uint64_t& rays_;
  Around around_;  ///< around the current place
  double at_ = 0;  ///< distance of the current place from the ray's origin
  /// The first crossings are stored, so that most rays are traced only once.
  std::array<Crossing, kKept> kept_;
  std::size_t kept_size_ = 0;
  std::size_t taken_ = 0;  ///< number of stored crossings that take_crossing() has returned
  Search beyond_kept_;     ///< continues after the last stored crossing
  bool all_kept_ = true;   ///< false: crossings may be left that are not stored
};

/// Returns the transmittance of the media along the ray from its origin to `t_max`, by channel. If
/// a medium varies in space, its transmittance is estimated with the random numbers `numbers`. The
/// direction need not be a unit vector. The scene MUST have media. Adds the number of rays traced
/// to `rays`.
Rgb media_transmittance(const Scene& scene, const Ray& ray, NumberStream numbers,
                        std::uint64_t& rays);

}  // namespace bandsaw
