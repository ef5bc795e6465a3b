#pragma once

// The files of the dashboard's page, which the build embeds into the program (embed.cmake). They
// are the files of coordinator/web/page, and two downloads: the add-on for Blender and the module
// for Python.

#include "absl/strings/string_view.h"
#include "absl/types/span.h"

namespace bandsaw::coordinator {

struct PageFile {
  absl::string_view name;  ///< "index.html"
  absl::string_view type;  ///< "text/html; charset=utf-8"
  absl::string_view bytes;
};

/// Returns all files, sorted by their paths.
absl::Span<const PageFile> page_files();

}  // namespace bandsaw::coordinator
