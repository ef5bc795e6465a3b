#include "coordinator/web/reply.h"

#include <google/protobuf/util/json_util.h>

#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "proto/web.pb.h"

namespace bandsaw::coordinator {
namespace {

int http_status(absl::StatusCode code) {
  switch (code) {
    case absl::StatusCode::kInvalidArgument:
    case absl::StatusCode::kDataLoss:
      return 400;
    case absl::StatusCode::kUnauthenticated:
      return 401;
    case absl::StatusCode::kPermissionDenied:
      return 403;
    case absl::StatusCode::kNotFound:
      return 404;
    case absl::StatusCode::kFailedPrecondition:
      return 409;
    case absl::StatusCode::kResourceExhausted:
      return 429;
    case absl::StatusCode::kUnavailable:
    case absl::StatusCode::kCancelled:
      return 503;
    case absl::StatusCode::kDeadlineExceeded:
      return 504;
    default:
      return 500;
  }
}

std::string json_of(const google::protobuf::Message& message) {
  google::protobuf::util::JsonPrintOptions options;
  options.always_print_primitive_fields = true;
  options.preserve_proto_field_names = true;
  std::string json;
  const auto status = google::protobuf::util::MessageToJsonString(message, &json, options);
  return status.ok() ? json : "{}";
}

}  // namespace

void reply(httplib::Response& response, const google::protobuf::Message& message) {
  response.set_content(json_of(message), "application/json");
}

void refuse(httplib::Response& response, const absl::Status& status) {
  web::Problem problem;
  problem.set_error(std::string(status.message()));
  response.status = http_status(status.code());
  reply(response, problem);
}

void send_bytes(httplib::Response& response, absl::string_view bytes, const char* type,
                std::shared_ptr<const void> held) {
  response.set_content_provider(
      bytes.size(), type,
      [bytes, held = std::move(held)](std::size_t offset, std::size_t length,
                                      httplib::DataSink& sink) {
        constexpr std::size_t kPiece = 1 << 20;
        if (offset >= bytes.size()) {
          return false;
        }
        return sink.write(bytes.data() + offset, std::min({length, bytes.size() - offset, kPiece}));
      });
}

absl::Status read_json(const httplib::ContentReader& reader, google::protobuf::Message& message) {
  std::string body;
  const bool read = reader([&](const char* data, std::size_t size) {
    if (size > kMostJson - body.size()) {
      return false;
    }
    body.append(data, size);
    return true;
  });
  if (!read) {
    return absl::InvalidArgumentError(
        absl::StrCat("the body must come whole and have at most ", kMostJson, " bytes"));
  }
  const auto status = google::protobuf::util::JsonStringToMessage(body, &message);
  return status.ok() ? absl::OkStatus()
                     : absl::InvalidArgumentError(
                           absl::StrCat("the body is not the JSON that is expected here: ",
                                        std::string(status.message())));
}

}  // namespace bandsaw::coordinator
