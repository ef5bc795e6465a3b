#include "coordinator/cli/command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "coordinator/cli/checked_options.h"
#include "coordinator/cli/did_you_mean.h"
#include "coordinator/cli/house_options.h"
#include "coordinator/cli/invite_options.h"
#include "coordinator/cli/report_options.h"
#include "coordinator/cli/study_options.h"

namespace bandsaw::coordinator {
namespace {

constexpr char kPictures[] = ".png, .ppm, .pfm, .hdr or .exr";

void add_output(CLI::App& app, RawOptions& raw, const std::string& formats,
                const std::string& standard) {
  app.add_option("-o,--output", raw.outputs,
                 "File for the image: " + formats + "; may be repeated" + standard)
      ->allow_extra_args(false)
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void add_image(CLI::App& app, RawOptions& raw) {
  app.add_option("scene", raw.scene, "Scene file (.textproto, .json) or model file");
  app.add_option("--environment", raw.environment,
                 "Equirectangular image (.hdr, .exr …) that lights the scene from all around "
                 "[default: the scene's]")
      ->type_name("FILE");
  app.add_option("--camera", raw.camera,
                 "One of the cameras that the scene's models bring, see bandsaw info "
                 "[default: the scene's, or a model's first]")
      ->type_name("NAME");
  app.add_option("--samples", raw.samples, "Stop at N samples a pixel [default: 64]")
      ->type_name("N");
  app.add_option("--error", raw.error, "Stop at this estimated relative RMSE, as in 1%")
      ->type_name("E%");
  app.add_flag("--adaptive", raw.adaptive, "With --error: more samples where noise is");
  app.add_option("--time", raw.time, "Stop before this much time, as in 5s, 2m, 1h")
      ->type_name("T");
  app.add_option("--seed", raw.seed, "Another seed, another noise [default: 0]")->type_name("N");
  app.add_option("--width", raw.width, "Pixels; alone it keeps the scene's aspect ratio")
      ->type_name("W");
  app.add_option("--height", raw.height, "Pixels; alone it keeps the scene's aspect ratio")
      ->type_name("H");
  app.add_option("--depth", raw.depth, "Most surfaces a path scatters at [default: the scene's]")
      ->type_name("N");
}

void add_integrator(CLI::App& app, RawOptions& raw) {
  app.add_option("--integrator", raw.integrator,
                 "What is shown: path, direct, normals, depth, albedo, ambient_occlusion, "
                 "path_lights or path_scattering "
                 "[default: the scene's]")
      ->type_name("I");
}

void add_display(CLI::App& app, RawOptions& raw, const char* standard) {
  app.add_option("--exposure", raw.exposure,
                 absl::StrCat("PNG and PPM show 2^STOPS times the light [default: ", standard, "]"))
      ->type_name("STOPS");
  app.add_option("--tone", raw.tone,
                 absl::StrCat("Light above 1 in PNG and PPM: none (cut off) or filmic [default: ",
                              standard, "]"))
      ->type_name("T");
  app.add_flag("--half", raw.half, "EXR files hold 16-bit numbers, not 32");
  add_report(app, raw);
}

void add_layers(CLI::App& app, RawOptions& raw) {
  app.add_option("--layers", raw.layers,
                 "What EXR files hold besides, as in albedo,normal,depth,samples")
      ->type_name("L,L,…");
}

void add_submit(CLI::App& app, RawOptions& raw) {
  add_image(app, raw);
  add_integrator(app, raw);
  add_output(app, raw, kPictures, " [default: the scene's name as .png]");
  add_display(app, raw, "the scene's");
  add_layers(app, raw);
  app.add_flag("--detach", raw.detach, "Do not watch; say the job's number and leave");
  app.add_option("--priority", raw.priority,
                 "The highest is rendered first, -1000 to 1000 [default: 0]")
      ->type_name("N");
  add_farm(app, raw);
  add_verbosity(app, raw);
}

void add_watch(CLI::App& app, RawOptions& raw) {
  app.add_option("job", raw.job, "The job's number");
  add_output(app, raw, kPictures, "");
  add_display(app, raw, "the scene's");
  add_farm(app, raw);
  add_verbosity(app, raw);
}

void add_list(CLI::App& app, RawOptions& raw) {
  add_farm(app, raw);
  add_verbosity(app, raw, false);
}

void add_job(CLI::App& app, RawOptions& raw) {
  app.add_option("job", raw.job, "The job's number, as in: bandsaw jobs");
  add_farm(app, raw);
  add_verbosity(app, raw);
}

void add_priority(CLI::App& app, RawOptions& raw) {
  app.add_option("job", raw.job, "The job's number, as in: bandsaw jobs");
  app.add_option("value", raw.priority, "The highest is rendered first, -1000 to 1000");
  add_farm(app, raw);
  add_verbosity(app, raw);
}

void add_render(CLI::App& app, RawOptions& raw) {
  add_image(app, raw);
  add_integrator(app, raw);
  add_output(app, raw, ".png, .ppm, .pfm, .hdr, .exr, or .band with --rows",
             " [default: the scene's name as .png]");
  add_display(app, raw, "the scene's");
  add_layers(app, raw);
  app.add_option("--threads", raw.threads, "Threads [default: one for each CPU]")->type_name("N");
  app.add_option("--rows", raw.rows,
                 "Only rows y0 to y1 - 1, from the top; parts are joined by stitch")
      ->type_name("y0:y1");
  add_verbosity(app, raw);
}

void add_info(CLI::App& app, RawOptions& raw) {
  app.add_option("scene", raw.scene, "Scene file (.textproto, .json) or model file");
  add_verbosity(app, raw, false);
}

void add_stitch(CLI::App& app, RawOptions& raw) {
  app.add_option("parts", raw.parts, "Parts made by: bandsaw render --rows y0:y1 -o PART.band");
  add_output(app, raw, kPictures, "");
  add_display(app, raw, "the scene's");
  add_verbosity(app, raw);
}

void add_compare(CLI::App& app, RawOptions& raw) {
  app.add_option("image", raw.image, "The image that is judged (PNG, PPM, PFM, …)");
  app.add_option("reference", raw.reference, "The image that it is judged by");
  app.add_option("-o,--output", raw.outputs,
                 "File for a picture of the differences (FLIP), black for none, white for the most")
      ->allow_extra_args(false)
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  add_verbosity(app, raw, false);
}

struct Entry {
  const char* name;
  const char* what;
  void (*add)(CLI::App&, RawOptions&);
  absl::StatusOr<Command> (*check)(const RawOptions&);
  const char* example = nullptr;
};

constexpr Entry kCommands[] = {
    {"serve", "Run the coordinator of a farm on this machine", add_serve, checked_serve},
    {"submit", "Render a scene on the farm and watch it", add_submit, checked_submit},
    {"watch", "Watch a job again, and fetch its image", add_watch, checked_watch},
    {"jobs", "List the farm's jobs", add_list, checked_jobs},
    {"workers", "List the farm's workers", add_list, checked_workers},
    {"cancel", "End a job without an image", add_job, checked_cancel, "bandsaw cancel 7"},
    {"pause", "Render nothing more of a job until it is resumed", add_job, checked_pause,
     "bandsaw pause 7"},
    {"resume", "Let a paused job go on", add_job, checked_resume, "bandsaw resume 7"},
    {"priority", "Render a job before others, or after them", add_priority, checked_priority,
     "bandsaw priority 7 10    # before all jobs that are below 10"},
    {"why", "Say why a job is not done yet", add_job, checked_why, "bandsaw why 7"},
    {"logs", "Show the last lines of a worker's log", add_logs, checked_logs, "bandsaw logs desk"},
    {"quarantine", "Keep a machine away that renders wrongly, or let it in", add_quarantine,
     checked_quarantine, "bandsaw quarantine --lift desk"},
    {"doctor", "Check this machine, and the farm that it uses", add_doctor, checked_doctor,
     "bandsaw doctor --farm join    # on a worker's machine"},
    {"secret", "Make a new secret; who has the old one is shut out", add_secret, checked_secret,
     "bandsaw secret rotate worker"},
    {"invite", "Bring workers to other machines by ssh", add_invite, checked_invite,
     "bandsaw invite anna@desk laptop"},
    {"dismiss", "Take such workers away again", add_dismiss, checked_dismiss,
     "bandsaw dismiss anna@desk laptop"},
    {"render", "Render a scene on this machine, without a farm: the same bits", add_render,
     checked_render},
    {"info", "Say what is in a scene or model, and what of it is left out", add_info, checked_info},
    {"stitch", "Join parts of an image that were rendered by rows", add_stitch, checked_stitch},
    {"compare", "Error metrics between two images", add_compare, checked_compare},
    {"study", "Measure speed against error, with and without each technique", add_study,
     checked_study, "bandsaw study cornell.textproto spheres.textproto -o study.svg"},
};

constexpr char kExitCodes[] =
    "Exit status: 0 done, 1 failed, 2 wrong usage or input, 3 no farm reached, 130 interrupted.";

absl::Status unknown(const std::string& kind, const std::string& word,
                     const std::vector<std::string>& known, const std::string& cure) {
  const auto meant = did_you_mean(word, known);
  return absl::InvalidArgumentError(absl::StrCat(
      "no ", kind, " '", word, "'", meant ? absl::StrCat("; did you mean ", *meant, "?") : cure));
}

absl::Status check_no_extras(const CLI::App& app, const std::string& command) {
  const std::vector<std::string> extras = app.remaining();
  if (extras.empty()) {
    return absl::OkStatus();
  }
  const std::string word = extras.front().substr(0, extras.front().find('='));
  const std::string cure = absl::StrCat("; see: bandsaw ", command, " --help");
  if (word.size() < 2 || word.front() != '-') {
    return absl::InvalidArgumentError(
        absl::StrCat(command, ": one argument too many, '", word, "'", cure));
  }
  std::vector<std::string> known;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) {
      known.push_back("--" + name);
    }
  }
  return unknown(command + " option", word, known, cure);
}

absl::StatusOr<Command> parse_with(CLI::App& app, const std::vector<CLI::App*>& commands,
                                   const RawOptions& raw,
                                   const std::vector<std::string>& arguments) {
  // CLI11 reports by exceptions; they end here.
  try {
    std::vector<std::string> reversed(arguments.rbegin(), arguments.rend());
    app.parse(std::move(reversed));
  } catch (const CLI::CallForAllHelp&) {
    return ShowText{app.help("", CLI::AppFormatMode::All)};
  } catch (const CLI::CallForHelp&) {
    for (const CLI::App* command : commands) {
      if (command->parsed()) {
        return ShowText{command->help()};
      }
    }
    return ShowText{app.help()};
  } catch (const CLI::CallForVersion&) {
    return ShowText{"bandsaw " BANDSAW_VERSION "\n"};
  } catch (const CLI::ParseError& error) {
    return absl::InvalidArgumentError(
        absl::StrCat(absl::StrReplaceAll(error.what(), {{"\n", " "}}), "; see: bandsaw --help"));
  }
  for (std::size_t i = 0; i < commands.size(); ++i) {
    if (commands[i]->parsed()) {
      if (auto status = check_no_extras(*commands[i], kCommands[i].name); !status.ok()) {
        return status;
      }
      return kCommands[i].check(raw);
    }
  }
  return absl::InvalidArgumentError("no command; see: bandsaw --help");
}

}  // namespace

