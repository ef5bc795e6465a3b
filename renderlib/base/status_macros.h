#pragma once

// Macros that return early on errors.

#include <utility>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

#define BANDSAW_CONCAT_INNER(a, b) a##b
#define BANDSAW_CONCAT(a, b) BANDSAW_CONCAT_INNER(a, b)

/// Returns the status of `expression` from the enclosing function if it is an error.
#define RETURN_IF_ERROR(expression)                           \
  do {                                                        \
    if (absl::Status status_ = (expression); !status_.ok()) { \
      return status_;                                         \
    }                                                         \
  } while (false)

/// `ASSIGN_OR_RETURN(auto x, f());` assigns the value of f(), or returns its error from the
/// enclosing function.
#define ASSIGN_OR_RETURN(target, expression) \
  ASSIGN_OR_RETURN_INNER(BANDSAW_CONCAT(status_or_, __LINE__), target, expression)
#define ASSIGN_OR_RETURN_INNER(temporary, target, expression) \
  auto temporary = (expression);                              \
  if (!temporary.ok()) {                                      \
    return std::move(temporary).status();                     \
  }                                                           \
  target = *std::move(temporary)
