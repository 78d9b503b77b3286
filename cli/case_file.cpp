#include "cli/case_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "cli/build_info.hpp"
#include "cli/emc_case.hpp"
#include "cli/flipped_bits.hpp"
#include "cli/implementations.hpp"
#include "cli/pics_file.hpp"
#include "cli/sequence_file.hpp"
#include "harness/config/document.hpp"
#include "harness/judge/result_json.hpp"
#include "harness/kernel/error.hpp"
#include "reports/pcapng_writer.hpp"
#include "reports/timeline_writer.hpp"
#include "reports/vcd_writer.hpp"

namespace fieldproof::cli {
namespace {

using nlohmann::ordered_json;

constexpr std::string_view kSchema = "fieldproof/case/1";
constexpr const char* kPlayback = "playback.json";
constexpr const char* kCaseFile = "case.json";

std::string place_of_copy(std::string_view name) {
  return fmt::format("../../{}", name);
}

// Copies a file of the setup into the directory of the run and answers with its place as seen from a case.
std::string kept_file(const reports::RunDirectory& directory, const std::string& file, const char* name) {
  if (file.empty()) return {};
  directory.write(name, reports::read_text_file(file));
  return place_of_copy(name);
}

// Places of the copies beside the case; empty where there is nothing to copy.
struct KeptFiles {
  std::string network;
  std::string plan;
  std::string pics;
};

KeptFiles keep_files(const reports::RunDirectory& directory, const conformance::Setup& setup) {
  KeptFiles kept{kept_file(directory, setup.network_file, "network.json"),
                 kept_file(directory, setup.plan_file, "plan.json"),
                 {}};
  if (setup.pics) {
    directory.write("pics.json", pics_text(*setup.pics));
    kept.pics = place_of_copy("pics.json");
  }
  return kept;
}

ordered_json case_json(const conformance::CaseRun& done, std::uint64_t run_seed, const KeptFiles& kept,
                       bool is_quiet) {
  const judge::CaseResult& result = done.outcome.result;
  ordered_json json;
  json["schema"] = kSchema;
  json["case"] = result.id;
  json["run_seed"] = std::to_string(run_seed);
  json["case_seed"] = std::to_string(result.seed);
  json["volume"] = conformance::name(done.setup.volume);
  json["implementations"] = ordered_json::parse(implementations_json(done.setup.implementations));
  if (!kept.network.empty()) json["network"] = kept.network;
  if (!kept.plan.empty()) json["plan"] = kept.plan;
  if (!kept.pics.empty()) json["pics"] = kept.pics;
  if (is_quiet) json["quiet"] = true;
  add_end(json, end_of(result));
  if (done.outcome.recording.devices) json["playback"] = kPlayback;
  json["truncated"] = done.outcome.recording.truncated;
  return json;
}

std::string text_of(const ordered_json& json) {
  return json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

std::string program_name() {
  return fmt::format("fieldproof {}", tool_version());
}

void store_recording(const reports::RunDirectory& directory, const conformance::CaseRun& done) {
  const conformance::Outcome& outcome = done.outcome;
  const std::string& id = outcome.result.id;
  const conformance::Recording& recording = outcome.recording;
  directory.write_case(id, "trace.txt", fmt::format("{}\n", fmt::join(recording.lines(), "\n")));
  directory.write_case(id, "timeline.json",
                       reports::timeline_json(outcome.result, recording.trace, recording.told_in()));
  directory.write_case(id, "trace.pcapng", capture_of(recording, id));
}

std::string path_from(const std::optional<config::Value>& value, const std::filesystem::path& folder) {
  return value ? (folder / value->as_string()).lexically_normal().string() : std::string{};
}

// A run where one of its cases was meant.
[[noreturn]] void refuse_folder(const std::filesystem::path& folder) {
  constexpr std::size_t kMostNamed = 20;
  std::vector<std::string> cases;
  const std::filesystem::path all = folder / "cases";
  if (std::filesystem::is_directory(all)) {
    for (const auto& one : std::filesystem::directory_iterator(all)) {
      if (std::filesystem::exists(one.path() / kCaseFile)) cases.push_back((one.path() / kCaseFile).string());
    }
  }
  if (cases.empty()) {
    throw kernel::Error(
        kernel::ErrorKind::configuration,
        fmt::format("{}: a folder, and no run with stored cases; a case is a file", folder.string()));
  }
  std::ranges::sort(cases);
  const std::size_t count = cases.size();
  cases.resize(std::min(count, kMostNamed));
  throw kernel::Error(
      kernel::ErrorKind::configuration,
      fmt::format("{}: a folder; a case is a file, here {}{}", folder.string(), fmt::join(cases, ", "),
                  count > kMostNamed ? fmt::format(" and {} more", count - kMostNamed) : ""));
}

const conformance::Entry& entry_from(const config::Value& id, const conformance::Catalogue& catalogue) {
  try {
    return catalogue.at(id.as_string());
  } catch (const kernel::Error& error) {
    if (error.kind() != kernel::ErrorKind::usage) throw;
    config::fail(id, error.what());
  }
}

void expect_case(const config::Value& schema) {
  constexpr std::array kSchemas{kSchema, kSequenceSchema, kEmcCaseSchema};
  if (schema.as_choice(kSchemas) == 0) return;
  config::fail(schema,
               "this is no case of a suite; 'fieldproof replay' and 'fieldproof shrink' take such a file");
}

CaseFile read_case(config::ObjectReader& reader, const std::filesystem::path& folder,
                   const conformance::Catalogue& catalogue) {
  CaseFile read;
  expect_case(reader.required("schema"));
  const conformance::Entry& entry = entry_from(reader.required("case"), catalogue);
  read.id = entry.test_case->id;
  read.setup.seed = judge::unsigned_from(reader.required("run_seed"));
  read.case_seed = judge::unsigned_from(reader.required("case_seed"));
  read.setup.volume = reader.required("volume").as_choice<conformance::Volume>(
      {{"quick", conformance::Volume::quick}, {"full", conformance::Volume::full}});
  read.setup.implementations = implementations_from(reader.required("implementations"), *entry.suite);
  read.setup.network_file = path_from(reader.optional("network"), folder);
  read.setup.plan_file = path_from(reader.optional("plan"), folder);
  read.pics_file = path_from(reader.optional("pics"), folder);
  if (!read.pics_file.empty()) read.setup.pics = load_pics(read.pics_file, catalogue.pics_items());
  if (const auto quiet = reader.optional("quiet")) read.is_quiet = quiet->as_bool();
  read.end = end_from(reader);
  read.playback = path_from(reader.optional("playback"), folder);
  read.is_truncated = reader.required("truncated").as_bool();
  const std::uint64_t expected = conformance::case_seed(read.setup.seed, read.id);
  if (read.case_seed != expected) {
    config::fail(reader.required("case_seed"),
                 fmt::format("does not belong to run_seed and case; it would be \"{}\"", expected));
  }
  return read;
}

}  // namespace

std::string implementations_json(std::span<const conformance::Assignment> implementations) {
  ordered_json list = ordered_json::array();
  for (const conformance::Assignment& assignment : implementations) {
    list.push_back({{"role", assignment.role}, {"position", assignment.position}, {"uri", assignment.uri}});
  }
  return list.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

std::vector<conformance::Assignment> implementations_from(const config::Value& list,
                                                          const conformance::Suite& suite,
                                                          std::size_t last_position) {
  std::vector<conformance::Assignment> implementations;
  for (const config::Value& element : list.as_array()) {
    implementations.push_back(config::read_object(element, [](config::ObjectReader& reader) {
      conformance::Assignment assignment;
      assignment.role = reader.required("role").as_string();
      assignment.position = reader.required("position").as_integer<int>(0);
      assignment.uri = reader.required("uri").as_string();
      return assignment;
    }));
    if (const auto why = reason_not_runnable(implementations.back(), suite, last_position))
      config::fail(element, *why);
  }
  return implementations;
}

void store_case(const reports::RunDirectory& directory, const conformance::CaseRun& done,
                std::uint64_t run_seed) {
  const std::string& id = done.outcome.result.id;
  const conformance::Recording& recording = done.outcome.recording;
  const KeptFiles kept = keep_files(directory, done.setup);
  if (!recording.trace.records.empty()) store_recording(directory, done);
  if (recording.devices) directory.write_case(id, kPlayback, recording.devices->text());
  if (!done.outcome.result.log.empty()) directory.write_case(id, "log.txt", done.outcome.result.log);
  // Last, so that a case file never names a file that is not there.
  directory.write_case(id, kCaseFile, text_of(case_json(done, run_seed, kept, false)));
}

void write_quiet_case(const std::filesystem::path& file, const conformance::CaseRun& done,
                      const CaseFile& stored) {
  const std::filesystem::path folder = std::filesystem::absolute(file).parent_path();
  const auto seen = [&folder](const std::string& path) {
    return path.empty() ? path : std::filesystem::relative(path, folder).string();
  };
  const KeptFiles files{seen(done.setup.network_file), seen(done.setup.plan_file), seen(stored.pics_file)};
  reports::write_text_file(file.string(), text_of(case_json(done, stored.setup.seed, files, true)));
}

std::string capture_of(const conformance::Recording& recording, const std::string& id) {
  return reports::pcapng(recording.trace, recording.told_in(), program_name(), id);
}

std::string wave_dump_of(const conformance::Recording& recording, const std::string& id) {
  return reports::vcd(recording.trace, program_name(), id);
}

StoredEntry::StoredEntry(const CaseFile& stored, const Session& session) {
  if (stored.is_quiet) {
    quiet_ = std::make_unique<conformance::Catalogue>(make_suites(without_stresses(all_disturbances())));
  }
  entry_ = &(quiet_ ? *quiet_ : session.catalogue()).at(stored.id);
}

CaseFile load_case(const std::filesystem::path& file, const conformance::Catalogue& catalogue) {
  if (std::filesystem::is_directory(file)) refuse_folder(file);
  const config::Document document = config::Document::load(file);
  return config::read_object(document.root(), [&](config::ObjectReader& reader) {
    return read_case(reader, std::filesystem::absolute(file).parent_path(), catalogue);
  });
}

}  // namespace fieldproof::cli
