#pragma once

// Draws a picture as text: two pixels per character, in 24-bit colours. Pure functions.

#include <string>
#include <vector>

#include "coordinator/cli/base/console.h"
#include "renderlib/image/display.h"
#include "renderlib/image/image.h"

namespace bandsaw::coordinator {

/// Returns lines that fit into `available`. Each pixel drawn is a mean of image pixels; the aspect
/// ratio is kept, assuming characters twice as high as wide; the picture is never larger than the
/// image. Each line resets the colours (ECMA-48 SGR, colours by ISO 8613-6).
std::vector<std::string> half_blocks(const Image& image, const Display& display,
                                     TerminalSize available);

}  // namespace bandsaw::coordinator
