#pragma once

// A ray, cut where it passes the boundaries of media (scene/media.h).
//
// What a point is inside of is found anew for every ray, from the boundaries ahead: a shape that
// the ray leaves before it enters it contains the ray's origin. Nothing is carried along a path, so
// nothing can go wrong on the way: cameras and lights inside of media, surfaces that touch a
// boundary or lie in it, and reflections at a filled glass need no rules of their own.

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
  /// More shapes than these around one point are not kept.
  static constexpr std::size_t kMostNested = 16;

  /// `ray` has a unit direction and is followed for `length` (> 0, maybe infinite). The scene MUST
  /// need media and outlive the walk. Adds the rays that it traced to `rays`.
  MediumWalk(const Scene& scene, const Ray& ray, double length, std::uint64_t& rays);

  /// The next part that is in a medium, in order; nothing at the end.
  std::optional<Stretch> next();

 private:
  struct Crossing {
    Hit hit;
    PrimitiveId shape;  ///< primitive 0 for all of what is placed
    MediumId medium{};
    bool inwards = false;
  };
  /// The shapes around a point.
  class Around {
   public:
    void enter(const Crossing& crossing);
    /// Whether it was there.
    bool leave(const PrimitiveId& shape);
    bool contains(const PrimitiveId& shape) const;
    std::optional<MediumId> medium() const;

   private:
    struct Entry {
      PrimitiveId shape;
      MediumId medium{};
    };
    std::array<Entry, kMostNested> entries_;
    std::size_t size_ = 0;
  };

  static constexpr std::size_t kKept = 8;

  /// The first crossing beyond `after`, or the very first where that is no hit; none at the end.
  std::optional<Crossing> crossing_after(const Hit& after);
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
  Hit last_;
  bool all_kept_ = true;
};

/// The share of light that the media along the ray let pass, from its origin to t_max; the
/// direction need not be a unit vector. The scene MUST need media.
Rgb media_transmittance(const Scene& scene, const Ray& ray, std::uint64_t& rays);

}  // namespace bandsaw
