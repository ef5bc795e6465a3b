// Connections by a join string, which names addresses of a farm, the digest of its certificate and
// a secret. The server's certificate is checked before the secret is sent, and the addresses are
// tried in turn.

#include "proto/link/channel.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/x509.h>

#include "proto/farm.grpc.pb.h"
#include "proto/link/certificate.h"
#include "proto/link/identity.h"
#include "tests/support/temp_dir.h"

namespace bandsaw::link {
namespace {

using std::chrono::milliseconds;
using ::testing::HasSubstr;

/// A server that answers a call of ListJobs with the secret of the call, as the name of a job.
class Echo : public farm::Farm::Service {
  grpc::Status ListJobs(grpc::ServerContext* context, const farm::ListJobsRequest*,
                        farm::ListJobsReply* reply) override {
    const auto& metadata = context->client_metadata();
    const auto secret = metadata.find(kSecretKey);
    reply->add_job()->set_name(secret == metadata.end()
                                   ? std::string()
                                   : std::string(secret->second.data(), secret->second.size()));
    return grpc::Status::OK;
  }
};

/// Runs an Echo on loopback. `wanted_port`: the port; 0 for any free one.
struct EchoServer {
  Echo service;
  int port = 0;
  std::unique_ptr<grpc::Server> server;

  EchoServer(std::shared_ptr<grpc::ServerCredentials> credentials, int wanted_port = 0) {
    grpc::ServerBuilder builder;
    configure_server(builder);
    builder.AddListeningPort("127.0.0.1:" + std::to_string(wanted_port), std::move(credentials),
                             &port);
    builder.RegisterService(&service);
    server = builder.BuildAndStart();
  }
};

/// Returns the credentials of a server that has the certificate of `identity`.
std::shared_ptr<grpc::ServerCredentials> tls(const Identity& identity) {
  grpc::SslServerCredentialsOptions options;
  options.pem_key_cert_pairs.push_back({identity.key_pem, identity.certificate_pem});
  return grpc::SslServerCredentials(options);
}

/// Returns a join string for a port on loopback. `digest`: digest of the certificate; std::nullopt:
/// plaintext.
JoinString join_to(int port, std::optional<wire::Digest> digest) {
  JoinString join;
  join.addresses = {"127.0.0.1:" + std::to_string(port)};
  join.certificate = digest;
  join.secret = "abcdefghijklmnopqrstuv";
  return join;
}

/// Moves the start of the certificate's validity to `seconds` after now. Then signs the certificate
/// again.
void make_valid_from(Identity& identity, long seconds) {
  const std::unique_ptr<BIO, decltype(&BIO_free_all)> bio(BIO_new(BIO_s_mem()), &BIO_free_all);
  BIO_puts(bio.get(), (identity.certificate_pem + identity.key_pem).c_str());
  const std::unique_ptr<X509, decltype(&X509_free)> certificate(
      PEM_read_bio_X509(bio.get(), nullptr, nullptr, nullptr), &X509_free);
  const std::unique_ptr<EVP_PKEY, decltype(&EVP_PKEY_free)> key(
      PEM_read_bio_PrivateKey(bio.get(), nullptr, nullptr, nullptr), &EVP_PKEY_free);
  X509_gmtime_adj(X509_getm_notBefore(certificate.get()), seconds);
  X509_sign(certificate.get(), key.get(), EVP_sha256());
  PEM_write_bio_X509(bio.get(), certificate.get());
  char* text = nullptr;
  const long size = BIO_get_mem_data(bio.get(), &text);
  identity.certificate_pem.assign(text, static_cast<std::size_t>(size));
  identity.certificate_digest = *certificate_digest(identity.certificate_pem);
}

/// Expects that calls on both channels of the connection, `control` and `bulk`, arrive with the
/// secret of the join string.
void expect_calls_work(const Connected& connected, const JoinString& join) {
  for (const auto& channel : {connected.control, connected.bulk}) {
    grpc::ClientContext context;
    prepare(context, join, milliseconds(10'000));
    farm::ListJobsReply reply;
    const grpc::Status status =
        farm::Farm::NewStub(channel)->ListJobs(&context, farm::ListJobsRequest(), &reply);
    ASSERT_TRUE(status.ok()) << status.error_message();
    EXPECT_EQ(reply.job(0).name(), join.secret);
  }
}

class ConnectTest : public ::testing::Test {
 protected:
  test::TempDir folder_;
  Identity identity_ = *load_or_make_identity(folder_.path());
};

TEST_F(ConnectTest, TrustsTheCertificateThatTheStringNames) {
  const EchoServer server(tls(identity_));
  const JoinString join = join_to(server.port, identity_.certificate_digest);
  const absl::StatusOr<Connected> connected = connect(join, milliseconds(10'000));
  ASSERT_TRUE(connected.ok()) << connected.status();
  expect_calls_work(*connected, join);
}

TEST_F(ConnectTest, TriesNoAddressOnceItIsStopped) {
  const EchoServer server(tls(identity_));
  const absl::Status status =
      connect(join_to(server.port, identity_.certificate_digest), milliseconds(10'000), [] {
        return true;
      }).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kUnavailable);
  EXPECT_THAT(std::string(status.message()), HasSubstr("interrupted"));
}

TEST_F(ConnectTest, RefusesAnotherCertificateBeforeAnyCall) {
  const EchoServer server(tls(identity_));
  const absl::Status status =
      connect(join_to(server.port, wire::sha256("another")), milliseconds(10'000)).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kUnauthenticated);
  EXPECT_THAT(std::string(status.message()), HasSubstr("another certificate"));
}

// Join strings name addresses that every machine has, such as loopback. Another farm may run at
// such an address, while the right farm exists and is unreachable at the moment. So the error must
// be UNAVAILABLE, as for a farm that does not answer, and not UNAUTHENTICATED.
TEST_F(ConnectTest, AnotherFarmOnThisMachineDoesNotHideThatTheRightFarmIsUnreachable) {
  const EchoServer server(tls(identity_));
  for (const std::string host : {"127.0.0.1", "localhost"}) {
    JoinString join = join_to(server.port, wire::sha256("another"));
    join.addresses = {"127.0.0.2:1", host + ":" + std::to_string(server.port)};
    const absl::Status status = connect(join, milliseconds(10'000)).status();
    EXPECT_EQ(status.code(), absl::StatusCode::kUnavailable) << host;
    EXPECT_THAT(std::string(status.message()), HasSubstr("another certificate")) << host;
  }
}

TEST_F(ConnectTest, TriesTheNextAddress) {
  const EchoServer server(tls(identity_));
  JoinString join = join_to(server.port, identity_.certificate_digest);
  join.addresses.insert(join.addresses.begin(), {"127.0.0.1:1", "no-such-host.invalid:7878"});
  const absl::StatusOr<Connected> connected = connect(join, milliseconds(10'000));
  ASSERT_TRUE(connected.ok()) << connected.status();
  EXPECT_EQ(connected->address, join.addresses[2]);
}

TEST_F(ConnectTest, ReportsARefusedConnection) {
  const absl::Status status = connect(join_to(1, wire::Digest()), milliseconds(10'000)).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kUnavailable);
  EXPECT_EQ(status.message(), "no coordinator answers at 127.0.0.1:1: connection refused");
}

TEST_F(ConnectTest, ReportsAPlaintextServer) {
  const EchoServer server(grpc::InsecureServerCredentials());
  const absl::Status status =
      connect(join_to(server.port, identity_.certificate_digest), milliseconds(3'000)).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kUnavailable);
}

TEST_F(ConnectTest, TellsThatTheClockIsWrong) {
  make_valid_from(identity_, 48 * 60 * 60);
  const EchoServer server(tls(identity_));
  const absl::Status status =
      connect(join_to(server.port, identity_.certificate_digest), milliseconds(10'000)).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kUnavailable);
  // The 2 is the first digit of the year.
  EXPECT_THAT(std::string(status.message()), HasSubstr("this machine's clock says 2"));
  EXPECT_THAT(std::string(status.message()), HasSubstr("set the clock"));
}

TEST_F(ConnectTest, FetchingACertificateNeitherReadsNorLeavesErrorsOfOpenSsl) {
  const EchoServer server(tls(identity_));
  ERR_raise(ERR_LIB_USER, ERR_R_INTERNAL_ERROR);  // an old error in this thread's queue
  const auto pem =
      fetch_certificate_pem("127.0.0.1:" + std::to_string(server.port), milliseconds(3'000));
  ASSERT_TRUE(pem.ok()) << pem.status();
  EXPECT_EQ(*pem, identity_.certificate_pem);
  const EchoServer plaintext(grpc::InsecureServerCredentials());
  EXPECT_FALSE(
      fetch_certificate_pem("127.0.0.1:" + std::to_string(plaintext.port), milliseconds(3'000))
          .ok());
  EXPECT_EQ(ERR_peek_error(), 0u);
}

TEST_F(ConnectTest, UsesPlaintextOnlyIfTheJoinStringSaysSo) {
  const EchoServer server(grpc::InsecureServerCredentials());
  const JoinString join = join_to(server.port, std::nullopt);
  const absl::StatusOr<Connected> connected = connect(join, milliseconds(10'000));
  ASSERT_TRUE(connected.ok()) << connected.status();
  expect_calls_work(*connected, join);
}

TEST_F(ConnectTest, SecondServerOnAPortDoesNotStart) {
  const EchoServer first(tls(identity_));
  const EchoServer second(tls(identity_), first.port);
  EXPECT_TRUE(second.server == nullptr || second.port == 0);
}

TEST(Status, KeepsCodeAndMessageBothWays) {
  for (int code = 0; code <= 16; ++code) {
    const absl::Status status(static_cast<absl::StatusCode>(code), code == 0 ? "" : "why");
    EXPECT_EQ(from_grpc(to_grpc(status)), status);
  }
}

}  // namespace
}  // namespace bandsaw::link
