#include "conformance/token_bus/station_scene.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace fieldproof::conformance {
namespace {

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
  expect_right(*one, right, span, what, wrong);
  return answer;
}

void TokenScene::expect_right(const DrivenFrame& one, const ExpectedFrame& right, const TokenSpan& span,
                              const std::string& what, std::string_view wrong) {
  answer = one;
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
}

void TokenScene::expect_silence(kernel::Duration duration, std::string_view reason, std::string_view why) {
  const auto one = bench.next(bench.now() + duration);
  judge.expect(!one, reason,
               [&] { return Mismatch{{fmt::format("silence: {}", why)}, one->text(), one->begin}; });
}

// The answer of one that is solicited, and its token.
void TokenScene::join_between(TokenControl solicit, std::uint64_t before, std::uint64_t after) {
  bench.wait(bench.octets(kPauseOctets));
  send(bench.frame(solicit, after, before));
  const auto one = bench.next(bench.now() + bench.slots(2));
  if (!one && bench.driven().empty())
    judge.inconclusive("precondition_not_met", {{"a station that answers"}, "it has driven nothing"});
  judge.expect(one.has_value(), "answer_missing", "set_successor", "silence");
  expect_right(*one, {TokenControl::set_successor, before, bench.address()}, at_once(),
               "set_successor to who solicits", "answer_wrong");
  bench.wait(bench.octets(kPauseOctets));
  send(bench.frame(TokenControl::token, bench.address(), before));
  expect_frame({TokenControl::token, after}, at_once(), "the token to its successor", "token_missing",
               "token_wrong");
}

void TokenScene::join(bool is_lowest) {
  const std::uint64_t before = is_lowest ? 0x000C : TokenBench::kAbove;
  const std::uint64_t after = is_lowest ? TokenBench::kAbove : TokenBench::kBelow;
  join_between(is_lowest ? TokenControl::solicit_2 : TokenControl::solicit_1, before, after);
  bench.wait(bench.octets(kPauseOctets));
  send(bench.frame(TokenControl::token, is_lowest ? before : TokenBench::kAbove, after));
  bench.wait(bench.octets(kPauseOctets));
  bench.user().frames.clear();
  bench.user().events.clear();
}

void TokenScene::fail_to_pass() {
  join_between(TokenControl::solicit_1, TokenBench::kAbove, TokenBench::kBelow);
  const auto expect_sought = [&](const ExpectedFrame& right, unsigned slots, const std::string& what) {
    expect_frame(right, after_slots(slots), what, "token_missing", "token_wrong");
  };
  expect_sought({TokenControl::token, TokenBench::kBelow}, 1, "the token to 0004 again");
  for (const unsigned slots : {1U, 3U})
    expect_sought({TokenControl::who_follows, TokenBench::kBelow, TokenBench::kBelow}, slots,
                  "who_follows 0004");
  expect_sought({TokenControl::solicit_2, bench.address()}, 3, "a solicitation of anybody");
  bench.run_until(since + bench.slots(2) + bench.octets(1));
}

void TokenScene::take_token() {
  bench.wait(bench.octets(kPauseOctets));
  send(bench.frame(TokenControl::token, TokenBench::kAbove, TokenBench::kBelow));
  bench.wait(bench.octets(kPauseOctets));
}

void TokenScene::rotate_until_window() {
  const unsigned most = bench.rules().max_inter_solicit_count + 4;
  for (unsigned n = 0; n < most; ++n) {
    send(bench.frame(TokenControl::token, bench.address(), TokenBench::kAbove));
    const auto one = bench.next(bench.now() + bench.slots(2));
    judge.expect(one.has_value(), "token_missing", "the token, or a response window", "silence");
    answer = *one;
    since = answer.end;
    if (one->is(TokenControl::solicit_1) || one->is(TokenControl::solicit_2)) return;
    take_token();
  }
  judge.fail("window_missing", {{fmt::format("a response window after {} tokens at most", most)}, "none"});
}

TestCase token_must(const std::string& id, std::string purpose, std::string requirement,
                    judge::Reference reference, std::vector<MustCatch> catches,
                    std::vector<PartialSource> details) {
  TestCase test_case = must_case("token_bus/station/" + id, std::move(purpose), std::move(requirement),
                                 std::move(reference), std::move(catches), std::move(details));
  // What leads to a case may be found wrong in it: that is the standard's, where the case is not about it.
  PartialSource joining{token_sources::standard("response windows, token pass"),
                        {"answer_missing", "answer_wrong", "token_missing", "token_wrong"}};
  std::erase_if(joining.reasons, [&](const std::string& reason) {
    return std::ranges::count(test_case.catches, reason, &MustCatch::reason) > 0;
  });
  rest_also_on(test_case, {joining});
  return test_case;
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
  return {"the token goes round", "when enough tokens have gone by the station opens a response window",
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
          scene.submitted.push_back(scene.data);
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

std::vector<TokenStep> and_then(std::vector<TokenStep> first, std::vector<TokenStep> second,
                                std::vector<TokenStep> third) {
  first.insert(first.end(), second.begin(), second.end());
  first.insert(first.end(), third.begin(), third.end());
  return first;
}

TokenStep repeat(Rounds times, std::vector<TokenStep> steps) {
  return repeated<TokenScene>(times, std::move(steps));
}

TokenStep require(std::string text, std::function<bool(TokenScene&)> holds, std::string reason) {
  std::string expected_text = text;
  return expected<TokenScene>(std::move(expected_text), [text = std::move(text), holds = std::move(holds),
                                                         reason = std::move(reason)](TokenScene& scene) {
    scene.judge.expect(holds(scene), reason,
                       [&] { return Mismatch{{text}, "it is otherwise; " + scene.bench.user_text()}; });
  });
}

TokenStep reported(const std::string& text, token_bus::EventKind kind, std::uint64_t about) {
  return require(
      fmt::format("{} is reported to its user, about {:04X}", text, about),
      [kind, about](TokenScene& scene) { return scene.bench.user().has_event(kind, about); }, "not_reported");
}

}  // namespace token_chart
}  // namespace fieldproof::conformance
