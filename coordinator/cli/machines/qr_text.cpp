// Draws a QR code as text. Each character shows two modules (squares of the code), one above the
// other.

#include "coordinator/cli/machines/qr_text.h"

#include "absl/strings/str_cat.h"

namespace bandsaw::coordinator {

std::string qr_text(const QrCode& code) {
  const int last = code.side + QrCode::kMargin;
  std::string text;
  for (int y = -QrCode::kMargin; y < last; y += 2) {
    text += "\x1b[38;5;16;48;5;231m";  // black on white
    for (int x = -QrCode::kMargin; x < last; ++x) {
      const bool upper = code.is_dark(x, y);
      const bool lower = code.is_dark(x, y + 1);
      text += upper && lower ? "█" : upper ? "▀" : lower ? "▄" : " ";
    }
    text += "\x1b[0m\n";
  }
  return text;
}

}  // namespace bandsaw::coordinator
