#pragma once

// How a sequence (a job of many frames) and its frames are shown to users.

#include <string>
#include <vector>

#include "coordinator/scheduler/context/context.h"

namespace bandsaw::coordinator {

/// Returns the view of a sequence as that of a job: sums over its frames, and the workers of all
/// frames that are rendered. The error is the worst of the frames that are done.
JobView sequence_view(const Context& context, const Sequence& sequence, Time now);

/// Returns the frames that changed after `after` (FrameView::changed), ascending by number; 0: all
/// frames.
std::vector<FrameView> frame_views(const Sequence& sequence, std::uint64_t after);

/// Returns sentences about the frames that are rendered, wait, are expected, or failed, for
/// `bandsaw why`.
std::vector<std::string> frame_sentences(const Sequence& sequence);

}  // namespace bandsaw::coordinator
