#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "campaign/embedded_schemas.hpp"
#include "cli/embedded_schemas.hpp"
#include "cli/named_schemas.hpp"
#include "cli/protocol_entry.hpp"
#include "cli/verbs.hpp"
#include "emc/embedded_schemas.hpp"
#include "harness/config/nearest.hpp"
#include "harness/fault/embedded_schemas.hpp"
#include "harness/field/json_schema.hpp"
#include "harness/kernel/error.hpp"
#include "reports/embedded_schemas.hpp"

// `fieldproof schema`: the JSON Schema of a file, or of what an implementation is given in a role.
namespace fieldproof::cli {
namespace {

using nlohmann::ordered_json;

void add_files(std::vector<NamedText>& all) {
  for (const auto& [name, text] : {std::pair{"baseline", baseline_schema},
                                   {"case", case_schema},
                                   {"configuration", configuration_schema},
                                   {"detection", detection_schema},
                                   {"emc_case", emc_case_schema},
                                   {"fuzz", fuzz_schema},
                                   {"matrix", matrix_schema},
                                   {"faults", fault::plan_schema},
                                   {"profile", emc::profile_schema},
                                   {"diff", reports::diff_schema},
                                   {"emc", reports::emc_schema},
                                   {"emc_fit", reports::emc_fit_schema},
                                   {"journal", reports::journal_schema},
                                   {"manifest", reports::manifest_schema},
                                   {"measurement", reports::measurement_schema},
                                   {"publication", reports::publication_schema},
                                   {"residual", reports::residual_schema},
                                   {"results", reports::results_schema},
                                   {"timeline", reports::timeline_schema},
                                   {"timings", reports::timings_schema}}) {
    all.push_back({name, std::string(text)});
  }
}

}  // namespace

std::string pics_schema_text(const conformance::Catalogue& catalogue) {
  const std::vector<judge::PicsItem> items = catalogue.pics_items();
  const ordered_json schema{
      {"$schema", "http://json-schema.org/draft-07/schema#"},
      {"title", "PICS"},
      {"description",
       "What an implementation declares about itself, for --pics. Comments are allowed. What is not answered "
       "is as the suite takes for granted; 'fieldproof list pics' shows the items."},
      {"type", "object"},
      {"additionalProperties", false},
      {"required", {"items"}},
      {"properties",
       {{"$schema", {{"description", "For editors."}}},
        {"items",
         {{"type", "object"},
          {"additionalProperties", false},
          {"properties", field::properties_of(items)}}}}}};
  return schema.dump(2) + "\n";
}

std::vector<NamedText> named_schemas(const conformance::Catalogue& catalogue) {
  std::vector<NamedText> all;
  add_files(all);
  all.push_back({"pics", pics_schema_text(catalogue)});
  all.push_back({"campaign", campaign_schema_text()});
  all.push_back({"campaign_result", std::string(campaign::campaign_result_schema)});
  all.push_back({"sequence", sequence_schema_text(catalogue)});
  for (const auto& suite : catalogue.suites()) {
    for (const field::NamedSchema& file : suite->schemas()) {
      all.push_back({fmt::format("{}/{}", suite->protocol(), file.name), std::string(file.text)});
    }
  }
  for (const ProtocolEntry& protocol : protocols()) {
    if (protocol.schemas == nullptr) continue;
    for (const field::NamedSchema& file : protocol.schemas())
      all.push_back({fmt::format("{}/{}", protocol.name, file.name), std::string(file.text)});
  }
  std::ranges::sort(all, {}, &NamedText::name);
  for (const auto& suite : catalogue.suites()) {
    const std::vector<std::string> roles = suite->roles();
    for (const field::NamedTable& one : suite->tables()) {
      // Numbers of a protocol that belong to no role are settings of nobody.
      if (std::ranges::find(roles, one.name) == roles.end()) continue;
      std::string name = fmt::format("{}/{}", suite->protocol(), one.name);
      std::string text = field::settings_schema_of(*one.table, name).dump(2) + "\n";
      all.push_back({std::move(name), std::move(text)});
    }
  }
  return all;
}

namespace {

// Without its protocol a name is near to all that end like it.
std::vector<std::string> near_to(const std::string& wanted, const std::vector<NamedText>& all) {
  const bool is_short = wanted.find('/') == std::string::npos;
  const auto key_of = [is_short](const std::string& name) {
    const std::string_view whole = name;
    return is_short ? whole.substr(whole.rfind('/') + 1) : whole;
  };
  std::vector<std::string_view> keys;
  for (const NamedText& one : all) {
    if (const auto key = key_of(one.name); std::ranges::find(keys, key) == keys.end()) keys.push_back(key);
  }
  std::vector<std::string> names;
  for (const std::string_view key : config::nearest(wanted, keys, 3)) {
    for (const NamedText& one : all)
      if (key_of(one.name) == key) names.push_back(one.name);
  }
  return names;
}

}  // namespace

int schema(Session& session) {
  const std::vector<NamedText> all = named_schemas(session.catalogue());
  if (session.operands.empty()) {
    for (const NamedText& one : all) session.terminal.print(one.name + "\n");
    return 0;
  }
  const std::string& wanted = session.operands.front();
  const auto found = std::ranges::find(all, wanted, &NamedText::name);
  if (found == all.end()) {
    throw kernel::Error(kernel::ErrorKind::usage, fmt::format("there is no schema '{}'; near to it are {}",
                                                              wanted, fmt::join(near_to(wanted, all), ", ")));
  }
  session.terminal.print(found->text);
  return 0;
}

}  // namespace fieldproof::cli
