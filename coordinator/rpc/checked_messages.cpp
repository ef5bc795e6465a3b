// Each function checks every field of one message and returns the value that the scheduler takes.

#include <algorithm>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "coordinator/convert/farm_messages.h"
#include "coordinator/rpc/checked_messages.h"
#include "coordinator/scheduler/api/frame_numbers.h"
#include "proto/convert/render_values.h"
#include "proto/wire/limits.h"
#include "renderlib/base/clean_text.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/scene/guide_integrators.h"

namespace bandsaw::coordinator {
namespace {

template <class... Parts>
absl::Status invalid(const char* field, const Parts&... parts) {
  return absl::InvalidArgumentError(absl::StrCat(field, ": ", parts...));
}

absl::Status check_range(const char* field, std::uint64_t value, std::uint64_t least,
                         std::uint64_t most) {
  if (value < least || value > most) {
    return invalid(field, "must lie in [", least, ", ", most, "], is ", value);
  }
  return absl::OkStatus();
}

/// Names and reasons are printed on terminals, so control characters are refused.
absl::Status check_text(const char* field, const std::string& text, std::size_t most) {
  if (text.size() > most) {
    return invalid(field, "at most ", most, " bytes, has ", text.size());
  }
  if (clean_text(text, most) != text) {
    return invalid(field, "must not hold control characters");
  }
  return absl::OkStatus();
}

/// Checks and converts a lease that a worker still holds when it connects.
absl::StatusOr<WorkerHello::Held> held_lease(const farm::Held& message) {
  WorkerHello::Held held{.job = message.job(),
                         .band = {},
                         .lease = message.lease(),
                         .epoch = message.epoch(),
                         .finished = message.finished(),
                         .work = message.work()};
  RETURN_IF_ERROR(check_text("hello.held.epoch", held.epoch, wire::kWorkerNameBytes));
  ASSIGN_OR_RETURN(held.band, band("hello.held.band", message.band()));
  return held;
}

}  // namespace

absl::StatusOr<wire::Digest> digest_field(const char* field, const std::string& raw) {
  absl::StatusOr<wire::Digest> digest = wire::digest_from_raw(raw);
  if (!digest.ok()) {
    return invalid(field, "must be 32 bytes, is ", raw.size());
  }
  return digest;
}

namespace {

absl::Status check_request_id(const std::string& id) {
  const bool plain = std::all_of(id.begin(), id.end(), [](char c) {
    return absl::ascii_isalnum(c) || c == '-' || c == '_' || c == '.';
  });
  if (id.size() < 16 || id.size() > 64 || !plain) {
    return invalid("request_id", "must be 16 to 64 letters, digits, or any of - _ .");
  }
  return absl::OkStatus();
}

absl::StatusOr<RenderSettings> image_settings(const farm::Settings& message) {
  const RenderSettings settings = settings_of(message);
  RETURN_IF_ERROR(validate(settings));
  return settings;
}

}  // namespace

absl::StatusOr<SequenceSpec> sequence_spec(const farm::SubmitSequenceRequest& request) {
  RETURN_IF_ERROR(check_request_id(request.request_id()));
  RETURN_IF_ERROR(check_text("name", request.name(), wire::kJobNameBytes));
  SequenceSpec spec;
  spec.request_id = request.request_id();
  spec.name = request.name();
  ASSIGN_OR_RETURN(spec.settings, image_settings(request.settings()));
  if (is_guide(spec.settings.integrator)) {
    return absl::InvalidArgumentError(
        "integrator: a sequence cannot render guides, which are images for the denoiser only");
  }
  ASSIGN_OR_RETURN(spec.stop, stop_rule_of(request.stop()));
  spec.fixed_seed = request.fixed_seed();
  auto frames = parse_frames(request.frames());
  if (!frames.ok()) {
    return invalid("frames", frames.status().message());
  }
  spec.frames = *std::move(frames);
  return spec;
}

absl::StatusOr<std::vector<FrameScene>> frame_scenes(const farm::AddFramesRequest& request) {
  RETURN_IF_ERROR(check_range("scene (count)", static_cast<std::uint64_t>(request.scene_size()), 1,
                              wire::kFramesPerMessage));
  std::vector<FrameScene> scenes;
  for (const farm::FrameScene& scene : request.scene()) {
    ASSIGN_OR_RETURN(const wire::Digest manifest,
                     digest_field("scene.manifest_sha256", scene.manifest_sha256()));
    scenes.push_back({scene.frame(), manifest.hex()});
  }
  return scenes;
}

absl::StatusOr<std::vector<FrameNumber>> frame_numbers(const farm::RetryFramesRequest& request) {
  RETURN_IF_ERROR(check_range("frame (count)", static_cast<std::uint64_t>(request.frame_size()), 0,
                              kMaxFrames));
  std::vector<FrameNumber> frames(request.frame().begin(), request.frame().end());
  std::sort(frames.begin(), frames.end());
  frames.erase(std::unique(frames.begin(), frames.end()), frames.end());
  return frames;
}

absl::StatusOr<JobSpec> job_spec(const farm::SubmitRequest& request) {
  RETURN_IF_ERROR(check_request_id(request.request_id()));
  RETURN_IF_ERROR(check_text("name", request.name(), wire::kJobNameBytes));
  ASSIGN_OR_RETURN(const wire::Digest manifest,
                   digest_field("manifest_sha256", request.manifest_sha256()));
  ASSIGN_OR_RETURN(const RenderSettings settings, image_settings(request.settings()));
  ASSIGN_OR_RETURN(StopRule stop, stop_rule_of(request.stop()));
  return JobSpec{.request_id = request.request_id(),
                 .name = request.name(),
                 .manifest = manifest.hex(),
                 .settings = settings,
                 .stop = stop};
}

absl::StatusOr<Band> band(const char* field, const farm::Band& message) {
  const Band band = band_of(message);
  if (band.samples.first >= band.samples.last || band.samples.last > kMaxSamples) {
    return invalid(field, "samples must be a range within [0, ", kMaxSamples, "], are [",
                   band.samples.first, ", ", band.samples.last, ")");
  }
  // A node is an aligned range of a power-of-two number of blocks of 8 samples.
  if (!is_node(band.samples)) {
    return invalid(field, "samples must be an aligned range of 2^k blocks of ", kBlockSamples,
                   " samples, are [", band.samples.first, ", ", band.samples.last, ")");
  }
  if (band.rows.first >= band.rows.last || band.rows.last > kMaxSide) {
    return invalid(field, "rows must be a range within [0, ", kMaxSide, "], are [", band.rows.first,
                   ", ", band.rows.last, ")");
  }
  return band;
}

absl::StatusOr<WorkerHello> worker_hello(const farm::Hello& message, std::string address) {
  const std::string& instance = message.instance();
  if (instance.size() != 32 ||
      !std::all_of(instance.begin(), instance.end(), absl::ascii_isxdigit)) {
    return invalid("hello.instance", "must be 32 hexadecimal digits");
  }
  RETURN_IF_ERROR(check_text("hello.name", message.name(), wire::kWorkerNameBytes));
  RETURN_IF_ERROR(check_text("hello.build", message.build(), wire::kReasonBytes));
  RETURN_IF_ERROR(check_range("hello.threads", message.threads(), 1, wire::kThreadsPerWorker));
  RETURN_IF_ERROR(check_range("hello.max_bands", message.max_bands(), 1, wire::kBandsPerWorker));
  RETURN_IF_ERROR(check_range("hello.held (count)", static_cast<std::uint64_t>(message.held_size()),
                              0, wire::kBandsPerWorker));
  WorkerHello hello{.instance = instance,
                    .name = message.name().empty() ? "worker" : message.name(),
                    .address = std::move(address),
                    .build = message.build(),
                    .protocol = message.protocol(),
                    .pixel_version = message.pixel_version(),
                    .canary = message.canary(),
                    .threads = message.threads(),
                    .max_bands = message.max_bands(),
                    .memory_bytes = message.memory_bytes(),
                    .held = {}};
  for (const farm::Held& held : message.held()) {
    ASSIGN_OR_RETURN(WorkerHello::Held converted, held_lease(held));
    hello.held.push_back(std::move(converted));
  }
  return hello;
}

absl::StatusOr<input::Heartbeat> heartbeat(const farm::Heartbeat& message) {
  RETURN_IF_ERROR(check_range("heartbeat.lease (count)",
                              static_cast<std::uint64_t>(message.lease_size()), 0,
                              wire::kBandsPerWorker));
  RETURN_IF_ERROR(check_text("heartbeat.doing", message.doing(), wire::kReasonBytes));
  input::Heartbeat beat{.session = 0, .leases = {}, .doing = message.doing()};
  for (const farm::LeaseProgress& lease : message.lease()) {
    RETURN_IF_ERROR(check_range("heartbeat.lease.rows_done", lease.rows_done(), 0, kMaxSide));
    beat.leases.push_back(
        {.lease = lease.lease(), .rows_done = lease.rows_done(), .prepared = lease.prepared()});
  }
  return beat;
}

absl::StatusOr<std::vector<std::string>> log_lines(
    const char* field, const google::protobuf::RepeatedPtrField<std::string>& lines) {
  RETURN_IF_ERROR(check_range(absl::StrCat(field, " (count)").c_str(),
                              static_cast<std::uint64_t>(lines.size()), 0, wire::kLogLines));
  for (const std::string& line : lines) {
    RETURN_IF_ERROR(check_text(field, line, wire::kLogLineBytes));
  }
  return std::vector<std::string>(lines.begin(), lines.end());
}

absl::StatusOr<input::BandFailed> band_failed(const farm::BandFailed& message) {
  RETURN_IF_ERROR(check_text("failed.reason", message.reason(), wire::kReasonBytes));
  ASSIGN_OR_RETURN(std::vector<std::string> log, log_lines("failed.log", message.log()));
  return input::BandFailed{
      .session = 0, .lease = message.lease(), .reason = message.reason(), .log = std::move(log)};
}

absl::StatusOr<std::string> reason_field(const char* field, const std::string& text) {
  RETURN_IF_ERROR(check_text(field, text, wire::kReasonBytes));
  return text;
}

}  // namespace bandsaw::coordinator
