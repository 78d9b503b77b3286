#include <fmt/format.h>

#include <algorithm>

#include "conformance/interbus/length_codes.hpp"
#include "conformance/interbus/slave_scene.hpp"

// IS-04: the length of the data register follows from the length code, one case for each code.
namespace fieldproof::conformance {
namespace {

constexpr unsigned kMore = 4;  // words that only pass: a longer register shows as well

// After how many octets what came in leaves again; nothing when it does not come.
std::optional<std::size_t> shift_of(const CycleOnLine& in, const CycleOnLine& out) {
  for (std::size_t shift = 0; shift + 2 <= out.octets; ++shift) {
    bool fits = true;
    for (std::size_t n = shift; n < out.octets && fits; ++n)
      fits = out.telegrams[n].data == in.telegrams[n - shift].data;
    if (fits) return shift;
  }
  return std::nullopt;
}

SlaveStep long_data_cycle(unsigned words) {
  return stimulus<SlaveScene>(fmt::format("a data cycle of {} random words", words + kMore),
                              [words](SlaveScene& scene) {
                                scene.bench.set_inputs(scene.bench.random_words());
                                std::vector<std::uint16_t> sent(words + kMore);
                                for (std::uint16_t& word : sent)
                                  word = static_cast<std::uint16_t>(scene.bench.random().next());
                                scene.bench.data_cycle(sent);
                                scene.words.assign(sent.begin() + kMore, sent.end());
                              });
}

SlaveStep inputs_then_what_came_in(unsigned words) {
  return expected<SlaveScene>(
      fmt::format("the {} input words leave, then what came in", words), [words](SlaveScene& scene) {
        SlaveBench& bench = scene.bench;
        expect_all_telegrams(bench, scene.judge);
        const std::optional<CycleOnLine> in = bench.cycle_on(bench.in(), 0);
        const std::optional<CycleOnLine> out = bench.cycle_on(bench.out(), 0);
        if (!in || !out) scene.judge.fail("telegram_lost", {{"the cycle passes"}, "it did not arrive whole"});
        const std::optional<std::size_t> shift = shift_of(*in, *out);
        scene.judge.expect(shift == 2 * words, "register_length_wrong", [&] {
          return Mismatch{.expected = {fmt::format("what comes in leaves after {} octets", 2 * words)},
                          .actual = shift ? fmt::format("after {} octets", *shift)
                                          : std::string("it does not leave within the cycle"),
                          .time = bench.out().start_of(out->telegrams[0])};
        });
        const std::vector<std::uint8_t> load = bench.data_load();
        for (std::size_t octet = 0; bench.pics().supports("inputs") && octet < load.size(); ++octet) {
          scene.judge.expect(out->telegrams[octet].data == load[octet], "register_content_wrong", [&] {
            return Mismatch{.expected = {fmt::format("{:02X}h, octet {} of input word {}", load[octet],
                                                     octet % 2, octet / 2)},
                            .actual = fmt::format("{:02X}h", out->telegrams[octet].data),
                            .time = bench.out().start_of(out->telegrams[octet])};
          });
        }
      });
}

SlaveStep last_words_shown(unsigned words) {
  return expected<SlaveScene>(
      fmt::format("the outputs show the last {} words", words), [words](SlaveScene& scene) {
        const auto in = scene.bench.cycle_on(scene.bench.in(), 0);
        if (in && in->octets == 2 + 2 * (std::size_t{words} + kMore))
          expect_outputs(scene.bench, scene.judge, scene.words, "valid_cycle_rejected");
      });
}

std::vector<MustCatch> catches_of(const interbus::LengthCode& length) {
  constexpr unsigned kRoomOfMutant = 16;
  std::vector<MustCatch> catches{{"id_register_in_data_cycle", "register_length_wrong"}};
  if (length.code != length.words) catches.push_back({"length_code_binary", "register_length_wrong"});
  if (length.words > kRoomOfMutant)
    catches.push_back({"loses_input_words_above_16", "register_content_wrong"});
  return catches;
}

SlaveCase length_case(const interbus::LengthCode& length) {
  const auto id_code = static_cast<std::uint16_t>(length.code << 8 | 0x03);
  const unsigned words = length.words;
  const judge::Reference table{"Schneider 890USE196", "page 37, table of length codes",
                               judge::Standing::searched};
  return on_chart(
      {.id = fmt::format("interbus/slave/length_code/code_{:02x}h_is_{}_words", length.code, words),
       .purpose = "IS-04",
       .requirement = fmt::format("A slave whose ID code has the length code {:02X}h has a data register of "
                                  "{} words. The code is an entry of a table, not a number of words.",
                                  length.code, words),
       .reference = length.code == kLengthCodeFromMemory
                        ? sources::from_memory("table of length codes, entry 14h")
                        : table,
       .tags = {"must"},
       .catches = catches_of(length),
       .not_applicable =
           for_item("any_length_code", "the slave has one length code and cannot be given others")},
      {.rounds = {3, 3},
       .steps = {long_data_cycle(words), inputs_then_what_came_in(words), last_words_shown(words)},
       .first = {slave_chart::identified(fmt::format("a slave with the ID code {:04X}h", id_code))}},
      {.id_code = id_code});
}

}  // namespace

std::vector<SlaveCase> slave_length_code_cases() {
  std::vector<SlaveCase> cases;
  for (const interbus::LengthCode& length : kLengthCodes) cases.push_back(length_case(length));
  return cases;
}

}  // namespace fieldproof::conformance
