// A Panel draws axes, grid, lines and legend of one diagram as SVG elements. svg_of() arranges the
// panels in rows of two.

#include "coordinator/cli/study/log_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_replace.h"

namespace bandsaw::coordinator {
namespace {

// Sizes of a panel and its margins in pixels.
constexpr double kWidth = 460;
constexpr double kHeight = 380;
constexpr double kLeft = 62;
constexpr double kRight = 14;
constexpr double kTop = 34;
constexpr double kBottom = 46;
constexpr double kLegendLine = 15;

// Distinguishable with colour vision deficiencies: Okabe and Ito 2008, "Color Universal Design".
constexpr std::array<const char*, 7> kColours = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                 "#e69f00", "#56b4e9", "#000000"};

std::string escaped(const std::string& text) {
  return absl::StrReplaceAll(text, {{"&", "&amp;"}, {"<", "&lt;"}, {">", "&gt;"}});
}

/// A logarithmic axis from 10^first to 10^last.
struct Axis {
  int first = 0;
  int last = 1;

  /// Returns the position of `value` along the axis, in [0, 1].
  double place(double value) const { return (std::log10(value) - first) / (last - first); }
};

/// Returns the shortest axis of whole decades that covers the coordinates of all points in all
/// panels. `of` returns the coordinate of a point.
template <class Of>
Axis axis_over(const Plot& plot, Of of) {
  double least = 1e300;
  double most = 0;
  for (const PlotPanel& panel : plot.panels) {
    for (const PlotLine& line : panel.lines) {
      for (const auto& point : line.points) {
        if (of(point) > 0 && std::isfinite(of(point))) {
          least = std::min(least, of(point));
          most = std::max(most, of(point));
        }
      }
    }
  }
  if (most <= 0) {
    return {};
  }
  const int first = static_cast<int>(std::floor(std::log10(least)));
  return {first, std::max(first + 1, static_cast<int>(std::ceil(std::log10(most))))};
}

/// Draws one diagram at its place in the file. `number`: its index in the plot.
class Panel {
 public:
  Panel(const Plot& plot, const Axis& x, const Axis& y, std::size_t number)
      : plot_(plot),
        panel_(plot.panels[number]),
        x_(x),
        y_(y),
        left_(static_cast<double>(number % 2) * kWidth + kLeft),
        top_(static_cast<double>(number / 2) * kHeight + kTop) {}

  std::string svg() const {
    std::string out = text(left_, top_ - 12, panel_.title, "start", "font-weight=\"bold\"");
    absl::StrAppend(&out, grid(), lines());
    absl::StrAppend(&out, text(left_ + kInner / 2, top_ + kTall + 38, plot_.x, "middle", ""));
    const double x = left_ - 46;
    const double y = top_ + kTall / 2;
    return absl::StrCat(out, text(x, y, plot_.y, "middle",
                                  absl::StrFormat("transform=\"rotate(-90 %.1f %.1f)\"", x, y)));
  }

 private:
  // Width and height of the area between the axes.
  static constexpr double kInner = kWidth - kLeft - kRight;
  static constexpr double kTall = kHeight - kTop - kBottom;

  double x_of(double value) const { return left_ + kInner * x_.place(value); }
  double y_of(double value) const { return top_ + kTall * (1 - y_.place(value)); }

  static std::string text(double x, double y, const std::string& what, const char* anchor,
                          const std::string& more) {
    return absl::StrFormat("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\" %s>%s</text>\n", x, y,
                           anchor, more, escaped(what));
  }

  static std::string stroke(double x0, double y0, double x1, double y1, const char* colour) {
    return absl::StrFormat(
        "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"%s\"/>\n", x0, y0, x1, y1,
        colour);
  }

  std::string grid() const {
    std::string out;
    for (int power = x_.first; power <= x_.last; ++power) {
      const double x = x_of(std::pow(10.0, power));
      absl::StrAppend(&out, stroke(x, top_, x, top_ + kTall, "#ddd"),
                      text(x, top_ + kTall + 16, number(power), "middle", ""));
    }
    for (int power = y_.first; power <= y_.last; ++power) {
      const double y = y_of(std::pow(10.0, power));
      absl::StrAppend(&out, stroke(left_, y, left_ + kInner, y, "#ddd"),
                      text(left_ - 6, y + 4, number(power), "end", ""));
    }
    return out;
  }

