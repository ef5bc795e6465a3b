// Previews, images, and what is said of them.

#include <functional>
#include <utility>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "coordinator/web/reply.h"
#include "coordinator/web/routes.h"

namespace bandsaw::coordinator {
namespace {

constexpr std::uint32_t kSmallestSide = 64;
constexpr std::uint32_t kLargestSide = 2048;

/// Few sizes, so that few are made.
std::uint32_t side_of(const httplib::Request& request) {
  std::uint32_t wanted = 0;
  if (!absl::SimpleAtoi(request.get_param_value("side"), &wanted)) {
    wanted = 1024;
  }
  std::uint32_t side = kSmallestSide;
  while (side < wanted && side < kLargestSide) {
    side *= 2;
  }
  return side;
}

void send(httplib::Response& response, const absl::StatusOr<Pictures::Bytes>& bytes,
          const char* type) {
  if (!bytes.ok()) {
    refuse(response, bytes.status());
    return;
  }
  const auto& held = **bytes;
  send_bytes(response, {reinterpret_cast<const char*>(held.data()), held.size()}, type, *bytes);
}

using Make = std::function<absl::StatusOr<Pictures::Bytes>(JobId)>;

/// A file of a finished job: `what`.`suffix`.
void add_file(HttpServer& server, const std::string& what, const std::string& suffix,
              const char* type, Make make) {
  server.Get(absl::StrCat("/api/jobs/(\\d{1,19})/", what, "\\.", suffix),
             [suffix, type, make = std::move(make)](const httplib::Request& request,
                                                    httplib::Response& response) {
               const auto job = job_of(request);
               if (!job.ok()) {
                 refuse(response, job.status());
                 return;
               }
               response.set_header("Content-Disposition", absl::StrCat("inline; filename=\"job-",
                                                                       *job, ".", suffix, "\""));
               send(response, make(*job), type);
             });
}

}  // namespace

void add_pictures(HttpServer& server, Pictures& pictures, const TellReport& report) {
  server.Get("/api/jobs/(\\d{1,19})/preview\\.png",
             [&pictures](const httplib::Request& request, httplib::Response& response) {
               const auto job = job_of(request);
               if (!job.ok()) {
                 refuse(response, job.status());
                 return;
               }
               send(response, pictures.preview(*job, side_of(request)), "image/png");
             });
  add_file(server, "image", "png", "image/png",
           [&pictures](JobId job) { return pictures.image(job, ImageFormat::kPng); });
  add_file(server, "image", "exr", "image/x-exr",
           [&pictures](JobId job) { return pictures.image(job, ImageFormat::kExr); });
  add_file(server, "report", "json", "application/json",
           [&pictures, &report](JobId job) { return pictures.report(job, report); });
}

}  // namespace bandsaw::coordinator
