// The coordinator identifies worker programs by their bytes, without running them. It reads the ELF
// header and the mark of the program. The mark is a record with the version of the program, the
// version of its protocol and the version of the pixels that it renders. fitting_mark() returns a
// mark that the coordinator accepts.

#include "coordinator/cli/machines/worker_file.h"

#include <elf.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "coordinator/cli/machines/elf_file.h"
#include "tests/support/worker_file.h"

namespace bandsaw::coordinator {
namespace {

using test::fitting_mark;
using test::worker_file;
using testing::HasSubstr;

/// Returns the error for a file with these bytes that is offered as the worker program for
/// `machine`; "no error" if the file is accepted.
std::string error_of(const std::string& bytes, Machine machine = Machine::kAarch64) {
  const auto program = checked_worker_program(bytes, machine);
  return program.ok() ? "no error" : std::string(program.status().message());
}

TEST(WorkerProgram, IsIdentifiedByItsHeaderAndItsMark) {
  const std::string bytes = worker_file(EM_AARCH64, fitting_mark());
  const auto program = checked_worker_program(bytes, Machine::kAarch64);
  ASSERT_TRUE(program.ok()) << program.status();
  EXPECT_EQ(program->machine, Machine::kAarch64);
  EXPECT_EQ(program->version, "7.8.9");
  EXPECT_EQ(program->bytes, bytes);
  EXPECT_EQ(program->digest, wire::sha256(bytes));
  EXPECT_TRUE(
      checked_worker_program(worker_file(EM_X86_64, fitting_mark()), Machine::kX86_64).ok());
}

TEST(WorkerProgram, IsRefusedForAnotherArchitecture) {
  EXPECT_EQ(error_of(worker_file(EM_X86_64, fitting_mark())),
            "is a program for x86_64, not for aarch64");
  EXPECT_EQ(error_of(worker_file(EM_AARCH64, fitting_mark()), Machine::kX86_64),
            "is a program for aarch64, not for x86_64");
  EXPECT_EQ(error_of(worker_file(EM_RISCV, fitting_mark())),
            "is a program for another architecture (ELF machine 243), not for aarch64");
}

TEST(WorkerProgram, IsRefusedIfItIsCutOffAnywhere) {
  const std::string bytes = worker_file(EM_AARCH64, fitting_mark());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const std::string error = error_of(bytes.substr(0, size));
    EXPECT_THAT(error, HasSubstr(size < SELFMAG ? "is no program" : "is cut off")) << size;
  }
}

// Any header gives a result or an error, and nothing beyond the file is read.
TEST(WorkerProgram, AWrongHeaderGivesAMachineOrAnError) {
  const std::string bytes = worker_file(EM_AARCH64, fitting_mark());
  for (std::size_t at = 0; at < sizeof(Elf64_Ehdr) + sizeof(Elf64_Phdr); ++at) {
    for (const char wrong : {'\x00', '\x01', '\x7f', '\x80', '\xff'}) {
      std::string damaged = bytes;
      damaged[at] = wrong;
      const auto machine = elf_machine(damaged);
      if (!machine.ok()) {
        EXPECT_FALSE(machine.status().message().empty());
      }
    }
  }
}

TEST(WorkerProgram, OtherFilesAreRefused) {
  EXPECT_THAT(error_of("#!/bin/sh\nexit 0\n"), HasSubstr("does not begin with an ELF header"));
  for (const auto& [at, value] : {std::pair<std::size_t, char>{EI_CLASS, ELFCLASS32},
                                  {EI_DATA, ELFDATA2MSB},
                                  {offsetof(Elf64_Ehdr, e_type), ET_REL}}) {
    std::string bytes = worker_file(EM_AARCH64, fitting_mark());
    bytes[at] = value;
    EXPECT_EQ(error_of(bytes), "is no 64-bit little-endian program") << at;
  }
  wire::WorkerMark none = fitting_mark();
  none.magic[1] = 'B';
  EXPECT_THAT(error_of(worker_file(EM_AARCH64, none)), HasSubstr("is no bandsaw-worker"));
}

TEST(WorkerProgram, IsRefusedIfItsVersionIsIncompatible) {
  wire::WorkerMark mark = fitting_mark();
  mark.protocol += 1;
  EXPECT_THAT(error_of(worker_file(EM_AARCH64, mark)),
              HasSubstr("is version 7.8.9 with protocol " + std::to_string(mark.protocol)));
  mark = fitting_mark();
  mark.pixel_version -= 1;
  EXPECT_THAT(error_of(worker_file(EM_AARCH64, mark)), HasSubstr("but this farm needs protocol "));
}

// The version is sent in an HTTP header, so it must be printable text. The 24 bytes of the mark
// that hold the version must end with a zero.
TEST(WorkerProgram, AVersionThatIsNoTextIsRefused) {
  for (const std::string& version :
       {std::string(), std::string("1\r\nX-Evil: 1"), std::string(24, '1')}) {
    wire::WorkerMark mark = fitting_mark();
    std::memset(mark.version, 0, sizeof(mark.version));
    std::memcpy(mark.version, version.data(), version.size());
    EXPECT_THAT(error_of(worker_file(EM_AARCH64, mark)),
                HasSubstr("says a version that is no text"));
  }
}

TEST(WorkerProgram, ArchitecturesHaveTwoNames) {
  EXPECT_EQ(machine_named("x86_64"), Machine::kX86_64);
  EXPECT_EQ(machine_named("amd64"), Machine::kX86_64);
  EXPECT_EQ(machine_named("aarch64"), Machine::kAarch64);
  EXPECT_EQ(machine_named("arm64"), Machine::kAarch64);
  for (const char* other : {"", "armv7l", "AARCH64", "aarch64 ", "x86_64;reboot"}) {
    EXPECT_EQ(machine_named(other), std::nullopt) << other;
  }
}

}  // namespace
}  // namespace bandsaw::coordinator
