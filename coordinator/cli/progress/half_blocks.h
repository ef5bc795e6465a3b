#pragma once

// Draws a picture as text for --preview: two pixels per character, in 24-bit colours.

#include <string>
#include <vector>

#include "coordinator/cli/base/console.h"
#include "renderlib/image/display.h"
#include "renderlib/image/image.h"

namespace bandsaw::coordinator {

/// Returns the lines of the picture, which fit into `available`; none if the image has no pixels.
/// Each pixel drawn is a mean of image pixels. The aspect ratio is kept for characters that are
/// twice as high as wide. The picture never has more pixels than the image. Each line resets the
/// colours at its end (ECMA-48 SGR, colours by ISO 8613-6). The function is pure.
std::vector<std::string> half_blocks(const Image& image, const Display& display,
                                     TerminalSize available);

}  // namespace bandsaw::coordinator
