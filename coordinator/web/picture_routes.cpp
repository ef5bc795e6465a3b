// The handlers of a job's pictures: previews, finished images, and reports.

#include <functional>
#include <tuple>
#include <utility>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "coordinator/web/reply.h"
#include "coordinator/web/routes.h"

namespace bandsaw::coordinator {
namespace {

constexpr std::uint32_t kMinPictureSide = 64;
constexpr std::uint32_t kMaxPictureSide = 2048;

/// Returns the limit of a picture's width and height that the request asks for, in pixels. The
/// result is rounded up to one of a few sizes, so that few different pictures are made.
std::uint32_t side_of(const HttpRequest& request) {
  std::uint32_t wanted = 0;
  if (!absl::SimpleAtoi(request.parameter("side"), &wanted)) {
    wanted = 1024;
  }
  std::uint32_t side = kMinPictureSide;
  while (side < wanted && side < kMaxPictureSide) {
    side *= 2;
  }
  return side;
}

HttpReply send(const absl::StatusOr<Pictures::Bytes>& bytes, const char* type) {
  if (!bytes.ok()) {
    return refuse(bytes.status());
  }
  return {.type = type, .bytes = **bytes, .held = *bytes};
}

using Make = std::function<absl::StatusOr<Pictures::Bytes>(JobId)>;

/// Adds the handler of /api/jobs/ID/`what`.`suffix`, a file of a finished job. `make` returns the
/// bytes of the file.
void add_file(Router& router, const std::string& what, const std::string& suffix, const char* type,
              Make make) {
  router.get(absl::StrCat("/api/jobs/*/", what, ".", suffix),
             [suffix, type, make = std::move(make)](const HttpRequest& request) {
               const auto job = job_of(request);
               if (!job.ok()) {
                 return refuse(job.status());
               }
               HttpReply file = send(make(*job), type);
               file.headers.emplace_back(
                   "Content-Disposition",
                   absl::StrCat("inline; filename=\"job-", *job, ".", suffix, "\""));
               return file;
             });
}

}  // namespace

void add_pictures(Router& router, Pictures& pictures, const MakeReport& report) {
  for (const auto& [suffix, format, type] :
       {std::tuple{"png", ImageFormat::kPng, "image/png"},
        std::tuple{"pfm", ImageFormat::kPfm, "image/x-portable-floatmap"}}) {
    router.get(absl::StrCat("/api/jobs/*/preview.", suffix),
               [&pictures, format = format, type = type](const HttpRequest& request) {
                 const auto job = job_of(request);
                 return job.ok() ? send(pictures.preview(*job, side_of(request), format), type)
                                 : refuse(job.status());
               });
  }
  add_file(router, "image", "png", "image/png",
           [&pictures](JobId job) { return pictures.image(job, ImageFormat::kPng); });
  add_file(router, "image", "exr", "image/x-exr",
           [&pictures](JobId job) { return pictures.image(job, ImageFormat::kExr); });
  add_file(router, "image", "pfm", "image/x-portable-floatmap",
           [&pictures](JobId job) { return pictures.image(job, ImageFormat::kPfm); });
  add_file(router, "report", "json", "application/json",
           [&pictures, &report](JobId job) { return pictures.report(job, report); });
}

}  // namespace bandsaw::coordinator
