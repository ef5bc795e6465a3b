// A band is a range of rows and samples of an image. Measures what a band costs the real
// coordinator, which receives each band through gRPC with TLS and writes it to the disk. Also
// measures how much memory a connected worker takes. The workers are null workers: they render
// nothing. They answer each lease (the order to render a band) at once with black rows.
//
//   dispatch_bench [SECONDS [WORKERS]]
//
// First 1, then 4, 5, 6 and 16 workers send bands, each time for SECONDS (default 10). Then WORKERS
// (default 1000) connect, and the memory is measured.

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "proto/farm.grpc.pb.h"
#include "proto/link/channel.h"
#include "proto/wire/versions.h"
#include "renderlib/base/check.h"
#include "renderlib/base/file.h"
#include "renderlib/package/package.h"
#include "renderlib/render/canary.h"
#include "renderlib/render/pixel_version.h"
#include "tests/support/process.h"
#include "tests/support/scenes.h"
#include "tests/support/temp_dir.h"

namespace bandsaw {
namespace {

using Clock = std::chrono::steady_clock;
using Stream = grpc::ClientReaderWriter<farm::FromWorker, farm::ToWorker>;

constexpr std::chrono::milliseconds kLong{600'000};  // deadline of calls; every call is shorter
// The image has many rows of few bytes each, because the cost of bands is measured, not that of
// their bytes.
constexpr std::uint32_t kWidth = 64;
constexpr std::uint32_t kHeight = 4096;

/// CPU seconds and resident MB of the coordinator's process.
struct Usage {
  double cpu_s = 0;
  double resident_mb = 0;
};

Usage usage_of(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
  std::string text((std::istreambuf_iterator<char>(file)), {});
  std::istringstream fields(text.substr(text.rfind(')') + 2));
  std::vector<std::string> field;
  for (std::string word; fields >> word;) {
    field.push_back(word);
  }
  // proc(5): utime and stime are fields 14 and 15, rss is 24; field 3 has index 0 here.
  const double ticks = std::stod(field.at(11)) + std::stod(field.at(12));
  const double pages = std::stod(field.at(21));
  return {ticks / static_cast<double>(sysconf(_SC_CLK_TCK)),
          pages * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6};
}

void check(const grpc::Status& status) {
  BANDSAW_CHECK(status.ok(), status.error_message().c_str());
}

link::JoinString join_from(const std::string& file) {
  const auto join = link::join_string_from(file);
  BANDSAW_CHECK(join.ok(), join.status().ToString().c_str());
  return *join;
}

link::Connected connect(const link::JoinString& join) {
  auto connected = link::connect(join, kLong);
  BANDSAW_CHECK(connected.ok(), connected.status().ToString().c_str());
  return *connected;
}

void put_blob(farm::Farm::Stub& stub, const link::JoinString& join, const std::string& bytes) {
  farm::BlobChunk chunk;
  chunk.set_sha256(wire::sha256(bytes).raw());
  chunk.set_size(bytes.size());
  chunk.set_data(bytes);
  grpc::ClientContext context;
  link::prepare(context, join, kLong);
  farm::PutBlobReply reply;
  const auto writer = stub.PutBlob(&context, &reply);
  writer->Write(chunk);
  writer->WritesDone();
  check(writer->Finish());
}

/// Submits a job of `width` x `height` pixels. It has 2^20 samples a pixel, so that it does not end
/// during the measurement.
void submit(const link::JoinString& join, std::uint32_t width, std::uint32_t height) {
  const link::Connected farm = connect(join);
  const auto stub = farm::Farm::NewStub(farm.control);
  BlobMap blobs;
  const std::string manifest = encode_package(test::cornell_box().scene, PackageInfo(), blobs);
  for (const auto& [digest, bytes] : blobs.all()) {
    put_blob(*stub, join, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  }
  put_blob(*stub, join, manifest);
  farm::SubmitRequest request;
  request.set_request_id("0123456789abcdef" + std::to_string(width));
  request.set_name("null");
  request.set_manifest_sha256(wire::sha256(manifest).raw());
  request.mutable_settings()->set_width(width);
  request.mutable_settings()->set_height(height);
  request.mutable_settings()->set_max_depth(4);
  request.mutable_stop()->set_samples(1 << 20);
  grpc::ClientContext context;
  link::prepare(context, join, kLong);
  farm::SubmitReply reply;
  check(stub->Submit(&context, request, &reply));
}

/// A worker that renders nothing.
class NullWorker {
 public:
  NullWorker(const link::JoinString& join, const link::Connected& farm, int number)
      : join_(join),
        stub_(farm::Work::NewStub(farm.control)),
        bulk_(farm::Work::NewStub(farm.bulk)),
        instance_(std::string(32, '0')) {
    const std::string digits = std::to_string(number);
    instance_.replace(32 - digits.size(), digits.size(), digits);
    link::prepare(context_, join, std::chrono::milliseconds(0));
    stream_ = stub_->Session(&context_);
    farm::FromWorker message;
    farm::Hello& hello = *message.mutable_hello();
    hello.set_protocol(wire::kProtocol);
    hello.set_pixel_version(kPixelVersion);
    hello.set_canary(canary());
    hello.set_instance(instance_);
    hello.set_name("null-" + digits);
    hello.set_threads(1);
    hello.set_max_bands(3);
    stream_->Write(message);
    farm::ToWorker answer;
    BANDSAW_CHECK(stream_->Read(&answer) && answer.has_welcome(), "a null worker is welcome");
    link::prepare(bands_context_, join, std::chrono::milliseconds(0));
    bands_ = bulk_->PutBands(&bands_context_);
  }
  ~NullWorker() {
    context_.TryCancel();
    bands_context_.TryCancel();
    bands_->Finish();
  }

  void beat() {
    farm::FromWorker message;
    message.mutable_heartbeat()->set_doing("nothing");
    stream_->Write(message);
  }

  /// Answers leases until the time is up. Returns, for each lease, the seconds from its arrival to
  /// the acknowledgement of its band.
  std::vector<double> work(Clock::time_point until) {
    std::vector<double> took;
    farm::ToWorker message;
    auto last_beat = Clock::now();
    while (Clock::now() < until && stream_->Read(&message)) {
      if (message.has_lease()) {
        const auto began = Clock::now();
        put(message.lease());
        took.push_back(std::chrono::duration<double>(Clock::now() - began).count());
      }
      if (Clock::now() - last_beat > std::chrono::seconds(1)) {
        beat();
        last_beat = Clock::now();
      }
    }
    return took;
  }

 private:
  /// Sends black rows for a lease and waits for the acknowledgement.
  void put(const farm::Lease& lease) {
    const farm::Band& band = lease.band();
    // 24 bytes a pixel: three sums, each a double.
    const std::string black(
        std::size_t{band.last_row() - band.first_row()} * lease.settings().width() * 24, '\0');
    farm::BandChunk chunk;
    farm::BandHeader& header = *chunk.mutable_header();
    header.set_job(lease.job());
    *header.mutable_band() = band;
    header.set_lease(lease.lease());
    header.set_instance(instance_);
    header.set_size(black.size());
    header.set_sha256(wire::sha256(black).raw());
    // Reports a speed so low that the scheduler leases bands of one row. So the measurement shows
    // the cost of a band and not that of its bytes.
    header.mutable_counters()->set_render_s(2.0 * (band.last_row() - band.first_row()));
    chunk.set_data(black);
    farm::PutBandReply reply;
    const bool answered = bands_->Write(chunk) && bands_->Read(&reply);
    BANDSAW_CHECK(answered, "a band is taken");
  }

  const link::JoinString join_;
  const std::unique_ptr<farm::Work::Stub> stub_;
  const std::unique_ptr<farm::Work::Stub> bulk_;
  std::string instance_;
  grpc::ClientContext context_;
  std::unique_ptr<Stream> stream_;
  grpc::ClientContext bands_context_;
  std::unique_ptr<grpc::ClientReaderWriter<farm::BandChunk, farm::PutBandReply>> bands_;
};

struct Coordinator {
  test::TempDir folder;
  test::Process process =
      test::Process::start({BANDSAW_BIN, "serve", "--data", folder / "data", "--listen",
                            "127.0.0.1:0", "--web", "none", "--audit", "0%"});
  Coordinator() { BANDSAW_CHECK(process.wait_for("join with:"), process.err().c_str()); }
  /// Join string for workers.
  link::JoinString workers() const { return join_from(folder / "data/join"); }
  /// Join string for users, who submit jobs.
  link::JoinString people() const { return join_from(folder / "data/farm"); }
};

/// Prints the number of bands that `workers` null workers get acknowledged in `seconds`, and the
/// cost of a band.
void bands(double seconds, int workers) {
  Coordinator farm;
  submit(farm.people(), kWidth, kHeight);
  std::vector<std::vector<double>> took(workers);
  std::vector<std::thread> threads;
  const Usage before = usage_of(farm.process.pid());
  const auto began = Clock::now();
  const auto until = began + std::chrono::milliseconds(static_cast<int>(1000 * seconds));
  for (int i = 0; i < workers; ++i) {
    threads.emplace_back([&, i] {
      const link::JoinString join = farm.workers();
      NullWorker worker(join, connect(join), i);
      took[i] = worker.work(until);
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  const double passed = std::chrono::duration<double>(Clock::now() - began).count();
  const Usage after = usage_of(farm.process.pid());
  std::vector<double> all;
  for (const auto& one : took) {
    all.insert(all.end(), one.begin(), one.end());
  }
  std::sort(all.begin(), all.end());
  BANDSAW_CHECK(!all.empty(), "some band was answered");
  std::printf(
      "%zu bands of %d null worker(s) in %.1f s: %.0f bands/s; median time from the lease to the "
      "acknowledgement %.2f ms; coordinator %.0f µs CPU a band, %.0f MB\n",
      all.size(), workers, passed, static_cast<double>(all.size()) / passed,
      1e3 * all[all.size() / 2],
      1e6 * (after.cpu_s - before.cpu_s) / static_cast<double>(all.size()), after.resident_mb);
}

/// Measures a lower bound for the time of a band: the time to append and sync one row, with nothing
/// else to do.
void disk(double seconds) {
  const test::TempDir folder;
  auto file = File::open(folder / "rows", O_CREAT | O_WRONLY);
  BANDSAW_CHECK(file.ok(), file.status().ToString().c_str());
  const std::vector<std::byte> row(std::size_t{kWidth} * 24);
  std::vector<double> took;
  const auto until = Clock::now() + std::chrono::milliseconds(static_cast<int>(1000 * seconds));
  for (auto began = Clock::now(); began < until; began = Clock::now()) {
    const bool synced = file->write(row).ok() && file->sync().ok();
    BANDSAW_CHECK(synced, "the disk takes a row");
    took.push_back(std::chrono::duration<double>(Clock::now() - began).count());
  }
  std::sort(took.begin(), took.end());
  std::printf("the disk alone: a row appended and synced, median %.2f ms\n",
              1e3 * took[took.size() / 2]);
}

/// Prints the coordinator's memory while `count` workers connect, one after the other.
void memory(int count) {
  Coordinator farm;
  submit(farm.people(), 3840, 2160);
  const link::JoinString join = farm.workers();
  const double empty = usage_of(farm.process.pid()).resident_mb;
  std::vector<std::unique_ptr<NullWorker>> workers;
  for (int i = 0; i < count; ++i) {
    workers.push_back(std::make_unique<NullWorker>(join, connect(join), i));
    if ((i + 1) % 100 == 0) {  // heartbeats, so that the first workers do not count as lost
      for (const auto& worker : workers) {
        worker->beat();
      }
    }
    if (i + 1 == count / 4 || i + 1 == count / 2 || i + 1 == count) {
      const double now = usage_of(farm.process.pid()).resident_mb;
      std::printf("%d workers, one 4K job: coordinator %.0f MB resident, %.0f kB a worker\n", i + 1,
                  now, 1e3 * (now - empty) / (i + 1));
    }
  }
}

}  // namespace
}  // namespace bandsaw

int main(int argc, char** argv) {
  bandsaw::disk(/*seconds=*/2);
  for (const int workers : {1, 4, 5, 6, 16}) {
    bandsaw::bands(argc > 1 ? std::atof(argv[1]) : 10, workers);
  }
  bandsaw::memory(argc > 2 ? std::atoi(argv[2]) : 1'000);
}
