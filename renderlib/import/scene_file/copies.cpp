#include "renderlib/import/scene_file/copies.h"

#include <cmath>
#include <cstdint>

#include "absl/strings/str_cat.h"
#include "renderlib/base/split_mix.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/draft/placements.h"
#include "renderlib/import/scene_file/numbers.h"
#include "renderlib/import/scene_file/read_placement.h"

namespace bandsaw {
namespace {

/// Returns a number in [0, 1) that depends on seed, copy and use alone.
double random_number(std::uint64_t seed, std::uint64_t copy, std::uint64_t use) {
  std::uint64_t x = seed;
  for (const std::uint64_t next : {copy, use}) {
    x = split_mix(x + kSplitMixIncrement * (next + 1));
  }
  return static_cast<double>(x >> 11) * 0x1p-53;
}

struct Grid {
  std::uint64_t count[3];
  Vec3 step;
  Vec3 origin;
  Vec3 jitter;
  double turn = 0;
  double least = 1;
  double most = 1;
  std::uint64_t seed = 0;
};

absl::StatusOr<Grid> read_grid(const Field& in, const scene::Grid& from) {
  Grid grid;
  if (from.count_size() != 3) {
    return in.error("count", absl::StrCat("must be 3 numbers, has ", from.count_size()));
  }
  std::uint64_t all = 1;
  for (int k = 0; k < 3; ++k) {
    if (from.count(k) < 1 || from.count(k) > kMaxPlacements) {
      return in.error("count", absl::StrCat("must be at least 1 and at most ", kMaxPlacements,
                                            ", is ", from.count(k)));
    }
    grid.count[k] = from.count(k);
    all *= grid.count[k];
    if (all > kMaxPlacements) {
      return in.error("count", absl::StrCat("makes more than ", kMaxPlacements, " copies"));
    }
  }
  ASSIGN_OR_RETURN(grid.step, read_vec3(in, "step", from.step()));
  ASSIGN_OR_RETURN(grid.origin, read_vec3(in, "origin", from.origin(), Vec3{}));
  ASSIGN_OR_RETURN(grid.jitter, read_vec3(in, "jitter", from.jitter(), Vec3{}));
  if (!(grid.jitter.x >= 0 && grid.jitter.y >= 0 && grid.jitter.z >= 0)) {
    return in.error("jitter", "must not be negative");
  }
  grid.turn = from.turn();
  RETURN_IF_ERROR(check_range(in, "turn", grid.turn, 0, 1e9));
  if (from.scale_size() != 0) {
    if (from.scale_size() != 2 ||
        !(from.scale(0) > 0 && from.scale(0) <= from.scale(1) && std::isfinite(from.scale(1)))) {
      return in.error("scale", "must be [least, most], both > 0");
    }
    grid.least = from.scale(0);
    grid.most = from.scale(1);
  }
  grid.seed = from.seed();
  return grid;
}

Transform copy_of(const Grid& grid, std::uint64_t number) {
  const std::uint64_t i = number % grid.count[0];
  const std::uint64_t j = number / grid.count[0] % grid.count[1];
  const std::uint64_t k = number / grid.count[0] / grid.count[1];
  const auto random = [&](std::uint64_t use) { return random_number(grid.seed, number, use); };
  const auto around = [&](std::uint64_t use, double by) { return by * (2 * random(use) - 1); };
  const double dx = around(0, grid.jitter.x);
  const double dy = around(1, grid.jitter.y);
  const double dz = around(2, grid.jitter.z);
  const Vec3 to = grid.origin + Vec3{static_cast<double>(i) * grid.step.x + dx,
                                     static_cast<double>(j) * grid.step.y + dy,
                                     static_cast<double>(k) * grid.step.z + dz};
  const double size = grid.least + (grid.most - grid.least) * random(4);
  return translation(to) * rotation({0, 1, 0}, grid.turn * random(3)) * scaling({size, size, size});
}

}  // namespace

absl::StatusOr<std::vector<Transform>> read_copies(const Field& in, const scene::Instance& from) {
  std::vector<Transform> copies;
  if (from.has_grid()) {
    if (from.at_size() > 0) {
      return in.error("grid", "stands instead of at: write one or the other");
    }
    ASSIGN_OR_RETURN(const Grid grid, read_grid(in.child("grid"), from.grid()));
    const std::uint64_t count = grid.count[0] * grid.count[1] * grid.count[2];
    for (std::uint64_t i = 0; i < count; ++i) {
      copies.push_back(copy_of(grid, i));
    }
    return copies;
  }
  for (int i = 0; i < from.at_size(); ++i) {
    ASSIGN_OR_RETURN(const Transform copy, read_placement(in.child("at", i), from.at(i)));
    copies.push_back(copy);
  }
  if (copies.empty()) {
    copies.push_back(Transform{});
  }
  return copies;
}

}  // namespace bandsaw
