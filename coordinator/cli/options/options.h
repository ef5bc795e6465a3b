#pragma once

// The checked options of each command, as plain values.

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "coordinator/cli/options/scene_choices.h"
#include "coordinator/scheduler/api/job_spec.h"
#include "coordinator/scheduler/api/options.h"
#include "proto/link/join.h"
#include "renderlib/image/display.h"
#include "renderlib/render/band.h"

namespace bandsaw {
struct Kernel;  // renderlib/render/kernel.h
}  // namespace bandsaw

namespace bandsaw::coordinator {

/// The amount and the form of output.
struct Verbosity {
  bool quiet = false;    ///< only the last line and errors
  bool json = false;     ///< one JSON object per line instead of text
  bool preview = false;  ///< the image as it forms, on a terminal with colours
};

/// All settings besides the scene that determine an image; unset: not given.
struct ImageOptions {
  StopRule stop = StopAtSamples{64};
  std::uint64_t seed = 0;
  std::optional<std::uint32_t> width;   ///< alone: the height keeps the scene's aspect ratio
  std::optional<std::uint32_t> height;  ///< alone: the width keeps the scene's aspect ratio
  std::optional<std::uint32_t> depth;
  std::optional<Integrator> integrator;
  SceneChoices choices;
  bool fixed_seed = false;  ///< every frame has `seed`; otherwise frame N has seed + N
};

/// Files that are made, and the command that runs, when a job is over. Empty: not given.
struct AfterOptions {
  std::string video;          ///< file for a video of the frames
  double video_fps = 24;      ///< frames per second of the video
  std::string contact_sheet;  ///< file for a picture with all frames, small
  std::string command;        ///< for sh
};

/// Settings for writing pictures; unset: not given.
struct DisplayOptions {
  std::optional<double> exposure;  ///< stops
  std::optional<Tone> tone;
  bool half = false;  ///< EXR with 16 bits per channel

