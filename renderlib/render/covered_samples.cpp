#include "renderlib/render/covered_samples.h"

#include <algorithm>

namespace bandsaw {

std::optional<SampleRange> CoveredSamples::overlap(const SampleRange& samples) const {
  for (const SampleRange& range : ranges_) {
    if (range.first < samples.last && samples.first < range.last) {
      return range;
    }
  }
  return std::nullopt;
}

void CoveredSamples::add(const SampleRange& samples) {
  const auto after = std::find_if(ranges_.begin(), ranges_.end(), [&](const SampleRange& range) {
    return range.first >= samples.last;
  });
  auto at = ranges_.insert(after, samples);
  if (const auto next = std::next(at); next != ranges_.end() && next->first == at->last) {
    at->last = next->last;
    ranges_.erase(next);
  }
  if (at != ranges_.begin() && std::prev(at)->last == at->first) {
    std::prev(at)->last = at->last;
    ranges_.erase(at);
  }
}

std::uint64_t CoveredSamples::from_start() const {
  return ranges_.empty() || ranges_.front().first > 0 ? 0 : ranges_.front().last;
}

}  // namespace bandsaw
