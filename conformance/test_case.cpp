#include "conformance/test_case.hpp"

#include <algorithm>
#include <utility>

namespace fieldproof::conformance {

std::string TestCase::role() const {
  const std::size_t first = id.find('/');
  if (first == std::string::npos) return {};
  return id.substr(first + 1, id.find('/', first + 1) - first - 1);
}

std::string_view TestCase::requirement_of(std::string_view reason) const {
  const auto rule = std::ranges::find(rules, reason, &ReasonRule::reason);
  return rule == rules.end() ? std::string_view(requirement) : rule->rule;
}

const judge::Reference& TestCase::reference_of(std::string_view reason) const {
  for (const PartialSource& detail : details) {
    if (std::ranges::find(detail.reasons, reason) != detail.reasons.end()) return detail.reference;
  }
  return reference;
}

judge::Reference TestCase::rests_on() const {
  judge::Reference all = reference;
  for (const PartialSource& detail : details) all = judge::resting_on_both(std::move(all), detail.reference);
  return all;
}

TestCase must_case(std::string id, std::string purpose, std::string requirement, judge::Reference reference,
                   std::vector<MustCatch> catches, std::vector<PartialSource> details) {
  return {.id = std::move(id),
          .purpose = std::move(purpose),
          .requirement = std::move(requirement),
          .reference = std::move(reference),
          .details = std::move(details),
          .tags = {"must"},
          .catches = std::move(catches)};
}

void rest_also_on(TestCase& test_case, const std::vector<PartialSource>& details) {
  const auto is_told = [own = test_case.details](const std::string& reason) {
    return std::ranges::any_of(own, [&](const PartialSource& one) {
      return std::ranges::find(one.reasons, reason) != one.reasons.end();
    });
  };
  for (PartialSource detail : details) {
    std::erase_if(detail.reasons, is_told);
    if (!detail.reasons.empty()) test_case.details.push_back(std::move(detail));
  }
}

bool has_tag(const TestCase& test_case, std::string_view tag) {
  return std::find(test_case.tags.begin(), test_case.tags.end(), tag) != test_case.tags.end();
}

bool is_canary(const TestCase& test_case) {
  return has_tag(test_case, "canary");
}

std::string_view name(Volume volume) {
  return volume == Volume::quick ? "quick" : "full";
}

const trace::Dissector& Recording::told_in() const {
  static const trace::PlainDissector unknown;
  return dissector != nullptr ? *dissector : unknown;
}

}  // namespace fieldproof::conformance
