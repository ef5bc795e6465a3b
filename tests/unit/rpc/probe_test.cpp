// The health service and reflection of the gRPC server. Probes of Kubernetes and load balancers
// call the health service without a secret. The tool grpcurl lists the services by reflection.

#include <gmock/gmock.h>
#include <grpcpp/generic/generic_stub.h>

#include "proto/health.grpc.pb.h"
#include "tests/unit/rpc/farm.h"

namespace bandsaw::coordinator {
namespace {

namespace health = grpc::health::v1;
using testing::HasSubstr;

class ProbeTest : public FarmTest {
 protected:
  static grpc::Status check(const std::shared_ptr<grpc::Channel>& channel,
                            const std::string& service, health::HealthCheckResponse& reply) {
    grpc::ClientContext context;  // without a secret
    health::HealthCheckRequest request;
    request.set_service(service);
    return health::Health::NewStub(channel)->Check(&context, request, &reply);
  }

  /// Requests the list of services from the server on this port. Returns the status of the call;
  /// the bytes of the response are appended to `answer`.
  grpc::Status list_services(int port, std::string& answer) {
    link::JoinString where = join(link::Role::kFarm);
    where.addresses = {"127.0.0.1:" + std::to_string(port)};
    const auto connected = link::connect(where, std::chrono::seconds(60));
    EXPECT_TRUE(connected.ok()) << connected.status();
    grpc::ClientContext context;
    grpc::CompletionQueue queue;
    const auto wait = [&] {
      void* tag = nullptr;
      bool ok = false;
      return queue.Next(&tag, &ok) && ok;
    };
    grpc::GenericStub stub(connected->control);
    const auto call = stub.PrepareCall(
        &context, "/grpc.reflection.v1alpha.ServerReflection/ServerReflectionInfo", &queue);
    call->StartCall(nullptr);
    wait();
    const grpc::Slice request("\x3a\x01*");  // field 7, list_services: "*"
    call->Write(grpc::ByteBuffer(&request, 1), nullptr);
    wait();
    call->WritesDone(nullptr);
    wait();
    grpc::ByteBuffer reply;
    call->Read(&reply, nullptr);
    if (wait()) {
      std::vector<grpc::Slice> slices;
      EXPECT_TRUE(reply.Dump(&slices).ok());
      for (const grpc::Slice& slice : slices) {
        answer.append(reinterpret_cast<const char*>(slice.begin()), slice.size());
      }
    }
    grpc::Status status;
    call->Finish(&status, nullptr);
    wait();
    return status;
  }
};

TEST_F(ProbeTest, HealthIsAnsweredWithoutASecret) {
  for (const char* service : {"", "bandsaw.farm.Farm", "bandsaw.farm.Work"}) {
    health::HealthCheckResponse reply;
    const grpc::Status status = check(channel(), service, reply);
    EXPECT_TRUE(status.ok()) << status.error_message();
    EXPECT_EQ(reply.status(), health::HealthCheckResponse::SERVING);
  }
  health::HealthCheckResponse reply;
  EXPECT_EQ(check(channel(), "nothing", reply).error_code(), grpc::StatusCode::NOT_FOUND);
}

TEST_F(ProbeTest, TheStreamOfHealthStatesIsNotImplemented) {
  grpc::ClientContext context;
  const auto reader = health::Health::NewStub(channel())->Watch(&context, {});
  health::HealthCheckResponse reply;
  EXPECT_FALSE(reader->Read(&reply));
  EXPECT_EQ(reader->Finish().error_code(), grpc::StatusCode::UNIMPLEMENTED);
}

TEST_F(ProbeTest, ReflectionIsOffByDefault) {
  std::string answer;
  EXPECT_EQ(list_services(server_->port(), answer).error_code(), grpc::StatusCode::UNIMPLEMENTED);
  EXPECT_EQ(answer, "");
  const auto reflecting =
      Server::start(*engine_, identity_, {.listen = "127.0.0.1:0", .reflection = true});
  ASSERT_TRUE(reflecting.ok()) << reflecting.status();
  EXPECT_TRUE(list_services((*reflecting)->port(), answer).ok());
  EXPECT_THAT(answer, HasSubstr("bandsaw.farm.Farm"));
  EXPECT_THAT(answer, HasSubstr("grpc.health.v1.Health"));
}

}  // namespace
}  // namespace bandsaw::coordinator
