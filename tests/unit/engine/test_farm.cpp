// A coordinator's engine on a temporary folder. Each call waits for the engine's answer.

#include "tests/unit/engine/test_farm.h"

#include <spdlog/spdlog.h>

#include <atomic>
#include <utility>

#include "absl/strings/str_cat.h"
#include "renderlib/package/package.h"
#include "renderlib/render/render_image.h"

namespace bandsaw::coordinator {

TestFarm::TestFarm() : maker_(test::cornell_box()), scene_(maker_.build()) {
  spdlog::set_level(spdlog::level::off);
}

absl::Status TestFarm::start(EngineDependencies dependencies, const Keep& keep) {
  engine_.reset();
  // Fake workers send no heartbeats. The timeouts are so long that no test depends on the speed of
  // the machine.
  absl::StatusOr<std::unique_ptr<Engine>> engine = Engine::start({.data_folder = folder_,
                                                                  .heartbeat_timeout_s = 1e6,
                                                                  .progress_timeout_s = 1e6,
                                                                  .reattach_grace_s = 0,
                                                                  .audit_share = 0,
                                                                  .keep = keep},
                                                                 std::move(dependencies));
  if (engine.ok()) {
    engine_ = *std::move(engine);
  }
  return engine.status();
}

DigestHex TestFarm::send_package() {
  BlobMap blobs;
  const std::string manifest = encode_package(maker_.scene,
                                              {.name = "test",
                                               .width = settings_.width,
                                               .height = settings_.height,
                                               .max_depth = settings_.max_depth,
                                               .warnings = {}},
                                              blobs);
  const auto* bytes = reinterpret_cast<const std::byte*>(manifest.data());
  const wire::Digest digest = blobs.put({bytes, bytes + manifest.size()});
  for (const auto& [name, blob] : blobs.all()) {
    auto writer = engine_->write_blob(name, blob.size());
    BANDSAW_CHECK(writer.ok() && (*writer)->append(blob).ok() && (*writer)->commit().ok(),
                  "the disk takes the blobs");
  }
  return digest.hex();
}

JobSpec TestFarm::spec(StopRule stop) {
  return {.request_id = "0123456789abcdef",
          .name = "test",
          .manifest = send_package(),
          .settings = settings_,
          .stop = stop};
}

absl::StatusOr<JobId> TestFarm::submit(const JobSpec& spec) {
  const auto box = std::make_shared<Box<absl::StatusOr<JobId>>>();
  engine_->submit(spec, [box](absl::StatusOr<JobId> job) { box->put(std::move(job)); });
  return box->take();
}

JobId TestFarm::begin(StopRule stop) {
  const absl::StatusOr<JobId> job = submit(spec(stop));
  BANDSAW_CHECK(job.ok(), "the job is valid");
  return *job;
}

JobView TestFarm::view(JobId job) {
  const auto box = std::make_shared<Box<absl::StatusOr<JobView>>>();
  engine_->watch(job, [box](absl::StatusOr<JobView> view) {
    box->put(std::move(view));
    return false;
  });
  return *box->take();
}

JobView TestFarm::wait_until(JobId job, const std::function<bool(const JobView&)>& fits) {
  const auto box = std::make_shared<Box<absl::StatusOr<JobView>>>();
  const auto stop = std::make_shared<std::atomic<bool>>(false);
  engine_->watch(job, [box, stop](absl::StatusOr<JobView> view) {
    box->put(std::move(view));
    return !*stop;
  });
  JobView view = *box->wait([&](const absl::StatusOr<JobView>& v) { return fits(*v); });
  *stop = true;
  return view;
}

JobView TestFarm::wait_final(JobId job) {
  return wait_until(job, [](const JobView& view) { return is_final(view.state); });
}

absl::StatusOr<StoredResult> TestFarm::result(JobId job, FinishedPart part) {
  const auto box = std::make_shared<Box<absl::StatusOr<StoredResult>>>();
  engine_->result(job, part, [box](absl::StatusOr<StoredResult> r) { box->put(std::move(r)); });
  return box->take();
}

absl::StatusOr<BandOutcome> TestFarm::put(JobId job, const BandPixels& pixels, std::uint64_t work,
                                          bool browser) {
  const auto box = std::make_shared<Box<absl::StatusOr<BandOutcome>>>();
  engine_->put_band(
      job, work, "nobody", pixels, /*render_s=*/0, /*cpu_s=*/0,
      [box](absl::StatusOr<BandOutcome> outcome) { box->put(std::move(outcome)); }, browser);
  return box->take();
}

std::vector<std::string> TestFarm::why(JobId job) {
  const auto box = std::make_shared<Box<std::vector<std::string>>>();
  engine_->why(job, [box](std::vector<std::string> lines) { box->put(std::move(lines)); });
  return box->take();
}

Image TestFarm::local(std::uint64_t samples) const {
  Pool pool(1);
  const std::atomic<bool> stop{false};
  const auto rendered = render_image(
      *scene_, settings_, samples, pool, stop, [](std::uint64_t) {}, "");
  BANDSAW_CHECK(rendered.ok(), "the scene is valid");
  return rendered->film.snapshot().image;
}

}  // namespace bandsaw::coordinator
