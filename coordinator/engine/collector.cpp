// to_forget() sums the sizes of all blobs and of all final jobs (done, failed or cancelled), and
// returns the oldest final jobs if a limit is exceeded. sweep() removes the blobs that no job
// needs, and folders of unknown jobs.

#include "coordinator/engine/collector.h"

#include <spdlog/spdlog.h>
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "absl/strings/numbers.h"
#include "renderlib/base/file.h"
#include "renderlib/package/package.h"

namespace bandsaw::coordinator {

// Returns false if the manifest exists but cannot be read. Then it is not known which blobs the
// package needs. A manifest that is missing or damaged needs no blobs.
bool Collector::add_blobs_of(const DigestHex& manifest, Needs& needs) {
  const auto digest = wire::digest_from_hex(manifest);
  if (!digest.ok()) {
    return true;
  }
  const auto bytes = blobs_.get(*digest);
  if (absl::IsNotFound(bytes.status()) || absl::IsDataLoss(bytes.status())) {
    return true;
  }
  if (!bytes.ok()) {
    spdlog::warn("cannot read the scene {} to find the blobs that it needs: {}", manifest,
                 bytes.status().ToString());
    return false;
  }
  const auto text = (*bytes)->bytes();
  const auto refs = package_blobs({reinterpret_cast<const char*>(text.data()), text.size()});
  needs.blobs.insert(*digest);
  for (const BlobRef& ref : refs.ok() ? *refs : std::vector<BlobRef>()) {
    needs.blobs.insert(ref.digest);
  }
  ++needs.packages;
  return true;
}

std::optional<std::set<wire::Digest>> Collector::blobs_of(const KeptJob& job) {
  if (const auto found = known_.find(job.id);
      found != known_.end() && found->second.packages == job.manifests.size()) {
    return found->second.blobs;
  }
  // A missing package is read again the next time, because it may be sent again.
  Needs needs;
  for (const DigestHex& manifest : job.manifests) {
    if (!add_blobs_of(manifest, needs)) {
      return std::nullopt;
    }
  }
  return (known_[job.id] = std::move(needs)).blobs;
}

std::set<wire::Digest> Collector::known_blobs_of(const KeptJob& job) {
  return blobs_of(job).value_or(std::set<wire::Digest>());
}

/// Returns the time at which a final job ended, and the size of its files. For a sequence (a job of
/// many frames), the frames are included in the time and in the size. It is possible that neither
/// the job nor its frames have a folder, for example after a sequence was cancelled before a frame
/// was done. Such a job counts as ended at `now` (seconds since 1970), and an empty folder is made
/// for it. Later collections take the time from this folder.
Collector::Final Collector::final_job(const KeptJob& kept, double now) const {
  Final job{.id = kept.id};
  add_files_of(kept.id, job);
  for (const JobId frame : kept.frame_jobs) {
    add_files_of(frame, job);
  }
  if (job.at == 0) {
    make_folder(folder_.job(kept.id)).IgnoreError();  // the next collection tries it again
    job.at = now;
  }
  return job;
}

/// Adds the sizes of the files of the job `id` to `job`, and sets `job.at` to the time of the last
/// change of its folder if that is later. The bands of a job are removed from its folder when the
/// job becomes final. So the time of this change is the time at which the job ended.
void Collector::add_files_of(JobId id, Final& job) const {
  struct stat found {};
  if (::stat(folder_.job(id).c_str(), &found) == 0) {
    job.at = std::max(job.at, static_cast<double>(found.st_mtim.tv_sec));
  }
  for (const std::string& file : {folder_.result(id), folder_.first(id), folder_.samples(id),
                                  folder_.attribution(id), folder_.old_attribution(id)}) {
    if (::stat(file.c_str(), &found) == 0) {
      job.bytes += static_cast<std::uint64_t>(found.st_size);
    }
  }
}

std::vector<JobId> Collector::to_forget(const std::vector<KeptJob>& jobs, double now) {
  std::map<wire::Digest, std::uint64_t> sizes;
  std::uint64_t bytes = 0;
  for (const BlobStore::Stored& blob : blobs_.list()) {
    sizes[blob.digest] = blob.size;
    bytes += blob.size;
  }
  std::map<wire::Digest, std::size_t> users;
  std::map<JobId, const KeptJob*> by_id;
  std::vector<Final> final_jobs;
  for (const KeptJob& job : jobs) {
    by_id[job.id] = &job;
    for (const wire::Digest& digest : known_blobs_of(job)) {
      ++users[digest];
    }
    if (job.final) {
      final_jobs.push_back(final_job(job, now));
      bytes += final_jobs.back().bytes;
    }
  }
  std::sort(final_jobs.begin(), final_jobs.end(), [](const Final& a, const Final& b) {
    return std::pair(a.at, a.id) < std::pair(b.at, b.id);
  });
  std::vector<JobId> forget;
  for (const Final& job : final_jobs) {
    // The submitter of a job that has just become final may still fetch its result.
    const bool fresh = now - job.at < keep_.min_seconds;
    if (now - job.at <= keep_.seconds && (bytes <= keep_.bytes || fresh) &&
        final_jobs.size() - forget.size() <= keep_.jobs) {
      break;
    }
    forget.push_back(job.id);
    bytes -= std::min(bytes, job.bytes);
    for (const wire::Digest& digest : known_blobs_of(*by_id.at(job.id))) {
      if (--users[digest] == 0) {
        bytes -= std::min(bytes, sizes[digest]);
      }
    }
  }
  return forget;
}

void Collector::remove_unneeded(const std::set<wire::Digest>& needed, double now) {
  std::size_t removed = 0;
  for (const BlobStore::Stored& blob : blobs_.list()) {
    if (!needed.contains(blob.digest) && now - blob.used_at > keep_.unused_seconds) {
      removed += blobs_.remove(blob.digest).ok() ? 1 : 0;
    }
  }
  if (removed > 0) {
    spdlog::info("removed {} blobs that no job needs", removed);
  }
}

void Collector::sweep(const std::vector<KeptJob>& jobs, double now) {
  std::set<wire::Digest> needed;
  std::set<JobId> ids;
  bool all_known = true;
  for (const KeptJob& job : jobs) {
    ids.insert(job.id);
    ids.insert(job.frame_jobs.begin(), job.frame_jobs.end());
    if (const auto blobs = blobs_of(job)) {
      needed.insert(blobs->begin(), blobs->end());
    } else if (!job.final) {
      all_known = false;
    }
  }
  std::erase_if(known_, [&](const auto& one) { return !ids.contains(one.first); });
  if (all_known) {
    remove_unneeded(needed, now);
  }
  blobs_.remove_partials(now, keep_.unused_seconds);
  // A job that was added after `jobs` was made has a higher id than every job in `jobs`. Its folder
  // is kept.
  std::error_code error;
  std::vector<std::filesystem::path> unknown;
  for (std::filesystem::directory_iterator entry(folder_.jobs(), error), end;
       !error && entry != end; entry.increment(error)) {
    JobId id = 0;
    if (absl::SimpleAtoi(entry->path().filename().string(), &id) && !ids.contains(id) &&
        !ids.empty() && id < *ids.rbegin()) {
      unknown.push_back(entry->path());
    }
  }
  for (const std::filesystem::path& path : unknown) {
    std::filesystem::remove_all(path, error);
  }
}

}  // namespace bandsaw::coordinator
