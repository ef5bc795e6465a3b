// Parses the options, starts the log and the thread for signals, and runs the Daemon.

#include "worker/command.h"

#include <signal.h>
#include <spdlog/sinks/ringbuffer_sink.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "proto/link/channel.h"
#include "proto/link/join.h"
#include "proto/link/random.h"
#include "proto/wire/limits.h"
#include "proto/wire/worker_mark.h"
#include "renderlib/base/clean_text.h"
#include "renderlib/base/cpu_name.h"
#include "renderlib/base/float_mode.h"
#include "renderlib/render/canary.h"
#include "renderlib/render/kernel.h"
#include "renderlib/render/pixel_version.h"
#include "worker/log_queue.h"

namespace bandsaw::worker {
namespace {

std::string host_name() {
  char name[65] = {};  // Linux allows 64 bytes
  return gethostname(name, sizeof(name) - 1) == 0 && name[0] != '\0' ? name : "worker";
}

/// Returns version, compiler, kernel and CPU, for display only.
std::string build_description(const Kernel& kernel) {
#if defined(__clang__)
  const std::string compiler = absl::StrCat("clang ", __clang_major__, ".", __clang_minor__);
#else
  const std::string compiler = absl::StrCat("g++ ", __GNUC__, ".", __GNUC_MINOR__);
#endif
  return absl::StrCat(BANDSAW_VERSION, ", ", compiler, ", ", kernel.name, " kernel, ", cpu_name());
}

/// Returns $XDG_CACHE_HOME/bandsaw/blobs or ~/.cache/bandsaw/blobs, which all workers of a user
/// share; empty if neither variable is set.
std::string default_cache_folder() {
  if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache != nullptr && cache[0] == '/') {
    return absl::StrCat(cache, "/bandsaw/blobs");
  }
  if (const char* home = std::getenv("HOME"); home != nullptr && home[0] == '/') {
    return absl::StrCat(home, "/.cache/bandsaw/blobs");
  }
  return "";
}

/// Returns FAILED_PRECONDITION if the floating-point unit is not in its default mode (round to
/// nearest, nothing flushed to zero), because another mode would change pixels.
absl::Status check_machine() {
  if (!float_mode_is_default()) {
    return absl::FailedPreconditionError(
        "the floating-point unit is not in its default mode: a library loaded with this program "
        "has changed it");
  }
  return absl::OkStatus();
}

/// A coordinator that offers this program for download reads the program's versions from this mark
/// in the file. The program itself does not use the mark.
[[gnu::used]] constexpr wire::WorkerMark kMark{.pixel_version = kPixelVersion,
                                               .version = BANDSAW_VERSION};

// Exit codes.
constexpr int kUnfit = 1;          // the machine or the cache folder is unsuitable
constexpr int kWrongUsage = 2;     // wrong options, or a wrong join string
constexpr int kInterrupted = 130;  // a second SIGTERM or SIGINT

struct Arguments {
  std::string join;
  unsigned threads = std::max(1U, std::thread::hardware_concurrency());
  std::string name = host_name();
  std::string cache = default_cache_folder();
  double cache_gb = 16;
  std::string kernel = kernels().front()->name;
  bool quiet = false;
};

/// Adds the options to `app`, which writes their values to `arguments`.
void describe(CLI::App& app, Arguments& arguments) {
  app.set_version_flag("--version", "bandsaw-worker " BANDSAW_VERSION);
  app.add_option("--join", arguments.join,
                 "The join string, a file that holds it, or - for standard input")
      ->envname("BANDSAW_JOIN")
      ->required();
  app.add_option("--threads", arguments.threads,
                 "Number of rendering threads; default: one for each hardware thread")
      ->check(CLI::Range(std::size_t{1}, wire::kThreadsPerWorker));
  app.add_option("--name", arguments.name,
                 "Name of this worker for display; default: the name of the host");
  app.add_option("--cache", arguments.cache,
                 "Folder for scenes; workers of one machine may share it");
  app.add_option("--cache-size", arguments.cache_gb,
                 "Maximum size of the cache folder, in gigabytes")
      ->check(CLI::Range(0.001, 1e6));
  app.add_option("--kernel", arguments.kernel,
                 "Version of the renderer's code: avx2, neon or plain, if the program has it and "
                 "the machine can run it. All give the same image. Default: the fastest");
  app.add_flag("--quiet", arguments.quiet, "Log warnings and errors only");
}

/// Prints the error and returns the exit code `code`.
int fail(int code, const absl::Status& status) {
  std::fprintf(stderr, "bandsaw-worker: %s\n", std::string(status.message()).c_str());
  return code;
}

/// Sinks of the log besides standard error.
struct Log {
  std::shared_ptr<spdlog::sinks::ringbuffer_sink_mt> tail;  ///< sent with a failed band
  std::shared_ptr<LogQueue> news;                           ///< sent to the coordinator
};

/// Makes the log of this process. Standard error gets only warnings and errors if `quiet` is true.
Log start_log(bool quiet) {
  Log log{std::make_shared<spdlog::sinks::ringbuffer_sink_mt>(wire::kLogLines),
          std::make_shared<LogQueue>()};
  auto err = std::make_shared<spdlog::sinks::stderr_sink_mt>();
  err->set_level(quiet ? spdlog::level::warn : spdlog::level::info);
  auto logger = std::make_shared<spdlog::logger>(
      "worker", spdlog::sinks_init_list{std::move(err), log.tail, log.news});
  logger->set_pattern("%Y-%m-%d %H:%M:%S.%e %l %v");
  spdlog::set_default_logger(std::move(logger));
  return log;
}

/// Returns the signals that one thread reads with sigwait; there are no handlers.
sigset_t watched_signals() {
  sigset_t set{};
  sigemptyset(&set);
  sigaddset(&set, SIGTERM);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGUSR1);
  sigaddset(&set, SIGUSR2);  // wakes the thread, so that it can end
  return set;
}

