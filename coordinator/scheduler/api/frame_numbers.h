#pragma once

// The numbers of a sequence's frames as text: "1-30", "1:240:2", "47,60-72".

#include <cstddef>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "coordinator/scheduler/api/ids.h"

namespace bandsaw::coordinator {

/// Maximum number of frames of a sequence.
inline constexpr std::size_t kMaxFrames = 50'000;
/// Maximum magnitude of a frame's number.
inline constexpr FrameNumber kMaxFrameNumber = 1'000'000'000;

/// Parses a list of numbers and ranges, separated by commas. A range is FIRST:LAST or FIRST-LAST,
/// both included; a step may follow, as in 1:240:2 or 1-240x2. Returns the numbers in ascending
/// order, each once. INVALID_ARGUMENT, beginning with the item: not a number or range, a range that
/// runs backwards, a number beyond kMaxFrameNumber, more than kMaxFrames different numbers, more
/// than twice as many with those that are repeated, or none.
absl::StatusOr<std::vector<FrameNumber>> parse_frames(absl::string_view text);

/// Returns the shortest list of ranges, as parse_frames reads them. `numbers` MUST be ascending.
std::string frames_text(const std::vector<FrameNumber>& numbers);

}  // namespace bandsaw::coordinator
