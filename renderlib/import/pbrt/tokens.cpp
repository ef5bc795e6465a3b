// Splits the files of a pbrt scene into words. Open files form a stack: next() returns the words of
// the file that was included last. After the last word of this file, next() continues with the file
// that includes it.

#include "renderlib/import/pbrt/tokens.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "renderlib/base/file.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/files/inflate.h"

namespace bandsaw::pbrt {
namespace {

bool is_space(char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r'; }
bool ends_word(char c) { return is_space(c) || c == '"' || c == '[' || c == ']' || c == '#'; }

/// Returns the error `status` with the place at the beginning of its message.
absl::Status at_place(const Place& place, const absl::Status& status) {
  return absl::Status(status.code(), absl::StrCat(text_of(place), ": ", status.message()));
}

}  // namespace

absl::Status Tokens::include(const std::string& name, const Place& place) {
  const auto path = folder_.resolve(name, folder_.path());
  if (!path.ok()) {
    return at_place(place, path.status());
  }
  for (const Source& source : open_) {
    if (source.path == *path) {
      return error_at(place, absl::StrCat("\"", name, "\" includes itself"));
    }
  }
  if (open_.size() >= kMaxIncludes) {
    return at_place(place, absl::ResourceExhaustedError(absl::StrCat("more than ", kMaxIncludes,
                                                                     " files include each other")));
  }
  auto bytes = read_whole_file(*path, kMaxFileBytes);
  if (bytes.ok() && is_gzip(*bytes)) {
    bytes = inflate(*bytes, DeflateKind::kGzip, kMaxFileBytes);
  }
  if (!bytes.ok()) {
    return at_place(place,
                    absl::Status(bytes.status().code(),
                                 absl::StrCat("\"", name, "\": ", bytes.status().message())));
  }
  total_bytes_ += bytes->size();
  if (total_bytes_ > kMaxSceneBytes) {
    return at_place(place, absl::ResourceExhaustedError("the scene has more than 4 GiB of text"));
  }
  open_.push_back({*path, name, *std::move(bytes)});
  return absl::OkStatus();
}

void Tokens::skip_space(Source& from) {
  while (from.at < from.text.size()) {
    const char c = from.text[from.at];
    if (c == '#') {
      const std::size_t end = from.text.find('\n', from.at);
      from.at = end == std::string::npos ? from.text.size() : end;
    } else if (is_space(c)) {
      from.line += c == '\n' ? 1 : 0;
      ++from.at;
    } else {
      return;
    }
  }
}

absl::StatusOr<Token> Tokens::read_string(Source& from) {
  Token token{Token::Kind::kString, "", {from.name, from.line}};
  for (++from.at; from.at < from.text.size(); ++from.at) {
    char c = from.text[from.at];
    if (c == '"') {
      ++from.at;
      return token;
    }
    if (c == '\n') {
      break;
    }
    if (c == '\\' && from.at + 1 < from.text.size()) {
      c = from.text[++from.at];
      c = c == 'n' ? '\n' : c == 't' ? '\t' : c == 'r' ? '\r' : c;
    }
    token.text.push_back(c);
  }
  return error_at(token.place, "the string has no end on its line");
}

absl::StatusOr<std::optional<Token>> Tokens::next() {
  if (back_) {
    return std::exchange(back_, std::nullopt);
  }
  while (!open_.empty()) {
    Source& from = open_.back();
    skip_space(from);
    if (from.at == from.text.size()) {
      open_.pop_back();
      continue;
    }
    const char c = from.text[from.at];
    if (c == '"') {
      ASSIGN_OR_RETURN(Token token, read_string(from));
      return token;
    }
    Token token{Token::Kind::kWord, std::string(1, c), {from.name, from.line}};
    if (c == '[' || c == ']') {
      ++from.at;
      token.kind = c == '[' ? Token::Kind::kOpen : Token::Kind::kClose;
      return token;
    }
    const std::size_t begin = from.at;
    while (from.at < from.text.size() && !ends_word(from.text[from.at])) {
      ++from.at;
    }
    token.text = from.text.substr(begin, from.at - begin);
    return token;
  }
  return std::nullopt;
}

}  // namespace bandsaw::pbrt
