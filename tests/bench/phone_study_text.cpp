// Formats the results of phone_bench as tables, answers, CSV and a plot. The phone study is another
// author's study, which rendered 23 images on a laptop and on phones. phone_bench renders the same
// images on one thread, on all threads and on a farm. Their times are shown beside the times that
// the study states.

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "tests/bench/phone_study.h"

namespace bandsaw::coordinator {
namespace {

constexpr char kNone[] = "–";
constexpr char kNotKnown[] = "not known";

const PhoneImage* image_of(const PhoneStudy& study, absl::string_view name) {
  const auto found = std::find_if(study.images.begin(), study.images.end(),
                                  [&](const PhoneImage& image) { return image.name == name; });
  return found == study.images.end() ? nullptr : &*found;
}

std::string ms(double value) {
  return value < 10 ? absl::StrFormat("%.2f", value) : absl::StrFormat("%.1f", value);
}
/// Returns the median of `times` as text; a dash if there are none.
std::string median_text(const std::vector<double>& times) {
  return times.empty() ? kNone : ms(median(times));
}

std::string threads_text(int threads) {
  return threads == 1 ? "1 thread" : absl::StrCat(threads, " threads");
}

std::string row_text(const PhoneRow& row, const PhoneImage& image) {
  return absl::StrFormat("| %s | %s | %s | %s | %s | %s |\n", row.label,
                         median_text(image.one.build), median_text(image.one.render),
                         median_text(image.all.render), median_text(image.farm.render),
                         row.study_ms > 0 ? absl::StrFormat("%.0f", row.study_ms) : kNotKnown);
}

std::string table_text(const PhoneStudy& study, const PhoneTable& table) {
  std::string rows;
  for (const PhoneRow& row : table.rows) {
    if (const PhoneImage* image = image_of(study, row.image)) {
      absl::StrAppend(&rows, row_text(row, *image));
    }
  }
  return rows.empty() ? ""
                      : absl::StrCat("### ", table.title, "\n\n| ", table.what,
                                     " | build, ms | 1 thread, ms | ", threads_text(study.threads),
                                     ", ms | farm, ms | the study's, ms |\n",
                                     "| --- | --- | --- | --- | --- | --- |\n", rows, "\n");
}

/// Sum of the median render times of all images. `where` selects the machine: &PhoneImage::one, all
/// or farm.
double sum(const PhoneStudy& study, PhoneTimes PhoneImage::*where) {
  double all = 0;
  for (const PhoneImage& image : study.images) {
    all += median((image.*where).render);
  }
  return all;
}

std::string machines_text(const PhoneStudy& study) {
  const double one = sum(study, &PhoneImage::one);
  const auto row = [&](const std::string& machine, double all) {
    return absl::StrFormat("| %s | %s | %.2f |\n", machine, ms(all), all / one);
  };
  std::string out =
      absl::StrCat("### Machine\n\n| machine | ", study.images.size(),
                   " images, ms | time relative to the first row |\n| --- | --- | --- |\n");
  absl::StrAppend(
      &out, row(absl::StrCat(study.machine, ", 1 thread"), one),
      row(absl::StrCat("the same, ", threads_text(study.threads)), sum(study, &PhoneImage::all)));
  if (study.farm.empty()) {
    absl::StrAppend(&out, "| a farm | ", kNone, " | ", kNone, " |\n");
  } else {
    absl::StrAppend(&out, row(absl::StrCat("a farm, ", study.farm), sum(study, &PhoneImage::farm)));
  }
  return absl::StrCat(out, "| the study's laptop | ", kNotKnown, " | ", kNotKnown, " |\n",
                      "| the study's phones | 35 to 150 times the laptop's | ", kNotKnown,
                      " |\n\n");
}

/// States the ratio of the time of image `b` to that of image `a` on one thread, in a sentence that
/// begins with `what` and ends with `then`; empty if one of them was not rendered.
std::string compared(const PhoneStudy& study, const std::string& what, const char* a, const char* b,
                     const std::string& then) {
  const PhoneImage* const first = image_of(study, a);
  const PhoneImage* const last = image_of(study, b);
  return first == nullptr || last == nullptr
             ? ""
             : absl::StrFormat("- %s %.2f%s\n", what,
                               median(last->one.render) / median(first->one.render), then);
}

/// States the ratio of the rays of `b` to those of `a`; empty if one of them was not rendered.
std::string rays_text(const PhoneStudy& study, const char* a, const char* b) {
  const PhoneImage* const first = image_of(study, a);
  const PhoneImage* const last = image_of(study, b);
  return first == nullptr || last == nullptr
             ? ""
             : absl::StrFormat(" times as long, with %.2f times the rays",
                               last->rays / first->rays);
}

/// Answers the questions of the study's author in numbers.
std::string answers(const PhoneStudy& study) {
  double most_build = 0;
  for (const PhoneImage& image : study.images) {
    most_build = std::max(most_build, median(image.one.build));
  }
  return absl::StrCat(
      "### The questions of the study\n\n",
      compared(study, "Many objects: on one thread, compared with one object, 24 objects take",
               "objects_1", "objects_24",
               absl::StrCat(rays_text(study, "objects_1", "objects_24"),
                            "; the study states 11.34 times (3,289 ms and 290 ms).")),
      absl::StrFormat("- Threads: all images take %.2f times as long on one thread as on %d.\n",
                      sum(study, &PhoneImage::one) / sum(study, &PhoneImage::all), study.threads),
      absl::StrFormat("- Memory in C++: the program used at most %.0f MB in all measurements.\n",
                      study.peak_mb),
      compared(study, "Smaller images: 500 x 500 pixels take", "size_125", "size_500",
               " times as long as 125 x 125 pixels, which are a sixteenth as many."),
      compared(study, "Fewer shadow rays: compared with no light, an image with one light takes",
               "lights_0", "lights_1", absl::StrCat(rays_text(study, "lights_0", "lights_1"), ".")),
      absl::StrFormat("- Precomputation: it takes at most %s ms, once for each scene.\n",
                      ms(most_build)));
}

/// Appends a line of CSV for each run of an image on `machine`: "1 thread", "farm".
void add_lines(std::string& out, const PhoneImage& image, const std::string& machine,
               const PhoneTimes& times) {
  for (std::size_t i = 0; i < times.render.size(); ++i) {
    const std::string build = times.build.empty() ? "" : absl::StrFormat("%.4f", times.build[i]);
    absl::StrAppendFormat(&out, "%s,%s,%d,%s,%.4f\n", image.name, machine, i + 1, build,
                          times.render[i]);
  }
}

}  // namespace

std::string phone_tables_text(const PhoneStudy& study) {
  std::string out = machines_text(study);
  for (const PhoneTable& table : phone_tables()) {
    absl::StrAppend(&out, table_text(study, table));
  }
  return out + answers(study);
}

std::string phone_csv(const PhoneStudy& study) {
  std::string out = "image,machine,run,build_ms,render_ms\n";
  for (const PhoneImage& image : study.images) {
    add_lines(out, image, "1 thread", image.one);
    add_lines(out, image, threads_text(study.threads), image.all);
    add_lines(out, image, "farm", image.farm);
  }
  return out;
}

Plot phone_plot(const PhoneStudy& study) {
  Plot plot{.x = "as the panel says", .y = "milliseconds an image", .panels = {}};
  for (const PhoneTable& table : phone_tables()) {
    PlotLine one{.name = "1 thread", .note = "", .points = {}};
    PlotLine all{.name = threads_text(study.threads), .note = "", .points = {}};
    PlotLine farm{.name = "farm", .note = study.farm, .points = {}};
    PlotLine theirs{.name = "the study", .note = "", .points = {}};
    for (const PhoneRow& row : table.rows) {
      if (const PhoneImage* image = image_of(study, row.image); image != nullptr && row.x > 0) {
        one.points.emplace_back(row.x, median(image->one.render));
        all.points.emplace_back(row.x, median(image->all.render));
        if (!image->farm.render.empty()) {
          farm.points.emplace_back(row.x, median(image->farm.render));
        }
        if (row.study_ms > 0) {
          theirs.points.emplace_back(row.x, row.study_ms);
        }
      }
    }
    std::vector<PlotLine> lines;
    for (PlotLine* line : {&one, &all, &farm, &theirs}) {
      if (!line->points.empty()) {
        lines.push_back(std::move(*line));
      }
    }
    if (!lines.empty()) {
      plot.panels.push_back({absl::StrCat("by ", table.what), std::move(lines)});
    }
  }
  return plot;
}

}  // namespace bandsaw::coordinator
