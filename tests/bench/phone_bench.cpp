// Times the 23 images of a study of ray tracing on phones (renderlib/gallery/study) on one thread,
// on all threads, and on a farm if there is one. phone_study.h says what is known of the study.

#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <set>
#include <thread>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "coordinator/cli/base/program_folder.h"
#include "coordinator/cli/base/text.h"
#include "coordinator/cli/farm/farm_errors.h"
#include "coordinator/cli/farm/upload.h"
#include "coordinator/cli/farm/watch_job.h"
#include "coordinator/cli/image/output.h"
#include "coordinator/cli/options/commands.h"
#include "coordinator/cli/scene/image_settings.h"
#include "coordinator/cli/scene/import_scene_file.h"
#include "coordinator/cli/study/study_outputs.h"
#include "coordinator/engine/clock.h"
#include "coordinator/scheduler/api/job_spec.h"
#include "renderlib/base/cpu_name.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/render/render_image.h"
#include "tests/bench/phone_study.h"

namespace bandsaw::coordinator {
namespace {

struct PhoneStudyOptions {
  std::vector<std::string> images;  ///< beginnings of image names; empty: all images
  std::vector<std::string> outputs = {"phone.csv", "phone.svg"};
  int runs = 10;                       ///< runs of each image on each machine
  std::optional<std::uint32_t> width;  ///< pixels; std::nullopt: as in the study
  int threads = 0;                     ///< of the runs on all threads; 0: one for each CPU
  FarmOption farm;                     ///< empty: the default farm, if there is one
  Verbosity verbosity;
};

constexpr std::uint64_t kSamples = 1;  // per pixel, as in the study

/// Returns the peak resident memory of this process, in MB.
double peak_mb() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  return static_cast<double>(used.ru_maxrss) * 1024 / 1e6;
}

/// Imports the images. Renders each image several times on one thread, on all threads, and on the
/// farm if there is one.
class PhoneRun {
 public:
  PhoneRun(const PhoneStudyOptions& options, Process& process, FarmClient* client,
           const std::atomic<bool>& stop)
      : options_(options),
        process_(process),
        client_(client),
        stop_(stop),
        one_(1),
        all_(options.threads > 0
                 ? options.threads
                 : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()))) {}

  /// Returns the times of the images of these names. CANCELLED: `stop` was set.
  absl::StatusOr<PhoneStudy> measured(const std::set<std::string>& names) {
    PhoneStudy study;
    study.machine = cpu_name();
    study.threads = all_.threads();
    if (client_ != nullptr) {
      ASSIGN_OR_RETURN(study.farm, farm_text());
    }
    for (const PhoneTable& table : phone_tables()) {
      ASSIGN_OR_RETURN(std::vector<Prepared> images, prepared(table, names));
      if (!options_.verbosity.quiet && !images.empty()) {
        process_.console.line(absl::StrCat(table.title, ": ", images.size(), " images, ",
                                           options_.runs, " times each"));
      }
      // Runs alternate between the images, so that other load on the machine affects all rows of a
      // table equally.
      for (int run = 0; run < options_.runs; ++run) {
        for (Prepared& image : images) {
          RETURN_IF_ERROR(time_once(image));
        }
      }
      for (Prepared& image : images) {
        study.images.push_back(std::move(image.times));
      }
    }
    study.peak_mb = peak_mb();
    return study;
  }

 private:
  /// Describes the farm: "3 workers, 24 threads". FAILED_PRECONDITION: it has no worker.
  absl::StatusOr<std::string> farm_text() {
    ASSIGN_OR_RETURN(const farm::ListWorkersReply reply, client_->workers());
    int workers = 0;
    std::uint64_t threads = 0;
    for (const farm::WorkerStatus& worker : reply.worker()) {
      if (worker.state() == "idle" || worker.state() == "rendering") {
        ++workers;
        threads += worker.threads();
      }
    }
    return workers > 0
               ? absl::StatusOr<std::string>(
                     absl::StrCat(workers, workers == 1 ? " worker, " : " workers, ", threads,
                                  threads == 1 ? " thread" : " threads"))
               : absl::FailedPreconditionError(absl::StrCat("the farm at ", client_->address(),
                                                            " has no worker; start one first"));
  }

  /// An imported image and its times so far.
  struct Prepared {
    ImportedPackage package;
    SceneDescription scene;
    RenderSettings settings;
    PhoneImage times;
  };

  /// Imports the images of the table that are in `names`.
  absl::StatusOr<std::vector<Prepared>> prepared(const PhoneTable& table,
                                                 const std::set<std::string>& names) {
    std::vector<Prepared> out;
    for (const PhoneRow& row : table.rows) {
      if (!names.contains(row.image)) {
        continue;
      }
      const std::string file = absl::StrCat(gallery_folder(), "/study/", row.image, ".textproto");
      ASSIGN_OR_RETURN(ImportedPackage package,
                       import_scene_file(file, options_.verbosity, process_));
      ASSIGN_OR_RETURN(SceneDescription scene, decode_package(package.manifest(), package.blobs()));
      ImageOptions image;
      image.width = options_.width;
      ASSIGN_OR_RETURN(const RenderSettings settings, image_settings(image, package.info()));
      PhoneImage times;
      times.name = row.image;
      out.push_back({std::move(package), std::move(scene), settings, std::move(times)});
    }
    return out;
  }

  /// Renders the image once on each machine, and adds the times to `image.times`.
  absl::Status time_once(Prepared& image) {
    RETURN_IF_ERROR(here(image, one_, image.times.one));
    RETURN_IF_ERROR(here(image, all_, image.times.all));
    return client_ == nullptr ? absl::OkStatus() : there(image);
  }

  /// Renders once on this machine.
  absl::Status here(Prepared& image, Pool& pool, PhoneTimes& times) {
    SceneDescription copy = image.scene;
    const double begin = steady_seconds();
    ASSIGN_OR_RETURN(const std::shared_ptr<const Scene> built, Scene::build(std::move(copy), pool));
    const double ready = steady_seconds();
    ASSIGN_OR_RETURN(const RenderedImage rendered,
                     render_image(*built, image.settings, kSamples, pool, stop_, /*progress=*/{},
                                  /*spill_folder=*/""));
    times.build.push_back(1000 * (ready - begin));
    times.render.push_back(1000 * (steady_seconds() - ready));
    image.times.rays = static_cast<double>(rendered.counters.rays);
    return absl::OkStatus();
  }

  /// Renders once on the farm. The time begins when a worker gets the first rows, and ends when the
  /// image is complete; the dashboard shows the same time. In the first run, workers also load the
  /// scene.
  absl::Status there(Prepared& image) {
    ProgressDisplay display(process_.console, {.quiet = true});
    ASSIGN_OR_RETURN(
        const JobId job,
        send(*client_, image.package,
             request_for(image.package, image.settings, StopAtSamples{kSamples}), display));
    ASSIGN_OR_RETURN(const Progress last, follow_job(*client_, job, display));
    if (last.job.state != JobState::kDone) {
      return absl::AbortedError(
          absl::StrCat("job ", job, " ", state_name(last.job.state), ": ", last.job.reason));
    }
    image.times.farm.render.push_back(1000 * last.job.elapsed_s);
    return absl::OkStatus();
  }

  const PhoneStudyOptions& options_;
  Process& process_;
  FarmClient* const client_;  ///< nullptr: no farm
  const std::atomic<bool>& stop_;
  Pool one_;  ///< one thread
  Pool all_;  ///< all threads
};

