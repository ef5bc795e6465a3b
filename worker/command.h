#pragma once

#include "worker/daemon.h"

namespace bandsaw::worker {

/// Runs the command `bandsaw-worker` until the worker has drained, that is, has finished the bands
/// that it holds and takes no more. Returns the exit code. 0: the worker has drained, or was
/// dismissed permanently. 1: the machine or the cache folder is unsuitable. 2: wrong usage, or a
/// join string that is malformed or not valid for this farm. A second SIGTERM or SIGINT ends the
/// process with 130. Erases join strings, which are secret, from `argv`. `wrap_calls`: a function
/// that replaces the calls to the coordinator in tests; nullptr: they are not replaced.
int run_command(int argc, char** argv, const WrapCalls& wrap_calls = nullptr);

}  // namespace bandsaw::worker
