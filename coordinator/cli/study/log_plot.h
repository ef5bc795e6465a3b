#pragma once

// Plots lines in panels with logarithmic axes, for `bandsaw study`. The result is an SVG file,
// which is small, scalable and readable as text. It needs no scripts, fonts or other files.

#include <string>
#include <utility>
#include <vector>

namespace bandsaw::coordinator {

struct PlotLine {
  std::string name;
  std::string note;  ///< shown after the name in the legend, such as "n^-0.52"; may be empty
  /// (x, y); points with a coordinate <= 0 are omitted.
  std::vector<std::pair<double, double>> points;
};

/// One diagram. All panels of a plot have the same axes.
struct PlotPanel {
  std::string title;
  /// The n-th line has the same colour in each panel.
  std::vector<PlotLine> lines;
};

struct Plot {
  std::string x;  ///< axis labels, with units
  std::string y;
  std::vector<PlotPanel> panels;  ///< arranged in rows of two
};

/// Returns the text of the SVG file. Names may contain any text; it is escaped.
std::string svg_of(const Plot& plot);

}  // namespace bandsaw::coordinator
