#pragma once

// Settings of the scheduler: its timeouts, audits and versions. The engine sets them (engine.h,
// EngineOptions), mostly from the options of `bandsaw serve`.

#include <cstddef>
#include <cstdint>
#include <string>

namespace bandsaw::coordinator {

/// The versions that a worker and the coordinator must have in common.
struct Compatibility {
  std::uint32_t protocol = 0;
  std::uint32_t pixel_version = 0;  ///< changes whenever rendered pixels change
  std::uint64_t canary = 0;         ///< hash of a small render (renderlib/render/canary.h)
};

/// Which workers may be browsers.
enum class Browsers {
  kNone,  ///< browsers are refused
  kAlso,  ///< browsers and native workers render
  kOnly,  ///< native workers only compare what browsers rendered
};

struct SchedulerOptions {
  Compatibility compatibility;      ///< versions of this coordinator
  double heartbeat_interval_s = 1;  ///< requested of workers
  double heartbeat_timeout_s = 4;   ///< a worker that is silent for longer is disconnected
  double progress_timeout_s = 30;   ///< a lease without progress for longer is revoked
  /// After a restart, or after all workers were lost at once, nothing is leased until all former
  /// workers have reconnected, or until this time has passed.
  double reattach_grace_s = 6;
  /// Seconds that a worker should need for a band (the rows and samples of one lease); bands near
  /// the end of a job are shorter.
  double band_target_s = 1;
  /// Minimum number of machines that must be lost at the same suspect band before its job fails. A
  /// band becomes suspect when a worker that holds it is lost. More machines are required on farms
  /// that lose many workers, or of which little is known (CrashRate in
  /// liveness/crash_attribution.h).
  std::size_t min_crashes_per_band = 3;
  /// Share of the bands of native workers that a second machine renders, to compare the results
  /// (model/audit.h); in [0, 1].
  double audit_share = 0;
  /// Share of the bands of browsers that a second machine renders; in [0, 1].
  double browser_audit_share = 0;
  Browsers browsers = Browsers::kAlso;
  /// Name of this run of the coordinator; workers report it with the leases that they hold.
  std::string epoch;
};

}  // namespace bandsaw::coordinator
