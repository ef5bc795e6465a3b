#pragma once

// Lines in panels with logarithmic axes, as SVG: text, so that it is small, sharp and can be read
// in a review. No scripts, no fonts, no other files.

#include <string>
#include <utility>
#include <vector>

namespace bandsaw::coordinator {

struct PlotLine {
  std::string name;
  std::string note;                               ///< after the name in the legend: "n^-0.52"
  std::vector<std::pair<double, double>> points;  ///< x, y; those not above 0 are left out
};

struct PlotPanel {
  std::string title;
  std::vector<PlotLine> lines;  ///< a line has the same colour in each panel by its place
};

struct Plot {
  std::string x;  ///< what is along the axes, with units
  std::string y;
  std::vector<PlotPanel> panels;  ///< two in a row
};

/// The whole file. Any text may be in names.
std::string svg_of(const Plot& plot);

}  // namespace bandsaw::coordinator
