#pragma once

// An audit renders a band (a range of rows and samples) on a second machine and compares the
// digests of its rows with those of the first result.
//
// Rendering is a pure function, so results that differ prove that a machine is wrong. Two machines
// that agree are assumed to be right, because two wrong results would differ from each other. A
// machine that renders the band again and contradicts its own first result is wrong for certain.
//
// These rules hold for native workers, which belong to the farm and are wrong by accident only.
// Anyone who has the link for browsers can open several browsers that return the same wrong pixels.
// So a result on which only browsers agree is assumed to be right only while no native worker is
// connected. A native worker that repeats its result wins against any number of browsers.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "coordinator/scheduler/api/ids.h"
#include "coordinator/scheduler/api/job_spec.h"
#include "renderlib/render/band.h"

namespace bandsaw::coordinator {

/// Returns true if the band is selected for an audit. `share`: the share of all bands that is
/// selected, [0, 1]. The selection is a hash of the band and of the submitter's request id. Workers
/// never see the request id, so none can predict which bands are audited. Every epoch (run of the
/// coordinator) selects the same bands.
bool is_audited(const JobSpec& spec, const Band& band, double share);

/// Origin of a result: the worker process, and its machine under the name that the worker reports.
/// The machine is the same when its worker is restarted.
struct Reporter {
  WorkerProcessId process = 0;
  /// Empty: unknown, because the process has not connected in this epoch. Each browser is a machine
  /// of its own.
  std::string machine;
  bool browser = false;

  bool same_machine(const Reporter& other) const {
    return process == other.process || (!machine.empty() && machine == other.machine);
  }
};

class Audit {
 public:
  /// The result of one machine for the band.
  struct Result {
    Reporter reporter;
    std::vector<std::uint64_t> digests;  ///< one per row
    bool repeated = false;               ///< the machine rendered it again with the same digests
    /// The result is of an earlier epoch. The journal names its machine, which has not connected in
    /// this epoch.
    bool away = false;
  };
  struct Verdict {
    bool stored_is_right = false;
    std::vector<Result> wrong;  ///< results that differ from the right one
  };

  /// `stored`: the result whose rows are in the image.
  Audit(const Band& band, Result stored) : band_(band) { results_.push_back(std::move(stored)); }

  /// Adds a result. `requested`: it was rendered for this audit. If the machine contradicts its own
  /// earlier result, returns that earlier result, and nothing is added.
  std::optional<Result> add(Result result, bool requested);
  /// Returns the verdict once two machines agree, else std::nullopt. Two browsers that agree count
  /// only if `only_browsers_left` (Context::only_browsers) and no native worker returned a result.
  /// Exception: a machine that rendered the band again with the same result wins against machines
  /// that have not connected in this epoch, because these cannot render the band again. If the
  /// machine is a native worker, it also wins against browsers.
  std::optional<Verdict> verdict(bool only_browsers_left) const;
  /// Notes that the worker `reporter` has connected. In the results of its machine, sets the name
  /// of the machine (only the process may have been known) and clears Result::away.
  void identify(const Reporter& reporter);
  /// Cuts off the rows from `row` on and returns them as an audit of their own. REQUIRES a row
  /// inside the band.
  Audit split_at(std::uint32_t row);
  /// Removes the machine's result. It MUST NOT be the stored one.
  void forget(const Reporter& reporter);

  const Band& band() const { return band_; }
  const std::vector<Result>& results() const { return results_; }
  const Result& stored() const { return results_.front(); }
  const Result* result_of(const Reporter& reporter) const;
  /// Returns true if machines returned different results and none is known to be right.
  bool disputed() const { return results_.size() > 1; }
  /// Returns true if the audit is disputed and the stored rows may be wrong. They are not doubted
  /// if a native worker stored them and all other results are of browsers.
  bool doubtful() const;
  /// Returns true if all results are of browsers.
  bool only_browsers() const;

  LeaseId lease = 0;  ///< lease under which it is being rendered again; 0: none
  /// Machines (Worker::machine) that have had a lease of this audit.
  std::set<std::string> given;
  std::set<std::string> unable;  ///< machines in `given` that could not render it

 private:
  /// Returns the verdict if `right` is known to be right: all results that differ from it are
  /// wrong.
  Verdict verdict_for(const Result& right) const;
  /// Returns the index of the machine's result, or results_.size().
  std::size_t index_of(const Reporter& reporter) const;

  Band band_;
  std::vector<Result> results_;  ///< one for each machine; the first is the stored one
};

}  // namespace bandsaw::coordinator
