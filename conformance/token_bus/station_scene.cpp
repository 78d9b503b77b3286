#include "conformance/token_bus/station_scene.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fieldproof::conformance {
namespace {

constexpr unsigned kMostTokensUntilWindow = 20;
constexpr std::int64_t kPauseOctets = 8;

bool is_right(const DrivenFrame& one, const ExpectedFrame& right) {
  return one.is_well_formed && one.has_right_check && one.is(right.control) &&
         (!right.destination || one.destination() == *right.destination) &&
         (!right.data || (one.data().size() == one.address_octets && one.address_in_data() == *right.data));
}

}  // namespace

const DrivenFrame& TokenScene::expect_frame(const ExpectedFrame& right, const TokenSpan& span,
                                            const std::string& what, std::string_view missing,
                                            std::string_view wrong) {
  const auto one = bench.next(since + span.latest + bench.slots(1));
  if (!one) judge.fail(missing, {{what}, "silence"});
  answer = *one;
  judge.expect(is_right(answer, right), wrong, [&] { return Mismatch{{what}, answer.text(), answer.begin}; });
  const auto expect_instant = [&](bool holds, std::string_view reason) {
    judge.expect(holds, reason, [&] {
      return Mismatch{{fmt::format("{}, begun {} to {} after what was before", what,
                                   kernel::describe(span.earliest), kernel::describe(span.latest))},
                      fmt::format("begun {} after it", kernel::describe(answer.begin - since)),
                      answer.begin};
    });
  };
  expect_instant(answer.begin >= since + span.earliest - kTokenRounding, "begins_too_early");
  expect_instant(answer.begin <= since + span.latest + kTokenRounding, "begins_too_late");
  since = answer.end;
  return answer;
}

void TokenScene::expect_silence(kernel::Duration duration, std::string_view reason, std::string_view why) {
  const auto one = bench.next(bench.now() + duration);
  judge.expect(!one, reason,
               [&] { return Mismatch{{fmt::format("silence: {}", why)}, one->text(), one->begin}; });
}

void TokenScene::join(bool is_lowest) {
  const auto expect_next = [&](TokenControl control, std::uint64_t destination) {
    const auto one = bench.next(bench.now() + bench.slots(2));
    if (!one || !one->is(control) || one->destination() != destination) {
      judge.inconclusive("precondition_not_met", {{"the station joins a ring and passes the token on"},
                                                  one ? one->text() : "silence"});
    }
    since = one->end;
  };
  const std::uint64_t before = is_lowest ? 0x000C : TokenBench::kAbove;
  const std::uint64_t after = is_lowest ? TokenBench::kAbove : TokenBench::kBelow;
  bench.wait(bench.octets(kPauseOctets));
  send(bench.frame(is_lowest ? TokenControl::solicit_2 : TokenControl::solicit_1, after, before));
  expect_next(TokenControl::set_successor, before);
  bench.wait(bench.octets(kPauseOctets));
  send(bench.frame(TokenControl::token, bench.address(), before));
  expect_next(TokenControl::token, after);
  bench.wait(bench.octets(kPauseOctets));
  send(bench.frame(TokenControl::token, is_lowest ? before : TokenBench::kAbove, after));
  bench.wait(bench.octets(kPauseOctets));
  bench.user().frames.clear();
  bench.user().events.clear();
}

void TokenScene::take_token() {
  bench.wait(bench.octets(kPauseOctets));
  send(bench.frame(TokenControl::token, TokenBench::kAbove, TokenBench::kBelow));
  bench.wait(bench.octets(kPauseOctets));
}

void TokenScene::rotate_until_window() {
  for (unsigned n = 0; n < kMostTokensUntilWindow; ++n) {
    send(bench.frame(TokenControl::token, bench.address(), TokenBench::kAbove));
    const auto one = bench.next(bench.now() + bench.slots(2));
    if (!one) break;
    answer = *one;
    since = answer.end;
    if (one->is(TokenControl::solicit_1) || one->is(TokenControl::solicit_2)) return;
    take_token();
  }
  judge.fail("window_missing",
             {{fmt::format("a response window after {} tokens at most", kMostTokensUntilWindow)}, "none"});
}

TestCase token_must(const std::string& id, std::string purpose, std::string requirement,
                    judge::Reference reference, std::vector<MustCatch> catches,
                    std::vector<PartialSource> details) {
  return must_case("token_bus/station/" + id, std::move(purpose), std::move(requirement),
                   std::move(reference), std::move(catches), std::move(details));
}

