// Decodes the targets of requests, and cuts a range of bytes out of a response.

#include "coordinator/web/http.h"

#include <algorithm>
#include <cstdint>
#include <optional>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "absl/strings/strip.h"

namespace bandsaw::coordinator {
namespace {

/// Returns the value of a hexadecimal digit; -1: `c` is none.
int hex_digit(char c) {
  if (absl::ascii_isdigit(static_cast<unsigned char>(c))) {
    return c - '0';
  }
  const char lower = absl::ascii_tolower(static_cast<unsigned char>(c));
  return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : -1;
}

/// Returns the text with each percent escape, such as "%20", replaced by the byte that it stands
/// for. If `plus_is_space`, each '+' is replaced by a space.
std::string decoded(absl::string_view text, bool plus_is_space) {
  std::string out;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const int high = text[at] == '%' && at + 2 < text.size() ? hex_digit(text[at + 1]) : -1;
    const int low = high >= 0 ? hex_digit(text[at + 2]) : -1;
    if (low >= 0) {
      out.push_back(static_cast<char>(high * 16 + low));
      at += 2;
    } else {
      out.push_back(plus_is_space && text[at] == '+' ? ' ' : text[at]);
    }
  }
  return out;
}

struct ByteRange {
  std::uint64_t first = 0;
  std::uint64_t last = 0;  ///< inclusive; less than `first`: the body has no such bytes
};

/// Parses the value of the header Range, such as "bytes=0-99", for a body of `size` bytes.
/// std::nullopt: the value is not exactly one valid range of bytes.
std::optional<ByteRange> range_of(absl::string_view header, std::uint64_t size) {
  if (!absl::StartsWithIgnoreCase(header, "bytes=") || !absl::StrContains(header, '-')) {
    return std::nullopt;
  }
  const std::pair<absl::string_view, absl::string_view> ends =
      absl::StrSplit(header.substr(6), absl::MaxSplits('-', 1));
  std::uint64_t first = 0;
  std::uint64_t last = size - 1;
  const bool has_last = !ends.second.empty();
  if ((has_last && !absl::SimpleAtoi(ends.second, &last)) ||
      (!ends.first.empty() && !absl::SimpleAtoi(ends.first, &first)) ||
      (ends.first.empty() && !has_last) || (!ends.first.empty() && has_last && last < first)) {
    return std::nullopt;
  }
  if (ends.first.empty()) {  // "bytes=-N": the last N bytes
    return last == 0 || size == 0 ? ByteRange{1, 0}
                                  : ByteRange{size - std::min(last, size), size - 1};
  }
  return first >= size ? ByteRange{1, 0} : ByteRange{first, std::min(last, size - 1)};
}

/// Returns the value of the first field of this name, ignoring case; empty: there is none.
std::string value_of_first(const std::vector<HttpField>& fields, absl::string_view name) {
  const auto found = std::find_if(fields.begin(), fields.end(), [&](const HttpField& field) {
    return absl::EqualsIgnoreCase(field.first, name);
  });
  return found == fields.end() ? "" : found->second;
}

}  // namespace

std::string HttpRequest::header(absl::string_view name) const {
  return value_of_first(headers, name);
}

bool HttpRequest::has_header(absl::string_view name) const {
  return std::any_of(headers.begin(), headers.end(), [&](const HttpField& field) {
    return absl::EqualsIgnoreCase(field.first, name);
  });
}

std::string HttpRequest::parameter(absl::string_view name) const {
  const auto found =
      std::find_if(parameters.begin(), parameters.end(),
                   [&](const HttpField& parameter) { return parameter.first == name; });
  return found == parameters.end() ? "" : found->second;
}

void parse_target(absl::string_view target, HttpRequest& request) {
  const std::pair<absl::string_view, absl::string_view> parts =
      absl::StrSplit(target, absl::MaxSplits('?', 1));
  request.path = decoded(parts.first, /*plus_is_space=*/false);
  request.parameters.clear();
  for (const absl::string_view one : absl::StrSplit(parts.second, '&', absl::SkipEmpty())) {
    const std::pair<absl::string_view, absl::string_view> named =
        absl::StrSplit(one, absl::MaxSplits('=', 1));
    request.parameters.emplace_back(decoded(named.first, /*plus_is_space=*/true),
                                    decoded(named.second, /*plus_is_space=*/true));
  }
}

HttpReply text_reply(std::string text, std::string type) {
  HttpReply reply;
  const auto held = std::make_shared<const std::string>(std::move(text));
  reply.type = std::move(type);
  reply.bytes = *held;
  reply.held = held;
  return reply;
}

HttpReply with_range(const HttpRequest& request, HttpReply reply) {
  if (request.method != "GET" || reply.status != 200 || !request.has_header("Range") ||
      request.has_header("If-Range")) {  // If-Range is not evaluated
    return reply;
  }
  const std::size_t size = reply.bytes.size();
  const std::optional<ByteRange> range = range_of(request.header("Range"), size);
  if (!range.has_value()) {
    return reply;
  }
  if (range->last < range->first) {
    return {.status = 416, .headers = {{"Content-Range", absl::StrCat("bytes */", size)}}};
  }
  reply.status = 206;
  reply.bytes = reply.bytes.substr(range->first, range->last - range->first + 1);
  reply.headers.emplace_back("Content-Range",
                             absl::StrCat("bytes ", range->first, "-", range->last, "/", size));
  return reply;
}

}  // namespace bandsaw::coordinator
