#pragma once

#include <cstdint>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

namespace bandsaw::coordinator {

/// Returns the machine type (e_machine; EM_X86_64, EM_AARCH64, … of <elf.h>) of a program, given
/// its whole file. Reads the ELF header and the program headers; runs nothing. INVALID_ARGUMENT:
/// not a 64-bit little-endian program. DATA_LOSS: the file ends before a part that its headers
/// name. Messages begin with a verb; the caller names the file. Source: System V ABI, chapter 4
/// "Object Files" and chapter 5 "Program Header".
absl::StatusOr<std::uint16_t> elf_machine(absl::string_view file);

}  // namespace bandsaw::coordinator
