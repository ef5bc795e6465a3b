// Stores and names the files that the converter of another renderer's scene makes. Files with equal
// contents get one name. A hash finds candidates, which are then compared.

#include "renderlib/import/convert/made_files.h"

#include <functional>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"

namespace bandsaw {

MadeFiles::MadeFiles(const std::string& scene)
    : folder_(absl::StrCat(scene.substr(0, scene.find('.')), "_files/")) {}

std::string MadeFiles::add(absl::string_view what, absl::string_view suffix, std::string bytes) {
  const std::size_t hash = std::hash<std::string>{}(bytes);
  const auto [first, last] = names_by_hash_.equal_range(hash);
  for (auto same = first; same != last; ++same) {
    if (absl::EndsWith(same->second, suffix) && files_.at(same->second) == bytes) {
      return same->second;
    }
  }
  const int number = ++counts_[std::string(what)];
  std::string name = absl::StrCat(folder_, what, "_", number, suffix);
  names_by_hash_.emplace(hash, name);
  files_.emplace(name, std::move(bytes));
  return name;
}

const std::string* MadeFiles::find(const std::string& name) const {
  const auto found = files_.find(name);
  return found == files_.end() ? nullptr : &found->second;
}

}  // namespace bandsaw
