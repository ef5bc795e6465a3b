#pragma once

// One job on a farm that loses machines, cables or its coordinator, and what must hold of it.

#include <string>

#include "tests/farm/band_log.h"
#include "tests/farm/farm_processes.h"

namespace bandsaw::test {

class Survival {
 public:
  /// `farm` MUST stay.
  explicit Survival(FarmProcesses& farm) : farm_(farm) {}

  /// Starts a job of some seconds; the command that watches it, on the machine `host`.
  Process submit(const std::string& host = "house");

  /// Waits until so many bands of the worker are on the coordinator's disk.
  void wait_until_stored(const std::string& worker, std::size_t bands);

  /// Waits until the worker has joined so many times.
  void wait_until_joined(const std::string& worker, int times);

  /// The job ends well, and with the bytes of a local render.
  void expect_the_same_bytes(Process& client);

  /// Bands that some worker had stored and another rendered too, without having been asked to help
  /// it; and bands one worker rendered twice. What a worker that was `cut_off` rendered in vain
  /// does not count: it could not know what others did meanwhile.
  int rendered_again(const std::string& cut_off = "");

  /// None of the above; where there are, every log is printed.
  void expect_nothing_rendered_again(const std::string& cut_off = "");

 private:
  bool shared(const LoggedBand& one, const LoggedBand& other) const;
  FarmProcesses& farm_;
};

}  // namespace bandsaw::test
