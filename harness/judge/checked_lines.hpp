// A file of lines that are stored the moment they are known, so that nothing that was told is ever lost: the
// journal of a run, of a campaign.
//
// Contract: `append` returns when the line is with the operating system in one write(2), so it survives a
// SIGKILL of this program; with Durability::synced it is also on the disk (fdatasync) and survives a power
// cut. A line is {"check":"<16 hexadecimal digits>","size":<octets>,"result":{...}}, where check (FNV-1a, 64
// bit) and size are of the text of the result. Reading verifies both: a last line that does not hold is torn
// and dropped; any other one is kernel::Error(configuration) that names file and line.
//
// Limits: one writer at a time, which is held: a second one waits 2 s for it to end, and then is an
// Error(configuration).
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace fieldproof::judge {

enum class Durability : std::uint8_t { written, synced };

// FNV-1a: enough to know a torn or changed text; it guards against accidents only.
inline constexpr std::uint64_t kCheckOfNothing = 0xcbf29ce484222325;
// `so_far`: of what stands in front of the text.
std::uint64_t check_of(std::string_view text, std::uint64_t so_far = kCheckOfNothing);

// The text of the result of a line without its line break, or nothing when the line is not what was appended.
std::optional<std::string_view> intact_result(std::string_view line);

// What reading found besides the results themselves.
struct LinesRead {
  bool is_torn = false;            // the last line was incomplete and is not among the results
  std::uintmax_t intact_size = 0;  // octets up to the end of the last intact line
};

// Hands on the text of each result with its place, "FILE:LINE", in the order of the lines.
using OnLine = std::function<void(std::string_view result, const std::string& place)>;
LinesRead read_checked_lines(const std::filesystem::path& path, const OnLine& on_line);

class CheckedLines {
 public:
  // Creates the file, or continues it: what is there is handed on as by read_checked_lines, and a torn last
  // line is cut off. Throws kernel::Error(output) when the file cannot be opened,
  // kernel::Error(configuration) when it is damaged before its last line or has a writer.
  CheckedLines(std::filesystem::path path, Durability durability, const OnLine& on_line);

  // `result` is a JSON value without line breaks. Throws kernel::Error(output) when the disk takes no more;
  // what was appended before stays readable.
  void append(std::string_view result);

 private:
  struct OpenFile {
    int number = -1;
    OpenFile() = default;
    OpenFile(const OpenFile&) = delete;
    OpenFile& operator=(const OpenFile&) = delete;
    ~OpenFile();
  };

  void lock() const;

  std::filesystem::path path_;
  Durability durability_;
  OpenFile file_;
};

}  // namespace fieldproof::judge
