#include "conformance/valve_bus/node_cases.hpp"

#include <array>
#include <optional>
#include <utility>

namespace fieldproof::conformance {
namespace {

NodeCase canary() {
  return {canary_of("node", "the case asks for an answer that no node gives."),
          [](NodeBench& bench, CaseJudge& judge) {
            bench.read();
            bench.settle();
            const auto answers = bench.answers();
            judge.expect(answers.size() == 1 && answers.front().characters.size() == 300, "canary",
                         "an answer of 300 octets", "it was shorter");
          }};
}

}  // namespace

const std::vector<NodeCase>& node_cases() {
  static const std::vector<NodeCase> cases = [] {
    static constexpr std::array kChapters{node_write_cases, node_read_cases,    node_address_cases,
                                          node_check_cases, node_framing_cases, node_timing_cases,
                                          node_line_cases,  node_power_cases,   node_immunity_cases};
    auto all = cases_of<NodeCase>(kChapters, node_details());
    all.push_back(canary());
    return all;
  }();
  return cases;
}

std::function<std::optional<std::string>(const judge::Pics&)> for_node_with(std::string item,
                                                                            std::string sentence) {
  return [item = std::move(item),
          sentence = std::move(sentence)](const judge::Pics& pics) -> std::optional<std::string> {
    // What is not answered is as the bench's own node is.
    if (pics.completed_by(declared_node()).supports(item)) return std::nullopt;
    return sentence;
  };
}

}  // namespace fieldproof::conformance
