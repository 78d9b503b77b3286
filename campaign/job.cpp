#include "campaign/job.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "harness/judge/checked_lines.hpp"
#include "harness/kernel/untrusted_text.hpp"
#include "reports/results.hpp"

namespace fieldproof::campaign {
namespace {

using nlohmann::ordered_json;

std::string text_of(const ordered_json& json) {
  return json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

}  // namespace

std::string_view JobResult::file(std::string_view name) const {
  const auto found = std::ranges::find(files, name, &KeptFile::name);
  return found == files.end() ? std::string_view{} : std::string_view(found->text);
}

std::string command_of(const Job& job) {
  std::string command = "fieldproof " + job.verb;
  for (const std::string& word : job.arguments) command += " " + reports::shell_quoted(word);
  return command;
}

std::string to_json(const Job& job) {
  ordered_json outputs = ordered_json::array();
  for (const OutputFile& file : job.outputs)
    outputs.push_back({{"option", file.option}, {"name", file.name}});
  ordered_json inputs = ordered_json::array();
  for (const judge::InputFile& file : job.inputs)
    inputs.push_back({{"path", file.path}, {"hash", file.hash}});
  return text_of({{"id", job.id},
                  {"verb", job.verb},
                  {"arguments", job.arguments},
                  {"manner", job.manner},
                  {"outputs", std::move(outputs)},
                  {"inputs", std::move(inputs)},
                  {"limit_ms", job.limit.count()}});
}

Job job_from_json(std::string_view text) {
  const ordered_json json = ordered_json::parse(text);
  Job job;
  json.at("id").get_to(job.id);
  json.at("verb").get_to(job.verb);
  json.at("arguments").get_to(job.arguments);
  json.at("manner").get_to(job.manner);
  for (const auto& file : json.at("outputs")) job.outputs.push_back({file.at("option"), file.at("name")});
  for (const auto& file : json.at("inputs")) job.inputs.push_back({file.at("path"), file.at("hash")});
  job.limit = std::chrono::milliseconds(json.at("limit_ms").get<std::int64_t>());
  return job;
}

std::string to_json(const JobResult& result) {
  ordered_json files = ordered_json::array();
  for (const KeptFile& file : result.files) files.push_back({{"name", file.name}, {"text", file.text}});
  return text_of({{"id", result.id},
                  {"exit_code", result.exit_code},
                  {"loss", result.loss},
                  {"obstacle", result.obstacle},
                  {"obstacle_code", result.obstacle_code},
                  {"log", kernel::as_utf8(result.log)},
                  {"files", std::move(files)},
                  {"wall_time_ms", result.wall_time_ms}});
}

JobResult result_from_json(std::string_view text) {
  const ordered_json json = ordered_json::parse(text);
  JobResult result;
  json.at("id").get_to(result.id);
  json.at("exit_code").get_to(result.exit_code);
  json.at("loss").get_to(result.loss);
  json.at("obstacle").get_to(result.obstacle);
  json.at("obstacle_code").get_to(result.obstacle_code);
  json.at("log").get_to(result.log);
  for (const auto& file : json.at("files")) result.files.push_back({file.at("name"), file.at("text")});
  json.at("wall_time_ms").get_to(result.wall_time_ms);
  return result;
}

}  // namespace fieldproof::campaign
