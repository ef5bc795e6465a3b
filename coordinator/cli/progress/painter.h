#pragma once

// Redraws a few lines at the bottom of a terminal in place. Pure: returns the bytes to write.

#include <string>
#include <vector>

#include "coordinator/cli/base/console.h"

namespace bandsaw::coordinator {

/// Moves the cursor up only over lines that it drew itself, and always leaves it at the start of
/// the line below them, so that the terminal stays usable if the program ends at any moment.
/// (ECMA-48: CUU, EL, ED.)
class Painter {
 public:
  /// Returns the bytes that replace the last frame by these lines, each cut to the terminal's
  /// width, at most rows - 1 of them. `picture`: lines drawn first; they MUST already fit and may
  /// contain colour codes.
  std::string frame(const std::vector<std::string>& lines, TerminalSize size,
                    const std::vector<std::string>& picture = {});
  /// Returns the bytes that erase the last frame.
  std::string clear();

 private:
  std::string back_to_first() const;

  std::size_t drawn_ = 0;
};

}  // namespace bandsaw::coordinator
