#pragma once

#include <future>
#include <memory>
#include <utility>

namespace bandsaw::coordinator {

/// Waits for the result of a call that passes its result to a callback. Calls `begin` with a
/// callback, waits until the callback is called, and returns the argument of the callback. `begin`
/// MUST cause exactly one call of the callback, as the engine's functions do (engine/answer.h).
/// MUST be called only on threads that may wait, never on the engine's or gRPC's own threads.
template <class T, class Begin>
T blocking_call(Begin begin) {
  const auto answer = std::make_shared<std::promise<T>>();
  std::future<T> later = answer->get_future();
  begin([answer](T value) { answer->set_value(std::move(value)); });
  return later.get();
}

}  // namespace bandsaw::coordinator
