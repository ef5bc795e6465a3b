// Sends the state of each watched job to its watchers: at most ten times a second if something has
// changed, otherwise about once a second.

#include "coordinator/engine/watchers.h"

#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"

namespace bandsaw::coordinator {
namespace {

constexpr double kMinInterval_s = 0.1;
/// A little less than a second, because the interval is checked every tenth of a second.
constexpr double kMaxInterval_s = 0.9;

/// Returns true if the views differ in a field that does not change with time alone.
bool differ(const JobView& a, const JobView& b) {
  return a.state != b.state || a.reason != b.reason || a.samples_done != b.samples_done ||
         a.samples_per_pixel != b.samples_per_pixel || a.error != b.error ||
         a.counters != b.counters || a.frames != b.frames || a.workers_used != b.workers_used ||
         !std::equal(a.workers.begin(), a.workers.end(), b.workers.begin(), b.workers.end(),
                     [](const JobWorkerView& v, const JobWorkerView& w) {
                       return v.name == w.name && v.rows == w.rows && v.state == w.state;
                     });
}

absl::Status unknown(JobId job) {
  return absl::NotFoundError(absl::StrCat("there is no job ", job));
}

}  // namespace

void Watchers::add(JobId job, const std::optional<JobView>& view, Changed changed, Time now) {
  if (!view) {
    changed(unknown(job));
    return;
  }
  if (!changed(*view) || is_final(view->state)) {
    return;
  }
  const auto [entry, is_new] = jobs_.try_emplace(job);
  if (is_new) {
    entry->second.sent = *view;
    entry->second.sent_at = now;
    entry->second.checked_at = now;
  }
  entry->second.watchers.push_back(std::move(changed));
}

void Watchers::update(ViewOf view_of, bool hold_final, Time now) {
  for (auto it = jobs_.begin(); it != jobs_.end();) {
    Watched& watched = it->second;
    if (now - watched.checked_at < kMinInterval_s) {
      ++it;
      continue;
    }
    watched.checked_at = now;
    const std::optional<JobView> view = view_of(it->first);
    if (!view) {
      for (const Changed& deliver : watched.watchers) {
        deliver(unknown(it->first));
      }
      it = jobs_.erase(it);
      continue;
    }
    const bool final = is_final(view->state);
    const bool due = differ(*view, watched.sent) || now - watched.sent_at >= kMaxInterval_s;
    if (!due || (final && hold_final)) {
      ++it;
      continue;
    }
    watched.sent = *view;
    watched.sent_at = now;
    std::erase_if(watched.watchers, [&](const Changed& deliver) { return !deliver(*view); });
    it = final || watched.watchers.empty() ? jobs_.erase(it) : std::next(it);
  }
}

}  // namespace bandsaw::coordinator
