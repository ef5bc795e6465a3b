#pragma once

// Sequences: jobs of many frames. Each frame is rendered by a job of its own, its frame job, which
// the scheduler makes when workers are about to need it.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "coordinator/scheduler/api/ids.h"
#include "coordinator/scheduler/api/job_spec.h"

namespace bandsaw::coordinator {

/// The specification of a sequence by its submitter. Jobs and sequences have different ids of the
/// same type, JobId. The scenes of the frames are sent later, some at a time (input::AddFrames).
struct SequenceSpec {
  std::string request_id;  ///< chosen by the submitter: the same id means the same sequence
  std::string name;
  RenderSettings settings;          ///< settings of all frames; the seed is that of frame 0
  StopRule stop;                    ///< stop rule of each frame
  bool fixed_seed = false;          ///< all frames have the same seed
  std::vector<FrameNumber> frames;  ///< ascending; 1 to kMaxFrames
  friend bool operator==(const SequenceSpec&, const SequenceSpec&) = default;
};

enum class FrameState {
  kExpected,   ///< its scene has not arrived yet
  kWaiting,    ///< its scene has arrived; it has no job yet
  kRendering,  ///< its job is not final
  kDone,       ///< its image can be fetched
  kFailed,     ///< it was tried as often as is allowed, and failed each time
};
inline constexpr std::size_t kFrameStates = 5;

/// Returns the word for a state in tables, JSON and messages.
constexpr const char* frame_state_name(FrameState state) {
  switch (state) {
    case FrameState::kExpected:
      return "expected";
    case FrameState::kWaiting:
      return "waiting";
    case FrameState::kRendering:
      return "rendering";
    case FrameState::kDone:
      return "done";
    case FrameState::kFailed:
      return "failed";
  }
  return "unknown";
}

/// The scene of a frame.
struct FrameScene {
  FrameNumber number = 0;
  DigestHex manifest;
  std::uint64_t package_bytes = 0;  ///< size of its scene package; 0: unknown
};

/// A frame as it is displayed.
struct FrameView {
  FrameNumber number = 0;
  FrameState state = FrameState::kExpected;
  JobId job = 0;       ///< its frame job; 0: none
  std::string reason;  ///< why it failed last, also if it is tried again
  /// Number of the frame's last change. In each run of the coordinator, all changes of all frames
  /// of the sequence are numbered together, from 1 on. 0: the frame has not changed.
  std::uint64_t changed = 0;
};

/// Number of frames in each state.
struct FrameCounts {
  std::size_t in[kFrameStates] = {};

  std::size_t of(FrameState state) const { return in[static_cast<std::size_t>(state)]; }
  std::size_t all() const {
    std::size_t sum = 0;
    for (const std::size_t count : in) {
      sum += count;
    }
    return sum;
  }
  friend bool operator==(const FrameCounts&, const FrameCounts&) = default;
};

}  // namespace bandsaw::coordinator
