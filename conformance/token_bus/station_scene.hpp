#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "conformance/chart.hpp"
#include "conformance/token_bus/station_bench.hpp"
#include "conformance/token_bus/station_cases.hpp"

// The words of charts for a station of the token bus.
namespace fieldproof::conformance {

inline constexpr std::uint64_t kOwnAddress = 0x000A;

// When a frame must begin, from the end of what was on the line before it.
struct TokenSpan {
  kernel::Duration earliest{};
  kernel::Duration latest{};
};

struct ExpectedFrame {
  TokenControl control;
  std::optional<std::uint64_t> destination{};  // nothing: any
  std::optional<std::uint64_t> data{};         // an address
};

// What the steps of one round share.
struct TokenScene : Scene<TokenBench> {
  TokenScene(TokenBench& bench_, CaseJudge& judge_, unsigned round_)
      : Scene(bench_, judge_, round_), since(bench_.now()) {}

  // After the gap, and within the slot time in which others wait for it.
  TokenSpan at_once() const { return {bench.gap(), bench.slots(1)}; }
  // The same in a response window, counted from 0.
  TokenSpan in_window(unsigned window) const {
    return {bench.slots(window) + bench.gap(), bench.slots(window + 1)};
  }
  // When so many slot times are over.
  TokenSpan after_slots(unsigned count) const {
    return {bench.slots(count) - bench.octets(1), bench.slots(count) + bench.gap() + bench.octets(1)};
  }
  kernel::Time send(const Octets& octets, const FrameForm& form = {}) {
    return since = bench.send(octets, form);
  }
  // The next frame of the IUT: `begins_too_early`, `begins_too_late`, and the reasons for none or another.
  const DrivenFrame& expect_frame(const ExpectedFrame& right, const TokenSpan& span, const std::string& what,
                                  std::string_view missing, std::string_view wrong);
  // Of one that has come.
  void expect_right(const DrivenFrame& one, const ExpectedFrame& right, const TokenSpan& span,
                    const std::string& what, std::string_view wrong);
  void expect_silence(kernel::Duration duration, std::string_view reason, std::string_view why);
  // It becomes a member between 000E and 0004, or as the lowest below 000C. One that is absent is no matter
  // of the case: `precondition_not_met`. One that takes part and does it wrong fails, for the reasons of the
  // cases about joining and the pass.
  void join(bool is_lowest);
  void join_between(TokenControl solicit, std::uint64_t before, std::uint64_t after);
  // It joins, and nobody takes the token that it passes.
  void fail_to_pass();
  // As its successor: the token goes on.
  void take_token();
  // Until the IUT opens a window: `window_missing`.
  void rotate_until_window();

  kernel::Time since;               // the end of what was on the line last
  DrivenFrame answer{};             // what the IUT drove last, of what was required
  Octets data{};                    // of the last frame with data, of either side
  Octets first{};                   // of the first of two that wait
  std::vector<Octets> submitted{};  // by `submit`, in their order
  kernel::Time token_came{};        // the last one whose rotation is measured
  unsigned turn = 0;                // of steps that are repeated
};

using TokenStep = ChartStep<TokenScene>;

inline TokenCase on_chart(TestCase test_case, Chart<TokenScene> chart, TokenNeeds needs = {}) {
  return charted<TokenCase>(std::move(test_case), std::move(chart), needs);
}

// What an implementation must do.
TestCase token_must(const std::string& id, std::string purpose, std::string requirement,
                    judge::Reference reference, std::vector<MustCatch> catches,
                    std::vector<PartialSource> details = {});

namespace token_chart {

using SpanOf = std::function<TokenSpan(const TokenScene&)>;
using MakeOctets = std::function<Octets(TokenScene&)>;

SpanOf at_once();
SpanOf in_window(unsigned window);
SpanOf after_slots(unsigned count);

TokenStep joined();
TokenStep joined_as_lowest();
TokenStep until_window();
TokenStep wait(std::int64_t octets);
TokenStep send(std::string text, MakeOctets make, FrameForm form = {});
// The token for the IUT, from 000E.
TokenStep token();
// 0004 passes on the token that it got.
TokenStep taken();
TokenStep noise(std::size_t octets);
TokenStep submit(std::vector<unsigned> priorities, std::size_t size);
TokenStep says(std::string what, ExpectedFrame right, SpanOf span, std::string missing, std::string wrong);
TokenStep silence(std::int64_t octets, std::string reason, std::string why);
// A token is used: `does_not_recover`.
TokenStep serves();
// Lists of steps, one after the other.
std::vector<TokenStep> and_then(std::vector<TokenStep> first, std::vector<TokenStep> second,
                                std::vector<TokenStep> third = {});
TokenStep repeat(Rounds times, std::vector<TokenStep> steps);
TokenStep require(std::string text, std::function<bool(TokenScene&)> holds, std::string reason);
// To its user, and about whom: `not_reported`.
TokenStep reported(const std::string& text, token_bus::EventKind kind, std::uint64_t about);

}  // namespace token_chart
}  // namespace fieldproof::conformance
