#include "conformance/interbus/slave_scene.hpp"

#include <fmt/format.h>

namespace fieldproof::conformance {

SlaveCase slave_case(std::string_view id, std::string_view purpose, std::string_view requirement,
                     judge::Reference reference, std::vector<MustCatch> catches, SlaveChart chart,
                     SlaveExtras extras) {
  TestCase test_case;
  test_case.id = fmt::format("interbus/slave/{}", id);
  test_case.purpose = purpose;
  test_case.requirement = requirement;
  test_case.reference = std::move(reference);
  test_case.details = std::move(extras.details);
  test_case.tags = std::move(extras.tags);
  test_case.tags.insert(test_case.tags.begin(), "must");
  test_case.catches = std::move(catches);
  test_case.not_applicable = std::move(extras.only_for);
  return charted<SlaveCase>(std::move(test_case), std::move(chart), extras.needs);
}

namespace slave_chart {
namespace {

std::uint16_t messages_of(SlaveScene& scene) {
  const interbus::Rules& rules = scene.bench.rules();
  scene.bench.id_cycle(scene.bench.interfaces_off());
  return id_register(scene.bench, scene.judge) &
         (rules.message_check_error | rules.message_peripheral_fault | rules.message_reconfiguration);
}

void expect_messages(SlaveScene& scene, bool holds, std::uint16_t found, std::string_view reason,
                     std::string expected) {
  scene.judge.expect(holds, reason, [&] {
    LineView& out = scene.bench.out();
    return Mismatch{.expected = {std::move(expected)},
                    .actual = fmt::format("message bits {:04X}h", found),
                    .time = out.start_of(out.data_telegrams()[0]),
                    .first_difference = "bits 13 to 15 of the ID register" +
                                        (scene.fault.empty() ? "" : ", after: " + scene.fault)};
  });
}

std::string name_of(RuleBits bit) {
  if (bit == &interbus::Rules::message_check_error) return "a check error";
  return bit == &interbus::Rules::message_peripheral_fault ? "a peripheral fault" : "reconfiguration";
}

}  // namespace

std::vector<std::uint16_t> inverted_outputs(SlaveBench& bench) {
  std::vector<std::uint16_t> words = bench.outputs();
  for (std::uint16_t& word : words) word = static_cast<std::uint16_t>(~word);
  return words;
}

SlaveStep identified(const std::string& whom) {
  return stimulus<SlaveScene>("ID cycles identify " + whom,
                              [](SlaveScene& scene) { scene.bench.bring_up(); });
}

SlaveStep data_cycle() {
  return stimulus<SlaveScene>("a valid data cycle with random words and inputs", [](SlaveScene& scene) {
    scene.bench.set_inputs(scene.bench.random_words());
    scene.words = scene.bench.random_words();
    scene.bench.data_cycle(scene.words);
  });
}

SlaveStep good_cycle(std::string reason) {
  return {"a valid data cycle", "it is taken over, its status word leaves clean",
          [reason = std::move(reason)](SlaveScene& scene) {
            expect_good_cycle(scene.bench, scene.judge, reason);
          }};
}

SlaveStep status_telegrams(std::size_t count) {
  return stimulus<SlaveScene>(fmt::format("{} status telegrams", count),
                              [count](SlaveScene& scene) { scene.bench.status_telegrams(count); });
}

SlaveStep silence(std::string text, kernel::Duration (*of)(const interbus::Rules&)) {
  return stimulus<SlaveScene>(std::move(text),
                              [of](SlaveScene& scene) { scene.bench.silence(of(scene.bench.rules())); });
}

SlaveStep flipped(std::string text, MakeLevel level) {
  return stimulus<SlaveScene>(std::move(text), [level = std::move(level)](SlaveScene& scene) {
    SlaveBench& bench = scene.bench;
    bench.terminals().forget_changes();
    bench.begin();
    const CyclePlace& cycle = bench.append_data_cycle(inverted_outputs(bench));
    const std::size_t at = level(scene, cycle);
    const std::size_t within = at - cycle.level;
    scene.fault = fmt::format("telegram {} of the data cycle arrived with level {} flipped",
                              within / cycle.pitch, within % cycle.pitch);
    bench.channel().on_next().flip(at);
    bench.send();
  });
}

SlaveStep flipped_bit() {
  return flipped("a data cycle with one bit flipped at the slave's receiver",
                 [](SlaveScene& scene, const CyclePlace& cycle) {
                   SlaveBench& bench = scene.bench;
                   return bench.code_word_level(
                       cycle, static_cast<std::size_t>(bench.random().below(bench.code_word_bits())));
                 });
}

SlaveStep stop_bit_missing() {
  return flipped("a data cycle in which its stop bit arrives as 0",
                 [](SlaveScene& scene, const CyclePlace& cycle) {
                   return cycle.level_of(telegram_in_turn(scene, cycle, 0), TrainWriter::kStopLevel);
                 });
}

Walk<SlaveScene> each_telegram(std::string text, std::size_t last, std::size_t times) {
  return {std::move(text), [last, times](SlaveScene& scene) {
            scene.bench.begin();
            const CyclePlace& cycle = scene.bench.append_data_cycle(scene.bench.random_words());
            return (cycle.telegrams() - last) * times;
          }};
}

std::size_t telegram_in_turn(const SlaveScene& scene, const CyclePlace& cycle, std::size_t last) {
  return scene.round % (cycle.telegrams() - last);
}

SlaveStep shown(std::string reason) {
  return expected<SlaveScene>("its words are at the outputs",
                              [reason = std::move(reason)](SlaveScene& scene) {
                                expect_outputs(scene.bench, scene.judge, scene.words, reason);
                              });
}

SlaveStep answered() {
  return expected<SlaveScene>(
      "the inputs leave, then what came in, with a right check and a clean status word",
      [](SlaveScene& scene) { expect_answer(scene.bench, scene.judge, 0, scene.bench.data_load()); });
}

SlaveStep unchanged(std::string reason, std::string why_not) {
  return expected<SlaveScene>("no output changes",
                              [reason = std::move(reason), why_not = std::move(why_not)](SlaveScene& scene) {
                                expect_no_change(scene.bench, scene.judge, reason, why_not);
                              });
}

SlaveStep all_safe() {
  return expected<SlaveScene>("all outputs are 0", [](SlaveScene& scene) {
    expect_outputs(scene.bench, scene.judge, std::vector<std::uint16_t>(scene.bench.words()),
                   "outputs_not_safe_after_limit");
    scene.bench.terminals().forget_changes();
  });
}

SlaveStep rejected() {
  return expected<SlaveScene>("the status word leaves marked, no output changes",
                              [](SlaveScene& scene) { expect_rejected(scene.bench, scene.judge, 0); });
}

SlaveStep not_taken_over() {
  return expected<SlaveScene>("no output changes", [](SlaveScene& scene) {
    // One early check phase in 256, and few other faults in headers, leave a cycle whose check fits by
    // chance: no slave can know, so it is not judged.
    FoundCycle arrived;
    find_last_cycle(scene.bench.in().data_telegrams(), arrived);
    if (!is_right_data_cycle(scene.bench, arrived))
      expect_no_change(scene.bench, scene.judge, "output_changed_by_rejected_cycle", scene.fault);
    scene.bench.terminals().forget_changes();
  });
}

SlaveStep message(RuleBits bit, std::string reason, std::string why) {
  std::string expected =
      bit == nullptr ? "no message in the ID register"
                     : fmt::format("the message bit of {} in the ID register and no other", name_of(bit));
  return {"an ID cycle", std::move(expected),
          [bit, reason = std::move(reason), why = std::move(why)](SlaveScene& scene) {
            const std::uint16_t required = bit == nullptr ? 0 : scene.bench.rules().*bit;
            const std::uint16_t found = messages_of(scene);
            expect_messages(scene, found == required, found, reason,
                            fmt::format("message bits {:04X}h: {}", required, why));
          }};
}

SlaveStep check_error(bool is_reported, std::string reason, std::string why) {
  return {"an ID cycle",
          fmt::format("{} message of a check error in the ID register", is_reported ? "the" : "no"),
          [is_reported, reason = std::move(reason), why = std::move(why)](SlaveScene& scene) {
            const std::uint16_t bit = scene.bench.rules().message_check_error;
            const std::uint16_t found = messages_of(scene);
            expect_messages(
                scene, ((found & bit) != 0) == is_reported, found, reason,
                fmt::format("message bit {:04X}h {}set: {}", bit, is_reported ? "" : "not ", why));
          }};
}

}  // namespace slave_chart
}  // namespace fieldproof::conformance
