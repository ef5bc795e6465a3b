#pragma once

// What of a model is not rendered. The same of many materials is one warning.

#include <map>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"

namespace bandsaw {

class LeftOut {
 public:
  /// `what` is a sentence without subject: "its specular map is left out".
  void add(const std::string& what, const std::string& material) {
    materials_[what].push_back(material);
  }

  /// "helmet.glb: material "steel" and 2 more: its specular map is left out"
  void tell(const std::string& model, std::vector<std::string>& warnings) const {
    for (const auto& [what, who] : materials_) {
      const std::string others =
          who.size() > 1 ? absl::StrCat(" and ", who.size() - 1, " more") : "";
      warnings.push_back(absl::StrCat(model, ": material ", who.front(), others, ": ", what));
    }
  }

 private:
  std::map<std::string, std::vector<std::string>> materials_;
};

}  // namespace bandsaw
