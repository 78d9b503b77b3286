#include "conformance/token_bus/station_listening.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace fieldproof::conformance::token_chart {

Octets right_token(TokenScene& scene) {
  return scene.bench.frame(TokenControl::token, scene.bench.address(), TokenBench::kAbove);
}

TokenStep drive(std::string text, std::function<line::Levels(TokenScene&)> make) {
  return stimulus<TokenScene>(std::move(text), [make = std::move(make)](TokenScene& scene) {
    scene.since = scene.bench.send_half_bits(make(scene));
  });
}

TokenStep ignored(std::string reason, std::string why) {
  return silence(2 * 28, std::move(reason), std::move(why));
}

TokenStep counted(std::string name, Counted which, std::uint32_t count) {
  return expected<TokenScene>(fmt::format("{} counted: {}", name, count), [=](TokenScene& scene) {
    scene.judge.expect_equal(scene.bench.counters().at(which), count, "counter_wrong", name + " counted");
  });
}

TokenStep delivered(std::string what, std::size_t count) {
  return require(
      what,
      [count](TokenScene& scene) {
        const auto& frames = scene.bench.user().frames;
        const auto& sent = scene.bench.sent();
        const auto last =
            std::find_if(sent.rbegin(), sent.rend(), [](const DrivenFrame& one) { return one.is_data(); });
        const bool is_right = frames.size() == count &&
                              (count == 0 || (last != sent.rend() && is_reported_as(*last, frames.back())));
        scene.bench.user().frames.clear();
        return is_right;
      },
      count == 0 ? "delivered_unasked" : "not_delivered");
}

TokenStep passes_on() {
  return says("the token to 0004", {TokenControl::token, TokenBench::kBelow}, at_once(), "token_missing",
              "token_wrong");
}

}  // namespace fieldproof::conformance::token_chart
