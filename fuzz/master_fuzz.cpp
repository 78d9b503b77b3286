// A whole master, fed with arbitrary content on its return line.
//
// Input: a script. Its first octet chooses the configuration and whether disturbances begin with the
// recognition or in run; then each step says what becomes of the answer to one cycle: nothing, flipped
// levels, loss, forged octets with a check that fits them, a marked status, a telegram too many, delay,
// another rate, raw levels, a cut, a division into waveforms; or what the application does. Invariants: a
// cycle is accepted only when the telegrams that came back are one (by the definition, with a check that is
// computed bit by bit), and only then inputs change, to exactly its words; what the master drives never
// overlaps and never pauses for longer than the stations' supervision unless it has stopped the bus; on an
// ideal ring it works again within the published number of cycles, or has stopped and works after a start.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fuzz/ideal_ring.hpp"
#include "fuzz/octet_reader.hpp"
#include "fuzz/reference_line.hpp"
#include "harness/kernel/check.hpp"
#include "harness/line/telegram_receiver.hpp"
#include "harness/segment/segment.hpp"
#include "protocols/interbus/master.hpp"

namespace {

using fieldproof::fuzz::Answer;
using fieldproof::fuzz::check_bit_by_bit;
using fieldproof::fuzz::IdealRing;
using fieldproof::fuzz::OctetReader;
using fieldproof::fuzz::SentTelegram;
using fieldproof::interbus::Master;
using fieldproof::interbus::MasterConfiguration;
using fieldproof::interbus::MasterState;
using fieldproof::interbus::Rules;
using fieldproof::kernel::Duration;
using fieldproof::kernel::kMillisecond;
using fieldproof::kernel::Time;
using fieldproof::line::kDataTelegram;
using fieldproof::line::Telegram;
using fieldproof::line::Waveform;

constexpr std::size_t kLargestInput = 256;
constexpr unsigned kMostCycles = 64;
constexpr unsigned kMostEvents = 20'000;
constexpr std::size_t kTrailer = 4;

// Few status telegrams and little software time: both cost time and show nothing new.
Rules quick_rules() {
  Rules rules;
  rules.status_pitch_bits = 250;
  rules.software_time = 50 * fieldproof::kernel::kMicrosecond;
  return rules;
}

MasterConfiguration configuration(std::uint8_t choice) {
  MasterConfiguration made;
  made.rules = quick_rules();
  if ((choice & 1) == 0) {
    made.expected = {{IdealRing::id_code(0), 1, -1, false}, {IdealRing::id_code(1), 1, 0, false}};
  }
  if ((choice & 2) != 0) made.copy = {{0, 1}};
  return made;
}

// Hears the return line as the master does and judges each cycle for itself.
class Witness final : public fieldproof::segment::Tap {
 public:
  Witness(const fieldproof::line::TelegramCode& code, std::int64_t bit_rate) : receiver_(code, bit_rate) {}

  void on_wave(const Waveform& wave) override {
    receiver_.receive(wave, [this](const Waveform& heard, const Telegram& t) { add(heard, t); });
  }
  void begin(Time now, std::size_t transfer, bool is_id_cycle) {
    flush(now);
    telegrams_.clear();
    starts_.clear();
    transfer_ = transfer;
    is_id_cycle_ = is_id_cycle;
  }
  void flush(Time now) {
    if (receiver_.pending_until() > now) return;
    receiver_.flush([this](const Waveform& heard, const Telegram& t) { add(heard, t); });
  }
  bool is_acceptable(Time now) const;
  std::uint16_t word(std::size_t n) const {
    return static_cast<std::uint16_t>(telegrams_[2 * n].data << 8 | telegrams_[2 * n + 1].data);
  }
  std::size_t words() const { return transfer_ / 2 - 1; }

 private:
  void add(const Waveform& wave, const Telegram& telegram) {
    if (!telegram.is_data()) return;
    telegrams_.push_back({telegram.level, telegram.header, telegram.data});
    starts_.push_back(wave.time_of(telegram.level));
  }

