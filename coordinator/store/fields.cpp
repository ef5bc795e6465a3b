// Fields are lines of a name and a value, in a fixed order. The reader stops at the first field
// that is not the expected one, and reports it at the end.

#include "coordinator/store/fields.h"

#include <array>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"

namespace bandsaw::coordinator {

void FieldWriter::text(absl::string_view name, absl::string_view value) {
  absl::StrAppend(&out_, name, " ", absl::CEscape(value), "\n");
}

void FieldWriter::number(absl::string_view name, std::uint64_t value) {
  absl::StrAppend(&out_, name, " ", value, "\n");
}

void FieldWriter::real(absl::string_view name, double value) {
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  absl::StrAppend(&out_, name, " ",
                  absl::string_view(digits.data(), static_cast<std::size_t>(end - digits.data())),
                  "\n");
}

void FieldReader::refuse(std::string reason) {
  if (status_.ok()) {
    status_ = absl::DataLossError(std::move(reason));
  }
  rest_ = {};
}

absl::string_view FieldReader::value_of(absl::string_view name) {
  const std::size_t end = rest_.find('\n');
  const absl::string_view line = rest_.substr(0, end);
  if (end == absl::string_view::npos || line.size() <= name.size() ||
      line.substr(0, name.size()) != name || line[name.size()] != ' ') {
    refuse(absl::StrCat("expected the field '", name, "', found '", line.substr(0, 40), "'"));
    return {};
  }
  rest_.remove_prefix(end + 1);
  return line.substr(name.size() + 1);
}

bool FieldReader::next_is(absl::string_view name) const {
  return rest_.size() > name.size() && rest_.substr(0, name.size()) == name &&
         rest_[name.size()] == ' ';
}

std::string FieldReader::text(absl::string_view name) {
  std::string value;
  std::string error;
  if (!absl::CUnescape(value_of(name), &value, &error)) {
    refuse(absl::StrCat("field '", name, "': ", error));
    return {};
  }
  return value;
}

std::uint64_t FieldReader::number(absl::string_view name, std::uint64_t most) {
  const absl::string_view digits = value_of(name);
  if (!status_.ok()) {
    return 0;
  }
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size() || value > most) {
    refuse(absl::StrCat("field '", name, "' must be a number of at most ", most, ", found '",
                        digits.substr(0, 40), "'"));
    return 0;
  }
  return value;
}

double FieldReader::real(absl::string_view name) {
  const absl::string_view digits = value_of(name);
  if (!status_.ok()) {
    return 0;
  }
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size()) {
    refuse(absl::StrCat("field '", name, "' must be a real number, found '", digits.substr(0, 40),
                        "'"));
    return 0;
  }
  return value;
}

absl::Status FieldReader::finish() {
  if (!rest_.empty()) {
    refuse(absl::StrCat("unknown field at '", rest_.substr(0, 40), "'"));
  }
  return status_;
}

}  // namespace bandsaw::coordinator
