#include "conformance/interbus/length_codes.hpp"
#include "conformance/interbus/slave_cases.hpp"
#include "conformance/interbus/slave_expect.hpp"

#include <fmt/format.h>

#include <algorithm>

// IS-04: the length of the data register follows from the length code, one case for each code.
namespace fieldproof::conformance {
namespace {

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

void has_register_of(SlaveBench& bench, CaseJudge& judge, unsigned words) {
  bench.bring_up();
  for (unsigned n = 0; n < 3; ++n) {
    bench.set_inputs(bench.random_words());
    // As many words as the code says, plus some that only pass: a longer register shows as well.
    std::vector<std::uint16_t> sent(words + 4);
    for (std::uint16_t& word : sent) word = static_cast<std::uint16_t>(bench.random().next());
    bench.data_cycle(sent);
    expect_all_telegrams(bench, judge);
    const std::optional<CycleOnLine> in = bench.cycle_on(bench.in(), 0);
    const std::optional<CycleOnLine> out = bench.cycle_on(bench.out(), 0);
    if (!in || !out) judge.fail("telegram_lost", {{"the cycle passes"}, "it did not arrive whole"});
    const std::optional<std::size_t> shift = shift_of(*in, *out);
    judge.expect(shift == 2 * words, "register_length_wrong", [&] {
      return Mismatch{.expected = {fmt::format("what comes in leaves after {} octets", 2 * words)},
                      .actual = shift ? fmt::format("after {} octets", *shift)
                                      : std::string("it does not leave within the cycle"),
                      .time = bench.out().start_of(out->telegrams[0])};
    });
    const std::span<const std::uint16_t> last{sent.data() + sent.size() - words, words};
    const std::vector<std::uint8_t> load = bench.data_load();
    for (std::size_t octet = 0; bench.pics().supports("inputs") && octet < load.size(); ++octet) {
      judge.expect(out->telegrams[octet].data == load[octet], "register_content_wrong", [&] {
        return Mismatch{.expected = {fmt::format("{:02X}h, octet {} of input word {}", load[octet], octet % 2,
                                                 octet / 2)},
                        .actual = fmt::format("{:02X}h", out->telegrams[octet].data),
                        .time = bench.out().start_of(out->telegrams[octet])};
      });
    }
    if (bench.pics().supports("outputs") && in->octets == 2 + 2 * sent.size())
      expect_outputs(bench, judge, last, "valid_cycle_rejected");
  }
}

SlaveCase length_case(const interbus::LengthCode& length) {
  const auto id_code = static_cast<std::uint16_t>(length.code << 8 | 0x03);
  const bool is_binary = length.code == length.words;
  std::vector<MustCatch> catches{{"id_register_in_data_cycle", "register_length_wrong"}};
  if (!is_binary) catches.push_back({"length_code_binary", "register_length_wrong"});
  constexpr unsigned kRoomOfMutant = 16;
  if (length.words > kRoomOfMutant)
    catches.push_back({"loses_input_words_above_16", "register_content_wrong"});
  SlaveCase result{
      {.id = fmt::format("interbus/slave/length_code/code_{:02x}h_is_{}_words", length.code, length.words),
       .purpose = "IS-04",
       .requirement =
           fmt::format("A slave whose ID code has the length code {:02X}h has a data register of {} "
                       "words. The code is an entry of a table, not a number of words.",
                       length.code, length.words),
       .reference = length.code == kLengthCodeFromMemory
                        ? sources::from_memory("table of length codes, entry 14h")
                        : judge::Reference{"Schneider 890USE196", "page 37, table of length codes",
                                           judge::Standing::searched},
       .stimulus = fmt::format("An ID cycle, then data cycles of {} random words through a slave with the ID "
                               "code {:04X}h.",
                               length.words + 4, id_code),
       .expected =
           fmt::format("The {} input words leave, then what came in, and the outputs show the last {} "
                       "words.",
                       length.words, length.words),
       .tags = {"must"},
       .catches = catches,
       .not_applicable =
           for_item("any_length_code", "the slave has one length code and cannot be given others")},
      [words = length.words](SlaveBench& bench, CaseJudge& judge) { has_register_of(bench, judge, words); }};
  result.needs.id_code = id_code;
  return result;
}

}  // namespace

std::vector<SlaveCase> slave_length_code_cases() {
  std::vector<SlaveCase> cases;
  for (const interbus::LengthCode& length : kLengthCodes) cases.push_back(length_case(length));
  return cases;
}

}  // namespace fieldproof::conformance
