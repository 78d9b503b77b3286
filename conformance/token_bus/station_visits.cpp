#include "conformance/token_bus/station_visits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace fieldproof::conformance {
namespace {

bool is_frame_of(const DrivenFrame& one, unsigned priority) {
  return one.is_well_formed && one.is_data() && one.priority() == priority;
}

}  // namespace

namespace token_chart {

std::vector<DrivenFrame> visit(TokenScene& scene) {
  std::vector<DrivenFrame> data;
  for (;;) {
    const auto one = scene.bench.next(scene.bench.now() + scene.bench.slots(2));
    scene.judge.expect(one.has_value(), "token_missing", "data, and then the token", "silence");
    scene.since = one->end;
    if (one->is(TokenControl::token)) break;
    data.push_back(*one);
  }
  return data;
}

TokenStep sends(std::string what, std::vector<unsigned> priorities, std::string more, std::string missing) {
  return expected<TokenScene>(
      what + ", then the token", [what, priorities = std::move(priorities), more = std::move(more),
                                  missing = std::move(missing)](TokenScene& scene) {
        const std::vector<DrivenFrame> all = visit(scene);
        for (std::size_t n = 0; n < std::max(all.size(), priorities.size()); ++n) {
          scene.judge.expect(n < all.size(), missing, [&] {
            return Mismatch{{fmt::format("{}: data of priority {}", what, priorities[n])}, "the token"};
          });
          scene.judge.expect(n < priorities.size(), more,
                             [&] { return Mismatch{{what}, all[n].text(), all[n].begin}; });
          scene.judge.expect(is_frame_of(all[n], priorities[n]), "order_wrong", [&] {
            return Mismatch{
                {fmt::format("{}: data of priority {}", what, priorities[n])}, all[n].text(), all[n].begin};
          });
        }
      });
}

TokenStep others_hold_it_for(std::int64_t octets) {
  return stimulus<TokenScene>(
      fmt::format("the token is with the others until {} octet durations after it came", octets),
      [octets](TokenScene& scene) {
        const kernel::Time until = scene.token_came + scene.bench.octets(octets);
        scene.take_token();
        while (scene.bench.now() + scene.bench.octets(4'000) < until) {
          scene.send(scene.bench.data_frame(0x62, TokenBench::kBelow, TokenBench::kAbove, Octets(3'000)));
          scene.bench.wait(scene.bench.octets(8));
        }
        while (scene.bench.now() + scene.bench.octets(60) < until) {
          scene.send(scene.bench.frame(TokenControl::token, TokenBench::kBelow, TokenBench::kAbove));
          scene.bench.wait(scene.bench.octets(8));
        }
        // The token itself takes its time.
        scene.bench.run_until(until - scene.bench.octets(15));
      });
}

TokenStep sends_in_order() {
  return expected<TokenScene>("what was submitted, in that order, then the token", [](TokenScene& scene) {
    const std::vector<DrivenFrame> all = visit(scene);
    scene.judge.expect_equal(all.size(), scene.submitted.size(), "data_missing", "frames of data");
    for (std::size_t n = 0; n < all.size(); ++n) {
      scene.judge.expect(all[n].data() == scene.submitted[n], "order_wrong", [&] {
        return Mismatch{{fmt::format("number {} of what was submitted", n + 1)}, all[n].text(), all[n].begin};
      });
    }
  });
}

TokenStep timed_token() {
  return stimulus<TokenScene>("000E passes the token to the station", [](TokenScene& scene) {
    scene.token_came =
        scene.send(scene.bench.frame(TokenControl::token, scene.bench.address(), TokenBench::kAbove));
  });
}

TokenStep holds() {
  return expected<TokenScene>(
      "data of class 6, each begun within hi_pri_token_hold_time after the token, the last completed; one "
      "more "
      "would not have begun",
      [](TokenScene& scene) {
        const kernel::Time over =
            scene.since + scene.bench.octets(scene.bench.rules().high_priority_hold_octets);
        const std::vector<DrivenFrame> all = visit(scene);
        scene.judge.expect(!all.empty(), "hold_not_used", "data", "the token at once");
        for (const DrivenFrame& one : all) {
          scene.judge.expect(one.is_well_formed, "frame_cut", "whole frames", one.text());
          scene.judge.expect(one.begin < over, "hold_exceeded", [&] {
            return Mismatch{
                {fmt::format("no frame from {} on", kernel::describe(over))}, one.text(), one.begin};
          });
        }
        const kernel::Duration pause = all.size() > 1 ? all[1].begin - all[0].end : scene.bench.gap();
        scene.judge.expect(all.back().end + pause >= over, "hold_not_used", [&] {
          return Mismatch{{fmt::format("frames are begun until {}", kernel::describe(over))},
                          fmt::format("the last ends {}", kernel::describe(all.back().end))};
        });
      });
}

}  // namespace token_chart
}  // namespace fieldproof::conformance
