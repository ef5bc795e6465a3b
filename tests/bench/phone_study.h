#pragma once

// Benchmark with the 23 images of another author's study of ray tracing on phones
// (renderlib/gallery/study), timed ten times each, as in the study. Few results of the study are
// known: images of 1 to 24 objects took 290 to 3,289 ms, and phones took 35 to 150 times as long as
// a laptop.

#include <optional>
#include <string>
#include <vector>

#include "absl/types/span.h"
#include "coordinator/cli/study/log_plot.h"

namespace bandsaw::coordinator {

/// One image in one of the study's tables.
struct PhoneRow {
  const char* image;    ///< stem of its file, "objects_24"
  const char* label;    ///< "24"
  double x = 0;         ///< x in a plot; 0: not plotted
  double study_ms = 0;  ///< time measured in the study; 0: unknown
};
struct PhoneTable {
  const char* title;
  const char* what;  ///< quantity that varies between the rows, such as "objects"
  absl::Span<const PhoneRow> rows;
};
/// Returns the tables of the study with the rows of all 23 images.
absl::Span<const PhoneTable> phone_tables();

/// Milliseconds of wall-clock time, one value per run.
struct PhoneTimes {
  /// From the package in memory to the scene ready to render; empty for a farm.
  std::vector<double> build;
  std::vector<double> render;  ///< one sample per pixel
};

/// The measurements of one image.
struct PhoneImage {
  std::string name;  ///< as PhoneRow::image
  double rays = 0;   ///< rays of one render
  PhoneTimes one;    ///< on one thread
  PhoneTimes all;    ///< on all threads
  PhoneTimes farm;   ///< empty: no farm
};

/// All measurements of one run of phone_bench.
struct PhoneStudy {
  std::string machine;  ///< name of the processor
  int threads = 1;      ///< number of threads of PhoneImage::all
  std::string farm;     ///< "3 workers, 24 threads"; empty: no farm
  double peak_mb = 0;   ///< peak memory use of the program
  std::vector<PhoneImage> images;
};

/// Returns the median of at least one value.
double median(std::vector<double> values);

/// Formats the medians as Markdown tables, followed by the answers to the study's questions. Rows
/// whose images were not rendered are omitted. Ends with a line end.
std::string phone_tables_text(const PhoneStudy& study);
/// Formats one line per run (RFC 4180), with a header.
std::string phone_csv(const PhoneStudy& study);
/// Plots the medians of the tables whose rows are numbers, one panel per table.
Plot phone_plot(const PhoneStudy& study);

}  // namespace bandsaw::coordinator
