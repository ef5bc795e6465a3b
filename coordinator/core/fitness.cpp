#include "coordinator/core/fitness.h"

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"

namespace bandsaw::coordinator {

std::optional<std::string> unfit(const Fitness& farm, const WorkerHello& worker) {
  const char* const which =
      worker.protocol < farm.protocol || worker.pixel_version < farm.pixel_version
          ? "update the worker"
          : "update the coordinator";
  if (worker.protocol != farm.protocol) {
    return absl::StrCat("protocol ", worker.protocol, ", the coordinator's is ", farm.protocol,
                        ": build ", worker.build, "; ", which);
  }
  if (worker.pixel_version != farm.pixel_version) {
    return absl::StrCat("pixel version ", worker.pixel_version, ", the coordinator's is ",
                        farm.pixel_version, ": build ", worker.build, "; ", which);
  }
  if (worker.canary != farm.canary) {
    return absl::StrFormat(
        "its test render gives other pixels (canary %016x, the coordinator's is %016x): build %s; "
        "compile both from the same sources",
        worker.canary, farm.canary, worker.build);
  }
  return std::nullopt;
}

}  // namespace bandsaw::coordinator
