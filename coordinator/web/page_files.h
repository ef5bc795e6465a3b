#pragma once

// The files of the dashboard's page, which the build embeds into the program (embed.cmake). These
// are the files of coordinator/web/page and files that the build makes.

#include "absl/strings/string_view.h"
#include "absl/types/span.h"

namespace bandsaw::coordinator {

struct PageFile {
  absl::string_view name;  ///< "index.html"
  absl::string_view type;  ///< "text/html; charset=utf-8"
  absl::string_view bytes;
};

absl::Span<const PageFile> page_files();

}  // namespace bandsaw::coordinator
