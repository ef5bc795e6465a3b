#pragma once

#include <cstdint>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

namespace bandsaw::coordinator {

/// The machine type (e_machine; EM_X86_64, EM_AARCH64, … of <elf.h>) of a program's whole file.
/// Reads its ELF header and its program headers, and runs nothing. INVALID_ARGUMENT: it is no
/// 64-bit little-endian program. DATA_LOSS: the file ends before something that its headers name.
/// Messages begin with a verb; the caller names the file. Source: System V ABI, chapter 4 "Object
/// Files" and chapter 5 "Program Header".
absl::StatusOr<std::uint16_t> elf_machine(absl::string_view file);

}  // namespace bandsaw::coordinator
