#include <fmt/format.h>

#include "conformance/interbus/slave_scene.hpp"

// IS-03: what an ID cycle brings back.
namespace fieldproof::conformance {
namespace {

using namespace slave_chart;

void return_id_code(SlaveScene& scene) {
  constexpr std::uint16_t kMessages = 0xE000;
  SlaveBench& bench = scene.bench;
  const auto declared = static_cast<std::uint16_t>(bench.pics().number("id_code", bench.id_code()));
  bench.set_loopback_word(static_cast<std::uint16_t>(bench.rules().loopback_word + scene.round));
  bench.id_cycle(bench.interfaces_off());
  const std::uint16_t found = id_register(bench, scene.judge);
  scene.judge.expect((found & ~unsigned{kMessages}) == declared, "id_code_wrong", [&] {
    return Mismatch{.expected = {fmt::format("ID code {:04X}h in bits 0 to 12", declared)},
                    .actual = fmt::format("{:04X}h", found & ~unsigned{kMessages}),
                    .time = bench.out().start_of(bench.out().data_telegrams()[0])};
  });
  expect_answer(bench, scene.judge, 0, bench.id_load(found & kMessages));
}

}  // namespace

std::vector<SlaveCase> slave_id_cycle_cases() {
  return {slave_case(
      "id_cycle/returns_its_id_code_and_then_the_loopback_word", "IS-03",
      "In an ID cycle the 16-bit ID register of the slave is in the ring: its own ID code leaves first, bits "
      "0 to 12 as declared, and after it everything that came in.",
      sources::park("section 2.2: identification cycle and loopback word"),
      {{"id_octets_swapped", "id_code_wrong"}, {"loopback_word_changed_in_id_cycle", "passed_octet_changed"}},
      {.rounds = {4, 4},
       .steps = {{"an ID cycle with a control word for the slave and a loopback word that differs from cycle "
                  "to cycle",
                  "the first 16 bits that leave are the ID code; then the loopback word unchanged, the check "
                  "of what left and a clean status word",
                  return_id_code}},
       .first = {identified()}},
      {.details = details::answer()})};
}

}  // namespace fieldproof::conformance
