// The checks of `bandsaw doctor` that need a connection to a farm, and the search for the join
// string (a line with the addresses of the farm and a secret).

#include <chrono>
#include <cstdlib>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "coordinator/cli/base/data_folder.h"
#include "coordinator/cli/farm/farm_client.h"
#include "coordinator/cli/farm/find_farm.h"
#include "coordinator/cli/machines/doctor_checks.h"
#include "proto/link/certificate.h"
#include "renderlib/base/file.h"

namespace bandsaw::coordinator {
namespace {

constexpr std::chrono::milliseconds kFarmTimeout{5'000};

double unix_seconds() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

/// Returns the result of a check that failed. `cure`: the remedy, which is appended to the message
/// of `status`; may be empty.
Check failed(const std::string& name, const absl::Status& status, const std::string& cure) {
  return {.name = name, .ok = false, .found = absl::StrCat(status.message(), cure)};
}

/// Checks the dates of the certificate that the farm at `address` (HOST:PORT) uses.
Check check_certificate(const std::string& address) {
  const auto pem = link::fetch_certificate_pem(address, kFarmTimeout);
  if (!pem.ok()) {
    return failed("certificate", pem.status(), "");
  }
  const auto validity = link::certificate_validity(*pem);
  return validity.ok() ? certificate_check(validity->from, validity->until, unix_seconds())
                       : failed("certificate", validity.status(), "");
}

/// Returns the remedy for a secret that the farm does not accept; empty for other errors.
std::string secret_cure(const absl::Status& status) {
  return absl::IsUnauthenticated(status)
             ? "; take the new join string from the coordinator's data folder"
             : "";
}

}  // namespace

absl::StatusOr<link::JoinString> doctor_join(const FarmOption& option, const std::string& folder) {
  std::string text = option.farm;
  for (const char* variable : {"BANDSAW_FARM", "BANDSAW_JOIN"}) {
    if (const char* value = std::getenv(variable); text.empty() && value != nullptr) {
      text = value;
    }
  }
  if (text.empty() && file_exists(farm_join_file(folder))) {
    text = farm_join_file(folder);
  }
  if (text.empty()) {
    return absl::NotFoundError(
        "no farm is named: use --farm STRING-or-FILE, or start one here with: bandsaw serve");
  }
  return link::join_string_from(text);
}

FarmChecks check_farm(const link::JoinString& join) {
  const auto client = FarmClient::connect(join);
  if (!client.ok()) {
    const std::string cure =
        absl::IsUnavailable(client.status())
            ? "; does bandsaw serve run there, and does a firewall let its port through?"
            : "; take the new join string from the coordinator's data folder";
    return {.checks = {failed("farm", client.status(), cure)}, .answered = ""};
  }
  std::vector<Check> checks;
  if (join.certificate) {
    checks.push_back(check_certificate((*client)->address()));
  } else {
    checks.push_back({"certificate", true, "none: the farm was started with --insecure"});
  }
  const double before = unix_seconds();
  const auto about = (*client)->about();
  const double after = unix_seconds();
  if (!about.ok()) {
    checks.push_back(failed("farm", about.status(), secret_cure(about.status())));
    return {.checks = std::move(checks), .answered = (*client)->address()};
  }
  checks.insert(checks.begin(),
                Check{"farm", true,
                      absl::StrCat((*client)->address(), " answers; ", about->workers(),
                                   about->workers() == 1 ? " worker is connected"
                                                         : " workers are connected")});
  checks.push_back(versions_check(*about));
  checks.push_back(clock_check(before, about->unix_s(), after));
  checks.push_back(disk_space_check("farm's disk", "at the coordinator", about->free_bytes()));
  return {.checks = std::move(checks), .answered = (*client)->address()};
}

}  // namespace bandsaw::coordinator
