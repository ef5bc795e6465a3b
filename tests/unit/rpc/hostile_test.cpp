// Hostile clients: many connections, repeated requests, names that look like paths. Other clients
// are served at the same time, and nothing is leaked. Other files test wrong secrets and roles
// (gate_test), wrong certificates (link/channel_test) and sizes beyond the limits (chunks_test).

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <filesystem>
#include <set>

#include "tests/unit/rpc/farm.h"

namespace bandsaw::coordinator {
namespace {

class HostileTest : public FarmTest {
 protected:
  ~HostileTest() override { hang_up(); }

  /// Raises the limit of open files of this process, which holds both ends of each connection.
  /// Returns true if the process may then open `files` files.
  static bool may_open(std::size_t files) {
    rlimit limit{};
    getrlimit(RLIMIT_NOFILE, &limit);
    limit.rlim_cur = limit.rlim_max;
    return setrlimit(RLIMIT_NOFILE, &limit) == 0 && limit.rlim_cur >= files;
  }

  /// Connects to the coordinator's port and sends only these bytes.
  void dial(const std::string& words) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(server_->port()));
    inet_pton(AF_INET, "127.0.0.1", &address.sin_addr);
    sockets_.push_back(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
    ASSERT_EQ(connect(sockets_.back(), reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
    send(sockets_.back(), words.data(), words.size(), MSG_NOSIGNAL);
  }
  void hang_up() {
    for (const int one : sockets_) {
      close(one);
    }
    sockets_.clear();
  }

  static std::size_t open_files() {
    const std::filesystem::directory_iterator all("/proc/self/fd");
    return static_cast<std::size_t>(std::distance(begin(all), end(all)));
  }

  /// Makes the call About over a new connection.
  grpc::Status ask_as_newcomer() {
    const auto connected = link::connect(join(link::Role::kFarm), std::chrono::seconds(60));
    EXPECT_TRUE(connected.ok()) << connected.status();
    farm::AboutReply reply;
    return farm::Farm::NewStub(connected->control)
        ->About(context(link::Role::kFarm).get(), {}, &reply);
  }

  std::uint64_t submit(const farm::SubmitRequest& request) {
    farm::SubmitReply reply;
    const auto status = people()->Submit(context(link::Role::kFarm).get(), request, &reply);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return reply.job();
  }

  std::vector<int> sockets_;
};

// The first bytes of a TLS handshake: the beginning of a record of 512 bytes.
const std::string kHalfHello("\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03", 11);

TEST_F(HostileTest, AThousandConnectionsDoNotBlockOthersAndLeakNothing) {
  if (!may_open(4096)) {
    GTEST_SKIP() << "needs 4,096 open files (ulimit -Hn)";
  }
  ASSERT_TRUE(ask_as_newcomer().ok());
  const std::size_t before = open_files();
  for (int i = 0; i < 1000; ++i) {
    dial(i % 3 == 0 ? "" : i % 3 == 1 ? kHalfHello : "GET / HTTP/1.1\r\n\r\n");
  }
  const grpc::Status asked = ask_as_newcomer();
  EXPECT_TRUE(asked.ok()) << asked.error_message();
  EXPECT_TRUE(put_blob({whole("still stored")}).ok());
  hang_up();
  while (open_files() > before + 8) {  // the connections of other clients may remain for a moment
    ASSERT_TRUE(ask_as_newcomer().ok());
  }
}

TEST_F(HostileTest, AnUnfinishedHandshakeIsClosed) {
  dial("");
  dial(kHalfHello);
  for (const int one : sockets_) {
    pollfd readable{.fd = one, .events = POLLIN, .revents = 0};
    ASSERT_EQ(poll(&readable, 1, 60'000), 1) << "the coordinator did not close the connection";
    char byte = 0;
    while (recv(one, &byte, 1, 0) > 0) {
    }
  }
}

TEST_F(HostileTest, RepeatedMessagesCountOnce) {
  const wire::Digest manifest = put_cornell_box();
  const farm::SubmitRequest request = cornell_request(manifest);
  const std::uint64_t job = submit(request);
  EXPECT_EQ(submit(request), job);
  farm::ListJobsReply jobs;
  ASSERT_TRUE(people()->ListJobs(context(link::Role::kFarm).get(), {}, &jobs).ok());
  EXPECT_EQ(jobs.job_size(), 1);
  farm::CancelRequest cancel;
  cancel.set_job(job);
  for (int i = 0; i < 2; ++i) {
    farm::JobStatus status;
    ASSERT_TRUE(people()->Cancel(context(link::Role::kFarm).get(), cancel, &status).ok());
    EXPECT_EQ(status.state(), farm::JOB_STATE_CANCELLED);
  }
  EXPECT_EQ(submit(request), job) << "a repeated request must return the cancelled job";
}

TEST_F(HostileTest, NamesAreNeverPaths) {
  const std::string beyond = "../../../../../../../tmp/bandsaw-beyond";
  farm::SubmitRequest request = cornell_request(put_cornell_box());
  request.set_name(beyond);
  submit(request);
  request.set_request_id(beyond);
  farm::SubmitReply reply;
  EXPECT_EQ(people()->Submit(context(link::Role::kFarm).get(), request, &reply).error_code(),
            grpc::StatusCode::INVALID_ARGUMENT);
  farm::LogsRequest logs;
  logs.set_worker("../../../../../../../etc/passwd");
  farm::LogsReply lines;
  EXPECT_EQ(people()->Logs(context(link::Role::kFarm).get(), logs, &lines).error_code(),
            grpc::StatusCode::NOT_FOUND);
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_.path())) {
    names.insert(entry.path().filename().string());
  }
  for (const std::string& name : names) {
    EXPECT_EQ(name.find("beyond"), std::string::npos) << name;
  }
  EXPECT_FALSE(std::filesystem::exists("/tmp/bandsaw-beyond"));
}

}  // namespace
}  // namespace bandsaw::coordinator
