#include "cli/matrix_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

namespace fieldproof::cli {
namespace {

using conformance::Cell;
using conformance::Matrix;
using conformance::RoleMatrix;
using nlohmann::ordered_json;

// In the order of CellKind.
constexpr std::string_view kSigns = " -.#+!X";
constexpr const char* kLegend =
    "# caught for the declared reason   + caught, not declared   . passes   - not applicable\n"
    "! declared but not caught          X caught for another reason, or error\n";

char sign_of(const Cell& cell) {
  return kSigns.at(static_cast<std::size_t>(cell.kind));
}

// On the reference a pass is what is wanted, or a warn; anything that is not quiet is a false alarm.
char reference_sign(const Cell& cell) {
  if (cell.verdict == judge::Verdict::pass || cell.verdict == judge::Verdict::warn) return '.';
  return cell.kind == conformance::CellKind::not_applicable || cell.kind == conformance::CellKind::not_run
             ? sign_of(cell)
             : 'X';
}

// The labels of the columns, read from top to bottom.
std::string upright(const std::vector<std::string>& labels, std::size_t indent) {
  std::size_t height = 0;
  for (const std::string& label : labels) height = std::max(height, label.size());
  std::string text;
  for (std::size_t line = 0; line < height; ++line) {
    std::string row(indent, ' ');
    for (const std::string& label : labels) {
      const std::size_t offset = height - label.size();
      row += ' ';
      row += line < offset ? ' ' : label[line - offset];
    }
    row.erase(row.find_last_not_of(' ') + 1);
    text += row + "\n";
  }
  return text;
}

std::string short_id(const conformance::TestCase& test_case) {
  return test_case.id.substr(test_case.id.find('/', test_case.id.find('/') + 1) + 1);
}

std::string role_text(const RoleMatrix& role) {
  std::size_t width = 4;
  for (const conformance::TestCase* test_case : role.cases)
    width = std::max(width, test_case->purpose.size());
  std::vector<std::string> labels = {"ref"};
  for (const conformance::Mutant* mutant : role.mutants) labels.push_back(mutant->label);
  std::string text =
      fmt::format("{}: {} cases, {} mutants\n", role.role, role.cases.size(), role.mutants.size());
  text += upright(labels, width);
  for (std::size_t row = 0; row < role.cases.size(); ++row) {
    text += fmt::format("{:<{}} {}", role.cases[row]->purpose, width, reference_sign(role.reference[row]));
    for (const Cell& cell : role.cells[row]) text += fmt::format(" {}", sign_of(cell));
    text += fmt::format("  {}\n", short_id(*role.cases[row]));
  }
  return text + "\n";
}

ordered_json cell_json(const Cell& cell) {
  ordered_json json;
  json["kind"] = conformance::name(cell.kind);
  json["verdict"] = judge::name(cell.verdict);
  if (!cell.reason.empty()) json["reason"] = cell.reason;
  if (!cell.declared.empty()) json["declared"] = cell.declared;
  return json;
}

ordered_json role_json(const RoleMatrix& role) {
  ordered_json json;
  json["role"] = role.role;
  json["mutants"] = ordered_json::array();
  for (const conformance::Mutant* mutant : role.mutants) {
    json["mutants"].push_back(
        {{"name", mutant->name}, {"label", mutant->label}, {"description", mutant->description}});
  }
  json["cases"] = ordered_json::array();
  for (std::size_t row = 0; row < role.cases.size(); ++row) {
    ordered_json one;
    one["id"] = role.cases[row]->id;
    one["purpose"] = role.cases[row]->purpose;
    one["reference"] = cell_json(role.reference[row]);
    one["cells"] = ordered_json::array();
    for (const Cell& cell : role.cells[row]) one["cells"].push_back(cell_json(cell));
    json["cases"].push_back(std::move(one));
  }
  return json;
}

}  // namespace

std::string matrix_text(const Matrix& matrix) {
  std::string text = fmt::format("{}: cases x mutants, seed {}\n\n", matrix.protocol, matrix.seed);
  for (const RoleMatrix& role : matrix.roles) text += role_text(role);
  text += kLegend;
  for (const conformance::Hole& hole : matrix.holes) {
    text += fmt::format("{}: {}\n", conformance::name(hole.kind), hole.sentence);
  }
  if (!matrix.is_complete) return text + "the matrix is incomplete\n";
  return text + (matrix.holes.empty() ? "no survivor\n"
                                      : fmt::format("{} gaps in the suite\n", matrix.holes.size()));
}

std::string matrix_json(const Matrix& matrix) {
  ordered_json json;
  json["schema"] = "fieldproof/matrix/1";
  json["protocol"] = matrix.protocol;
  json["seed"] = std::to_string(matrix.seed);
  json["complete"] = matrix.is_complete;
  json["roles"] = ordered_json::array();
  for (const RoleMatrix& role : matrix.roles) json["roles"].push_back(role_json(role));
  json["holes"] = ordered_json::array();
  for (const conformance::Hole& hole : matrix.holes) {
    json["holes"].push_back({{"kind", conformance::name(hole.kind)},
                             {"case", hole.case_id},
                             {"mutant", hole.mutant},
                             {"sentence", hole.sentence}});
  }
  return json.dump(1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace fieldproof::cli
