#pragma once

// Decides whether a worker may render a job, and a band (a range of rows and samples) of the job. A
// band that a worker failed is left to other workers as long as one of them can render it. So is a
// band that the worker's machine was rendering when the machine was lost.
//
// A worker is eligible (Worker::eligible) if it is connected, has not announced that it will leave,
// and is not quarantined (excluded because its machine returned wrong pixels, or by a user).

#include <cstdint>
#include <vector>

#include "coordinator/scheduler/context/context.h"

namespace bandsaw::coordinator {

class Eligibility {
 public:
  /// A worker that failed this many bands of a job in a row gets no more bands of this job.
  static constexpr std::uint32_t kMaxFailuresPerWorker = 3;
  /// Maximum number of bytes of memory that a loaded scene takes per byte of its package. A mesh
  /// has 18 bytes per triangle in its package (12 of indices, 6 of vertices), and its acceleration
  /// structure takes 54 more bytes per triangle (renderlib/accel/README.md). Textures take as many
  /// bytes in memory as in the package.
  static constexpr std::uint64_t kMemoryPerPackageByte = 4;

  explicit Eligibility(const Context& context) : context_(context) {}

  /// Returns true if the worker may render bands of the job for comparison: its memory is enough
  /// and it has not failed too many bands of the job in a row.
  bool may_audit(const Worker& worker, const Job& job) const;
  /// Returns true if may_audit() is true and the worker's results may be stored for the image. The
  /// results of a browser may not be stored while audits_lag() is true. The results of a native
  /// worker (one that is no browser) may not be stored if SchedulerOptions::browsers lets only
  /// browsers render.
  bool may_render(const Worker& worker, const Job& job) const;
  /// Returns true if a native worker is eligible and many bands of the job wait for an audit (a
  /// second render, to compare). Then browsers get no more bands of the job until native workers
  /// have done some of these audits.
  /// Without this limit, the job's audits would reach Job::kMaxAudits, and further bands that are
  /// selected for an audit would be stored without one.
  bool audits_lag(const Job& job) const;
  /// Returns true if the scene of the job fits into the worker's memory.
  static bool fits(const Worker& worker, const Job& job);
  /// Returns true if the worker failed kMaxFailuresPerWorker bands of the job in a row.
  static bool failed_too_often(const Worker& worker, const Job& job);
  /// Returns true if failed_too_often() is true for an eligible native worker.
  bool native_gave_up(const Job& job) const;
  /// Returns true if may_render() is true for an eligible worker.
  bool someone_may_render(const Job& job) const;
  /// Returns true if may_render() is true for an eligible worker that has not failed the band.
  bool someone_else(const Job& job, const Band& band) const;
  /// Returns true if may_render() is true for an eligible worker that has not failed the band and
  /// runs on a machine that was not lost while it was rendering the band.
  bool another_machine(const Job& job, const Band& band) const;

  /// Returns the bands of the job that this worker must leave to others: those that it failed, if
  /// someone_else() may render them, and those that its machine was rendering when it was lost, if
  /// another_machine() may render them.
  std::vector<Band> left_to_others(const Job& job, const Worker& worker) const;
  /// Returns true if `band` overlaps a band that this worker must leave to others.
  bool left_to_others(const Job& job, const Worker& worker, const Band& band) const;

 private:
  const Context& context_;
};

}  // namespace bandsaw::coordinator
