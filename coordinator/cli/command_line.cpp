// The table of commands has for each command its name, its help, the function that adds its options
// to the parser (CLI11), and the function that checks them. parse_command_line() calls both. The
// functions add_X() and checked_X() of most commands are in cli/options.

#include "coordinator/cli/command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "coordinator/cli/completion.h"
#include "coordinator/cli/options/add_options.h"
#include "coordinator/cli/options/checked_options.h"
#include "coordinator/cli/options/choices.h"
#include "coordinator/cli/options/did_you_mean.h"

namespace bandsaw::coordinator {
namespace {

// Each of the functions from add_list() to add_retry() adds the options of one command, or of
// several commands that have the same options.

void add_list(CLI::App& app, RawOptions& raw) {
  add_farm(app, raw);
  add_verbosity(app, raw, /*can_be_quiet=*/false);
}

void add_job(CLI::App& app, RawOptions& raw) {
  app.add_option("job", raw.job, "The job's number, as in: bandsaw jobs");
  add_farm(app, raw);
  add_verbosity(app, raw);
}

void add_priority(CLI::App& app, RawOptions& raw) {
  app.add_option("job", raw.job, "The job's number, as in: bandsaw jobs");
  app.add_option("value", raw.priority,
                 "From -1000 to 1000; jobs of the highest priority are rendered first");
  add_farm(app, raw);
  add_verbosity(app, raw);
}

void add_completion(CLI::App& app, RawOptions& raw) {
  app.add_option("shell", raw.shell, "Name of the shell: " + one_of(choices_of("shell")));
}

void add_retry(CLI::App& app, RawOptions& raw) {
  app.add_option("job", raw.job, "The job's number, as in: bandsaw jobs");
  app.add_option("--frames", raw.frames,
                 "Frames that failed, as in 12,47-50 [default: all of them]")
      ->type_name("RANGES");
  add_farm(app, raw);
  add_verbosity(app, raw);
}

/// A row of the table.
struct Entry {
  const char* name;
  const char* what;  ///< help in one line
  void (*add)(CLI::App&, RawOptions&);
  /// nullptr for the command `completion`, whose output is generated from this table.
  absl::StatusOr<Command> (*check)(const RawOptions&);
  const char* example;
};

constexpr Entry kCommands[] = {
    {"serve", "Run the coordinator of a farm on this machine", add_serve, checked_serve,
     "bandsaw serve --data ~/farm --web 0.0.0.0:8787    # phones reach the dashboard"},
    {"submit", "Render a scene on the farm and watch it", add_submit, checked_submit,
     "bandsaw submit cornell.textproto -o cornell.png --error 2%"},
    {"watch", "Watch a job again, and fetch its image", add_watch, checked_watch,
     "bandsaw watch 7 -o cornell.png"},
    {"jobs", "List the farm's jobs", add_list, checked_jobs, "bandsaw jobs --json"},
    {"workers", "List the farm's workers", add_list, checked_workers,
     "bandsaw workers --farm farm.txt"},
    {"cancel", "End a job before its image is finished", add_job, checked_cancel,
     "bandsaw cancel 7"},
    {"pause", "Render nothing more of a job until it is resumed", add_job, checked_pause,
     "bandsaw pause 7"},
    {"resume", "Resume a paused job", add_job, checked_resume, "bandsaw resume 7"},
    {"priority", "Set the priority of a job", add_priority, checked_priority,
     "bandsaw priority 7 10    # before all jobs that are below 10"},
    {"missing", "List the frames of a job that are not done", add_job, checked_missing,
     "bandsaw missing 7"},
    {"retry", "Render failed frames of a job again", add_retry, checked_retry,
     "bandsaw retry 7 --frames 12"},
    {"why", "Explain why a job is not done", add_job, checked_why, "bandsaw why 7"},
    {"logs", "Show the last lines of a worker's log", add_logs, checked_logs, "bandsaw logs desk"},
    {"quarantine", "Exclude a machine that renders wrong pixels, or admit it again", add_quarantine,
     checked_quarantine, "bandsaw quarantine --lift desk"},
    {"doctor", "Check this machine, and the farm that it uses", add_doctor, checked_doctor,
     "bandsaw doctor --farm join    # on a worker's machine"},
    {"secret", "Make a new secret; the old one becomes invalid", add_secret, checked_secret,
     "bandsaw secret rotate worker"},
    {"link", "Show the link by which browsers join as workers, or revoke it", add_link,
     checked_link, "bandsaw link --for 8h    # a QR code for phones"},
    {"invite", "Install and start workers on other machines by ssh", add_invite, checked_invite,
     "bandsaw invite anna@desk laptop"},
    {"dismiss", "Stop and remove workers that bandsaw invite has installed", add_dismiss,
     checked_dismiss, "bandsaw dismiss anna@desk laptop"},
    {"render", "Render a scene on this machine, without a farm; a farm gives the same bits",
     add_render, checked_render,
     "bandsaw render helmet.glb --width 640 --samples 256 -o helmet.exr"},
    {"info", "Describe the contents of a scene or model, and what is not supported", add_info,
     checked_info, "bandsaw info helmet.glb"},
    {"import", "Convert a scene of pbrt or Mitsuba, or a model, to a scene file", add_import,
     checked_import, "bandsaw import kitchen.pbrt -o kitchen.textproto"},
    {"stitch", "Join parts of an image that render --rows has made", add_stitch, checked_stitch,
     "bandsaw stitch top.band bottom.band -o whole.png"},
    {"compare", "Compute error metrics between two images", add_compare, checked_compare,
     "bandsaw compare mine.png reference.pfm -o differences.png"},
    {"study", "Measure error against time, with and without each technique", add_study,
     checked_study, "bandsaw study cornell.textproto spheres.textproto -o study.svg"},
    {"completion", "Print the script that lets a shell complete commands and options",
     add_completion, nullptr, "source <(bandsaw completion bash)    # in ~/.bashrc"},
};

constexpr char kExitCodes[] =
    "Exit status: 0 done, 1 failed, 2 wrong usage or input, 3 no farm reached, 130 interrupted.";

/// Makes the INVALID_ARGUMENT error for `word`, which is not one of `known`. `kind`: what the word
/// should be, such as "command". The message ends with the known word that is most similar, or with
/// `cure` if none is similar.
absl::Status unknown(const std::string& kind, const std::string& word,
                     const std::vector<std::string>& known, const std::string& cure) {
  const auto meant = did_you_mean(word, known);
  return absl::InvalidArgumentError(absl::StrCat(
      "no ", kind, " '", word, "'", meant ? absl::StrCat("; did you mean ", *meant, "?") : cure));
}

/// Returns INVALID_ARGUMENT if the parser has found an argument or option that the command does not
/// have. `app`: the parser of the command `command`.
absl::Status check_no_extras(const CLI::App& app, const std::string& command) {
  std::vector<std::string> extras = app.remaining();
  // If a "--" follows the last argument that the command takes, the words after it are not left in
  // the parser of the command but in its parent, the parser of the program.
  const std::vector<std::string> later = app.get_parent()->remaining();
  extras.insert(extras.end(), later.begin(), later.end());
  std::erase(extras, "--");  // the parser keeps "--", which is no argument
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

/// Returns the script of the command `completion`, as a text to print. INVALID_ARGUMENT: the shell
/// is not bash.
absl::StatusOr<Command> completion(const CLI::App& app, const RawOptions& raw) {
  if (raw.shell != "bash") {
    return wrong_choice("completion: the shell", "shell", raw.shell.value_or(""));
  }
  return ShowText{bash_completion(app)};
}

/// Parses the arguments and checks them. `app`: the parser, which stores the values in `raw`.
/// `commands`: the parser of each entry of kCommands, in the order of kCommands.
absl::StatusOr<Command> parse_with(CLI::App& app, const std::vector<CLI::App*>& commands,
                                   const RawOptions& raw,
                                   const std::vector<std::string>& arguments) {
  // CLI11 reports by exceptions; they are converted here.
  try {
    // CLI11 takes a vector of arguments in reverse order.
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
      return kCommands[i].check != nullptr ? kCommands[i].check(raw) : completion(app, raw);
    }
  }
  return absl::InvalidArgumentError("no command; see: bandsaw --help");
}

/// Replaces the word `help` by the option --help: "help submit" becomes "submit --help".
std::vector<std::string> without_help_word(std::vector<std::string> arguments) {
  if (!arguments.empty() && arguments.front() == "help") {
    arguments.erase(arguments.begin());
    arguments.emplace_back("--help");
  }
  return arguments;
}

}  // namespace

absl::StatusOr<Command> parse_command_line(const std::vector<std::string>& typed) {
  const std::vector<std::string> arguments = without_help_word(typed);
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
    command->footer(absl::StrCat("Example: ", entry.example, "\n", kExitCodes));
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
                                                     first,
                                                     "' is not a command; see: bandsaw --help"));
    }
  }
  return parse_with(app, commands, raw, arguments);
}

}  // namespace bandsaw::coordinator
