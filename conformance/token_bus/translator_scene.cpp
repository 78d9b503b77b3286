#include "conformance/token_bus/translator_scene.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace fieldproof::conformance {
namespace {

constexpr std::size_t kFrameOctets = 9;
constexpr std::size_t kMostShown = 60;
// Longer than any blanking.
constexpr std::int64_t kRestSymbols = 200;

}  // namespace

TranslatorScene::TranslatorScene(TranslatorBench& bench_, CaseJudge& judge_, unsigned round_)
    : Scene(bench_, judge_, round_), octets(bench_.random_octets(kFrameOctets)), begin(bench_.now()) {}

void TranslatorScene::request(std::string symbols) {
  bench.clear();
  begin = bench.now();
  requested = std::move(symbols);
  bench.request(requested);
}

void TranslatorScene::receive(const SideBits& bits) {
  bench.clear();
  begin = bench.now();
  bench.carry(bits);
}

void TranslatorScene::exchange(std::string script, SideBits bits) {
  if (bits.size() % 2 == 1) bits.push_back({'I', false, false});
  bench.clear();
  begin = bench.now();
  requested = std::move(script);
  bench.request_and_receive(requested, bits);
  bench.settle();
}

std::string TranslatorScene::answers_to(SideCommand command) {
  const std::size_t length = 2 * std::size_t{bench.configuration().answer_symbols};
  bench.clear();
  bench.command(command, length);
  bench.settle();
  std::string answers = bench.indicated().text();
  std::ranges::replace(answers, 'S', 'i');
  const std::size_t first = answers.find_first_not_of('i');
  if (first == std::string::npos) return answers.empty() ? "" : "i";
  if (first > bench.configuration().answer_symbols + bench.configuration().delay_symbols) return "late";
  answers = answers.substr(first);
  answers.erase(std::ranges::unique(answers).begin(), answers.end());
  return without_end(answers, 'i');
}

void TranslatorScene::bring_up() {
  for (const SideCommand one :
       {SideCommand::reset, SideCommand::disable_loopback, SideCommand::enable_transmitter}) {
    const std::string answers = answers_to(one);
    if (answers == "a") continue;
    const std::string right = fmt::format("ACK to {}", text_of(one));
    if (answers.empty()) judge.inconclusive("precondition_not_met", {{right}, "no answer"});
    judge.fail("answer_wrong", {{right}, fmt::format("the answers {}", answers)});
  }
  rest();
}

void TranslatorScene::rest() {
  bench.wait(bench.symbols(kRestSymbols));
  bench.clear();
}

void TranslatorScene::expect_sent(const std::string& bits, std::string_view reason) {
  bench.settle();
  const std::string& text = bench.sent().text();
  const std::string right = without_ends(bits, 'I');
  judge.expect(sent() == right, reason, [&] { return difference(right, sent()); });
  if (right.empty()) return;
  const auto expect_in_time = [&](std::size_t symbol, std::size_t bit, std::string_view which) {
    const kernel::Duration took = bench.sent().time_of(bit) - begin - bench.requested_symbols(symbol);
    judge.expect(took <= bench.delay() + kernel::kNanosecond, "sent_too_late", [&] {
      return Mismatch{
          {fmt::format("the {} bit at most {} after its request", which, kernel::describe(bench.delay()))},
          kernel::describe(took)};
    });
  };
  constexpr std::string_view kSent = "01PpNn";
  expect_in_time(requested.find_first_of(kSent), text.find_first_not_of('I'), "first");
  expect_in_time(requested.find_last_of(kSent), text.find_last_not_of('I') - 1, "last");
}

void TranslatorScene::expect_nothing_sent(std::string_view reason, std::string_view why) {
  bench.settle();
  judge.expect(sent().empty(), reason, [&] {
    return Mismatch{{fmt::format("nothing is sent: {}", why)}, sent().substr(0, kMostShown)};
  });
}

std::string TranslatorScene::content() const {
  const std::string& text = bench.indicated().text();
  const std::size_t first = text.find('N');
  return first == std::string::npos ? "" : without_end(text.substr(first), 'S');
}

