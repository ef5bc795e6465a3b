#pragma once

// A ray, cut where it passes the boundaries of media (scene/media.h).
//
// What a point is inside of is found anew for every ray, from the boundaries ahead: a medium that
// the ray leaves more often than it enters it is around the ray's origin. Nothing is carried along
// a path, so nothing can go wrong on the way: cameras and lights inside of media, surfaces that
// touch a boundary or lie in it, and reflections at a filled glass need no rules of their own.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "renderlib/scene/scene.h"

namespace bandsaw {

/// A part of a ray in one medium. Distances from the ray's origin, scene units; `end` may be
/// infinite.
struct Stretch {
  double begin = 0;
  double end = 0;
  const Medium* medium = nullptr;
};

class MediumWalk {
 public:
  /// More media than these around one point are not kept.
  static constexpr std::size_t kMostMedia = 16;

  /// `ray` has a unit direction and is followed for `length` (> 0, maybe infinite). The scene MUST
  /// need media and outlive the walk. Adds the rays that it traced to `rays`.
  MediumWalk(const Scene& scene, const Ray& ray, double length, std::uint64_t& rays);

  /// The next part that is in a medium, in order; nothing at the end.
  std::optional<Stretch> next();

 private:
  struct Crossing {
    double t = 0;
    PrimitiveId shape;  ///< primitive 0 for all of what is placed
    MediumId medium{};
    bool inwards = false;
    bool on_rim = false;  ///< of a mesh's triangle
  };
  /// How many shapes of each medium are around a point; below 0 between faces of one distance.
  class Around {
   public:
    void add(MediumId medium, int shapes);
    /// Shapes that are not closed may be entered more often than they are left.
    void forget_negative();
    std::optional<MediumId> medium() const;

   private:
    int* count_of(MediumId medium);
    struct Entry {
      MediumId medium{};
      int shapes = 0;
    };
    std::array<Entry, kMostMedia> entries_;
    std::size_t size_ = 0;
  };
  /// How far the boundaries have been looked for.
  struct Search {
    static constexpr std::size_t kRecent = 4;
    Hit last;
    std::array<Crossing, kRecent> recent;
    std::size_t found = 0;
  };

  static constexpr std::size_t kKept = 8;

  bool is_of_mesh(const Hit& hit) const;
  /// The next crossing; none at the end.
  std::optional<Crossing> find_next(Search& search);
  void find_around_origin();
  std::optional<Crossing> take_crossing();
  const Medium* here() const;

  const Scene& scene_;
  Ray ray_;
  double length_;
  std::uint64_t& rays_;
  Around around_;
  double at_ = 0;
  /// The first crossings, so that most rays are traced once.
  std::array<Crossing, kKept> kept_;
  std::size_t kept_size_ = 0;
  std::size_t taken_ = 0;
  Search beyond_kept_;
  bool all_kept_ = true;
};

/// The share of light that the media along the ray let pass, from its origin to t_max; the
/// direction need not be a unit vector. The scene MUST need media.
Rgb media_transmittance(const Scene& scene, const Ray& ray, std::uint64_t& rays);

}  // namespace bandsaw
