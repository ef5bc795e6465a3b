#pragma once

#include <optional>
#include <string>

#include "coordinator/core/core.h"

namespace bandsaw::coordinator {

/// Why a worker cannot serve on this farm, for its log: what differs, and what to do. Nothing when
/// it is fit.
std::optional<std::string> unfit(const Fitness& farm, const WorkerHello& worker);

}  // namespace bandsaw::coordinator
