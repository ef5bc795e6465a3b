#pragma once

// The image of a job while it forms, for the views of the command that watches it.

#include <memory>
#include <optional>

#include "coordinator/cli/base/ticker.h"
#include "coordinator/cli/farm/farm_client.h"
#include "coordinator/cli/progress/views.h"

namespace bandsaw::coordinator {

/// Fetches a job's image from the farm again and again, over a connection of its own, until it goes
/// out of scope, and shows it. Does nothing where there is no view.
class FollowedImage {
 public:
  FollowedImage(FarmClient& client, JobId job, Views& views);
  ~FollowedImage();

 private:
  void look();

  Views& views_;
  const JobId job_;
  const std::unique_ptr<FarmClient> client_;
  double next_ = 0;  ///< when to look again, in seconds of a steady clock
  std::optional<Ticker> ticker_;
};

}  // namespace bandsaw::coordinator
