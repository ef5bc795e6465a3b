// elf_machine() reads the architecture from the header of an ELF program, and checks that the file
// is as long as its headers say, because a copy may have been interrupted.

#include "coordinator/cli/machines/elf_file.h"

#include <elf.h>

#include <algorithm>
#include <cstring>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

/// Returns true if `count` records of `size` bytes from `offset` on are within the file. Does not
/// overflow, whatever the numbers are.
bool holds(absl::string_view file, std::uint64_t offset, std::uint64_t size, std::uint64_t count) {
  return offset <= file.size() && (count == 0 || size <= (file.size() - offset) / count);
}

absl::Status cut_off(absl::string_view file) {
  return absl::DataLossError(absl::StrCat("is cut off: it has ", file.size(),
                                          " bytes, and its headers name more; copy it again"));
}

/// Checks that the file has all bytes of the segments that its program headers name.
absl::Status check_segments(absl::string_view file, const Elf64_Ehdr& header) {
  for (std::size_t i = 0; i < header.e_phnum; ++i) {
    Elf64_Phdr segment{};
    std::memcpy(&segment, file.data() + header.e_phoff + i * sizeof(segment), sizeof(segment));
    if (!holds(file, segment.p_offset, segment.p_filesz, 1)) {
      return cut_off(file);
    }
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<std::uint16_t> elf_machine(absl::string_view file) {
  Elf64_Ehdr header{};
  std::memcpy(&header, file.data(), std::min(file.size(), sizeof(header)));
  if (!absl::StartsWith(file, ELFMAG)) {
    return absl::InvalidArgumentError("is no program: it does not begin with an ELF header");
  }
  if (file.size() < sizeof(header)) {
    return cut_off(file);
  }
  if (header.e_ident[EI_CLASS] != ELFCLASS64 || header.e_ident[EI_DATA] != ELFDATA2LSB ||
      (header.e_type != ET_EXEC && header.e_type != ET_DYN)) {
    return absl::InvalidArgumentError("is no 64-bit little-endian program");
  }
  if (header.e_phnum > 0 && header.e_phentsize != sizeof(Elf64_Phdr)) {
    return absl::InvalidArgumentError("has an ELF header that is damaged; copy it again");
  }
  // Linkers write the section headers last, so a truncated file lacks them.
  if (!holds(file, header.e_phoff, header.e_phentsize, header.e_phnum) ||
      !holds(file, header.e_shoff, header.e_shentsize, header.e_shnum)) {
    return cut_off(file);
  }
  RETURN_IF_ERROR(check_segments(file, header));
  return header.e_machine;
}

}  // namespace bandsaw::coordinator
