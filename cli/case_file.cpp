#include "cli/case_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <nlohmann/json.hpp>

#include "cli/pics_file.hpp"
#include "harness/config/document.hpp"
#include "harness/judge/result_json.hpp"

namespace fieldproof::cli {
namespace {

using nlohmann::ordered_json;

constexpr std::string_view kSchema = "fieldproof/case/1";
constexpr const char* kPlayback = "playback.txt";

ordered_json pics_json(const judge::Pics& pics) {
  ordered_json items = ordered_json::object();
  for (const auto& [name, answer] : pics.items()) {
    std::visit([&items, key = name](const auto& value) { items[key] = value; }, answer);
  }
  return items;
}

ordered_json implementations_json(const conformance::Setup& setup) {
  ordered_json list = ordered_json::array();
  for (const conformance::Assignment& assignment : setup.implementations) {
    list.push_back({{"role", assignment.role}, {"position", assignment.position}, {"uri", assignment.uri}});
  }
  return list;
}

// Copies a file of the setup into the directory of the run and answers with its place as seen from a case.
std::string kept_file(const reports::RunDirectory& directory, const std::string& file, const char* name) {
  if (file.empty()) return {};
  directory.write(name, reports::read_text_file(file));
  return fmt::format("../../{}", name);
}

ordered_json case_json(const conformance::CaseRun& done, std::uint64_t run_seed, const std::string& network,
                       const std::string& plan) {
  const judge::CaseResult& result = done.outcome.result;
  ordered_json json;
  json["schema"] = kSchema;
  json["case"] = result.id;
  json["run_seed"] = std::to_string(run_seed);
  json["case_seed"] = std::to_string(result.seed);
  json["volume"] = conformance::name(done.setup.volume);
  json["implementations"] = implementations_json(done.setup);
  if (!network.empty()) json["network"] = network;
  if (!plan.empty()) json["plan"] = plan;
  if (done.setup.pics) json["pics"] = pics_json(*done.setup.pics);
  json["verdict"] = judge::name(result.verdict);
  json["reason"] = result.reason;
  json["fingerprint"] = judge::fingerprint_text(result.fingerprint);
  if (!done.outcome.recording.playback.empty()) json["playback"] = kPlayback;
  json["truncated"] = done.outcome.recording.truncated;
  return json;
}

std::uint64_t number_from(const config::Value& value, int base) {
  const std::string_view text = value.as_string();
  std::uint64_t number = 0;
  const auto [rest, failure] = std::from_chars(text.data(), text.data() + text.size(), number, base);
  if (failure != std::errc{} || rest != text.data() + text.size()) {
    config::fail(value, fmt::format("'{}' is no 64-bit number of base {}; write one as a text", text, base));
  }
  return number;
}

std::vector<conformance::Assignment> implementations_from(const config::Value& list) {
  std::vector<conformance::Assignment> implementations;
  for (const config::Value& element : list.as_array()) {
    implementations.push_back(config::read_object(element, [](config::ObjectReader& reader) {
      conformance::Assignment assignment;
      assignment.role = reader.required("role").as_string();
      assignment.position = reader.required("position").as_integer<int>(0, 4096);
      assignment.uri = reader.required("uri").as_string();
      return assignment;
    }));
  }
  return implementations;
}

std::string path_from(const std::optional<config::Value>& value, const std::filesystem::path& folder) {
  return value ? (folder / value->as_string()).lexically_normal().string() : std::string{};
}

CaseFile read_case(config::ObjectReader& reader, const std::filesystem::path& folder) {
  CaseFile read;
  reader.required("schema").as_choice(std::array{kSchema});
  read.id = reader.required("case").as_string();
  read.setup.seed = number_from(reader.required("run_seed"), 10);
  read.case_seed = number_from(reader.required("case_seed"), 10);
  read.setup.volume = reader.required("volume").as_choice<conformance::Volume>(
      {{"quick", conformance::Volume::quick}, {"full", conformance::Volume::full}});
  read.setup.implementations = implementations_from(reader.required("implementations"));
  read.setup.network_file = path_from(reader.optional("network"), folder);
  read.setup.plan_file = path_from(reader.optional("plan"), folder);
  if (const auto pics = reader.optional("pics")) read.setup.pics = pics_from(*pics);
  const config::Value verdict = reader.required("verdict");
  const auto known = judge::verdict_from(verdict.as_string());
  if (!known)
    config::fail(verdict, "is no verdict; write pass, warn, inconclusive, fail, error or not-applicable");
  read.verdict = *known;
  read.reason = reader.required("reason").as_string();
  read.fingerprint = number_from(reader.required("fingerprint"), 16);
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

void store_case(const reports::RunDirectory& directory, const conformance::CaseRun& done,
                std::uint64_t run_seed) {
  const std::string& id = done.outcome.result.id;
  const conformance::Recording& recording = done.outcome.recording;
  const std::string network = kept_file(directory, done.setup.network_file, "network.json");
  const std::string plan = kept_file(directory, done.setup.plan_file, "plan.json");
  if (!recording.lines.empty()) {
    directory.write_case(id, "trace.txt", fmt::format("{}\n", fmt::join(recording.lines, "\n")));
  }
  if (!recording.playback.empty()) directory.write_case(id, kPlayback, recording.playback);
  if (!done.outcome.result.log.empty()) directory.write_case(id, "log.txt", done.outcome.result.log);
  // Last, so that a case file never names a file that is not there.
  const ordered_json json = case_json(done, run_seed, network, plan);
  directory.write_case(id, "case.json",
                       json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n");
}

CaseFile load_case(const std::filesystem::path& file) {
  const config::Document document = config::Document::load(file);
  return config::read_object(document.root(), [&](config::ObjectReader& reader) {
    return read_case(reader, std::filesystem::absolute(file).parent_path());
  });
}

}  // namespace fieldproof::cli
