// Builds the photon map. A first tree divides space into places, and the radii of the disks follow
// from the density of the photons in each place (with_disks). A second tree, with boxes around the
// disks, finds the photons whose disks contain a point (PhotonMap::add_node).

#include "renderlib/guiding/photon_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "renderlib/base/split_mix.h"
#include "renderlib/guiding/guiding_record.h"
#include "renderlib/sampling/sampler.h"

namespace bandsaw {
namespace {

// Radii are found in a tree of places: boxes of space that are divided while they have more than
// kPhotonsOfLeaf photons.
constexpr std::uint32_t kPhotonsOfLeaf = 8;
/// The area that a photon occupies is estimated from at least this many photons.
constexpr std::uint32_t kEnoughPhotons = 16;
/// Bounds the recursion where many photons are at nearly the same point.
constexpr int kMaxTreeDepth = 48;
/// A place is divided at a random point of its longest side: between kFirstPart and 1 - kFirstPart
/// of the length.
constexpr double kFirstPart = 3.0 / 8;
/// In even places (defined at kDeviations) of at most kMaxPhotonsOfEven photons, each disk has the
/// part kDiskPartOfEven of the area of its place.
constexpr std::uint32_t kMaxPhotonsOfEven = 1024;
constexpr double kDiskPartOfEven = 1.0 / 4;
// A place is even if its photons are nearly uniform on a flat surface. This is so if two conditions
// hold for the place and for all places into which it is divided. First, the difference between the
// powers of its two parts deviates from the difference that is expected of uniform photons by at
// most kDeviations standard deviations plus kSlope times the sum of both powers. Second, the sum of
// the normals is at least kMinFlatness times as long as it would be for equal normals. A place that
// is not divided counts as even.
constexpr double kDeviations = 3.5;
constexpr double kSlope = 0.1;
constexpr double kMinFlatness = 0.97;
/// In an even place one photon replaces a group of photons. The groups are so small that a point
/// still lies in about this many disks.
constexpr double kDisksAtPoint = 10;
/// The largest radius at a radius factor of 1, as a part of the diagonal of the box of all photons.
constexpr double kLargestDisk = 1.0 / 16;

/// A box of space; it begins empty.
struct Box {
  Float3 low{std::numeric_limits<float>::max(), std::numeric_limits<float>::max(),
             std::numeric_limits<float>::max()};
  Float3 high{std::numeric_limits<float>::lowest(), std::numeric_limits<float>::lowest(),
              std::numeric_limits<float>::lowest()};

  /// Extends the box so that it contains the box from `from` to `to`.
  void add(const Float3& from, const Float3& to) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], from[axis]);
      high[axis] = std::max(high[axis], to[axis]);
    }
  }
  double extent(std::size_t axis) const { return double{high[axis]} - low[axis]; }
  std::size_t longest_axis() const {
    const double x = extent(0);
    const double y = extent(1);
    const double z = extent(2);
    return x >= y && x >= z ? 0 : y >= z ? 1 : 2;
  }
};

Box box_of(absl::Span<const StoredPhoton> photons) {
  Box box;
  for (const StoredPhoton& photon : photons) {
    box.add(photon.position, photon.position);
  }
  return box;
}

/// Returns a box around the disks of the photons. It is a little larger, because of rounding.
Box box_of_disks(absl::Span<const StoredPhoton> photons) {
  constexpr float kMost = std::numeric_limits<float>::infinity();
  Box box;
  for (const StoredPhoton& photon : photons) {
    Float3 low = photon.position;
    Float3 high = photon.position;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::nextafter(low[axis] - photon.radius * 1.001f, -kMost);
      high[axis] = std::nextafter(high[axis] + photon.radius * 1.001f, kMost);
    }
    box.add(low, high);
  }
  return box;
}

/// Returns the area of the surface in the box: the product of the two longer sides of the box. The
/// surface is taken to be flat.
double area_of(const Box& box) {
  const double x = box.extent(0);
  const double y = box.extent(1);
  const double z = box.extent(2);
  return std::max({x * y, y * z, z * x});
}

