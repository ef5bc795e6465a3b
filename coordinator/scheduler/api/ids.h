#pragma once

// Identifiers and time, as the scheduler and all that talk to it use them.

#include <cstdint>
#include <string>

namespace bandsaw::coordinator {

using JobId = std::uint64_t;      ///< counts from 1; reused only after a reset of the data folder
using LeaseId = std::uint64_t;    ///< unique within one epoch (one run of the coordinator)
using SessionId = std::uint64_t;  ///< one stream of one worker; unique within one epoch

/// The number of a frame of a sequence; its time is number / frames per second.
using FrameNumber = std::int64_t;

/// Identifies a worker process in all epochs: a hash of its instance name (worker_process.h).
/// 0: unknown.
using WorkerProcessId = std::uint64_t;

/// Seconds since an arbitrary start; only differences have a meaning.
using Time = double;

/// 64 lower-case hexadecimal digits.
using DigestHex = std::string;

}  // namespace bandsaw::coordinator
