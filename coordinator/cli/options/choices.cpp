#include "coordinator/cli/options/choices.h"

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/types/span.h"
#include "coordinator/cli/options/did_you_mean.h"
#include "coordinator/cli/options/layers.h"
#include "renderlib/image/display.h"
#include "renderlib/scene/integrator.h"

namespace bandsaw::coordinator {
namespace {

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
    return layer_names();
  }
  if (name == "--kernel") {
    std::vector<std::string> names;
    for (const Kernel* kernel : kernels()) {
      names.emplace_back(kernel->name);
    }
    return names;
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
