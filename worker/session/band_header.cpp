// Collects the fields of the message that precedes the bytes of a band.

#include "worker/session/band_header.h"

#include "proto/convert/render_values.h"
#include "renderlib/render/work_hash.h"

namespace bandsaw::worker {

farm::BandHeader band_header(const Task& task, const BandPayload& payload, const Counters& counters,
                             const RenderCost& cost, const std::string& instance,
                             const LeaseName& lease) {
  farm::BandHeader header;
  header.set_job(task.job);
  *header.mutable_band() = to_message(task.band);
  header.set_lease(lease.lease);
  header.set_epoch(lease.epoch);
  header.set_instance(instance);
  header.set_size(payload.size);
  header.set_sha256(payload.digest.raw());
  header.set_work(work_hash(task.manifest.hex(), task.settings));
  *header.mutable_counters() = to_message(counters);
  header.mutable_counters()->set_render_s(cost.render_s);
  header.mutable_counters()->set_cpu_s(cost.cpu_s);
  return header;
}

}  // namespace bandsaw::worker
