#pragma once

// Shows the current image of a job in the views of the command that watches it.

#include <memory>
#include <optional>

#include "coordinator/cli/base/ticker.h"
#include "coordinator/cli/farm/farm_client.h"
#include "coordinator/cli/progress/views.h"

namespace bandsaw::coordinator {

/// Periodically fetches a job's image from the farm, over a client of its own, and shows it, until
/// destroyed. Does nothing if there is no view.
class FollowedImage {
 public:
  FollowedImage(FarmClient& client, JobId job, Views& views);
  ~FollowedImage();

 private:
  void look();

  Views& views_;
  const JobId job_;
  const std::unique_ptr<FarmClient> client_;
  double next_ = 0;  ///< time of the next fetch, in seconds of a steady clock
  std::optional<Ticker> ticker_;
};

}  // namespace bandsaw::coordinator
