// A Field is a message of a scene file with its path and its place in the file, for errors. Paths
// and places are computed only for error messages and for child messages.

#include "renderlib/import/scene_file/field.h"

#include "absl/strings/str_cat.h"
#include "renderlib/base/check.h"

namespace bandsaw {
namespace {

const google::protobuf::FieldDescriptor* descriptor(const google::protobuf::Message& message,
                                                    const std::string& name) {
  const auto* field = message.GetDescriptor()->FindFieldByName(name);
  BANDSAW_CHECK(field != nullptr, "the reader only asks for fields of scene.proto");
  return field;
}

}  // namespace

std::string Field::path(const std::string& name, int index) const {
  std::string path = path_.empty() ? name : absl::StrCat(path_, ".", name);
  return index < 0 ? path : absl::StrCat(path, "[", index, "]");
}

Field::At Field::at(const std::string& name, int index) const {
  if (tree_ == nullptr) {
    return at_;
  }
  const auto* field = descriptor(*message_, name);
  const int count = field->is_repeated()
                        ? message_->GetReflection()->FieldSize(*message_, field)
                        : (message_->GetReflection()->HasField(*message_, field) ? 1 : 0);
  // An error about a whole list refers to its beginning.
  const int shown = field->is_repeated() && index < 0 && count > 0 ? 0 : index;
  if (count == 0 || shown >= count) {
    return at_;
  }
  auto location = tree_->GetLocation(field, shown);
  if (location.line < 0 && shown > 0) {
    // For a list in brackets only the position of its beginning is known.
    location = tree_->GetLocation(field, 0);
  }
  return location.line < 0 ? at_ : At{location.line, location.column};
}

Field Field::child(const std::string& name, int index) const {
  const auto* field = descriptor(*message_, name);
  const auto* reflection = message_->GetReflection();
  Field child = *this;
  child.message_ = index < 0 ? &reflection->GetMessage(*message_, field)
                             : &reflection->GetRepeatedMessage(*message_, field, index);
  child.tree_ = tree_ == nullptr ? nullptr : tree_->GetTreeForNested(field, index);
  child.path_ = path(name, index);
  child.at_ = at(name, index);
  return child;
}

bool Field::has(const std::string& name) const {
  return message_->GetReflection()->HasField(*message_, descriptor(*message_, name));
}

absl::Status Field::error(const std::string& name, absl::string_view what, int index) const {
  return failure(at(name, index), path(name, index), what);
}

absl::Status Field::error(absl::string_view what) const { return failure(at_, path_, what); }

absl::Status Field::failure(const At& at, const std::string& path, absl::string_view what) const {
  const std::string place =
      at.line < 0 ? *file_ : absl::StrCat(*file_, ":", at.line + 1, ":", at.column + 1);
  return absl::InvalidArgumentError(path.empty() ? absl::StrCat(place, ": ", what)
                                                 : absl::StrCat(place, ": ", path, ": ", what));
}

}  // namespace bandsaw
