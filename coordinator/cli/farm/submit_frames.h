#pragma once

// The command `bandsaw submit --frames`, which renders many frames as one job, a sequence.

#include "coordinator/cli/farm/farm_client.h"
#include "coordinator/cli/options/commands.h"

namespace bandsaw::coordinator {

/// Starts a sequence, or continues one (--continue), sends the scenes of its frames and fetches
/// their images. `watch`: what is made of the frames, in files whose names have a place for the
/// number of a frame ("walk.####.png"); `watch.job` is ignored.
ExitCode submit_frames(FarmClient& client, const SubmitOptions& options, WatchOptions watch,
                       Process& process);

}  // namespace bandsaw::coordinator
