// Options of `bandsaw invite` and `bandsaw dismiss`, and their checks.

#include "absl/strings/str_cat.h"
#include "coordinator/cli/options/add_options.h"
#include "coordinator/cli/options/quantities.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

void add_hosts(CLI::App& app, RawOptions& raw) {
  app.add_option("hosts", raw.hosts,
                 "Hosts as ssh takes them: HOST, USER@HOST, ssh://USER@HOST:PORT");
}

absl::StatusOr<std::vector<std::string>> checked_hosts(const RawOptions& raw,
                                                       const std::string& command) {
  if (raw.hosts.empty()) {
    return absl::InvalidArgumentError(absl::StrCat(
        command, ": no host is named; for example: bandsaw ", command, " anna@desk laptop"));
  }
  for (const std::string& host : raw.hosts) {
    if (host.empty() || host.front() == '-') {
      return absl::InvalidArgumentError(absl::StrCat(command, ": '", host, "' is no host"));
    }
  }
  return raw.hosts;
}

}  // namespace

void add_invite(CLI::App& app, RawOptions& raw) {
  add_hosts(app, raw);
  app.add_option("--join", raw.join,
                 "The workers' join string, or the file that holds it [default: that of the farm "
                 "served from this account]");
  add_data(app, raw);
  app.add_option("--time", raw.time, "Time limit for each host [default: 5m]")->type_name("T");
  add_verbosity(app, raw);
}

void add_dismiss(CLI::App& app, RawOptions& raw) {
  add_hosts(app, raw);
  app.add_option("--time", raw.time,
                 "Maximum time for a worker to finish the rows that it is rendering [default: 1m]")
      ->type_name("T");
  add_verbosity(app, raw);
}

absl::StatusOr<Command> checked_invite(const RawOptions& raw) {
  InviteOptions options;
  options.join = raw.join;
  options.data = raw.data;
  ASSIGN_OR_RETURN(options.hosts, checked_hosts(raw, "invite"));
  ASSIGN_OR_RETURN(options.verbosity, checked_verbosity(raw));
  if (raw.time) {
    ASSIGN_OR_RETURN(options.seconds, parse_seconds("--time", *raw.time));
  }
  return options;
}

absl::StatusOr<Command> checked_dismiss(const RawOptions& raw) {
  DismissOptions options;
  ASSIGN_OR_RETURN(options.hosts, checked_hosts(raw, "dismiss"));
  ASSIGN_OR_RETURN(options.verbosity, checked_verbosity(raw));
  if (raw.time) {
    ASSIGN_OR_RETURN(options.drain_s, parse_seconds("--time", *raw.time));
  }
  return options;
}

}  // namespace bandsaw::coordinator
