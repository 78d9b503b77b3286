#include "conformance/token_bus/station_bench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "conformance/user_reports.hpp"
#include "harness/line/frame_check.hpp"
#include "protocols/token_bus/station_settings.hpp"

namespace fieldproof::conformance {
namespace {

void append_address(Octets& octets, std::uint64_t address, unsigned size) {
  for (unsigned n = 0; n < size; ++n) octets.push_back(static_cast<std::uint8_t>(address >> 8 * n));
}

// A transmission may have several frames, and each at most so many octets.
LineWatch line_watch_of(const token_bus::Rules& rules) {
  return LineWatch(token_bus::octets(rules, 1),
                   token_bus::octets(rules, 2 * std::int64_t{rules.most_octets}));
}

}  // namespace

token_bus::StationConfiguration token_configuration(const TokenNeeds& needs, std::uint64_t seed,
                                                    const field::Settings& settings) {
  token_bus::StationConfiguration configuration;
  kernel::Random random = kernel::Random(seed).split("settings");
  if (needs.adjust) needs.adjust(configuration, random);
  field::take_settings(token_bus::kStationTable, settings, configuration);
  return configuration;
}

bool is_reported_as(const DrivenFrame& sent, const token_bus::Frame& frame) {
  // MMM, its highest bit first.
  const auto action = static_cast<unsigned>(line::reflect(sent.control() >> 2U & 7U, 3));
  return sent.is_data() && frame.kind == token_bus::FrameKind::data &&
         static_cast<unsigned>(frame.action) == action && frame.priority == sent.priority() &&
         frame.destination == sent.destination() && frame.source == sent.source() &&
         frame.data == sent.data();
}

bool TokenUser::has_event(token_bus::EventKind kind, std::uint64_t about) const {
  return std::ranges::any_of(
      events, [&](const token_bus::Event& one) { return one.kind == kind && one.address == about; });
}

std::string TokenBench::user_text() const {
  const std::string events = reports_text(user_.all_events, [&](const TokenUser::Reported& one) {
    return fmt::format("{} about {}", token_bus::text_of(one.event.kind),
                       token_bus::text_of(one.event.address, rules()));
  });
  const std::string data = reports_text(
      user_.frames, [&](const token_bus::Frame& one) { return token_bus::describe(one, rules()); });
  return fmt::format("reported: {}; delivered: {}", events, data);
}

TokenBench::TokenBench(const token_bus::StationConfiguration& configuration, bool is_powered,
                       const TokenSetting& setting)
    : LineBench(setting.seed, setting.volume, setting.stresses, line_watch_of(configuration.rules)),
      configuration_(configuration),
      driven_(rules().phy_bit_rate, token_bus::address_octets(rules())),
      sent_(rules().phy_bit_rate, token_bus::address_octets(rules())),
      station_(setting.make_device(configuration_)) {
  start_recording(setting, rules());
  attach_iut(*station_, "station");
  place().sense_activity();
  place().tap_driven(driven_);
  tester().tap_driven(sent_);
  watch(place());
  install(setting.plan, rules().phy_bit_rate);
  station_->wire(place(), user_);
  if (is_powered) set_power(true);
}

void TokenBench::set_power(bool is_on) {
  if (is_on) {
    station_->start(now());
  } else {
    station_->stop(now());
  }
  if (is_on != is_powered_) supply_.add_supply(now(), is_on);
  is_powered_ = is_on;
  refresh_iut();
}

bool TokenBench::submit(const token_bus::DataRequest& request) {
  const bool is_taken = station_->submit(request, now());
  refresh_iut();
  return is_taken;
}

void TokenBench::set_in_ring_desired(bool is_desired) {
  may_leave_ |= !is_desired;
  station_->set_in_ring_desired(is_desired, now());
  refresh_iut();
}

void TokenBench::set_response(const Octets& data) {
  station_->set_response(data, now());
  refresh_iut();
}

Octets TokenBench::numbered_data(std::size_t size) {
  ++number_;
  Octets data{static_cast<std::uint8_t>(number_ >> 8), static_cast<std::uint8_t>(number_ & 0xFF)};
  while (data.size() < size) data.push_back(random_octet());
  data.resize(size);
  return data;
}

Octets TokenBench::frame(TokenControl control, std::uint64_t destination, std::uint64_t source,
                         std::optional<std::uint64_t> data) const {
  const unsigned size = token_bus::address_octets(rules());
  Octets octets{static_cast<std::uint8_t>(control)};
  append_address(octets, destination, size);
  append_address(octets, source, size);
  if (data) append_address(octets, *data, size);
  return octets;
}

Octets TokenBench::data_frame(std::uint8_t control, std::uint64_t destination, std::uint64_t source,
                              const Octets& data) const {
  Octets octets = frame(TokenControl{control}, destination, source);
  octets.insert(octets.end(), data.begin(), data.end());
  return octets;
}

kernel::Time TokenBench::send(const Octets& octets, const FrameForm& form) {
  return send_half_bits(half_bits_around(with_crc_32(octets), form));
}

kernel::Time TokenBench::send_half_bits(line::Levels half_bits) {
  line::Waveform wave{now(), 2 * rules().phy_bit_rate, std::move(half_bits)};
  return drive_to_end(wave);
}

kernel::Time TokenBench::send_noise(std::size_t octet_times) {
  constexpr std::uint64_t kZero = 0b1001;
  line::Levels levels;
  for (std::size_t n = 0; n < 8 * octet_times; ++n) levels.append(kZero, 4);
  return send_half_bits(std::move(levels));
}

void TokenBench::run_until(kernel::Time time) {
  if (time > now()) segment().run_until(time);
}

std::optional<DrivenFrame> TokenBench::next(kernel::Time limit) {
  // In steps of an octet: the ear knows at once what the IUT begins, and no frame is as short.
  run_in_steps(limit, octets(1), [&] { return driven_.has_new(limit); });
  if (!driven_.has_new(limit)) return std::nullopt;
  const DrivenFrame one = driven_.take_one();
  run_until(one.end);
  return one;
}

std::vector<std::string> TokenBench::decode_lines(kernel::Time time) {
  DecodedLines lines;
  const auto add = [&](std::string_view who, std::span<const DrivenFrame> frames) {
    for (const DrivenFrame& one : frames) {
      lines.add(one.begin, fmt::format("{} {} to {}: {}", who, kernel::describe(one.begin),
                                       kernel::describe(one.end), one.text()));
    }
  };
  add("tester drove", sent());
  add("station drove", driven());
  lines.add(supply_);
  return lines.around(time);
}

void TokenBench::ask() {
  set_power(true);
  set_in_ring_desired(true);
  next(now() + slots(2 * std::int64_t{rules().bus_idle_slots}));
}

}  // namespace fieldproof::conformance
