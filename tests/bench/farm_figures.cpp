// Measures a farm of real processes on one machine and prints a table.
//
//   farm_figures [loss|pixels|again|left]...    default: all four, ten minutes on two cores
//
//   loss: time until the loss of a worker is detected
//   pixels: time until the first pixels of a job arrive
//   again: finished bands (parts of an image) that are rendered again after the coordinator was
//     killed
//   left: error of the remaining time that is reported during a job

#include "tests/bench/farm_figures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <set>

namespace bandsaw::bench {
namespace {

void print(const Figure& figure) {
  std::vector<double> sorted = figure.measured;
  std::sort(sorted.begin(), sorted.end());
  std::printf("| %s | %s | ", figure.name.c_str(), figure.aim.c_str());
  if (!sorted.empty()) {
    const char* const unit = figure.unit.c_str();
    std::printf("%.3g%s, %.3g–%.3g%s in %zu runs", sorted[sorted.size() / 2], unit, sorted.front(),
                sorted.back(), unit, sorted.size());
  }
  const bool both = !sorted.empty() && !figure.remark.empty();
  std::printf("%s%s |\n", both ? "; " : "", figure.remark.c_str());
  std::fflush(stdout);
}

void print(const std::vector<Figure>& figures) {
  for (const Figure& figure : figures) {
    print(figure);
  }
}

}  // namespace
}  // namespace bandsaw::bench

int main(int argc, char** argv) {
  using namespace bandsaw::bench;
  GTEST_FLAG_SET(throw_on_failure, true);  // a failed assertion in tests/farm ends this program
  testing::InitGoogleTest(&argc, argv);
  const std::set<std::string> asked(argv + 1, argv + argc);
  const auto wanted = [&](const char* name) { return asked.empty() || asked.contains(name); };
  std::printf("| figure | aim | measured: median, range |\n| --- | --- | --- |\n");
  if (wanted("loss")) {
    print(loss_figures());
  }
  if (wanted("pixels")) {
    print(first_pixel_figures());
  }
  if (wanted("again")) {
    print(rendered_again_figure());
  }
  if (wanted("left")) {
    print(time_left_figure());
  }
}
