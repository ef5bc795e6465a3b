#pragma once

// Of what pixels are, beside their place: a job's number may come to mean another job, where a
// coordinator's journal is restored from a copy or begun anew.

#include <cstdint>

#include "absl/strings/string_view.h"
#include "renderlib/render/settings.h"

namespace bandsaw {

/// A hash of the package's digest, in hexadecimal, and the settings; never 0.
std::uint64_t work_hash(absl::string_view manifest, const RenderSettings& settings);

}  // namespace bandsaw
