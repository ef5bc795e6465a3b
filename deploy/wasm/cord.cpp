// Abseil records samples of its cords only if a program asks for it. Without threads there is no such record to remove.

#include "absl/strings/internal/cordz_info.h"

namespace absl {
ABSL_NAMESPACE_BEGIN
namespace cord_internal {
void CordzInfo::Untrack() {}
}  // namespace cord_internal
ABSL_NAMESPACE_END
}  // namespace absl
