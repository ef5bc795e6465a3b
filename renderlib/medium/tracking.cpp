// visit_collisions() finds the tentative collisions of null-collision tracking along a ray; fly(),
// pass() and estimate_transmittance() differ in what they do at each of them. The space is divided
// into regions with bounds of the density, `least` and `most`; a span is the part of a ray in a
// region.

#include "renderlib/medium/tracking.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include "renderlib/math/elementary.h"
#include "renderlib/medium/attenuation.h"

namespace bandsaw {
namespace {

using Channels = std::array<double, 3>;

/// Where the medium emits, there are on average at least this many tentative collisions along a
/// region's side.
constexpr double kCollisionsWhereItEmits = 2;
/// A flight whose weight is below this share of its first weight takes part in Russian roulette at
/// each collision, and survives with probability kSurvivalOfLow.
constexpr double kLowWeight = 0x1p-4;
constexpr double kSurvivalOfLow = 0x1p-2;
/// After this many collisions, a flight survives each further one with probability kSurvivalOfMany
/// at most, so that every flight ends.
constexpr std::uint32_t kManyCollisions = 1u << 14;
constexpr double kSurvivalOfMany = 1 - 0x1p-10;

Channels channels_of(const Rgb& color) { return {color.r, color.g, color.b}; }
Rgb rgb_of(const Channels& c) {
  return {static_cast<float>(c[0]), static_cast<float>(c[1]), static_cast<float>(c[2])};
}
double sum(const Channels& c) { return c[0] + c[1] + c[2]; }
double max_of(const Channels& c) { return std::max({c[0], c[1], c[2]}); }
void scale(Channels& c, double by) {
  for (double& channel : c) {
    channel *= by;
  }
}

/// Samples a distance in mean free paths; u in [0, 1).
double exponential(double u) { return -log1p(-u); }

/// Russian roulette over the weight of one flight.
class Roulette {
 public:
  explicit Roulette(const Channels& first) : low_(kLowWeight * max_of(first)) {}

  /// Called at each collision. Scales the weight if the flight goes on; returns false if it ends.
  bool survives(Channels& weight, NumberStream& numbers) {
    double survival = ++collisions_ > kManyCollisions ? kSurvivalOfMany : 1;
    const double most = max_of(weight);
    if (most == 0) {
      return false;
    }
    if (most < low_) {
      survival *= kSurvivalOfLow;
    }
    if (survival == 1) {
      return true;
    }
    if (numbers.next() >= survival) {
      weight = {};
      return false;
    }
    scale(weight, 1 / survival);
    return true;
  }

 private:
  double low_;
  std::uint32_t collisions_ = 0;
};

/// Samples the tentative collisions along the ray, and calls `collide(distance, span, per_unit)`
/// for each of them, in order, until `collide` returns false. `per_unit` is the rate of tentative
/// collisions in the span, per scene unit. The function `rate(region, speed)` returns the rate for
/// a region; `speed` is RegionWalk::speed(). `enter(span)` is called before the collisions of each
/// span. `free_paths` is the distance to the first collision, in mean free paths.
template <class Rate, class Enter, class Collide>
void visit_collisions(const GridMedium& medium, const GridRay& ray, double length,
                      double free_paths, NumberStream& numbers, const Rate& rate,
                      const Enter& enter, const Collide& collide) {
  RegionWalk walk(medium.regions(), ray, length);
  const double speed = walk.speed();
  RegionSpan span;
  double left = free_paths;
  while (walk.next(span)) {
    enter(span);
    const double per_unit = rate(span.region, speed);
    if (per_unit == 0) {
      continue;
    }
    double at = span.begin;
    for (;;) {
      const double distance = at + left / per_unit;
      if (!(distance < span.end)) {
        left = std::max(left - (span.end - at) * per_unit, 0.0);
        break;
      }
      at = distance;
      if (!collide(distance, span, per_unit)) {
        return;
      }
      left = exponential(numbers.next());
    }
  }
}

/// The rate of tentative collisions in fly() and pass(), per scene unit.
struct FlightRate {
  const GridMedium& medium;

  double operator()(const Region& region, double speed) const {
    const double majorant = medium.max_extinction() * region.most;
    const double for_emission =
        region.emits ? kCollisionsWhereItEmits * speed / medium.regions().side : 0;
    return std::max(majorant, for_emission);
  }
};

/// The coefficients at a tentative collision.
struct Collision {
  Vec3 at;
  Channels density;
  Coefficients coefficients;

  Collision(const GridMedium& medium, const GridRay& ray, double distance, const Region& region)
      : at(ray.at(distance)),
        // Rounding may place a point beyond its region.
        density(medium.density(at, region.most)),
        coefficients(medium.coefficients(at, density)) {}

