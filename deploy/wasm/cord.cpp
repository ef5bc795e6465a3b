// Defines a function that Abseil's cords call. The build for WebAssembly leaves out the file of
// Abseil that defines it, because that file needs threads. The function removes the record of a
// sampled cord. It does nothing here, because without sampling there are no such records.

#include "absl/strings/internal/cordz_info.h"

namespace absl {
ABSL_NAMESPACE_BEGIN
namespace cord_internal {
void CordzInfo::Untrack() {}
}  // namespace cord_internal
ABSL_NAMESPACE_END
}  // namespace absl
