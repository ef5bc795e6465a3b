#pragma once

// One job on a farm that loses machines, cables or its coordinator, and the invariants that the job
// must satisfy.

#include <string>

#include "tests/farm/band_log.h"
#include "tests/farm/farm_processes.h"

namespace bandsaw::test {

/// Submits a job of its own. The test harms the farm between submit() and expect_the_same_bytes().
class Survival {
 public:
  /// `farm` MUST outlive this object. `scene`: the file to render; the default is a gallery scene.
  explicit Survival(FarmProcesses& farm, std::string scene = "");

  /// Starts `bandsaw submit` on machine `host`. This command submits a job that takes several
  /// seconds, and writes the image when the job is done.
  Process submit(const std::string& host = "coordinator");

  /// Waits until `bands` bands of the worker are on the coordinator's disk.
  void wait_until_stored(const std::string& worker, std::size_t bands);

  /// Waits until the worker has joined `times` times.
  void wait_until_joined(const std::string& worker, int times);

  /// Expects that the job succeeds with the same bytes as a local render.
  void expect_the_same_bytes(Process& client);

  /// Counts bands that one worker had stored and another rendered as well, and bands that one
  /// worker rendered twice. Rows that the coordinator gave to two workers on purpose do not count:
  /// the coordinator copies or moves rows of a slow worker to an idle worker. Bands that the worker
  /// `cut_off` rendered in vain do not count either. That worker could not know what the other
  /// workers did meanwhile, or it was killed before it could send its bands.
  int rendered_again(const std::string& cut_off = "");

  /// Expects rendered_again() to be 0; otherwise prints every log.
  void expect_nothing_rendered_again(const std::string& cut_off = "");

 private:
  /// Whether the coordinator gave the rows that both bands contain to two workers on purpose.
  bool shared(const LoggedBand& one, const LoggedBand& other) const;
  FarmProcesses& farm_;
  std::string scene_;
};

}  // namespace bandsaw::test
