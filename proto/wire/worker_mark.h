#pragma once

#include <cstdint>

#include "proto/wire/versions.h"

namespace bandsaw::wire {

/// States the version of a worker in its program file. A coordinator reads the mark before it
/// offers the file for download. It cannot run the program instead, because the program may be for
/// another architecture. The mark is in the read-only data of each bandsaw-worker and is found by
/// `magic`. Little-endian, without padding. A mark with another layout MUST have another `magic`.
struct WorkerMark {
  char magic[16] = "\177bandsaw-worker";
  std::uint32_t protocol = kProtocol;
  /// kPixelVersion of renderlib, which changes whenever the renderer computes other pixels.
  std::uint32_t pixel_version = 0;
  char version[24] = "";  ///< visible ASCII characters; ends with a zero
};
static_assert(sizeof(WorkerMark) == 48);

}  // namespace bandsaw::wire
