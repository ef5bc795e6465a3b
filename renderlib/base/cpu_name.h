#pragma once

#include <string>

namespace bandsaw {

/// Returns Linux's name of the processor, for display: "AMD EPYC-Milan Processor"; "unknown CPU" if
/// Linux reports none.
std::string cpu_name();

}  // namespace bandsaw
