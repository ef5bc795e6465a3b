#pragma once

// QR codes (ISO/IEC 18004), made by libqrencode. `bandsaw link` and the dashboard show the link for
// browsers as a QR code.

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

namespace bandsaw::coordinator {

/// A square of modules (dark or light cells), without the light margin of four modules that a
/// reader needs around it.
struct QrCode {
  static constexpr int kMargin = 4;  ///< modules
  int side = 0;                      ///< modules
  std::vector<bool> dark;            ///< side x side, rows from the top

  /// Returns true if the module in column `x` and row `y` is dark. Places outside of the code are
  /// light, so that a drawing may begin at -kMargin.
  bool is_dark(int x, int y) const {
    return x >= 0 && y >= 0 && x < side && y < side && dark[static_cast<std::size_t>(y * side + x)];
  }
};

/// Returns the code of a text. Its error correction has level M: the text can be read although
/// about 15 % of the code are damaged. INVALID_ARGUMENT: the text is too long for a code.
absl::StatusOr<QrCode> qr_code(absl::string_view text);

/// Returns the code with a margin around it as an SVG image, dark on white.
std::string qr_svg(const QrCode& code);

}  // namespace bandsaw::coordinator
