// A login is a cookie whose value is derived from the users' secret by HMAC, so it becomes invalid
// when the secret is renewed.

#include "coordinator/web/access.h"

#include <arpa/inet.h>
#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <openssl/hmac.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <array>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/escaping.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "absl/strings/strip.h"
#include "coordinator/engine/clock.h"
#include "proto/link/join.h"
#include "proto/wire/limits.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

constexpr long kLoginSeconds = 30L * 24 * 60 * 60;  // 30 days

std::string machine_name() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

/// Returns the name of the dashboard's cookie. It contains the port, because cookies do not
/// distinguish ports. Otherwise several coordinators on a machine would overwrite each other's
/// cookies.
std::string cookie_name(const HttpRequest& request) {
  return absl::StrCat("bandsaw-", request.local_port);
}

/// Returns the value of the dashboard's cookie; empty: the request has none.
std::string cookie_of(const HttpRequest& request) {
  const std::string name = cookie_name(request) + "=";
  for (absl::string_view one : absl::StrSplit(request.header("Cookie"), ';')) {
    one = absl::StripAsciiWhitespace(one);
    if (absl::ConsumePrefix(&one, name)) {
      return std::string(one);
    }
  }
  return "";
}

/// Returns the cookie's value, which is derived from the users' secret. The value becomes invalid
/// when the secret changes, and cannot be used for gRPC.
std::string pass_of(const std::string& secret) {
  constexpr char kPurpose[] = "bandsaw dashboard 1";
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned size = 0;
  HMAC(EVP_sha256(), secret.data(), static_cast<int>(secret.size()),
       reinterpret_cast<const unsigned char*>(kPurpose), sizeof(kPurpose) - 1, digest.data(),
       &size);
  return absl::BytesToHexString({reinterpret_cast<const char*>(digest.data()), size});
}

/// Refuses a POST that a page of another site may have sent.
absl::Status check_post(const HttpRequest& request) {
  if (!request.has_header(kOurHeader)) {
    return absl::PermissionDeniedError(absl::StrCat("a POST needs the header ", kOurHeader));
  }
  if (request.has_header("Origin") && !is_of_this_site(request)) {
    return absl::PermissionDeniedError("this request comes from another site");
  }
  return absl::OkStatus();
}

/// Returns true for requests that need no login: the page, its files, the workers' programs, the
/// login itself, and all requests below /join, which are checked by the handlers of /join.
bool is_open(const HttpRequest& request) {
  return request.path == "/api/login" ||
         (request.path != "/metrics" && !absl::StartsWith(request.path, "/api/"));
}

}  // namespace

bool is_own_host(const std::string& host, const std::string& machine, const std::string& named) {
  std::string name = absl::AsciiStrToLower(host);
  if (const std::size_t end = name.find(']'); absl::StartsWith(name, "[")) {
    in6_addr address{};
    return end != std::string::npos &&
           inet_pton(AF_INET6, name.substr(1, end - 1).c_str(), &address) == 1;
  }
  name = name.substr(0, name.find(':'));
  in_addr address{};
  const std::string own = absl::AsciiStrToLower(machine);
  return inet_pton(AF_INET, name.c_str(), &address) == 1 || name == "localhost" ||
         (!own.empty() && (name == own || name == own + ".local")) ||
         (!name.empty() && name == absl::AsciiStrToLower(named));
}

bool is_of_this_site(const HttpRequest& request) {
  const std::string origin = request.header("Origin");
  const std::string host = request.header("Host");
  return origin == absl::StrCat("http://", host) || origin == absl::StrCat("https://", host);
}

std::string bearer_secret(const HttpRequest& request) {
  constexpr char kScheme[] = "Bearer ";
  const std::string authorization = request.header("Authorization");
  return absl::StartsWith(authorization, kScheme) ? authorization.substr(sizeof(kScheme) - 1) : "";
}

Access::Access(link::Identity identity, bool secure, std::string host)
    : secure_(secure),
      host_(std::move(host)),
      identity_(std::move(identity)),
      pass_(pass_of(identity_.farm_secret)),
      failures_(wire::kWrongSecretsPerMinute) {}

bool Access::renew(link::Identity identity) {
  MutexLock lock(mutex_);
  const bool changed = identity.farm_secret != identity_.farm_secret;
  identity_ = std::move(identity);
  pass_ = pass_of(identity_.farm_secret);
  return changed;
}

absl::Status Access::check(const HttpRequest& request) {
  if (!is_own_host(request.header("Host"), machine_name(), host_)) {
    return absl::PermissionDeniedError(
        "the dashboard answers under this machine's address or name only; to use another name, "
        "give it to the coordinator: --web NAME:PORT");
  }
  if (request.method == "POST") {
    RETURN_IF_ERROR(check_post(request));
  } else if (request.method != "GET" && request.method != "HEAD") {
    return absl::InvalidArgumentError("only GET, HEAD and POST are known here");
  }
  return is_open(request) ? absl::OkStatus() : check_login(request);
}

bool Access::logged_in(const HttpRequest& request) {
  const std::string cookie = cookie_of(request);
  MutexLock lock(mutex_);
  return cookie.size() == pass_.size() &&
         CRYPTO_memcmp(cookie.data(), pass_.data(), pass_.size()) == 0;
}

absl::Status Access::check_login(const HttpRequest& request) {
  if (logged_in(request)) {
    return absl::OkStatus();
  }
  if (const std::string secret = bearer_secret(request); !secret.empty()) {
    MutexLock lock(mutex_);
    return check_secret(secret, request.remote_address);
  }
  return absl::UnauthenticatedError("log in first");
}

absl::Status Access::check_secret(const std::string& secret, const std::string& address) {
  const absl::StatusOr<link::Role> role = link::role_of_secret(identity_, secret);
  if (role.ok()) {
    return *role == link::Role::kFarm ? absl::OkStatus()
                                      : absl::PermissionDeniedError(
                                            "this is the workers' join string: the dashboard needs "
                                            "the users' one (file `farm` in the coordinator's data "
                                            "folder)");
  }
  switch (failures_.add(address, steady_seconds())) {
    case Failures::Verdict::kFirst:
      spdlog::warn("address={} dashboard refused: {}", address,
                   std::string(role.status().message()));
      return role.status();
    case Failures::Verdict::kMore:
      return role.status();
    case Failures::Verdict::kTooMany:
      break;
  }
  return absl::ResourceExhaustedError(
      absl::StrCat("too many wrong secrets from ", address, "; wait a minute"));
}

absl::Status Access::log_in(const HttpRequest& request, const std::string& text, HttpReply& reply) {
  const std::string plain(absl::StripAsciiWhitespace(text));
  const absl::StatusOr<link::JoinString> join = link::parse_join_string(plain);
  MutexLock lock(mutex_);
  RETURN_IF_ERROR(check_secret(join.ok() ? join->secret : plain, request.remote_address));
  reply.headers.emplace_back("Set-Cookie", cookie(request, pass_, kLoginSeconds));
  return absl::OkStatus();
}

void Access::log_out(const HttpRequest& request, HttpReply& reply) const {
  reply.headers.emplace_back("Set-Cookie", cookie(request, "", 0));
}

std::string Access::cookie(const HttpRequest& request, const std::string& value,
                           long seconds) const {
  return absl::StrCat(cookie_name(request), "=", value, "; Path=/; HttpOnly; SameSite=Strict",
                      "; Max-Age=", seconds, secure_ ? "; Secure" : "");
}

}  // namespace bandsaw::coordinator