  /// Takes unset values from `standard`.
  Display over(const Display& standard) const {
    return {exposure.value_or(standard.exposure), tone.value_or(standard.tone), half};
  }
};

/// The report, as given: a file, "none", or empty (beside each image).
struct ReportOption {
  std::string file;
};

/// The farm, as given: a join string, a file, "-", or empty (then the environment and the default
/// folder are used).
struct FarmOption {
  std::string farm;
};

struct ServeOptions {
  std::string data;  ///< empty: the default data folder
  std::string listen = "0.0.0.0:7878";
  std::string web;  ///< HOST:PORT of the dashboard; "none"; empty: loopback, on a free port
  bool insecure = false;
  bool reflection = false;
  double keep_days = 30;             ///< maximum age of jobs that are over
  double keep_gb = 100;              ///< maximum size of results and scenes
  std::uint64_t keep_jobs = 10'000;  ///< maximum number of jobs that are over
  double audit_share = 0.01;         ///< share of the bands of native workers, [0, 1]
  double browser_audit_share = 0.1;  ///< share of the bands of browsers, [0, 1]
  Browsers browsers = Browsers::kAlso;
};

/// Additional layers of an EXR file.
enum class LayerKind { kAlbedo, kNormal, kDepth, kSamples };
/// Their names, in the order of LayerKind.
inline constexpr const char* kLayerNames[] = {"albedo", "normal", "depth", "samples"};

/// Method of the clean image, which is written beside the image as rendered; kNone: not made.
enum class Denoiser {
  kNone,
  kRegression,  ///< renderlib/denoise
  kOidn,        ///< the library OpenImageDenoise, if it is installed
};

struct SubmitOptions {
  std::string scene;
  std::vector<std::string> outputs;  ///< empty: the scene's name as PNG
  ImageOptions image;
  FarmOption farm;
  DisplayOptions display;
  ReportOption report;
  std::string tev;  ///< HOST:PORT of a viewer; empty: none
  Verbosity verbosity;
  bool detach = false;              ///< do not watch the job
  std::int32_t priority = 0;        ///< [-kMaxPriority, kMaxPriority]
  std::vector<LayerKind> layers;    ///< layers of EXR files
  std::vector<FrameNumber> frames;  ///< ascending; empty: a single image
  JobId continued = 0;  ///< sequence whose missing scenes are sent; 0: a new job is started
  AfterOptions after;
  Denoiser denoise = Denoiser::kNone;
};

struct WatchOptions {
  JobId job = 0;
  std::vector<std::string> outputs;  ///< empty: the image is not fetched
  FarmOption farm;
  DisplayOptions display;
  ReportOption report;
  std::string tev;  ///< HOST:PORT of a viewer; empty: none
  Verbosity verbosity;
  Denoiser denoise = Denoiser::kNone;
  AfterOptions after;
};

struct MissingOptions {
  JobId job = 0;
  FarmOption farm;
  Verbosity verbosity;
};

struct RetryOptions {
  JobId job = 0;
  std::vector<FrameNumber> frames;  ///< ascending; empty: all that failed
  FarmOption farm;
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
  std::string listen = "0.0.0.0:7878";  ///< address to test for a coordinator on this machine
  FarmOption farm;                      ///< users' or workers' join string
  Verbosity verbosity;
};

struct RotateOptions {
  link::Role role = link::Role::kWorker;
  std::string data;  ///< empty: the default data folder
  Verbosity verbosity;
};

struct LinkOptions {
  std::optional<double> seconds;  ///< the link ends after this time; std::nullopt: as it is
  bool revoke = false;
  FarmOption farm;
  Verbosity verbosity;
};

struct InviteOptions {
  std::vector<std::string> hosts;  ///< as ssh takes them; at least one
  std::string join;      ///< workers' join string or its file; empty: from the data folder
  std::string data;      ///< empty: the default data folder
  double seconds = 300;  ///< maximum time for one host
  Verbosity verbosity;
};

struct DismissOptions {
  std::vector<std::string> hosts;  ///< as ssh takes them; at least one
  double drain_s = 60;             ///< maximum time for a worker to finish its bands
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
  const Kernel* kernel = nullptr;  ///< nullptr: the fastest that this machine can run
  std::optional<RowRange> rows;    ///< only these rows
  std::vector<LayerKind> layers;   ///< layers of EXR files
  Denoiser denoise = Denoiser::kNone;
};

struct InfoOptions {
  std::string scene;
  SceneChoices choices;
  Verbosity verbosity;
};

struct ImportOptions {
  std::string scene;
  std::string output;  ///< empty: the scene's name as .textproto
  bool force = false;  ///< files that exist are replaced
  SceneChoices choices;
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
  std::vector<std::string> outputs;  ///< files for the picture of the differences
  Verbosity verbosity;
};

struct StudyOptions {
  std::vector<std::string> scenes;
  std::vector<std::string> outputs = {"study.csv", "study.svg"};
  std::uint64_t samples = 64;      ///< maximum samples per pixel, [4, 65536]
  std::uint64_t seeds = 4;         ///< number of seeds to average over
  std::uint64_t reference = 1024;  ///< samples per pixel of the reference
  std::uint64_t seed = 0;          ///< first seed
  std::uint32_t width = 96;        ///< pixels; the height keeps the scene's aspect ratio
  int threads = 0;                 ///< 0: one for each CPU
  bool every_object = false;       ///< also measure without BVHs
  bool denoise = false;            ///< also measure clean images
  Verbosity verbosity;
};

/// --help and --version: print a text and exit.
struct ShowText {
  std::string text;
};

using Command =
    std::variant<ServeOptions, SubmitOptions, WatchOptions, JobsOptions, WorkersOptions,
                 CancelOptions, PauseOptions, ResumeOptions, PriorityOptions, WhyOptions,
                 MissingOptions, RetryOptions, LogsOptions, QuarantineOptions, DoctorOptions,
                 RotateOptions, LinkOptions, InviteOptions, DismissOptions, RenderOptions,
                 InfoOptions, ImportOptions, StitchOptions, CompareOptions, StudyOptions, ShowText>;

}  // namespace bandsaw::coordinator
