#pragma once

// A few lines at the bottom of a terminal that are drawn again in place. Pure: makes the bytes,
// writes nothing.

#include <string>
#include <vector>

#include "coordinator/cli/base/console.h"

namespace bandsaw::coordinator {

/// Only moves up over lines that it drew itself, and always leaves the cursor at the start of the
/// line below them, so that a program that ends at any moment leaves a usable terminal. (ECMA-48:
/// CUU, EL, ED.)
class Painter {
 public:
  /// The bytes that replace the last frame by these lines, each cut to the terminal's width, at
  /// most rows - 1 of them. `picture`: lines that come before and fit already, with what colours
  /// them.
  std::string frame(const std::vector<std::string>& lines, TerminalSize size,
                    const std::vector<std::string>& picture = {});
  /// The bytes that take the last frame away.
  std::string clear();

 private:
  std::string back_to_first() const;

  std::size_t drawn_ = 0;
};

}  // namespace bandsaw::coordinator
