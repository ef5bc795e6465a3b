#pragma once

namespace bandsaw {

/// Returns true if the floating-point unit of this thread is in its default mode, on which all
/// results depend: round to nearest, exceptions masked, denormal numbers kept.
bool float_mode_is_default();

}  // namespace bandsaw
