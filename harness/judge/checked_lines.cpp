#include "harness/judge/checked_lines.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>
#include <utility>

#include "harness/config/document.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::judge {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void throw_file_error(const fs::path& path, std::string_view what) {
  throw kernel::Error(kernel::ErrorKind::output,
                      fmt::format("{}: {}: {}", path.string(), what, std::strerror(errno)));
}

std::string head_of(std::string_view result) {
  return fmt::format(R"({{"check":"{:016x}","size":{},"result":)", check_of(result), result.size());
}

constexpr std::size_t kLargestFile = std::size_t{1} << 30;  // octets

// 2 s for a writer that is ending.
constexpr std::chrono::milliseconds kBetweenLooks{10};
constexpr int kMostLooks = 200;

constexpr std::string_view kResultKey = R"("result":)";

}  // namespace

std::uint64_t check_of(std::string_view text, std::uint64_t so_far) {
  std::uint64_t check = so_far;
  for (const char c : text) {
    check ^= static_cast<unsigned char>(c);
    check *= 0x100000001b3;
  }
  return check;
}

std::optional<std::string_view> intact_result(std::string_view line) {
  const std::size_t key = line.find(kResultKey);
  if (key == std::string_view::npos || !line.ends_with('}')) return std::nullopt;
  const std::size_t begin = key + kResultKey.size();
  const std::string_view result = line.substr(begin, line.size() - begin - 1);
  if (line.substr(0, begin) != head_of(result)) return std::nullopt;
  return result;
}

// A file that is closed also when the constructor that opened it throws.
CheckedLines::OpenFile::~OpenFile() {
  if (number >= 0) ::close(number);
}

CheckedLines::CheckedLines(fs::path path, Durability durability, const OnLine& on_line)
    : path_(std::move(path)), durability_(durability) {
  file_.number = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (file_.number < 0) throw_file_error(path_, "the journal cannot be opened for writing");
  // Before it is read: what is torn now may be what another program is just writing.
  lock();
  const LinesRead read = read_checked_lines(path_, on_line);
  if (read.is_torn && ::ftruncate(file_.number, static_cast<off_t>(read.intact_size)) != 0) {
    throw_file_error(path_, "the torn last line of the journal cannot be cut off");
  }
}

// A writer that has been told to end may need a moment: mpirun does not wait for its ranks.
void CheckedLines::lock() const {
  for (int look = 0; ::flock(file_.number, LOCK_EX | LOCK_NB) != 0; ++look) {
    if (errno != EWOULDBLOCK && errno != EINTR) throw_file_error(path_, "the journal cannot be locked");
    if (look == kMostLooks) {
      throw kernel::Error(
          kernel::ErrorKind::configuration,
          fmt::format("{}: another program writes this run; wait until it ends, or end it", path_.string()));
    }
    std::this_thread::sleep_for(kBetweenLooks);
  }
}

void CheckedLines::append(std::string_view result) {
  const std::string line = head_of(result).append(result) + "}\n";
  const off_t begin = ::lseek(file_.number, 0, SEEK_END);
  ssize_t written = 0;
  do {
    written = ::write(file_.number, line.data(), line.size());
  } while (written < 0 && errno == EINTR);
  if (written != static_cast<ssize_t>(line.size())) {
    const int cause = written < 0 ? errno : ENOSPC;
    // What a full disk took of the line would stand torn in the middle once there is room again.
    if (written > 0 && ::ftruncate(file_.number, begin) != 0)
      throw_file_error(path_, "the journal is damaged");
    errno = cause;
    throw_file_error(path_, "the journal cannot be written");
  }
  if (durability_ == Durability::synced && ::fdatasync(file_.number) != 0) {
    throw_file_error(path_, "the journal cannot be brought to the disk");
  }
}

LinesRead read_checked_lines(const fs::path& path, const OnLine& on_line) {
  const std::string text = config::read_text(path, kLargestFile);
  LinesRead read;
  std::size_t begin = 0;
  for (std::size_t number = 1; begin < text.size(); ++number) {
    const std::size_t end = text.find('\n', begin);
    const bool is_last = end == std::string::npos || end + 1 == text.size();
    const std::string_view line = std::string_view(text).substr(begin, end - begin);
    const std::string place = fmt::format("{}:{}", path.string(), number);
    const auto result = end == std::string::npos || line.empty() ? std::nullopt : intact_result(line);
    if (!result && is_last) {
      read.is_torn = true;
      break;
    }
    if (!result) {
      throw kernel::Error(kernel::ErrorKind::configuration,
                          place +
                              ": the line is damaged; its check and size do not fit its result (only "
                              "the last line may be incomplete)");
    }
    on_line(*result, place);
    begin = end + 1;
    read.intact_size = begin;
  }
  return read;
}

}  // namespace fieldproof::judge
