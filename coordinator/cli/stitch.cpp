// bandsaw stitch: parts that were rendered by rows, put together.

#include <optional>

#include "absl/strings/str_cat.h"
#include "coordinator/cli/commands.h"
#include "coordinator/cli/json.h"
#include "coordinator/cli/output.h"
#include "coordinator/cli/part_file.h"
#include "coordinator/cli/stitch_coverage.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/render/film.h"

namespace bandsaw::coordinator {
namespace {

class Stitcher {
 public:
  absl::Status add(const std::string& part, const BandRecord& record) {
    if (!film_) {
      ASSIGN_OR_RETURN(film_, Film::create(record.settings.width, record.settings.height, ""));
      coverage_.emplace(record.settings.height);
      first_part_ = part;
      digest_ = record.package_digest;
      settings_ = record.settings;
    }
    if (record.package_digest != digest_) {
      return absl::InvalidArgumentError(
          absl::StrCat(part, " and ", first_part_,
                       " are parts of different scenes (the packages' digests differ)"));
    }
    if (!(record.settings == settings_)) {
      return absl::InvalidArgumentError(
          absl::StrCat(part, " and ", first_part_, " were rendered with different settings: ",
                       text(record.settings), " and ", text(settings_)));
    }
    RETURN_IF_ERROR(coverage_->add(part, record.pixels.band));
    return film_->add(record.pixels);
  }

  absl::StatusOr<Image> image() const {
    RETURN_IF_ERROR(coverage_->samples().status());
    return film_->snapshot().image;
  }

 private:
  static std::string text(const RenderSettings& settings) {
    return absl::StrCat(settings.width, "×", settings.height, " depth ", settings.max_depth,
                        " seed ", settings.seed, " by ", integrator_name(settings.integrator));
  }

  std::string first_part_;
  std::string digest_;
  RenderSettings settings_;
  std::optional<Film> film_;
  std::optional<StitchCoverage> coverage_;
};

struct Stitched {
  Image image;
  Display display;  ///< as the first part says
};

absl::StatusOr<Stitched> stitched(const std::vector<std::string>& parts) {
  Stitcher stitcher;
  Stitched out;
  for (const std::string& part : parts) {
    ASSIGN_OR_RETURN(const Display display, read_part(part, [&](const BandRecord& record) {
                       return stitcher.add(part, record);
                     }));
    out.display = &part == &parts.front() ? display : out.display;
  }
  ASSIGN_OR_RETURN(out.image, stitcher.image());
  return out;
}

}  // namespace

ExitCode run(const StitchOptions& options, Process& process) {
  if (const auto status = check_outputs_writable(options.outputs); !status.ok()) {
    return process.console.fail(ExitCode::kWrong, std::string(status.message()));
  }
  const auto whole = stitched(options.parts);
  if (!whole.ok()) {
    const bool memory = absl::IsResourceExhausted(whole.status());
    return process.console.fail(memory ? ExitCode::kFailed : ExitCode::kWrong,
                                std::string(whole.status().message()));
  }
  const Image& image = whole->image;
  if (const auto status =
          write_outputs(image, options.outputs, options.display.over(whole->display));
      !status.ok()) {
    return process.console.fail(ExitCode::kFailed, std::string(status.message()));
  }
  if (options.verbosity.json) {
    process.console.line(
        JsonObject().text("event", "done").texts("outputs", options.outputs).str());
  } else {
    process.console.line(absl::StrCat(names_of(options.outputs), " · ", image.width, "×",
                                      image.height, " · ", options.parts.size(),
                                      options.parts.size() == 1 ? " part" : " parts"));
  }
  return ExitCode::kDone;
}

}  // namespace bandsaw::coordinator
