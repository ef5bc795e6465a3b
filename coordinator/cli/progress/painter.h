#pragma once

// Redraws a few lines at the bottom of a terminal in place, for ProgressDisplay. A Painter writes
// nothing itself: its functions return the bytes to write.

#include <string>
#include <vector>

#include "coordinator/cli/base/console.h"

namespace bandsaw::coordinator {

/// A Painter moves the cursor up only over lines that it drew itself, and always leaves the cursor
/// at the start of the line below them. So the terminal stays usable if the program ends at any
/// moment. The escape sequences are CUU, EL and ED of ECMA-48.
class Painter {
 public:
  /// Returns the bytes that draw `picture` and, below it, `lines`, in place of what was drawn last.
  /// Each of `lines` is cut to the terminal's width; at most size.rows - 1 lines are drawn in all.
  /// The lines of `picture` MUST fit into the width and may have colour codes.
  std::string frame(const std::vector<std::string>& lines, TerminalSize size,
                    const std::vector<std::string>& picture = {});
  /// Returns the bytes that erase what was drawn last; empty if nothing is drawn.
  std::string clear();

 private:
  /// Returns the bytes that move the cursor to the first line that was drawn last.
  std::string back_to_first() const;

  std::size_t drawn_ = 0;  ///< number of lines that were drawn last
};

}  // namespace bandsaw::coordinator
