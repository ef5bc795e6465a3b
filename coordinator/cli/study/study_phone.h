#pragma once

// The 23 images of a study of ray tracing on phones (gallery/study), timed as it timed them, ten
// times each. Of the study's own figures few are known: its times by number of objects went from
// 290 to 3,289 ms, and phones took 35 to 150 times as long as a laptop.

#include <optional>
#include <string>
#include <vector>

#include "absl/types/span.h"
#include "coordinator/cli/study/log_plot.h"

namespace bandsaw::coordinator {

/// One image in one of the study's tables.
struct PhoneRow {
  const char* image;    ///< "objects_24": its file's stem
  const char* label;    ///< "24"
  double x = 0;         ///< where a plot has it; 0: nowhere
  double study_ms = 0;  ///< what the study measured; 0: not known
};
struct PhoneTable {
  const char* title;
  const char* what;  ///< what its rows are by, as in "objects"
  absl::Span<const PhoneRow> rows;
};
absl::Span<const PhoneTable> phone_tables();

/// Milliseconds of wall clock, as many as there were runs.
struct PhoneTimes {
  std::vector<double> build;   ///< from the package in memory to what is rendered; a farm: empty
  std::vector<double> render;  ///< of the image, one sample a pixel
};

struct PhoneImage {
  std::string name;  ///< as PhoneRow::image
  double rays = 0;   ///< of one render
  PhoneTimes one;    ///< on one thread
  PhoneTimes all;    ///< on all
  PhoneTimes farm;   ///< empty: there was none
};

struct PhoneStudy {
  std::string machine;  ///< its processor
  int threads = 1;      ///< what "all" is
  std::string farm;     ///< "3 workers, 24 threads"; empty: there was none
  double peak_mb = 0;   ///< the most memory that the program had at once
  std::vector<PhoneImage> images;
};

/// Of at least one value.
double median(std::vector<double> values);

/// Tables in Markdown, medians, then what they answer. Rows whose images were not rendered are left
/// out. With a line end.
std::string phone_tables_text(const PhoneStudy& study);
/// A line a run (RFC 4180), with a header.
std::string phone_csv(const PhoneStudy& study);
/// Medians of the tables whose rows are by a number, a panel a table.
Plot phone_plot(const PhoneStudy& study);

}  // namespace bandsaw::coordinator
