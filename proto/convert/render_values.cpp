// Copies fields between the messages of farm.proto and the values of renderlib. Nothing is checked
// here.

#include "proto/convert/render_values.h"

namespace bandsaw {

farm::Settings to_message(const RenderSettings& settings) {
  farm::Settings message;
  message.set_width(settings.width);
  message.set_height(settings.height);
  message.set_max_depth(settings.max_depth);
  message.set_seed(settings.seed);
  message.set_integrator(static_cast<farm::Integrator>(settings.integrator));
  return message;
}

RenderSettings settings_of(const farm::Settings& message) {
  return {.width = message.width(),
          .height = message.height(),
          .max_depth = message.max_depth(),
          .seed = message.seed(),
          .integrator = static_cast<Integrator>(message.integrator())};
}

farm::Band to_message(const Band& band) {
  farm::Band message;
  message.set_first_sample(band.samples.first);
  message.set_last_sample(band.samples.last);
  message.set_first_row(band.rows.first);
  message.set_last_row(band.rows.last);
  return message;
}

Band band_of(const farm::Band& message) {
  return {.samples = {.first = message.first_sample(), .last = message.last_sample()},
          .rows = {.first = message.first_row(), .last = message.last_row()}};
}

farm::Counters to_message(const Counters& counters) {
  farm::Counters message;
  message.set_rays(counters.rays);
  message.set_bad_samples(counters.bad_samples);
  message.set_bad_x(counters.bad_x);
  message.set_bad_y(counters.bad_y);
  message.set_bad_sample(counters.bad_sample);
  message.set_negative_samples(counters.negative_samples);
  message.set_truncated_paths(counters.truncated_paths);
  message.set_dropped_primitives(counters.dropped_primitives);
  message.set_techniques(counters.techniques);
  message.set_training_rays(counters.training_rays);
  return message;
}

Counters counters_of(const farm::Counters& message) {
  return {.rays = message.rays(),
          .bad_samples = message.bad_samples(),
          .bad_x = message.bad_x(),
          .bad_y = message.bad_y(),
          .bad_sample = message.bad_sample(),
          .negative_samples = message.negative_samples(),
          .truncated_paths = message.truncated_paths(),
          .dropped_primitives = message.dropped_primitives(),
          .techniques = message.techniques(),
          .training_rays = message.training_rays()};
}

}  // namespace bandsaw
