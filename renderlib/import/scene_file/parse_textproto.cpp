// Parses a scene file in protobuf's text format with protobuf's TextFormat, which also returns the
// place of each field. Reports only the first error, with an explanation.

#include <google/protobuf/descriptor.h>
#include <google/protobuf/io/tokenizer.h>

#include <algorithm>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/str_split.h"
#include "absl/strings/string_view.h"
#include "absl/strings/strip.h"
#include "renderlib/import/scene_file/parse_scene.h"
#include "renderlib/import/scene_file/suggest.h"

namespace bandsaw {
namespace {

// Returns the text of the error that the parser describes by `message`. If a field is unknown, the
// text names the known fields. The package name "bandsaw.scene." is left out.
std::string explain(const std::string& message) {
  absl::string_view rest = message;
  // Removes the text before the next quotation mark from `rest`, and returns the removed text.
  const auto until_quote = [&rest] {
    const std::string part(rest.substr(0, rest.find('"')));
    rest.remove_prefix(std::min(rest.size(), part.size()));
    return part;
  };
  if (!absl::ConsumePrefix(&rest, "Message type \"bandsaw.scene.")) {
    return absl::StrReplaceAll(message, {{"bandsaw.scene.", ""}});
  }
  const std::string type_name = until_quote();
  const auto* type = scene::Scene::descriptor()->file()->FindMessageTypeByName(type_name);
  if (type == nullptr || !absl::ConsumePrefix(&rest, "\" has no field named \"")) {
    return absl::StrReplaceAll(message, {{"bandsaw.scene.", ""}});
  }
  const std::string name = until_quote();
  std::vector<std::string> fields;
  for (int i = 0; i < type->field_count(); ++i) {
    fields.push_back(type->field(i)->name());
  }
  return absl::StrCat("unknown field \"", name, "\" in ", type_name, did_you_mean(name, fields),
                      " (its fields: ", absl::StrJoin(fields, ", "), ")");
}

// Stores the first error; later ones mostly follow from it.
class FirstError : public google::protobuf::io::ErrorCollector {
 public:
  FirstError(const std::string& text, const std::string& file) : text_(text), file_(file) {}

  void AddError(int line, google::protobuf::io::ColumnNumber column,
                const std::string& message) override {
    if (!status_.ok()) {
      return;
    }
    const std::string place =
        line < 0 ? file_
                 : absl::StrCat(file_, ":", line + 1, ":", column_of(line, column, message));
    status_ = absl::InvalidArgumentError(absl::StrCat(place, ": ", explain(message)));
  }
  const absl::Status& status() const { return status_; }

 private:
  // Returns the column of an error, counted from 1. The parser reports a name after it has read the
  // name, so the position of the name is searched backwards from `column`.
  std::size_t column_of(int line, int column, const std::string& message) const {
    const auto from = static_cast<std::size_t>(column);
    const std::size_t open = message.find("named \"");
    if (open == std::string::npos) {
      return from + 1;
    }
    const std::string name = message.substr(open + 7, message.find('"', open + 7) - open - 7);
    const std::vector<absl::string_view> lines = absl::StrSplit(text_, '\n');
    const absl::string_view here =
        lines[std::min(lines.size() - 1, static_cast<std::size_t>(line))];
    const std::size_t found = here.substr(0, from).rfind(name);
    return 1 + (found == here.npos ? from : found);
  }

  const std::string& text_;
  const std::string& file_;
  absl::Status status_;
};

}  // namespace

absl::StatusOr<ParsedScene> parse_textproto(const std::string& text, const std::string& file) {
  ParsedScene parsed;
  parsed.locations = std::make_unique<google::protobuf::TextFormat::ParseInfoTree>();
  FirstError errors(text, file);
  google::protobuf::TextFormat::Parser parser;
  parser.RecordErrorsTo(&errors);
  parser.WriteLocationsTo(parsed.locations.get());
  parser.SetRecursionLimit(64);
  const bool good = parser.ParseFromString(text, &parsed.scene);
  if (!errors.status().ok()) {
    return errors.status();
  }
  if (!good) {
    return absl::InvalidArgumentError(
        absl::StrCat(file, ": is not a scene in protobuf text format"));
  }
  return parsed;
}

}  // namespace bandsaw
