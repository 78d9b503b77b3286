#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "cli/verbs.hpp"

// `fieldproof explain`: what a case requires, where that stands, what it does and what it catches.
namespace fieldproof::cli {
namespace {

std::string source_text(const judge::Reference& reference) {
  const std::string clause = reference.clause.empty() ? "" : ", " + reference.clause;
  const char* trust = judge::is_verified(reference.standing) ? "" : ", unverified";
  return fmt::format("{}{} [{}{}]", reference.source, clause, judge::name(reference.standing), trust);
}

std::string catches_text(const conformance::Entry& entry) {
  std::string text;
  for (const conformance::Catch& caught : entry.test_case->catches) {
    const auto& known = entry.suite->deviations();
    const auto found = std::find_if(known.begin(), known.end(), [&](const conformance::Deviation& deviation) {
      return deviation.role == entry.test_case->role() && deviation.name == caught.deviation;
    });
    const std::string label = found->mutant.empty() ? "" : fmt::format(" ({})", found->mutant);
    text += fmt::format("  {}{}: {}\n    with the finding '{}'\n", found->name, label, found->description,
                        caught.reason);
  }
  return text.empty() ? "  nothing\n" : text;
}

}  // namespace

int explain(Session& session) {
  const conformance::Entry& entry = session.catalogue.at(session.operands.front());
  const conformance::TestCase& test_case = *entry.test_case;
  std::string text = fmt::format("{}\n", test_case.id);
  const auto field = [&text](const char* label, const std::string& value) {
    if (!value.empty()) text += fmt::format("\n{}\n  {}\n", label, value);
  };
  field("purpose", test_case.purpose);
  field("requirement", test_case.requirement);
  field("source", source_text(test_case.reference));
  for (const conformance::Detail& detail : test_case.details) {
    field("source of a detail", fmt::format("{}\n  with the findings {}", source_text(detail.reference),
                                            fmt::join(detail.reasons, ", ")));
  }
  field("stimulus", test_case.stimulus);
  field("expected", test_case.expected);
  field("tags", fmt::format("{}", fmt::join(test_case.tags, " ")));
  text += fmt::format("\ndeviations that it catches\n{}", catches_text(entry));
  text +=
      fmt::format("\ncommands\n  fieldproof run {}\n  fieldproof verify {}\n", test_case.id, test_case.id);
  for (const conformance::Catch& caught : test_case.catches) {
    text += fmt::format("  fieldproof run {} --iut {}=deviant:{}\n", test_case.id, test_case.role(),
                        caught.deviation);
  }
  session.terminal.print(text);
  return 0;
}

}  // namespace fieldproof::cli
