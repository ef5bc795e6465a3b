// An audit compares the results of several machines for one band (a range of rows and samples). It
// holds one result for each machine, the stored one first. A verdict needs two machines that agree,
// or one machine that repeated its result and is the only one left that can render the band.

#include "coordinator/scheduler/model/audit.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "coordinator/scheduler/api/worker_process.h"

namespace bandsaw::coordinator {

bool is_audited(const JobSpec& spec, const Band& band, double share) {
  Hash64 hash;
  hash.add(text_hash(spec.request_id));
  hash.add(band.samples.first);
  hash.add(std::uint64_t{band.rows.first});
  // The upper 53 bits of the hash as a number in [0, 1).
  return std::ldexp(static_cast<double>(hash.value() >> 11), -53) < share;
}

std::size_t Audit::index_of(const Reporter& reporter) const {
  const auto result = std::find_if(results_.begin(), results_.end(), [&](const Result& c) {
    return c.reporter.same_machine(reporter);
  });
  return static_cast<std::size_t>(result - results_.begin());
}

const Audit::Result* Audit::result_of(const Reporter& reporter) const {
  const std::size_t index = index_of(reporter);
  return index == results_.size() ? nullptr : &results_[index];
}

std::optional<Audit::Result> Audit::add(Result result, bool requested) {
  const std::size_t index = index_of(result.reporter);
  if (index == results_.size()) {
    results_.push_back(std::move(result));
    return std::nullopt;
  }
  Result& before = results_[index];
  if (before.digests != result.digests) {
    return before;
  }
  before.repeated = before.repeated || requested;
  return std::nullopt;
}

Audit::Verdict Audit::verdict_for(const Result& right) const {
  const auto agrees = [&](const Result& other) { return other.digests == right.digests; };
  Verdict verdict{.stored_is_right = agrees(stored()), .wrong = {}};
  std::remove_copy_if(results_.begin(), results_.end(), std::back_inserter(verdict.wrong), agrees);
  return verdict;
}

bool Audit::only_browsers() const {
  return std::all_of(results_.begin(), results_.end(),
                     [](const Result& result) { return result.reporter.browser; });
}

bool Audit::doubtful() const {
  const auto native = [](const Result& result) { return !result.reporter.browser; };
  return disputed() &&
         (!native(stored()) || std::any_of(std::next(results_.begin()), results_.end(), native));
}

std::optional<Audit::Verdict> Audit::verdict(bool only_browsers_left) const {
  const bool browsers_decide = only_browsers_left && only_browsers();
  for (auto one = results_.begin(); one != results_.end(); ++one) {
    const auto agrees = [&](const Result& other) {
      const bool counts = browsers_decide || !one->reporter.browser || !other.reporter.browser;
      return counts && other.digests == one->digests;
    };
    if (std::find_if(std::next(one), results_.end(), agrees) != results_.end()) {
      return verdict_for(*one);
    }
  }
  // No two agree. If a single machine is left that can render the band, and it has repeated its
  // result, that result is right.
  const auto known = [&](const Result& result) {
    return !result.reporter.machine.empty() && !result.away &&
           (browsers_decide || !result.reporter.browser);
  };
  const auto here = std::find_if(results_.begin(), results_.end(), known);
  const bool alone = disputed() && here != results_.end() &&
                     std::count_if(results_.begin(), results_.end(), known) == 1;
  return alone && here->repeated ? std::optional(verdict_for(*here)) : std::nullopt;
}

void Audit::identify(const Reporter& reporter) {
  for (Result& result : results_) {
    if (result.reporter.same_machine(reporter)) {
      result.reporter.machine = reporter.machine;
      result.away = false;
    }
  }
}

Audit Audit::split_at(std::uint32_t row) {
  Audit rest = *this;
  rest.lease = 0;
  rest.band_.rows.first = row;
  band_.rows.last = row;
  const auto cut = static_cast<std::ptrdiff_t>(band_.rows.count());
  for (std::size_t i = 0; i < results_.size(); ++i) {
    std::vector<std::uint64_t>& all = results_[i].digests;
    rest.results_[i].digests.erase(rest.results_[i].digests.begin(),
                                   rest.results_[i].digests.begin() + cut);
    all.erase(all.begin() + cut, all.end());
  }
  return rest;
}

void Audit::forget(const Reporter& reporter) {
  std::erase_if(results_, [&](const Result& c) { return c.reporter.same_machine(reporter); });
}

}  // namespace bandsaw::coordinator
