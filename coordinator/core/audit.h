#pragma once

// A band that is rendered twice, by two machines, and compared by the digests of its rows.
//
// Rendering is a pure function, so results that differ prove that a machine is wrong. Two that
// agree are right: two machines that are wrong differ from each other. A machine that is asked
// again and differs from itself is wrong for certain, whoever else there is.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "coordinator/core/types.h"

namespace bandsaw::coordinator {

/// Whether a band of the job is rendered twice. `share`: of all bands, [0, 1]. Decided by a hash of
/// the band and of the submitter's request id, which workers are never told: none knows when it is
/// watched, and every life of the coordinator picks the same bands.
bool is_audited(const JobSpec& spec, const Band& band, double share);

/// Who gave a result: a worker process, and the machine by the name that it says itself, under
/// which it comes back when it is started again.
struct Witness {
  std::uint64_t renderer = 0;  ///< core/renderer.h
  std::string machine;         ///< empty: not heard of in this life of the coordinator

  bool same_machine(const Witness& other) const {
    return renderer == other.renderer || (!machine.empty() && machine == other.machine);
  }
};

class Audit {
 public:
  /// What a machine says of the band; one digest a row.
  struct Claim {
    Witness witness;
    std::vector<std::uint64_t> digests;
    bool repeated = false;  ///< it was asked again and said the same
  };
  /// Once two agree: who does not, and whether the stored rows are right.
  struct Verdict {
    bool stored_is_right = false;
    std::vector<Claim> liars;
  };

  /// `stored`: of the rows that are in the image.
  Audit(const Band& band, Claim stored) : band_(band) { claims_.push_back(std::move(stored)); }

  /// One more result. `asked`: it was rendered for this. The earlier claim of a machine that
  /// contradicts itself.
  std::optional<Claim> hear(Claim claim, bool asked);
  /// Nothing while no two machines agree. Except: one that repeated its word is believed against
  /// those that were not heard of in this life of the coordinator and cannot be asked.
  std::optional<Verdict> verdict() const;
  /// A witness of whom only the renderer was known is this one.
  void introduce(const Witness& witness);
  /// Cuts off the rows from `row` on, with what was said of them. REQUIRES a row inside of the
  /// band.
  Audit split_at(std::uint32_t row);
  /// A machine whose word counts nothing any more; MUST NOT be the one whose rows are stored.
  void forget(const Witness& witness);

  const Band& band() const { return band_; }
  const std::vector<Claim>& claims() const { return claims_; }
  const Claim& stored() const { return claims_.front(); }
  const Claim* claim_of(const Witness& witness) const;
  /// Machines said different things, and it is not known which is right.
  bool disputed() const { return claims_.size() > 1; }

  LeaseId lease = 0;             ///< of who renders it again now; 0: nobody
  std::set<std::string> given;   ///< machines that had it
  std::set<std::string> unable;  ///< of these, who could not

 private:
  Verdict verdict_for(const Claim& right) const;
  /// Of its claim; claims_.size(): it has said nothing.
  std::size_t index_of(const Witness& witness) const;

  Band band_;
  std::vector<Claim> claims_;  ///< of different machines; the first is what is stored
};

}  // namespace bandsaw::coordinator
