// Implements the link for browsers: one secret, and the time at which it becomes invalid. make()
// sets a new time, and keeps the secret if the link is still valid. Wrong secrets are counted for
// each address.

#include "coordinator/rpc/browser_access.h"

#include <spdlog/spdlog.h>

#include <chrono>
#include <utility>

#include "absl/strings/str_cat.h"
#include "coordinator/engine/clock.h"
#include "proto/link/identity.h"
#include "proto/link/random.h"
#include "proto/wire/limits.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

double seconds_since_1970() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

}  // namespace

BrowserAccess::BrowserAccess(std::string folder, UnixSeconds now,
                             std::optional<link::BrowserLink> link)
    : folder_(std::move(folder)),
      now_(now ? std::move(now) : &seconds_since_1970),
      link_(std::move(link)),
      failures_(wire::kWrongSecretsPerMinute) {}

absl::StatusOr<std::unique_ptr<BrowserAccess>> BrowserAccess::load(std::string folder,
                                                                   UnixSeconds now) {
  ASSIGN_OR_RETURN(std::optional<link::BrowserLink> link, link::load_browser_link(folder));
  return std::unique_ptr<BrowserAccess>(
      new BrowserAccess(std::move(folder), std::move(now), std::move(link)));
}

bool BrowserAccess::has_ended() { return !link_ || now_() >= link_->ends_unix_s; }

BrowserAccess::Link BrowserAccess::shown() {
  return {absl::StrCat(address_, "/join#", link_->secret), link_->ends_unix_s - now_()};
}

std::optional<BrowserAccess::Link> BrowserAccess::present() {
  MutexLock lock(mutex_);
  return has_ended() || address_.empty() ? std::nullopt : std::optional(shown());
}

absl::StatusOr<BrowserAccess::Link> BrowserAccess::make(double seconds) {
  if (!(seconds >= 1 && seconds <= kMaxSeconds)) {
    return absl::InvalidArgumentError(
        absl::StrCat("seconds: must lie in [1, ", kMaxSeconds, "], is ", seconds));
  }
  if (address_.empty()) {
    return absl::FailedPreconditionError(
        "browsers join at the dashboard, and this coordinator has none: start it without --web "
        "none");
  }
  MutexLock lock(mutex_);
  const link::BrowserLink made{has_ended() ? link::make_secret() : link_->secret, now_() + seconds};
  RETURN_IF_ERROR(link::write_browser_link(folder_, made));
  link_ = made;
  spdlog::info("browsers may join by the link for {:.0f} s", seconds);
  return shown();
}

absl::Status BrowserAccess::revoke() {
  MutexLock lock(mutex_);
  if (!link_) {
    return absl::OkStatus();
  }
  RETURN_IF_ERROR(link::remove_browser_link(folder_));
  link_.reset();
  spdlog::info("the link for browsers is revoked");
  return absl::OkStatus();
}

bool BrowserAccess::holds(const std::string& secret) {
  MutexLock lock(mutex_);
  return !has_ended() && link::is_same_secret(link_->secret, secret);
}

absl::Status BrowserAccess::check(const std::string& secret, const std::string& address) {
  if (holds(secret)) {
    return absl::OkStatus();
  }
  MutexLock lock(mutex_);
  switch (failures_.add(address, steady_seconds())) {
    case Failures::Verdict::kFirst:
      spdlog::warn("address={} refused: it has no valid link for browsers", address);
      break;
    case Failures::Verdict::kMore:
      break;
    case Failures::Verdict::kTooMany:
      return absl::ResourceExhaustedError(
          absl::StrCat("too many wrong links from ", address, "; wait a minute"));
  }
  return absl::UnauthenticatedError(
      "this link has ended or was revoked: ask for a new one (on the host: bandsaw link)");
}

}  // namespace bandsaw::coordinator
