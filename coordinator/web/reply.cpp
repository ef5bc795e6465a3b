// Converts protobuf messages to JSON with the field names of the .proto file. An error status
// becomes an HTTP status and a JSON object that has the error's text.

#include "coordinator/web/reply.h"

#include <google/protobuf/util/json_util.h>

#include <string>

#include "absl/strings/str_cat.h"
#include "proto/web.pb.h"
#include "renderlib/base/status_macros.h"

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

HttpReply reply(const google::protobuf::Message& message) {
  return text_reply(json_of(message), "application/json");
}

HttpReply refuse(const absl::Status& status) {
  web::Problem problem;
  problem.set_error(std::string(status.message()));
  HttpReply refusal = reply(problem);
  refusal.status = http_status(status.code());
  return refusal;
}

absl::Status read_json(const HttpBody& body, google::protobuf::Message& message, std::size_t most) {
  std::string json;
  while (true) {
    ASSIGN_OR_RETURN(const absl::string_view bytes, body());
    if (bytes.empty()) {
      break;
    }
    if (bytes.size() > most - json.size()) {
      return absl::InvalidArgumentError(
          absl::StrCat("the body must have at most ", most, " bytes"));
    }
    json.append(bytes.data(), bytes.size());
  }
  const auto status = google::protobuf::util::JsonStringToMessage(json, &message);
  return status.ok() ? absl::OkStatus()
                     : absl::InvalidArgumentError(
                           absl::StrCat("the body is not the JSON that is expected here: ",
                                        std::string(status.message())));
}

}  // namespace bandsaw::coordinator
