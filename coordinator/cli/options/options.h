#pragma once

// What each command was asked to do: plain values, checked.

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "coordinator/cli/options/scene_choices.h"
#include "coordinator/scheduler/api/job_spec.h"
#include "proto/link/join.h"
#include "renderlib/image/display.h"
#include "renderlib/render/band.h"

namespace bandsaw {
struct Kernel;  // renderlib/render/kernel.h
}  // namespace bandsaw

namespace bandsaw::coordinator {

/// How much a command says.
struct Verbosity {
  bool quiet = false;    ///< only the last line and errors
  bool json = false;     ///< one JSON object a line instead of text
  bool preview = false;  ///< the image as it forms, on a terminal with colours
};

/// Everything beside the scene that decides an image, as far as it was given.
struct ImageOptions {
  StopRule stop = StopAtSamples{64};
  std::uint64_t seed = 0;
  std::optional<std::uint32_t> width;   ///< alone: the height keeps the scene's aspect ratio
  std::optional<std::uint32_t> height;  ///< alone: the width does
  std::optional<std::uint32_t> depth;
  std::optional<Integrator> integrator;
  SceneChoices choices;
};

/// How pictures are written, as far as it was given.
struct DisplayOptions {
  std::optional<double> exposure;  ///< stops
  std::optional<Tone> tone;
  bool half = false;  ///< EXR with 16 bits a channel

