#include "cli/stored_document.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string_view>

#include "campaign/embedded_schemas.hpp"
#include "cli/build_info.hpp"
#include "cli/embedded_schemas.hpp"
#include "cli/run_setup.hpp"
#include "harness/kernel/error.hpp"
#include "harness/kernel/host_name.hpp"
#include "harness/kernel/untrusted_text.hpp"
#include "reports/embedded_schemas.hpp"
#include "reports/results.hpp"
#include "reports/run_directory.hpp"

namespace fieldproof::cli {
namespace {

std::string command_of(const Session& session, const std::string& verb, const std::string& more) {
  std::string command = "fieldproof " + verb;
  for (const std::string& operand : session.operands) command += " " + reports::shell_quoted(operand);
  const std::string options = session.settings.reproduce_options();
  for (const std::string& words : {options, more})
    if (!words.empty()) command += " " + words;
  return command;
}

}  // namespace

std::string date_of_document() {
  constexpr const char* kVariable = "SOURCE_DATE_EPOCH";
  const char* const set = std::getenv(kVariable);
  if (set == nullptr || *set == '\0') return utc_now();
  const std::string_view text = set;
  std::uint32_t seconds = 0;
  const auto [end, error] = std::from_chars(text.begin(), text.end(), seconds);
  if (error != std::errc{} || end != text.end()) {
    throw kernel::Error(kernel::ErrorKind::usage,
                        fmt::format("{}: '{}' is no number of seconds since 1970; unset it, or write for "
                                    "example 1764201600",
                                    kVariable, kernel::escaped_line(text)));
  }
  return utc_text(seconds);
}

void write_document(const Session& session, const std::string& verb, const std::string& json,
                    const std::string& more) {
  if (!session.settings.is_set("json")) return;
  using nlohmann::ordered_json;
  ordered_json document = ordered_json::parse(json);
  document["command"] = command_of(session, verb, more);
  document["inputs"] = judge::json_of(session.inputs);
  document["made"] = {
      {"tool_version", tool_version()}, {"date", date_of_document()}, {"host", kernel::host_name()}};
  reports::write_text_file(session.settings.text("json"),
                           document.dump(1, ' ', false, ordered_json::error_handler_t::replace) + "\n");
}

std::span<const reports::DocumentKind> document_kinds() {
  static const std::array kinds = {
      reports::DocumentKind{"fieldproof/emc/1", reports::emc_schema},
      reports::DocumentKind{"fieldproof/measurement/1", reports::measurement_schema},
      reports::DocumentKind{"fieldproof/publication/2", reports::publication_schema},
      reports::DocumentKind{"fieldproof/residual/1", reports::residual_schema},
      reports::DocumentKind{"fieldproof/matrix/1", matrix_schema},
      reports::DocumentKind{"fieldproof/detection/1", detection_schema},
      reports::DocumentKind{"fieldproof/emc_fit/1", reports::emc_fit_schema},
      reports::DocumentKind{"fieldproof/campaign/1", campaign::campaign_result_schema},
      reports::DocumentKind{"fieldproof/fuzz/1", fuzz_schema},
  };
  return kinds;
}

}  // namespace fieldproof::cli
