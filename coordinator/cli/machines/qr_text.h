#pragma once

// A QR code on a terminal.

#include <string>

#include "coordinator/web/qr_code.h"

namespace bandsaw::coordinator {

/// Returns lines of half blocks with the margin, two rows of modules a line, in explicit black and
/// white (256 colours), so that readers find them on dark and on light terminals.
std::string qr_text(const QrCode& code);

}  // namespace bandsaw::coordinator
