#pragma once

// Converts between the messages of farm.proto and renderlib's values, for the coordinator, its
// commands and the worker. Nothing is checked here, so code that receives values from the network
// must check them (validate() in renderlib/render).

#include "proto/farm.pb.h"
#include "renderlib/render/band.h"
#include "renderlib/render/settings.h"

namespace bandsaw {

farm::Settings to_message(const RenderSettings& settings);
RenderSettings settings_of(const farm::Settings& message);

farm::Band to_message(const Band& band);
Band band_of(const farm::Band& message);

/// Leaves the times of the message 0, because renderlib's Counters has no times.
farm::Counters to_message(const Counters& counters);
Counters counters_of(const farm::Counters& message);

}  // namespace bandsaw
