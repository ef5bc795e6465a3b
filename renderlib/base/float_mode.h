#pragma once

namespace bandsaw {

/// Returns true if the floating-point unit of this thread is in its default mode, on which all
/// results depend: round to nearest, exceptions masked, denormal numbers kept. The worker calls
/// this function when it starts.
bool float_mode_is_default();

}  // namespace bandsaw
