#pragma once

// Callbacks that finish a unary RPC with the job that the engine passes to them.

#include <grpcpp/grpcpp.h>

#include "absl/status/statusor.h"
#include "coordinator/convert/farm_messages.h"
#include "proto/farm.pb.h"
#include "proto/link/channel.h"

namespace bandsaw::coordinator {

/// Returns a callback that replies with the job's status.
inline auto reply_with(grpc::ServerUnaryReactor* reactor, farm::JobStatus* reply) {
  return [reactor, reply](const absl::StatusOr<JobView>& job) {
    if (job.ok()) {
      *reply = to_message(*job);
    }
    reactor->Finish(link::to_grpc(job.status()));
  };
}

/// Returns a callback that replies with the number of a job that was submitted.
inline auto reply_with(grpc::ServerUnaryReactor* reactor, farm::SubmitReply* reply) {
  return [reactor, reply](const absl::StatusOr<JobId>& job) {
    if (job.ok()) {
      reply->set_job(*job);
    }
    reactor->Finish(link::to_grpc(job.status()));
  };
}

}  // namespace bandsaw::coordinator
