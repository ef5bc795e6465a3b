// The handlers of requests for the clean (denoised) picture of a job (proto/web.proto). A POST of
// /api/jobs/ID/clean requests the picture, and a GET returns its state. /api/jobs/ID/clean.png,
// .exr and .pfm return the picture as a file.

#include <tuple>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "coordinator/web/reply.h"
#include "coordinator/web/routes.h"
#include "proto/web.pb.h"

namespace bandsaw::coordinator {
namespace {

const char* stage_name(CleanPictures::Stage stage) {
  switch (stage) {
    case CleanPictures::Stage::kNone:
      return "none";
    case CleanPictures::Stage::kGuides:
      return "guides";
    case CleanPictures::Stage::kFiltering:
      return "filtering";
    case CleanPictures::Stage::kReady:
      return "ready";
    case CleanPictures::Stage::kFailed:
      return "failed";
  }
  return "";
}

/// Returns the state of a clean picture as a web::CleanPicture, or the error.
HttpReply answer_with(const absl::StatusOr<CleanPictures::State>& state) {
  if (!state.ok()) {
    return refuse(state.status());
  }
  web::CleanPicture message;
  message.set_state(stage_name(state->stage));
  message.set_fraction(state->fraction);
  message.set_reason(std::string(state->why.message()));
  message.set_relative_rmse_raw(state->error.relative_raw());
  message.set_relative_rmse_clean(state->error.relative_clean());
  message.set_bias_share(state->error.bias_share);
  return reply(message);
}

/// Answers a request for a file of a clean picture. The request's parameter `side` limits the
/// number of pixels per side; without this parameter the picture is not reduced.
HttpReply file(CleanPictures& pictures, const HttpRequest& request, ImageFormat format,
               const char* suffix, const char* type) {
  const auto job = job_of(request);
  if (!job.ok()) {
    return refuse(job.status());
  }
  std::uint32_t side = 0;
  const std::string wanted = request.parameter("side");
  if (!wanted.empty() && !absl::SimpleAtoi(wanted, &side)) {
    return refuse(absl::InvalidArgumentError("side: must be a number of pixels"));
  }
  const absl::StatusOr<CleanPictures::Bytes> bytes = pictures.file(*job, side, format);
  if (!bytes.ok()) {
    return refuse(bytes.status());
  }
  HttpReply out{.type = type, .bytes = **bytes, .held = *bytes};
  out.headers.emplace_back("Content-Disposition",
                           absl::StrCat("inline; filename=\"job-", *job, "-clean.", suffix, "\""));
  return out;
}

}  // namespace

void add_clean_pictures(Router& router, CleanPictures& pictures) {
  router.get("/api/jobs/*/clean", [&pictures](const HttpRequest& request) {
    const auto job = job_of(request);
    return job.ok() ? answer_with(pictures.state(*job)) : refuse(job.status());
  });
  router.post("/api/jobs/*/clean", [&pictures](const HttpRequest& request, const HttpBody&) {
    const auto job = job_of(request);
    return job.ok() ? answer_with(pictures.start(*job)) : refuse(job.status());
  });
  for (const auto& [suffix, format, type] :
       {std::tuple{"png", ImageFormat::kPng, "image/png"},
        std::tuple{"exr", ImageFormat::kExr, "image/x-exr"},
        std::tuple{"pfm", ImageFormat::kPfm, "image/x-portable-floatmap"}}) {
    router.get(
        absl::StrCat("/api/jobs/*/clean.", suffix),
        [&pictures, suffix = suffix, format = format, type = type](const HttpRequest& request) {
          return file(pictures, request, format, suffix, type);
        });
  }
}

}  // namespace bandsaw::coordinator
