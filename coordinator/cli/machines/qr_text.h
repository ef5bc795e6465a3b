#pragma once

// Draws a QR code on a terminal, for `bandsaw link`.

#include <string>

#include "coordinator/web/qr_code.h"

namespace bandsaw::coordinator {

/// Returns lines of text with the code and its margin. Each line shows two rows of modules (squares
/// of the code) by half blocks. The colours are explicitly black and white (of 256 colours), so
/// that cameras recognise the code on dark and on light terminals.
std::string qr_text(const QrCode& code);

}  // namespace bandsaw::coordinator
