// A coordinator with a gRPC server on a free port, and functions by which tests call it.

#include "tests/unit/rpc/farm.h"

#include "coordinator/engine/blocking_call.h"
#include "renderlib/base/check.h"
#include "tests/support/scenes.h"

namespace bandsaw::coordinator {
namespace {

constexpr std::chrono::milliseconds kLong{60'000};  // a call that takes longer hangs

}  // namespace

// The engine waits only 0.1 s for the workers of an earlier run. It makes no audits, in which a
// second machine renders a band again.
FarmTest::FarmTest() : identity_(*link::load_or_make_identity(folder_ / "identity")) {
  auto engine =
      Engine::start({.data_folder = folder_ / "data", .reattach_grace_s = 0.1, .audit_share = 0});
  BANDSAW_CHECK(engine.ok(), engine.status().ToString().c_str());
  engine_ = *std::move(engine);
  auto server = Server::start(*engine_, identity_, {.listen = "127.0.0.1:0"});
  BANDSAW_CHECK(server.ok(), server.status().ToString().c_str());
  server_ = *std::move(server);
  auto connected = link::connect(join(link::Role::kFarm), kLong);
  BANDSAW_CHECK(connected.ok(), connected.status().ToString().c_str());
  channel_ = connected->control;
}

FarmTest::~FarmTest() {
  server_.reset();
  engine_.reset();
}

link::JoinString FarmTest::join(link::Role role) const {
  link::JoinString join;
  join.role = role;
  join.addresses = {"127.0.0.1:" + std::to_string(server_->port())};
  join.certificate = identity_.certificate_digest;
  join.secret = role == link::Role::kWorker ? identity_.worker_secret : identity_.farm_secret;
  return join;
}

std::unique_ptr<grpc::ClientContext> FarmTest::context(link::Role role) const {
  auto context = std::make_unique<grpc::ClientContext>();
  link::prepare(*context, join(role), kLong);
  return context;
}

grpc::Status FarmTest::put_blob(const std::vector<farm::BlobChunk>& chunks) {
  const auto call = context(link::Role::kFarm);
  farm::PutBlobReply reply;
  const auto writer = people()->PutBlob(call.get(), &reply);
  for (const farm::BlobChunk& chunk : chunks) {
    writer->Write(chunk);
  }
  writer->WritesDone();
  return writer->Finish();
}

FarmTest::PutBands FarmTest::put_bands(const std::vector<farm::BandChunk>& chunks) {
  const auto call = context(link::Role::kWorker);
  const auto stream = work()->PutBands(call.get());
  for (const farm::BandChunk& chunk : chunks) {
    stream->Write(chunk);
  }
  stream->WritesDone();
  PutBands put;
  for (farm::PutBandReply reply; stream->Read(&reply);) {
    put.outcomes.push_back(reply.outcome());
  }
  put.status = stream->Finish();
  return put;
}

farm::BandChunk FarmTest::band_chunk(const std::vector<double>& sums) {
  const std::string bytes(reinterpret_cast<const char*>(sums.data()), sums.size() * sizeof(double));
  farm::BandChunk chunk;
  farm::BandHeader* header = chunk.mutable_header();
  header->set_job(1);
  header->mutable_band()->set_last_sample(8);
  header->mutable_band()->set_last_row(2);
  header->set_instance(std::string(32, 'a'));
  header->set_size(bytes.size());
  header->set_sha256(wire::sha256(bytes).raw());
  chunk.set_data(bytes);
  return chunk;
}

farm::BlobChunk FarmTest::whole(const std::string& bytes) {
  farm::BlobChunk chunk;
  chunk.set_sha256(wire::sha256(bytes).raw());
  chunk.set_size(bytes.size());
  chunk.set_data(bytes);
  return chunk;
}

wire::Digest FarmTest::put_cornell_box() {
  BlobMap blobs;
  PackageInfo info;
  info.name = "box";
  const std::string manifest = encode_package(test::cornell_box().scene, info, blobs);
  for (const auto& [digest, bytes] : blobs.all()) {
    const auto status =
        put_blob({whole(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()))});
    EXPECT_TRUE(status.ok()) << status.error_message();
  }
  const auto status = put_blob({whole(manifest)});
  EXPECT_TRUE(status.ok()) << status.error_message();
  return wire::sha256(manifest);
}

farm::SubmitRequest FarmTest::cornell_request(const wire::Digest& manifest) const {
  farm::SubmitRequest request;
  request.set_request_id("0123456789abcdef");
  request.set_name("box");
  request.set_manifest_sha256(manifest.raw());
  request.mutable_settings()->set_width(24);
  request.mutable_settings()->set_height(20);
  request.mutable_settings()->set_max_depth(4);
  request.mutable_settings()->set_seed(5);
  request.mutable_stop()->set_samples(40);
  return request;
}

std::uint64_t FarmTest::submit_job(std::uint32_t side) {
  farm::SubmitRequest request = cornell_request(put_cornell_box());
  request.set_request_id("request-of-a-job-" + std::to_string(++submitted_));
  request.mutable_settings()->set_width(side);
  request.mutable_settings()->set_height(side);
  request.mutable_stop()->set_samples(8);
  farm::SubmitReply reply;
  const grpc::Status status = people()->Submit(context(link::Role::kFarm).get(), request, &reply);
  EXPECT_TRUE(status.ok()) << status.error_message();
  return reply.job();
}

void FarmTest::put_rows(std::uint64_t job, std::uint32_t side, std::uint32_t first,
                        std::uint32_t last) {
  const BandPixels pixels{.band = {.samples = {0, 8}, .rows = {first, last}},
                          .width = side,
                          .sums = std::vector<double>(std::size_t{side} * (last - first) * 3, 4.0),
                          .counters = {}};
  using Put = absl::StatusOr<BandOutcome>;
  const Put put = blocking_call<Put>([&](auto answer) {
    engine_->put_band(job, /*work=*/0, std::string(32, 'a'), pixels, /*render_s=*/0,
                      /*cpu_s=*/0, answer);
  });
  ASSERT_TRUE(put.ok()) << put.status();
  EXPECT_EQ(*put, BandOutcome::kStored);
}

std::uint64_t FarmTest::finish_job(std::uint32_t side) {
  const std::uint64_t job = submit_job(side);
  put_rows(job, side, 0, side);
  const auto call = context(link::Role::kFarm);
  farm::WatchRequest request;
  request.set_job(job);
  const auto watch = people()->Watch(call.get(), request);
  farm::JobStatus state;
  while (watch->Read(&state)) {
  }
  EXPECT_TRUE(watch->Finish().ok());
  EXPECT_EQ(state.state(), farm::JOB_STATE_DONE) << state.reason();
  return job;
}

}  // namespace bandsaw::coordinator
