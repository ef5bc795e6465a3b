#pragma once

// Collects the features of a model's materials that are not rendered, so that the same feature of
// many materials is one warning.

#include <map>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"

namespace bandsaw {

class UnsupportedFeatures {
 public:
  /// Adds a feature of a material. `what` says what is done with the feature: "its specular map is
  /// left out". `material` is the material's name in messages, with quotes.
  void add(const std::string& what, const std::string& material) {
    materials_[what].push_back(material);
  }

  /// Appends one warning for each feature:
  /// "helmet.glb: material "steel" and 2 more: its specular map is left out".
  void add_warnings(const std::string& model, std::vector<std::string>& warnings) const {
    for (const auto& [what, materials] : materials_) {
      const std::string others =
          materials.size() > 1 ? absl::StrCat(" and ", materials.size() - 1, " more") : "";
      warnings.push_back(absl::StrCat(model, ": material ", materials.front(), others, ": ", what));
    }
  }

 private:
  std::map<std::string, std::vector<std::string>> materials_;
};

}  // namespace bandsaw
