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
/// order, each once. INVALID_ARGUMENT: an item is neither a number nor a range; a range runs
/// backwards or has a step below 1; a number is beyond kMaxFrameNumber; there are more than
/// kMaxFrames different numbers; there are more than 2 * kMaxFrames numbers, where repeated numbers
/// count each time; there is no number. The message begins with the item, or with the list if only
/// the list as a whole is too long.
absl::StatusOr<std::vector<FrameNumber>> parse_frames(absl::string_view text);

/// Returns a short list of numbers and ranges in the form that parse_frames reads. `numbers` MUST
/// be ascending.
std::string frames_text(const std::vector<FrameNumber>& numbers);

}  // namespace bandsaw::coordinator
