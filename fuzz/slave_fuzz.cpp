// A whole slave in a segment, fed with arbitrary content on all three of its lines.
//
// Input: a script. Its first octet chooses the slave (register length, kind of bus, branch), then each step
// is an octet that chooses what comes, and its parameters: telegrams, raw levels, levels at another rate,
// good ID and data cycles, cycles with arbitrary octets and a check that fits them, all of them with a level
// flipped if the step says so, idle time, silence, the bridges put in and pulled, content of the return
// lines. Invariants: the outputs are written when the model (slave_model.hpp) says so, and with its values,
// and never otherwise; what the slave sends is bounded by what it hears; when the line is clean again, one
// good ID cycle and one data cycle work.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "fuzz/octet_reader.hpp"
#include "fuzz/reference_line.hpp"
#include "fuzz/script.hpp"
#include "fuzz/slave_model.hpp"
#include "harness/kernel/check.hpp"
#include "harness/segment/segment.hpp"
#include "protocols/interbus/slave.hpp"

namespace {

using fieldproof::fuzz::check_bit_by_bit;
using fieldproof::fuzz::OctetReader;
using fieldproof::fuzz::OutputWrite;
using fieldproof::fuzz::SlaveModel;
using fieldproof::interbus::kFromBranch;
using fieldproof::interbus::kFromRemote;
using fieldproof::interbus::kFromUpstream;
using fieldproof::interbus::Rules;
using fieldproof::interbus::Slave;
using fieldproof::interbus::SlaveConfiguration;
using fieldproof::kernel::Duration;
using fieldproof::kernel::kMicrosecond;
using fieldproof::kernel::kMillisecond;
using fieldproof::kernel::Time;
using fieldproof::line::Waveform;

constexpr unsigned kMostSteps = 40;
constexpr std::uint16_t kInput = 0xC35A;
constexpr std::uint16_t kMark = 0xBEEF;
constexpr std::uint8_t kTransfer = 4;
constexpr std::uint8_t kCheck = 6;
constexpr std::uint8_t kIdTransfer = 5;
constexpr std::uint8_t kIdCheck = 7;

class Terminals final : public fieldproof::interbus::Terminals {
 public:
  std::uint16_t input(unsigned, Time) override { return kInput; }
  void output(unsigned word, std::uint16_t value, Time when) override {
    writes.push_back({when, word, value});
  }
  bool has_peripheral_fault(Time) override { return has_fault; }
  bool wants_reconfiguration(Time) override { return !has_fault; }

  std::vector<OutputWrite> writes;
  bool has_fault = false;
};

// The end of a line that the slave drives.
class Listener final : public fieldproof::segment::Station {
 public:
  void receive(fieldproof::segment::PortIndex, const Waveform& wave) override {
    levels += wave.levels.size();
    ++waves;
  }
  void on_time(Time) override {}
  Time next_time() const override { return fieldproof::kernel::kNever; }

  std::size_t levels = 0;
  std::size_t waves = 0;
};

SlaveConfiguration configuration(std::uint8_t choice) {
  constexpr std::array<std::uint8_t, 4> kWords = {1, 0, 2, 5};
  SlaveConfiguration made;
  made.words = kWords[choice & 3];
  made.id_code = static_cast<std::uint16_t>(made.words << 8 | 3);
  made.is_local = (choice & 4) != 0;
  made.has_branch = (choice & 8) == 0;
  return made;
}

class World {
 public:
  explicit World(std::uint8_t choice)
      : configuration_(configuration(choice)),
        slave_(configuration_),
        model_(configuration_.words, rules().bit_rate, rules().silence_limit),
        code_(rules().telegram) {
    const std::size_t listener = segment_.attach(listener_, "listener");
    const std::size_t seat = segment_.attach(slave_, "slave@1");
    for (const auto port : {kFromUpstream, kFromBranch, kFromRemote}) {
      lines_[port] = &segment_.connect("slave@1/in", seat, port, {});
      ends_[port] = &segment_.connect("listener/in", listener, port, {});
    }
    lines_[kFromUpstream]->tap_arrived(model_);
    slave_.wire(
        {.upstream = ends_[kFromUpstream], .branch = ends_[kFromBranch], .remote = ends_[kFromRemote]},
        terminals_);
    terminals_.writes.clear();  // safe values when it is wired
  }

