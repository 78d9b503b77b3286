#include "reports/history_folders.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <tuple>

#include "harness/kernel/error.hpp"
#include "reports/json_writer.hpp"

namespace fieldproof::reports {
namespace {

namespace fs = std::filesystem;

struct Candidate {
  std::string started;
  std::string name;
  fs::path path;
};

bool has_file(const fs::path& folder, const char* name) {
  std::error_code failure;
  return fs::is_regular_file(folder / name, failure);
}

// A campaign has a manifest too, and beside it a plan.
bool is_a_run(const fs::path& folder) {
  return has_file(folder, "results.json") ||
         (has_file(folder, "manifest.json") && !has_file(folder, "plan.json"));
}

std::string name_below(const fs::path& folder, const fs::path& path) {
  const std::string name = path.lexically_relative(folder).string();
  return name == "." ? path.filename().string() : name;
}

class Search {
 public:
  Search(const fs::path& folder, FoundRuns& found) : folder_(folder), found_(found) {}

  std::vector<Candidate> candidates() {
    consider(folder_);
    std::error_code failure;
    fs::recursive_directory_iterator at(folder_, fs::directory_options::skip_permission_denied, failure);
    for (const fs::recursive_directory_iterator end; !failure && at != end; at.increment(failure)) {
      std::error_code unknown;
      if (at->is_symlink(unknown) || !at->is_directory(unknown)) continue;
      if (consider(at->path())) at.disable_recursion_pending();
    }
    std::ranges::sort(candidates_, std::greater{},
                      [](const Candidate& one) { return std::tie(one.started, one.name); });
    return std::move(candidates_);
  }

 private:
  bool consider(const fs::path& path) {
    if (!is_a_run(path)) return false;
    const std::string name = name_below(folder_, path);
    try {
      const std::string manifest = (path / "manifest.json").string();
      candidates_.push_back({manifest_from_json(read_text_file(manifest), manifest).started, name, path});
    } catch (const kernel::Error& error) {
      found_.left_out.push_back({name, error.what()});
    }
    return true;
  }

  fs::path folder_;
  FoundRuns& found_;
  std::vector<Candidate> candidates_;
};

}  // namespace

FoundRuns for_each_run(
    const fs::path& folder, std::size_t most,
    const std::function<void(const std::string& name, const fs::path& path, const StoredRun& run)>& take) {
  std::error_code failure;
  if (!fs::is_directory(folder, failure)) {
    throw kernel::Error(kernel::ErrorKind::configuration,
                        fmt::format("{}: there is no such folder of runs", folder.string()));
  }
  FoundRuns found;
  std::size_t taken = 0;
  for (const Candidate& one : Search(folder, found).candidates()) {
    if (taken == most) {
      ++found.older;
      continue;
    }
    try {
      take(one.name, one.path, RunDirectory::open(one.path).load());
      ++taken;
    } catch (const kernel::Error& error) {
      found.left_out.push_back({one.name, error.what()});
    }
  }
  std::ranges::sort(found.left_out, {}, &LeftOut::name);
  if (taken > 0) return found;
  std::string sentence = fmt::format("{}: there is no run in it or below it", folder.string());
  for (const LeftOut& one : found.left_out)
    sentence += fmt::format("; {} cannot be read: {}", one.name, one.why);
  throw kernel::Error(kernel::ErrorKind::configuration, sentence);
}

}  // namespace fieldproof::reports
