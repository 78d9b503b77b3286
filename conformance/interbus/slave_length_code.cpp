#include <fmt/format.h>

#include <algorithm>

#include "conformance/interbus/length_codes.hpp"
#include "conformance/interbus/slave_scene.hpp"

// IS-04: the length of the data register follows from the length code, one case for each code.
namespace fieldproof::conformance {
namespace {

using namespace slave_chart;

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

void send_long_data_cycle(SlaveScene& scene, unsigned words) {
  scene.bench.set_inputs(scene.bench.random_words());
  std::vector<std::uint16_t> sent(words + kMore);
  for (std::uint16_t& word : sent) word = static_cast<std::uint16_t>(scene.bench.random().next());
  scene.bench.data_cycle(sent);
  scene.words.assign(sent.begin() + kMore, sent.end());
}

void expect_register(SlaveBench& bench, CaseJudge& judge, unsigned words) {
  expect_all_telegrams(bench, judge);
  const std::optional<CycleOnLine> in = bench.cycle_on(bench.in(), 0);
  const std::optional<CycleOnLine> out = bench.cycle_on(bench.out(), 0);
  if (!in || !out) judge.fail("telegram_lost", {{"the cycle passes"}, "it did not arrive whole"});
  const std::optional<std::size_t> shift = shift_of(*in, *out);
  judge.expect(shift == 2 * words, "register_length_wrong",
               fmt::format("what comes in leaves after {} octets", 2 * words),
               shift ? fmt::format("after {} octets", *shift) : "it does not leave within the cycle");
  const std::vector<std::uint8_t> load = bench.data_load();
  for (std::size_t octet = 0; bench.pics().supports("inputs") && octet < load.size(); ++octet) {
    const std::uint8_t seen = out->telegrams[octet].data;
    judge.expect(seen == load[octet], "register_content_wrong",
                 fmt::format("{:02X}h, octet {} of input word {}", load[octet], octet % 2, octet / 2),
                 fmt::format("{:02X}h", seen));
  }
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
  return slave_case(
      fmt::format("length_code/code_{:02x}h_is_{}_words", length.code, words), "IS-04",
      fmt::format("A slave whose ID code has the length code {:02X}h has a data register of {} words. The "
                  "code is an entry of a table, not a number of words.",
                  length.code, words),
      length.code == kLengthCodeFromMemory ? sources::from_memory("table of length codes, entry 14h") : table,
      catches_of(length),
      {.rounds = {3, 3},
       .steps = {stimulus<SlaveScene>(fmt::format("a data cycle of {} random words", words + kMore),
                                      [words](SlaveScene& scene) { send_long_data_cycle(scene, words); }),
                 expected<SlaveScene>(
                     fmt::format("the {} input words leave, then what came in", words),
                     [words](SlaveScene& scene) { expect_register(scene.bench, scene.judge, words); }),
                 shown()},
       .first = {identified(fmt::format("a slave with the ID code {:04X}h", id_code))}},
      {.only_for = for_item("any_length_code", "the slave has one length code and cannot be given others"),
       .needs = {.id_code = id_code}});
}

}  // namespace

std::vector<SlaveCase> slave_length_code_cases() {
  std::vector<SlaveCase> cases;
  for (const interbus::LengthCode& length : kLengthCodes) cases.push_back(length_case(length));
  return cases;
}

}  // namespace fieldproof::conformance