  /// With what was not given from `standard`.
  Display over(const Display& standard) const {
    return {exposure.value_or(standard.exposure), tone.value_or(standard.tone), half};
  }
};

/// Where the report goes, as given: a file, "none", or nothing (then beside each image).
struct ReportOption {
  std::string file;
};

/// Where the farm is, as given: a join string, a file, "-", or nothing (then environment and
/// default folder are asked).
struct FarmOption {
  std::string farm;
};

struct ServeOptions {
  std::string data;  ///< empty: the default data folder
  std::string listen = "0.0.0.0:7878";
  std::string web;  ///< HOST:PORT of the dashboard; "none"; empty: loopback, on a port that is free
  bool insecure = false;
  bool reflection = false;
  double keep_days = 30;             ///< jobs that are over
  double keep_gb = 100;              ///< results and scenes in all
  std::uint64_t keep_jobs = 10'000;  ///< that are over
  double audit_share = 0.01;         ///< of all bands, [0, 1]
};

/// What an EXR file holds beside the image.
enum class LayerKind { kAlbedo, kNormal, kDepth, kSamples };

struct SubmitOptions {
  std::string scene;
  std::vector<std::string> outputs;  ///< empty: the scene's name as PNG
  ImageOptions image;
  FarmOption farm;
  DisplayOptions display;
  ReportOption report;
  std::string tev;  ///< HOST:PORT of a viewer; empty: none
  Verbosity verbosity;
  bool detach = false;            ///< do not watch
  std::int32_t priority = 0;      ///< [-kMaxPriority, kMaxPriority]
  std::vector<LayerKind> layers;  ///< of EXR files
};

struct WatchOptions {
  JobId job = 0;
  std::vector<std::string> outputs;  ///< empty: the image is not fetched
  FarmOption farm;
  DisplayOptions display;
  ReportOption report;
  std::string tev;  ///< HOST:PORT of a viewer; empty: none
  Verbosity verbosity;
};

struct JobsOptions {
  FarmOption farm;
  Verbosity verbosity;
};

struct WorkersOptions {
  FarmOption farm;
  Verbosity verbosity;
};

struct CancelOptions {
  JobId job = 0;
  FarmOption farm;
  Verbosity verbosity;
};

struct PauseOptions {
  JobId job = 0;
  FarmOption farm;
  Verbosity verbosity;
};

struct ResumeOptions {
  JobId job = 0;
  FarmOption farm;
  Verbosity verbosity;
};

struct PriorityOptions {
  JobId job = 0;
  std::int32_t priority = 0;  ///< [-kMaxPriority, kMaxPriority]
  FarmOption farm;
  Verbosity verbosity;
};

struct LogsOptions {
  std::string worker;
  FarmOption farm;
  Verbosity verbosity;
};

struct QuarantineOptions {
  std::string worker;
  bool lift = false;
  FarmOption farm;
  Verbosity verbosity;
};

struct DoctorOptions {
  std::string data;                     ///< empty: the default data folder
  std::string listen = "0.0.0.0:7878";  ///< where a coordinator would listen here
  FarmOption farm;                      ///< people's or workers' join string
  Verbosity verbosity;
};

struct RotateOptions {
  link::Role role = link::Role::kWorker;
  std::string data;  ///< empty: the default data folder
  Verbosity verbosity;
};

struct InviteOptions {
  std::vector<std::string> hosts;  ///< as ssh takes them; at least one
  std::string join;                ///< workers' join string or its file; empty: of the data folder
  std::string data;                ///< empty: the default data folder
  double seconds = 300;            ///< most for one host
  Verbosity verbosity;
};

struct DismissOptions {
  std::vector<std::string> hosts;  ///< as ssh takes them; at least one
  double drain_s = 60;             ///< most for a worker to finish what it holds
  Verbosity verbosity;
};

struct WhyOptions {
  JobId job = 0;
  FarmOption farm;
  Verbosity verbosity;
};

struct RenderOptions {
  std::string scene;
  std::vector<std::string>
      outputs;  ///< empty: the scene's name as PNG, or as .band when rows are given
  ImageOptions image;
  DisplayOptions display;
  ReportOption report;
  std::string tev;  ///< HOST:PORT of a viewer; empty: none
  Verbosity verbosity;
  int threads = 0;                 ///< 0: one for each CPU
  const Kernel* kernel = nullptr;  ///< null: the fastest that this machine runs
  std::optional<RowRange> rows;    ///< a part of the image
  std::vector<LayerKind> layers;   ///< of EXR files
};

struct InfoOptions {
  std::string scene;
  Verbosity verbosity;
};

struct StitchOptions {
  std::vector<std::string> parts;
  std::vector<std::string> outputs;
  DisplayOptions display;
  ReportOption report;
  Verbosity verbosity;
};

struct CompareOptions {
  std::string image;
  std::string reference;
  std::vector<std::string> outputs;  ///< of the picture of the differences
  Verbosity verbosity;
};

struct StudyOptions {
  std::vector<std::string> scenes;
  std::vector<std::string> outputs = {"study.csv", "study.svg"};
  std::uint64_t samples = 64;      ///< the most a pixel, [4, 65536]
  std::uint64_t seeds = 4;         ///< images of each kind
  std::uint64_t reference = 1024;  ///< samples a pixel of what is compared with
  std::uint64_t seed = 0;          ///< the first
  std::uint32_t width = 96;        ///< pixels; the height keeps the scene's aspect ratio
  int threads = 0;                 ///< 0: one for each CPU
  bool every_object = false;       ///< also without trees
  Verbosity verbosity;
};

/// study --phone.
struct PhoneStudyOptions {
  std::vector<std::string> images;  ///< how their names begin; empty: all
  std::vector<std::string> outputs = {"phone.csv", "phone.svg"};
  int runs = 10;                       ///< of each image on each machine
  std::optional<std::uint32_t> width;  ///< pixels; nothing: the study's own
  int threads = 0;                     ///< of "all"; 0: one for each CPU
  FarmOption farm;                     ///< need not be there where none is named
  Verbosity verbosity;
};

/// --help and --version: print and leave.
struct ShowText {
  std::string text;
};

using Command =
    std::variant<ServeOptions, SubmitOptions, WatchOptions, JobsOptions, WorkersOptions,
                 CancelOptions, PauseOptions, ResumeOptions, PriorityOptions, WhyOptions,
                 LogsOptions, QuarantineOptions, DoctorOptions, RotateOptions, InviteOptions,
                 DismissOptions, RenderOptions, InfoOptions, StitchOptions, CompareOptions,
                 StudyOptions, PhoneStudyOptions, ShowText>;

}  // namespace bandsaw::coordinator
