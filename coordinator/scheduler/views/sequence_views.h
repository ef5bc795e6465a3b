#pragma once

// How a sequence (a job of many frames) and its frames are shown to users.

#include <string>
#include <vector>

#include "coordinator/scheduler/context/context.h"

namespace bandsaw::coordinator {

/// Returns the view of a sequence, in the form of a job's view. It has the samples, counters and
/// CPU time of all frames together, the workers that are rendering a frame, and the largest error
/// of the frames that are done.
JobView sequence_view(const Context& context, const Sequence& sequence, Time now);

/// Returns the frames whose FrameView::changed is greater than `after`, or all frames if `after` is
/// 0. They ascend by number.
std::vector<FrameView> frame_views(const Sequence& sequence, std::uint64_t after);

/// Returns sentences for `bandsaw why`: which frames are being rendered, which wait, which are
/// expected, and which failed.
std::vector<std::string> frame_sentences(const Sequence& sequence);

}  // namespace bandsaw::coordinator
