#pragma once

// The files of coordinator/web/page, which the build embeds into the program (embed.cmake).

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
