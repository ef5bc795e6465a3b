#pragma once

#include <cstdint>
#include <string>

#include "proto/wire/worker_mark.h"

namespace bandsaw::test {

/// A file that is a worker as far as its bytes tell: an ELF header of the machine type (EM_AARCH64,
/// … of <elf.h>), one segment with the mark in it, and section headers at its end. It does not run.
std::string worker_file(std::uint16_t machine, const wire::WorkerMark& mark);

/// The mark of a worker that fits a coordinator of this build; its version is "7.8.9".
wire::WorkerMark fitting_mark();

}  // namespace bandsaw::test
