// Starts, stops and kills the processes of a farm for one test: a coordinator, its workers, and
// commands.

#include "tests/farm/farm_processes.h"

#include <gtest/gtest.h>

#include <csignal>
#include <fstream>
#include <regex>
#include <sstream>
#include <utility>

#include "proto/link/join.h"
#include "renderlib/base/check.h"

namespace bandsaw::test {

FarmProcesses::FarmProcesses(const Hosts* hosts, std::vector<std::string> options,
                             std::string program)
    : hosts_(hosts),
      options_(std::move(options)),
      program_(std::move(program)),
      listen_((hosts == nullptr ? std::string("127.0.0.1") : hosts->address("coordinator")) +
              ":0") {
  start_coordinator();
}

std::vector<std::string> FarmProcesses::on(const std::string& host,
                                           std::vector<std::string> argv) const {
  return hosts_ == nullptr ? argv : hosts_->on(host, std::move(argv));
}

void FarmProcesses::start_coordinator() {
  std::vector<std::string> argv = {program_,         "serve",    "--data",
                                   folder_ / "data", "--listen", listen_};
  argv.insert(argv.end(), options_.begin(), options_.end());
  coordinator_ = std::make_unique<Process>(Process::start(on("coordinator", argv)));
  BANDSAW_CHECK(coordinator_->wait_for("join with:"), coordinator_->err().c_str());
  const auto join = link::join_string_from(join_file());
  BANDSAW_CHECK(join.ok(), join.status().ToString().c_str());
  listen_ = join->addresses.front();
}

void FarmProcesses::restart_coordinator() {
  earlier_log_ += coordinator_->err();
  start_coordinator();
}

Process& FarmProcesses::add_worker(const std::string& name, int threads,
                                   const std::string& program) {
  Process process =
      Process::start(on(name, {program, "--join", join_file(), "--name", name, "--threads",
                               std::to_string(threads), "--cache", folder_ / ("cache-" + name)}));
  EXPECT_TRUE(process.wait_for("joined")) << process.err();
  return workers_.insert_or_assign(name, std::move(process)).first->second;
}

std::vector<std::string> FarmProcesses::worker_names() const {
  std::vector<std::string> names;
  for (const auto& [name, process] : workers_) {
    names.push_back(name);
  }
  return names;
}

std::vector<std::string> FarmProcesses::command(std::vector<std::string> arguments) const {
  arguments.insert(arguments.begin(), BANDSAW_BIN);
  arguments.insert(arguments.end(), {"--farm", farm_file()});
  return arguments;
}

std::string line_to_paste(Process& coordinator) {
  const std::regex line("no bandsaw-worker:  ([^\n]*)\n");
  std::smatch found;
  EXPECT_TRUE(coordinator.wait_until([&](const std::string& out, const std::string&) {
    return std::regex_search(out, line);
  })) << coordinator.err();
  const std::string out = coordinator.out();
  std::regex_search(out, found, line);
  return found[1];
}

std::string file_bytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  EXPECT_TRUE(file.good()) << path << " cannot be read";
  std::ostringstream bytes;
  bytes << file.rdbuf();
  return bytes.str();
}

}  // namespace bandsaw::test
