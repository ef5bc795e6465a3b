// Parses a join string (join.h) from both ends. Version and role are taken from the front. The
// secret and the digest, which have fixed lengths, are taken from the back. The addresses,
// and after them the dashboard if it is named, remain in between.

#include "proto/link/join.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <memory>

#include "absl/strings/ascii.h"
#include "absl/strings/escaping.h"
#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "proto/link/random.h"

namespace bandsaw::link {
namespace {

/// Every join string begins with this; the number is the version of the format.
constexpr char kForm[] = "bsw1-";
/// Stands in place of the digest if the coordinator has no TLS.
constexpr char kPlain[] = "plain";
constexpr std::size_t kDigestLength = 43;  // 32 bytes, base64url without padding
constexpr std::size_t kMaxAddresses = 8;
constexpr std::size_t kMaxFile = 64 << 10;

absl::Status wrong(absl::string_view what) {
  return absl::InvalidArgumentError(absl::StrCat("wrong join string: ", what));
}

bool is_base64url(absl::string_view text) {
  return std::all_of(text.begin(), text.end(),
                     [](char c) { return absl::ascii_isalnum(c) || c == '-' || c == '_'; });
}

/// Returns INVALID_ARGUMENT if the address is not HOST:PORT or [IPv6]:PORT.
absl::Status check_address(absl::string_view address) {
  const std::size_t colon = address.rfind(':');
  if (colon == absl::string_view::npos || colon == 0) {
    return wrong(absl::StrCat("the address '", address, "' is not HOST:PORT"));
  }
  absl::string_view host = address.substr(0, colon);
  const bool bracketed = absl::StartsWith(host, "[") && absl::EndsWith(host, "]");
  if (bracketed) {
    host = host.substr(1, host.size() - 2);
  }
  const bool good_host = !host.empty() && std::all_of(host.begin(), host.end(), [&](char c) {
    return absl::ascii_isalnum(c) || c == '.' || c == '-' || c == '_' ||
           (bracketed && (c == ':' || c == '%'));
  });
  if (!good_host) {
    return wrong(absl::StrCat("'", address, "' does not name a host (IPv6 goes in brackets)"));
  }
  int port = 0;
  if (!absl::SimpleAtoi(address.substr(colon + 1), &port) || port < 1 || port > 65535) {
    return wrong(absl::StrCat("the port of '", address, "' is not a number from 1 to 65535"));
  }
  return absl::OkStatus();
}

absl::StatusOr<std::vector<std::string>> parse_addresses(absl::string_view text) {
  std::vector<std::string> addresses = absl::StrSplit(text, ',');
  if (addresses.size() > kMaxAddresses) {
    return wrong(absl::StrCat("it holds more than ", kMaxAddresses, " addresses"));
  }
  for (const std::string& address : addresses) {
    if (absl::Status status = check_address(address); !status.ok()) {
      return status;
    }
  }
  return addresses;
}

/// Removes "-TAIL" from the end of `rest` and sets `tail`, which has `length` characters. Returns
/// false if there is no dash at that place. Digest and secret may contain dashes, so the string
/// cannot be split at dashes.
bool take_tail(absl::string_view& rest, std::size_t length, absl::string_view& tail) {
  if (rest.size() < length + 1 || rest[rest.size() - length - 1] != '-') {
    return false;
  }
  tail = rest.substr(rest.size() - length);
  rest = rest.substr(0, rest.size() - length - 1);
  return true;
}

/// Returns true if `rest` ends in "-plain" after a port. A digest contains neither colon nor plus,
/// so nothing else ends in ":PORT-plain" or "+PORT-plain".
bool is_plain(absl::string_view rest) {
  if (!absl::ConsumeSuffix(&rest, absl::StrCat("-", kPlain))) {
    return false;
  }
  const std::size_t colon = rest.find_last_of(":+");
  return colon != absl::string_view::npos && colon + 1 < rest.size() &&
         std::all_of(rest.begin() + static_cast<std::ptrdiff_t>(colon) + 1, rest.end(),
                     absl::ascii_isdigit);
}

/// Returns the text of a file of at most kMaxFile bytes. `name` is for error messages.
absl::StatusOr<std::string> read_stream(std::FILE* file, const std::string& name) {
  std::string text(kMaxFile + 1, '\0');
  const std::size_t size = std::fread(text.data(), 1, text.size(), file);
  if (std::ferror(file) != 0 || size > kMaxFile) {
    return absl::InvalidArgumentError(absl::StrCat("cannot read a join string from ", name));
  }
  text.resize(size);
  return text;
}

}  // namespace

std::string JoinString::text() const {
  const std::string digest =
      certificate ? absl::WebSafeBase64Escape(certificate->raw()) : std::string(kPlain);
  return absl::StrCat(kForm, role == Role::kWorker ? "w-" : "f-", absl::StrJoin(addresses, ","),
                      web.empty() ? "" : "+", web, "-", digest, "-", secret);
}

absl::StatusOr<JoinString> parse_join_string(const std::string& text) {
  absl::string_view rest = absl::StripAsciiWhitespace(text);
  if (!absl::ConsumePrefix(&rest, kForm)) {
    return wrong(absl::StrCat("it does not begin with ", kForm));
  }
  JoinString join;
  if (absl::ConsumePrefix(&rest, "w-")) {
    join.role = Role::kWorker;
  } else if (absl::ConsumePrefix(&rest, "f-")) {
    join.role = Role::kFarm;
  } else {
    return wrong("its role is neither w (worker) nor f (farm)");
  }
  absl::string_view secret;
  if (!take_tail(rest, kSecretLength, secret) || !is_base64url(secret)) {
    return wrong("it does not end in a secret of 22 characters; was it cut off?");
  }
  join.secret = std::string(secret);
  if (is_plain(rest)) {
    absl::ConsumeSuffix(&rest, absl::StrCat("-", kPlain));
  } else {
    absl::string_view digest;
    std::string raw;
    if (!take_tail(rest, kDigestLength, digest) || !is_base64url(digest) ||
        !absl::WebSafeBase64Unescape(digest, &raw)) {
      return wrong("the digest of the certificate is not 43 characters; was it cut off?");
    }
    absl::StatusOr<wire::Digest> parsed = wire::digest_from_raw(raw);
    if (!parsed.ok()) {
      return wrong("the digest of the certificate is not 32 bytes");
    }
    join.certificate = *parsed;
  }
  if (const std::size_t plus = rest.find('+'); plus != absl::string_view::npos) {
    join.web = std::string(rest.substr(plus + 1));
    rest = rest.substr(0, plus);
    const bool is_port = !absl::StrContains(join.web, ':');
    if (absl::Status status = check_address(is_port ? "host:" + join.web : join.web);
        !status.ok()) {
      return status;
    }
  }
  absl::StatusOr<std::vector<std::string>> addresses = parse_addresses(rest);
  if (!addresses.ok()) {
    return addresses.status();
  }
  join.addresses = *std::move(addresses);
  return join;
}

absl::StatusOr<JoinString> join_string_from(const std::string& text) {
  if (absl::StartsWith(absl::StripLeadingAsciiWhitespace(text), kForm)) {
    return parse_join_string(text);
  }
  if (text == "-") {
    absl::StatusOr<std::string> read = read_stream(stdin, "standard input");
    return read.ok() ? parse_join_string(*read) : read.status();
  }
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(text.c_str(), "rb"),
                                                             &std::fclose);
  if (file == nullptr) {
    // The text may be a mistyped join string with a secret, so it is not repeated.
    const bool may_be_secret = text.size() > kSecretLength && absl::StrContains(text, ':');
    return absl::InvalidArgumentError(
        absl::StrCat(may_be_secret ? "the join string given" : absl::StrCat("'", text, "'"),
                     " does not begin with ", kForm, " and is not a file that can be read"));
  }
  absl::StatusOr<std::string> read = read_stream(file.get(), absl::StrCat("'", text, "'"));
  if (!read.ok()) {
    return read.status();
  }
  absl::StatusOr<JoinString> join = parse_join_string(*read);
  if (!join.ok()) {
    return absl::InvalidArgumentError(absl::StrCat(text, ": ", join.status().message()));
  }
  return join;
}

void hide_join_strings(absl::Span<char* const> arguments) {
  for (char* argument : arguments) {
    if (char* found = std::strstr(argument, kForm)) {
      found += std::strlen(kForm);
      std::memset(found, 'x', std::strlen(found));
    }
  }
}

}  // namespace bandsaw::link
