// Starts a coordinator with a dashboard for tests, and sends the requests of a browser.

#include "tests/unit/web/web_farm.h"

#include <google/protobuf/util/json_util.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <future>
#include <sstream>

#include "absl/strings/match.h"
#include "coordinator/engine/blocking_call.h"
#include "renderlib/base/check.h"
#include "tests/support/scenes.h"

namespace bandsaw::coordinator {
namespace {

/// Stores a blob on the farm.
absl::Status put(Engine& engine, const wire::Digest& digest, absl::Span<const std::byte> bytes) {
  auto writer = engine.write_blob(digest, bytes.size());
  absl::Status status = writer.status();
  if (status.ok()) {
    status = (*writer)->append(bytes);
  }
  return status.ok() ? (*writer)->commit() : status;
}

/// Stores a package of the Cornell box on the farm. The package has the name of the scene file
/// `path`. INVALID_ARGUMENT: the file contains "broken".
absl::StatusOr<SceneOnFarm> bring_box(Engine& engine, const std::string& path) {
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  if (absl::StrContains(text.str(), "broken")) {
    return absl::InvalidArgumentError("scene.textproto:1:1: it is broken");
  }
  BlobMap blobs;
  PackageInfo info;
  info.name = std::filesystem::path(path).stem();
  info.warnings = {"nothing was left out"};
  const std::string manifest = encode_package(test::cornell_box().scene, info, blobs);
  const auto* const bytes = reinterpret_cast<const std::byte*>(manifest.data());
  blobs.put(std::vector<std::byte>(bytes, bytes + manifest.size()));
  for (const auto& [digest, content] : blobs.all()) {
    if (const absl::Status status = put(engine, digest, absl::MakeConstSpan(content));
        !status.ok()) {
      return status;
    }
  }
  return SceneOnFarm{wire::sha256(manifest).hex(), info};
}

}  // namespace

WebTest::WebTest() : identity_(*link::load_or_make_identity(folder_ / "identity")) {
  auto engine =
      Engine::start({.data_folder = folder_ / "data", .reattach_grace_s = 0.1, .audit_share = 0});
  BANDSAW_CHECK(engine.ok(), engine.status().ToString().c_str());
  engine_ = *std::move(engine);
  std::filesystem::create_directory(folder_ / "gallery");
  std::ofstream(folder_ / "gallery/box.textproto") << "# A box.\n# With a lamp.\n\n# Walls\n";
  access_ = *BrowserAccess::load(folder_ / "identity");
  DashboardOptions& options = options_;
  options.browsers = access_.get();
  options.browser_program = {.bytes = "the renderer", .compressed = "smaller", .tag = "0123"};
  options.port = 0;
  options.gallery = folder_ / "gallery";
  const std::string bytes(3 << 20, 'w');
  options.workers = {
      {.version = "1.2.3", .bytes = bytes, .digest = wire::sha256(bytes)},
      {.machine = kOtherMachine, .version = "1.2.4", .bytes = "o", .digest = wire::sha256("o")}};
  options.import_scene = [this](const std::string& path, const std::string& inside,
                                const std::atomic<bool>&) -> absl::StatusOr<SceneOnFarm> {
    if (!inside.empty()) {
      return absl::NotFoundError("there is no \"" + inside + "\" in it");
    }
    return bring_box(*engine_, path);
  };
  options.report = [](const JobView& job, const Image&) { return job.spec.name; };
  start_dashboard();
}

void WebTest::start_dashboard() {
  dashboard_.reset();
  auto dashboard = Dashboard::start(*engine_, identity_, options_);
  BANDSAW_CHECK(dashboard.ok(), dashboard.status().ToString().c_str());
  dashboard_ = *std::move(dashboard);
  access_->set_address(base());
}

WebTest::~WebTest() {
  dashboard_.reset();
  engine_.reset();
}

WebTest::Answer WebTest::get(const std::string& path) {
  return test::http_call(dashboard_->port(), {.target = path, .headers = headers_});
}

WebTest::Answer WebTest::post(const std::string& path, const std::string& body) {
  return test::http_call(dashboard_->port(),
                         {.method = "POST", .target = path, .headers = headers_, .body = body});
}

void WebTest::log_in() {
  const auto result = post("/api/login", "{\"secret\": \"" + identity_.farm_secret + "\"}");
  ASSERT_TRUE(result && result->status == 200);
  const std::string cookie = result->header("Set-Cookie");
  headers_.emplace("Cookie", cookie.substr(0, cookie.find(';')));
}

std::uint64_t WebTest::submit_box() {
  return message<web::Submitted>(post("/api/scenes?name=box.textproto&width=24", "a box")).job();
}

void WebTest::put(std::uint64_t job, std::uint32_t width, std::uint32_t height,
                  const SampleRange& samples, double value) {
  const double sum = static_cast<double>(samples.samples()) * value;
  const BandPixels pixels{.band = {.samples = samples, .rows = {0, height}},
                          .width = width,
                          .sums = std::vector<double>(std::size_t{width} * height * 3, sum),
                          .counters = {}};
  using Put = absl::StatusOr<BandOutcome>;
  const Put outcome = blocking_call<Put>([&](auto answer) {
    engine_->put_band(job, /*work=*/0, std::string(32, 'a'), pixels, /*render_s=*/0,
                      /*cpu_s=*/0, answer);
  });
  ASSERT_TRUE(outcome.ok()) << outcome.status();
}

void WebTest::finish(std::uint64_t job, std::uint32_t width, std::uint32_t height,
                     std::uint64_t samples, std::uint64_t first) {
  for (std::uint64_t sample = first; sample < samples; sample += kBlockSamples) {
    const SampleRange band{sample, std::min(sample + kBlockSamples, samples)};
    ASSERT_NO_FATAL_FAILURE(put(job, width, height, band, 0.5));
  }
  const auto done = std::make_shared<std::promise<void>>();
  engine_->watch(job, [done](const absl::StatusOr<JobView>& view) {
    const bool is_done = view.ok() && view->state == JobState::kDone;
    if (is_done) {
      done->set_value();
    }
    return !is_done;
  });
  done->get_future().wait();
}

void WebTest::read(const Answer& result, google::protobuf::Message& out) {
  ASSERT_TRUE(result) << "no answer came";
  EXPECT_EQ(result->header("Content-Type"), "application/json");
  const auto status = google::protobuf::util::JsonStringToMessage(result->body, &out);
  EXPECT_TRUE(status.ok()) << status.ToString() << ": " << result->body;
}

}  // namespace bandsaw::coordinator
