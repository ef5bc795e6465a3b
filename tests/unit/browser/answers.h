#pragma once

// Reads answers, for tests of the worker in a browser's tab. The worker exports functions, which
// return answers. An answer is valid until the next call for the same renderer or session.

#include <gtest/gtest.h>

#include <string>

#include "worker/browser/exports.h"

namespace bandsaw::worker {

/// Returns the bytes of an answer.
inline std::string text_of(const BandsawAnswer* answer) {
  return std::string(static_cast<const char*>(answer->data), answer->size);
}
/// Returns the bytes of an answer; the test fails if the answer is an error.
inline std::string good(const BandsawAnswer* answer) {
  EXPECT_EQ(answer->failed, 0U) << text_of(answer);
  return text_of(answer);
}
/// Returns the text of an error; the test fails if the answer is not an error.
inline std::string error_of(const BandsawAnswer* answer) {
  EXPECT_EQ(answer->failed, 1U) << text_of(answer);
  return text_of(answer);
}

}  // namespace bandsaw::worker
