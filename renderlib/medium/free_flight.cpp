// The constructor computes, for each channel, the light that is scattered within the length and the
// light that passes. All probabilities are ratios of their sums over the channels.

#include "renderlib/medium/free_flight.h"

#include <algorithm>

#include "renderlib/math/elementary.h"
#include "renderlib/medium/attenuation.h"

namespace bandsaw {

FreeFlight::FreeFlight(const Medium& medium, const Rgb& throughput, double length)
    : length_(length) {
  const std::array<float, 3> weight = {throughput.r, throughput.g, throughput.b};
  const std::array<float, 3> absorption = {medium.absorption.r, medium.absorption.g,
                                           medium.absorption.b};
  const std::array<float, 3> scattering = {medium.scattering.r, medium.scattering.g,
                                           medium.scattering.b};
  for (std::size_t c = 0; c < 3; ++c) {
    extinction_[c] = extinction(absorption[c], scattering[c]);
    entering_[c] = double{weight[c]} * scattering[c];
    // The case distinction avoids 0 * infinity if a channel has no extinction.
    all_scattered_[c] = entering_[c] == 0 ? 0 : entering_[c] * reach(extinction_[c], length);
    passing_[c] = weight[c] * transmittance(extinction_[c], length);
  }
}

Rgb FreeFlight::color(const Channels& c, double scale) {
  return {static_cast<float>(c[0] * scale), static_cast<float>(c[1] * scale),
          static_cast<float>(c[2] * scale)};
}

FreeFlight::Channels FreeFlight::scattered_channels(double distance) const {
  Channels result;
  for (std::size_t c = 0; c < 3; ++c) {
    result[c] = entering_[c] == 0 ? 0 : entering_[c] * transmittance(extinction_[c], distance);
  }
  return result;
}

double FreeFlight::scatter_probability() const {
  const double scatters = sum(all_scattered_);
  return scatters > 0 ? scatters / (scatters + sum(passing_)) : 0;
}

double FreeFlight::sample(double choice, double u) const {
  double left = choice * sum(all_scattered_);
  std::size_t c = 0;
  while (c < 2 && (left >= all_scattered_[c] || all_scattered_[c] == 0)) {
    left -= all_scattered_[c];
    ++c;
  }
  // Rounding may select a channel beyond the last one that scatters.
  while (all_scattered_[c] == 0) {
    --c;
  }
  // 1 - exp(-sigma * length), without cancellation.
  const double share = std::min(1.0, extinction_[c] * reach(extinction_[c], length_));
  return std::min(-log1p(-u * share) / extinction_[c], length_);
}

double FreeFlight::pdf(double distance) const {
  return sum(scattered_channels(distance)) / sum(all_scattered_);
}

Rgb FreeFlight::scattered(double distance) const { return color(scattered_channels(distance), 1); }

Rgb FreeFlight::after_scattering(double distance) const {
  const Channels channels = scattered_channels(distance);
  const double all = sum(channels);
  return all > 0 ? color(channels, (sum(all_scattered_) + sum(passing_)) / all) : Rgb{};
}

Rgb FreeFlight::after_passing() const {
  const double all = sum(passing_);
  return all > 0 ? color(passing_, (sum(all_scattered_) + all) / all) : Rgb{};
}

Rgb FreeFlight::passing() const { return color(passing_, 1); }

Rgb FreeFlight::all_scattered() const { return color(all_scattered_, 1); }

}  // namespace bandsaw
