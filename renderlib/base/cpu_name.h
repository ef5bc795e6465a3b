#pragma once

#include <string>

namespace bandsaw {

/// The processor as Linux names it, for people: "AMD EPYC-Milan Processor". "unknown CPU" where it
/// says nothing.
std::string cpu_name();

}  // namespace bandsaw
