// The packets of the network protocol of the image viewer tev, which show an image while it is
// rendered. Numbers are little-endian.

#include "coordinator/cli/progress/tev.h"

#include <gmock/gmock.h>

namespace bandsaw::coordinator {
namespace {

// Returns the literal as a string, with the zero bytes that it contains.
template <std::size_t n>
std::string bytes(const char (&text)[n]) {
  return std::string(text, n - 1);
}

TEST(Tev, AnImageIsCreatedWithItsNameSizeAndChannels) {
  EXPECT_EQ(tev::create_image("box", 258, 2),
            bytes("\x1c\0\0\0"  // number of bytes of the packet, 28
                  "\x04"        // create
                  "\x01"        // grab the focus
                  "box\0"
                  "\x02\x01\0\0"  // width
                  "\x02\0\0\0"    // height
                  "\x03\0\0\0"    // number of channels
                  "R\0G\0B\0"));
}

TEST(Tev, RowsAreSentAsTheyLieInMemory) {
  const Image image{.width = 1, .height = 3, .pixels = {{9, 9, 9}, {1, 0, 0.5F}, {0, -2, 0}}};
  EXPECT_EQ(tev::update_rows("b", image, /*first=*/1, /*last=*/3),
            bytes("\x6a\0\0\0"  // number of bytes of the packet, 106
                  "\x06"        // update, third version
                  "\0"          // leave the focus
                  "b\0"
                  "\x03\0\0\0"  // number of channels
                  "R\0G\0B\0"
                  "\0\0\0\0"          // x
                  "\x01\0\0\0"        // y
                  "\x01\0\0\0"        // width
                  "\x02\0\0\0"        // height
                  "\0\0\0\0\0\0\0\0"  // offsets of the channels in the data, in floats
                  "\x01\0\0\0\0\0\0\0"
                  "\x02\0\0\0\0\0\0\0"
                  "\x03\0\0\0\0\0\0\0"  // strides of the channels, in floats
                  "\x03\0\0\0\0\0\0\0"
                  "\x03\0\0\0\0\0\0\0"
                  "\0\0\x80\x3f\0\0\0\0\0\0\0\x3f"  // IEEE 754: 1, 0, 0.5
                  "\0\0\0\0\0\0\0\xc0\0\0\0\0"));   // 0, -2, 0
}

}  // namespace
}  // namespace bandsaw::coordinator
