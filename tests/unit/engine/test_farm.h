#pragma once

// A coordinator's engine on a temporary folder, with the Cornell box as the scene of all jobs, and
// blocking calls for tests. The image has 20 x 14 pixels.

#include <memory>
#include <string>

#include "coordinator/engine/engine.h"
#include "renderlib/image/image.h"
#include "tests/support/scenes.h"
#include "tests/support/temp_dir.h"
#include "tests/unit/engine/box.h"

namespace bandsaw::coordinator {

class TestFarm {
 public:
  TestFarm();
  /// Starts the engine, or restarts it on the same folder.
  absl::Status start(EngineDependencies dependencies = {}, const Keep& keep = {});
  void stop() { engine_.reset(); }
  Engine& engine() { return *engine_; }
  const std::string& folder() const { return folder_; }

  /// Sends the blobs of the scene and returns the manifest's digest.
  DigestHex send_package();
  /// Sends the package, and returns the specification of a job with this stop rule.
  JobSpec spec(StopRule stop);
  absl::StatusOr<JobId> submit(const JobSpec& spec);
  /// Sends the package and submits a job; ends the test if that fails.
  JobId begin(StopRule stop);
  /// Returns the present state of the job.
  JobView view(JobId job);
  /// Waits until the job satisfies `fits`. `wait_final` waits until the job is final.
  JobView wait_until(JobId job, const std::function<bool(const JobView&)>& fits);
  JobView wait_final(JobId job);
  absl::StatusOr<StoredResult> result(JobId job, FinishedPart part = FinishedPart::kImage);
  /// Sends a band as a native worker does. If `browser` is true, sends the band as a browser does.
  /// `work`: the hash of scene and settings (render/work_hash.h) that the worker reports; 0: none.
  /// Returns what the engine did with the band.
  absl::StatusOr<BandOutcome> put(JobId job, const BandPixels& pixels, std::uint64_t work = 0,
                                  bool browser = false);
  std::string bands_file(JobId job) const {
    return folder_ + "/jobs/" + std::to_string(job) + "/bands";
  }
  /// Returns the sentences of `bandsaw why`: what the job waits for.
  std::vector<std::string> why(JobId job);

  std::shared_ptr<const Scene> scene() const { return scene_; }
  const RenderSettings& settings() const { return settings_; }
  /// Renders the image of a job with this number of samples without an engine.
  Image local(std::uint64_t samples) const;

 private:
  test::TempDir temp_;
  std::string folder_ = temp_ / "data";
  test::SceneMaker maker_;
  std::shared_ptr<const Scene> scene_;
  RenderSettings settings_{.width = 20, .height = 14, .max_depth = 4, .seed = 3};
  std::unique_ptr<Engine> engine_;
};

}  // namespace bandsaw::coordinator
