#include <fmt/format.h>

#include <array>
#include <initializer_list>
#include <numeric>
#include <span>
#include <utility>

#include "conformance/interbus/compared_master.hpp"
#include "conformance/interbus/master_sequence.hpp"
#include "conformance/interbus/other_codings.hpp"
#include "conformance/sequence_draw.hpp"

// A master beside the reference: each value of each word, each level of a cycle flipped on its way back, what
// ends a run and begins the next one, one thing after another, and everything again with other settings.
namespace fieldproof::conformance {
namespace {

using namespace compared_master;

// ---- families of sequences ----

std::vector<MasterCommands> each_value_for_a_master() {
  constexpr std::int64_t kFew = 14;
  std::vector<MasterCommands> all;
  for (std::size_t word = 0; word < words_of_master().words.size(); ++word) {
    const auto& numbers = words_of_master().words[word].numbers;
    all.push_back({order(static_cast<MasterWord>(word))});
    for (std::size_t n = 0; n < numbers.size(); ++n) {
      std::vector<std::int64_t> values(numbers[n].likely.begin(), numbers[n].likely.end());
      for (std::int64_t value = numbers[n].least; value <= numbers[n].most && numbers[n].most <= kFew;
           ++value)
        values.push_back(value);
      for (const std::int64_t value : values)
        all.push_back({ring(5), order(static_cast<MasterWord>(word), {{n, value}})});
    }
  }
  for (std::int64_t limits = 1; limits <= 6; ++limits) {
    for (const std::int64_t number : {std::int64_t{0}, std::int64_t{5}, kDeepRing})
      all.push_back({order(MasterWord::power, {{0, number}, {5, limits}})});
  }
  all.push_back({order(MasterWord::power, {{0, 4}, {3, 1}})});
  all.push_back({ring(6), order(MasterWord::output, {{0, 150}, {1, 0x8001}}), cycles(2)});
  return all;
}

// A level flipped, or the telegram lost, of each of so many telegrams.
std::vector<MasterCommands> faults_of_telegrams(bool is_id_cycle, std::uint32_t first, std::uint32_t count,
                                                std::span<const std::uint32_t> levels) {
  std::vector<MasterCommands> all;
  const auto add = [&](const SequenceFault& fault) {
    SequenceCommand changed = order(MasterWord::changed);
    changed.faults.push_back(fault);
    all.push_back({changed});
    if (is_id_cycle) all.back().insert(all.back().begin(), order(MasterWord::identify));
  };
  for (std::uint32_t unit = first; unit < first + count; ++unit) {
    for (const std::uint32_t level : levels) add({SequenceFaultKind::flip, unit, level});
    add({SequenceFaultKind::drop, unit, 0});
  }
  return all;
}

std::vector<MasterCommands> both(std::vector<MasterCommands> all, const std::vector<MasterCommands>& more) {
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

// Each header level, the stop level and some data levels of each telegram, and each telegram lost; of a data
// cycle and of an ID cycle.
std::vector<MasterCommands> each_fault_on_the_way_back() {
  constexpr std::array<std::uint32_t, 7> kLevels{0, 1, 2, 3, 4, 11, 12};
  constexpr std::uint32_t kTelegrams = 10;
  return both(faults_of_telegrams(false, 0, kTelegrams, kLevels),
              faults_of_telegrams(true, 0, kTelegrams, kLevels));
}

void add_end_telegrams(interbus::Rules& rules) {
  rules.end_telegrams = 2;
}

// Of the status word and what comes after it.
std::vector<MasterCommands> each_fault_at_the_end_of_a_cycle() {
  constexpr std::array<std::uint32_t, 4> kLevels{1, 2, 3, 12};
  return both(faults_of_telegrams(false, 8, 4, kLevels), faults_of_telegrams(true, 10, 4, kLevels));
}

std::vector<SequenceCommand> events_for_a_master() {
  return {order(MasterWord::bad),
          order(MasterWord::bad, {{0, 9}}),
          order(MasterWord::bad, {{0, 10}}),
          order(MasterWord::marked),
          order(MasterWord::marked, {{0, 1}, {1, 2}}),
          order(MasterWord::marked, {{0, 2}, {1, 0}, {2, 0x0080}}),
          order(MasterWord::forged, {{0, 2}}),
          order(MasterWord::extra, {{0, 2}}),
          order(MasterWord::shifted, {{0, 16}}),
          order(MasterWord::lost, {{0, 2}}),
          order(MasterWord::inputs, {{0, 0x8001}, {1, 0x0180}}),
          order(MasterWord::outputs, {{0, 0x7FFE}, {1, 0xFF00}}),
          order(MasterWord::output, {{0, 1}, {1, 0x8000}}),
          order(MasterWord::identify),
          order(MasterWord::messages, {{0, 1}, {1, 3}}),
          order(MasterWord::messages, {{0, 0}, {1, 2}}),
          order(MasterWord::cut),
          order(MasterWord::cut, {{0, 1}}),
          order(MasterWord::ring, {{0, 0}}),
          order(MasterWord::ring, {{0, 1}}),
          order(MasterWord::ring, {{0, 2}}),
          order(MasterWord::stop),
          order(MasterWord::stop, {{0, 1}}),
          order(MasterWord::start, {{0, 2}}),
          ring(1),
          ring(5),
          order(MasterWord::wait, {{0, 30}})};
}

std::vector<MasterCommands> one_order_after_another() {
  std::vector<MasterCommands> all;
  for (const SequenceCommand& first : events_for_a_master()) {
    for (const SequenceCommand& second : events_for_a_master()) all.push_back({first, cycles(1), second});
  }
  return all;
}

// What ends a run, how the next one begins, and what ends that.
std::vector<MasterCommands> run_after_run() {
  const std::vector<SequenceCommand> ends{
      order(MasterWord::stop),           order(MasterWord::bad, {{0, 10}}),
      order(MasterWord::cut, {{0, 1}}),  order(MasterWord::ring, {{0, 0}, {1, 1}}),
      order(MasterWord::ring, {{0, 2}}), order(MasterWord::cut, {{0, 3}})};
  std::vector<MasterCommands> all;
  for (const SequenceCommand& first : ends) {
    for (const SequenceCommand& second : ends) {
      all.push_back({ring(5), order(MasterWord::inputs, {{0, 0x1357}, {1, 0x2468}}),
                     order(MasterWord::outputs, {{0, 0x1111}, {1, 0x2222}}), order(MasterWord::bad, {{0, 5}}),
                     cycles(2), first, order(MasterWord::identify),
                     order(MasterWord::outputs, {{0, 1}, {1, 1}}), order(MasterWord::start),
                     order(MasterWord::bad, {{0, 6}}), cycles(3), second, order(MasterWord::start),
                     order(MasterWord::bad, {{0, 9}})});
    }
  }
  for (const std::int64_t number : {4, 6}) {
    all.push_back({ring(number), order(MasterWord::outputs, {{0, 0x1111}, {1, 0x2222}}), cycles(2),
                   order(MasterWord::stop), order(MasterWord::start), cycles(2)});
  }
  for (std::int64_t station = 0; station < 4; ++station) {
    const SequenceCommand changed = order(MasterWord::ring, {{0, 0}, {1, station}});
    all.push_back({ring(5), changed, order(MasterWord::identify), cycles(2)});
    all.push_back({ring(5), changed, order(MasterWord::lost, {{0, 12}})});
    all.push_back({ring(5), order(MasterWord::messages, {{0, 3 - station}, {1, 3}}),
                   order(MasterWord::marked, {{0, station}, {1, 3}}), cycles(3)});
  }
  return all;
}

std::vector<MasterCommands> many_cycles_of_a_master() {
  MasterCommands many;
  for (std::int64_t n = 0; n < 26; ++n) {
    many.push_back(order(MasterWord::inputs, {{0, n}, {1, 0xFFFF - n}}));
    many.push_back(order(n % 3 == 0 ? MasterWord::bad : MasterWord::cycles));
    many.push_back(cycles(10));
  }
  MasterCommands window;
  for (int n = 0; n < 3; ++n) {
    window.push_back(order(MasterWord::bad));
    window.push_back(cycles(2));
  }
  window.push_back(cycles(30));
  window.push_back(order(MasterWord::bad));
  window.push_back(cycles(30));
  return {many, window};
}

// Each ring, with all words copied: its inputs and outputs change, and the cable to each station is cut.
std::vector<MasterCommands> each_ring() {
  constexpr std::int64_t kRings = 7;
  constexpr std::int64_t kMostStations = 4;
  std::vector<MasterCommands> all;
  std::vector<std::int64_t> rings(kRings);
  std::iota(rings.begin(), rings.end(), 0);
  rings.push_back(kDeepRing);
  for (const std::int64_t number : rings) {
    for (std::int64_t copies = 0; copies < 4; ++copies) {
      all.push_back({order(MasterWord::power, {{0, number}, {1, 1}, {2, copies}}),
                     order(MasterWord::inputs, {{0, 0x1234}, {1, 0x8765}}),
                     order(MasterWord::outputs, {{0, 0x0F1E}, {1, 0x2D3C}}), cycles(2),
                     order(MasterWord::inputs, {{0, 0x4321}, {1, 0x5678}}), order(MasterWord::bad), cycles(2),
                     order(MasterWord::outputs, {{0, 0x4B5A}, {1, 0x6978}}), cycles(2)});
    }
    for (std::int64_t station = 0; station < kMostStations; ++station)
      all.push_back({ring(number), order(MasterWord::cut, {{0, station}})});
  }
  return all;
}

std::vector<MasterCommands> orders_in_each_state() {
  std::vector<MasterCommands> all;
  for (std::int64_t state = 0; state < 4; ++state) {
    for (std::int64_t given = 0; given < 4; ++given)
      all.push_back({order(MasterWord::early_order, {{0, state}, {1, given}}), order(MasterWord::start)});
  }
  return all;
}

MasterFamilies drawn_for_a_master() {
  constexpr std::uint64_t kAll = 300;
  const auto all = [](kernel::Random random) {
    return drawn_commands(words_of_master(), random.next(), kAll);
  };
  const auto run = [](const Sequence& sequence, MasterBench& bench, CaseJudge& judge) {
    run_master_sequence(sequence, bench, judge);
  };
  return {{.all = all, .quick = 15, .full = kAll, .run = run}};
}

MasterFamilies both(MasterFamilies all, const MasterFamilies& more) {
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

// ---- other settings ----

void change_all_codings(interbus::Rules& rules) {
  change_each_coding(rules);
  rules.loopback_word = 0x8C31;
  rules.end_telegrams = 3;
  rules.message_peripheral_fault = 0x2000;
  rules.message_reconfiguration = 0x4000;
  rules.message_check_error = 0x8000;
}

std::vector<MasterCommands> messages_of_each_station() {
  MasterCommands all{ring(5)};
  for (std::int64_t station = 0; station < 4; ++station) {
    all.push_back(order(MasterWord::messages, {{0, station}, {1, 1 + station % 3}}));
    all.push_back(order(MasterWord::identify));
    all.push_back(cycles(2));
    all.push_back(order(MasterWord::marked, {{0, station}, {1, station}}));
    all.push_back(cycles(2));
  }
  return {all};
}

void change_times_of_a_master(interbus::Rules& rules) {
  rules.bit_rate = 2'000'000;
  rules.telegram_gap_millibits = 3'700;
  rules.status_pitch_bits = 300;
  rules.software_time = 3 * kernel::kMillisecond;
  rules.frame_check = "CRC-16/GENIBUS";
  rules.stop_after_bad_cycles = 4;
  rules.quality_bad_cycles = 2;
  rules.quality_window_cycles = 7;
  rules.silence_limit = 60 * kernel::kMillisecond;
  rules.silence_tolerance = 5 * kernel::kMillisecond;
}

}  // namespace

std::vector<MasterCase> master_compared_cases() {
  return {
      compared("each_value_of_each_word", "Each word of sequences with each boundary value, in run.",
               {{"first_station_first", "cycle_wrong"}, {"each_branch_is_level_2", "state_wrong"}},
               each_beside(each_value_for_a_master, 166)),
      compared("each_fault_on_the_way_back",
               "A data cycle and an ID cycle come back with a level flipped or a telegram lost.",
               {{"telegrams_without_gap", "cycle_time_wrong"},
                {"last_end_telegram_not_counted", "wrong_cycle_accepted"}},
               both(each_beside(each_fault_on_the_way_back, 160),
                    each_beside(each_fault_at_the_end_of_a_cycle, 40, add_end_telegrams))),
      compared("one_thing_after_another", "Each two of all that can happen to a master, in run.",
               {{"cycle_start_wanders", "pause_not_filled"},
                {"output_after_stop_kept", "state_wrong"},
                {"bad_stop_cycle_repeated", "goes_on_after_a_stop"}},
               each_beside(one_order_after_another, 50)),
      compared("run_after_run", "What ends a run, a start, and what ends the next one.",
               {{"changed_ring_ignored", "state_missing"}, {"inputs_cleared_by_stop", "inputs_not_held"}},
               each_beside(run_after_run, 60)),
      compared("each_ring",
               "Each ring, with no, two and all words copied, with copies from and to words that it does not "
               "have, and cut in front of each station.",
               {{"later_words_of_a_station_frozen", "new_inputs_missed"},
                {"third_copy_lost", "cycle_wrong"},
                {"copies_zero_for_no_word", "cycle_wrong"},
                {"lone_station_not_placed", "state_wrong"}},
               each_beside(each_ring, 64)),
      compared("orders_in_each_state",
               "Start, stop, an ID cycle and an output are ordered in each state but run.",
               {{"stop_before_run_ignored", "not_silent"},
                {"start_begins_again", "order_starts_again"},
                {"early_output_kept", "early_output_kept"},
                {"early_output_sent", "early_output_kept"}},
               each_beside(orders_in_each_state, 16)),
      compared("many_cycles", "300 cycles, some of them bad, each with other inputs.",
               {{"outputs_torn", "cycle_wrong"}}, each_beside(many_cycles_of_a_master, 2)),
      compared("drawn_sequences", "Sequences of all words at random.",
               {{"first_station_first", "cycle_wrong"}}, drawn_for_a_master()),
      compared("other_codings", "The same with each coding another one.",
               {{"outputs_one_cycle_late", "cycle_wrong"}, {"message_bit_kept", "report_wrong"}},
               both(each_beside(messages_of_each_station, 1, change_all_codings),
                    each_beside(each_value_for_a_master, 10, change_all_codings))),
      compared("other_times", "The same with other times and counts.",
               {{"inputs_frozen", "new_inputs_missed"}, {"bit_rate_kept", "state_wrong"}},
               each_beside(run_after_run, 8, change_times_of_a_master))};
}

}  // namespace fieldproof::conformance