  fieldproof::line::TelegramReceiver receiver_;
  std::vector<SentTelegram> telegrams_;
  std::vector<Time> starts_;
  std::size_t transfer_ = 0;
  bool is_id_cycle_ = false;
};

// Whether what came back until now is the cycle that was sent, turned around.
FIELDPROOF_UNINSTRUMENTED bool Witness::is_acceptable(Time now) const {
  const std::size_t count = transfer_ + kTrailer;
  if (telegrams_.size() < count) return false;
  // A telegram that follows after the verdict is nothing to it; one that began before it is one too many.
  if (telegrams_.size() > count && starts_[count] < now) return false;
  std::vector<std::uint8_t> octets;
  for (std::size_t n = 0; n < count; ++n) {
    const unsigned phase = (is_id_cycle_ ? 1U : 0U) | (n < transfer_ ? 0U : 2U) | kDataTelegram;
    if (telegrams_[n].header != phase) return false;
    octets.push_back(telegrams_[n].data);
  }
  const std::uint16_t check = check_bit_by_bit({octets.data(), transfer_});
  const std::uint16_t status = static_cast<std::uint16_t>(octets[transfer_ + 2] << 8 | octets[transfer_ + 3]);
  if ((octets[transfer_] << 8 | octets[transfer_ + 1]) != check || status != 0) return false;
  for (std::size_t n = is_id_cycle_ ? 0 : transfer_ - 2; n + 1 < transfer_; n += 2) {
    if (octets[n] == 0xA5 && octets[n + 1] == 0x5A) return true;
  }
  return false;
}

class World final : private fieldproof::fuzz::Line, private fieldproof::segment::Tap {
 public:
  explicit World(OctetReader& script);
  void run_script();
  void recover();

 private:
  void on_answer(Answer& answer) override;
  void on_wave(const Waveform& wave) override;
  void on_cycle_end(Time now, bool is_data_cycle, bool accepted);
  void disturb(Answer& answer, Waveform& wave);
  void forge(Answer& answer);
  void write(const Answer& answer, Waveform& wave) const;
  void flip(Waveform& wave);
  void divide(Waveform& wave);
  void drive(Waveform& wave);
  void act_as_application(std::uint8_t choice);
  void check_images();
  void note_state();
  void take_inputs();
  void step();
  bool is_working() const;
  bool knows_ring() const;
  bool run_until_working(unsigned cycles, Duration most);
  void start();
  void restart();

  OctetReader& script_;
  const std::uint8_t choice_;
  fieldproof::segment::Segment segment_;
  Master master_;
  const fieldproof::line::TelegramCode code_;
  Witness witness_;
  IdealRing ring_;
  fieldproof::segment::Link* out_ = nullptr;
  fieldproof::segment::Link* back_ = nullptr;
  std::size_t seat_ = 0;

