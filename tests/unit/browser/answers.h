#pragma once

// Reads the answers of the functions that the browser's renderer exports.

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
