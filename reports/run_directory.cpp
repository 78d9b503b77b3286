#include "reports/run_directory.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <set>
#include <system_error>

#include "harness/config/document.hpp"
#include "harness/judge/journal.hpp"
#include "harness/kernel/error.hpp"
#include "reports/json_writer.hpp"

namespace fieldproof::reports {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kNotEnded = "the run did not end";
constexpr std::string_view kNotWritten = "the file cannot be written";

[[noreturn]] void refuse(const fs::path& path, std::string_view sentence) {
  throw kernel::Error(kernel::ErrorKind::configuration, fmt::format("{}: {}", path.string(), sentence));
}

[[noreturn]] void refuse_output(const fs::path& path, std::string_view what, std::string_view cause) {
  throw kernel::Error(kernel::ErrorKind::output, fmt::format("{}: {}: {}", path.string(), what, cause));
}

void check(const fs::path& path, const std::error_code& failure, std::string_view what) {
  if (failure) refuse_output(path, what, failure.message());
}

void create_folders(const fs::path& path) {
  std::error_code failure;
  fs::create_directories(path, failure);
  check(path, failure, "the directory cannot be created");
}

// "2026-11-21T05:18:28Z" as part of a name: no colons, they are not allowed everywhere.
std::string stamp_of(const std::string& utc) {
  std::string stamp;
  for (const char c : utc) {
    if ((c >= '0' && c <= '9') || c == 'T' || c == 'Z') stamp += c;
  }
  return stamp.empty() ? "run" : stamp;
}

// The first free name; creating it is what claims it, so two programs never share one.
fs::path claim_folder(const fs::path& parent, const std::string& stem) {
  for (int attempt = 1;; ++attempt) {
    fs::path path = parent / (attempt == 1 ? stem : fmt::format("{}-{}", stem, attempt));
    std::error_code failure;
    if (fs::create_directory(path, failure)) return path;
    check(path, failure, "the directory of the run cannot be created");
  }
}

// What a run writes first; creating it claims a folder that is there already, where two begin at once.
void claim_results(const fs::path& folder) {
  const fs::path first = folder / "results.json";
  const int number = ::open(first.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (number < 0 && errno == EEXIST) refuse(folder, "another run has begun here");
  if (number < 0) refuse_output(folder, "nothing can be created in it", std::strerror(errno));
  ::close(number);
}

// Where a file is written until it is whole.
fs::path part_of(const fs::path& path) {
  fs::path beside = path;
  beside += fmt::format(".{}.part", ::getpid());
  return beside;
}

// A device or a pipe: it is written to, and not replaced by a file.
bool is_special(const fs::path& path) {
  std::error_code failure;
  const fs::file_status status = fs::status(path, failure);
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

// Who listens at the socket; -1 and errno where nobody does.
int connected_to(const fs::path& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.native().size() >= sizeof(address.sun_path)) {
    errno = ENAMETOOLONG;
    return -1;
  }
  std::ranges::copy(path.native(), static_cast<char*>(address.sun_path));
  const int number = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (number >= 0 && ::connect(number, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0) {
    const int cause = errno;
    ::close(number);
    errno = cause;
    return -1;
  }
  return number;
}

// Into what is no regular file: a device, a pipe, a socket.
void write_stream(const fs::path& path, std::string_view content) {
  std::error_code failure;
  const int number = fs::is_socket(path, failure) ? connected_to(path)
                                                  : ::open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  int cause = number < 0 ? errno : 0;
  while (cause == 0 && !content.empty()) {
    const ssize_t written = ::write(number, content.data(), content.size());
    if (written < 0 && errno != EINTR) cause = errno;
    if (written > 0) content.remove_prefix(static_cast<std::size_t>(written));
  }
  if (number >= 0) ::close(number);
  if (cause != 0) refuse_output(path, kNotWritten, std::strerror(cause));
}

// Answers why it could not be done: the run is there all the same.
std::string point_latest_at(const fs::path& parent, const fs::path& run) {
  const fs::path beside = parent / fmt::format(".latest.{}", ::getpid());
  std::error_code failure;
  fs::remove(beside, failure);
  fs::create_directory_symlink(run.filename(), beside, failure);
  if (!failure) fs::rename(beside, parent / "latest", failure);
  if (!failure) return {};
  std::error_code ignored;
  fs::remove(beside, ignored);
  return fmt::format("{} does not lead to this run: {}", (parent / "latest").string(), failure.message());
}

}  // namespace

std::string case_directory_name(std::string_view case_id) {
  constexpr std::string_view kPlain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789._-";
  std::string name;
  for (const char c : case_id) {
    if (c == '/') {
      name += '+';
    } else if (kPlain.find(c) == std::string_view::npos || (c == '.' && name.empty())) {
      name += fmt::format("%{:02X}", static_cast<unsigned char>(c));
    } else {
      name += c;
    }
  }
  return name.empty() ? "%" : name;
}

std::string read_text_file(const fs::path& path) {
  return config::read_text(path);
}

void check_writable(const fs::path& path) {
  std::error_code failure;
  if (is_special(path)) return;
  if (fs::is_directory(path, failure)) refuse_output(path, kNotWritten, "it is a folder");
  write_text_file(part_of(path), "");
  fs::remove(part_of(path), failure);
}

namespace {

// What a link leads to is written, and the link stays; also where there is nothing yet.
fs::path what_it_leads_to(fs::path path) {
  constexpr int kMostLinks = 40;
  std::error_code failure;
  for (int links = 0; links < kMostLinks && fs::is_symlink(path, failure); ++links) {
    const fs::path target = fs::read_symlink(path, failure);
    if (failure) break;
    path = target.is_absolute() ? target : path.parent_path() / target;
  }
  return path;
}

}  // namespace

void write_text_file(const fs::path& named, std::string_view content) {
  if (named.has_parent_path()) create_folders(named.parent_path());
  std::error_code failure;
  if (is_special(named)) {
    write_stream(named, content);
    return;
  }
  const fs::path path = what_it_leads_to(named);
  const fs::path beside = part_of(path);
  {
    std::ofstream file(beside, std::ios::binary | std::ios::trunc);
    file.write(content.data(), static_cast<std::streamsize>(content.size()));
    file.flush();
    if (!file) {
      const int cause = errno;
      fs::remove(beside, failure);
      refuse_output(path, kNotWritten, std::strerror(cause));
    }
  }
  fs::rename(beside, path, failure);
  if (failure) {
    std::error_code ignored;
    fs::remove(beside, ignored);
  }
  check(path, failure, kNotWritten);
}

void write_files(const fs::path& path, const std::vector<std::string>& contents) {
  const bool is_stream = is_special(path);
  for (std::size_t n = 0; n < contents.size(); ++n) {
    const std::string name =
        n == 0 || is_stream ? path.filename().string()
                            : fmt::format("{}-{}{}", path.stem().string(), n + 1, path.extension().string());
    write_text_file(path.parent_path() / name, contents[n]);
  }
}

RunDirectory RunDirectory::create(const fs::path& parent, const Manifest& manifest,
                                  const RunIdentity& identity) {
  create_folders(parent);
  RunDirectory run(claim_folder(parent, fmt::format("{}-{}", stamp_of(manifest.started), identity.seed)));
  run.begin(manifest, identity);
  run.warning_ = point_latest_at(parent, run.path());
  return run;
}

RunDirectory RunDirectory::create_at(const fs::path& path, const Manifest& manifest,
                                     const RunIdentity& identity) {
  std::error_code failure;
  if (fs::exists(path, failure) && !(fs::is_directory(path, failure) && fs::is_empty(path, failure))) {
    refuse(path, "the path is taken; name one that does not exist, or an empty directory");
  }
  create_folders(path);
  claim_results(path);
  const RunDirectory run(path);
  run.begin(manifest, identity);
  return run;
}

RunDirectory RunDirectory::open(const fs::path& path) {
  std::error_code failure;
  if (!fs::is_directory(path, failure)) refuse(path, "there is no such directory of a run");
  if (fs::exists(path / "manifest.json", failure)) return RunDirectory(path);
  if (fs::exists(path / "latest" / "manifest.json", failure)) return RunDirectory(path / "latest");
  refuse(path, "this is no directory of a run: it has no manifest.json");
}

fs::path RunDirectory::case_directory(std::string_view case_id) const {
  return path_ / "cases" / case_directory_name(case_id);
}

void RunDirectory::begin(const Manifest& manifest, const RunIdentity& identity) const {
  Run run{identity, {}};
  if (run.is_complete()) run.identity.incomplete_because = kNotEnded;
  store(manifest, run);
}

void RunDirectory::store(const Manifest& manifest, const Run& run) const {
  write("results.json", results_json(run));
  write("timings.json", timings_json(manifest, run));
  write("manifest.json", manifest_json(manifest, run));
}

void RunDirectory::write(std::string_view name, std::string_view content) const {
  write_text_file(path_ / name, content);
}

void RunDirectory::write_case(std::string_view case_id, std::string_view name,
                              std::string_view content) const {
  write_text_file(case_directory(case_id) / name, content);
}

std::string RunDirectory::read_case(std::string_view case_id, std::string_view name) const {
  return read_text_file(case_directory(case_id) / name);
}

StoredRun RunDirectory::load() const {
  const auto text = [this](const char* name) { return read_text_file(path_ / name); };
  const auto place = [this](const char* name) { return (path_ / name).string(); };
  StoredRun stored;
  stored.manifest = manifest_from_json(text("manifest.json"), place("manifest.json"));
  stored.run = run_from_json(text("results.json"), place("results.json"));
  std::error_code failure;
  if (fs::exists(path_ / "timings.json", failure)) {
    add_timings(text("timings.json"), place("timings.json"), stored.run);
  }
  if (stored.run.is_complete() || !fs::exists(journal(), failure)) return stored;
  judge::JournalContent content = judge::read_journal(journal());
  stored.journal_was_torn = content.is_torn;
  std::set<std::string> known;
  for (const judge::CaseResult& result : stored.run.cases) known.insert(result.id);
  for (judge::CaseResult& result : content.results) {
    if (known.insert(result.id).second) stored.run.cases.push_back(std::move(result));
  }
  return stored;
}

}  // namespace fieldproof::reports
