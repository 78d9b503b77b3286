#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "cli/explained_numbers.hpp"
#include "cli/verbs.hpp"

// `fieldproof explain`: what a case requires, where that stands, what it does and what it catches; or the
// settings of a role, or one number.
namespace fieldproof::cli {
namespace {

std::string source_text(const judge::Reference& reference) {
  const std::string clause = reference.clause.empty() ? "" : ", " + reference.clause;
  const char* trust = judge::is_verified(reference.standing) ? "" : ", unverified";
  return fmt::format("{}{} [{}{}]", reference.source, clause, judge::name(reference.standing), trust);
}

std::string catches_text(const conformance::Entry& entry) {
  std::string text;
  for (const conformance::MustCatch& caught : entry.test_case->catches) {
    const auto& known = entry.suite->mutants();
    const auto found = std::find_if(known.begin(), known.end(), [&](const conformance::Mutant& mutant) {
      return mutant.role == entry.test_case->role() && mutant.name == caught.mutant;
    });
    const std::string label = found->label.empty() ? "" : fmt::format(" ({})", found->label);
    text += fmt::format("  {}{}: {}\n    with the finding '{}'\n", found->name, label, found->description,
                        caught.reason);
  }
  return text.empty() ? "  nothing\n" : text;
}

}  // namespace

int explain(Session& session) {
  if (const auto text = explained_numbers(session.catalogue(), session.operands.front())) {
    session.terminal.print(*text);
    return 0;
  }
  const conformance::Entry& entry = session.catalogue().at(session.operands.front());
  const conformance::TestCase& test_case = *entry.test_case;
  std::string text = fmt::format("{}\n", test_case.id);
  const auto field = [&text](const char* label, const std::string& value) {
    if (!value.empty()) text += fmt::format("\n{}\n  {}\n", label, value);
  };
  field("purpose", test_case.purpose);
  field("requirement", test_case.requirement);
  field("source", source_text(test_case.reference));
  for (const conformance::PartialSource& detail : test_case.details) {
    field("source of a detail", fmt::format("{}\n  with the findings {}", source_text(detail.reference),
                                            fmt::join(detail.reasons, ", ")));
  }
  field("stimulus", test_case.stimulus);
  field("expected", test_case.expected);
  if (!test_case.steps.empty()) field("steps", fmt::format("{}", fmt::join(test_case.steps, "\n  ")));
  field("tags", fmt::format("{}", fmt::join(test_case.tags, " ")));
  text += fmt::format("\nmutants that it catches\n{}", catches_text(entry));
  text +=
      fmt::format("\ncommands\n  fieldproof run {}\n  fieldproof verify {}\n", test_case.id, test_case.id);
  for (const conformance::MustCatch& caught : test_case.catches) {
    text += fmt::format("  fieldproof run {} --iut {}=mutant:{}\n", test_case.id, test_case.role(),
                        caught.mutant);
  }
  session.terminal.print(text);
  return 0;
}

}  // namespace fieldproof::cli