/// A node of the tree from which the radii of the disks are found.
struct Place {
  std::uint32_t first = 0;  ///< photons [first, last)
  std::uint32_t last = 0;
  std::uint32_t next = 0;  ///< the place after all descendants
  double area = 0;         ///< area that a photon occupies; an ancestor's if few photons are here
  double power = 0;        ///< sum of the luminances
  double squares = 0;      ///< sum of the squared luminances
  Vec3 normal;             ///< sum of the normals, by luminance
  bool even = false;       ///< true for an even place, as defined at kDeviations

  std::uint32_t count() const { return last - first; }
};

/// Divides the photons [first, last) at the part `part`, in (0, 1), of the longest side of their
/// box, and sorts them accordingly. Returns the number of the first photon of the second part.
/// Returns std::nullopt if there are at most kPhotonsOfLeaf photons, if they are all at one point,
/// or at the maximum depth.
std::optional<std::uint32_t> divide(std::vector<StoredPhoton>& photons, std::uint32_t first,
                                    std::uint32_t last, int depth, const Box& box,
                                    float part = 0.5f) {
  const std::size_t axis = box.longest_axis();
  const float middle = box.low[axis] * (1 - part) + box.high[axis] * part;
  // In a box that is a few units in the last place wide, `middle` may be rounded to above the box.
  const bool divides = middle > box.low[axis] && middle <= box.high[axis];
  if (last - first <= kPhotonsOfLeaf || depth >= kMaxTreeDepth || !divides) {
    return std::nullopt;
  }
  const auto half = std::stable_partition(
      photons.begin() + static_cast<std::ptrdiff_t>(first),
      photons.begin() + static_cast<std::ptrdiff_t>(last),
      [&](const StoredPhoton& photon) { return photon.position[axis] < middle; });
  return static_cast<std::uint32_t>(half - photons.begin());
}

/// Adds the place of photons [first, last) and its descendants, in depth-first order, and sorts the
/// photons accordingly. `area` is the area that a photon occupies in the parent. `seed` determines
/// the random points at which places are divided. Radii differ on the two sides of such a point.
/// The points are random so that the steps of the radius do not add up to a visible line over
/// several maps.
void add_places(std::vector<StoredPhoton>& photons, std::uint32_t first, std::uint32_t last,
                int depth, double area, std::uint64_t seed, std::vector<Place>& places) {
  const absl::Span<const StoredPhoton> own(photons.data() + first, last - first);
  const Box box = box_of(own);
  Place place{.first = first, .last = last, .area = area, .normal = {}};
  // Few photons, or photons at one point, do not show an area. Their place keeps the parent's area.
  if (own.size() >= kEnoughPhotons && area_of(box) > 0) {
    // The outermost photons lie on the sides of the box. So the box has the area of one photon less
    // than it contains.
    place.area = area_of(box) / static_cast<double>(own.size() - 1);
  }
  const std::size_t number = places.size();
  places.push_back(place);
  const double part =
      kFirstPart + (1 - 2 * kFirstPart) * NumberStream(seed ^ split_mix(number + 1)).next();
  if (const auto half = divide(photons, first, last, depth, box, static_cast<float>(part))) {
    add_places(photons, first, *half, depth + 1, place.area, seed, places);
    const std::size_t second = places.size();
    add_places(photons, *half, last, depth + 1, place.area, seed, places);
    const Place& a = places[number + 1];
    const Place& b = places[second];
    place.power = a.power + b.power;
    place.squares = a.squares + b.squares;
    place.normal = a.normal + b.normal;
    place.even = a.even && b.even && length(place.normal) >= kMinFlatness * place.power &&
                 2 * std::abs(a.power - part * place.power) <=
                     kDeviations * std::sqrt(place.squares) + kSlope * place.power;
  } else {
    for (const StoredPhoton& photon : own) {
      const double power = luminance(photon.power);
      place.power += power;
      place.squares += power * power;
      place.normal = place.normal + vec3(photon.normal) * power;
    }
    place.even = true;
  }
  place.next = static_cast<std::uint32_t>(places.size());
  places[number] = place;
}

