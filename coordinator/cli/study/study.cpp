// The command `bandsaw study`: measures the error of images against their cost, with and without
// each technique of the renderer.

#include <algorithm>
#include <atomic>
#include <thread>
#include <utility>

#include "absl/strings/str_cat.h"
#include "coordinator/cli/base/text.h"
#include "coordinator/cli/image/output.h"
#include "coordinator/cli/options/commands.h"
#include "coordinator/cli/scene/image_settings.h"
#include "coordinator/cli/scene/import_scene_file.h"
#include "coordinator/cli/study/study_measure.h"
#include "coordinator/cli/study/study_outputs.h"
#include "coordinator/cli/study/study_text.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

/// A scene that is imported, and the settings to render it.
struct Prepared {
  std::string name;
  RenderSettings settings;
  SceneDescription scene;
};

/// Imports all scenes before the first is rendered, so that an error in any of them is reported at
/// once.
absl::StatusOr<std::vector<Prepared>> prepare(const StudyOptions& options, Process& process) {
  std::vector<Prepared> out;
  for (const std::string& scene : options.scenes) {
    ASSIGN_OR_RETURN(DecodedScene decoded, decode_scene_file(scene, options.verbosity, process));
    if (options.every_object && objects_of(decoded.scene) > kMaxObjects) {
      return absl::InvalidArgumentError(
          absl::StrCat("--every-object: ", scene, " has ", objects_of(decoded.scene),
                       " objects, but the option allows at most ", kMaxObjects,
                       ": leave the option out, or choose a smaller scene"));
    }
    ImageOptions image;
    image.seed = options.seed;
    image.width = options.width;
    ASSIGN_OR_RETURN(const RenderSettings settings, image_settings(image, decoded.info));
    out.push_back({decoded.info.name, settings, std::move(decoded.scene)});
  }
  return out;
}

/// Runs the study of each scene, one after the other.
absl::StatusOr<std::vector<StudyOfScene>> studied(const StudyOptions& options,
                                                  std::vector<Prepared> scenes, Process& process,
                                                  const std::atomic<bool>& stop) {
  const auto cpus = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  Pool pool(options.threads > 0 ? options.threads : cpus);
  const StudyPlan plan{options.samples, options.seeds, options.reference, options.denoise};
  std::vector<StudyOfScene> out;
  for (Prepared& prepared : scenes) {
    std::shared_ptr<const Scene> every_object;
    if (options.every_object) {
      ASSIGN_OR_RETURN(every_object,
                       Scene::build(prepared.scene, pool, /*forced=*/{}, Traversal::kBruteForce));
    }
    ASSIGN_OR_RETURN(const std::shared_ptr<const Scene> scene,
                     Scene::build(std::move(prepared.scene), pool));
    const auto doing = [&](const std::string& what) {
      if (!options.verbosity.quiet) {
        process.console.line(what);
      }
    };
    ASSIGN_OR_RETURN(StudyOfScene study, study_scene(prepared.name, *scene, every_object.get(),
                                                     prepared.settings, plan, pool, stop, doing));
    out.push_back(std::move(study));
  }
  return out;
}

}  // namespace

ExitCode run(const StudyOptions& options, Process& process) {
  const Console& console = process.console;
  if (const auto status = check_study_writable(options.outputs); !status.ok()) {
    return console.fail(ExitCode::kWrong, std::string(status.message()));
  }
  auto scenes = prepare(options, process);
  if (!scenes.ok()) {
    return console.fail(import_exit_code(scenes.status()), std::string(scenes.status().message()));
  }
  std::atomic<bool> stop{false};
  const Interrupts::Listener listener(process.interrupts, [&] { stop = true; });
  const auto studies = studied(options, std::move(*scenes), process, stop);
  if (!studies.ok()) {
    return absl::IsCancelled(studies.status())
               ? console.fail(ExitCode::kInterrupted, "interrupted; nothing was written")
               : console.fail(ExitCode::kFailed, std::string(studies.status().message()));
  }
  if (const absl::Status written =
          write_study(options.outputs, study_csv(*studies), study_plot(*studies));
      !written.ok()) {
    return console.fail(ExitCode::kFailed, std::string(written.message()));
  }
  console.write(absl::StrCat(options.verbosity.quiet ? "" : "\n", study_table(*studies)));
  if (options.denoise) {
    std::vector<CleanOfScene> clean;
    for (const StudyOfScene& study : *studies) {
      clean.push_back({study.scene, study.clean});
    }
    console.write(absl::StrCat("\n", clean_table(clean)));
  }
  console.line(absl::StrCat("\n", printable_list(options.outputs)));
  return ExitCode::kDone;
}

}  // namespace bandsaw::coordinator
