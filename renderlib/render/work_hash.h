#pragma once

// Hash that identifies what was rendered, independently of the job's number: job numbers are reused
// after a coordinator's journal is restored from a copy or reset.

#include <cstdint>

#include "absl/strings/string_view.h"
#include "renderlib/render/settings.h"

namespace bandsaw {

/// Returns a hash of the package's digest, in hexadecimal, and of the settings; never 0.
std::uint64_t work_hash(absl::string_view manifest, const RenderSettings& settings);

}  // namespace bandsaw
