// Portals, which are rectangular openings through which rays escape from the scene, are found one
// after the other. Candidates are rectangles in planes of walls. For each direction there is one
// more plane, because an opening need not lie in a wall: the plane in which the crossings of the
// escaping rays are closest together. A plane may have several openings, so its crossings are
// divided where they have gaps. The best rectangle of all becomes a portal, and the search goes on
// with the rays that do not pass through it.

#include "renderlib/integrate/fit_portals.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "renderlib/geometry/box.h"

namespace bandsaw {
namespace {

/// Fewer escaping rays do not tell where an opening is.
constexpr std::size_t kMinRays = 24;
/// At least the part kMinPrecision of the rays towards a portal escapes. This part is also at least
/// kMinLift times as large as the part of all rays that escapes.
constexpr double kMinPrecision = 0.35;
constexpr double kMinLift = 3;
/// A portal has at least this part of the escaping rays.
constexpr double kMinPart = 0.04;

/// Maximum number of normals of planes: the axes and the most frequent normals of the surfaces.
constexpr std::size_t kMaxNormals = 9;
/// Normals whose cosine is above this number count as equal or opposite.
constexpr double kSameDirection = 0.9995;
/// For each normal, at most kMaxWalls walls are considered: those at which most rays start. More
/// than the part kMinPartOfWall of the rays must start at a wall. Surfaces belong to one wall if
/// their offsets, in sorted order, differ from one to the next by at most the part kThickness of
/// the scene's size.
constexpr std::size_t kMaxWalls = 8;
constexpr double kMinPartOfWall = 0.005;
constexpr double kThickness = 1e-4;
/// Openings may lie outside the box of the places from which rays start, by at most this part of
/// the scene's size.
constexpr double kMarginOfBox = 0.01;
/// Rays whose cosine to the normal is not above this number are not used to fit a rectangle.
constexpr double kMinCosine = 0.1;

/// This part of the crossings may lie outside the rectangle on each of its four sides, because it
/// may belong to other openings.
constexpr double kTrimmed = 0.01;
/// Crossings are divided where a gap is larger than this part of their extent.
constexpr double kGap = 0.15;
/// Crossings beside the rectangle by up to this part of its size belong to the same opening.
constexpr double kBeside = 0.05;
/// A portal is larger than the rectangle of its crossings. At both ends of an axis, two margins are
/// added: the part kMargin of the size along this axis, and kMarginInRays times the mean distance
/// between neighbouring crossings along this axis.
constexpr double kMargin = 0.01;
constexpr double kMarginInRays = 4;

/// A family of parallel planes, described by unit vectors that are perpendicular to each other.
/// Rays cross the planes in the direction of `normal`.
struct Planes {
  Vec3 normal;
  Vec3 u;
  Vec3 v;
};

using Rays = std::vector<const ScatteredRay*>;

/// A closed interval of coordinates.
struct Bounds {
  double low = 0;
  double high = 0;
  double size() const { return high - low; }
  bool has(double value) const { return value >= low && value <= high; }
};

/// A rectangle in one of the planes.
struct Rectangle {
  double offset = 0;  ///< of the plane: dot(point, normal)
  Bounds u;
  Bounds v;
  double area() const { return u.size() * v.size(); }
};

/// Returns the distance at which the ray crosses the plane. It is negative if the plane is behind
/// the ray's origin.
double distance_to(const ScatteredRay& ray, const Planes& planes, double offset) {
  return (offset - dot(ray.origin, planes.normal)) / dot(ray.direction, planes.normal);
}

/// Returns the coordinate along `axis` at which the ray crosses the plane.
double crossing(const ScatteredRay& ray, const Planes& planes, double offset, const Vec3& axis) {
  return dot(ray.origin, axis) + distance_to(ray, planes, offset) * dot(ray.direction, axis);
}

/// Returns the interval of the values, without the part `part` of the values at each end. Reorders
/// the values.
Bounds trimmed(std::vector<double>& values, double part) {
  const auto skip = static_cast<std::ptrdiff_t>(part * static_cast<double>(values.size()));
  std::nth_element(values.begin(), values.begin() + skip, values.end());
  const double low = values[static_cast<std::size_t>(skip)];
  std::nth_element(values.begin(), values.end() - 1 - skip, values.end());
  return {low, values[values.size() - 1 - static_cast<std::size_t>(skip)]};
}

/// Returns the coordinates along `axis` at which the rays cross the plane at `offset`.
std::vector<double> crossings(const Rays& rays, const Planes& planes, double offset,
                              const Vec3& axis) {
  std::vector<double> out;
  out.reserve(rays.size());
  for (const ScatteredRay* ray : rays) {
    out.push_back(crossing(*ray, planes, offset, axis));
  }
  return out;
}

/// Returns the rectangle of the rays' crossings with the plane at `offset`. On each side, the part
/// kTrimmed of the crossings is left outside.
Rectangle rectangle_at(const Rays& rays, const Planes& planes, double offset) {
  std::vector<double> u = crossings(rays, planes, offset, planes.u);
  std::vector<double> v = crossings(rays, planes, offset, planes.v);
  return {offset, trimmed(u, kTrimmed), trimmed(v, kTrimmed)};
}

/// Returns the smallest rectangle through which nearly all of the rays pass. The extents of the
/// crossings are convex functions of the offset, so the search by golden sections finds the
/// smallest sum of them.
Rectangle smallest_rectangle(const Rays& rays, const Planes& planes) {
  std::vector<double> starts;
  for (const ScatteredRay* ray : rays) {
    starts.push_back(dot(ray->origin, planes.normal));
  }
  const Bounds all = trimmed(starts, 0);
  // Rays that start in the room start before the opening. Other rays may start beyond it.
  double low = all.low;
  double high = all.high + all.size();
  constexpr int kSteps = 32;
  constexpr double kGolden = 0.6180339887498949;
  const auto extent = [&](double offset) {
    const Rectangle at = rectangle_at(rays, planes, offset);
    return at.u.size() + at.v.size();
  };
  double a = high - kGolden * (high - low);
  double b = low + kGolden * (high - low);
  double at_a = extent(a);
  double at_b = extent(b);
  for (int i = 0; i < kSteps; ++i) {
    if (at_a < at_b) {
      high = b;
      b = a;
      at_b = at_a;
      a = high - kGolden * (high - low);
      at_a = extent(a);
    } else {
      low = a;
      a = b;
      at_a = at_b;
      b = low + kGolden * (high - low);
      at_b = extent(b);
    }
  }
  return rectangle_at(rays, planes, (low + high) / 2);
}

/// Divides the rays where their crossings along one of the axes have gaps, and returns the parts
/// with at least kMinRays rays.
std::vector<Rays> divided(const Rays& rays, const Planes& planes, double offset) {
  std::vector<Rays> done;
  // Parts that may have to be divided, each with the number of axes along which it has no gap.
  std::vector<std::pair<Rays, int>> open = {{rays, 0}};
  while (!open.empty()) {
    auto [part, undivided] = std::move(open.back());
    open.pop_back();
    if (part.size() < kMinRays) {
      continue;
    }
    if (undivided == 2) {
      done.push_back(std::move(part));
      continue;
    }
    const Vec3& axis = undivided == 0 ? planes.u : planes.v;
    std::stable_sort(part.begin(), part.end(), [&](const ScatteredRay* x, const ScatteredRay* y) {
      return crossing(*x, planes, offset, axis) < crossing(*y, planes, offset, axis);
    });
    std::vector<double> sorted = crossings(part, planes, offset, axis);
    const double extent = sorted.back() - sorted.front();
    std::size_t from = 0;
    for (std::size_t i = 1; i < sorted.size(); ++i) {
      if (sorted[i] - sorted[i - 1] > kGap * extent) {
        const auto begin = part.begin();
        open.emplace_back(
            Rays(begin + static_cast<std::ptrdiff_t>(from), begin + static_cast<std::ptrdiff_t>(i)),
            0);
        from = i;
      }
    }
    if (from == 0) {
      open.emplace_back(std::move(part), undivided + 1);
    } else {
      open.emplace_back(Rays(part.begin() + static_cast<std::ptrdiff_t>(from), part.end()), 0);
    }
  }
  return done;
}

/// Returns the normals of planes in which openings may lie: the axes, and the normals that more
/// than 1/32 of the considered surfaces have.
std::vector<Vec3> candidate_normals(absl::Span<const ScatteredRay> rays) {
  std::vector<Vec3> normals = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  constexpr std::size_t kConsidered = 1024;
  std::vector<Vec3> left;
  const std::size_t stride = std::max<std::size_t>(1, rays.size() / kConsidered);
  for (std::size_t i = 0; i < rays.size(); i += stride) {
    left.push_back(rays[i].normal);
  }
  const std::size_t frequent = left.size() / 32;
  const auto remove = [&](const Vec3& normal) {
    left.erase(std::remove_if(left.begin(), left.end(),
                              [&](const Vec3& other) {
                                return std::abs(dot(normal, other)) > kSameDirection;
                              }),
               left.end());
  };
  for (const Vec3& axis : normals) {
    remove(axis);
  }
  while (normals.size() < kMaxNormals && !left.empty()) {
    const Vec3 normal = left.front();
    const std::size_t before = left.size();
    remove(normal);
    if (before - left.size() > frequent) {
      normals.push_back(normal);
    }
  }
  return normals;
}

/// Returns planes with this normal. Of the vectors `normals`, the one that is most perpendicular to
/// `normal` is made exactly perpendicular to it and becomes the axis u.
Planes planes_of(const Vec3& normal, const std::vector<Vec3>& normals) {
  Vec3 best = normals[0];
  for (const Vec3& other : normals) {
    if (std::abs(dot(other, normal)) < std::abs(dot(best, normal)) - 1e-6) {
      best = other;
    }
  }
  const Vec3 u = normalize(best - normal * dot(best, normal));
  return {normal, u, cross(normal, u)};
}

/// Returns the portal of these rays, nearly all of which pass through the rectangle. The portal
/// holds all crossings in the rectangle and a little beside it. It has a margin, because the border
/// of an opening is farther outside than any of the few rays. Light beside a portal would be found
/// by BSDF sampling alone, which shows as bright dots.
Portal portal_of(const Rays& rays, const Rectangle& rectangle, const Planes& planes) {
  const auto widened = [](const Bounds& of, double by) {
    return Bounds{of.low - by * of.size(), of.high + by * of.size()};
  };
  const Bounds near_u = widened(rectangle.u, kBeside);
  const Bounds near_v = widened(rectangle.v, kBeside);
  Bounds u = rectangle.u;
  Bounds v = rectangle.v;
  for (const ScatteredRay* ray : rays) {
    const double at_u = crossing(*ray, planes, rectangle.offset, planes.u);
    const double at_v = crossing(*ray, planes, rectangle.offset, planes.v);
    if (near_u.has(at_u) && near_v.has(at_v)) {
      u = {std::min(u.low, at_u), std::max(u.high, at_u)};
      v = {std::min(v.low, at_v), std::max(v.high, at_v)};
    }
  }
  const double margin = kMargin + kMarginInRays / static_cast<double>(rays.size());
  u = widened(u, margin);
  v = widened(v, margin);
  return {planes.normal * rectangle.offset + planes.u * u.low + planes.v * v.low,
          planes.u * u.size(), planes.v * v.size()};
}

/// Returns the offsets of the planes of walls. They are the most frequent offsets of surfaces that
/// have this normal or its opposite. `size` is the size of the scene.
std::vector<double> offsets_of_walls(absl::Span<const ScatteredRay> rays, const Vec3& normal,
                                     double size) {
  std::vector<double> offsets;
  for (const ScatteredRay& ray : rays) {
    if (std::abs(dot(ray.normal, normal)) > kSameDirection) {
      offsets.push_back(dot(ray.origin, normal));
    }
  }
  std::sort(offsets.begin(), offsets.end());
  std::vector<std::pair<std::size_t, double>> walls;  // number of rays, offset
  for (std::size_t first = 0, i = 1; i <= offsets.size(); ++i) {
    if (i == offsets.size() || offsets[i] - offsets[i - 1] > kThickness * size) {
      walls.emplace_back(i - first, offsets[(first + i) / 2]);
      first = i;
    }
  }
  std::stable_sort(walls.begin(), walls.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  walls.resize(std::min(walls.size(), kMaxWalls));
  std::vector<double> out;
  for (const auto& [count, offset] : walls) {
    if (count > kMinPartOfWall * static_cast<double>(rays.size())) {
      out.push_back(offset);
    }
  }
  return out;
}

/// A portal, and how many of the escaping rays pass through it.
struct Found {
  Portal portal;
  std::size_t escaping = 0;
  double precision = 0;  ///< part of the rays through the portal that escape
  double score() const { return static_cast<double>(escaping) * precision; }
};

/// Counts the rays that pass through the portal, and those of them that escape.
Found judge(const Portal& portal, absl::Span<const ScatteredRay> rays) {
  Found found{.portal = portal};
  std::size_t all = 0;
  for (const ScatteredRay& ray : rays) {
    if (portal.passes(ray.origin, ray.direction)) {
      ++all;
      found.escaping += ray.escapes ? 1 : 0;
    }
  }
  found.precision = all > 0 ? static_cast<double>(found.escaping) / static_cast<double>(all) : 0;
  return found;
}

/// The input of the search for one portal.
struct Search {
  absl::Span<const ScatteredRay> rays;
  Box box;  ///< of all places from which rays start, a little larger; openings lie in it
  std::vector<Planes> planes;
  std::vector<std::vector<double>> walls;  ///< offsets of walls in each of the planes
};

/// Makes the input of the search from the rays: the box around their origins, and for both sides of
/// each candidate normal the planes to search and the walls that have this normal.
Search search_of(absl::Span<const ScatteredRay> rays) {
  Search search{rays, {}, {}, {}};
  for (const ScatteredRay& ray : rays) {
    search.box.add(ray.origin);
  }
  const double size = max_abs(search.box.hi - search.box.lo);
  const double margin = kMarginOfBox * size;
  search.box.lo = search.box.lo - Vec3{margin, margin, margin};
  search.box.hi = search.box.hi + Vec3{margin, margin, margin};
  const std::vector<Vec3> normals = candidate_normals(rays);
  for (const Vec3& normal : normals) {
    for (const Vec3& side : {normal, -normal}) {
      search.planes.push_back(planes_of(side, normals));
      search.walls.push_back(offsets_of_walls(rays, side, size));
    }
  }
  return search;
}

bool is_inside(const Box& box, const Vec3& point) {
  return point.x >= box.lo.x && point.x <= box.hi.x && point.y >= box.lo.y && point.y <= box.hi.y &&
         point.z >= box.lo.z && point.z <= box.hi.z;
}

/// Returns the rays that cross the plane ahead of them, at a place within the box.
Rays crossing_in_box(const Rays& rays, const Planes& planes, double offset, const Box& box) {
  Rays out;
  for (const ScatteredRay* ray : rays) {
    const double distance = distance_to(*ray, planes, offset);
    if (distance > 0 && is_inside(box, ray->origin + ray->direction * distance)) {
      out.push_back(ray);
    }
  }
  return out;
}

/// Returns the portal with the highest Found::score(); std::nullopt if there is no candidate.
/// Candidates are fitted to the rays `escaping`.
std::optional<Found> best_portal(const Rays& escaping, const Search& search) {
  std::optional<Found> best;
  const auto consider = [&](const Rays& rays, const Rectangle& rectangle, const Planes& planes) {
    // Hardly any escaping ray besides `rays` passes through the portal that is fitted to `rays`. So
    // the number of `rays` limits the score of this portal.
    const bool may_be_best = !best || static_cast<double>(rays.size()) > 0.9 * best->score();
    if (!may_be_best || !(rectangle.area() > 0)) {
      return;
    }
    const Found found = judge(portal_of(rays, rectangle, planes), search.rays);
    if (!best || found.score() > best->score()) {
      best = found;
    }
  };
  for (std::size_t i = 0; i < search.planes.size(); ++i) {
    const Planes& planes = search.planes[i];
    Rays outwards;
    for (const ScatteredRay* ray : escaping) {
      if (dot(ray->direction, planes.normal) > kMinCosine) {
        outwards.push_back(ray);
      }
    }
    if (outwards.size() < kMinRays) {
      continue;
    }
    std::vector<double> offsets = search.walls[i];
    offsets.push_back(smallest_rectangle(outwards, planes).offset);
    for (const double offset : offsets) {
      for (const Rays& part :
           divided(crossing_in_box(outwards, planes, offset, search.box), planes, offset)) {
        consider(part, rectangle_at(part, planes, offset), planes);
        consider(part, smallest_rectangle(part, planes), planes);
      }
    }
  }
  return best;
}

}  // namespace

double escaping_part(absl::Span<const ScatteredRay> rays) {
  const auto count =
      std::count_if(rays.begin(), rays.end(), [](const ScatteredRay& ray) { return ray.escapes; });
  return rays.empty() ? 0 : static_cast<double>(count) / static_cast<double>(rays.size());
}

Portals portals_of(absl::Span<const ScatteredRay> rays) {
  Rays escaping;
  for (const ScatteredRay& ray : rays) {
    if (ray.escapes) {
      escaping.push_back(&ray);
    }
  }
  const double part = escaping_part(rays);
  if (escaping.size() < kMinRays || part > kMaxEscaping) {
    return {};
  }
  const auto least = static_cast<std::size_t>(
      std::max<double>(kMinRays, kMinPart * static_cast<double>(escaping.size())));
  const Search search = search_of(rays);
  std::vector<Portal> portals;
  while (portals.size() < Portals::kMaxPortals && escaping.size() >= least) {
    const std::optional<Found> best = best_portal(escaping, search);
    if (!best || best->precision < kMinPrecision || best->precision < kMinLift * part) {
      break;
    }
    const std::size_t before = escaping.size();
    escaping.erase(std::remove_if(escaping.begin(), escaping.end(),
                                  [&](const ScatteredRay* ray) {
                                    return best->portal.passes(ray->origin, ray->direction);
                                  }),
                   escaping.end());
    if (before - escaping.size() < least) {
      break;
    }
    portals.push_back(best->portal);
  }
  return Portals(std::move(portals));
}

}  // namespace bandsaw
