#pragma once

// The engine's answer, waited for.

#include <future>
#include <memory>
#include <utility>

namespace bandsaw::coordinator {

/// Waits on this thread for what `begin` is to call its argument with, once: the engine always
/// answers (engine/answer.h). For threads that are there to wait, never the engine's or gRPC's own.
template <class T, class Begin>
T blocking_call(Begin begin) {
  const auto answer = std::make_shared<std::promise<T>>();
  std::future<T> later = answer->get_future();
  begin([answer](T value) { answer->set_value(std::move(value)); });
  return later.get();
}

}  // namespace bandsaw::coordinator
