#include "coordinator/core/error_curve.h"

#include <algorithm>
#include <cmath>

#include "coordinator/core/power_fit.h"
#include "renderlib/base/check.h"

namespace bandsaw::coordinator {
namespace {

constexpr double kFallOfNoise = 0.5;
// Short runs of a fall look steeper than what follows, above all just past a power of two: of the
// gallery's scenes the end is foreseen best with this (tests/unit/core/error_curve_test.cpp).
constexpr double kSteepestFall = 0.65;

double log_samples(const ErrorPoint& point) { return std::log(static_cast<double>(point.samples)); }
double log_error(const ErrorPoint& point) { return std::log(point.estimate.at_most()); }

}  // namespace

void add_point(ErrorCurve& curve, const ErrorPoint& point) {
  BANDSAW_CHECK(curve.empty() || curve.back().samples <= point.samples, "samples only grow");
  if (!curve.empty() && curve.back().samples == point.samples) {
    curve.back().estimate = point.estimate;
    return;
  }
  const std::size_t n = curve.size();
  if (n >= 2 && curve[n - 1].samples < curve[n - 2].samples + curve[n - 2].samples / 8) {
    curve.back() = point;
  } else {
    curve.push_back(point);
  }
}

double fall_of(const ErrorCurve& curve) {
  std::vector<std::pair<double, double>> points;
  for (const ErrorPoint& point : curve) {
    if (16 * point.samples >= curve.back().samples) {
      points.emplace_back(point.samples, point.estimate.at_most());
    }
  }
  return std::clamp(-power_of(points).value_or(-kFallOfNoise), kFallOfNoise, kSteepestFall);
}

std::optional<double> samples_until(const ErrorCurve& curve, double target) {
  if (curve.empty() || curve.back().estimate.at_most() <= 0) {
    return std::nullopt;
  }
  const auto reached = std::find_if(curve.begin(), curve.end(), [&](const ErrorPoint& point) {
    return point.estimate.at_most() <= target;
  });
  const bool at_first = reached == curve.begin();
  const ErrorPoint& near = at_first ? curve.front() : *std::prev(reached);
  double fall = fall_of(curve);
  if (!at_first && reached != curve.end()) {
    fall = (log_error(near) - log_error(*reached)) / (log_samples(*reached) - log_samples(near));
  }
  return static_cast<double>(near.samples) * std::exp((log_error(near) - std::log(target)) / fall);
}

std::optional<double> cpu_s_until(const ErrorCurve& curve, double target) {
  const std::optional<double> samples = samples_until(curve, target);
  if (!samples || curve.back().cpu_s <= 0) {
    return std::nullopt;
  }
  const ErrorPoint& last = curve.back();
  return last.cpu_s * *samples / static_cast<double>(last.samples);
}

}  // namespace bandsaw::coordinator
