// Decodes a buffer view of glTF's extension EXT_meshopt_compression: checks its parameters, decodes
// the stream with libmeshoptimizer, and applies the filter (meshopt_filters.h).

#include "renderlib/import/gltf/meshopt_view.h"

#include <meshoptimizer.h>

#include <utility>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/gltf/meshopt_filters.h"

namespace bandsaw::gltf {
namespace {

using Mode = MeshoptView::Mode;
using Filter = MeshoptView::Filter;

constexpr std::size_t kMaxStride = 256;
constexpr std::size_t kMaxElements = std::size_t{1} << 31;

/// Checks that the mode and the stride permit the filter, whose name in the file is `name`.
absl::Status check_filter(const MeshoptView& view, absl::string_view name) {
  const bool fits = view.filter == Filter::kNone ||
                    (view.mode == Mode::kAttributes &&
                     (view.filter == Filter::kOctahedral   ? view.stride == 4 || view.stride == 8
                      : view.filter == Filter::kQuaternion ? view.stride == 8
                                                           : view.stride % 4 == 0));
  return fits
             ? absl::OkStatus()
             : damaged(view.place, absl::StrCat("filter ", name, " does not go with this mode and ",
                                                "a stride of ", view.stride));
}

/// Checks stride and count. `bytes` is the byteLength of the buffer view.
absl::Status check_elements(const MeshoptView& view, std::size_t bytes) {
  const bool stride_fits =
      view.mode == Mode::kAttributes
          ? view.stride >= 4 && view.stride <= kMaxStride && view.stride % 4 == 0
          : view.stride == 2 || view.stride == 4;
  if (!stride_fits) {
    return damaged(view.place, absl::StrCat("byteStride is ", view.stride));
  }
  const bool count_fits =
      view.count <= kMaxElements && (view.mode != Mode::kTriangles || view.count % 3 == 0);
  if (!count_fits || view.bytes() != bytes) {
    return damaged(view.place,
                   absl::StrCat("count ", view.count, " and byteStride ", view.stride,
                                " do not make up the ", bytes, " bytes of its buffer view"));
  }
  return absl::OkStatus();
}

/// Returns the byte with which the extension requires a stream to begin. decode_meshopt() checks
/// it, because newer versions of the library decode other streams too, and the set of accepted
/// streams must not depend on the version of the library.
unsigned char header_of(Mode mode) {
  return mode == Mode::kAttributes ? 0xa0 : mode == Mode::kTriangles ? 0xe1 : 0xd1;
}

}  // namespace

absl::StatusOr<MeshoptView> meshopt_view(const Json& of, std::size_t bytes, std::string place) {
  MeshoptView view;
  view.place = std::move(place);
  const std::string mode = text(of, "mode");
  const std::string filter = find(of, "filter") == nullptr ? "NONE" : text(of, "filter");
  if (mode != "ATTRIBUTES" && mode != "TRIANGLES" && mode != "INDICES") {
    return damaged(view.place, absl::StrCat("mode is \"", mode, "\""));
  }
  if (filter != "NONE" && filter != "OCTAHEDRAL" && filter != "QUATERNION" &&
      filter != "EXPONENTIAL") {
    return damaged(view.place, absl::StrCat("filter is \"", filter, "\""));
  }
  view.mode = mode == "ATTRIBUTES"  ? Mode::kAttributes
              : mode == "TRIANGLES" ? Mode::kTriangles
                                    : Mode::kIndices;
  view.filter = filter == "OCTAHEDRAL"    ? Filter::kOctahedral
                : filter == "QUATERNION"  ? Filter::kQuaternion
                : filter == "EXPONENTIAL" ? Filter::kExponential
                                          : Filter::kNone;
  ASSIGN_OR_RETURN(view.count, whole_of(of, "count", view.place));
  ASSIGN_OR_RETURN(view.stride, whole_of(of, "byteStride", view.place));
  RETURN_IF_ERROR(check_elements(view, bytes));
  RETURN_IF_ERROR(check_filter(view, filter));
  return view;
}

absl::StatusOr<std::string> decode_meshopt(const MeshoptView& view, absl::string_view stream) {
  const auto* bytes = reinterpret_cast<const unsigned char*>(stream.data());
  if (stream.empty() || bytes[0] != header_of(view.mode)) {
    return damaged(view.place, "its stream is not one of EXT_meshopt_compression");
  }
  std::string out(view.bytes(), '\0');
  const int failed =
      view.mode == Mode::kAttributes
          ? meshopt_decodeVertexBuffer(out.data(), view.count, view.stride, bytes, stream.size())
      : view.mode == Mode::kTriangles
          ? meshopt_decodeIndexBuffer(out.data(), view.count, view.stride, bytes, stream.size())
          : meshopt_decodeIndexSequence(out.data(), view.count, view.stride, bytes, stream.size());
  if (failed != 0) {
    return damaged(view.place, absl::StrCat("its stream cannot be decoded (", failed, ")"));
  }
  switch (view.filter) {
    case Filter::kNone:
      break;
    case Filter::kOctahedral:
      decode_octahedral(out, view.stride);
      break;
    case Filter::kQuaternion:
      decode_quaternions(out);
      break;
    case Filter::kExponential:
      decode_exponential(out);
      break;
  }
  return out;
}

}  // namespace bandsaw::gltf
