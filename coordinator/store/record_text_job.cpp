// Text of records about jobs and sequences: their specifications, the plans of adaptive jobs (how
// many samples each part of the image gets), and the scenes of frames. The functions write and read
// the fields in the same order.

#include "coordinator/store/record_text_parts.h"

#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "coordinator/scheduler/api/frame_numbers.h"
#include "renderlib/scene/guide_integrators.h"

namespace bandsaw::coordinator {
namespace {

void write_stop(FieldWriter& out, const StopRule& stop) {
  if (const auto* samples = std::get_if<StopAtSamples>(&stop)) {
    out.text("stop", "samples");
    out.number("samples", samples->samples);
  } else if (const auto* error = std::get_if<StopAtError>(&stop)) {
    out.text("stop", error->adaptive ? "adaptive_error" : "error");
    out.real("relative_rmse", error->relative_rmse);
    out.number("max_samples", error->max_samples);
  } else if (const auto* time = std::get_if<StopAtTime>(&stop)) {
    out.text("stop", "time");
    out.real("seconds", time->seconds);
    out.number("max_samples", time->max_samples);
  }
}

// Braced initialisers are evaluated in the order in which they are written, which is the order of
// the fields.

StopRule read_stop(FieldReader& in) {
  const std::string kind = in.text("stop");
  if (kind == "samples") {
    return StopAtSamples{.samples = in.number("samples")};
  }
  if (kind == "error" || kind == "adaptive_error") {
    return StopAtError{.relative_rmse = in.real("relative_rmse"),
                       .max_samples = in.number("max_samples"),
                       .adaptive = kind == "adaptive_error"};
  }
  if (kind == "time") {
    return StopAtTime{.seconds = in.real("seconds"), .max_samples = in.number("max_samples")};
  }
  in.refuse(absl::StrCat("field 'stop': unknown rule '", kind, "'"));
  return {};
}

RenderSettings read_settings(FieldReader& in) {
  return {.width = static_cast<std::uint32_t>(in.number("width", kMaxSide)),
          .height = static_cast<std::uint32_t>(in.number("height", kMaxSide)),
          .max_depth = static_cast<std::uint32_t>(in.number("max_depth", kMaxDepth)),
          .seed = in.number("seed"),
          // Journals of the schema versions that had a single integrator lack this field.
          .integrator = in.next_is("integrator")
                            ? static_cast<Integrator>(in.number("integrator", kLastGuideIntegrator))
                            : Integrator::kPath};
}

void write_settings(FieldWriter& out, const RenderSettings& settings) {
  out.number("width", settings.width);
  out.number("height", settings.height);
  out.number("max_depth", settings.max_depth);
  out.number("seed", settings.seed);
  out.number("integrator", static_cast<std::uint64_t>(settings.integrator));
}

/// Frame numbers are stored with an offset, because fields hold no signed numbers.
void write_number(FieldWriter& out, FrameNumber number) {
  out.number("frame_plus_most", static_cast<std::uint64_t>(number + kMaxFrameNumber));
}

FrameNumber read_number(FieldReader& in) {
  return static_cast<FrameNumber>(
             in.number("frame_plus_most", static_cast<std::uint64_t>(2 * kMaxFrameNumber))) -
         kMaxFrameNumber;
}

/// Reads the size of the scene package. Returns 0 (unknown) for journals of schema versions below
/// 10, which lack this field.
std::uint64_t read_package_bytes(FieldReader& in) {
  return in.next_is("package_bytes") ? in.number("package_bytes") : 0;
}

}  // namespace

void write_job(FieldWriter& out, const record::JobAdded& added) {
  out.number("job", added.job);
  out.number("pixel_version", added.pixel_version);
  if (added.spec.sequence != 0) {
    out.number("sequence", added.spec.sequence);
    write_number(out, added.spec.frame);
  }
  out.text("request_id", added.spec.request_id);
  out.text("name", added.spec.name);
  out.text("manifest", added.spec.manifest);
  out.number("package_bytes", added.spec.package_bytes);
  write_settings(out, added.spec.settings);
  write_stop(out, added.spec.stop);
}

record::JobAdded read_job(FieldReader& in) {
  const JobId job = in.number("job");
  const std::uint64_t version =
      in.next_is("pixel_version") ? in.number("pixel_version", UINT32_MAX) : 0;
  JobSpec spec;
  if (in.next_is("sequence")) {
    spec.sequence = in.number("sequence");
    spec.frame = read_number(in);
  }
  spec.request_id = in.text("request_id");
  spec.name = in.text("name");
  spec.manifest = in.text("manifest");
  spec.package_bytes = read_package_bytes(in);
  spec.settings = read_settings(in);
  spec.stop = read_stop(in);
  return {
      .job = job, .spec = std::move(spec), .pixel_version = static_cast<std::uint32_t>(version)};
}

void write_tiles(FieldWriter& out, const record::TilesPlanned& r) {
  out.number("job", r.job);
  out.number("pilot", r.plan.pilot);
  out.text("levels", r.plan.levels);
}

record::TilesPlanned read_tiles(FieldReader& in) {
  record::TilesPlanned planned{
      .job = in.number("job"),
      .plan = {.pilot = in.number("pilot", kMaxSamples), .levels = in.text("levels")}};
  if (planned.plan.levels.find_first_not_of("0123456789abcdef") != std::string::npos) {
    in.refuse("field 'levels': must be digits 0 to f");
  }
  return planned;
}

void write_sequence(FieldWriter& out, const record::SequenceAdded& added) {
  out.number("job", added.job);
  out.number("pixel_version", added.pixel_version);
  out.text("request_id", added.spec.request_id);
  out.text("name", added.spec.name);
  write_settings(out, added.spec.settings);
  write_stop(out, added.spec.stop);
  out.number("fixed_seed", added.spec.fixed_seed ? 1 : 0);
  out.text("frames", frames_text(added.spec.frames));
}

record::SequenceAdded read_sequence(FieldReader& in) {
  record::SequenceAdded added{
      .job = in.number("job"),
      .spec = {},
      .pixel_version = static_cast<std::uint32_t>(in.number("pixel_version", UINT32_MAX))};
  added.spec.request_id = in.text("request_id");
  added.spec.name = in.text("name");
  added.spec.settings = read_settings(in);
  added.spec.stop = read_stop(in);
  added.spec.fixed_seed = in.number("fixed_seed", 1) == 1;
  absl::StatusOr<std::vector<FrameNumber>> frames = parse_frames(in.text("frames"));
  if (frames.ok()) {
    added.spec.frames = *std::move(frames);
  } else {
    in.refuse(absl::StrCat("field 'frames': ", frames.status().message()));
  }
  return added;
}

void write_frame(FieldWriter& out, const record::FrameWaits& r) {
  out.number("job", r.job);
  write_number(out, r.frame);
  out.text("manifest", r.manifest);
  out.number("package_bytes", r.package_bytes);
  out.number("failures", r.failures);
  out.text("reason", r.reason);
}

record::FrameWaits read_frame(FieldReader& in) {
  return {.job = in.number("job"),
          .frame = read_number(in),
          .manifest = in.text("manifest"),
          .package_bytes = read_package_bytes(in),
          .failures = static_cast<std::uint32_t>(in.number("failures", UINT32_MAX)),
          .reason = in.text("reason")};
}

}  // namespace bandsaw::coordinator
