#pragma once

#include <vector>

#include "conformance/token_bus/station_scene.hpp"

// The life of a station in steps that follow from its settings, whatever they are.
namespace fieldproof::conformance::token_chart {

// With these rules, or some that are drawn from a range, both ends in it.
template <typename Set>
TokenNeeds with(Set set) {
  return {.adjust = [set](token_bus::StationConfiguration& configuration, kernel::Random&) {
    set(configuration.rules);
  }};
}
inline unsigned drawn(kernel::Random& random, unsigned least, unsigned most) {
  return least + static_cast<unsigned>(random.below(most - least + 1));
}

// All claims, from bus_idle_slots of silence on: `claim_missing`, `claim_wrong`, `claim_length_wrong`.
TokenStep claims();
// Each pair of bits of its address in its turn: set_successor to F000, which resolves contention.
TokenStep contest();
// The token to 0004: `token_missing`, `token_wrong`.
TokenStep passes_below(SpanOf span);
TokenStep asks_who_follows(SpanOf span);
// For 0004, of priority 6: `data_refused`.
TokenStep request();
TokenStep is_requested(SpanOf span);
// As often as max_retry_limit says, each after response_wait_slots; then the token.
TokenStep request_repeated();
// As long as a setting says.
SpanOf after_slots_of(unsigned token_bus::Rules::* count);

// It claims the token, solicits anybody, and has 0004 as its successor, which passes the token on.
std::vector<TokenStep> forms_ring();
// A token that nobody takes: once more, who follows twice, anybody.
std::vector<TokenStep> seeks_successor();
// All of a life: the ring, the token, a request that nobody answers, noise after the token, no successor.
std::vector<TokenStep> life();

}  // namespace fieldproof::conformance::token_chart
