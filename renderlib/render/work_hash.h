#pragma once

// A hash that identifies the image that a band belongs to. Workers send it with their bands, and
// the coordinator compares it with the hash of the job. The job's number is not enough, because
// numbers are reused after a coordinator's journal is reset or restored from a copy.

#include <cstdint>

#include "absl/strings/string_view.h"
#include "renderlib/render/settings.h"

namespace bandsaw {

/// Returns a hash of the settings and of `manifest`, the digest of the scene package in
/// hexadecimal; never 0.
std::uint64_t work_hash(absl::string_view manifest, const RenderSettings& settings);

}  // namespace bandsaw
