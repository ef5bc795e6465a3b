// Tests of access control. A client has the role kFarm (users) or kWorker (workers), and each role
// has a secret. Each call in the list calls() is made with the secret of each role, with a wrong
// secret, and without a secret.

#include <gmock/gmock.h>

#include <optional>

#include "tests/unit/rpc/farm.h"

namespace bandsaw::coordinator {
namespace {

using Call = std::function<grpc::Status(grpc::ClientContext&)>;

struct NamedCall {
  std::string name;
  std::optional<link::Role> role;  ///< the role whose secret is required; std::nullopt: either
  Call call;
};

/// Reads all messages of a stream, and returns its status.
template <class Reader, class Message>
grpc::Status drain(Reader& reader) {
  Message message;
  while (reader.Read(&message)) {
  }
  return reader.Finish();
}

class GateTest : public FarmTest {
 protected:
  /// Returns all calls of the protocol, with empty requests.
  std::vector<NamedCall> calls() {
    const auto farm_role = link::Role::kFarm;
    const auto work_role = link::Role::kWorker;
    return {
        {"MissingBlobs", farm_role,
         [this](auto& c) {
           farm::MissingBlobsReply reply;
           return people()->MissingBlobs(&c, {}, &reply);
         }},
        {"PutBlob", farm_role,
         [this](auto& c) {
           farm::PutBlobReply reply;
           const auto writer = people()->PutBlob(&c, &reply);
           writer->WritesDone();
           return writer->Finish();
         }},
        {"Submit", farm_role,
         [this](auto& c) {
           farm::SubmitReply reply;
           return people()->Submit(&c, {}, &reply);
         }},
        {"SubmitSequence", farm_role,
         [this](auto& c) {
           farm::SubmitReply reply;
           return people()->SubmitSequence(&c, {}, &reply);
         }},
        {"AddFrames", farm_role,
         [this](auto& c) {
           farm::JobStatus reply;
           return people()->AddFrames(&c, {}, &reply);
         }},
        {"RetryFrames", farm_role,
         [this](auto& c) {
           farm::JobStatus reply;
           return people()->RetryFrames(&c, {}, &reply);
         }},
        {"ListFrames", farm_role,
         [this](auto& c) {
           farm::ListFramesReply reply;
           return people()->ListFrames(&c, {}, &reply);
         }},
        {"Watch", farm_role,
         [this](auto& c) {
           const auto reader = people()->Watch(&c, {});
           return drain<grpc::ClientReader<farm::JobStatus>, farm::JobStatus>(*reader);
         }},
        {"GetResult", farm_role,
         [this](auto& c) {
           const auto reader = people()->GetResult(&c, {});
           return drain<grpc::ClientReader<farm::ResultChunk>, farm::ResultChunk>(*reader);
         }},
        {"Preview", farm_role,
         [this](auto& c) {
           const auto reader = people()->Preview(&c, {});
           return drain<grpc::ClientReader<farm::ResultChunk>, farm::ResultChunk>(*reader);
         }},
        {"ListJobs", farm_role,
         [this](auto& c) {
           farm::ListJobsReply reply;
           return people()->ListJobs(&c, {}, &reply);
         }},
        {"ListWorkers", farm_role,
         [this](auto& c) {
           farm::ListWorkersReply reply;
           return people()->ListWorkers(&c, {}, &reply);
         }},
        {"Cancel", farm_role,
         [this](auto& c) {
           farm::JobStatus reply;
           return people()->Cancel(&c, {}, &reply);
         }},
        {"Pause", farm_role,
         [this](auto& c) {
           farm::JobStatus reply;
           return people()->Pause(&c, {}, &reply);
         }},
        {"Resume", farm_role,
         [this](auto& c) {
           farm::JobStatus reply;
           return people()->Resume(&c, {}, &reply);
         }},
        {"SetPriority", farm_role,
         [this](auto& c) {
           farm::JobStatus reply;
           return people()->SetPriority(&c, {}, &reply);
         }},
        {"Why", farm_role,
         [this](auto& c) {
           farm::WhyReply reply;
           return people()->Why(&c, {}, &reply);
         }},
        {"Logs", farm_role,
         [this](auto& c) {
           farm::LogsReply reply;
           return people()->Logs(&c, {}, &reply);
         }},
        {"Quarantine", farm_role,
         [this](auto& c) {
           farm::QuarantineReply reply;
           return people()->Quarantine(&c, {}, &reply);
         }},
        {"About", std::nullopt,
         [this](auto& c) {
           farm::AboutReply reply;
           return people()->About(&c, {}, &reply);
         }},
        {"RotateSecret", farm_role,
         [this](auto& c) {
           farm::RotateSecretReply reply;
           return people()->RotateSecret(&c, {}, &reply);
         }},
        {"BrowserLink", farm_role,
         [this](auto& c) {
           farm::BrowserLinkReply reply;
           return people()->BrowserLink(&c, {}, &reply);
         }},
        {"Session", work_role,
         [this](auto& c) {
           const auto stream = work()->Session(&c);
           stream->WritesDone();
           return drain<grpc::ClientReaderWriter<farm::FromWorker, farm::ToWorker>, farm::ToWorker>(
               *stream);
         }},
        {"GetBlob", work_role,
         [this](auto& c) {
           const auto reader = work()->GetBlob(&c, {});
           return drain<grpc::ClientReader<farm::BlobChunk>, farm::BlobChunk>(*reader);
         }},
        {"PutBands", work_role,
         [this](auto& c) {
           const auto stream = work()->PutBands(&c);
           stream->WritesDone();
           return drain<grpc::ClientReaderWriter<farm::BandChunk, farm::PutBandReply>,
                        farm::PutBandReply>(*stream);
         }},
    };
  }

