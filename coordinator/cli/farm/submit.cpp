// The command `bandsaw submit`: sends a scene to the farm and fetches the image. With --frames,
// submit_frames() does the work.

#include <atomic>
#include <utility>

#include "absl/strings/str_cat.h"
#include "coordinator/cli/base/json.h"
#include "coordinator/cli/farm/after_job.h"
#include "coordinator/cli/farm/farm_errors.h"
#include "coordinator/cli/farm/submit_frames.h"
#include "coordinator/cli/farm/upload.h"
#include "coordinator/cli/farm/watch_job.h"
#include "coordinator/cli/image/clean.h"
#include "coordinator/cli/image/layers.h"
#include "coordinator/cli/options/commands.h"
#include "coordinator/cli/options/output_names.h"
#include "coordinator/cli/scene/image_settings.h"
#include "coordinator/cli/scene/import_scene_file.h"
#include "coordinator/scheduler/api/job_spec.h"
#include "proto/convert/render_values.h"
#include "proto/link/random.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

/// Uploads the scene and submits the job. CANCELLED: a signal came.
absl::StatusOr<JobId> send_image(FarmClient& client, ImportedPackage& package,
                                 const farm::SubmitRequest& request, Verbosity verbosity,
                                 Process& process) {
  const Interrupts::Listener listener(process.interrupts, [&] { client.stop(); });
  verbosity.preview = false;  // there is no image to show at this stage
  ProgressDisplay display(process.console, verbosity);
  return send(client, package, request, display);
}

/// Renders an additional layer of an EXR file as a job of its own: `request` has the same scene and
/// another integrator. ABORTED: the job failed or was cancelled.
absl::StatusOr<Image> render_on_farm(FarmClient& client, ImportedPackage& package,
                                     farm::SubmitRequest request, ProgressDisplay& display) {
  request.set_request_id(link::random_hex(16));
  ASSIGN_OR_RETURN(const JobId job, send(client, package, request, display));
  ASSIGN_OR_RETURN(const Progress last, follow_job(client, job, display));
  if (last.job.state != JobState::kDone) {
    return absl::AbortedError(absl::StrCat("job ", job, ", which renders a layer, ",
                                           state_name(last.job.state),
                                           last.job.reason.empty() ? "" : ": ", last.job.reason));
  }
  ASSIGN_OR_RETURN(FarmImage result, client.result(job));
  return std::move(result.image);
}

/// Returns the options of `watch` by which the files are written, without the job's number.
WatchOptions watch_options(const SubmitOptions& options, std::vector<std::string> outputs) {
  return {.outputs = std::move(outputs),
          .farm = options.farm,
          .display = options.display,
          .report = options.report,
          .tev = options.tev,
          .verbosity = options.verbosity,
          .denoise = options.denoise,
          .after = options.after};
}

/// Prints the number of a job that is submitted with --detach.
void say_detached(JobId job, Verbosity verbosity, const Console& console) {
  if (verbosity.json) {
    console.line(JsonObject().text("event", "submitted").whole("job", job).str());
  } else {
    console.line(absl::StrCat("job ", job));
  }
}

}  // namespace

ExitCode run(const SubmitOptions& options, Process& process) {
  // Ignores SIGPIPE, so that the image is written even if the reader of standard output has ended.
  outlive_reader();
  const Console& console = process.console;
  std::vector<std::string> outputs = options.outputs;
  if (outputs.empty() && !options.detach) {
    outputs = {default_output(options.scene, options.frames.empty() ? ".png" : ".####.png")};
  }
  WatchOptions watch = watch_options(options, outputs);
  if (!options.frames.empty()) {
    const auto client = connect_to_farm(options.farm);
    return client.ok() ? submit_frames(**client, options, std::move(watch), process)
                       : console.fail(exit_code_of(client.status()),
                                      std::string(client.status().message()));
  }
  const auto reports =
      check_image_files(options.scene, options.outputs, outputs, options.denoise, options.report);
  if (!reports.ok()) {
    return console.fail(ExitCode::kWrong, std::string(reports.status().message()));
  }
  // Connects first: importing a large scene takes long, and would be useless without a farm.
  const auto client = connect_to_farm(options.farm);
  if (!client.ok()) {
    return console.fail(exit_code_of(client.status()), std::string(client.status().message()));
  }
  auto package =
      import_scene_file(options.scene, options.verbosity, process, options.image.choices);
  if (!package.ok()) {
    return console.fail(import_exit_code(package.status()),
                        std::string(package.status().message()));
  }
  const auto settings = image_settings(options.image, package->info());
  if (!settings.ok()) {
    return console.fail(ExitCode::kWrong, std::string(settings.status().message()));
  }
  if (const auto status = check_denoise(options.denoise, *settings, options.image.stop);
      !status.ok()) {
    return console.fail(ExitCode::kWrong, std::string(status.message()));
  }
  farm::SubmitRequest request = request_for(*package, *settings, options.image.stop);
  request.set_priority(options.priority);
  const auto job = send_image(**client, *package, request, options.verbosity, process);
  if (!job.ok()) {
    return console.fail(exit_code_of(job.status()), std::string(job.status().message()));
  }
  if (options.detach) {
    say_detached(*job, options.verbosity, console);
    return ExitCode::kDone;
  }
  const auto layers = [&](std::uint64_t samples, ProgressDisplay& display) {
    const auto render = [&](const RenderSettings& layer, std::uint64_t count) {
      farm::SubmitRequest of_layer = request;
      *of_layer.mutable_settings() = bandsaw::to_message(layer);
      *of_layer.mutable_stop() = to_message(StopRule(StopAtSamples{count}));
      return render_on_farm(**client, *package, std::move(of_layer), display);
    };
    SampleCounts counts;
    if (is_adaptive(options.image.stop)) {
      counts = [&] { return (*client)->samples(*job); };
    }
    return make_layers(options.layers, *settings, samples, render, counts);
  };
  watch.job = *job;
  const ExitCode code = watch_job(**client, watch, *reports, process, layers);
  std::vector<std::string> files = outputs;
  files.insert(files.end(), reports->begin(), reports->end());
  return run_after(watch, **client, outputs, files, code, process);
}

}  // namespace bandsaw::coordinator
