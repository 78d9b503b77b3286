#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "cli/build_info.hpp"
#include "cli/case_lists.hpp"
#include "cli/pics_file.hpp"
#include "cli/pics_roles.hpp"
#include "cli/protocol_entry.hpp"
#include "cli/run_setup.hpp"
#include "cli/verbs.hpp"
#include "reports/run_directory.hpp"
#include "reports/text_summary.hpp"

// `fieldproof list`: the cases, or the mutants, the protocols, the items of a PICS, of all roles or of one.
namespace fieldproof::cli {
namespace {

using nlohmann::ordered_json;

// What is listed besides cases.
constexpr std::array<std::string_view, 3> kOtherLists = {"protocols", "mutants", "pics"};

// One row as JSON and as text; `list` prints either.
struct Row {
  ordered_json json;
  std::string text;
};

Row row_of(const conformance::Entry& entry, const conformance::Setup& setup) {
  const conformance::TestCase& test_case = *entry.test_case;
  const std::optional<judge::Pics> pics = entry.suite->declared_pics(test_case, setup);
  std::optional<std::string> excluded;
  if (pics && test_case.not_applicable) excluded = test_case.not_applicable(*pics);
  Row row;
  row.json["id"] = test_case.id;
  row.json["purpose"] = test_case.purpose;
  row.json["requirement"] = test_case.requirement;
  row.json["verified"] = judge::is_verified(test_case.rests_on().standing);
  row.json["tags"] = test_case.tags;
  row.json["catches"] = ordered_json::array();
  for (const conformance::MustCatch& caught : test_case.catches) row.json["catches"].push_back(caught.mutant);
  if (excluded) row.json["not_applicable"] = *excluded;
  row.text = fmt::format("{}  {}", test_case.id, test_case.purpose);
  if (!test_case.tags.empty()) row.text += fmt::format("  +{}", fmt::join(test_case.tags, " +"));
  if (excluded) row.text += fmt::format("  not applicable: {}", *excluded);
  return row;
}

Row row_of(const conformance::MutantEntry& entry) {
  Row row;
  row.json["path"] = entry.path();
  row.json["label"] = entry.mutant->label;
  row.json["description"] = entry.mutant->description;
  row.text = fmt::format("{}  {}  {}", entry.path(), entry.mutant->label, entry.mutant->description);
  return row;
}

Row row_of(const judge::PicsItem& item) {
  Row row;
  row.json["item"] = item.name;
  row.json["answers"] = judge::answers_text(item);
  row.json["meaning"] = item.meaning;
  row.text = fmt::format("{}  {}  {}", item.name, judge::answers_text(item), item.meaning);
  return row;
}

// The items of one role, with what is taken where a PICS does not answer.
std::vector<Row> pics_rows_of(const Role& role, const Session& session) {
  std::vector<Row> rows;
  const auto& of_protocol = session.catalogue().suite(role.protocol).role_rows();
  const auto& of_role = *std::ranges::find(of_protocol, role.name, &conformance::RoleRow::name);
  if (of_role.pics_items.empty()) session.terminal.log(fmt::format("{} has no items of a PICS", role.path()));
  const auto& usual = of_role.usual_answers.items();
  for (const judge::PicsItem& item : of_role.pics_items) {
    Row row = row_of(item);
    const auto answer = usual.find(item.name);
    if (answer != usual.end()) {
      const std::string text = judge::answer_text(answer->second);
      row.json["default"] = text;
      row.text =
          fmt::format("{}  {}, otherwise {}  {}", item.name, judge::answers_text(item), text, item.meaning);
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

Row row_of(const conformance::Suite& suite) {
  Row row;
  row.json["protocol"] = suite.protocol();
  row.json["roles"] = suite.roles();
  const auto canaries =
      static_cast<std::size_t>(std::ranges::count_if(suite.cases(), conformance::is_canary));
  row.json["cases"] = suite.cases().size() - canaries;
  row.json["canaries"] = canaries;
  row.json["mutants"] = suite.mutants().size();
  row.text = fmt::format("{}  roles {}, {} cases ({} more must fail), {} mutants", suite.protocol(),
                         fmt::join(suite.roles(), " "), suite.cases().size() - canaries, canaries,
                         suite.mutants().size());
  return row;
}

// A protocol that nothing is attached to.
Row row_of_plans(const ProtocolEntry& protocol) {
  Row row;
  row.json["protocol"] = protocol.name;
  row.json["roles"] = nlohmann::ordered_json::array();
  for (const char* const none : {"cases", "canaries", "mutants"}) row.json[none] = 0;
  row.text = fmt::format("{}  no role to attach and no case; 'fieldproof plan' reads {}/{}", protocol.name,
                         protocol.name, protocol.planner.file);
  return row;
}

// The files of `--needs` and `--ctest`.
void write_case_lists(const Session& session, std::span<const conformance::Entry> entries) {
  const Settings& settings = session.settings;
  if (settings.is_set("needs"))
    reports::write_text_file(settings.text("needs"), needs_json(entries, tool_version()));
  if (!settings.is_set("ctest")) return;
  std::vector<std::string> options;
  for (const std::string& uri : settings.list("iut")) options.insert(options.end(), {"--iut", uri});
  if (settings.is_set("pics")) {
    options.insert(options.end(), {"--pics", std::filesystem::absolute(settings.text("pics")).string()});
  }
  const std::string program = std::filesystem::read_symlink("/proc/self/exe").string();
  reports::write_text_file(settings.text("ctest"),
                           ctest_script(entries, program, options, std::filesystem::current_path().string()));
}

std::vector<Row> case_rows_of(const Session& session) {
  std::vector<Row> rows;
  conformance::Setup setup;
  const std::vector<conformance::Entry> selected = session.catalogue().select(session.operands);
  if (session.settings.is_set("pics")) {
    setup.pics = load_pics(session.settings.text("pics"), session.catalogue().pics_items());
    expect_items_of(roles_of(selected), *setup.pics, session.settings.text("pics"), session.catalogue());
  }
  const std::vector<conformance::Entry> entries = shard_of(session.settings, selected);
  for (const conformance::Entry& entry : entries) rows.push_back(row_of(entry, setup));
  write_case_lists(session, entries);
  return rows;
}

// A test against the reference would be green without the device; and an implementation that only stands
// there is not tested.
void check_case_lists(const Session& session) {
  const Settings& settings = session.settings;
  for (const char* const option : {"needs", "ctest"}) {
    const bool is_of_cases = session.operands.empty() ||
                             std::ranges::count(kOtherLists, std::string_view(session.operands.front())) == 0;
    if (settings.is_set(option) && !is_of_cases)
      settings.refuse(option, "is of cases; name them by a selector");
  }
  const bool names_one = settings.origin("iut") != Origin::fallback;
  if (settings.is_set("ctest") && !names_one) {
    settings.refuse("ctest",
                    "needs the implementation that is to be tested; write for example --iut exec:./device");
  }
  if (!settings.is_set("ctest") && settings.origin("iut") == Origin::command_line) {
    settings.refuse("iut", "takes part in a list with --ctest only; judge it with 'fieldproof run'");
  }
}

std::vector<Row> rows_of(Session& session) {
  std::vector<Row> rows;
  const bool is_single = session.operands.size() == 1;
  if (is_single && session.operands.front() == "protocols") {
    for (const auto& suite : session.catalogue().suites()) rows.push_back(row_of(*suite));
    for (const ProtocolEntry& protocol : protocols())
      if (protocol.suite == nullptr && protocol.planner.plan != nullptr)
        rows.push_back(row_of_plans(protocol));
    return rows;
  }
  if (is_single && session.operands.front() == "mutants") {
    for (const conformance::MutantEntry& entry : session.catalogue().mutants()) rows.push_back(row_of(entry));
    return rows;
  }
  const std::vector<judge::PicsItem> items = session.catalogue().pics_items();
  if (is_single && session.operands.front() == "pics") {
    for (const judge::PicsItem& item : items) rows.push_back(row_of(item));
    return rows;
  }
  if (session.operands.size() == 2 && session.operands.front() == "pics")
    return pics_rows_of(role_named(session.operands.back()), session);
  return case_rows_of(session);
}

}  // namespace

int list(Session& session) {
  check_case_lists(session);
  const std::vector<Row> rows = rows_of(session);
  if (session.settings.is_set("json")) {
    ordered_json all = ordered_json::array();
    for (const Row& row : rows) all.push_back(row.json);
    const ordered_json answer = session.settings.is_set("count") ? ordered_json(rows.size()) : all;
    session.terminal.print(answer.dump(2) + "\n");
  } else if (session.settings.is_set("count")) {
    session.terminal.print(fmt::format("{}\n", rows.size()));
  } else {
    for (const Row& row : rows) session.terminal.print(reports::escaped_line(row.text) + "\n");
  }
  return 0;
}

}  // namespace fieldproof::cli