  void step(OctetReader& input);
  void recover();

 private:
  const Rules& rules() const { return configuration_.rules; }
  void drive(fieldproof::segment::PortIndex port, Waveform& wave);
  void send(fieldproof::segment::PortIndex port, Waveform& wave, std::uint8_t flip);
  void pass(Duration duration);
  void append_cycle(Waveform& wave, std::span<const std::uint8_t> octets, bool is_id, std::uint16_t status);
  void telegrams(OctetReader& input, Waveform& wave);
  void id_cycle(Waveform& wave, std::uint16_t control);
  void data_cycle(Waveform& wave, std::uint16_t value);
  void repaired_cycle(OctetReader& input, Waveform& wave);
  void compare();

  fieldproof::segment::Segment segment_;
  SlaveConfiguration configuration_;
  Terminals terminals_;
  Slave slave_;
  SlaveModel model_;
  fieldproof::line::TelegramCode code_;
  Listener listener_;
  std::array<fieldproof::segment::Link*, 3> lines_{};
  std::array<fieldproof::segment::Link*, 3> ends_{};
  std::size_t bits_sent_ = 0;
  std::size_t waves_sent_ = 0;
};

void World::drive(fieldproof::segment::PortIndex port, Waveform& wave) {
  if (wave.levels.empty()) return;
  wave.start = std::max(segment_.now(), lines_[port]->driven_until());
  const Time end = wave.end();
  const auto bits =
      (end - wave.start).count() / fieldproof::kernel::levels_duration(1, rules().bit_rate).count();
  bits_sent_ += static_cast<std::size_t>(bits) + 1;
  ++waves_sent_;
  lines_[port]->drive(wave);
  if (port == kFromUpstream) segment_.run_until(end);
}

void World::send(fieldproof::segment::PortIndex port, Waveform& wave, std::uint8_t flip) {
  fieldproof::fuzz::flip_level(wave.levels, flip);
  drive(port, wave);
}

void World::pass(Duration duration) {
  segment_.run_for(duration);
}

void World::append_cycle(Waveform& wave, std::span<const std::uint8_t> octets, bool is_id,
                         std::uint16_t status) {
  const std::uint16_t check = check_bit_by_bit(octets);
  for (const std::uint8_t octet : octets) code_.append(wave.levels, is_id ? kIdTransfer : kTransfer, octet);
  for (const std::uint16_t word : {check, status}) {
    code_.append(wave.levels, is_id ? kIdCheck : kCheck, static_cast<std::uint8_t>(word >> 8));
    code_.append(wave.levels, is_id ? kIdCheck : kCheck, static_cast<std::uint8_t>(word & 0xFF));
  }
}

void World::telegrams(OctetReader& input, Waveform& wave) {
  for (unsigned left = input.octet() % 16U + 1; left > 0; --left) {
    const std::uint8_t header = input.octet();
    code_.append(wave.levels, header & 7, (header & 4) != 0 ? input.octet() : std::uint8_t{0});
    wave.levels.append_idle(header >> 6);
  }
}

void World::id_cycle(Waveform& wave, std::uint16_t control) {
  const std::array<std::uint8_t, 4> octets = {0xA5, 0x5A, static_cast<std::uint8_t>(control >> 8),
                                              static_cast<std::uint8_t>(control & 0xFF)};
  append_cycle(wave, octets, true, 0);
}

void World::data_cycle(Waveform& wave, std::uint16_t value) {
  std::vector<std::uint8_t> octets = {0xA5, 0x5A};
  for (unsigned word = 0; word < configuration_.words; ++word) {
    octets.push_back(static_cast<std::uint8_t>(value >> 8));
    octets.push_back(static_cast<std::uint8_t>((value + word) & 0xFF));
  }
  append_cycle(wave, octets, false, 0);
}

// Arbitrary octets, as many as the step likes, and the check that fits them.
void World::repaired_cycle(OctetReader& input, Waveform& wave) {
  const std::uint8_t choice = input.octet();
  const auto octets = input.take(choice & 0x1F);
  if (octets.empty()) return;
  const auto status = static_cast<std::uint16_t>((choice & 0xC0) == 0xC0 ? input.word() : 0);
  append_cycle(wave, octets, (choice & 0x20) != 0, status);
}

void World::step(OctetReader& input) {
  const auto [kind, flip] = read_choice(input, 14);
  Waveform wave{segment_.now(), rules().bit_rate, {}};
  switch (kind) {
    case 0:
      id_cycle(wave, input.octet());
      return send(kFromUpstream, wave, flip);
    case 1:
      data_cycle(wave, input.word());
      return send(kFromUpstream, wave, flip);
    case 2:
      repaired_cycle(input, wave);
      return send(kFromUpstream, wave, flip);
    case 3:
      telegrams(input, wave);
      return send(kFromUpstream, wave, flip);
    case 4:
      append_levels(input, wave.levels);
      return send(kFromUpstream, wave, flip);
    case 5:
      wave.rate = read_rate(input);
      append_levels(input, wave.levels);
      return send(kFromUpstream, wave, flip);
    case 6:
      return pass((std::int64_t{input.octet()} + 1) * kMicrosecond);
    case 7:
      return pass((std::int64_t{input.octet()} % 32) * kMillisecond);
    case 8:
      slave_.set_next_present((flip & 1) != 0, (flip & 2) != 0);
      return;
    case 9:
      terminals_.has_fault = !terminals_.has_fault;
      return;
    case 10:
      telegrams(input, wave);
      return send(kFromBranch, wave, flip);
    case 11:
      telegrams(input, wave);
      return send(kFromRemote, wave, flip);
    case 12:
      append_levels(input, wave.levels);
      return send(kFromRemote, wave, flip);
    default:
      wave.rate = read_rate(input);
      append_levels(input, wave.levels);
      return send(kFromBranch, wave, flip);
  }
}

void World::compare() {
  model_.run_until(segment_.now());
  FIELDPROOF_CHECK(terminals_.writes == model_.writes(),
                   "outputs are written at the end of a good data cycle and after a silence, never else");
  FIELDPROOF_CHECK((slave_.mode() == Slave::Mode::active) == model_.is_active(),
                   "a slave is active from a good ID cycle to a silence");
  // Each telegram that is heard leaves once, retimed; one that the end of its line cuts is completed.
  FIELDPROOF_CHECK(listener_.levels <= 2 * bits_sent_ + 13 * waves_sent_,
                   "a slave sends no more than it hears");
}

// The line is idle for as long as a telegram may be cut; then one good cycle of each kind must do. Only an ID
// cycle that broke off in its transfer takes the first good one as its own end.
void World::recover() {
  compare();
  pass(100 * kMicrosecond);
  const bool is_in_transfer = slave_.phase() == Slave::Phase::id_transfer;
  for (int left = is_in_transfer ? 2 : 1; left > 0; --left) {
    Waveform wave{segment_.now(), rules().bit_rate, {}};
    id_cycle(wave, 0x000B);  // both interfaces off, messages cleared
    drive(kFromUpstream, wave);
  }
  FIELDPROOF_CHECK(slave_.mode() == Slave::Mode::active, "one good ID cycle makes a slave active");
  const std::size_t before = terminals_.writes.size();
  Waveform wave{segment_.now(), rules().bit_rate, {}};
  data_cycle(wave, kMark);
  drive(kFromUpstream, wave);
  FIELDPROOF_CHECK(terminals_.writes.size() == before + configuration_.words,
                   "one good data cycle writes every output");
  if (configuration_.words > 0) {
    FIELDPROOF_CHECK(terminals_.writes[before].value == kMark, "what is written is what was sent");
  }
  compare();
  pass(rules().silence_limit + kMillisecond);
  FIELDPROOF_CHECK(slave_.mode() == Slave::Mode::reset, "a silence resets a slave");
  compare();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return fieldproof::fuzz::play_script<World>(data, size, kMostSteps);
}
