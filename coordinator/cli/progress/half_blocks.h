#pragma once

// A picture as text: two pixels a character, in 24-bit colours. Pure.

#include <string>
#include <vector>

#include "coordinator/cli/base/console.h"
#include "renderlib/image/display.h"
#include "renderlib/image/image.h"

namespace bandsaw::coordinator {

/// Lines of at most `room` (each pixel of the picture is a mean of the image's), with its aspect
/// ratio where a character is twice as high as it is wide; never larger than the image. Each line
/// leaves the colours as they were (ECMA-48 SGR, colours by ISO 8613-6).
std::vector<std::string> half_blocks(const Image& image, const Display& display, TerminalSize room);

}  // namespace bandsaw::coordinator
