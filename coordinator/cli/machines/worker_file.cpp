// A file is accepted as the worker for an architecture if its ELF header names this architecture,
// and the WorkerMark in its bytes (proto/wire/worker_mark.h) has this farm's protocol and pixel
// version. Programs of the same pixel version render the same pixels. The file is not run, because
// it may be for another architecture.

#include "coordinator/cli/machines/worker_file.h"

#include <elf.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "coordinator/cli/base/program_folder.h"
#include "coordinator/cli/machines/elf_file.h"
#include "proto/wire/worker_mark.h"
#include "renderlib/base/file.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/render/pixel_version.h"

namespace bandsaw::coordinator {
namespace {

constexpr std::uint16_t elf_number(Machine machine) {
  return machine == Machine::kX86_64 ? EM_X86_64 : EM_AARCH64;
}

/// Returns the name of an architecture for a message, or its number if workers do not run on it.
std::string machine_of_number(std::uint16_t number) {
  for (const Machine machine : kMachines) {
    if (elf_number(machine) == number) {
      return std::string(machine_name(machine));
    }
  }
  return absl::StrCat("another architecture (ELF machine ", number, ")");
}

std::string versions_text(std::uint32_t protocol, std::uint32_t pixel_version) {
  return absl::StrCat("protocol ", protocol, " and pixel version ", pixel_version);
}

/// Returns the WorkerMark in the bytes of a program. INVALID_ARGUMENT: there is none, or its
/// version is no printable text.
absl::StatusOr<wire::WorkerMark> mark_of(absl::string_view file) {
  wire::WorkerMark mark;
  const std::size_t at = file.find(absl::string_view(mark.magic, sizeof(mark.magic)));
  if (at == absl::string_view::npos || file.size() - at < sizeof(mark)) {
    return absl::InvalidArgumentError(
        "is no bandsaw-worker, or one that is too old: it does not say its version");
  }
  std::memcpy(&mark, file.data() + at, sizeof(mark));
  const absl::string_view version(mark.version, strnlen(mark.version, sizeof(mark.version)));
  if (version.empty() || version.size() == sizeof(mark.version) ||
      !std::all_of(version.begin(), version.end(), absl::ascii_isgraph)) {
    return absl::InvalidArgumentError("says a version that is no text; copy it again");
  }
  return mark;
}

}  // namespace

std::string worker_program_path(Machine machine) {
  const std::filesystem::path folder = program_folder();
  return machine == kThisMachine ? folder / kWorkerProgram
                                 : folder.parent_path() / "lib/bandsaw" /
                                       absl::StrCat(kWorkerProgram, "-", machine_name(machine));
}

absl::StatusOr<WorkerProgram> checked_worker_program(std::string bytes, Machine machine) {
  ASSIGN_OR_RETURN(const std::uint16_t number, elf_machine(bytes));
  if (number != elf_number(machine)) {
    return absl::InvalidArgumentError(absl::StrCat("is a program for ", machine_of_number(number),
                                                   ", not for ", machine_name(machine)));
  }
  ASSIGN_OR_RETURN(const wire::WorkerMark mark, mark_of(bytes));
  if (mark.protocol != wire::kProtocol || mark.pixel_version != kPixelVersion) {
    return absl::FailedPreconditionError(absl::StrCat(
        "is version ", mark.version, " with ", versions_text(mark.protocol, mark.pixel_version),
        ", but this farm needs ", versions_text(wire::kProtocol, kPixelVersion),
        ": take the worker of the same version as bandsaw"));
  }
  const wire::Digest digest = wire::sha256(bytes);
  return WorkerProgram{machine, mark.version, std::move(bytes), digest};
}

absl::StatusOr<WorkerProgram> load_worker_program(Machine machine) {
  const std::string path = worker_program_path(machine);
  if (!file_exists(path)) {
    const std::string package =
        machine == kThisMachine ? "" : absl::StrCat("-", other_machine_name(machine));
    return absl::NotFoundError(absl::StrCat("there is no bandsaw-worker for ",
                                            machine_name(machine), " here: put it at ", path,
                                            ", or install the package ", kWorkerProgram, package));
  }
  ASSIGN_OR_RETURN(std::string bytes,
                   read_whole_file(path, std::numeric_limits<std::uint64_t>::max()));
  auto program = checked_worker_program(std::move(bytes), machine);
  return program.ok() ? std::move(program)
                      : absl::Status(program.status().code(),
                                     absl::StrCat(path, " ", program.status().message()));
}

}  // namespace bandsaw::coordinator
