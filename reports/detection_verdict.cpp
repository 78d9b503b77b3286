#include "reports/detection_verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace fieldproof::reports {

using judge::Verdict;

Said said_by_detection(const nlohmann::json& document) {
  constexpr double kLeastFound = 0.95;  // as the verb wants it, of each role
  Said said{Verdict::pass, ""};
  std::size_t found = 0;
  std::size_t pairs = 0;
  std::size_t alarms = 0;
  bool is_whole = true;
  for (const nlohmann::json& role : document.at("roles")) {
    const auto of_role = role.at("found").get<std::size_t>();
    const auto pairs_of_role = role.at("of").get<std::size_t>();
    found += of_role;
    pairs += pairs_of_role;
    alarms += role.at("false_alarms").size();
    is_whole = is_whole && role.at("complete").get<bool>();
    // Of what was not tried nobody knows.
    if (role.at("complete") == true &&
        static_cast<double>(of_role) < kLeastFound * static_cast<double>(pairs_of_role))
      said.verdict = Verdict::fail;
  }
  if (pairs == 0) return {Verdict::inconclusive, "random sequences were tried on no mutant"};
  said.sentence =
      fmt::format("random sequences find a mutant in {} of {} ({:.1f} %)", found, several(pairs, "trial"),
                  100.0 * static_cast<double>(found) / static_cast<double>(pairs));
  if (!is_whole) {
    said.verdict = std::max(said.verdict, Verdict::inconclusive);
    add_words(said.sentence, "the table is incomplete");
  }
  if (alarms > 0) {
    said.verdict = Verdict::fail;
    add_words(said.sentence, fmt::format("the reference was accused in {}", several(alarms, "sequence")));
  }
  return said;
}

}  // namespace fieldproof::reports