  bool is_ideal_ = false;
  bool is_held_up_ = false;  // the last answer, by one before it that was late
  unsigned cycles_ = 0;
  unsigned ends_ = 0;
  unsigned events_ = 0;
  bool last_was_good_data_ = false;
  fieldproof::interbus::MasterStatus status_;  // as of the last event that may have changed it
  bool may_pause_ = true;
  Time driven_until_{};
  std::vector<std::uint16_t> inputs_;  // as the last accepted cycle brought them
};

World::World(OctetReader& script)
    : script_(script),
      choice_(script.octet()),
      master_(configuration(choice_)),
      code_(Rules{}.telegram),
      witness_(code_, Rules{}.bit_rate),
      ring_(code_, Rules{}.bit_rate, *this) {
  seat_ = segment_.attach(master_, "master");
  const std::size_t ring = segment_.attach(ring_, "ring");
  out_ = &segment_.connect("ring/in", ring, 0, {});
  back_ = &segment_.connect("master/in", seat_, 0, {});
  out_->tap_driven(*this);
  back_->tap_arrived(witness_);
  master_.wire(*out_);
  master_.on_cycle_end([this](Time now, bool data, bool accepted) { on_cycle_end(now, data, accepted); });
  ring_.set_input(0, 0x1234);
  ring_.set_input(1, 0x5678);
  start();
}

void World::start() {
  master_.start(segment_.now());
  note_state();
  may_pause_ = true;
  segment_.refresh(seat_);
}

// ---- what the master drives, and what it makes of what comes back ----

void World::on_wave(const Waveform& wave) {
  if (driven_until_ > fieldproof::kernel::kStart) {
    FIELDPROOF_CHECK(wave.start >= driven_until_, "what a master drives does not overlap");
    FIELDPROOF_CHECK(may_pause_ || wave.start - driven_until_ <= Rules{}.silence_limit,
                     "a master that has not stopped the bus gives signs of life");
  }
  driven_until_ = wave.end();
  may_pause_ = false;
  status_ = master_.status();
  check_images();
}

void World::on_cycle_end(Time now, bool is_data_cycle, bool accepted) {
  ++ends_;
  witness_.flush(now);
  last_was_good_data_ = is_data_cycle && accepted;
  FIELDPROOF_CHECK(!accepted || witness_.is_acceptable(now), "only a right cycle is accepted");
  note_state();
  if (last_was_good_data_ && status_.state == MasterState::run) take_inputs();
  check_images();
}

// The words of the last station came first, those of each station in their order.
void World::take_inputs() {
  inputs_.assign(witness_.words(), 0);
  std::size_t from = 0;
  std::size_t end = inputs_.size();
  for (auto station = status_.stations.rbegin(); station != status_.stations.rend(); ++station) {
    FIELDPROOF_CHECK(station->words <= end, "a cycle has the words of all stations");
    end -= station->words;
    for (unsigned word = 0; word < station->words; ++word) inputs_[end + word] = witness_.word(from++);
  }
}

void World::note_state() {
  status_ = master_.status();
  const MasterState state = status_.state;
  if (state == MasterState::off || state == MasterState::bus_stop) may_pause_ = true;
  if (state != MasterState::run && state != MasterState::bus_stop) inputs_.clear();
}

// Nothing but an accepted cycle changes inputs, and that one all at once.
void World::check_images() {
  for (std::size_t n = 0; n < inputs_.size(); ++n) {
    FIELDPROOF_CHECK(master_.input(static_cast<unsigned>(n)) == inputs_[n],
                     "inputs are those of the last accepted cycle, as a whole");
  }
}

// ---- what comes back ----

void World::write(const Answer& answer, Waveform& wave) const {
  wave.start = answer.start;
  wave.rate = Rules{}.bit_rate;
  wave.levels.clear();
  for (const SentTelegram& t : answer.telegrams) {
    if (t.level > wave.levels.size()) wave.levels.append_idle(t.level - wave.levels.size());
    code_.append(wave.levels, t.header, t.data);
  }
}

void World::on_answer(Answer& answer) {
  ++cycles_;
  witness_.begin(segment_.now(), answer.transfer, answer.is_id_cycle);
  Waveform wave;
  if (is_ideal_) {
    write(answer, wave);
  } else {
    disturb(answer, wave);
  }
  drive(wave);
}

void World::drive(Waveform& wave) {
  if (wave.levels.empty()) return;
  const Time in_time = wave.start;
  wave.start = std::max({in_time, back_->driven_until(), segment_.now()});
  is_held_up_ = wave.start > in_time;
  back_->drive(wave);
}

void World::flip(Waveform& wave) {
  for (unsigned left = script_.octet() % 4U + 1; left > 0 && !wave.levels.empty(); --left) {
    wave.levels.flip(script_.word() % wave.levels.size());
  }
}

void World::forge(Answer& answer) {
  const auto octets = script_.take(script_.octet() % 12U);
  for (std::size_t n = 0; n < std::min(octets.size(), answer.transfer); ++n) {
    answer.telegrams[n].data = octets[n];
  }
  answer.repair();
}

void World::divide(Waveform& wave) {
  const std::size_t step = std::size_t{script_.octet()} % 64 + 8;
  std::size_t at = 0;
  for (; at + step < wave.levels.size(); at += step) {
    Waveform part{wave.time_of(at), wave.rate, wave.levels.slice(at, step)};
    drive(part);
  }
  wave.start = wave.time_of(at);
  wave.levels = wave.levels.slice(at, wave.levels.size() - at);
}

void World::disturb(Answer& answer, Waveform& wave) {
  const std::uint8_t choice = script_.octet();
  const unsigned kind = choice % 13;
  if (kind == 3) forge(answer);
  if (kind == 4) answer.telegrams.back().data = script_.octet();  // of the status word
  if (kind == 5) {
    answer.telegrams.push_back(answer.telegrams.back());
    answer.telegrams.back().level += script_.octet();
  }
  if (kind == 6) answer.telegrams.resize(script_.octet() % answer.telegrams.size());
  if (kind == 7) answer.telegrams[script_.octet() % answer.telegrams.size()].header = choice >> 4 & 7;
  write(answer, wave);
  if (kind == 1) flip(wave);
  if (kind == 2) wave.levels.clear();
  if (kind == 8) wave.start += fieldproof::kernel::levels_duration(script_.octet(), Rules{}.bit_rate);
  if (kind == 9) wave.rate += (std::int64_t{script_.octet()} - 128) * 400;
  if (kind == 10) {
    wave.levels.clear();
    for (const std::uint8_t octet : script_.take(script_.octet() % 32U)) wave.levels.append(octet, 8);
  }
  if (kind == 11) divide(wave);
  if (kind == 12) act_as_application(choice);
}

void World::act_as_application(std::uint8_t choice) {
  switch (choice / 13 % 6) {
    case 0:
      return ring_.set_input(choice & 1, script_.word());
    case 1:
      return master_.request_id_cycle(segment_.now());
    case 2:
      return master_.write_output(choice & 1, script_.word(), segment_.now());
    case 3:
      master_.stop(segment_.now());
      break;
    case 4:
      is_ideal_ = true;  // from here on nothing is disturbed
      return;
    default:
      return;
  }
  note_state();
}

// ---- the run ----

void World::step() {
  FIELDPROOF_CHECK(++events_ < kMostEvents, "a master does a bounded number of things in a time");
  segment_.step();
}

void World::run_script() {
  is_ideal_ = (choice_ & 4) != 0;
  while (is_ideal_ && !is_working()) step();
  is_ideal_ = false;
  const unsigned last = cycles_ + kMostCycles;
  // A master that has stopped and found the fault sends no more cycles: what is left of the script stays.
  const Time end = segment_.now() + 300 * kMillisecond;
  while (!script_.is_empty() && !is_ideal_ && cycles_ < last && segment_.now() < end) {
    const MasterState state = status_.state;
    if (state == MasterState::off || (state == MasterState::bus_stop && (choice_ & 8) != 0)) start();
    step();
    // A stop with a configuration error lasts until a start: nothing is left to disturb.
    if (state == MasterState::bus_stop && !status_.configuration_error.empty()) break;
  }
  is_ideal_ = true;
}

bool World::is_working() const {
  return last_was_good_data_ && status_.state == MasterState::run &&
         status_.stations.size() == IdealRing::kStations && master_.input(0) == ring_.input(0) &&
         master_.input(1) == ring_.input(1);
}

// Without a configuration it may have taken a shorter ring, or forged ID codes, for what is there.
bool World::knows_ring() const {
  if (status_.stations.size() != IdealRing::kStations) return false;
  for (std::size_t n = 0; n < IdealRing::kStations; ++n) {
    if (status_.stations[n].id_code != IdealRing::id_code(n)) return false;
  }
  return true;
}

bool World::run_until_working(unsigned cycles, Duration most) {
  const unsigned last = ends_ + cycles;
  const Time end = segment_.now() + most;
  last_was_good_data_ = false;
  while (!is_working() && ends_ < last && segment_.now() < end) {
    const MasterState state = status_.state;
    if (state == MasterState::off) return false;
    step();
  }
  return is_working();
}

void World::restart() {
  master_.stop(segment_.now());
  note_state();
  const Time end = segment_.now() + 20 * kMillisecond;
  while (status_.state != MasterState::off && segment_.now() < end) step();
  start();
}

void World::recover() {
  // What was disturbed last still comes back: up to two cycles with the longest delay. It holds up the
  // answers after it, each a little less than the one before.
  (void)run_until_working(2, 50 * kMillisecond);
  for (unsigned ends = ends_ - 1; is_held_up_ && ends != ends_;) {
    ends = ends_;
    (void)run_until_working(1, 50 * kMillisecond);
  }
  const bool was_running = status_.state == MasterState::run && knows_ring();
  bool works = run_until_working(Rules{}.published_recovery_cycles, 50 * kMillisecond);
  const MasterState state = status_.state;
  FIELDPROOF_CHECK(works || !was_running || state != MasterState::run,
                   "a running master works again within the published number of cycles");
  if (works) return;
  // What it is about now (recognition, search for a fault, silence) comes to an end.
  works = run_until_working(kMostCycles, 500 * kMillisecond);
  if (!works) restart();
  works = works || run_until_working(kMostCycles, 500 * kMillisecond);
  FIELDPROOF_CHECK(works, "a master works after a start, whatever came before");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > kLargestInput) return -1;
  OctetReader script(data, size);
  World world(script);
  world.run_script();
  world.recover();
  return 0;
}
