// Writes the message of a scene file as text, for `bandsaw import`. A message that fits on one line
// is written on one line.

#include "renderlib/import/convert/scene_text.h"

#include <google/protobuf/message.h>
#include <google/protobuf/text_format.h>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"

namespace bandsaw {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

constexpr std::size_t kColumns = 100;

/// Appends the fields of messages to `text`, with indentation.
class Writer {
 public:
  std::string text;

  /// Writes all fields of `message` that are set. Their lines begin with `indent` spaces.
  void write_fields(const Message& message, std::size_t indent) {
    const auto* reflection = message.GetReflection();
    std::vector<const FieldDescriptor*> fields;
    reflection->ListFields(message, &fields);
    for (const FieldDescriptor* field : fields) {
      const int count = field->is_repeated() ? reflection->FieldSize(message, field) : 1;
      if (field->cpp_type() != FieldDescriptor::CPPTYPE_MESSAGE) {
        write_value(message, *field, count, indent);
        continue;
      }
      for (int i = 0; i < count; ++i) {
        write_message(field->is_repeated() ? reflection->GetRepeatedMessage(message, field, i)
                                           : reflection->GetMessage(message, field),
                      field->name(), indent);
      }
    }
  }

 private:
  void write_line(std::size_t indent, const std::string& line) {
    absl::StrAppend(&text, std::string(indent, ' '), line, "\n");
  }

  /// Writes a message as the field `name`: on one line if it fits into kColumns, otherwise with
  /// lines for its fields.
  void write_message(const Message& message, const std::string& name, std::size_t indent) {
    const std::string line = absl::StrCat(name, " { ", single_line(message), "}");
    if (indent + line.size() <= kColumns) {
      write_line(indent, line);
      return;
    }
    write_line(indent, name + " {");
    write_fields(message, indent + 2);
    write_line(indent, "}");
  }

  // Writes a field that is not a message. A list is written on one line.
  void write_value(const Message& message, const FieldDescriptor& field, int count,
                   std::size_t indent) {
    std::vector<std::string> values;
    for (int i = 0; i < count; ++i) {
      google::protobuf::TextFormat::PrintFieldValueToString(
          message, &field, field.is_repeated() ? i : -1, &values.emplace_back());
    }
    std::string list = values.front();
    for (std::size_t i = 1; i < values.size(); ++i) {
      absl::StrAppend(&list, ", ", values[i]);
    }
    write_line(indent, field.is_repeated() ? absl::StrCat(field.name(), ": [", list, "]")
                                           : absl::StrCat(field.name(), ": ", list));
  }

  static std::string single_line(const Message& message) {
    google::protobuf::TextFormat::Printer printer;
    printer.SetSingleLineMode(true);
    printer.SetUseShortRepeatedPrimitives(true);
    std::string line;
    printer.PrintToString(message, &line);
    return line;
  }
};

}  // namespace

std::string text_of(const scene::Scene& scene, const std::string& source,
                    const std::vector<std::string>& warnings) {
  Writer writer;
  const auto comment = [&](const std::string& line) {
    absl::StrAppend(&writer.text, "# ", absl::StrReplaceAll(line, {{"\n", " "}}), "\n");
  };
  comment(absl::StrCat("Converted from ", source, " by bandsaw import."));
  for (const std::string& warning : warnings) {
    comment(absl::StrCat("Warning: ", warning));
  }
  writer.write_fields(scene, 0);
  return std::move(writer.text);
}

}  // namespace bandsaw
