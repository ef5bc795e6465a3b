// Declares the options of the commands that read, render or write images: names, help and the
// fields of RawOptions that hold the values.

#include <CLI/CLI.hpp>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "coordinator/cli/options/add_options.h"
#include "coordinator/cli/options/checked_options.h"
#include "coordinator/cli/options/choices.h"

namespace bandsaw::coordinator {
namespace {

void add_report(CLI::App& app, RawOptions& raw) {
  app.add_option("--report", raw.report,
                 "File for the report of error and cost (.json), or none "
                 "[default: beside each image, with its name]")
      ->type_name("FILE|none");
}

constexpr char kPictures[] = ".png, .ppm, .pfm, .hdr or .exr";

// Adds -o. `standard`: the end of the help text, which states the default.
void add_output(CLI::App& app, RawOptions& raw, const std::string& formats,
                const std::string& standard) {
  app.add_option("-o,--output", raw.outputs,
                 "File for the image: " + formats + "; may be repeated" + standard)
      ->allow_extra_args(false)
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

// Adds the options of all commands that read a scene.
void add_scene(CLI::App& app, RawOptions& raw) {
  app.add_option("scene", raw.scene,
                 "Scene file (.textproto, .json), scene of pbrt (.pbrt) or Mitsuba (.xml), model "
                 "file, or a .zip of one of them with its files");
  app.add_flag(
      "--strict", raw.strict,
      "Fail if there is a warning, which names content of the scene or model that is not rendered");
  app.add_option("-D,--define", raw.parameters,
                 "Value of a parameter of a Mitsuba scene; may be repeated")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false)
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app.add_option("--folder", raw.folder,
                 "Folder whose files a Mitsuba scene may use; it contains the scene's folder "
                 "[default: the scene's folder]")
      ->type_name("FOLDER");
  app.add_option("--inside", raw.inside, "Name of the scene in a .zip [default: the only scene]")
      ->type_name("NAME");
}

// Adds the options of `submit` and `render` that determine the image.
void add_image(CLI::App& app, RawOptions& raw) {
  add_scene(app, raw);
  app.add_option("--environment", raw.environment,
                 "Equirectangular image (.hdr, .exr …) that lights the scene from all around "
                 "[default: the scene's]")
      ->type_name("FILE");
  app.add_option("--camera", raw.camera,
                 "One of the cameras of the scene's models, see bandsaw info "
                 "[default: the scene's, or a model's first]")
      ->type_name("NAME");
  app.add_option("--frame", raw.frame,
                 "Render frame N of a scene that moves: the scene at time N / fps [default: the "
                 "scene at time 0, models without their animations]")
      ->type_name("N");
  app.add_flag("--fixed-seed", raw.fixed_seed,
               "The same noise in all frames [default: frame N has seed + N]");
  app.add_option("--fps", raw.fps, "Frames per second, with --frame [default: the scene's, or 24]")
      ->type_name("F");
  app.add_option("--shutter", raw.shutter,
                 "Share of a frame's time in which the shutter is open, with --frame, as in 0.5 "
                 "[default: the scene's shutter]")
      ->type_name("S");
  app.add_option("--animation", raw.animation,
                 "One of the animations of the scene's models [default: with --frame the first]")
      ->type_name("NAME");
  app.add_option("--samples", raw.samples, "Stop at N samples per pixel [default: 64]")
      ->type_name("N");
  app.add_option(
         "--error", raw.error,
         "Stop at this relative RMSE, as in 1%; in 19 of 20 renders the true error is at most this")
      ->type_name("E%");
  app.add_flag("--adaptive", raw.adaptive, "With --error: more samples where there is more noise");
  app.add_option("--time", raw.time, "Stop before this time has passed, as in 5s, 2m, 1h")
      ->type_name("T");
  app.add_option("--seed", raw.seed, "Seed of the noise [default: 0]")->type_name("N");
  app.add_option(
         "--width", raw.width,
         "Width in pixels; if it is given without --height, the scene's aspect ratio is kept")
      ->type_name("W");
  app.add_option(
         "--height", raw.height,
         "Height in pixels; if it is given without --width, the scene's aspect ratio is kept")
      ->type_name("H");
  app.add_option("--depth", raw.depth,
                 "Maximum number of scatterings of a path [default: the scene's]")
      ->type_name("N");
}

void add_integrator(CLI::App& app, RawOptions& raw) {
  app.add_option("--integrator", raw.integrator,
                 absl::StrCat("What the image shows: ", one_of(choices_of("--integrator")),
                              " [default: the scene's]"))
      ->type_name("I");
}

// Adds the options for writing pictures. `standard`: the default, for the help text.
void add_display(CLI::App& app, RawOptions& raw, const char* standard) {
  app.add_option(
         "--exposure", raw.exposure,
         absl::StrCat("Multiply the light in PNG and PPM by 2^STOPS [default: ", standard, "]"))
      ->type_name("STOPS");
  app.add_option("--tone", raw.tone,
                 absl::StrCat("Values above 1 in PNG and PPM: none (clipped) or filmic [default: ",
                              standard, "]"))
      ->type_name("T");
  app.add_flag("--half", raw.half, "16-bit numbers in EXR files instead of 32-bit");
  add_report(app, raw);
}

void add_denoise(CLI::App& app, RawOptions& raw) {
  app.add_flag("--denoise{regression}", raw.denoise,
               "Remove the noise. FILE.raw.png, or the layer raw of an EXR file, has the image as "
               "rendered. The report states the errors of the clean and of the rendered image. "
               "--denoise=oidn uses the library OpenImageDenoise, if it is installed");
}

void add_layers(CLI::App& app, RawOptions& raw) {
  app.add_option("--layers", raw.layers,
                 "Additional layers of EXR files, as in albedo,normal,depth,samples")
      ->type_name("L,L,…");
}

// Adds the options that take effect when a job is over.
void add_after(CLI::App& app, RawOptions& raw) {
  app.add_option("--video", raw.video,
                 "Video of the frames, made by ffmpeg: .mp4, .mov, .mkv or .webm; --fps sets its "
                 "speed [default: 24]")
      ->type_name("FILE");
  app.add_option("--contact-sheet", raw.contact_sheet,
                 "Picture with all frames, each small and above its number: .png …")
      ->type_name("FILE");
  app.add_option("--then", raw.then,
                 "Command that this program runs by sh when the job is over, with BANDSAW_JOB, "
                 "BANDSAW_STATE, BANDSAW_FILES and BANDSAW_FILE_LIST in its environment")
      ->type_name("COMMAND");
}

// Adds the options that show the image while it forms.
void add_views(CLI::App& app, RawOptions& raw) {
  app.add_flag("--preview", raw.preview,
               "Draw the image on the terminal while it forms, in half blocks of 24-bit colours");
  app.add_option("--tev", raw.tev,
                 "Show the image while it forms in the viewer tev, as in 127.0.0.1:14158")
      ->type_name("HOST:PORT");
}

}  // namespace

absl::StatusOr<ReportOption> checked_report(const RawOptions& raw, bool has_images) {
  if (!raw.report) {
    return ReportOption();
  }
  if (!has_images) {
    return absl::InvalidArgumentError("--report is written with the image: add -o FILE");
  }
  if (*raw.report != "none" && !absl::EndsWithIgnoreCase(*raw.report, ".json")) {
    return absl::InvalidArgumentError(
        absl::StrCat("--report: must end in .json, or be none, is '", *raw.report, "'"));
  }
  return ReportOption{*raw.report};
}

void add_submit(CLI::App& app, RawOptions& raw) {
  add_image(app, raw);
  app.add_option(
         "--frames", raw.frames,
         "Many frames as one job, as in 1:240, 1-30, 1:240:2 or 47,60-72; the outputs' names "
         "have #### for the number")
      ->type_name("RANGES");
  app.add_option(
         "--continue", raw.continued,
         "Send the scenes that this job of many frames lacks, instead of starting a new job")
      ->type_name("JOB");
  add_integrator(app, raw);
  add_output(app, raw, kPictures, " [default: the scene's name as .png]");
  add_display(app, raw, "the scene's");
  add_layers(app, raw);
  add_denoise(app, raw);
  app.add_flag("--detach", raw.detach, "Do not watch; print the job's number and exit");
  app.add_option("--priority", raw.priority,
                 "From -1000 to 1000; jobs of the highest priority are rendered first [default: 0]")
      ->type_name("N");
  add_after(app, raw);
  add_farm(app, raw);
  add_views(app, raw);
  add_verbosity(app, raw);
}

void add_watch(CLI::App& app, RawOptions& raw) {
  app.add_option("job", raw.job, "The job's number");
  add_output(app, raw, kPictures, "");
  add_display(app, raw, "the scene's");
  add_denoise(app, raw);
  add_after(app, raw);
  app.add_option("--fps", raw.fps, "Frames per second of the video [default: 24]")->type_name("F");
  add_farm(app, raw);
  add_views(app, raw);
  add_verbosity(app, raw);
}

void add_render(CLI::App& app, RawOptions& raw) {
  add_image(app, raw);
  add_integrator(app, raw);
  add_output(app, raw, ".png, .ppm, .pfm, .hdr, .exr, or .band with --rows",
             " [default: the scene's name as .png]");
  add_display(app, raw, "the scene's");
  add_layers(app, raw);
  add_denoise(app, raw);
  app.add_option("--threads", raw.threads, "Threads [default: one for each CPU]")->type_name("N");
  app.add_option(
         "--kernel", raw.kernel,
         "Renderer's code for one instruction set, for comparison; each gives the same image: " +
             one_of(choices_of("--kernel")) + " [default: the first]")
      ->type_name("NAME");
  app.add_option("--rows", raw.rows, "Only rows y0 to y1 - 1, from the top; stitch joins the parts")
      ->type_name("y0:y1");
  add_views(app, raw);
  add_verbosity(app, raw);
}

void add_info(CLI::App& app, RawOptions& raw) {
  add_scene(app, raw);
  add_verbosity(app, raw, /*can_be_quiet=*/false);
}

void add_import(CLI::App& app, RawOptions& raw) {
  add_scene(app, raw);
  app.add_option("-o,--output", raw.outputs,
                 "The scene file; meshes and images are written beside it [default: the scene's "
                 "name as .textproto]")
      ->type_name("FILE")
      ->expected(1);
  app.add_flag("--force", raw.force, "Replace files that exist");
  add_verbosity(app, raw);
}

void add_stitch(CLI::App& app, RawOptions& raw) {
  app.add_option("parts", raw.parts, "Parts made by: bandsaw render --rows y0:y1 -o PART.band");
  add_output(app, raw, kPictures, "");
  add_display(app, raw, "the scene's");
  add_verbosity(app, raw);
}

void add_compare(CLI::App& app, RawOptions& raw) {
  app.add_option("image", raw.image, "The image whose errors are measured (PNG, PPM, PFM, …)");
  app.add_option("reference", raw.reference, "The image that it is compared with");
  app.add_option(
         "-o,--output", raw.outputs,
         "File for a picture of the differences (FLIP); black: no difference, white: the largest")
      ->allow_extra_args(false)
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  add_verbosity(app, raw, /*can_be_quiet=*/false);
}

}  // namespace bandsaw::coordinator
