#pragma once

// Plots lines in panels with logarithmic axes, as SVG, which is small, scalable and can be read in
// a review. No scripts, no fonts, no other files.

#include <string>
#include <utility>
#include <vector>

namespace bandsaw::coordinator {

struct PlotLine {
  std::string name;
  std::string note;  ///< shown after the name in the legend: "n^-0.52"
  /// (x, y); points with a coordinate <= 0 are omitted.
  std::vector<std::pair<double, double>> points;
};

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

/// Returns the whole file. Names may contain any text; it is escaped.
std::string svg_of(const Plot& plot);

}  // namespace bandsaw::coordinator
