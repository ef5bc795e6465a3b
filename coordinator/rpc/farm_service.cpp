// Implements the calls of the service Farm (proto/farm.proto) that receive scenes, submit and watch
// jobs, send images, and list jobs and workers. The other calls of the service are in
// farm_service_admin.cpp, farm_service_frames.cpp and farm_service_jobs.cpp.

#include "absl/strings/str_cat.h"
#include "coordinator/convert/farm_messages.h"
#include "coordinator/rpc/checked_messages.h"
#include "coordinator/rpc/downloads.h"
#include "coordinator/rpc/gate.h"
#include "coordinator/rpc/job_replies.h"
#include "coordinator/rpc/picture.h"
#include "coordinator/rpc/services.h"
#include "coordinator/rpc/uploads.h"
#include "coordinator/rpc/watch_call.h"
#include "proto/wire/limits.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/render/settings.h"

namespace bandsaw::coordinator {
namespace {

using Unary = grpc::ServerUnaryReactor;

absl::StatusOr<std::vector<wire::Digest>> digests(const farm::MissingBlobsRequest& request) {
  if (static_cast<std::size_t>(request.sha256_size()) > wire::kDigestsPerMessage) {
    return absl::InvalidArgumentError(absl::StrCat("sha256: at most ", wire::kDigestsPerMessage,
                                                   " digests, has ", request.sha256_size()));
  }
  std::vector<wire::Digest> digests;
  for (const std::string& raw : request.sha256()) {
    ASSIGN_OR_RETURN(const wire::Digest digest, digest_field("sha256", raw));
    digests.push_back(digest);
  }
  return digests;
}

/// Adds the jobs that the request selects (`jobs`) to the reply. If the request limits the number
/// of jobs, no further job is added once half of the maximum size of a message is full. So half of
/// the message remains for the last job, which may have thousands of workers. RESOURCE_EXHAUSTED:
/// the request is for all jobs, and they do not fit into a message.
absl::Status fill(const std::vector<JobView>& jobs, const farm::ListJobsRequest& request,
                  farm::ListJobsReply& reply) {
  constexpr std::size_t kEntryHead = 8;  // at least the bytes of an entry's tag and length
  const bool paged = request.most() > 0;
  std::size_t bytes = 0;
  for (const JobView& job : jobs) {
    if (paged && bytes > wire::kMessageBytes / 2) {
      break;
    }
    farm::JobStatus entry = to_list_entry(job);
    bytes += entry.ByteSizeLong() + kEntryHead;
    if (!paged && bytes > wire::kMessageBytes) {
      return absl::ResourceExhaustedError(
          absl::StrCat("the list of all ", jobs.size(),
                       " jobs is too long for one message; a newer bandsaw gets it in parts"));
    }
    *reply.add_job() = std::move(entry);
  }
  // The engine returned at most `most` jobs. If it returned exactly `most`, more jobs may follow.
  reply.set_more(paged && (static_cast<std::size_t>(reply.job_size()) < jobs.size() ||
                           jobs.size() == request.most()));
  return absl::OkStatus();
}

}  // namespace

Unary* FarmService::MissingBlobs(grpc::CallbackServerContext* context,
                                 const farm::MissingBlobsRequest* request,
                                 farm::MissingBlobsReply* reply) {
  return unary(deps_, *context, link::Role::kFarm, [&](Unary* reactor) -> absl::Status {
    ASSIGN_OR_RETURN(std::vector<wire::Digest> requested, digests(*request));
    deps_.files.post([this, reply, reactor, requested = std::move(requested)] {
      for (const wire::Digest& digest : requested) {
        if (!deps_.engine.has_blob(digest)) {
          reply->add_sha256(digest.raw());
          reply->add_there(deps_.engine.partial_blob(digest));  // bytes of an interrupted upload
        }
      }
      reactor->Finish(grpc::Status::OK);
    });
    return absl::OkStatus();
  });
}

grpc::ServerReadReactor<farm::BlobChunk>* FarmService::PutBlob(grpc::CallbackServerContext* context,
                                                               farm::PutBlobReply*) {
  return admitted<PutBlobCall>(deps_, *context, link::Role::kFarm, context);
}

Unary* FarmService::Submit(grpc::CallbackServerContext* context, const farm::SubmitRequest* request,
                           farm::SubmitReply* reply) {
  return unary(deps_, *context, link::Role::kFarm, [&](Unary* reactor) -> absl::Status {
    ASSIGN_OR_RETURN(JobSpec spec, job_spec(*request));
    deps_.engine.submit(std::move(spec), reply_with(reactor, reply), request->priority());
    return absl::OkStatus();
  });
}

grpc::ServerWriteReactor<farm::JobStatus>* FarmService::Watch(grpc::CallbackServerContext* context,
                                                              const farm::WatchRequest* request) {
  return admitted<WatchCall>(deps_, *context, link::Role::kFarm, request->job());
}

grpc::ServerWriteReactor<farm::ResultChunk>* FarmService::GetResult(
    grpc::CallbackServerContext* context, const farm::GetResultRequest* request) {
  const FinishedPart part = request->samples()      ? FinishedPart::kSamples
                            : request->first_part() ? FinishedPart::kFirst
                                                    : FinishedPart::kImage;
  return admitted<ImageCall>(deps_, *context, link::Role::kFarm,
                             [&engine = deps_.engine, job = request->job(), part] {
                               return result_of(engine, job, part);
                             });
}

grpc::ServerWriteReactor<farm::ResultChunk>* FarmService::Preview(
    grpc::CallbackServerContext* context, const farm::PreviewRequest* request) {
  return admitted<ImageCall>(deps_, *context, link::Role::kFarm,
                             [&engine = deps_.engine, job = request->job(),
                              side = request->most_side()]() -> absl::StatusOr<HeldImage> {
                               if (side > kMaxSide) {
                                 return absl::InvalidArgumentError(absl::StrCat(
                                     "most_side: must lie in [0, ", kMaxSide, "], is ", side));
                               }
                               return preview_of(engine, job, side > 0 ? side : kMaxSide);
                             });
}

Unary* FarmService::ListJobs(grpc::CallbackServerContext* context,
                             const farm::ListJobsRequest* request, farm::ListJobsReply* reply) {
  return unary(deps_, *context, link::Role::kFarm, [&](Unary* reactor) {
    JobPage page{.after = request->after()};
    if (request->most() > 0) {
      page.most = request->most();
    }
    deps_.engine.jobs(
        [reactor, request, reply](const std::vector<JobView>& jobs) {
          reactor->Finish(link::to_grpc(fill(jobs, *request, *reply)));
        },
        page);
    return absl::OkStatus();
  });
}

Unary* FarmService::ListWorkers(grpc::CallbackServerContext* context,
                                const farm::ListWorkersRequest*, farm::ListWorkersReply* reply) {
  return unary(deps_, *context, link::Role::kFarm, [&](Unary* reactor) {
    deps_.engine.workers([reactor, reply](const std::vector<WorkerView>& workers) {
      for (const WorkerView& worker : workers) {
        *reply->add_worker() = to_message(worker);
      }
      reactor->Finish(grpc::Status::OK);
    });
    return absl::OkStatus();
  });
}

}  // namespace bandsaw::coordinator