/// Photons that get a box.
struct Range {
  std::uint32_t first;
  std::uint32_t last;
  int depth;  ///< number of divisions of space so far

  std::uint32_t photons() const { return last - first; }
};

/// Divides the photons of `all` into up to `most` ranges, and sorts them accordingly. The range
/// with the most photons is divided until there are `most` ranges or all are leaves.
std::vector<Range> divide_into(std::size_t most, std::vector<StoredPhoton>& photons,
                               const Range& all) {
  const auto by_photons = [](const Range& a, const Range& b) { return a.photons() < b.photons(); };
  std::vector<Range> ranges{all};
  while (ranges.size() < most) {
    const auto largest = std::max_element(ranges.begin(), ranges.end(), by_photons);
    if (largest->photons() <= kPhotonsOfLeaf) {
      break;
    }
    const Range range = *largest;
    const Box box = box_of({photons.data() + range.first, range.photons()});
    const auto half = divide(photons, range.first, range.last, range.depth, box);
    // Photons that space cannot divide keep their order.
    const std::uint32_t middle = half.value_or(range.first + range.photons() / 2);
    const int below = half ? range.depth + 1 : kMaxTreeDepth;
    *largest = {range.first, middle, below};
    ranges.insert(largest + 1, {middle, range.last, below});
  }
  return ranges;
}

/// Returns one of the photons, chosen with a probability in proportion to its power. The chosen
/// photon gets the power of the whole group. It can replace the group where the photons are close
/// together compared with their disks.
StoredPhoton stand_in(absl::Span<const StoredPhoton> photons, std::uint64_t seed) {
  double total = 0;
  for (const StoredPhoton& photon : photons) {
    total += luminance(photon.power);
  }
  double left = NumberStream(seed).next() * total;
  std::size_t chosen = 0;
  while (chosen + 1 < photons.size() && left >= luminance(photons[chosen].power)) {
    left -= luminance(photons[chosen].power);
    ++chosen;
  }
  StoredPhoton one = photons[chosen];
  one.power = one.power * static_cast<float>(total / luminance(one.power));
  return one;
}

/// Returns the photons with their radii. Where photons are close together compared with their
/// disks, one of them replaces the whole group.
std::vector<StoredPhoton> with_disks(std::vector<StoredPhoton> photons, double radius_factor,
                                     std::uint64_t seed) {
  std::vector<Place> places;
  // There is one tree for each main direction of the normals, so the walls of a corner are in
  // different trees.
  auto from = photons.begin();
  for (std::uint32_t side = 0; side < 6 && from != photons.end(); ++side) {
    const auto to = std::stable_partition(from, photons.end(), [&](const StoredPhoton& photon) {
      return side_of(vec3(photon.normal)) == side;
    });
    if (from != to) {
      add_places(photons, static_cast<std::uint32_t>(from - photons.begin()),
                 static_cast<std::uint32_t>(to - photons.begin()), /*depth=*/0, /*area=*/kInfinity,
                 seed, places);
    }
    from = to;
  }
  const Box all = box_of(photons);
  const double largest =
      kLargestDisk * radius_factor * length(Vec3{all.extent(0), all.extent(1), all.extent(2)});
  std::vector<StoredPhoton> out;
  const auto radius_of = [&](double area) {
    const double wanted = radius_factor * std::sqrt(area / kPi);
    return std::max(std::min(wanted, largest), 1e-6 * largest);
  };
  double even_radius = 0;   // of the current even place
  double replaced = 0;      // number of photons that one photon may replace in this place
  std::uint32_t until = 0;  // end of the current even place
  for (std::uint32_t i = 0; i < places.size();) {
    const Place& place = places[i];
    if (i >= until && place.even && place.count() >= kEnoughPhotons &&
        place.count() <= kMaxPhotonsOfEven) {
      even_radius = radius_of(std::max(PhotonMap::kPhotonsOfDisk, place.count() * kDiskPartOfEven) *
                              place.area);
      replaced = kPi * even_radius * even_radius / (place.area * kDisksAtPoint);
      until = place.next;
    }
    const bool even = i < until;
    const bool is_leaf = place.next == i + 1;
    if (!is_leaf && !(even && place.count() <= replaced)) {
      ++i;
      continue;
    }
    const auto radius =
        static_cast<float>(even ? even_radius : radius_of(PhotonMap::kPhotonsOfDisk * place.area));
    const absl::Span<const StoredPhoton> own(photons.data() + place.first, place.count());
    const std::size_t first = out.size();
    if (even && place.count() <= replaced) {
      out.push_back(stand_in(own, seed + place.first));
    } else {
      out.insert(out.end(), own.begin(), own.end());
    }
    for (std::size_t at = first; at < out.size(); ++at) {
      out[at].radius = radius;
    }
    i = place.next;
  }
  return out;
}

}  // namespace

