#include "coordinator/core/loss_rate.h"

#include <algorithm>
#include <cmath>

namespace bandsaw::coordinator {

void LossRate::add(double& count) {
  count += 1;
  if (bands_ + losses_ > kMaxCount) {
    bands_ /= 2;
    losses_ /= 2;
  }
}

std::size_t LossRate::witnesses(std::size_t least, std::size_t own) const {
  const double losses = std::max(0.0, losses_ - static_cast<double>(own)) + kLossesBefore;
  const double share = losses / (losses + bands_ + kBandsBefore);
  const double needed = std::ceil(std::log(kMistake) / std::log(share));
  return std::clamp(static_cast<std::size_t>(needed), least, std::max(least, kMaxWitnesses));
}

}  // namespace bandsaw::coordinator