/// Drains the daemon at the first SIGTERM or SIGINT, and ends the process at the second. Ignores
/// SIGUSR1 and SIGUSR2 from other processes, because batch systems send them as warnings. The
/// signals MUST be blocked in all threads.
class SignalWatch {
 public:
  explicit SignalWatch(Daemon& daemon) : thread_([this, &daemon] { watch(daemon); }) {}
  ~SignalWatch() {
    ending_ = true;
    pthread_kill(thread_.native_handle(), SIGUSR2);
    thread_.join();
  }
  SignalWatch(const SignalWatch&) = delete;
  SignalWatch& operator=(const SignalWatch&) = delete;

 private:
  void watch(Daemon& daemon) {
    const sigset_t set = watched_signals();
    bool is_draining = false;
    while (!ending_) {
      int signal = 0;
      sigwait(&set, &signal);
      if (signal == SIGUSR1 || signal == SIGUSR2) {
        continue;
      }
      if (is_draining) {
        std::_Exit(kInterrupted);
      }
      is_draining = true;
      daemon.drain(signal == SIGTERM ? "SIGTERM" : "SIGINT");
    }
  }

  std::atomic<bool> ending_{false};
  std::thread thread_;  ///< last: it reads the member above
};

/// Checks the machine and the arguments, and runs the daemon until it ends. Returns the exit code.
/// `wrap_calls` replaces the calls to the coordinator in tests; nullptr: they are not replaced.
int run(const Arguments& arguments, const WrapCalls& wrap_calls) {
  if (const absl::Status status = check_machine(); !status.ok()) {
    return fail(kUnfit, status);
  }
  absl::StatusOr<link::JoinString> join = link::join_string_from(arguments.join);
  if (!join.ok()) {
    return fail(kWrongUsage, join.status());
  }
  if (join->role != link::Role::kWorker) {
    return fail(kWrongUsage,
                absl::InvalidArgumentError(
                    "this join string is for users; a worker needs the join string in the file "
                    "`join` of the coordinator's data folder"));
  }
  if (arguments.cache.empty()) {
    return fail(kWrongUsage, absl::InvalidArgumentError(
                                 "neither HOME nor XDG_CACHE_HOME is set: --cache DIR is needed"));
  }
  if (arguments.name.empty() ||
      clean_text(arguments.name, wire::kWorkerNameBytes) != arguments.name) {
    return fail(kWrongUsage,
                absl::InvalidArgumentError(
                    "--name must have 1 to 64 bytes of UTF-8 without control characters"));
  }
  const absl::StatusOr<const Kernel*> kernel = find_kernel(arguments.kernel);
  if (!kernel.ok()) {
    return fail(kWrongUsage,
                absl::InvalidArgumentError(absl::StrCat("--kernel: ", kernel.status().message())));
  }
  const sigset_t set = watched_signals();
  // There is no other thread yet, so all later threads inherit the mask.
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  const Log log = start_log(arguments.quiet);
  DaemonOptions options{.join = *std::move(join),
                        .info = {.instance = link::random_hex(16),
                                 .name = arguments.name,
                                 .build = build_description(**kernel),
                                 .threads = arguments.threads,
                                 .pixel_version = kPixelVersion,
                                 .canary = canary(*kernel)},
                        .kernel = *kernel,
                        .cache_folder = arguments.cache,
                        .cache_bytes = static_cast<std::uint64_t>(arguments.cache_gb * 1e9),
                        .log_tail = [tail = log.tail] { return tail->last_formatted(); },
                        .joined =
                            [&](const std::string& address, const std::string& name) {
                              std::printf("bandsaw-worker %s · %u thread%s · joined %s as %s\n",
                                          BANDSAW_VERSION, arguments.threads,
                                          arguments.threads == 1 ? "" : "s", address.c_str(),
                                          name.c_str());
                              std::fflush(stdout);
                            },
                        .log = log.news,
                        .wrap_calls = wrap_calls};
  absl::StatusOr<std::unique_ptr<Daemon>> daemon = Daemon::create(std::move(options));
  if (!daemon.ok()) {
    return fail(kUnfit, daemon.status());
  }
  const SignalWatch watch(**daemon);
  const absl::Status status = (*daemon)->run();
  return status.ok() ? 0 : fail(kWrongUsage, status);
}

}  // namespace

int run_command(int argc, char** argv, const WrapCalls& wrap_calls) {
  Arguments arguments;
  CLI::App app("Renders bands for a Bandsaw coordinator.", "bandsaw-worker");
  describe(app, arguments);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kWrongUsage;
  }
  link::hide_join_strings({argv, static_cast<std::size_t>(argc)});
  link::use_system_resolver();
  return run(arguments, wrap_calls);
}

}  // namespace bandsaw::worker