PhotonMap::PhotonMap(std::vector<StoredPhoton> photons, const Vec3& origin, double radius_factor,
                     std::uint64_t seed, Pool& pool,
                     absl::FunctionRef<double(StoredPhoton&)> share_on_surface)
    : origin_(origin) {
  if (photons.empty()) {
    return;
  }
  photons_ = with_disks(std::move(photons), radius_factor, seed);
  constexpr std::size_t kRun = 1024;  // photons that a thread takes at a time
  const std::size_t runs = (photons_.size() + kRun - 1) / kRun;
  pool.parallel_for(static_cast<std::int64_t>(runs), [&](std::int64_t run) {
    const auto first = static_cast<std::size_t>(run) * kRun;
    for (std::size_t i = first; i < std::min(first + kRun, photons_.size()); ++i) {
      photons_[i].power = photons_[i].power * static_cast<float>(1 / share_on_surface(photons_[i]));
    }
  });
  Box all;
  add_node(0, static_cast<std::uint32_t>(photons_.size()), 0, all.low, all.high);
  for (std::vector<float>& row : disks_) {
    row.reserve(photons_.size() + kWidth);
  }
  for (const StoredPhoton& photon : photons_) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      disks_[axis].push_back(photon.position[axis]);
    }
    disks_[3].push_back(photon.radius * photon.radius);
  }
  for (std::vector<float>& row : disks_) {
    row.resize(photons_.size() + kWidth);
  }
}

void PhotonMap::add_node(std::uint32_t first, std::uint32_t last, int depth, Float3& low,
                         Float3& high) {
  static_assert(kPhotonsOfLeaf <= kWidth);
  const std::vector<Range> ranges = divide_into(kWidth, photons_, {first, last, depth});
  const std::size_t number = nodes_.size();
  Node& empty = nodes_.emplace_back();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    empty.bounds[axis].fill(std::numeric_limits<float>::infinity());
    empty.bounds[axis + 3].fill(-std::numeric_limits<float>::infinity());
  }
  Box all;
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const Range& range = ranges[i];
    const bool is_leaf = range.photons() <= kPhotonsOfLeaf;
    const auto next = static_cast<std::uint32_t>(nodes_.size());
    Box box;
    if (is_leaf) {
      box = box_of_disks({photons_.data() + range.first, range.photons()});
    } else {
      add_node(range.first, range.last, range.depth, box.low, box.high);
    }
    Node& node = nodes_[number];
    node.children[i] = is_leaf ? Child{range.first, range.photons()} : Child{next, 0};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      node.bounds[axis][i] = box.low[axis];
      node.bounds[axis + 3][i] = box.high[axis];
    }
    all.add(box.low, box.high);
  }
  low = all.low;
  high = all.high;
}

}  // namespace bandsaw
