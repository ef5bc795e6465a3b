// Integrators, tones, layers and kernels have names in the code. The options that choose one of
// them accept these names. The words that the other options accept are listed in choices_of().

#include "coordinator/cli/options/choices.h"

#include <algorithm>
#include <iterator>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "absl/types/span.h"
#include "coordinator/cli/options/did_you_mean.h"
#include "renderlib/image/display.h"
#include "renderlib/scene/integrator.h"

namespace bandsaw::coordinator {
namespace {

/// Returns the names of the values 0 to `last` of an enumeration.
template <class Kind>
std::vector<std::string> names_of(int last, absl::string_view (*name)(Kind)) {
  std::vector<std::string> names;
  for (int i = 0; i <= last; ++i) {
    names.emplace_back(name(static_cast<Kind>(i)));
  }
  return names;
}

}  // namespace

std::vector<std::string> choices_of(const std::string& name) {
  if (name == "--integrator") {
    return names_of(kLastIntegrator, integrator_name);
  }
  if (name == "--tone") {
    return names_of(kLastTone, tone_name);
  }
  if (name == "--layers") {
    return {std::begin(kLayerNames), std::end(kLayerNames)};
  }
  if (name == "--kernel") {
    std::vector<std::string> names;
    for (const Kernel* kernel : kernels()) {
      names.emplace_back(kernel->name);
    }
    return names;
  }
  if (name == "--denoise") {
    return {"regression", "oidn"};
  }
  if (name == "--browsers") {
    return {"none", "also", "only"};  // in the order of the enumeration Browsers
  }
  if (name == "action") {
    return {"rotate"};
  }
  if (name == "role") {
    return {"worker", "farm"};
  }
  if (name == "shell") {
    return {"bash"};
  }
  return {};
}

absl::StatusOr<const Kernel*> chosen_kernel(const std::optional<std::string>& name) {
  if (!name) {
    return nullptr;
  }
  const absl::StatusOr<const Kernel*> kernel = find_kernel(*name);
  return kernel.ok() ? kernel : wrong_choice("--kernel", *name);
}

absl::StatusOr<std::vector<LayerKind>> parse_layers(const std::string& list) {
  std::vector<LayerKind> kinds;
  for (const absl::string_view name : absl::StrSplit(list, ',')) {
    const auto* found = std::find(std::begin(kLayerNames), std::end(kLayerNames), name);
    const auto kind = static_cast<LayerKind>(found - std::begin(kLayerNames));
    if (found == std::end(kLayerNames)) {
      return wrong_choice("--layers", std::string(name));
    }
    if (std::find(kinds.begin(), kinds.end(), kind) != kinds.end()) {
      return absl::InvalidArgumentError(absl::StrCat(
          "--layers: must name each layer at most once; '", list, "' names ", name, " twice"));
    }
    kinds.push_back(kind);
  }
  return kinds;
}

std::string one_of(const std::vector<std::string>& words) {
  const auto all = absl::MakeConstSpan(words);
  return all.size() < 2
             ? absl::StrJoin(all, "")
             : absl::StrCat(absl::StrJoin(all.first(all.size() - 1), ", "), " or ", all.back());
}

absl::Status wrong_choice(const std::string& called, const std::string& name,
                          const std::string& text) {
  const std::vector<std::string> words = choices_of(name);
  const auto meant = did_you_mean(text, words);
  return absl::InvalidArgumentError(absl::StrCat(called, ": must be ", one_of(words), ", is '",
                                                 text, "'",
                                                 meant ? "; did you mean " + *meant + "?" : ""));
}

}  // namespace bandsaw::coordinator
