#pragma once

// The checked options of each command, as plain values. The functions in
// cli/options/checked_options.h make them from the command line; each run() of
// cli/options/commands.h takes one type. The project's terms are in proto/README.md, Glossary.

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

/// All settings besides the scene that determine an image. An unset value is taken from the scene.
struct ImageOptions {
  StopRule stop = StopAtSamples{64};
  std::uint64_t seed = 0;
  /// In pixels. If only one of the two is set, the other keeps the scene's aspect ratio.
  std::optional<std::uint32_t> width;
  std::optional<std::uint32_t> height;
  std::optional<std::uint32_t> depth;  ///< maximum number of scatterings of a path
  std::optional<Integrator> integrator;
  SceneChoices choices;
  bool fixed_seed = false;  ///< every frame has `seed`; otherwise frame N has seed + N
};

/// Files that are made, and the command that runs, when a job is over. An empty text: the option is
/// not given.
struct AfterOptions {
  std::string video;          ///< file for a video of the frames
  double video_fps = 24;      ///< frames per second of the video
  std::string contact_sheet;  ///< file for one picture that shows all frames, each reduced
  std::string command;        ///< text that is run by sh (--then)
};

/// Settings for writing pictures; an unset value is taken from the scene.
struct DisplayOptions {
  std::optional<double> exposure;  ///< in stops: the light is multiplied by 2^exposure
  std::optional<Tone> tone;
  bool half = false;  ///< EXR with 16 bits per channel

  /// Returns these settings, with `standard` where a value is unset.
  Display over(const Display& standard) const {
    return {exposure.value_or(standard.exposure), tone.value_or(standard.tone), half};
  }
};

/// Where the report goes, as the user gave it: the name of a file, or "none" for no report. If the
/// name is empty, a report is written beside each image. The report is a JSON file that states an
/// image's error, cost and settings.
struct ReportOption {
  std::string file;
};

/// The farm, as the user gave it: a join string (one line with the addresses of the farm and a
/// secret), a file that has one, or "-" for standard input. Empty: the variable BANDSAW_FARM or the
/// default data folder names the farm.
struct FarmOption {
  std::string farm;
};

struct ServeOptions {
  std::string data;                     ///< empty: the default data folder
  std::string listen = "0.0.0.0:7878";  ///< HOST:PORT for workers and users
  /// HOST:PORT of the dashboard, or "none"; empty: 127.0.0.1:8787, or a free port if that is taken.
  std::string web;
  bool insecure = false;             ///< connections are not encrypted
  bool reflection = false;           ///< any client may list the calls (gRPC server reflection)
  double keep_days = 30;             ///< a job is removed this many days after it is over
  double keep_gb = 100;              ///< maximum size of results and scenes
  std::uint64_t keep_jobs = 10'000;  ///< maximum number of jobs that are over
  /// Share of the bands of native workers that a second machine renders for comparison, [0, 1]. A
  /// band (some rows of an image) is what a worker gets at once.
  double audit_share = 0.01;
  /// Share of the bands of browsers that a native worker renders again, [0, 1].
  double browser_audit_share = 0.1;
  Browsers browsers = Browsers::kAlso;
};

/// Additional layers of an EXR file. kSamples: the number of samples of each pixel.
enum class LayerKind { kAlbedo, kNormal, kDepth, kSamples };
/// The names of the layers, in the order of LayerKind.
inline constexpr const char* kLayerNames[] = {"albedo", "normal", "depth", "samples"};

/// Method by which the noise is removed. The image as rendered is written beside the clean image.
/// kNone: no clean image is made.
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
  /// A sequence (job of many frames) whose submission is continued: the scenes that the farm still
  /// lacks are sent. 0: a new job is started.
  JobId continued = 0;
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

/// `bandsaw missing`: lists the frames of a job that are not done.
struct MissingOptions {
  JobId job = 0;
  FarmOption farm;
  Verbosity verbosity;
};

/// `bandsaw retry`: renders failed frames of a job again.
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
  std::string worker;  ///< name of the worker whose machine gets no more work
  bool lift = false;   ///< end the quarantine instead
  FarmOption farm;
  Verbosity verbosity;
};

struct DoctorOptions {
  std::string data;                     ///< empty: the default data folder
  std::string listen = "0.0.0.0:7878";  ///< address to test for a coordinator on this machine
  FarmOption farm;                      ///< here also a join string of workers is allowed
  Verbosity verbosity;
};

/// `bandsaw secret rotate`: makes a new secret, which invalidates the old one.
struct RotateOptions {
  link::Role role = link::Role::kWorker;  ///< whose secret
  std::string data;                       ///< empty: the default data folder
  Verbosity verbosity;
};

/// The link by which browsers join as workers.
struct LinkOptions {
  /// Time from now to the end of the link. std::nullopt: the end of a present link is not changed,
  /// and a new link ends after 8 hours.
  std::optional<double> seconds;
  bool revoke = false;  ///< end the link now and disconnect its browsers
  FarmOption farm;
  Verbosity verbosity;
};

/// Installs and starts workers on other machines by ssh.
struct InviteOptions {
  std::vector<std::string> hosts;  ///< as ssh takes them; at least one
  std::string join;      ///< workers' join string or its file; empty: from the data folder
  std::string data;      ///< empty: the default data folder
  double seconds = 300;  ///< maximum time for one host
  Verbosity verbosity;
};

/// Stops and removes workers that `invite` has started.
struct DismissOptions {
  std::vector<std::string> hosts;  ///< as ssh takes them; at least one
  double drain_s = 60;             ///< maximum time for a worker to finish its bands
  Verbosity verbosity;
};

/// `bandsaw why`: explains why a job is not done.
struct WhyOptions {
  JobId job = 0;
  FarmOption farm;
  Verbosity verbosity;
};

struct RenderOptions {
  std::string scene;
  /// Empty: the scene's name as PNG, or as .band when rows are given.
  std::vector<std::string> outputs;
  ImageOptions image;
  DisplayOptions display;
  ReportOption report;
  std::string tev;  ///< HOST:PORT of a viewer; empty: none
  Verbosity verbosity;
  int threads = 0;                 ///< 0: one for each CPU
  const Kernel* kernel = nullptr;  ///< nullptr: the fastest that this machine can run
  std::optional<RowRange> rows;    ///< only these rows are rendered; std::nullopt: all
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

/// Joins parts of an image that were rendered by `render --rows`.
struct StitchOptions {
  std::vector<std::string> parts;  ///< .band files
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

/// Options of `bandsaw study`. This command measures the error of images against their cost, with
/// and without each technique of the renderer that can be disabled. The error of an image is
/// measured against a reference image, which is rendered with `reference` samples per pixel.
struct StudyOptions {
  std::vector<std::string> scenes;
  std::vector<std::string> outputs = {"study.csv", "study.svg"};
  std::uint64_t samples = 64;      ///< maximum samples per pixel, [4, 65536]
  std::uint64_t seeds = 4;         ///< number of seeds to average over
  std::uint64_t reference = 1024;  ///< samples per pixel of the reference image
  std::uint64_t seed = 0;          ///< first seed
  std::uint32_t width = 96;        ///< pixels; the height keeps the scene's aspect ratio
  int threads = 0;                 ///< 0: one for each CPU
  bool every_object = false;       ///< also measure without a BVH: rays test every object
  /// Measure denoised images and the same images as rendered, instead of images with and without
  /// each technique.
  bool denoise = false;
  Verbosity verbosity;
};

/// --help, --version and the command `completion` print a text and exit.
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
