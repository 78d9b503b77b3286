#include <algorithm>

#include "conformance/valve_bus/node_expect.hpp"
#include "conformance/valve_bus/node_sequence_run.hpp"
#include "conformance/valve_bus/node_vocabulary.hpp"

// What the words of a sequence for a local node put on the line, and what they do at an instant.
namespace fieldproof::conformance {
namespace {

constexpr std::int64_t kSixteenths = 16;
constexpr std::int64_t kSureBits = 6;  // beside a delimiter

// Microseconds, the same for both boards: an octet of an answer tells when it was looked at.
std::uint16_t clock_of_switches(kernel::Time when) {
  return static_cast<std::uint16_t>((when.time_since_epoch() / kernel::kMicrosecond & 0xFF) * 0x0101);
}

// The levels in sixteenths of a bit. The edges within the character lie beside their places, rising ones so
// many later, or falling ones so many earlier where the number is below 0; its ends do not.
line::Levels with_moved_edges_in(const line::Levels& bits, std::int64_t sixteenths) {
  line::Levels fine;
  for (std::size_t n = 0; n < bits.size(); ++n) {
    const bool rises = n > 0 && bits[n] && !bits[n - 1];
    const bool falls_next = n + 1 < bits.size() && bits[n] && !bits[n + 1];
    const std::int64_t low_first = rises ? std::max<std::int64_t>(0, sixteenths) : 0;
    const std::int64_t low_last = falls_next ? std::max<std::int64_t>(0, -sixteenths) : 0;
    fine.append_fill(false, static_cast<std::size_t>(low_first));
    fine.append_fill(bits[n], static_cast<std::size_t>(kSixteenths - low_first - low_last));
    fine.append_fill(false, static_cast<std::size_t>(low_last));
  }
  return fine;
}

}  // namespace

// ---- the line ----

// With those that a word is about.
std::vector<SequenceFault> NodeSequenceRun::faults_of(const SequenceCommand& command) const {
  const std::size_t length = bench_.levels_of(0).size();
  const auto unit = static_cast<std::uint32_t>(command.numbers.front());
  constexpr std::uint32_t kAfterData = 9;
  constexpr std::size_t kWithParity = 11;
  const auto word = static_cast<NodeWord>(command.word);
  if (word == NodeWord::parity && length >= kWithParity) return {{SequenceFaultKind::flip, unit, kAfterData}};
  if (word == NodeWord::spaced)
    return {{SequenceFaultKind::gap, unit,
             static_cast<std::uint32_t>(length) * static_cast<std::uint32_t>(command.numbers[1]) / 10}};
  // A character of silence follows, so that it is one that is over.
  if (word == NodeWord::stop)
    return {{SequenceFaultKind::flip, unit, static_cast<std::uint32_t>(length) - 1},
            {SequenceFaultKind::gap, unit, static_cast<std::uint32_t>(length)}};
  return command.faults;
}

// Character by character, as stations do: who listens learns of each when it is over.
void NodeSequenceRun::send(const std::vector<std::uint8_t>& octets, const std::vector<SequenceFault>& faults,
                           std::int64_t rate_percent) {
  for (std::size_t n = 0; n < octets.size(); ++n) {
    line::Waveform wave;
    wave.rate = bench_.rules().bit_rate * rate_percent / 100;
    wave.levels = bench_.levels_of(octets[n]);
    bool is_dropped = false;
    std::int64_t gap = 0;
    for (const SequenceFault& fault : faults) {
      if (fault.unit != n) continue;
      if (fault.kind == SequenceFaultKind::drop) is_dropped = true;
      if (fault.kind == SequenceFaultKind::gap) gap += fault.value;
      if (fault.kind == SequenceFaultKind::flip && fault.value < wave.levels.size()) {
        wave.levels.flip(fault.value);
      }
    }
    if (is_dropped) {
      bench_.wait(bench_.characters(1));
    } else {
      bench_.drive(wave);
    }
    bench_.wait(bench_.bits(gap));
  }
  // A host waits for what is due before it says anything else.
  const auto frames = bench_.arrived();
  if (!frames.empty() && is_answered(frames.back())) bench_.await_response_window();
}

void NodeSequenceRun::send_command(std::uint8_t id, std::uint8_t command, std::uint8_t inverted) {
  const auto check = static_cast<std::uint8_t>(id ^ command ^ 0xA5 ^ 0x3C ^ inverted);
  send({id, command, 0xA5, 0x3C, check}, {});
}

void NodeSequenceRun::send_with_moved_edges(const std::vector<std::uint8_t>& octets,
                                            std::int64_t sixteenths) {
  for (const std::uint8_t octet : octets) {
    line::Waveform wave;
    wave.rate = bench_.rules().bit_rate * kSixteenths;
    wave.levels = with_moved_edges_in(bench_.levels_of(octet), sixteenths);
    bench_.drive(wave);
  }
  send({}, {});
}

// In pieces as long as a character: a line tells a transmission when it is over, and a receiver knows of a
// missing stop bit no later than that.
void NodeSequenceRun::drive_low(std::int64_t bits) {
  const auto character = static_cast<std::int64_t>(bench_.levels_of(0).size());
  for (std::int64_t left = bits; left > 0; left -= character) {
    line::Waveform piece;  // a line may take away what it is given
    piece.rate = bench_.rules().bit_rate;
    piece.levels.append_fill(false, static_cast<std::size_t>(std::min(left, character)));
    bench_.drive(piece);
  }
}

// On a silent line: a receiver would know of it before a line tells it.
void NodeSequenceRun::drive_break(std::int64_t characters) {
  bench_.wait(bench_.delimiter() + bench_.bits(kSureBits));
  line::Waveform low;
  low.rate = bench_.rules().bit_rate;
  low.levels.append_fill(false, bench_.levels_of(0).size() * static_cast<std::size_t>(characters));
  bench_.drive(low);
}

void NodeSequenceRun::drive_glitch(std::int64_t sixteenths) {
  line::Waveform low;
  low.rate = bench_.rules().bit_rate * kSixteenths;
  low.levels.append_fill(false, static_cast<std::size_t>(sixteenths));
  bench_.drive(low);
}

// ---- what takes several frames, or an instant ----

void NodeSequenceRun::poll() {
  send_command(bench_.address(), static_cast<std::uint8_t>(bench_.rules().read_command));
  bench_.wait(bench_.delimiter() + bench_.bits(kSureBits));
  compare();
}

void NodeSequenceRun::send_wrong(std::int64_t count) {
  for (std::int64_t n = 0; n < count && !is_over_; ++n) {
    send_command(bench_.address(), static_cast<std::uint8_t>(bench_.rules().write_command), 0xFF);
    bench_.wait(bench_.delimiter() + bench_.bits(kSureBits));
    compare();
  }
}

void NodeSequenceRun::give_sign_of_life(std::int64_t kind) {
  const valve_bus::Rules& rules = bench_.rules();
  if (rules.loss_limit == kernel::Duration{} || bench_.capabilities().is_wall_clock) return;
  const kernel::Duration part = rules.loss_limit / 10 * 7;
  const std::uint8_t own = bench_.address();
  const auto write = static_cast<std::uint8_t>(rules.write_command);
  constexpr std::uint8_t kUndefined = 2;
  send_command(own, write);
  bench_.wait(part);
  compare();
  if (is_over_) return;
  if (kind == 0) send_command(own, static_cast<std::uint8_t>(rules.read_command));
  if (kind == 1) send_command(own, kUndefined);
  if (kind == 2) send_command(static_cast<std::uint8_t>(own == 1 ? 2 : 1), write);
  if (kind == 3) send_command(own, write, 1);
  if (kind == 5) send_command(own, write);
  bench_.wait(part);
}

// A line that is never silent for longer than a delimiter, where that does not take too long.
void NodeSequenceRun::talk_to_others() {
  constexpr std::int64_t kFrameBits = 100;
  constexpr std::int64_t kMostFrames = 1'500;
  const valve_bus::Rules& rules = bench_.rules();
  const std::int64_t count = rules.loss_limit * 13 / 10 / bench_.bits(kFrameBits);
  if (count > kMostFrames || bench_.capabilities().is_wall_clock) return;
  const std::uint8_t own = bench_.address();
  send_command(own, static_cast<std::uint8_t>(rules.write_command));
  for (std::int64_t n = 0; n <= count && !is_over_; ++n) {
    bench_.wait(bench_.delimiter() + bench_.bits(kSureBits));
    compare();
    send_command(static_cast<std::uint8_t>(own == 1 ? 2 : 1), static_cast<std::uint8_t>(rules.write_command));
  }
  bench_.wait(bench_.delimiter() + bench_.bits(kSureBits));
}

// What begins before anybody can be sure that the command in front of it is over. A node that has answered
// by then is within its rights.
void NodeSequenceRun::cancel(const SequenceCommand& command) {
  bench_.wait(bench_.delimiter() + bench_.bits(kSureBits));
  compare();
  if (is_over_) return;
  const valve_bus::Rules& rules = bench_.rules();
  const std::uint8_t own = bench_.address();
  const bool is_write = command.numbers[0] != 0;
  const auto [data0, data1] = std::array{static_cast<std::uint8_t>(command.numbers[2]),
                                         static_cast<std::uint8_t>(command.numbers[3])};
  const auto first = static_cast<std::uint8_t>(is_write ? rules.write_command : rules.read_command);
  const auto octets_to = [](std::uint8_t id, std::uint8_t what, std::uint8_t one, std::uint8_t other) {
    return std::vector<std::uint8_t>{id, what, one, other,
                                     static_cast<std::uint8_t>(id ^ what ^ one ^ other)};
  };
  const auto drive_all = [&](const std::vector<std::uint8_t>& octets) {
    for (const std::uint8_t octet : octets) {
      line::Waveform wave;
      wave.rate = rules.bit_rate;
      wave.levels = bench_.levels_of(octet);
      bench_.drive(wave);
      is_over_ |= bench_.has_driven();
      if (is_over_) return;
    }
  };
  drive_all(octets_to(own, first, data0, data1));
  bench_.wait(bench_.delimiter() + bench_.bits(2));
  const auto another = static_cast<std::uint8_t>(own == 1 ? 2 : 1);
  const auto write = static_cast<std::uint8_t>(rules.write_command);
  const std::array<std::vector<std::uint8_t>, 3> next{
      std::vector<std::uint8_t>{0x55}, octets_to(another, write, data1, data0),
      octets_to(own, write, static_cast<std::uint8_t>(~data0), data1)};
  may_cancel_ = true;
  is_over_ |= bench_.has_driven();
  if (is_over_) return;
  drive_all(next.at(static_cast<std::size_t>(command.numbers[1])));
  // A reference that has answered by then says nothing of a node that has not.
  for (NodeTwin& twin : twins_) {
    twin.run_until(bench_.now());
    is_over_ |= !twin.take_answers().empty();
  }
  if (!is_over_) bench_.await_response_window();
}

bool NodeSequenceRun::read_until_driven() {
  bench_.wait(bench_.delimiter() + bench_.bits(kSureBits));
  compare();
  if (is_over_) return false;
  const kernel::Time latest = bench_.read() + bench_.delimiter() + turnaround_time_span(bench_.rules());
  while (bench_.now() < latest && !bench_.has_driven()) bench_.wait(bench_.bits(1));
  // One that says nothing is compared as after any read.
  if (!bench_.has_driven()) bench_.await_response_window();
  return bench_.has_driven();
}

// When references answer is another instant, and what they hear then is another moment of theirs: the answer
// is judged by itself.
void NodeSequenceRun::collide(const SequenceCommand& command) {
  if (!read_until_driven()) return;
  const kernel::Time end = bench_.arrived().back().end - bench_.distance();
  bench_.interject(octets_of(valve_bus::Response{static_cast<std::uint8_t>(command.numbers[0]),
                                                 static_cast<std::uint8_t>(command.numbers[1])}),
                   bench_.now());
  bench_.await_response_window();
  const std::uint16_t seen = bench_.configuration().boards == 1 ? switches_ & 0xFF : switches_;
  expect_one_answer(bench_, judge_, static_cast<std::uint8_t>(seen & 0xFF),
                    static_cast<std::uint8_t>(seen >> 8), end);
  forget_answers();
}

// When a node looks at its switches is its own affair, but it does so once for both boards.
void NodeSequenceRun::read_clock() {
  if (!bench_.capabilities().moving_inputs || bench_.configuration().boards == 1) return;
  bench_.wait(bench_.delimiter() + bench_.bits(kSureBits));
  compare();
  if (is_over_) return;
  bench_.boards().set_signal(0, clock_of_switches);
  const kernel::Time end = bench_.read();
  bench_.await_response_window();
  bench_.boards().set_signal(0, {});
  for (NodeTwin& twin : twins_) {
    twin.run_until(bench_.now());
    // A node whose switches give no ID does not answer.
    if (twin.take_answers().empty()) return;
  }
  is_over_ = is_doubtful();
  if (is_over_) return;
  const auto answers = bench_.answers();
  const bool has_octet = !answers.empty() && !answers.front().characters.empty();
  const std::uint8_t first = has_octet ? answers.front().characters.front().octet() : std::uint8_t{0};
  expect_one_answer(bench_, judge_, first, first, end);
  forget_answers();
}

// A transmission that has been given to a line cannot be cut, so nothing is said of the answer.
void NodeSequenceRun::lose_power_in_an_answer(std::int64_t characters) {
  if (!read_until_driven()) return;
  bench_.wait(bench_.characters(static_cast<double>(characters)));
  forget_answers();
  bench_.set_power(false);
  for (NodeTwin& twin : twins_) twin.set_power(false, bench_.now());
  bench_.wait(bench_.characters(20));
  bench_.power_up();
  for (NodeTwin& twin : twins_) {
    twin.set_power(true, bench_.now());
    twin.take_answers();
  }
  bench_.clear_observations();
  powered_at_ = bench_.now();
  begin_valves();
}

}  // namespace fieldproof::conformance
