#pragma once

// Reads the architecture of a program from its file, for programs of workers that this machine
// hands out but may not be able to run (worker_file.h).

#include <cstdint>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

namespace bandsaw::coordinator {

/// Returns the machine type of a program: e_machine, such as EM_X86_64 or EM_AARCH64 of <elf.h>.
/// `file`: all bytes of the program's file. Reads the ELF header and the program headers; runs
/// nothing. INVALID_ARGUMENT: the file is no 64-bit little-endian program. DATA_LOSS: it lacks
/// bytes that its headers name. The message of an error begins with a verb; the caller puts the
/// name of the file before it. Source: System V ABI, chapter 4 "Object Files" and 5 "Program
/// Header".
absl::StatusOr<std::uint16_t> elf_machine(absl::string_view file);

}  // namespace bandsaw::coordinator