absl::StatusOr<Command> parse_command_line(const std::vector<std::string>& arguments) {
  CLI::App app("Renders one image on every machine of a network.", "bandsaw");
  app.set_version_flag("--version", std::string(BANDSAW_VERSION));
  app.footer(kExitCodes);
  app.allow_extras();
  RawOptions raw;
  std::vector<CLI::App*> commands;
  std::vector<std::string> names;
  for (const Entry& entry : kCommands) {
    CLI::App* command = app.add_subcommand(entry.name, entry.what);
    entry.add(*command, raw);
    command->allow_extras();
    command->footer(entry.example == nullptr
                        ? kExitCodes
                        : absl::StrCat("Example: ", entry.example, "\n", kExitCodes));
    commands.push_back(command);
    names.emplace_back(entry.name);
  }
  if (!arguments.empty()) {
    const std::string& first = arguments.front();
    if (first.empty() || first.front() != '-') {
      if (std::find(names.begin(), names.end(), first) == names.end()) {
        return unknown("command", first, names, "; see: bandsaw --help");
      }
    } else if (first != "-h" && first != "--help" && first != "--version") {
      return absl::InvalidArgumentError(absl::StrCat("the command comes first, then its options; '",
                                                     first, "' is none; see: bandsaw --help"));
    }
  }
  return parse_with(app, commands, raw, arguments);
}

}  // namespace bandsaw::coordinator
