// Lets libqrencode make a code, and converts its modules (cells). libqrencode stores one byte for
// each module. The lowest bit of this byte is 1 if the module is dark.

#include "coordinator/web/qr_code.h"

#include <qrencode.h>

#include <memory>

#include "absl/strings/str_cat.h"

namespace bandsaw::coordinator {
namespace {

struct FreeCode {
  void operator()(QRcode* code) const { QRcode_free(code); }
};

}  // namespace

absl::StatusOr<QrCode> qr_code(absl::string_view text) {
  // The version of a code is its size. 0: the smallest version that has room for the text.
  const std::unique_ptr<QRcode, FreeCode> made(
      QRcode_encodeString8bit(std::string(text).c_str(), /*version=*/0, QR_ECLEVEL_M));
  if (made == nullptr) {
    return absl::InvalidArgumentError(
        absl::StrCat("a QR code cannot hold this text of ", text.size(), " bytes"));
  }
  QrCode code;
  code.side = made->width;
  const auto modules =
      static_cast<std::size_t>(made->width) * static_cast<std::size_t>(made->width);
  for (std::size_t i = 0; i < modules; ++i) {
    code.dark.push_back((made->data[i] & 1) != 0);
  }
  return code;
}

std::string qr_svg(const QrCode& code) {
  const int size = code.side + 2 * QrCode::kMargin;
  std::string path;
  for (int y = 0; y < code.side; ++y) {
    for (int x = 0; x < code.side; ++x) {
      if (code.is_dark(x, y)) {
        absl::StrAppend(&path, "M", x + QrCode::kMargin, " ", y + QrCode::kMargin, "h1v1h-1z");
      }
    }
  }
  return absl::StrCat("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 ", size, " ", size,
                      "\" shape-rendering=\"crispEdges\"><path fill=\"#fff\" d=\"M0 0h", size, "v",
                      size, "h-", size, "z\"/><path d=\"", path, "\"/></svg>\n");
}

}  // namespace bandsaw::coordinator
