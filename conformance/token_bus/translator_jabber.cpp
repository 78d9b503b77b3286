#include <fmt/format.h>

#include "conformance/token_bus/translator_scene.hpp"

// How long a transmission may be, to the symbol, what counts, and what a jabber leaves as it is.
namespace fieldproof::conformance {
namespace {

using namespace translator_chart;
using token_sources::memory;
using token_sources::own;

constexpr std::size_t kMoreThanHalf = 40'000;
constexpr std::string_view kOnLine = "rrrrllllttttSSSS";

std::string pads(std::size_t symbols) {
  return std::string(symbols, 'P');
}

// What is answered to commands of so many symbols each.
TranslatorStep then_answers(std::string script, std::string answers, std::string reason,
                            std::size_t symbols = 4) {
  return {fmt::format("the commands {}", script), fmt::format("the answers {}", answers),
          [=](TranslatorScene& scene) {
            std::string commands;
            std::string right;
            for (const char one : script) commands += std::string(symbols, one);
            for (const char one : answers) right += std::string(symbols, one);
            scene.exchange(commands);
            scene.expect_indicated({right}, reason);
          }};
}

// All of it goes out, and that is no jabber.
TranslatorStep goes_out_whole(std::string text, std::string script) {
  return {std::move(text), "all of it goes out, and idle is answered with IDLE", [=](TranslatorScene& scene) {
            scene.exchange(script);
            scene.expect_sent(encoded(script), "cut_too_early");
            scene.exchange("iiii");
            scene.expect_indicated({"iiii"}, "cut_too_early");
          }};
}

// Whether the symbol that is too much still goes out is left open.
TranslatorStep is_cut_off(std::string text, std::size_t symbols) {
  return {std::move(text), "it is cut off at the limit", [=](TranslatorScene& scene) {
            scene.exchange(pads(symbols));
            const std::size_t bits = scene.sent().size();
            scene.judge.expect(
                bits >= 2 * std::size_t{kJabberSymbols} && bits <= 2 * std::size_t{kJabberSymbols} + 2,
                "jabbers", fmt::format("{} symbols", kJabberSymbols), fmt::format("{} bits", bits));
          }};
}

TranslatorStep stays_off(std::string text, std::string script) {
  return {std::move(text), "nothing goes out", [=](TranslatorScene& scene) {
            scene.exchange(script);
            scene.expect_nothing_sent("sends_after_jabber", "it is off until RESET");
          }};
}

TranslatorStep comes_on_line(std::string_view script) {
  return does("RESET, DISABLE LOOPBACK, ENABLE TRANSMITTER", [=](TranslatorScene& scene) {
    scene.exchange(std::string(script));
    scene.rest();
  });
}

TranslatorStep supply_fails() {
  return does("the supply fails and comes again", [](TranslatorScene& scene) {
    scene.bench.set_power(false);
    scene.rest();
    scene.bench.set_power(true);
    scene.rest();
  });
}

}  // namespace

std::vector<TranslatorCase> translator_jabber_cases() {
  return {
      on_chart(translator_must(
                   "management/a_long_transmission_is_no_jabber", "",
                   "jabber_symbols are no jabber, nor are more than these with one symbol of silence or "
                   "one command in between.",
                   memory("jabber inhibit"),
                   {{"jabber_one_early", "cut_too_early"},
                    {"jabber_at_half", "cut_too_early"},
                    {"jabber_over_one_silence", "cut_too_early"},
                    {"jabber_over_a_command", "cut_too_early"}},
                   {{own("nothing goes out in management mode"), {"cut_too_early"}}}),
               {{1, 2},
                {on_line(), goes_out_whole("66000 symbols of pad_idle", pads(kJabberSymbols)),
                 goes_out_whole("40000 symbols, silence, 40000 symbols",
                                pads(kMoreThanHalf) + "S" + pads(kMoreThanHalf)),
                 goes_out_whole("40000 symbols, idle, 40000 symbols",
                                pads(kMoreThanHalf) + "i" + pads(kMoreThanHalf))}},
               with_short_jabber()),
      on_chart(translator_must("management/one_symbol_more_is_a_jabber", "",
                               "One symbol more than jabber_symbols is a jabber: it is off until RESET or a "
                               "failure of the supply, "
                               "and all else is as it was.",
                               memory("jabber inhibit and physical error"),
                               {{"jabber_one_late", "answer_wrong"},
                                {"enabled_after_a_jabber", "sends_after_jabber"},
                                {"disable_refused_after_a_jabber", "answer_wrong"},
                                {"jabber_loops_back", "does_not_recover"},
                                {"jabber_outlives_supply", "answer_wrong"},
                                {"second_enable_taken", "answer_wrong"},
                                {"jabber_told_once", "answer_wrong"},
                                {"serial_data_tell_a_jabber", "answer_wrong"}}),
               {{1, 2},
                {on_line(), is_cut_off("66001 symbols of pad_idle", kJabberSymbols + 1), receives(),
                 then_answers("iltil", "eanea", "answer_wrong"),
                 then_answers("itditditditd", "ennennennenn", "answer_wrong", 24),
                 stays_off("a frame is requested, after ENABLE TRANSMITTER", pads(200)),
                 stays_off("again after silence", "SSSS" + pads(20) + "SSSS" + pads(20)), supply_fails(),
                 then_answers("itl", "iaa", "answer_wrong"), goes_out_whole("a preamble", pads(40))}},
               with_short_jabber()),
      on_chart(translator_must(
                   "management/only_a_transmission_is_a_jabber", "",
                   "What is requested while the transmitter is off is no transmission, and no jabber "
                   "however long it is; "
                   "a second jabber is one as the first.",
                   memory("jabber inhibit"),
                   {{"jabber_without_transmitter", "answer_wrong"}, {"one_jabber_only", "answer_wrong"}}),
               {{1, 2},
                {comes_on_line("rrrrllll"),
                 does("68000 symbols of pad_idle",
                      [](TranslatorScene& scene) { scene.exchange(pads(kJabberSymbols + 2'000)); }),
                 then_answers("it", "ia", "answer_wrong"), pause(),
                 is_cut_off("68000 symbols of pad_idle", kJabberSymbols + 2'000), comes_on_line(kOnLine),
                 is_cut_off("66001 symbols of pad_idle", kJabberSymbols + 1),
                 then_answers("iri", "eai", "answer_wrong", 1)}},
               with_short_jabber()),
  };
}

}  // namespace fieldproof::conformance