  /// Returns the text of 10^power: "0.01", or "10⁻⁵" where that is shorter.
  static std::string number(int power) {
    if (power >= -4 && power <= 4) {
      return absl::StrFormat("%g", std::pow(10.0, power));
    }
    constexpr std::array<const char*, 10> kSmall = {"⁰", "¹", "²", "³", "⁴",
                                                    "⁵", "⁶", "⁷", "⁸", "⁹"};
    std::string out = power < 0 ? "10⁻" : "10";
    for (const char digit : std::to_string(std::abs(power))) {
      out += kSmall[static_cast<std::size_t>(digit - '0')];
    }
    return out;
  }

  /// Returns true if the legend goes to the top left, false if it goes to the bottom left. Counts
  /// the points in the left 40 % of the diagram. The legend goes to the half, upper or lower, that
  /// has fewer of these points.
  bool names_on_top() const {
    int below = 0;
    for (const PlotLine& line : panel_.lines) {
      for (const auto& [x, y] : line.points) {
        if (x > 0 && y > 0 && x_.place(x) < 0.4) {
          below += y_.place(y) < 0.5 ? 1 : -1;
        }
      }
    }
    return below > 0;
  }

  /// Returns the lines with a dot at each point, and the legend.
  std::string lines() const {
    std::string out;
    const double names_top =
        names_on_top()
            ? top_ + kLegendLine
            : top_ + kTall - 8 - kLegendLine * static_cast<double>(panel_.lines.size() - 1);
    for (std::size_t i = 0; i < panel_.lines.size(); ++i) {
      const PlotLine& line = panel_.lines[i];
      const char* const colour = kColours[i % kColours.size()];
      std::string path;
      std::string dots;
      for (const auto& [x, y] : line.points) {
        if (x > 0 && y > 0 && std::isfinite(x) && std::isfinite(y)) {
          absl::StrAppendFormat(&path, "%.1f,%.1f ", x_of(x), y_of(y));
          absl::StrAppendFormat(&dots, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"2.5\" fill=\"%s\"/>\n",
                                x_of(x), y_of(y), colour);
        }
      }
      absl::StrAppendFormat(
          &out, "<polyline points=\"%s\" fill=\"none\" stroke=\"%s\" stroke-width=\"1.6\"/>\n%s",
          path, colour, dots);
      const double y = names_top + kLegendLine * static_cast<double>(i);
      absl::StrAppend(
          &out, text(left_ + 8, y,
                     line.note.empty() ? line.name : absl::StrCat(line.name, " · ", line.note),
                     "start", absl::StrCat("fill=\"", colour, "\"")));
    }
    return out;
  }

  const Plot& plot_;
  const PlotPanel& panel_;
  const Axis& x_;
  const Axis& y_;
  double left_;
  double top_;
};

}  // namespace

std::string svg_of(const Plot& plot) {
  const Axis x = axis_over(plot, [](const auto& point) { return point.first; });
  const Axis y = axis_over(plot, [](const auto& point) { return point.second; });
  const std::size_t panels = plot.panels.size();
  const double width = kWidth * static_cast<double>(std::clamp<std::size_t>(panels, 1, 2));
  const double height = kHeight * static_cast<double>(std::max<std::size_t>(1, (panels + 1) / 2));
  std::string out = absl::StrFormat(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %g %g\" width=\"%g\" height=\"%g\" "
      "font-family=\"sans-serif\" font-size=\"12\">\n"
      "<rect width=\"100%%\" height=\"100%%\" fill=\"#fff\"/>\n",
      width, height, width, height);
  for (std::size_t i = 0; i < panels; ++i) {
    absl::StrAppend(&out, Panel(plot, x, y, i).svg());
  }
  return out + "</svg>\n";
}

}  // namespace bandsaw::coordinator
