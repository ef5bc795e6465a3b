#pragma once

#include <string>

namespace bandsaw {

/// Returns Linux's name of the processor for display, for example "AMD EPYC-Milan Processor".
/// Returns "unknown CPU" if Linux reports no name.
std::string cpu_name();

}  // namespace bandsaw
