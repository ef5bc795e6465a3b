// Declares the options of the commands that control a farm and its machines: names, help and the
// fields of RawOptions that hold the values.

#include "coordinator/cli/options/add_options.h"

namespace bandsaw::coordinator {

void add_verbosity(CLI::App& app, RawOptions& raw, bool can_be_quiet) {
  if (can_be_quiet) {
    app.add_flag("--quiet", raw.quiet, "Print only the last line and errors");
  }
  app.add_flag("--json", raw.json, "Print one JSON object per line, for programs");
}

void add_farm(CLI::App& app, RawOptions& raw) {
  app.add_option("--farm", raw.farm,
                 "Join string, or the file that contains it, or - for standard input "
                 "[default: $BANDSAW_FARM, then the farm served from this account]");
}

void add_data(CLI::App& app, RawOptions& raw) {
  app.add_option("--data", raw.data,
                 "Data folder [default: $XDG_DATA_HOME/bandsaw or ~/.local/share/bandsaw]")
      ->type_name("DIR");
}

void add_keep(CLI::App& app, RawOptions& raw) {
  app.add_option(
         "--keep-days", raw.keep_days,
         "Remove jobs that have been over for more than N days, with their images [default: 30]")
      ->type_name("N");
  app.add_option("--keep-size", raw.keep_size,
                 "Remove the oldest jobs that are over if images and scenes take more than this "
                 "[default: 100]")
      ->type_name("GB");
  app.add_option(
         "--keep-jobs", raw.keep_jobs,
         "Remove the oldest jobs that are over if there are more than N of them [default: 10000]")
      ->type_name("N");
}

void add_serve(CLI::App& app, RawOptions& raw) {
  add_data(app, raw);
  app.add_option(
         "--listen", raw.listen,
         "Address for workers and users; port 0 stands for any free port [default: 0.0.0.0:7878]")
      ->type_name("HOST:PORT");
  app.add_option(
         "--web", raw.web,
         "Address of the dashboard, or none for no dashboard; an address that other machines can "
         "reach uses HTTPS [default: 127.0.0.1:8787, or another port if that is taken]")
      ->type_name("HOST:PORT");
  add_keep(app, raw);
  app.add_option("--audit", raw.audit,
                 "Share of the bands (some rows each) of native workers that a second machine "
                 "renders for comparison [default: 1%]")
      ->type_name("P%");
  app.add_option("--browser-audit", raw.browser_audit,
                 "Share of the bands of browsers that a native worker renders again for comparison "
                 "[default: 10%]")
      ->type_name("P%");
  app.add_option(
         "--browsers", raw.browsers,
         "Whether browsers render: none (browsers are refused), also (browsers and native workers "
         "render) or only (native workers only compare what browsers rendered) [default: also]")
      ->type_name("WHICH");
  app.add_flag(
      "--reflection", raw.reflection,
      "Let any client, such as grpcurl, list the gRPC calls; making a call still needs a secret");
  app.add_flag("--insecure", raw.insecure,
               "No encryption: anybody on the network can read and change the data");
}

void add_logs(CLI::App& app, RawOptions& raw) {
  app.add_option("worker", raw.worker, "The worker's name, as in: bandsaw workers");
  add_farm(app, raw);
  add_verbosity(app, raw, /*can_be_quiet=*/false);
}

void add_quarantine(CLI::App& app, RawOptions& raw) {
  app.add_option("worker", raw.worker, "The worker's name, as in: bandsaw workers");
  app.add_flag("--lift", raw.lift,
               "End the quarantine: the machine may render again after its worker is restarted");
  add_farm(app, raw);
  add_verbosity(app, raw);
}

void add_doctor(CLI::App& app, RawOptions& raw) {
  add_data(app, raw);
  app.add_option("--listen", raw.listen,
                 "Address to test for a coordinator on this machine [default: 0.0.0.0:7878]")
      ->type_name("HOST:PORT");
  app.add_option(
      "--farm", raw.farm,
      "Join string of users or of workers, or the file that contains it, or - for standard "
      "input [default: $BANDSAW_FARM, then $BANDSAW_JOIN, then the farm served from this "
      "account]");
  add_verbosity(app, raw);
}

void add_link(CLI::App& app, RawOptions& raw) {
  app.add_option("--for", raw.time,
                 "Time from now to the end of the link, as in 90m or 8h [default: the end of a "
                 "present link is not changed; a new link ends after 8h]")
      ->type_name("TIME");
  app.add_flag("--revoke", raw.revoke,
               "End the link now, and disconnect the browsers that joined by it");
  add_farm(app, raw);
  add_verbosity(app, raw, /*can_be_quiet=*/false);
}

void add_secret(CLI::App& app, RawOptions& raw) {
  app.add_option("action", raw.action, "rotate: make a new secret, which invalidates the old one");
  app.add_option("role", raw.role, "Whose secret: worker or farm (users)");
  add_data(app, raw);
  add_verbosity(app, raw);
}

}  // namespace bandsaw::coordinator
