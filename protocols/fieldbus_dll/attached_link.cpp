#include "protocols/fieldbus_dll/attached_link.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "harness/iut/misbehaviour.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::fieldbus_dll {
namespace {

constexpr std::size_t kMostFrameOctets = 300;  // of IEC 61158-2, with its check

}  // namespace

void put_number(Octets& octets, std::uint64_t number, unsigned size) {
  while (size-- > 0) octets.push_back(static_cast<std::uint8_t>(number >> 8 * size));
}

std::uint64_t number_at(std::span<const std::uint8_t> octets, std::size_t at, unsigned size) {
  std::uint64_t number = 0;
  for (const std::uint8_t octet : octets.subspan(at, size)) number = number << 8 | octet;
  return number;
}

AttachedLink::AttachedLink(iut::AttachedCase& attached, const LinkRules& rules)
    : attached_(attached), rules_(rules) {
  if (attached.unit_kind() != iut::UnitKind::characters) return;
  throw kernel::Error(
      kernel::ErrorKind::implementation,
      "a station of the data link receives and sends levels or telegrams; this implementation "
      "announces characters");
}

// ---- what it is told ----

void AttachedLink::receive(const line::Waveform& reception) {
  if (hears_frames()) {
    tell_frame(reception);
  } else {
    attached_.call(reception.end(), [&](iut::Device& device) { device.receive(kLinePort, reception); });
  }
}

line::Waveform AttachedLink::wave_of(std::span<const std::uint8_t> octets, kernel::Time start) const {
  line::Waveform wave{start, 2 * rules_.bit_rate, {}};
  code_.append(wave.levels, octets, rules_.preamble_octets);
  return wave;
}

void AttachedLink::tell_frame(const line::Waveform& reception) {
  const auto frames = line::delimited_frames_in(reception, rules_.bit_rate);
  const bool is_one = frames.size() == 1 && frames[0].end == line::FrameEnd::whole &&
                      wave_of(frames[0].octets, reception.start).levels == reception.levels;
  if (!is_one)
    throw iut::CannotBeDone("an implementation that receives telegrams receives whole frames only");
  const unsigned before = rules_.preamble_octets + 1;
  std::vector<iut::Character> characters;
  for (const std::uint8_t octet : frames[0].octets) {
    const auto place = static_cast<std::int64_t>(before + characters.size());
    characters.push_back(
        {reception.start + octets(rules_, place), reception.start + octets(rules_, place + 1), octet});
  }
  attached_.call(reception.end(),
                 [&](iut::Device& device) { device.receive(kLinePort, characters, reception.end()); });
}

void AttachedLink::on_activity(bool begins, kernel::Time now) {
  const iut::Character one{now, now, static_cast<std::uint16_t>(begins ? 1 : 0)};
  attached_.call(now, [&](iut::Device& device) { device.receive(kActivityPort, std::span(&one, 1), now); });
}

bool AttachedLink::ask(const Octets& request, kernel::Time now) {
  std::vector<iut::Character> characters;
  for (const std::uint8_t octet : request) characters.push_back({now, now, octet});
  return is_taken(
      [&] { attached_.call(now, [&](iut::Device& device) { device.receive(kUserPort, characters, now); }); });
}

bool AttachedLink::start(kernel::Time now) {
  return is_taken([&] { attached_.set_power(true, now); });
}

void AttachedLink::stop(kernel::Time now) {
  ahead_.clear();
  attached_.set_power(false, now);
}

void AttachedLink::refuse() {
  if (!is_asking_) iut::refuse_impossible("refuses something, and nothing is asked of it");
  is_refused_ = true;
}

void AttachedLink::on_time(kernel::Time now) {
  drive_due(now);
  if (attached_.next_time() <= now) attached_.on_time(now);
}

kernel::Time AttachedLink::next_time() const {
  const kernel::Time wanted = attached_.next_time();
  return ahead_.empty() ? wanted : std::min(wanted, ahead_.front().start);
}

// ---- what it does ----

void AttachedLink::send(unsigned port, kernel::Time start, std::span<const std::uint16_t> characters) {
  attached_.expect_supplied();
  if (port != kLinePort) iut::refuse_impossible(fmt::format("drives port {}; the line is port 0", port));
  if (!hears_frames()) iut::refuse_impossible("drives telegrams, having announced levels");
  const std::size_t count = characters.size();
  if (count == 0 || count > kMostFrameOctets) {
    iut::refuse_impossible(
        fmt::format("drives a frame of {} octets; there are 1 to {}", count, kMostFrameOctets));
  }
  Octets octets;
  for (const std::uint16_t one : characters) {
    if (one > 0xFF) iut::refuse_impossible(fmt::format("drives {} as an octet", one));
    octets.push_back(static_cast<std::uint8_t>(one));
  }
  // No sum of an instant that lies further than time reaches.
  attached_.expect_ahead(start, "drives a frame");
  drive(wave_of(octets, start));
}

void AttachedLink::transmit(unsigned port, line::Waveform& wave) {
  attached_.expect_supplied();
  if (port != kLinePort) iut::refuse_impossible(fmt::format("drives port {}; the line is port 0", port));
  drive(std::exchange(wave, {}));
}

void AttachedLink::drive(line::Waveform&& wave) {
  attached_.expect_drive(wave);
  if (wave.start < driven_until_) {
    iut::refuse_impossible(fmt::format("drives from {} on, and drives already until {}",
                                       kernel::describe(wave.start), kernel::describe(driven_until_)));
  }
  driven_until_ = wave.end();
  ahead_.push_back(std::move(wave));
  drive_due(attached_.now());
}

void AttachedLink::drive_due(kernel::Time now) {
  while (!ahead_.empty() && ahead_.front().start <= now) {
    line::Waveform wave = std::move(ahead_.front());
    ahead_.pop_front();
    line_->drive(wave);
  }
}

Octets AttachedLink::told_octets(std::span<const std::uint16_t> characters) {
  Octets octets;
  for (const std::uint16_t one : characters) {
    if (one > 0xFF || octets.size() >= kMostFrameOctets)
      iut::refuse_impossible("reports no octets to its user");
    octets.push_back(static_cast<std::uint8_t>(one));
  }
  return octets;
}

}  // namespace fieldproof::fieldbus_dll
