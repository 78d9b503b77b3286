#include "campaign/folder.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "harness/config/document.hpp"
#include "harness/kernel/error.hpp"
#include "reports/run_directory.hpp"

namespace fieldproof::campaign {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr const char* kManifest = "manifest.json";
constexpr const char* kSchema = "fieldproof/campaign_manifest/1";

[[noreturn]] void refuse_folder(const fs::path& path, std::string_view sentence) {
  throw kernel::Error(kernel::ErrorKind::configuration, fmt::format("{}: {}", path.string(), sentence));
}

std::string manifest_text(const Manifest& manifest) {
  const ordered_json json = {{"schema", kSchema},
                             {"suite_version", manifest.suite_version},
                             {"plan_hash", manifest.plan_hash},
                             {"inputs", judge::json_of(manifest.inputs)},
                             {"jobs", manifest.jobs},
                             {"folder", manifest.folder},
                             {"started", manifest.started}};
  return json.dump(1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

Manifest manifest_from(const fs::path& path) {
  const config::Document document = config::Document::load(path);
  return config::read_open_object(document.root(), [](config::ObjectReader& object) {
    if (object.required("schema").as_string() != kSchema)
      config::fail(object.value(), "this is no manifest of a campaign that this version knows");
    Manifest manifest;
    manifest.suite_version = object.required("suite_version").as_string();
    manifest.plan_hash = object.required("plan_hash").as_string();
    manifest.inputs = judge::input_files_from(object.required("inputs"));
    manifest.jobs = object.required("jobs").as_integer<std::uint64_t>();
    manifest.folder = object.required("folder").as_string();
    manifest.started = object.required("started").as_string();
    return manifest;
  });
}

void make_folders(const fs::path& path) {
  std::error_code failure;
  fs::create_directories(path, failure);
  if (failure) {
    throw kernel::Error(kernel::ErrorKind::output, fmt::format("{}: the directory cannot be created: {}",
                                                               path.string(), failure.message()));
  }
}

}  // namespace

Folder Folder::create_at(const fs::path& path, const Manifest& manifest, std::string_view plan) {
  std::error_code failure;
  if (fs::exists(path, failure) && !(fs::is_directory(path, failure) && fs::is_empty(path, failure)))
    refuse_folder(path, "the path is taken; name one that does not exist, or go on with it by --resume");
  make_folders(path);
  // Creating this one claims the folder, where two begin at once.
  if (!fs::create_directory(path / "jobs", failure)) {
    if (!failure) refuse_folder(path, "another campaign has begun here");
    throw kernel::Error(kernel::ErrorKind::output, fmt::format("{}: nothing can be created in it: {}",
                                                               path.string(), failure.message()));
  }
  Folder folder(path, manifest);
  folder.begin(plan);
  return folder;
}

Folder Folder::create_below(const fs::path& parent, const std::string& stem, const Manifest& manifest,
                            std::string_view plan) {
  make_folders(parent);
  for (int attempt = 1;; ++attempt) {
    fs::path path = parent / (attempt == 1 ? stem : fmt::format("{}-{}", stem, attempt));
    std::error_code failure;
    // Creating it is what claims it.
    if (fs::create_directory(path, failure)) {
      Folder folder(std::move(path), manifest);
      folder.begin(plan);
      return folder;
    }
    if (failure) {
      throw kernel::Error(kernel::ErrorKind::output,
                          fmt::format("{}: the directory of the campaign cannot be created: {}",
                                      path.string(), failure.message()));
    }
  }
}

Folder Folder::open(const fs::path& path) {
  std::error_code failure;
  if (!fs::exists(path / kManifest, failure))
    refuse_folder(path, "this is no folder of a campaign: it has no manifest.json");
  return {path, manifest_from(path / kManifest)};
}

void Folder::begin(std::string_view plan) const {
  reports::write_text_file(this->plan(), plan);
  reports::write_text_file(path_ / kManifest, manifest_text(manifest_));
}

void Folder::write_job(const JobResult& result) const {
  for (const KeptFile& file : result.files)
    reports::write_text_file(path_ / "jobs" / std::to_string(result.id) / file.name, file.text);
}

bool Folder::holds(std::uint64_t job, std::uint64_t files) const {
  std::uint64_t found = 0;
  std::error_code failure;
  if (files == 0) return true;
  for (fs::recursive_directory_iterator at(path_ / "jobs" / std::to_string(job), failure), end;
       !failure && at != end; at.increment(failure)) {
    std::error_code gone;
    found += at->is_regular_file(gone) ? 1U : 0U;
  }
  return found >= files;
}

void Folder::write_document(std::string_view text) const {
  reports::write_text_file(document(), text);
}

}  // namespace fieldproof::campaign
