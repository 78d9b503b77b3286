#include "conformance/interbus/slave_families.hpp"

#include <array>
#include <initializer_list>

#include "conformance/interbus/slave_sequence.hpp"

namespace fieldproof::conformance::slave_families {

const SequenceVocabulary& vocabulary() {
  static const SequenceVocabulary words = without_settings(slave_sequence_role().vocabulary);
  return words;
}

SequenceCommand command(SlaveWord word, GivenNumbers given) {
  return simple_command(vocabulary(), static_cast<std::size_t>(word), given);
}

SequenceCommand id(std::int64_t orders) {
  return command(SlaveWord::id, {{0, orders}});
}
SequenceCommand returns(bool on_branch) {
  return command(SlaveWord::returns, {{0, on_branch ? 1 : 0}, {5, 2}});
}

namespace {

SequenceCommand check_telegrams() {
  return command(SlaveWord::telegrams, {{1, 1}, {4, 4}});
}

std::vector<std::int64_t> values_of(const SequenceNumber& number) {
  constexpr std::int64_t kFew = 16;
  std::vector<std::int64_t> values(number.likely.begin(), number.likely.end());
  if (number.most - number.least >= kFew) return values;
  values.clear();
  for (std::int64_t value = number.least; value <= number.most; ++value) values.push_back(value);
  return values;
}

// Each header level, stop level and some data levels of each telegram, and each telegram lost.
std::vector<Commands> each_fault(SlaveWord word) {
  constexpr std::array<std::uint32_t, 7> kLevels{0, 1, 2, 3, 4, 11, 12};
  std::vector<Commands> all;
  const unsigned units = vocabulary().words[static_cast<std::size_t>(word)].units;
  for (std::uint32_t unit = 0; unit < units; ++unit) {
    SequenceCommand lost = command(word);
    lost.faults.push_back({SequenceFaultKind::drop, unit, 0});
    all.push_back({lost});
    for (const std::uint32_t level : kLevels) {
      SequenceCommand flipped = command(word);
      flipped.faults.push_back({SequenceFaultKind::flip, unit, level});
      all.push_back({flipped});
    }
  }
  return all;
}

}  // namespace

std::vector<Commands> each_value() {
  std::vector<Commands> all;
  for (std::size_t word = 0; word < vocabulary().words.size(); ++word) {
    const auto& numbers = vocabulary().words[word].numbers;
    for (std::size_t n = 0; n < numbers.size(); ++n) {
      for (const std::int64_t value : values_of(numbers[n]))
        all.push_back({command(static_cast<SlaveWord>(word), {{n, value}})});
    }
  }
  for (std::int64_t header = 0; header < 8; ++header) {
    const GivenNumbers of_telegrams{{0, header & 1}, {1, header >> 1 & 1}, {2, header >> 2}, {4, 2}};
    all.push_back({command(SlaveWord::telegrams, of_telegrams)});
    all.push_back({command(SlaveWord::periphery, {{0, header & 1}, {1, header >> 1 & 1}}), id(header),
                   command(SlaveWord::periphery, {{0, 0}})});
    for (const std::int64_t branch : {0, 1}) {
      const GivenNumbers back{{0, branch}, {1, header & 1}, {2, header >> 1 & 1}, {3, header >> 2}};
      all.push_back({command(SlaveWord::returns, back)});
      all.push_back({id(branch + 1), command(SlaveWord::returns, back)});
    }
  }
  return all;
}

std::vector<Commands> each_fault_of_a_data_cycle() {
  return each_fault(SlaveWord::data);
}
std::vector<Commands> each_fault_of_an_id_cycle() {
  return each_fault(SlaveWord::id);
}

// Each two telegrams without their stop level, and a level of the data flipped besides.
std::vector<Commands> two_faults_of_a_data_cycle() {
  constexpr std::uint32_t kStop = TrainWriter::kStopLevel;
  constexpr std::uint32_t kData = 6;
  std::vector<Commands> all;
  const unsigned units = vocabulary().words[static_cast<std::size_t>(SlaveWord::data)].units;
  for (std::uint32_t first = 0; first < units; ++first) {
    for (std::uint32_t second = 0; second < units; ++second) {
      SequenceCommand faulty = command(SlaveWord::data);
      faulty.faults.push_back({SequenceFaultKind::flip, first, first < second ? kStop : kData});
      faulty.faults.push_back({SequenceFaultKind::flip, second, kStop});
      all.push_back({faulty});
    }
  }
  return all;
}

namespace {

// What leaves something behind.
std::vector<SequenceCommand> events() {
  return {command(SlaveWord::data),
          command(SlaveWord::data, {{2, 1}}),
          command(SlaveWord::data, {{3, 1}}),
          command(SlaveWord::data, {{4, 1}}),
          id(0),
          id(1),
          id(2),
          id(3),
          id(4),
          command(SlaveWord::id, {{0, 0}, {2, 1}}),
          command(SlaveWord::id, {{0, 0}, {3, 0x8000}}),
          command(SlaveWord::id, {{0, 3}, {3, 0xFFFF}}),
          command(SlaveWord::telegrams),
          command(SlaveWord::telegrams, {{0, 1}}),
          check_telegrams(),
          command(SlaveWord::status, {{0, 3}}),
          command(SlaveWord::inputs),
          command(SlaveWord::plugs, {{0, 0}}),
          command(SlaveWord::plugs, {{1, 0}}),
          command(SlaveWord::periphery),
          command(SlaveWord::periphery, {{0, 0}, {1, 1}}),
          returns(false),
          returns(true),
          command(SlaveWord::returns, {{0, 1}, {6, 0}}),
          command(SlaveWord::silence, {{0, 1}}),
          command(SlaveWord::silence),
          command(SlaveWord::silence, {{0, 4}}),
          command(SlaveWord::kept_alive),
          command(SlaveWord::power),
          command(SlaveWord::glitch),
          command(SlaveWord::cut),
          command(SlaveWord::lost_in_a_telegram),
          command(SlaveWord::returned_glitch)};
}

}  // namespace

std::vector<Commands> one_after_another() {
  std::vector<Commands> all;
  for (const SequenceCommand& first : events()) {
    for (const SequenceCommand& second : events()) all.push_back({first, second});
  }
  return all;
}

std::vector<Commands> around_a_reset() {
  std::vector<Commands> all;
  for (const SequenceCommand& event : events()) {
    for (const SlaveWord reset : {SlaveWord::silence, SlaveWord::power}) {
      all.push_back({event, command(reset)});
      all.push_back({command(reset), event});
    }
  }
  return all;
}

// Silence after a slave has been kept alive for so many limits of silence: times since power-up are long
// then.
std::vector<Commands> silence_after_a_long_life() {
  constexpr int kMost = 8;
  std::vector<Commands> all;
  Commands life;
  for (int n = 0; n < kMost; ++n) {
    life.insert(life.end(), {command(SlaveWord::kept_alive, {{0, 2}}), id(0)});
    all.push_back(life);
    all.back().insert(all.back().end(), {command(SlaveWord::data), command(SlaveWord::silence)});
  }
  return all;
}

// A cycle whose end does not come, with and without its check; then its check comes after all.
std::vector<Commands> within_a_cycle() {
  std::vector<Commands> all;
  for (const SlaveWord word : {SlaveWord::data, SlaveWord::id}) {
    for (const unsigned lost : {4U, 2U, 1U}) {
      SequenceCommand cut = command(word);
      const unsigned units = vocabulary().words[cut.word].units;
      for (unsigned n = 1; n <= lost; ++n) cut.faults.push_back({SequenceFaultKind::drop, units - n, 0});
      for (const SequenceCommand& event : events()) {
        all.push_back(
            {cut, event,
             command(SlaveWord::telegrams, {{0, word == SlaveWord::id ? 1 : 0}, {1, 1}, {3, 0}, {4, lost}})});
      }
    }
  }
  return all;
}

// The time of a reset of the outgoing bus, from each side, with what may end it or begin it again.
std::vector<Commands> within_a_reset() {
  std::vector<Commands> all;
  for (std::int64_t first = 0; first < 3; ++first) {
    for (const SequenceCommand& between : {id(0), id(3), id(4), id(7), command(SlaveWord::silence),
                                           command(SlaveWord::power), command(SlaveWord::data)}) {
      for (std::int64_t second = 0; second < 3; ++second) {
        all.push_back({id(4), command(SlaveWord::kept_alive, {{0, first}}), between,
                       command(SlaveWord::kept_alive, {{0, second}})});
      }
    }
  }
  return all;
}

// What only a second thing shows: errors and marks in a cycle that has an order, a stray telegram without its
// stop level, what is plugged in later, silence in the middle of a cycle.
std::vector<Commands> rare_orders() {
  const SequenceCommand wrong = command(SlaveWord::data, {{2, 1}});
  const SequenceCommand plugged = command(SlaveWord::plugs);
  const SequenceCommand beyond = command(SlaveWord::kept_alive);
  std::vector<Commands> all{
      {command(SlaveWord::telegrams, {{1, 1}, {4, 2}, {5, 0}}), id(0)},
      {command(SlaveWord::plugs, {{0, 0}, {1, 0}}), id(0), plugged, returns(false), returns(true)},
      {id(3), plugged, command(SlaveWord::plugs, {{0, 0}, {1, 0}}), plugged, returns(false), returns(true)},
      {id(4), beyond, id(0), id(4), beyond, id(0), id(4), returns(true), id(0)}};
  for (const std::int64_t fault : {2, 3}) {
    const auto with_fault = [fault](std::int64_t orders) {
      return command(SlaveWord::id, {{0, orders}, {static_cast<std::size_t>(fault), 0x8000}});
    };
    all.push_back({with_fault(4), id(0)});
    all.push_back({wrong, with_fault(8), id(0)});
    all.push_back({id(4), command(SlaveWord::kept_alive, {{0, 0}}), with_fault(4),
                   command(SlaveWord::kept_alive, {{0, 0}}), command(SlaveWord::kept_alive, {{0, 1}}),
                   id(0)});
  }
  for (const SlaveWord word : {SlaveWord::data, SlaveWord::id}) {
    const unsigned units = vocabulary().words[static_cast<std::size_t>(word)].units;
    for (const std::uint32_t level : {6U, 12U}) {
      SequenceCommand cut = command(word);
      cut.faults.push_back({SequenceFaultKind::flip, 1, level});
      for (unsigned n = 0; n < 4; ++n) cut.faults.push_back({SequenceFaultKind::drop, units - 1 - n, 0});
      all.push_back({cut, command(SlaveWord::silence), id(0)});
      all.push_back({cut, id(0)});
    }
    // One cycle within another, each whole and each a telegram short.
    SequenceCommand within = command(word == SlaveWord::data ? SlaveWord::id : SlaveWord::data);
    SequenceCommand broken = command(word);
    for (unsigned n = 0; n < 4; ++n) broken.faults.push_back({SequenceFaultKind::drop, units - 1 - n, 0});
    for (const std::int64_t in_front : {-3, -1, 0}) {
      within.numbers[4] = in_front;
      all.push_back({broken, within});
    }
  }
  return all;
}

// Signs of life are telegrams of each header.
std::vector<Commands> each_header_keeps_alive() {
  std::vector<Commands> all;
  for (std::int64_t header = 0; header < 8; ++header) {
    const SequenceCommand one =
        command(SlaveWord::telegrams, {{0, header & 1}, {1, header >> 1 & 1}, {2, header >> 2}});
    const SequenceCommand half = command(SlaveWord::silence, {{0, 0}});
    all.push_back({half, one, half, one, half, one, half});
  }
  return all;
}

// 18, and 256: errors in a row that a counter of four or of eight bits does not hold. A station in front
// would put a right check in the place of a wrong one.
std::vector<Commands> many_errors() {
  SequenceCommand wrong = command(SlaveWord::data);
  wrong.faults.push_back({SequenceFaultKind::flip, 3, 6});
  return {Commands(18, wrong), Commands(256, wrong)};
}

// A right ID cycle that ends a little before the end of that time, and one after it.
std::vector<Commands> at_the_end_of_a_reset() {
  std::vector<Commands> all;
  for (const std::int64_t side : {3, 4}) {
    for (const std::int64_t orders : {0, 1, 2})
      all.push_back({command(SlaveWord::right_id, {{0, 4}}), command(SlaveWord::kept_alive, {{0, side}}),
                     command(SlaveWord::right_id, {{0, orders}}), command(SlaveWord::data)});
  }
  return all;
}

// More than a counter of eight bits counts.
// A cycle broken off after two telegrams, then one of which a telegram has no stop level.
std::vector<Commands> stop_missing_after_a_cut() {
  std::vector<Commands> all;
  for (const std::int64_t select : {1, 0}) {
    for (const std::int64_t telegram : {0, 1, 12})
      all.push_back({command(SlaveWord::telegrams, {{0, select}, {4, 2}}),
                     command(SlaveWord::no_stop, {{1, telegram}})});
  }
  return all;
}

// The data cycle comes after 255 good ID cycles, and more, up to 257.
std::vector<Commands> data_after_many_id_cycles() {
  constexpr std::size_t kAnOctet = 256;
  std::vector<Commands> all;
  for (std::size_t count = kAnOctet - 3; count < kAnOctet + 2; ++count) {
    all.emplace_back(count, id(0));
    all.back().push_back(command(SlaveWord::data, {{0, 0x5A5A}}));
  }
  return all;
}

std::vector<Commands> many_cycles() {
  constexpr std::size_t kThreeEach = 90;
  return {Commands(kThreeEach, command(SlaveWord::data, {{6, 3}})),
          Commands(kThreeEach, command(SlaveWord::id, {{0, 0}, {6, 3}}))};
}

// What shows each coding: in a word that is marked, in one whose check is wrong, in orders and messages.
std::vector<Commands> all_codings() {
  std::vector<SequenceCommand> commands;
  for (const std::int64_t orders : {1, 2, 0}) {
    commands.push_back(id(orders));
    commands.push_back(command(SlaveWord::data, {{2, 1}}));
    commands.push_back(command(SlaveWord::data, {{3, 0x8000}}));
    // A station in front has put its own check in the place of a wrong one.
    commands.push_back(command(SlaveWord::data));
    commands.back().faults.push_back({SequenceFaultKind::flip, 3, 6});
  }
  for (const std::int64_t message : {1, 2, 0}) {
    commands.push_back(command(SlaveWord::periphery, {{0, message & 1}, {1, message >> 1}}));
    commands.push_back(id(0));
  }
  commands.push_back(id(4));
  commands.push_back(id(0));
  return {commands};
}

// What a receiver that samples in the middle of a bit stands, and one that samples beside it does not.
std::vector<Commands> edges_at_both_limits() {
  std::vector<Commands> all;
  for (const std::int64_t longer : {-3, 3}) {
    for (const std::int64_t per_mille : {-10, 10}) {
      for (const std::int64_t word : {0x5555, 0x00FE})
        all.push_back({command(SlaveWord::pulses, {{0, longer}, {1, word}, {2, per_mille}})});
    }
  }
  return all;
}

// A right cycle in two transmissions, cut at each level of its first telegrams and of its last ones.
std::vector<Commands> each_cut() {
  std::vector<Commands> all;
  for (const std::int64_t telegram : {0, 1, 5, 8, 9}) {
    for (std::int64_t level = 1; level < line::kDataTelegramLevels; ++level) {
      for (const std::int64_t gap : {0, 2})
        all.push_back({command(SlaveWord::parts, {{0, telegram}, {1, level}, {3, gap}})});
    }
  }
  return all;
}

// Cut anywhere, with what follows it; in three; without the stop level at the cut; lost with the supply.
std::vector<Commands> other_cuts() {
  std::vector<Commands> all;
  for (std::int64_t telegram = 0; telegram < 14; ++telegram) {
    for (const std::int64_t level : {1, 3, 7, 12}) {
      const GivenNumbers at{{0, telegram}, {1, level}};
      all.push_back({command(SlaveWord::cut, at)});
      all.push_back({command(SlaveWord::lost_in_a_telegram, at), id(0)});
      for (const std::int64_t levels : {1, 2, 5, 12, 30})
        all.push_back({command(SlaveWord::three_parts, {{0, telegram}, {1, level}, {3, levels}})});
    }
    all.push_back({command(SlaveWord::cut_without_stop, {{0, telegram}})});
  }
  return all;
}

// Glitches between telegrams, and on the ways back.
std::vector<Commands> other_glitches() {
  std::vector<Commands> all;
  for (std::int64_t telegram = 0; telegram < 14; ++telegram)
    for (const std::int64_t eighths : {1, 2, 3})
      all.push_back({command(SlaveWord::glitch_within, {{0, telegram}, {2, eighths}})});
  for (const std::int64_t out2 : {0, 1})
    for (const std::int64_t eighths : {1, 2, 3})
      all.push_back({command(SlaveWord::returned_glitch, {{0, out2}, {1, eighths}})});
  return all;
}

std::vector<Commands> returned_edges_at_both_limits() {
  std::vector<Commands> all;
  for (const std::int64_t out2 : {0, 1}) {
    for (const std::int64_t longer : {-3, 3}) {
      for (const std::int64_t per_mille : {-10, 10})
        all.push_back(
            {command(SlaveWord::returned_pulses, {{0, out2}, {1, 0x55}, {2, longer}, {3, per_mille}})});
    }
  }
  return all;
}

std::vector<Commands> clock_at_the_inputs() {
  return {{command(SlaveWord::clock)}};
}
std::vector<Commands> other_signs_of_life() {
  return {{command(SlaveWord::kept_alive_without_stop)}};
}

}  // namespace fieldproof::conformance::slave_families
