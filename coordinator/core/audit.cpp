#include "coordinator/core/audit.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "coordinator/core/renderer.h"

namespace bandsaw::coordinator {

bool is_audited(const JobSpec& spec, const Band& band, double share) {
  Hash64 hash;
  hash.add(renderer_of(spec.request_id));
  hash.add(band.samples.first);
  hash.add(std::uint64_t{band.rows.first});
  return std::ldexp(static_cast<double>(hash.value() >> 11), -53) < share;
}

std::size_t Audit::index_of(const Witness& witness) const {
  const auto claim = std::find_if(claims_.begin(), claims_.end(),
                                  [&](const Claim& c) { return c.witness.same_machine(witness); });
  return static_cast<std::size_t>(claim - claims_.begin());
}

const Audit::Claim* Audit::claim_of(const Witness& witness) const {
  const std::size_t index = index_of(witness);
  return index == claims_.size() ? nullptr : &claims_[index];
}

std::optional<Audit::Claim> Audit::hear(Claim claim, bool asked) {
  const std::size_t index = index_of(claim.witness);
  if (index == claims_.size()) {
    claims_.push_back(std::move(claim));
    return std::nullopt;
  }
  Claim& before = claims_[index];
  if (before.digests != claim.digests) {
    return before;
  }
  before.repeated = before.repeated || asked;
  return std::nullopt;
}

Audit::Verdict Audit::verdict_for(const Claim& right) const {
  const auto agrees = [&](const Claim& other) { return other.digests == right.digests; };
  Verdict verdict{.stored_is_right = agrees(stored()), .liars = {}};
  std::remove_copy_if(claims_.begin(), claims_.end(), std::back_inserter(verdict.liars), agrees);
  return verdict;
}

std::optional<Audit::Verdict> Audit::verdict() const {
  for (auto one = claims_.begin(); one != claims_.end(); ++one) {
    const auto agrees = [&](const Claim& other) { return other.digests == one->digests; };
    if (std::find_if(std::next(one), claims_.end(), agrees) != claims_.end()) {
      return verdict_for(*one);
    }
  }
  const auto known = [](const Claim& claim) { return !claim.witness.machine.empty(); };
  const auto here = std::find_if(claims_.begin(), claims_.end(), known);
  const bool alone = disputed() && std::count_if(claims_.begin(), claims_.end(), known) == 1;
  return alone && here->repeated ? std::optional(verdict_for(*here)) : std::nullopt;
}

void Audit::introduce(const Witness& witness) {
  for (Claim& claim : claims_) {
    if (claim.witness.renderer == witness.renderer) {
      claim.witness.machine = witness.machine;
    }
  }
}

Audit Audit::split_at(std::uint32_t row) {
  Audit rest = *this;
  rest.lease = 0;
  rest.band_.rows.first = row;
  band_.rows.last = row;
  const auto cut = static_cast<std::ptrdiff_t>(band_.rows.count());
  for (std::size_t i = 0; i < claims_.size(); ++i) {
    std::vector<std::uint64_t>& all = claims_[i].digests;
    rest.claims_[i].digests.erase(rest.claims_[i].digests.begin(),
                                  rest.claims_[i].digests.begin() + cut);
    all.erase(all.begin() + cut, all.end());
  }
  return rest;
}

void Audit::forget(const Witness& witness) {
  std::erase_if(claims_, [&](const Claim& c) { return c.witness.same_machine(witness); });
}

}  // namespace bandsaw::coordinator