void TranslatorScene::expect_content(const std::string& symbols, std::string_view reason) {
  bench.settle();
  const std::string right = without_end(symbols, 'S');
  const std::string seen = content();
  judge.expect(seen == right, reason, [&] { return difference(right, seen); });
  const std::string& text = bench.indicated().text();
  judge.expect(text.substr(0, text.find('N')).find_first_not_of("01S") == std::string::npos, reason, [&] {
    return Mismatch{{"zeros, ones and silence before the start delimiter"}, text.substr(0, kMostShown)};
  });
}

std::string TranslatorScene::sent() const {
  return without_ends(bench.sent().text(), 'I');
}

std::string TranslatorScene::indicated() const {
  return without_ends(bench.indicated().text(), 'S');
}

std::string TranslatorScene::without_answers(std::string seen, const std::string& right,
                                             std::size_t first) const {
  constexpr std::string_view kCommands = "rltid";
  const std::size_t command = requested.find_first_of(kCommands);
  if (command == std::string::npos) return seen;
  const std::size_t end = requested.find_last_of(kCommands) + 1 + bench.configuration().answer_symbols;
  for (std::size_t n = command; n < end; ++n) {
    if (n < first || n - first >= std::min(seen.size(), right.size())) continue;
    char& one = seen[n - first];
    if (std::string_view("Sian").find(one) != std::string_view::npos) one = right[n - first];
  }
  return seen;
}

void TranslatorScene::expect_from_delimiter(const std::string& right, std::string_view reason) {
  const std::size_t first = right.find('N');
  const std::string wanted = right.substr(first);
  const std::string seen = without_answers(content(), wanted, first);
  judge.expect(seen == wanted, reason, [&] { return difference(wanted, seen); });
}

void TranslatorScene::expect_indicated(const std::vector<std::string>& right, std::string_view reason) {
  const std::string seen = indicated();
  judge.expect(std::ranges::find(right, seen) != right.end(), reason, [&] {
    Mismatch made = difference(right.front(), seen);
    for (std::size_t n = 1; n < right.size(); ++n) made.expected.push_back(right[n]);
    return made;
  });
}

void TranslatorScene::expect_nothing_indicated(std::string_view reason, std::string_view why) {
  bench.settle();
  judge.expect(without_end(bench.indicated().text(), 'S').empty(), reason, [&] {
    return Mismatch{{fmt::format("silence is indicated: {}", why)},
                    bench.indicated().text().substr(0, kMostShown)};
  });
}

TestCase translator_must(const std::string& id, std::string purpose, std::string requirement,
                         judge::Reference reference, std::vector<MustCatch> catches,
                         std::vector<PartialSource> details) {
  return must_case("token_bus/translator/" + id, std::move(purpose), std::move(requirement),
                   std::move(reference), std::move(catches), std::move(details));
}

namespace translator_chart {

TranslatorNeeds with_short_jabber() {
  return {.adjust = [](token_bus::TranslatorConfiguration& one) { one.jabber_symbols = kJabberSymbols; }};
}

TranslatorStep on_line() {
  return does(
      "the MAC brings the translator on line: RESET, DISABLE LOOPBACK, ENABLE TRANSMITTER, END PHYSICAL",
      [](TranslatorScene& scene) { scene.bring_up(); });
}
TranslatorStep pause() {
  return does("silence", [](TranslatorScene& scene) { scene.rest(); });
}
TranslatorStep does(std::string text, std::function<void(TranslatorScene&)> run) {
  return {std::move(text), {}, std::move(run)};
}
TranslatorStep requires_that(std::string text, std::function<void(TranslatorScene&)> run) {
  return {{}, std::move(text), std::move(run)};
}
TranslatorStep receives() {
  return {"a frame comes from the line", "it is indicated", [](TranslatorScene& scene) {
            scene.rest();
            const std::string frame = frame_text(scene.octets);
            scene.receive(encoded(frame));
            scene.expect_content(frame.substr(frame.find('N')), "does_not_recover");
          }};
}

}  // namespace translator_chart
}  // namespace fieldproof::conformance