/// Returns the images whose names begin with one of the words, or all images if there are no words.
/// NOT_FOUND: a word matches no image.
absl::StatusOr<std::set<std::string>> chosen(const std::vector<std::string>& words) {
  std::set<std::string> names;
  for (const PhoneTable& table : phone_tables()) {
    for (const PhoneRow& row : table.rows) {
      names.emplace(row.image);
    }
  }
  const auto begins = [](const std::string& name, const std::string& word) {
    return absl::StartsWith(name, word);
  };
  for (const std::string& word : words) {
    if (std::none_of(names.begin(), names.end(),
                     [&](const std::string& name) { return begins(name, word); })) {
      return absl::NotFoundError(absl::StrCat(
          "phone_bench: no image's name begins with '", word,
          "'; the names begin with texture, objects, spheres, triangles, lights, kind, size"));
    }
  }
  std::erase_if(names, [&](const std::string& name) {
    return !words.empty() && std::none_of(words.begin(), words.end(), [&](const std::string& word) {
      return begins(name, word);
    });
  });
  return names;
}

ExitCode run(const PhoneStudyOptions& options, Process& process) {
  const Console& console = process.console;
  const auto fail = [&](ExitCode code, const absl::Status& status) {
    return console.fail(code, std::string(status.message()));
  };
  absl::Status status = check_study_outputs(options.outputs);
  status.Update(check_study_writable(options.outputs));
  if (!status.ok()) {
    return fail(ExitCode::kWrong, status);
  }
  const auto names = chosen(options.images);
  if (!names.ok()) {
    return fail(ExitCode::kWrong, names.status());
  }
  const auto client = connect_to_farm(options.farm);
  if (!client.ok() && (!options.farm.farm.empty() || !absl::IsUnavailable(client.status()))) {
    return fail(exit_code_of(client.status()), client.status());
  }
  if (!client.ok() && !options.verbosity.quiet) {
    console.complain(absl::StrCat("no image is timed on a farm: ", client.status().message()));
  }
  std::atomic<bool> stop{false};
  const Interrupts::Listener listener(process.interrupts, [&] {
    stop = true;
    if (client.ok()) {
      (*client)->stop();
    }
  });
  const auto study =
      PhoneRun(options, process, client.ok() ? client->get() : nullptr, stop).measured(*names);
  if (!study.ok()) {
    return absl::IsCancelled(study.status())
               ? console.fail(ExitCode::kInterrupted, "interrupted; nothing was written")
               : fail(exit_code_of(study.status()), study.status());
  }
  if (const absl::Status written =
          write_study(options.outputs, phone_csv(*study), phone_plot(*study));
      !written.ok()) {
    return fail(ExitCode::kFailed, written);
  }
  console.write(absl::StrCat(options.verbosity.quiet ? "" : "\n", phone_tables_text(*study)));
  console.line(absl::StrCat("\n", printable_list(options.outputs)));
  return ExitCode::kDone;
}

int phone_bench(int argc, char** argv) {
  Interrupts interrupts;
  const Console console = Console::standard();
  Process process{console, interrupts};
  PhoneStudyOptions options;
  CLI::App app("Times the 23 images of a study of ray tracing on phones.", "phone_bench");
  app.add_option("images", options.images, "Beginnings of the images' names [default: all]");
  app.add_option("-o,--output", options.outputs, "Files for the figures (.csv) or the plot (.svg)");
  app.add_option("--runs", options.runs, "Number of times that each image is timed")
      ->check(CLI::PositiveNumber);
  app.add_option("--width", options.width, "Width in pixels; the height keeps the aspect ratio");
  app.add_option("--threads", options.threads, "Threads [default: one for each CPU]");
  app.add_option("--farm", options.farm.farm, "Join string of the farm, or a file with it");
  app.add_flag("--quiet", options.verbosity.quiet, "Print only the tables and errors");
  CLI11_PARSE(app, argc, argv);
  return static_cast<int>(run(options, process));
}

}  // namespace
}  // namespace bandsaw::coordinator

int main(int argc, char** argv) { return bandsaw::coordinator::phone_bench(argc, argv); }
