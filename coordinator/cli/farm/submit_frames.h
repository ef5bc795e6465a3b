#pragma once

#include "coordinator/cli/farm/farm_client.h"
#include "coordinator/cli/options/commands.h"

namespace bandsaw::coordinator {

/// bandsaw submit --frames: starts a sequence, or continues one, sends the scenes of its frames and
/// fetches their images. `outputs`: names of image files, with a place for the number of a frame
/// ("walk.####.png").
ExitCode submit_frames(FarmClient& client, const SubmitOptions& options,
                       const std::vector<std::string>& outputs, Process& process);

}  // namespace bandsaw::coordinator
