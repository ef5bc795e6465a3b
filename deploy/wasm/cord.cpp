// Defines a function that Abseil's cords call. The build for WebAssembly leaves out Abseil's file
// with it, which needs threads. It does nothing here: it would remove the record of a sampled cord,
// and without sampling there are no such records.

#include "absl/strings/internal/cordz_info.h"

namespace absl {
ABSL_NAMESPACE_BEGIN
namespace cord_internal {
void CordzInfo::Untrack() {}
}  // namespace cord_internal
ABSL_NAMESPACE_END
}  // namespace absl
