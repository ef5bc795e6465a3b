// Places a ring of vertices at each point of the profile, or two rings where an edge stays sharp,
// and joins neighbouring rings by faces.

#include "renderlib/gallery/lathe.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "renderlib/base/check.h"
#include "renderlib/math/elementary.h"

namespace bandsaw::gallery {
namespace {

double dot2(const Vec2& a, const Vec2& b) { return a.x * b.x + a.y * b.y; }
Vec2 minus(const Vec2& a, const Vec2& b) { return a + b * -1; }
Vec2 unit(const Vec2& a) { return a * (1 / std::sqrt(dot2(a, a))); }

/// A ring of vertices around the y axis.
struct Ring {
  Vec2 at;       ///< radius and height
  Vec2 normal;   ///< its radial and its vertical component
  double v = 0;  ///< of the uv coordinates
};

/// The rings of a profile's pieces (the lines between consecutive points). Piece i lies between the
/// rings low[i] and low[i] + 1. Two pieces that join smoothly share a ring.
struct Rings {
  std::vector<Ring> rings;
  std::vector<std::size_t> low;
};

/// Returns the rings of the profile. Two pieces that meet at less than 40 degrees share a ring,
/// with the mean of their normals. At a sharper edge the two pieces do not share a ring.
Rings rings_of(absl::Span<const Vec2> profile) {
  constexpr double kSmooth = 0.766;  // the cosine of 40 degrees
  std::vector<Vec2> normals;
  std::vector<double> reached = {0};  // length of the profile up to each point
  for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
    const Vec2 along = minus(profile[i + 1], profile[i]);
    reached.push_back(reached.back() + std::sqrt(dot2(along, along)));
    normals.push_back(unit({along.y, -along.x}));
  }
  const auto smooth = [&](std::size_t i) { return dot2(normals[i], normals[i + 1]) > kSmooth; };
  Rings out;
  for (std::size_t i = 0; i < normals.size(); ++i) {
    if (i == 0 || !smooth(i - 1)) {
      out.rings.push_back({profile[i], normals[i], reached[i] / reached.back()});
    }
    out.low.push_back(out.rings.size() - 1);
    const bool shared = i + 1 < normals.size() && smooth(i);
    out.rings.push_back({profile[i + 1], shared ? unit(normals[i] + normals[i + 1]) : normals[i],
                         reached[i + 1] / reached.back()});
  }
  return out;
}

/// Adds the vertices of a ring. The first vertex and the last one are at the same place, but differ
/// in uv.
void append_ring(std::string& out, const Ring& ring, int around) {
  for (int i = 0; i <= around; ++i) {
    const double turn = static_cast<double>(i) / around;
    const SinCos angle = sincos_turns(turn);
    absl::StrAppendFormat(&out, "v %.4f %.4f %.4f\nvn %.3f %.3f %.3f\nvt %.4g %.4g\n",
                          ring.at.x * angle.cos, ring.at.y, -ring.at.x * angle.sin,
                          ring.normal.x * angle.cos, ring.normal.y, -ring.normal.x * angle.sin,
                          turn, ring.v);
  }
}

std::string corner(int vertex) { return absl::StrCat(" ", vertex, "/", vertex, "/", vertex); }

/// Adds the faces between the rings whose vertices begin at `low` and `high`. The faces are quads,
/// or triangles where a ring lies on the axis.
void append_faces(std::string& out, int low, int high, bool low_on_axis, bool high_on_axis,
                  int around) {
  for (int i = 0; i < around; ++i) {
    absl::StrAppend(&out, "f", corner(low + i));
    if (!low_on_axis) {
      absl::StrAppend(&out, corner(low + i + 1));
    }
    absl::StrAppend(&out, corner(high + i + 1));
    if (!high_on_axis) {
      absl::StrAppend(&out, corner(high + i));
    }
    absl::StrAppend(&out, "\n");
  }
}

}  // namespace

std::string lathe_obj(absl::Span<const Vec2> profile, int around) {
  BANDSAW_CHECK(profile.size() >= 2 && around >= 3,
                "lathe_obj() needs at least 2 points, and 3 faces for a ring");
  const Rings turned = rings_of(profile);
  std::string out = "# Turned by bandsaw-gallery.\n";
  for (const Ring& ring : turned.rings) {
    append_ring(out, ring, around);
  }
  for (const std::size_t ring : turned.low) {
    const int low = 1 + static_cast<int>(ring) * (around + 1);
    append_faces(out, low, low + around + 1, turned.rings[ring].at.x == 0,
                 turned.rings[ring + 1].at.x == 0, around);
  }
  return out;
}

std::vector<Vec2> smooth_profile(absl::Span<const Vec2> corners, int steps) {
  BANDSAW_CHECK(corners.size() >= 2 && steps >= 1,
                "smooth_profile() needs at least 2 corners, and 1 step");
  const auto at = [&](std::size_t i) { return corners[std::min(i, corners.size() - 1)]; };
  std::vector<Vec2> points;
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    const Vec2 before = at(i == 0 ? 0 : i - 1);
    const Vec2 after = at(i + 2);
    for (int step = 0; step < steps; ++step) {
      const double t = static_cast<double>(step) / steps;
      const Vec2 slope0 = minus(at(i + 1), before) * 0.5;
      const Vec2 slope1 = minus(after, at(i)) * 0.5;
      // A cubic Hermite curve from at(i) to at(i + 1) with these slopes.
      const double s = 1 - t;
      Vec2 p = at(i) * (s * s * (1 + 2 * t)) + slope0 * (s * s * t) +
               at(i + 1) * (t * t * (3 - 2 * t)) + slope1 * (-s * t * t);
      p.x = std::max(p.x, 0.0);
      points.push_back(p);
    }
  }
  points.push_back(corners.back());
  return points;
}

}  // namespace bandsaw::gallery
