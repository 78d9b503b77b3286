// The journal of a run: the result of every case, stored the moment it is known, so that a verdict that was
// printed is never lost.
//
// Contract: `append` returns when the line is with the operating system in one write(2), so it survives a
// SIGKILL of this program; with Durability::synced it is also on the disk (fdatasync) and survives a power
// cut. One line per result: {"check":"<16 hexadecimal digits>","size":<octets>,"result":{...}}, where check
// (FNV-1a, 64 bit) and size are of the text of the result. Reading verifies both: a last line that does not
// hold is torn and dropped; any other one is kernel::Error(configuration) that names file and line.
//
// Limits: one writer at a time, which is held: a second one is an Error(configuration). A case may stand in
// the journal more than once (it was run again on resume); the last line counts.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "harness/judge/finding.hpp"

namespace fieldproof::judge {

enum class Durability : std::uint8_t { written, synced };

class Journal {
 public:
  // Creates the file, or continues it: a torn last line is cut off first. Throws kernel::Error(output) when
  // the file cannot be opened, kernel::Error(configuration) when it is damaged before its last line or has a
  // writer.
  explicit Journal(std::filesystem::path path, Durability durability = Durability::written);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  // Call it before the verdict is printed. Throws kernel::Error(output) when the disk takes no more;
  // what was appended before stays readable.
  void append(const CaseResult& result);

 private:
  struct OpenFile {
    int number = -1;
    OpenFile() = default;
    OpenFile(const OpenFile&) = delete;
    OpenFile& operator=(const OpenFile&) = delete;
    ~OpenFile();
  };

  std::filesystem::path path_;
  Durability durability_;
  OpenFile file_;
};

struct JournalContent {
  std::vector<CaseResult> results;  // one per case, in the order of their first appearance
  bool is_torn = false;             // the last line was incomplete and is not among the results
  std::uintmax_t intact_size = 0;   // octets up to the end of the last intact line
};

JournalContent read_journal(const std::filesystem::path& path);

}  // namespace fieldproof::judge