  /// Returns true if access was refused. Any other error shows that access was granted; most calls
  /// here fail because their request is empty.
  static bool refused(const grpc::Status& status) {
    return status.error_code() == grpc::StatusCode::UNAUTHENTICATED ||
           status.error_code() == grpc::StatusCode::PERMISSION_DENIED;
  }
};

TEST_F(GateTest, ListsEachCallOfTheProtocol) {
  std::vector<std::string> tested;
  for (const NamedCall& named : calls()) {
    tested.push_back(named.name);
  }
  std::vector<std::string> declared;
  const google::protobuf::FileDescriptor* const file = farm::SubmitRequest::descriptor()->file();
  for (int i = 0; i < file->service_count(); ++i) {
    for (int j = 0; j < file->service(i)->method_count(); ++j) {
      declared.emplace_back(file->service(i)->method(j)->name());
    }
  }
  EXPECT_THAT(tested, ::testing::UnorderedElementsAreArray(declared));
}

TEST_F(GateTest, AdmitsTheRoleOfEachCall) {
  for (const NamedCall& named : calls()) {
    for (const link::Role role : {link::Role::kFarm, link::Role::kWorker}) {
      if (named.role.value_or(role) == role) {
        const grpc::Status status = named.call(*context(role));
        EXPECT_FALSE(refused(status)) << named.name << ": " << status.error_message();
      }
    }
  }
}

TEST_F(GateTest, RefusesTheOtherRole) {
  for (const NamedCall& named : calls()) {
    if (!named.role) {
      continue;
    }
    const auto other = *named.role == link::Role::kFarm ? link::Role::kWorker : link::Role::kFarm;
    const grpc::Status status = named.call(*context(other));
    EXPECT_EQ(status.error_code(), grpc::StatusCode::PERMISSION_DENIED) << named.name;
    EXPECT_THAT(status.error_message(), ::testing::HasSubstr("join string")) << named.name;
  }
}

TEST_F(GateTest, RefusesAWrongSecret) {
  for (const NamedCall& named : calls()) {
    for (const std::string& secret :
         {std::string(22, 'A'), std::string(), identity_.farm_secret + "A"}) {
      grpc::ClientContext wrong;
      wrong.AddMetadata(link::kSecretKey, secret);
      EXPECT_EQ(named.call(wrong).error_code(), grpc::StatusCode::UNAUTHENTICATED) << named.name;
    }
  }
}

TEST_F(GateTest, RefusesACallWithoutASecret) {
  for (const NamedCall& named : calls()) {
    grpc::ClientContext none;
    EXPECT_EQ(named.call(none).error_code(), grpc::StatusCode::UNAUTHENTICATED) << named.name;
  }
}

}  // namespace
}  // namespace bandsaw::coordinator
