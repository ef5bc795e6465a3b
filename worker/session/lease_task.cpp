// Converts the fields of a lease message, and checks their ranges.

#include "worker/session/lease_task.h"

#include "proto/convert/render_values.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::worker {

absl::StatusOr<Task> task_of(const farm::Lease& lease) {
  Task task{.id = 0,
            .job = lease.job(),
            .manifest = {},
            .settings = settings_of(lease.settings()),
            .band = band_of(lease.band()),
            .tiles = {}};
  ASSIGN_OR_RETURN(task.manifest, wire::digest_from_raw(lease.manifest_sha256()));
  RETURN_IF_ERROR(validate(task.settings));
  RETURN_IF_ERROR(validate(task.band, task.settings));
  ASSIGN_OR_RETURN(task.tiles, TileSamples::from_numbers(lease.tile_samples(), task.settings.width,
                                                         task.band.rows));
  return task;
}

}  // namespace bandsaw::worker
