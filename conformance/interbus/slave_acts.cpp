#include "conformance/interbus/slave_acts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "conformance/interbus/moved_edges.hpp"
#include "conformance/interbus/slave_expect.hpp"
#include "conformance/interbus/slave_transmissions.hpp"

namespace fieldproof::conformance {
namespace {

using Numbers = std::span<const std::int64_t>;

constexpr std::int64_t kPerMille = 1'000;
constexpr std::array<std::uint16_t, 2> kBehind{0x7E57, 0x1EA5};

std::uint8_t header_of(Numbers numbers) {
  return static_cast<std::uint8_t>((numbers[0] != 0 ? line::kSelect : 0) |
                                   (numbers[1] != 0 ? line::kControl : 0) |
                                   (numbers[2] != 0 ? line::kDataTelegram : 0));
}

// ---- what is sent ----

// The octets in front of the slave's own and those of the way, the nearest to these as they usually are.
std::vector<std::uint8_t> with_front(std::span<const std::uint8_t> octets, std::int64_t in_front) {
  std::vector<std::uint8_t> sent(octets.begin(), octets.end());
  const auto usual = static_cast<std::int64_t>(kFrontOfSlave);
  if (in_front >= usual) {
    sent.insert(sent.begin(), static_cast<std::size_t>(in_front - usual), 0x3C);
  } else {
    const auto most = static_cast<std::int64_t>(sent.size()) - 1;
    sent.erase(sent.begin(), sent.begin() + std::min(usual - in_front, most));
  }
  return sent;
}

void append_cycle(SlaveBench& bench, bool is_id_cycle, std::span<const std::uint8_t> octets, Numbers shape) {
  const std::vector<std::uint8_t> sent = with_front(octets, shape[2]);
  bench.train().set_gap(static_cast<unsigned>(shape[3]));
  const auto check = static_cast<std::uint16_t>(bench.model().check().of(sent) ^ shape[0]);
  const auto status = static_cast<std::uint16_t>(bench.rules().status_clean ^ shape[1]);
  bench.train().cycle(is_id_cycle, sent, check, status);
}

void append_data(SlaveBench& bench, const SequenceCommand& command) {
  const Numbers numbers = command.numbers;
  // The words turn round from cycle to cycle, so that each one is seen.
  for (std::int64_t n = 0; n < numbers[6]; ++n) {
    const std::int64_t turn = n % 2 == 0 ? 0 : 0xFFFF;
    const auto words = words_in_turn(bench, numbers[0] ^ turn, numbers[1] ^ turn);
    append_cycle(bench, false, bench.data_octets(words, kBehind), numbers.subspan(2));
  }
}

std::uint16_t control_word(SlaveBench& bench, std::int64_t orders, std::int64_t reserved) {
  const interbus::Rules& r = bench.rules();
  // What the outputs do in a reset of the outgoing bus is declared, and judged by a case of its own.
  const bool may_reset = bench.pics().text("outputs_while_outgoing_bus_is_reset", "held") == "held";
  const auto known = static_cast<std::uint16_t>(r.control_remote_off | r.control_local_off | r.control_reset |
                                                r.control_acknowledge);
  auto word = static_cast<std::uint16_t>(reserved & ~known);
  if ((orders & slave_orders::kRemoteOff) != 0) word |= r.control_remote_off;
  if ((orders & slave_orders::kBranchOff) != 0) word |= r.control_local_off;
  if ((orders & slave_orders::kReset) != 0 && may_reset) word |= r.control_reset;
  if ((orders & slave_orders::kAcknowledge) != 0) word |= r.control_acknowledge;
  return word;
}

constexpr std::array<std::int64_t, 4> kNothingWrong{0, 0, kFrontOfSlave, 2};

// The words turn round from cycle to cycle. In trains: an implementation answers a transmission in one call.
void send_good(SlaveBench& bench, Numbers numbers) {
  constexpr std::int64_t kTrain = 16;
  bench.channel().on_next();
  for (std::int64_t done = 0; done < numbers[2];) {
    bench.begin();
    for (const std::int64_t end = std::min(numbers[2], done + kTrain); done < end; ++done) {
      const std::int64_t turn = done % 2 == 0 ? 0 : 0xFFFF;
      const auto words = words_in_turn(bench, numbers[0] ^ turn, numbers[1] ^ turn);
      append_cycle(bench, false, bench.data_octets(words, kBehind), kNothingWrong);
    }
    bench.send();
  }
}

// A cycle that is right but for the stop level of a telegram.
void append_no_stop(SlaveBench& bench, const SequenceCommand& command) {
  const Numbers numbers = command.numbers;
  const auto words = words_in_turn(bench, numbers[0], ~numbers[0] & 0xFFFF);
  const std::array<std::int64_t, 4> shape{0, 0, kFrontOfSlave, numbers[2]};
  append_cycle(bench, false, bench.data_octets(words, kBehind), shape);
  const CyclePlace& cycle = bench.train().cycles().back();
  const std::size_t telegram = static_cast<std::size_t>(numbers[1]) % cycle.telegrams();
  bench.train().levels().set(cycle.level_of(telegram, TrainWriter::kStopLevel), false);
}

void append_id(SlaveBench& bench, const SequenceCommand& command) {
  const Numbers numbers = command.numbers;
  const std::array<std::uint16_t, 2> behind{bench.interfaces_off(), bench.interfaces_off()};
  for (std::int64_t n = 0; n < numbers[6]; ++n)
    append_cycle(bench, true, bench.id_octets(control_word(bench, numbers[0], numbers[1]), behind),
                 numbers.subspan(2));
}

void append_right_id(SlaveBench& bench, const SequenceCommand& command) {
  const std::array<std::uint16_t, 2> behind{bench.interfaces_off(), bench.interfaces_off()};
  const std::uint16_t control = control_word(bench, command.numbers[0], command.numbers[1]);
  append_cycle(bench, true, bench.id_octets(control, behind), kNothingWrong);
}

// The numbers of telegrams; without a stop level the level is 0 up to the next one.
void append_alike(SlaveBench& bench, Numbers numbers) {
  const std::uint8_t header = header_of(numbers);
  const unsigned length =
      (header & line::kDataTelegram) != 0 ? line::kDataTelegramLevels : line::kStatusTelegramLevels;
  for (std::int64_t n = 0; n < numbers[4]; ++n) {
    const std::size_t start = bench.train().levels().size();
    bench.train().telegram(header, static_cast<std::uint8_t>(numbers[3]));
    if (numbers[5] == 0) bench.train().levels().place(start + length - 1, 0, 1);
  }
}

void append_telegrams(SlaveBench& bench, const SequenceCommand& command) {
  append_alike(bench, command.numbers);
}

void append_status(SlaveBench& bench, const SequenceCommand& command) {
  bench.train().status(static_cast<std::size_t>(command.numbers[0]));
}

void disturb(SlaveBench& bench, const SequenceCommand& command) {
  fault::ScriptedChannel& channel = bench.channel();
  channel.on_next();
  for (const SequenceFault& fault : command.faults) {
    if (fault.kind == SequenceFaultKind::flip) {
      channel.flip_in_telegram(fault.unit, fault.value);
    } else if (fault.kind == SequenceFaultKind::drop) {
      channel.drop_telegram(fault.unit);
    }
  }
}

// ---- inputs that move ----

// Microseconds, the same in both octets: an octet tells when it was looked at.
std::uint16_t clock_of_octets(kernel::Time when) {
  return static_cast<std::uint16_t>((when.time_since_epoch() / kernel::kMicrosecond & 0xFF) * 0x0101);
}

// Where its own register leaves first.
LineView& first_way_out(SlaveBench& bench) {
  if (!bench.branch().data_telegrams().empty()) return bench.branch();
  return bench.remote().data_telegrams().empty() ? bench.out() : bench.remote();
}

// The words that left in each cycle but the first, which ends what was sent before it.
std::vector<std::vector<std::uint16_t>> samples_of(SlaveBench& bench) {
  std::vector<std::vector<std::uint16_t>> all;
  LineView& view = first_way_out(bench);
  for (std::size_t n = 1; n < bench.train().cycles().size(); ++n) {
    const std::optional<CycleOnLine> out = bench.cycle_on(view, n);
    if (!out) return {};
    all.emplace_back();
    for (unsigned word = 0; word < bench.words(); ++word) all.back().push_back(out->word(2 * word));
  }
  return all;
}

// Of one instant, but for a tick between two words; empty: they are.
std::string_view wrong_sample(std::span<const std::uint16_t> words) {
  for (const std::uint16_t word : words) {
    if (word >> 8 != (word & 0xFF)) return "input_word_torn";
    const auto ticks = static_cast<std::int8_t>(static_cast<std::uint8_t>(word - words.front()));
    if (ticks < -1 || ticks > 1) return "input_words_not_of_one_instant";
  }
  return {};
}

// Ticks between the start level of the first telegram and what stood in the word, which is looked at there:
// from a quarter of a bit before it to a bit after.
bool is_of_start_level(SlaveBench& bench, std::size_t n, std::uint16_t word) {
  const std::optional<CycleOnLine> in = bench.cycle_on(bench.in(), n);
  if (!in) return true;
  const kernel::Time start = bench.in().start_of(in->telegrams[0]);
  const auto tick = [](kernel::Time when) { return static_cast<std::uint8_t>(clock_of_octets(when)); };
  const std::uint8_t first = tick(start - bench.bits(1) / 4);
  const std::uint8_t last = tick(start + bench.bits(1));
  return static_cast<std::uint8_t>(word - first) <= static_cast<std::uint8_t>(last - first);
}

// ---- what happens besides ----

void send_back(SlaveBench& bench, Numbers numbers) {
  const bool on_branch = numbers[0] != 0;
  if (bench.neighbour_words(on_branch) == 0) return;
  bench.begin();
  append_alike(bench, numbers.subspan(1));
  bench.send_back(on_branch);
}

// A low pulse of so many eighths of a bit: shorter than half a bit, it is no start level.
void drive_glitch(SlaveBench& bench, std::int64_t eighths) {
  constexpr std::int64_t kLevelsPerBit = 8;
  line::Levels levels;
  levels.append_idle(kLevelsPerBit);
  levels.append_fill(false, static_cast<std::size_t>(eighths));
  levels.append_idle(static_cast<std::size_t>(kLevelsPerBit));
  line::Waveform wave{bench.now(), bench.rules().bit_rate * kLevelsPerBit, std::move(levels)};
  bench.drive_at_receiver(wave);
}

}  // namespace

void SlaveActs::act(const SequenceCommand& command, CaseJudge& judge) {
  const Numbers numbers = command.numbers;
  switch (static_cast<SlaveWord>(command.word)) {
    case SlaveWord::data:
      return send(command, append_data);
    case SlaveWord::id:
      return send(command, append_id);
    case SlaveWord::telegrams:
      return send(command, append_telegrams);
    case SlaveWord::status:
      return send(command, append_status);
    case SlaveWord::inputs:
      return twins_.each(
          [&](SlaveBench& one) { one.set_inputs(words_in_turn(one, numbers[0], numbers[1])); });
    case SlaveWord::plugs:
      return twins_.each([&](SlaveBench& one) {
        one.set_bridge(false, numbers[0] != 0 && twins_.bench().pics().supports("remote_interface"));
        one.set_bridge(true, numbers[1] != 0);
      });
    case SlaveWord::periphery:
      return periphery(command);
    case SlaveWord::returns:
      return twins_.each([&](SlaveBench& one) { send_back(one, numbers); });
    case SlaveWord::silence:
      return be_silent(numbers[0]);
    case SlaveWord::kept_alive:
      return keep_alive(numbers[0]);
    case SlaveWord::power:
      return lose_supply(numbers[0] * kernel::kMillisecond);
    case SlaveWord::glitch:
      twins_.each([&](SlaveBench& one) { drive_glitch(one, numbers[0]); });
      return note_what_came(false);
    case SlaveWord::good:
      twins_.each([&](SlaveBench& one) { send_good(one, numbers); });
      return note_what_came(false);
    case SlaveWord::no_stop:
      return send(command, append_no_stop);
    case SlaveWord::rate:
      return drive_at_rate(command, judge);
    case SlaveWord::pulses:
      return drive_pulses(command, judge);
    case SlaveWord::parts:
      return drive_parts(command);
    case SlaveWord::right_id:
      return send(command, append_right_id);
    case SlaveWord::clock:
      return show_clock(judge);
    case SlaveWord::cut:
    case SlaveWord::lost_in_a_telegram: {
      const bool loses_supply = static_cast<SlaveWord>(command.word) == SlaveWord::lost_in_a_telegram;
      twins_.each(
          [&](SlaveBench& one) { drive_cut_cycle(one, numbers[2], {numbers[0], numbers[1]}, loses_supply); });
      return note_what_came(false);
    }
    case SlaveWord::three_parts:
      twins_.each(
          [&](SlaveBench& one) { drive_in_three(one, numbers[2], {numbers[0], numbers[1]}, numbers[3]); });
      return note_what_came(false);
    case SlaveWord::cut_without_stop:
      twins_.each([&](SlaveBench& one) { drive_cut_at_missing_stop(one, numbers[1], numbers[0]); });
      return note_what_came(false);
    case SlaveWord::glitch_within:
      twins_.each([&](SlaveBench& one) { drive_glitch_within(one, numbers[1], numbers[0], numbers[2]); });
      return note_what_came(false);
    case SlaveWord::returned_glitch:
      return twins_.each([&](SlaveBench& one) { return_glitch(one, numbers[0] != 0, numbers[1]); });
    case SlaveWord::returned_pulses:
      if (!twins_.bench().has_line_interface()) return;
      return twins_.each(
          [&](SlaveBench& one) { return_pulses(one, numbers[0] != 0, numbers[1], numbers[2], numbers[3]); });
    case SlaveWord::kept_alive_without_stop:
      return keep_alive_without_stop();
  }
}

void SlaveActs::lose_supply(kernel::Duration duration) {
  twins_.each([&](SlaveBench& one) {
    one.set_power(false);
    one.silence(duration);
    one.set_power(true);
  });
}

// Who receives telegrams has no levels that could be off: nothing comes. What a slave reads of it is its own
// affair, as long as it does not take it. What it keeps of it is lost.
void SlaveActs::drive_at_rate(const SequenceCommand& command, CaseJudge& judge) {
  if (!twins_.bench().has_line_interface()) return;
  const auto word = static_cast<std::uint16_t>(command.numbers[1]);
  twins_.each([&](SlaveBench& one) {
    const std::int64_t rate = one.rules().bit_rate * (kPerMille + command.numbers[0]) / kPerMille;
    line::Waveform wave{one.now(), rate, one.direct_data_cycle(words_in_turn(one, word, word), 2)};
    one.drive_at_receiver(wave);
  });
  judge.expect(!left_clean(twins_.bench()), "rate_beyond_limit_accepted",
               "a cycle at 6 % beside the bit rate is rejected", "one left with a clean status word");
  twins_.each([](SlaveBench& one) { one.clear_views(); });
  lose_supply(kernel::kMillisecond);
}

// Each word tells when it was looked at: all of a cycle at one instant, that of its first start level.
void SlaveActs::show_clock(CaseJudge& judge) {
  constexpr unsigned kCycles = 4;
  constexpr std::array<std::int64_t, 2> kWordsOfClock{0x1234, 0xFEDC};
  bool is_certain = twins_.bench().pics().supports("inputs");
  twins_.each([&](SlaveBench& one) {
    for (unsigned word = 0; word < one.words(); ++word) one.terminals().set_signal(word, clock_of_octets);
    one.channel().on_next();
    one.begin();
    for (unsigned n = 0; n < kCycles; ++n)
      append_cycle(one, false,
                   one.data_octets(words_in_turn(one, kWordsOfClock[0], kWordsOfClock[1]), kBehind),
                   kNothingWrong);
    one.send();
    const auto samples = samples_of(one);
    if (&one != &twins_.bench())
      is_certain &=
          std::ranges::all_of(samples, [](const auto& words) { return wrong_sample(words).empty(); });
  });
  note_what_came(false);
  const auto samples = is_certain ? samples_of(twins_.bench()) : decltype(samples_of(twins_.bench())){};
  for (std::size_t n = 0; n < samples.size(); ++n) {
    const std::string_view reason = wrong_sample(samples[n]);
    const std::string words = fmt::format("{:04X}", fmt::join(samples[n], " "));
    judge.expect(reason.empty(), reason, "words of one instant of the clock at the inputs", words);
    judge.expect(samples[n].empty() || is_of_start_level(twins_.bench(), n + 1, samples[n].front()),
                 "inputs_of_another_instant",
                 "the inputs as they stood at the start level of the first telegram, to a bit", words);
  }
  twins_.each([](SlaveBench& one) {
    for (unsigned word = 0; word < one.words(); ++word) one.terminals().set_signal(word, {});
    one.clear_views();
  });
}

void SlaveActs::drive_parts(const SequenceCommand& command) {
  const Numbers numbers = command.numbers;
  twins_.each([&](SlaveBench& one) {
    const auto gap = static_cast<std::size_t>(numbers[3]);
    const line::Levels levels = one.direct_data_cycle(words_in_turn(one, numbers[2], ~numbers[2] & 0xFFFF),
                                                      static_cast<unsigned>(gap));
    const std::size_t pitch = line::kDataTelegramLevels + gap;
    const std::size_t telegram = static_cast<std::size_t>(numbers[0]) % (levels.size() / pitch);
    one.drive_at_receiver(levels, std::array{telegram * pitch + static_cast<std::size_t>(numbers[1])});
  });
  note_what_came(false);
}

void SlaveActs::drive_pulses(const SequenceCommand& command, CaseJudge& judge) {
  constexpr double kMostOff = 0.03;
  if (!twins_.bench().has_line_interface()) return;
  const auto word = static_cast<std::uint16_t>(command.numbers[1]);
  twins_.each([&](SlaveBench& one) {
    const line::Levels levels =
        with_moved_edges(one.direct_data_cycle(words_in_turn(one, word, ~word & 0xFFFF), 2),
                         [&](bool falls) { return falls ? 0 : command.numbers[0]; });
    const std::int64_t rate = one.rules().bit_rate * (kPerMille + command.numbers[2]) / kPerMille;
    line::Waveform wave{one.now(), rate * kEdgesPerBit, levels};
    one.drive_at_receiver(wave);
  });
  note_what_came(false);
  const double worst = worst_edge(twins_.bench());
  judge.expect(worst <= kMostOff, "output_not_retimed",
               "every edge that leaves lies within 3 % of a bit of its place",
               fmt::format("one is {:.0f} % of a bit off", 100 * worst));
}

void SlaveActs::send(const SequenceCommand& command, void (*append)(SlaveBench&, const SequenceCommand&)) {
  twins_.each([&](SlaveBench& one) {
    one.begin();
    append(one, command);
    disturb(one, command);
    one.send();
  });
  const auto word = static_cast<SlaveWord>(command.word);
  note_what_came(word == SlaveWord::id || word == SlaveWord::right_id);
}

void SlaveActs::note_what_came(bool is_id_cycle) {
  LineView& in = twins_.bench().in();
  if (in.telegrams().empty()) return;
  last_telegram_ = in.end_of(in.telegrams().back());
  if (is_id_cycle) last_id_cycle_ = last_telegram_;
}

void SlaveActs::periphery(const SequenceCommand& command) {
  const judge::Pics& pics = twins_.bench().pics();
  const bool has_fault = command.numbers[0] != 0 && pics.supports("peripheral_fault_input");
  const bool is_asked = command.numbers[1] != 0 && pics.supports("reconfiguration_button");
  twins_.each([&](SlaveBench& one) {
    one.terminals().set_peripheral_fault([has_fault](kernel::Time) { return has_fault; });
    one.terminals().set_reconfiguration([is_asked](kernel::Time) { return is_asked; });
  });
}

void SlaveActs::be_silent(std::int64_t how_long) {
  const interbus::Rules& rules = twins_.bench().rules();
  const kernel::Duration beyond =
      rules.silence_tolerance + rules.silence_tolerance / 2 + twins_.bench().bits(2);
  const std::array<kernel::Duration, 6> lengths{
      rules.silence_limit / 2,      rules.silence_limit - beyond,
      rules.silence_limit + beyond, 3 * rules.silence_limit + beyond,
      70 * kernel::kSecond,         rules.silence_limit + rules.silence_tolerance / 4};
  const kernel::Time until = std::max(twins_.bench().now() + twins_.bench().bits(1),
                                      last_telegram_ + lengths.at(static_cast<std::size_t>(how_long)));
  twins_.each([&](SlaveBench& one) { one.segment().run_until(until); });
}

void SlaveActs::keep_alive(std::int64_t how_long) {
  const interbus::Rules& rules = twins_.bench().rules();
  const kernel::Duration whole = rules.silence_limit + rules.silence_tolerance;
  const kernel::Duration beside = rules.silence_tolerance / 2 + twins_.bench().bits(60);
  // Certain is the end of that time to an eighth of the tolerance.
  const kernel::Duration near = 3 * rules.silence_tolerance / 16 + twins_.bench().bits(1);
  const kernel::Duration before_id = whole - time_of_right_id();
  const std::array<kernel::Duration, 5> lengths{whole / 2, whole - beside, whole + beside, before_id - near,
                                                before_id + near};
  const kernel::Time until = last_id_cycle_ + lengths.at(static_cast<std::size_t>(how_long));
  const kernel::Duration step =
      std::min(rules.silence_limit / 3, (until - twins_.bench().now()) / 4 + kernel::kPicosecond);
  while (twins_.bench().now() < until) {
    const kernel::Time next = std::min(until, twins_.bench().now() + step);
    twins_.each([&](SlaveBench& one) {
      one.status_telegrams(1);
      one.segment().run_until(std::max(next, one.now()));
    });
    note_what_came(false);
  }
}

// Until its last telegram has arrived. Of all three: a train keeps its gap for what is sent next.
kernel::Duration SlaveActs::time_of_right_id() {
  std::size_t levels = 0;
  twins_.each([&](SlaveBench& one) {
    one.begin();
    const std::array<std::uint16_t, 2> behind{one.interfaces_off(), one.interfaces_off()};
    append_cycle(one, true, one.id_octets(0, behind), kNothingWrong);
    const CyclePlace& cycle = one.train().cycles().back();
    levels = cycle.level_of(cycle.telegrams() - 1, line::kDataTelegramLevels);
  });
  return twins_.bench().bits(static_cast<std::int64_t>(levels));
}

void SlaveActs::keep_alive_without_stop() {
  const interbus::Rules& rules = twins_.bench().rules();
  const kernel::Time until = last_telegram_ + rules.silence_limit + 2 * rules.silence_tolerance;
  const kernel::Duration step = rules.silence_limit / 3;
  while (twins_.bench().now() < until) {
    const kernel::Time next = twins_.bench().now() + step;
    twins_.each([&](SlaveBench& one) {
      one.begin();
      one.train().status(1);
      one.channel().on_next();
      one.channel().flip_in_telegram(0, line::kStatusTelegramLevels - 1);
      one.send();
      one.segment().run_until(std::max(next, one.now()));
    });
    note_what_came(false);
  }
}

}  // namespace fieldproof::conformance
