#pragma once

// Upper bounds of all messages and files, in one place. If data exceeds a bound, the error is
// INVALID_ARGUMENT or RESOURCE_EXHAUSTED with the name and the value of the bound. Data is never
// truncated silently. Bounds of an image are in renderlib/render/settings.h.

#include <cstddef>
#include <cstdint>

namespace bandsaw::wire {

inline constexpr std::size_t kChunkBytes = 1 << 20;      ///< data in one chunk of a stream
inline constexpr std::size_t kMessageBytes = 4 << 20;    ///< any gRPC message
inline constexpr std::uint64_t kBlobBytes = 8ull << 30;  ///< one blob
/// Number of interrupted uploads of blobs that the coordinator keeps. The newest are kept.
inline constexpr std::size_t kPartialBlobs = 64;
inline constexpr std::uint64_t kPartialBytes = 16ull << 30;   ///< total size of these uploads
inline constexpr std::uint64_t kManifestBytes = 64ull << 20;  ///< a package's manifest
inline constexpr std::uint64_t kPackageBytes = 32ull << 30;   ///< total size of a package's blobs
inline constexpr std::uint64_t kBandBytes = 64ull << 20;      ///< pixels of one band
inline constexpr std::size_t kBlobsPerPackage = 100'000;
inline constexpr std::size_t kDigestsPerMessage = 10'000;
inline constexpr std::size_t kFramesPerMessage = 1'000;  ///< frames whose scenes are sent together
/// Jobs in a state that is not final. The jobs of the frames of a sequence are not counted.
inline constexpr std::size_t kActiveJobs = 1'000;
inline constexpr std::size_t kWorkers = 4'096;
inline constexpr std::size_t kBandsPerWorker = 16;  ///< leased to one worker at the same time
inline constexpr std::size_t kThreadsPerWorker = 4'096;
inline constexpr std::size_t kJobNameBytes = 200;
inline constexpr std::size_t kWorkerNameBytes = 64;
inline constexpr std::size_t kWrongSecretsPerMinute =
    120;  ///< per address; further calls with a wrong secret get RESOURCE_EXHAUSTED
inline constexpr std::size_t kLogLines = 50;  ///< of a worker's log, in one message
inline constexpr std::size_t kLogLineBytes = 500;
/// Lines of one worker's log that the coordinator keeps.
inline constexpr std::size_t kLogLinesKept = 200;
/// Total size of all workers' logs that the coordinator keeps.
inline constexpr std::size_t kLogBytesKept = 64 << 20;
inline constexpr std::size_t kReasonBytes = 2'000;  ///< a reason or another text for display

}  // namespace bandsaw::wire
