#pragma once

// Makes files that the command `bandsaw` accepts as worker programs, although they cannot be run.

#include <cstdint>
#include <string>

#include "proto/wire/worker_mark.h"

namespace bandsaw::test {

/// Makes the bytes of a file that is accepted as a worker: an ELF header, one segment that contains
/// the mark, and section headers at the end of the file. `machine`: the machine type of the header
/// (EM_AARCH64, … of <elf.h>). `mark`: the record by which the command finds the version of a
/// worker program.
std::string worker_file(std::uint16_t machine, const wire::WorkerMark& mark);

/// Returns the mark of a worker of version "7.8.9" that is compatible with a coordinator of this
/// build.
wire::WorkerMark fitting_mark();

}  // namespace bandsaw::test
