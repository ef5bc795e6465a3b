#pragma once

// The two services of proto/farm.proto, Farm for users and Work for workers: each method
// authenticates the caller and creates the object that serves the call.

#include "coordinator/rpc/streams.h"
#include "proto/farm.grpc.pb.h"

namespace bandsaw::coordinator {

class FarmService final : public farm::Farm::CallbackService {
 public:
  explicit FarmService(const ServiceDependencies& deps) : deps_(deps) {}

  grpc::ServerUnaryReactor* MissingBlobs(grpc::CallbackServerContext* context,
                                         const farm::MissingBlobsRequest* request,
                                         farm::MissingBlobsReply* reply) override;
  grpc::ServerReadReactor<farm::BlobChunk>* PutBlob(grpc::CallbackServerContext* context,
                                                    farm::PutBlobReply* reply) override;
  grpc::ServerUnaryReactor* Submit(grpc::CallbackServerContext* context,
                                   const farm::SubmitRequest* request,
                                   farm::SubmitReply* reply) override;
  grpc::ServerUnaryReactor* SubmitSequence(grpc::CallbackServerContext* context,
                                           const farm::SubmitSequenceRequest* request,
                                           farm::SubmitReply* reply) override;
  grpc::ServerUnaryReactor* AddFrames(grpc::CallbackServerContext* context,
                                      const farm::AddFramesRequest* request,
                                      farm::JobStatus* reply) override;
  grpc::ServerUnaryReactor* RetryFrames(grpc::CallbackServerContext* context,
                                        const farm::RetryFramesRequest* request,
                                        farm::JobStatus* reply) override;
  grpc::ServerUnaryReactor* ListFrames(grpc::CallbackServerContext* context,
                                       const farm::ListFramesRequest* request,
                                       farm::ListFramesReply* reply) override;
  grpc::ServerWriteReactor<farm::JobStatus>* Watch(grpc::CallbackServerContext* context,
                                                   const farm::WatchRequest* request) override;
  grpc::ServerWriteReactor<farm::ResultChunk>* GetResult(
      grpc::CallbackServerContext* context, const farm::GetResultRequest* request) override;
  grpc::ServerWriteReactor<farm::ResultChunk>* Preview(
      grpc::CallbackServerContext* context, const farm::PreviewRequest* request) override;
  grpc::ServerUnaryReactor* ListJobs(grpc::CallbackServerContext* context,
                                     const farm::ListJobsRequest* request,
                                     farm::ListJobsReply* reply) override;
  grpc::ServerUnaryReactor* ListWorkers(grpc::CallbackServerContext* context,
                                        const farm::ListWorkersRequest* request,
                                        farm::ListWorkersReply* reply) override;
  grpc::ServerUnaryReactor* Cancel(grpc::CallbackServerContext* context,
                                   const farm::CancelRequest* request,
                                   farm::JobStatus* reply) override;
  grpc::ServerUnaryReactor* Pause(grpc::CallbackServerContext* context,
                                  const farm::PauseRequest* request,
                                  farm::JobStatus* reply) override;
  grpc::ServerUnaryReactor* Resume(grpc::CallbackServerContext* context,
                                   const farm::ResumeRequest* request,
                                   farm::JobStatus* reply) override;
  grpc::ServerUnaryReactor* SetPriority(grpc::CallbackServerContext* context,
                                        const farm::SetPriorityRequest* request,
                                        farm::JobStatus* reply) override;
  grpc::ServerUnaryReactor* Why(grpc::CallbackServerContext* context,
                                const farm::WhyRequest* request, farm::WhyReply* reply) override;
  grpc::ServerUnaryReactor* Logs(grpc::CallbackServerContext* context,
                                 const farm::LogsRequest* request, farm::LogsReply* reply) override;
  grpc::ServerUnaryReactor* Quarantine(grpc::CallbackServerContext* context,
                                       const farm::QuarantineRequest* request,
                                       farm::QuarantineReply* reply) override;
  grpc::ServerUnaryReactor* About(grpc::CallbackServerContext* context,
                                  const farm::AboutRequest* request,
                                  farm::AboutReply* reply) override;
  grpc::ServerUnaryReactor* RotateSecret(grpc::CallbackServerContext* context,
                                         const farm::RotateSecretRequest* request,
                                         farm::RotateSecretReply* reply) override;
  grpc::ServerUnaryReactor* BrowserLink(grpc::CallbackServerContext* context,
                                        const farm::BrowserLinkRequest* request,
                                        farm::BrowserLinkReply* reply) override;

 private:
  const ServiceDependencies deps_;
};

class WorkService final : public farm::Work::CallbackService {
 public:
  explicit WorkService(const ServiceDependencies& deps) : deps_(deps) {}

  grpc::ServerBidiReactor<farm::FromWorker, farm::ToWorker>* Session(
      grpc::CallbackServerContext* context) override;
  grpc::ServerWriteReactor<farm::BlobChunk>* GetBlob(grpc::CallbackServerContext* context,
                                                     const farm::GetBlobRequest* request) override;
  grpc::ServerBidiReactor<farm::BandChunk, farm::PutBandReply>* PutBands(
      grpc::CallbackServerContext* context) override;

 private:
  const ServiceDependencies deps_;
};

}  // namespace bandsaw::coordinator
