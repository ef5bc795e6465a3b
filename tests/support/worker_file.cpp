// Makes files that look like a worker program: an ELF header, and the mark by which the command
// finds the version of a worker program.

#include "tests/support/worker_file.h"

#include <elf.h>

#include <cstring>

#include "renderlib/render/pixel_version.h"

namespace bandsaw::test {
namespace {

template <class Record>
std::string bytes_of(const Record& record) {
  return {reinterpret_cast<const char*>(&record), sizeof(record)};
}

}  // namespace

std::string worker_file(std::uint16_t machine, const wire::WorkerMark& mark) {
  // The 1000 other bytes on both sides stand for code: the mark must be found between them.
  const std::string content = std::string(1000, 'c') + bytes_of(mark) + std::string(1000, 'c');
  Elf64_Phdr segment{};
  segment.p_type = PT_LOAD;
  segment.p_offset = sizeof(Elf64_Ehdr) + sizeof(Elf64_Phdr);
  segment.p_filesz = content.size();
  Elf64_Ehdr header{};
  std::memcpy(header.e_ident, ELFMAG, SELFMAG);
  header.e_ident[EI_CLASS] = ELFCLASS64;
  header.e_ident[EI_DATA] = ELFDATA2LSB;
  header.e_ident[EI_VERSION] = EV_CURRENT;
  header.e_type = ET_DYN;
  header.e_machine = machine;
  header.e_version = EV_CURRENT;
  header.e_ehsize = sizeof(Elf64_Ehdr);
  header.e_phoff = sizeof(Elf64_Ehdr);
  header.e_phentsize = sizeof(Elf64_Phdr);
  header.e_phnum = 1;
  header.e_shoff = segment.p_offset + content.size();
  header.e_shentsize = sizeof(Elf64_Shdr);
  header.e_shnum = 1;
  return bytes_of(header) + bytes_of(segment) + content + bytes_of(Elf64_Shdr{});
}

wire::WorkerMark fitting_mark() { return {.pixel_version = kPixelVersion, .version = "7.8.9"}; }

}  // namespace bandsaw::test
