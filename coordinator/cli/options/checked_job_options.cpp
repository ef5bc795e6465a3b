// Checks the options of commands that control a job. Each checked_X() converts the texts that the
// user typed to the plain values of command X, or returns INVALID_ARGUMENT.

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "coordinator/cli/options/checked_options.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

/// Checks the options that all commands of this file have: the job's number, the farm and the form
/// of the output. Returns the command's `Options` with these fields set. `command`: the command's
/// name, for errors.
template <class Options>
absl::StatusOr<Options> checked(const RawOptions& raw, const std::string& command) {
  Options options;
  options.farm.farm = raw.farm;
  ASSIGN_OR_RETURN(options.job, checked_job(raw, command));
  ASSIGN_OR_RETURN(options.verbosity, checked_verbosity(raw));
  return options;
}

}  // namespace

absl::StatusOr<std::int32_t> checked_priority_value(const std::string& name,
                                                    const std::string& text) {
  std::int32_t value = 0;
  if (!absl::SimpleAtoi(text, &value) || value < -kMaxPriority || value > kMaxPriority) {
    return absl::InvalidArgumentError(absl::StrCat(name, ": must be a whole number in [",
                                                   -kMaxPriority, ", ", kMaxPriority, "], is '",
                                                   text, "'"));
  }
  return value;
}

absl::StatusOr<Command> checked_cancel(const RawOptions& raw) {
  return checked<CancelOptions>(raw, "cancel");
}

absl::StatusOr<Command> checked_pause(const RawOptions& raw) {
  return checked<PauseOptions>(raw, "pause");
}

absl::StatusOr<Command> checked_resume(const RawOptions& raw) {
  return checked<ResumeOptions>(raw, "resume");
}

absl::StatusOr<Command> checked_priority(const RawOptions& raw) {
  ASSIGN_OR_RETURN(PriorityOptions options, checked<PriorityOptions>(raw, "priority"));
  if (!raw.priority) {
    return absl::InvalidArgumentError(absl::StrCat(
        "priority: the value is missing, as in: bandsaw priority ", options.job, " 10"));
  }
  ASSIGN_OR_RETURN(options.priority, checked_priority_value("priority", *raw.priority));
  return options;
}

absl::StatusOr<Command> checked_missing(const RawOptions& raw) {
  return checked<MissingOptions>(raw, "missing");
}

absl::StatusOr<Command> checked_retry(const RawOptions& raw) {
  ASSIGN_OR_RETURN(RetryOptions options, checked<RetryOptions>(raw, "retry"));
  ASSIGN_OR_RETURN(options.frames, checked_frames(raw));
  return options;
}

absl::StatusOr<Command> checked_why(const RawOptions& raw) {
  return checked<WhyOptions>(raw, "why");
}

}  // namespace bandsaw::coordinator
