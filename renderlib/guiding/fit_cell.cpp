// Fits the balls of a cell (guiding_cell.h) to its records. A record is light that arrived at a
// point, and a ball is a region of space from which a part of the light comes. The directions of
// the light, as seen from the cell's middle, begin as one cluster. Clusters are split as long as a
// split explains the records better. Each cluster that is not too wide becomes a ball. Then
// cross-validation finds the share of the directions that should be sampled towards the balls.

#include <algorithm>
#include <cmath>
#include <limits>

#include "renderlib/guiding/guiding_cell.h"
#include "renderlib/math/constants.h"
#include "renderlib/math/elementary.h"

namespace bandsaw {
namespace {

/// Minimum number of records with light in a cell, and in each ball if a cell has several.
constexpr std::size_t kMinRecordsOfCell = 8;
constexpr std::size_t kMinRecordsOfBall = 6;

/// Shares of guided directions to choose from.
constexpr std::array<double, 4> kShares = {0.125, 0.25, 0.375, 0.5};

/// Largest 1 - cos of the half-angle of a cone that becomes a ball. Wider cones are left to BSDF
/// sampling, because a large part of them would lie below the surface.
constexpr double kWidest = 0.5;

/// A single record has at most this share of a cell's light, so that a path that found a small lamp
/// by chance does not determine the cell alone.
constexpr double kMaxShareOfRecord = 0.1;

/// A cluster is split only if the split raises the mean logarithm of the pdf by more than this
/// number divided by the effective number of records. Without this limit, the clusters would fit
/// the noise of few records.
constexpr double kMinSplitGain = 3;

/// Share of its weight that a cluster keeps when it is split.
constexpr double kKept = 0.25;

/// Light as seen from the middle of the cell.
struct Seen {
  Vec3 direction;      ///< unit
  double inverse = 0;  ///< 1 / distance
  double weight = 0;
};

/// A cone around some of the directions: those with numbers in [first, last).
struct Cluster {
  std::size_t first = 0;
  std::size_t last = 0;
  double weight = 0;
  Vec3 axis;                 ///< unit
  double inverse = 0;        ///< mean of the inverse distances
  double one_minus_cos = 2;  ///< 1 - cos of the cone's half-angle
};

/// A split of a cluster into two parts: the directions whose component `axis` is below `at`, and
/// the other directions.
struct Split {
  double gain = 0;  ///< by how much it raises the sum of the scores; 0: there is no split
  int axis = 0;
  double at = 0;
};

/// The place of a cell: the middle of its records, their extent, and the irradiance that a record
/// of weight 1 adds.
struct Place {
  Vec3 middle;
  Vec3 normal;         ///< mean, unit
  double extent2 = 0;  ///< mean squared distance from the middle
  double irradiance_of_one = 0;
};

/// Returns the area of the surface on which the records lie, as if the surface were flat. It is the
/// product of the records' extents along the two axes across the main axis of the normal. Because
/// the surface may be tilted, the product is divided by the normal's component along that axis.
double area_of(absl::Span<const GuidingRecord> records, const Vec3& normal) {
  const std::uint32_t across = side_of(normal) / 2;
  double area = 1 / std::abs(normal[static_cast<int>(across)]);
  const auto n = static_cast<double>(records.size());
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    if (axis == across) {
      continue;
    }
    float low = std::numeric_limits<float>::max();
    float high = std::numeric_limits<float>::lowest();
    for (const GuidingRecord& record : records) {
      low = std::min(low, record.position[axis]);
      high = std::max(high, record.position[axis]);
    }
    // The extent of n uniform points is (n - 1) / (n + 1) of the whole on average.
    area *= (double{high} - low) * (n + 1) / std::max(1.0, n - 1);
  }
  return area;
}

/// Returns the place of the records, which MUST NOT be empty.
Place place_of(absl::Span<const GuidingRecord> records) {
  Place place;
  for (const GuidingRecord& record : records) {
    place.middle = place.middle + vec3(record.position);
    place.normal = place.normal + vec3(record.normal);
  }
  place.middle = place.middle / static_cast<double>(records.size());
  const double sum = length(place.normal);
  place.normal = sum > 0 ? place.normal / sum : vec3(records[0].normal);
  for (const GuidingRecord& record : records) {
    place.extent2 += length_squared(vec3(record.position) - place.middle);
  }
  place.extent2 /= static_cast<double>(records.size());
  // The powers of photons are summed and divided by the area. The irradiances of paths are
  // averaged.
  const double over = records[0].kind == GuidingRecord::Kind::kPhoton
                          ? area_of(records, place.normal)
                          : static_cast<double>(records.size());
  place.irradiance_of_one = over > 0 ? 1 / over : 0;
  return place;
}

/// Scales the weights to a sum of 1.
void normalize_weights(absl::Span<Seen> seen) {
  double sum = 0;
  for (const Seen& one : seen) {
    sum += one.weight;
  }
  for (Seen& one : seen) {
    one.weight /= sum;
  }
}

/// The light that the records describe.
struct Light {
  std::vector<Seen> seen;  ///< their weights sum to 1
  double irradiance = 0;
  double effective = 0;  ///< number of records of equal weight with as much information
};

/// Returns the light as seen from the place. Records without light are left out, and also records
/// whose source is at the place.
Light light_of(const Place& place, absl::Span<const GuidingRecord> records) {
  Light light;
  for (const GuidingRecord& record : records) {
    const double weight = record.weight * place.irradiance_of_one;
    const Vec3 to = vec3(record.source) - place.middle;
    const double distance = length(to);
    if (weight > 0 && std::isfinite(weight) && distance > 0) {
      light.seen.push_back({to / distance, 1 / distance, weight});
      light.irradiance += weight;
    }
  }
  double squares = 0;
  for (Seen& one : light.seen) {
    squares += one.weight * one.weight;
    one.weight = std::min(one.weight, kMaxShareOfRecord * light.irradiance);
  }
  light.effective = squares > 0 ? light.irradiance * light.irradiance / squares : 0;
  normalize_weights(absl::MakeSpan(light.seen));
  return light;
}

/// Returns the cluster of directions [first, last).
Cluster cluster_of(const Place& place, absl::Span<const Seen> seen, std::size_t first,
                   std::size_t last) {
  Cluster cluster;
  cluster.first = first;
  cluster.last = last;
  Vec3 sum;
  for (std::size_t i = first; i < last; ++i) {
    cluster.weight += seen[i].weight;
    sum = sum + seen[i].direction * seen[i].weight;
    cluster.inverse += seen[i].inverse * seen[i].weight;
  }
  cluster.inverse /= cluster.weight;
  const double size = length(sum);
  cluster.axis = size > 0 ? sum / size : place.normal;
  double farthest = 0;
  double mean = 0;
  double spread = 0;  // variance of the inverse distances
  for (std::size_t i = first; i < last; ++i) {
    const double h = 1 - dot(seen[i].direction, cluster.axis);
    farthest = std::max(farthest, h);
    mean += h * seen[i].weight;
    const double off = seen[i].inverse - cluster.inverse;
    spread += off * off * seen[i].weight;
  }
  mean /= cluster.weight;
  spread /= cluster.weight;
  // The cone contains the farthest direction, with a margin for few records. Uniform directions in
  // a cone have half of its 1 - cos on average, so the mean suggests 2 * mean for the cone. At most
  // 4 * mean is used, so that single directions far from the axis do not widen the cone. The last
  // term widens the cone where light comes from several distances. There the direction of the light
  // changes relative to the axis when the point moves within the cell.
  const auto n = static_cast<double>(last - first);
  const double cone = std::min(farthest * (1 + 3 / n), 4 * mean) + place.extent2 * spread / 2;
  cluster.one_minus_cos = std::clamp(cone, 4e-6, 2.0);
  return cluster;
}

/// Returns the cluster's part of the mean logarithm of the pdf of all directions, up to a constant.
double score(const Cluster& cluster) {
  return cluster.weight * log(cluster.weight / cluster.one_minus_cos);
}

/// Moves the cluster's directions whose component `axis` is below `at` to the front. Keeps the
/// order within both parts, and returns the number of the first direction of the second part.
std::size_t partition(absl::Span<Seen> seen, const Cluster& cluster, int axis, double at) {
  const auto begin = seen.begin();
  const auto middle =
      std::stable_partition(begin + static_cast<std::ptrdiff_t>(cluster.first),
                            begin + static_cast<std::ptrdiff_t>(cluster.last),
                            [&](const Seen& one) { return one.direction[axis] < at; });
  return static_cast<std::size_t>(middle - begin);
}

/// Returns the best split of the cluster: at the weighted mean of one coordinate of its directions.
/// Reorders the cluster's directions.
Split best_split(const Place& place, absl::Span<Seen> seen, const Cluster& cluster) {
  Split best;
  if (cluster.last - cluster.first < 2 * kMinRecordsOfBall) {
    return best;
  }
  for (int axis = 0; axis < 3; ++axis) {
    double mean = 0;
    for (std::size_t i = cluster.first; i < cluster.last; ++i) {
      mean += seen[i].direction[axis] * seen[i].weight;
    }
    mean /= cluster.weight;
    const std::size_t middle = partition(seen, cluster, axis, mean);
    if (middle - cluster.first < kMinRecordsOfBall || cluster.last - middle < kMinRecordsOfBall) {
      continue;
    }
    const double gain = score(cluster_of(place, seen, cluster.first, middle)) +
                        score(cluster_of(place, seen, middle, cluster.last)) - score(cluster);
    if (gain > best.gain) {
      best = {gain, axis, mean};
    }
  }
  return best;
}

/// Returns the clusters of all directions. The cluster whose split has the largest gain is split,
/// repeatedly, until no gain is large enough or one more split would exceed kMaxBalls. A cluster
/// that was split stays in the result beside its parts, with the share kKept of its weight, because
/// light is as likely from directions between the parts as from directions around them.
std::vector<Cluster> clusters_of(const Place& place, absl::Span<Seen> seen) {
  double squares = 0;  // the weights sum to 1
  for (const Seen& one : seen) {
    squares += one.weight * one.weight;
  }
  std::vector<Cluster> clusters;
  std::vector<Cluster> parts = {cluster_of(place, seen, 0, seen.size())};
  std::vector<Split> splits = {best_split(place, seen, parts[0])};
  std::vector<double> scales = {1};
  while (clusters.size() + parts.size() + 2 <= kMaxBalls) {
    const auto best =
        std::max_element(splits.begin(), splits.end(),
                         [](const Split& a, const Split& b) { return a.gain < b.gain; });
    if (best->gain <= kMinSplitGain * squares) {
      break;
    }
    const auto which = static_cast<std::size_t>(best - splits.begin());
    Cluster split = parts[which];
    const double scale = scales[which];
    const std::size_t middle = partition(seen, split, best->axis, best->at);
    parts[which] = cluster_of(place, seen, split.first, middle);
    parts.push_back(cluster_of(place, seen, middle, split.last));
    splits[which] = best_split(place, seen, parts[which]);
    splits.push_back(best_split(place, seen, parts.back()));
    scales[which] = scale * (1 - kKept);
    scales.push_back(scale * (1 - kKept));
    split.weight *= scale * kKept;
    clusters.push_back(split);
  }
  for (std::size_t i = 0; i < parts.size(); ++i) {
    parts[i].weight *= scales[i];
    clusters.push_back(parts[i]);
  }
  return clusters;
}

/// The pdfs with which a direction that carries light would be sampled by two strategies.
struct Densities {
  double weight = 0;
  double cosine = 0;    ///< pdf of sampling by the cosine, as a diffuse BSDF does
  double clusters = 0;  ///< pdf of sampling the cones of the clusters
};

/// Fits clusters to each half of the directions and returns the densities of the other half, which
/// were not used to fit these clusters (cross-validation).
std::vector<Densities> crossed_densities(const Place& place, absl::Span<const Seen> seen) {
  std::vector<Densities> out;
  for (std::size_t half = 0; half < 2; ++half) {
    std::vector<Seen> fitted;
    for (std::size_t i = half; i < seen.size(); i += 2) {
      fitted.push_back(seen[i]);
    }
    normalize_weights(absl::MakeSpan(fitted));
    const std::vector<Cluster> clusters = clusters_of(place, absl::MakeSpan(fitted));
    for (std::size_t i = 1 - half; i < seen.size(); i += 2) {
      Densities at{seen[i].weight, std::max(dot(seen[i].direction, place.normal), 0.02) * kInvPi,
                   0};
      for (const Cluster& cluster : clusters) {
        if (cluster.one_minus_cos > kWidest) {
          at.clusters += cluster.weight * at.cosine;
        } else if (1 - dot(seen[i].direction, cluster.axis) <= cluster.one_minus_cos) {
          at.clusters += cluster.weight / (2 * kPi * cluster.one_minus_cos);
        }
      }
      out.push_back(at);
    }
  }
  return out;
}

/// Returns the expected second moment of the estimate "light of a sampled direction / pdf", in
/// units of the squared mean. Directions are sampled from the clusters with the probability
/// `share`, and otherwise by the cosine. The light of a direction is assumed to be proportional to
/// the greater of the two pdfs in Densities. A larger `share` raises the result for directions that
/// no cluster covers, because such directions get fewer samples.
double second_moment(absl::Span<const Densities> densities, double share) {
  double sum = 0;
  for (const Densities& at : densities) {
    sum += at.weight * std::max(at.clusters, at.cosine) /
           ((1 - share) * at.cosine + share * at.clusters);
  }
  return sum;
}

/// Returns the expected second moment of the estimate for light of the records' solid angles, in
/// units of the squared mean. With directions sampled by the cosine, light of a small solid angle w
/// has the second moment pi / w.
double moment_of_lights(absl::Span<const GuidingRecord> records) {
  double sum = 0;
  double weight = 0;
  for (const GuidingRecord& record : records) {
    weight += record.weight;
    sum += record.solid_angle > 0 ? record.weight * kPi / record.solid_angle : 0;
  }
  return weight > 0 ? sum / weight : 0;
}

/// Returns the share of kShares that has the least second moment, or 0 if no share lowers it.
double best_share(absl::Span<const Densities> densities) {
  double best = 0;
  double least = second_moment(densities, 0);
  for (const double share : kShares) {
    const double moment = second_moment(densities, share);
    if (moment < least) {
      least = moment;
      best = share;
    }
  }
  return best;
}

/// Returns the ball that, as seen from the middle of the place, fills the cone of the cluster. The
/// distance of the ball is the inverse of the mean inverse distance.
GuidingBall ball_of(const Place& place, const Cluster& cluster) {
  const double h = cluster.one_minus_cos;
  const double distance = 1 / cluster.inverse;
  const double sin = std::sqrt(h * (2 - h));
  return {float3(place.middle + cluster.axis * distance), static_cast<float>(distance * sin),
          static_cast<float>(cluster.weight)};
}

}  // namespace

GuidingCell fit_cell(absl::Span<const GuidingRecord> records) {
  GuidingCell cell;
  if (records.empty()) {
    return cell;
  }
  const Place place = place_of(records);
  Light light = light_of(place, records);
  cell.irradiance = static_cast<float>(light.irradiance);
  cell.moment_of_lights = static_cast<float>(moment_of_lights(records));
  if (light.seen.size() < kMinRecordsOfCell || light.effective < kMinRecordsOfCell) {
    return cell;
  }
  const std::vector<Densities> densities = crossed_densities(place, light.seen);
  for (const Cluster& cluster : clusters_of(place, absl::MakeSpan(light.seen))) {
    if (cluster.one_minus_cos <= kWidest) {
      cell.balls[cell.count++] = ball_of(place, cluster);
    }
  }
  cell.share = static_cast<float>(best_share(densities));
  cell.moment = static_cast<float>(second_moment(densities, 0));
  cell.guided_moment = static_cast<float>(second_moment(densities, cell.share));
  return cell;
}

}  // namespace bandsaw