namespace token_chart {

SpanOf at_once() {
  return [](const TokenScene& scene) { return scene.at_once(); };
}
SpanOf in_window(unsigned window) {
  return [window](const TokenScene& scene) { return scene.in_window(window); };
}
SpanOf after_slots(unsigned count) {
  return [count](const TokenScene& scene) { return scene.after_slots(count); };
}

TokenStep joined() {
  return stimulus<TokenScene>("the station becomes a member of the ring between 000E and 0004",
                              [](TokenScene& scene) { scene.join(false); });
}

TokenStep joined_as_lowest() {
  return stimulus<TokenScene>("the station becomes the lowest of the ring, after 000C, before 000E",
                              [](TokenScene& scene) { scene.join(true); });
}

TokenStep until_window() {
  return {"the token goes round", "after 20 tokens at most the station opens a response window",
          [](TokenScene& scene) { scene.rotate_until_window(); }};
}

TokenStep wait(std::int64_t octets) {
  return stimulus<TokenScene>(fmt::format("{} octet durations pass", octets),
                              [octets](TokenScene& scene) { scene.bench.wait(scene.bench.octets(octets)); });
}

TokenStep send(std::string text, MakeOctets make, FrameForm form) {
  return stimulus<TokenScene>(
      std::move(text), [make = std::move(make), form](TokenScene& scene) { scene.send(make(scene), form); });
}

TokenStep token() {
  return send("000E passes the token to the station", [](TokenScene& scene) {
    return scene.bench.frame(TokenControl::token, scene.bench.address(), TokenBench::kAbove);
  });
}

TokenStep taken() {
  return stimulus<TokenScene>("its successor passes the token on",
                              [](TokenScene& scene) { scene.take_token(); });
}

TokenStep noise(std::size_t octets) {
  return stimulus<TokenScene>(fmt::format("{} octet durations of signal without a start delimiter", octets),
                              [octets](TokenScene& scene) { scene.since = scene.bench.send_noise(octets); });
}

TokenStep submit(std::vector<unsigned> priorities, std::size_t size) {
  return stimulus<TokenScene>(
      fmt::format("the user submits data of {} octets of priority {}", size, fmt::join(priorities, ", ")),
      [priorities, size](TokenScene& scene) {
        for (const unsigned priority : priorities) {
          scene.data = scene.bench.numbered_data(size);
          const bool is_taken = scene.bench.submit(
              {.priority = priority, .destination = TokenBench::kBelow, .data = scene.data});
          scene.judge.expect(is_taken, "data_refused", "the data is accepted", "it was refused");
        }
      });
}

TokenStep says(std::string what, ExpectedFrame right, SpanOf span, std::string missing, std::string wrong) {
  std::string text = what;
  return expected<TokenScene>(
      std::move(text), [what = std::move(what), right, span = std::move(span), missing = std::move(missing),
                        wrong = std::move(wrong)](TokenScene& scene) {
        scene.expect_frame(right, span(scene), what, missing, wrong);
      });
}

TokenStep silence(std::int64_t octets, std::string reason, std::string why) {
  std::string text = fmt::format("silence for {} octet durations: {}", octets, why);
  return expected<TokenScene>(std::move(text),
                              [octets, reason = std::move(reason), why = std::move(why)](TokenScene& scene) {
                                scene.expect_silence(scene.bench.octets(octets), reason, why);
                              });
}

TokenStep serves() {
  return {"000E passes the token to the station", "it passes the token on", [](TokenScene& scene) {
            scene.send(scene.bench.frame(TokenControl::token, scene.bench.address(), TokenBench::kAbove));
            const auto one = scene.bench.next(scene.bench.now() + scene.bench.slots(2));
            scene.judge.expect(one && one->is(TokenControl::token), "does_not_recover",
                               "a right token is used", one ? one->text() : "silence");
            scene.take_token();
          }};
}

TokenStep repeat(Rounds times, std::vector<TokenStep> steps) {
  return repeated<TokenScene>(times, std::move(steps));
}

TokenStep require(std::string text, std::function<bool(TokenScene&)> holds, std::string reason) {
  std::string expected_text = text;
  return expected<TokenScene>(std::move(expected_text), [text = std::move(text), holds = std::move(holds),
                                                         reason = std::move(reason)](TokenScene& scene) {
    scene.judge.expect(holds(scene), reason, text, "it is otherwise");
  });
}

TokenStep reported(const std::string& text, token_bus::EventKind kind, std::uint64_t about) {
  return require(
      fmt::format("{} is reported to its user, about {:04X}", text, about),
      [kind, about](TokenScene& scene) { return scene.bench.user().has_event(kind, about); }, "not_reported");
}

}  // namespace token_chart
}  // namespace fieldproof::conformance
