#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "conformance/token_bus/station_scene.hpp"

// The words of charts about what a station sends while it has the token, and how long the others have it.
namespace fieldproof::conformance::token_chart {

// All that the station sends until the token, which it passes on: `token_missing`.
std::vector<DrivenFrame> visit(TokenScene& scene);

// Data of these priorities in this order: the reasons for more and for fewer; `order_wrong`.
TokenStep sends(std::string what, std::vector<unsigned> priorities, std::string more, std::string missing);
// What was submitted in the steps before, in that order: `data_missing`, `order_wrong`.
TokenStep sends_in_order();
// Data of class 6 from the token on: `hold_not_used`, `hold_exceeded`, `frame_cut`.
TokenStep holds();
// The token, from which a rotation is measured.
TokenStep timed_token();
// The token comes again so much later; the line is not silent meanwhile.
TokenStep others_hold_it_for(std::int64_t octets);

}  // namespace fieldproof::conformance::token_chart
