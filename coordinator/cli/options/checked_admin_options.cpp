// Checks the options of the commands that control a farm and its machines, and those options of
// `serve` that have a check of their own. Each checked_X() converts the texts that the user typed
// to the plain values of command X, or returns INVALID_ARGUMENT.

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "coordinator/cli/options/checked_options.h"
#include "coordinator/cli/options/choices.h"
#include "coordinator/cli/options/quantities.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {

absl::StatusOr<Command> checked_logs(const RawOptions& raw) {
  LogsOptions options;
  options.farm.farm = raw.farm;
  ASSIGN_OR_RETURN(options.verbosity, checked_verbosity(raw));
  if (!raw.worker) {
    return absl::InvalidArgumentError(
        "logs: the worker's name is missing; bandsaw workers lists the names");
  }
  options.worker = *raw.worker;
  return options;
}

absl::StatusOr<Command> checked_quarantine(const RawOptions& raw) {
  QuarantineOptions options;
  options.farm.farm = raw.farm;
  options.lift = raw.lift;
  ASSIGN_OR_RETURN(options.verbosity, checked_verbosity(raw));
  if (!raw.worker || raw.worker->empty()) {
    return absl::InvalidArgumentError(
        "quarantine: the worker's name is missing; bandsaw workers lists the names");
  }
  options.worker = *raw.worker;
  return options;
}

absl::StatusOr<double> checked_share(const std::string& option,
                                     const std::optional<std::string>& text, double standard) {
  if (!text) {
    return standard;
  }
  return *text == "0%" ? 0 : parse_percent(option, *text);  // parse_percent() refuses 0
}

absl::StatusOr<Browsers> checked_browsers(const RawOptions& raw) {
  if (!raw.browsers) {
    return Browsers::kAlso;
  }
  const std::vector<std::string> words = choices_of("--browsers");
  const auto word = std::find(words.begin(), words.end(), *raw.browsers);
  if (word == words.end()) {
    return wrong_choice("--browsers", *raw.browsers);
  }
  return static_cast<Browsers>(word - words.begin());  // the words are in the order of Browsers
}

absl::StatusOr<std::string> checked_web(const RawOptions& raw) {
  if (raw.web && *raw.web != "none") {
    RETURN_IF_ERROR(check_address("--web", *raw.web, "0.0.0.0:8787"));
  }
  return raw.web.value_or("");
}

absl::StatusOr<Command> checked_doctor(const RawOptions& raw) {
  DoctorOptions options;
  options.data = raw.data;
  options.farm.farm = raw.farm;
  ASSIGN_OR_RETURN(options.verbosity, checked_verbosity(raw));
  if (raw.listen) {
    options.listen = *raw.listen;
  }
  RETURN_IF_ERROR(check_address("--listen", options.listen, "0.0.0.0:7878"));
  return options;
}

absl::StatusOr<Command> checked_link(const RawOptions& raw) {
  LinkOptions options;
  options.farm.farm = raw.farm;
  options.revoke = raw.revoke;
  ASSIGN_OR_RETURN(options.verbosity, checked_verbosity(raw));
  if (raw.time) {
    ASSIGN_OR_RETURN(options.seconds, parse_seconds("--for", *raw.time));
    if (options.revoke || *options.seconds < 1) {
      return absl::InvalidArgumentError(options.revoke
                                            ? "link: --for and --revoke exclude each other"
                                            : "link: --for needs at least one second");
    }
  }
  return options;
}

absl::StatusOr<Command> checked_secret(const RawOptions& raw) {
  constexpr char kUse[] = "as in: bandsaw secret rotate worker";
  RotateOptions options;
  options.data = raw.data;
  ASSIGN_OR_RETURN(options.verbosity, checked_verbosity(raw));
  if (!raw.action || *raw.action != "rotate") {
    return absl::InvalidArgumentError(absl::StrCat("secret: the action must be rotate, ", kUse));
  }
  if (!raw.role || (*raw.role != "worker" && *raw.role != "farm")) {
    return wrong_choice("secret rotate: the role", "role", raw.role.value_or(""));
  }
  options.role = *raw.role == "worker" ? link::Role::kWorker : link::Role::kFarm;
  return options;
}

}  // namespace bandsaw::coordinator