  /// Adds to `to` the emission that the collision stands for: collisions are 1 / rate apart on
  /// average.
  void emit(const GridMedium& medium, const Channels& weight, double rate, Channels& to) const {
    const Channels emission = medium.emission(at, density);
    for (std::size_t c = 0; c < 3; ++c) {
      to[c] += weight[c] * emission[c] / rate;
    }
  }
};

constexpr auto kNoAction = [](const RegionSpan&) {};

}  // namespace

Flight fly(const GridMedium& medium, const GridRay& ray, double length, const Rgb& throughput,
           const FirstCollision& first, NumberStream& numbers) {
  Flight flight;
  Channels weight = channels_of(throughput);
  Channels emitted{};
  Roulette roulette(weight);
  bool is_first = true;
  const auto collide = [&](double distance, const RegionSpan& span, double rate) {
    const Collision here(medium, ray, distance, span.region);
    if (span.region.emits) {
      here.emit(medium, weight, rate, emitted);
    }
    const double choice = is_first ? first.choice : numbers.next();
    is_first = false;
    Channels scatters;
    Channels passes;
    for (std::size_t c = 0; c < 3; ++c) {
      scatters[c] = weight[c] * here.coefficients.scattering[c];
      passes[c] = weight[c] * (rate - here.coefficients.extinction[c]);
    }
    // The weights are divided by the rate and by the probability of the outcome, which is its share
    // of `both`.
    const double both = sum(scatters) + sum(passes);
    if (choice * both < sum(scatters)) {
      flight.scattered = true;
      flight.distance = distance;
      weight = scatters;
      scale(weight, both / (rate * sum(scatters)));
      return false;
    }
    weight = passes;
    if (sum(passes) > 0) {
      scale(weight, both / (rate * sum(passes)));
    }
    return roulette.survives(weight, numbers);
  };
  visit_collisions(medium, ray, length, exponential(first.distance), numbers, FlightRate{medium},
                   kNoAction, collide);
  flight.throughput = rgb_of(weight);
  flight.emitted = rgb_of(emitted);
  return flight;
}

Passage pass(const GridMedium& medium, const GridRay& ray, double length, const Rgb& throughput,
             NumberStream& numbers) {
  Passage passage;
  Channels weight = channels_of(throughput);
  Channels emitted{};
  Channels chosen{};
  double all_scattered = 0;
  Roulette roulette(weight);
  const auto collide = [&](double distance, const RegionSpan& span, double rate) {
    const Collision here(medium, ray, distance, span.region);
    if (span.region.emits) {
      here.emit(medium, weight, rate, emitted);
    }
    Channels scattered;
    for (std::size_t c = 0; c < 3; ++c) {
      scattered[c] = weight[c] * here.coefficients.scattering[c] / rate;
      weight[c] *= (rate - here.coefficients.extinction[c]) / rate;
    }
    // Keeps one of the points: each with a probability proportional to its weight.
    const double share = sum(scattered);
    all_scattered += share;
    if (share > 0 && numbers.next() * all_scattered < share) {
      passage.scattered.distance = distance;
      chosen = scattered;
    }
    return roulette.survives(weight, numbers);
  };
  visit_collisions(medium, ray, length, exponential(numbers.next()), numbers, FlightRate{medium},
                   kNoAction, collide);
  if (all_scattered > 0) {
    scale(chosen, all_scattered / sum(chosen));
    passage.scattered.weight = rgb_of(chosen);
  }
  passage.throughput = rgb_of(weight);
  passage.emitted = rgb_of(emitted);
  return passage;
}

Rgb estimate_transmittance(const GridMedium& medium, const GridRay& ray, double length,
                           NumberStream& numbers) {
  const Channels& extinction = medium.extinction();
  const double most_extinction = medium.max_extinction();
  Channels weight = {1, 1, 1};
  double control = 0;  // the integral of the regions' least densities
  Roulette roulette(weight);
  const auto rate = [&](const Region& region, double) {
    return most_extinction * (double{region.most} - region.least);
  };
  const auto enter = [&](const RegionSpan& span) {
    control += span.region.least == 0 ? 0 : span.region.least * (span.end - span.begin);
  };
  const auto collide = [&](double distance, const RegionSpan& span, double per_unit) {
    const Channels density = medium.density(ray.at(distance), span.region.most);
    for (std::size_t c = 0; c < 3; ++c) {
      // Rounding may place a point beyond its region.
      const double beyond = std::max(density[c] - span.region.least, 0.0);
      weight[c] *= 1 - extinction[c] * beyond / per_unit;
    }
    return roulette.survives(weight, numbers);
  };
  visit_collisions(medium, ray, length, exponential(numbers.next()), numbers, rate, enter, collide);
  for (std::size_t c = 0; c < 3; ++c) {
    weight[c] *= transmittance(extinction[c], control);
  }
  return rgb_of(weight);
}

}  // namespace bandsaw
