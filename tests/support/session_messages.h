#pragma once

// Messages of a coordinator to a worker, for tests of the workers' sessions. A lease assigns a band
// (some samples of some rows of a job's image) to a worker. A revocation cancels leases.

#include "proto/farm.pb.h"
#include "proto/wire/digest.h"

namespace bandsaw::test {

/// Returns the message that assigns the lease `id`: samples [0, 16) of the rows `first_row` and
/// `first_row` + 1 of an image of 8 x 80 pixels. The digest of the scene's manifest is all zeros.
/// The job 7 is arbitrary.
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

/// Returns the message that cancels the lease `id`.
inline farm::ToWorker revoke(std::uint64_t id) {
  farm::ToWorker message;
  message.mutable_revoke()->add_lease(id);
  return message;
}

}  // namespace bandsaw::test
