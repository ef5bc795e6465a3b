#pragma once

// Messages of a coordinator to a worker, for tests of the workers' sessions.

#include "proto/farm.pb.h"
#include "proto/wire/digest.h"

namespace bandsaw::test {

/// Leases samples [0, 16) of the two rows from `first_row` of an image of 8 x 80 pixels. The
/// manifest's digest is all zeros. `id` is that of the lease. The job 7 is arbitrary.
inline farm::ToWorker lease(std::uint64_t id, std::uint32_t first_row, std::uint64_t job = 7) {
  farm::ToWorker message;
  farm::Lease* content = message.mutable_lease();
  content->set_lease(id);
  content->set_job(job);
  content->set_manifest_sha256(wire::Digest().raw());
  content->mutable_settings()->set_width(8);
  content->mutable_settings()->set_height(80);
  content->mutable_settings()->set_max_depth(4);
  content->mutable_band()->set_last_sample(16);
  content->mutable_band()->set_first_row(first_row);
  content->mutable_band()->set_last_row(first_row + 2);
  return message;
}

inline farm::ToWorker revoke(std::uint64_t id) {
  farm::ToWorker message;
  message.mutable_revoke()->add_lease(id);
  return message;
}

}  // namespace bandsaw::test
