#pragma once

// The viewer tev (https://github.com/Tom94/tev), which shows images that other programs send it.
// Its protocol: packets over TCP, each a 32-bit length of the whole packet, an operation in one
// byte, then fields; numbers little-endian, strings end in a zero byte.

#include <cstdint>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "proto/link/socket.h"
#include "renderlib/image/image.h"

namespace bandsaw::coordinator {

/// What is sent. Pure; the length has 32 bits, which the caller below does not come near.
namespace tev {

/// A new image of this size, black, with the channels R, G and B; shown at once.
std::string create_image(const std::string& name, std::uint32_t width, std::uint32_t height);
/// Rows [first, last) of the image, linear.
std::string update_rows(const std::string& name, const Image& image, std::uint32_t first,
                        std::uint32_t last);

}  // namespace tev

/// A viewer that shows one image. Each call waits for the viewer a few seconds at most.
class TevViewer {
 public:
  /// `address` is HOST:PORT; `name` is what the viewer calls the image. UNAVAILABLE.
  static absl::StatusOr<TevViewer> connect(const std::string& address, const std::string& name);

  /// Shows it in place of the one before, which had the same size. UNAVAILABLE: the viewer has
  /// gone.
  absl::Status show(const Image& image);

 private:
  TevViewer(link::Socket socket, std::string name)
      : socket_(std::move(socket)), name_(std::move(name)) {}
  link::Socket socket_;
  std::string name_;
  bool created_ = false;
};

}  // namespace bandsaw::coordinator
