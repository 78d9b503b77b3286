#include "conformance/token_bus/translator_scene.hpp"

// Settings at the ends of their ranges: what a translator has as a constant shows.
namespace fieldproof::conformance {
namespace {

using namespace translator_chart;
using token_bus::TranslatorConfiguration;
using token_sources::own;

constexpr std::size_t kOnes = 60;  // longer than any blanking

template <auto member, unsigned value>
TranslatorNeeds where_it_is() {
  return {.adjust = [](TranslatorConfiguration& one) { one.*member = value; }};
}
template <auto member, auto value>
TranslatorNeeds where_rule_is() {
  return {.adjust = [](TranslatorConfiguration& one) { one.rules.*member = value; }};
}

TranslatorStep frame_goes_out() {
  return {"a frame is requested", "its bits go out in time", [](TranslatorScene& scene) {
            scene.exchange(frame_text(scene.octets));
            scene.expect_sent(encoded(scene.requested), "bits_wrong");
            scene.rest();
          }};
}

TranslatorStep frame_is_indicated() {
  return {"a frame comes from the line, and ones after it",
          "it is indicated in time, then blanking_symbols of silence, and the rest of the ones",
          [](TranslatorScene& scene) {
            const std::string frame = frame_text(scene.octets);
            const std::size_t start = frame.find('N');
            scene.exchange("", side_bits_of(encoded(frame + std::string(kOnes, '1'))));
            const std::size_t blanked = scene.bench.configuration().rules.blanking_symbols;
            scene.expect_content(
                frame.substr(start) + std::string(blanked, 'S') + std::string(kOnes - blanked, '1'),
                "symbols_wrong");
            const kernel::Time due =
                scene.begin + scene.bench.symbols(static_cast<std::int64_t>(start)) + scene.bench.delay();
            const SideLog& indicated = scene.bench.indicated();
            const kernel::Time seen = indicated.time_of(indicated.text().find('N'));
            scene.judge.expect(seen <= due + kernel::kNanosecond, "indicated_too_late", kernel::describe(due),
                               kernel::describe(seen));
            scene.rest();
          }};
}

TranslatorStep commands_are_answered() {
  return {"serial SM data, no command, and RESET, eight symbols each", "each answer in time",
          [](TranslatorScene& scene) {
            scene.exchange("ddddddddiiiiiiiirrrrrrrr");
            const kernel::Duration most = scene.bench.symbols(scene.bench.configuration().answer_symbols);
            scene.bench.wait(most);
            const std::string answers = scene.indicated();
            scene.judge.expect(answers.ends_with("nnnnnnnniiiiiiiiaaaaaaaa"), "answer_wrong",
                               "NACK, IDLE, ACK", answers);
            const SideLog& indicated = scene.bench.indicated();
            const kernel::Duration took = indicated.time_of(indicated.text().find('n')) - scene.begin;
            scene.judge.expect(took <= most + kernel::kNanosecond, "answers_too_late", kernel::describe(most),
                               kernel::describe(took));
          }};
}

TranslatorCase life_with(const std::string& id, const std::string& what, std::vector<MustCatch> catches,
                         TranslatorNeeds needs) {
  return on_chart(
      translator_must(
          "settings/" + id, "",
          "With " + what + " a translator sends, indicates, blanks and answers as its settings say.",
          own("settings of a translator"), std::move(catches)),
      {{1, 5}, {on_line(), frame_goes_out(), frame_is_indicated(), commands_are_answered()}}, needs);
}

}  // namespace

std::vector<TranslatorCase> translator_settings_cases() {
  using token_bus::Rules;
  constexpr std::int64_t kMegabit = 1'000'000;
  return {
      life_with("the_lowest_bit_rate", "1 Mbit/s on the line", {{"bit_rate_of_10_megabits", "answer_wrong"}},
                where_rule_is<&Rules::phy_bit_rate, kMegabit>()),
      life_with("the_highest_bit_rate", "100 Mbit/s on the line", {{"delay_of_1600_ns", "sent_too_late"}},
                where_rule_is<&Rules::phy_bit_rate, 100 * kMegabit>()),
      life_with("the_shortest_delay", "a delay of two symbols", {{"delay_of_8_symbols", "sent_too_late"}},
                where_it_is<&TranslatorConfiguration::delay_symbols, 2>()),
      life_with("the_longest_delay", "a delay of 64 symbols", {{"slow_transmitter", "sent_too_late"}},
                where_it_is<&TranslatorConfiguration::delay_symbols, 64>()),
      life_with("the_fastest_answers", "answers within two symbols",
                {{"answers_of_8_symbols", "answers_too_late"}},
                where_it_is<&TranslatorConfiguration::answer_symbols, 2>()),
      life_with("the_slowest_answers", "answers within 256 symbols",
                {{"answers_too_late", "answers_too_late"}},
                where_it_is<&TranslatorConfiguration::answer_symbols, 256>()),
      life_with("the_shortest_blanking", "a blanking of 24 symbols",
                {{"blanking_of_28_symbols", "symbols_wrong"}}, where_rule_is<&Rules::blanking_symbols, 24>()),
      life_with("the_longest_blanking", "a blanking of 32 symbols",
                {{"blanking_of_28_symbols", "symbols_wrong"}}, where_rule_is<&Rules::blanking_symbols, 32>()),
  };
}

}  // namespace fieldproof::conformance
