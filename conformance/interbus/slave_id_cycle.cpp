#include "conformance/interbus/slave_cases.hpp"
#include "conformance/interbus/slave_expect.hpp"

#include <fmt/format.h>

// IS-03: what an ID cycle brings back.
namespace fieldproof::conformance {
namespace {

void returns_its_id_code(SlaveBench& bench, CaseJudge& judge) {
  constexpr std::uint16_t kMessages = 0xE000;
  const auto declared = static_cast<std::uint16_t>(bench.pics().number("id_code", bench.id_code()));
  bench.bring_up();
  for (unsigned n = 0; n < 4; ++n) {
    bench.set_loopback_word(static_cast<std::uint16_t>(bench.rules().loopback_word + n));
    bench.id_cycle(bench.interfaces_off());
    const std::uint16_t found = id_register(bench, judge);
    judge.expect((found & ~unsigned{kMessages}) == declared, "id_code_wrong", [&] {
      return Mismatch{.expected = {fmt::format("ID code {:04X}h in bits 0 to 12", declared)},
                      .actual = fmt::format("{:04X}h", found & ~unsigned{kMessages}),
                      .time = bench.out().start_of(bench.out().data_telegrams()[0])};
    });
    expect_answer(bench, judge, 0, bench.id_load(found & kMessages));
  }
}

}  // namespace

std::vector<SlaveCase> slave_id_cycle_cases() {
  std::vector<SlaveCase> cases;
  cases.push_back(
      {{.id = "interbus/slave/id_cycle/returns_its_id_code_and_then_the_loopback_word",
        .purpose = "IS-03",
        .requirement = "In an ID cycle the 16-bit ID register of the slave is in the ring: its own ID code "
                       "leaves first, bits 0 to 12 as declared, and after it everything that came in.",
        .reference = sources::park("section 2.2: identification cycle and loopback word"),
        .details = details::answer(),
        .stimulus =
            "ID cycles with a loopback word that differs from cycle to cycle and one control word for "
            "the slave.",
        .expected =
            "The first 16 bits that leave are the ID code; then the loopback word unchanged; then the "
            "check of what left and a clean status word.",
        .tags = {"must"},
        .catches = {{"id_octets_swapped", "id_code_wrong"},
                    {"loopback_word_changed_in_id_cycle", "passed_octet_changed"}},
        .not_applicable = for_every_slave()},
       returns_its_id_code});
  return cases;
}

}  // namespace fieldproof::conformance
