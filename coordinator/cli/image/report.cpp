// Builds the report of an image as one JSON object. Each function X_json() makes the object of one
// of its fields; coordinator/README.md documents these fields. known_number() writes null for a
// negative value, which stands for an unknown one.

#include "coordinator/cli/image/report.h"

#include <optional>
#include <span>

#include "coordinator/cli/progress/progress_json.h"
#include "proto/wire/digest.h"
#include "renderlib/render/pixel_version.h"

namespace bandsaw::coordinator {
namespace {

constexpr double kOnePercent = 0.01;

JsonObject settings_json(const JobSpec& spec) {
  JsonObject out;
  out.whole("width", spec.settings.width)
      .whole("height", spec.settings.height)
      .whole("max_depth", spec.settings.max_depth)
      .whole("seed", spec.settings.seed)
      .text("integrator", integrator_name(spec.settings.integrator));
  add_stop(out, spec.stop);
  return out;
}

JsonObject error_json(const ErrorEstimate& estimate) {
  return JsonObject()
      .text("method", "halves")
      .number("relative_rmse", estimate.relative_rmse)
      .number("relative_rmse_at_most", estimate.at_most())
      .number("rmse", estimate.rmse)
      .number("mean", estimate.mean)
      .number("relative_mse", estimate.relative_mse)
      .number("pixel_median", estimate.median)
      .number("pixel_percentile_95", estimate.percentile_95)
      .number("pixel_percentile_99", estimate.percentile_99)
      .number("worst_pixels_share", estimate.worst_share)
      .flag("doubtful", estimate.doubtful());
}

std::vector<JsonObject> curve_json(const ErrorCurve& curve) {
  std::vector<JsonObject> out;
  for (const ErrorPoint& point : curve) {
    out.push_back(JsonObject()
                      .whole("samples_per_pixel", point.samples)
                      .number("relative_rmse", point.estimate.relative_rmse)
                      .number("relative_rmse_at_most", point.estimate.at_most())
                      .number("relative_mse", point.estimate.relative_mse)
                      .number("elapsed_s", point.elapsed_s)
                      .number("cpu_s", point.cpu_s));
  }
  return out;
}

JsonObject time_json(const JobView& job) {
  return JsonObject()
      .known_number("elapsed_s", job.elapsed_s)
      .known_number("cpu_s", job.cpu_s > 0 ? job.cpu_s : -1)
      .known_number("cpu_s_to_1_percent", cpu_s_until(job.curve, kOnePercent).value_or(-1));
}

JsonObject work_json(const JobView& job) {
  const std::uint32_t techniques = job.counters.techniques;
  return JsonObject()
      .whole("samples_per_pixel", job.samples_per_pixel)
      .whole("samples", job.samples_done)
      .whole("rays", job.counters.rays)
      .flag("path_guiding", (techniques & Counters::kPathGuiding) != 0)
      .flag("photon_maps", (techniques & Counters::kPhotonMaps) != 0)
      .flag("indirect_photon_maps", (techniques & Counters::kIndirectMaps) != 0)
      .flag("portals", (techniques & Counters::kPortals) != 0)
      .whole("training_rays", job.counters.training_rays);
}

JsonObject health_json(const Report& report) {
  const Progress& progress = report.progress;
  const Counters& counters = progress.job.counters;
  JsonObject out;
  out.whole("bad_samples", counters.bad_samples)
      .whole("not_finite_samples", counters.bad_samples - counters.negative_samples)
      .whole("negative_samples", counters.negative_samples)
      .whole("truncated_paths", counters.truncated_paths)
      .whole("dropped_primitives", counters.dropped_primitives)
      .whole("cut_off_values", report.cut_off_values);
  return counters.bad_samples == 0 ? out.unknown("first_bad_sample")
                                   : out.text("first_bad_sample", progress.bad_sample_at);
}

JsonObject machines_json(const Progress& progress) {
  JsonObject out;
  const JobView& job = progress.job;
  out.known_number("mrays_per_cpu_s",
                   job.cpu_s > 0 ? static_cast<double>(job.counters.rays) / job.cpu_s / 1e6 : -1);
  // Only a render on this machine has a number of threads. Other reports list the workers.
  if (progress.threads > 0) {
    return out.whole("threads", static_cast<std::uint64_t>(progress.threads));
  }
  std::vector<JsonObject> workers;
  for (const WorkerShare& share : job.shares) {
    JsonObject worker;
    share.name.empty() ? worker.unknown("name") : worker.text("name", share.name);
    workers.push_back(worker.whole("samples", share.samples).number("cpu_s", share.cpu_s));
  }
  return out.whole("workers_used", job.workers_used).objects("workers", workers);
}

JsonObject hashes_json(const Report& report) {
  JsonObject out;
  out.text("package_sha256", report.progress.job.spec.manifest);
  return report.pixels_sha256.empty() ? out.unknown("pixels_sha256")
                                      : out.text("pixels_sha256", report.pixels_sha256);
}

JsonObject clean_json(const Report::Clean& clean) {
  return JsonObject()
      .text("method", clean.method)
      .flag("same_bits_on_all_machines", clean.same_bits)
      .number("relative_rmse_raw", clean.error.relative_raw())
      .number("relative_rmse_clean", clean.error.relative_clean())
      .number("relative_rmse_at_most", clean.error.at_most())
      .number("rmse_raw", clean.error.rmse_raw)
      .number("rmse_clean", clean.error.rmse_clean)
      .number("bias_share", clean.error.bias_share)
      .text("pixels_sha256", clean.pixels_sha256)
      .texts("raw_outputs", clean.raw_outputs);
}

JsonObject program_json() {
  return JsonObject().text("version", BANDSAW_VERSION).whole("pixel_version", kPixelVersion);
}

}  // namespace

std::string pixels_sha256(const Image& image) {
  static_assert(sizeof(Rgb) == 3 * sizeof(float), "pixels are three floats without gaps");
  return wire::sha256(std::as_bytes(std::span(image.pixels))).hex();
}

std::string report_text(const Report& report) {
  const JobView& job = report.progress.job;
  JsonObject out;
  out.text("schema", "bandsaw.report/1");
  job.spec.name.empty() ? out.unknown("scene") : out.text("scene", job.spec.name);
  out.object("settings", settings_json(job.spec));
  job.curve.empty() ? out.unknown("error")
                    : out.object("error", error_json(job.curve.back().estimate));
  report.clean ? out.object("denoise", clean_json(*report.clean)) : out.unknown("denoise");
  return out.objects("curve", curve_json(job.curve))
      .object("time", time_json(job))
      .object("work", work_json(job))
      .object("machines", machines_json(report.progress))
      .object("health", health_json(report))
      .object("hashes", hashes_json(report))
      .object("program", program_json())
      .texts("outputs", report.outputs)
      .lines();
}

}  // namespace bandsaw::coordinator
