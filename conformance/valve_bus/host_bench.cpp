#include "conformance/valve_bus/host_bench.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "conformance/decoded_lines.hpp"
#include "harness/iut/misbehaviour.hpp"
#include "protocols/valve_bus/host.hpp"

namespace fieldproof::conformance {
namespace {

using valve_bus::HostConfiguration;

constexpr kernel::Duration kHostWarmUp = 20 * kernel::kMillisecond;
constexpr std::size_t kHistoryLines = 24;
constexpr std::string_view kNodeDrove = "node drove";

std::unique_ptr<valve_bus::HostDevice> host_made(const HostSetting& setting,
                                                 const HostConfiguration& configuration) {
  if (setting.make_device) return setting.make_device(configuration);
  return std::make_unique<valve_bus::Host>(configuration);
}

std::string frame_text(const HostFrame& frame, const valve_bus::Rules& rules) {
  return fmt::format("host, driver on {} to {}: {}", kernel::describe(frame.sent.driver_on),
                     kernel::describe(frame.sent.driver_off), characters_text(frame.sent, rules));
}

// Of a character at the highest rate of the switches, and of a command at the lowest, with a delimiter on
// either side.
LineWatch watch_of(const HostNeeds& needs, const judge::Pics& pics) {
  valve_bus::Rules rules = host_configuration(needs, pics).rules;
  const kernel::Duration shortest =
      kernel::levels_duration(character_format(rules).half_bits() / 2, valve_bus::dip_bit_rates().front());
  rules.bit_rate = std::ranges::min(valve_bus::dip_bit_rates());
  const kernel::Duration command =
      valve_bus::kCommandOctets * (character_time(rules) + longest_gap(rules)) +
      valve_bus::bits(rules, std::int64_t{rules.driver_on_bits} + rules.driver_off_bits);
  return LineWatch(shortest, command + 2 * delimiter(rules));
}

}  // namespace

HostConfiguration host_configuration(const HostNeeds& needs, const judge::Pics& pics) {
  HostConfiguration configuration = host_declared_in(pics).configuration;
  configuration.dip = needs.dip.value_or(configuration.dip);
  configuration.receives_own_echo = needs.receives_own_echo.value_or(configuration.receives_own_echo);
  configuration.verifies_writes = needs.verifies_writes.value_or(configuration.verifies_writes);
  valve_bus::Rules& rules = configuration.rules;
  rules.characters = needs.characters.value_or(rules.characters);
  rules.answers_writes = needs.acknowledged_writes.value_or(rules.answers_writes);
  return configuration;
}

valve_bus::Command HostFrame::command() const {
  const std::vector<std::uint8_t> octets = sent.octets();
  return valve_bus::command_of(octets);
}

std::string text_of_error(const valve_bus::HostError& error) {
  return fmt::format("error {} of ID {:02X}: {}", static_cast<unsigned>(error.kind), error.id,
                     describe(error.kind));
}

std::string text_of(const HostEvent& told) {
  const std::string when = kernel::describe(told.when);
  if (const auto* error = std::get_if<valve_bus::HostError>(&told.what)) {
    return fmt::format("{}, at {}", text_of_error(*error), when);
  }
  const auto& response = std::get<valve_bus::HostResponse>(told.what);
  return fmt::format("response of {:02X}: {:02X} {:02X}{}, at {}", response.id, response.data0,
                     response.data1, response.is_old ? ", old" : "", when);
}

HostBench::HostBench(const HostNeeds& needs, const HostSetting& setting)
    : HostBench(needs, setting, setting.pics.value_or(judge::Pics{}).completed_by(declared_host())) {}

HostBench::HostBench(const HostNeeds& needs, const HostSetting& setting, judge::Pics pics)
    : LineBench(setting.seed, setting.volume, setting.stresses, watch_of(needs, pics)),
      pics_(std::move(pics)),
      configuration_(host_configuration(needs, pics_)),
      codec_(rules()),
      host_(host_made(setting, configuration_)),
      driven_(character_format(rules()), rules().bit_rate),
      arrived_(rules()),
      writes_(256) {
  // On a real line the echo is the box's own.
  attach_iut(*host_, "host", {}, configuration_.receives_own_echo && !capabilities().is_wall_clock);
  adopt_rate(configuration_.dip);
  expect_reachable();
  start_recording(setting, rules());
  if (host_->capabilities().senses_activity) place().sense_activity();
  place().tap_driven(driven_);
  place().tap_arrived(arrived_);
  watch(place());
  install(setting.plan, rules().bit_rate);
  host_->wire(place(), *this);
  set_power(true);
  wait(kHostWarmUp);
  clear_observations();
}

// A tester on a serial line answers after what it has read: some ten characters later than it would.
void HostBench::expect_reachable() const {
  if (!capabilities().process_side)
    throw iut::CannotBeDone(
        "nothing can be ordered of the host without an upper channel: its PC is not on the line");
  if (capabilities().is_wall_clock && characters(10) + kernel::kMillisecond > rules().response_wait) {
    throw iut::CannotBeDone(fmt::format(
        "at {} bit/s an answer over a serial line begins later than the host waits", rules().bit_rate));
  }
}

void HostBench::expect_exact_instants() const {
  if (capabilities().is_wall_clock)
    throw iut::CannotBeDone(
        "at a serial line the instants of a host and of its nodes are not known so exactly");
}

void HostBench::adopt_rate(unsigned dip) {
  const auto rates = valve_bus::dip_bit_rates();
  configuration_.rules.bit_rate = rates[dip % rates.size()];
  codec_ = valve_bus::CharacterCodec(rules());
  driven_.listen(character_format(rules()), rules().bit_rate);
  arrived_ = ArrivedFrames(rules());
  observation_timeout_ = 4 * (time_out() + characters(16)) + 10 * kernel::kMillisecond;
}

std::uint8_t HostBench::random_id() {
  return static_cast<std::uint8_t>(random().between(rules().first_address, rules().last_address));
}

kernel::Duration HostBench::characters(double count) const {
  const auto one = static_cast<double>(character_time(rules()).count());
  return kernel::Duration{std::llround(count * one)};
}

// ---- upper tester ----

void HostBench::set_power(bool is_on) {
  host_->set_power(is_on, now());
  if (now() > kernel::kStart) note(Deed{now(), supply_text(is_on)});
  refresh_iut();
}

void HostBench::restart(unsigned dip) {
  set_power(false);
  wait(observation_timeout_);
  host_->set_dip(dip);
  set_power(true);
  adopt_rate(dip);
  wait(kHostWarmUp);
  writes_.assign(writes_.size(), std::nullopt);
  clear_observations();
}

void HostBench::write(std::span<const std::uint8_t> octets) {
  note(Deed{now(), "PC ordered", {octets.begin(), octets.end()}});
  host_->write(octets, now());
  refresh_iut();
}

void HostBench::write_later(std::span<const std::uint8_t> octets, kernel::Duration later) {
  written_later_.assign(octets.begin(), octets.end());
  written_later_at_ = now() + later;
  refresh_tester();
}

void HostBench::on_time(kernel::Time) {
  written_later_at_ = kernel::kNever;
  write(written_later_);
}

void HostBench::order(const valve_bus::Command& command) {
  write({command.id, command.command, command.data0, command.data1});
}

std::optional<HostEvent> HostBench::next_told(kernel::Duration within) {
  const kernel::Time limit = now() + within;
  while (told_.empty() && segment().scheduler().next() <= limit) segment().step();
  if (told_.empty()) {
    segment().run_until(limit);
    return std::nullopt;
  }
  const HostEvent first = told_.front();
  told_.pop_front();
  return first;
}

void HostBench::await(kernel::Duration within) {
  const kernel::Time limit = now() + within;
  while (told_.empty() && frames_.empty() && driven_.empty() && segment().scheduler().next() <= limit) {
    segment().step();
  }
}

void HostBench::on_response(const valve_bus::HostResponse& response, kernel::Time when) {
  told_.push_back({when, response});
  note(told_.back());
}

void HostBench::on_error(const valve_bus::HostError& error, kernel::Time when) {
  told_.push_back({when, error});
  note(told_.back());
}

// ---- lower tester ----

bool HostBench::has_driven_by(kernel::Time limit) {
  const std::size_t before = driven_.waves();
  while (driven_.waves() == before && segment().scheduler().next() <= limit) segment().step();
  return driven_.waves() > before;
}

// Until the frame that has begun is over: with its last octet, or with a silence that no frame has in it.
void HostBench::collect() {
  std::vector<Transmission> seen = driven_.transmissions();
  while (seen.back().characters.size() < valve_bus::kCommandOctets &&
         has_driven_by(seen.back().driver_off + longest_gap(rules()))) {
    seen = driven_.transmissions();
  }
  while (is_followed_by_a_tail(seen.back())) seen = driven_.transmissions();
  last_waves_ = driven_.take();
  frames_.insert(frames_.end(), seen.begin(), seen.end());
}

// Who says when its driver goes off as it goes off drives what is behind the last stop bit in pieces.
bool HostBench::is_followed_by_a_tail(const Transmission& sent) {
  if (sent.characters.size() < valve_bus::kCommandOctets) return false;
  const kernel::Time longest = sent.characters.back().busy_until + bits(rules().driver_off_bits + 1);
  return sent.driver_off < longest && has_driven_by(sent.driver_off + driven_.pause());
}

std::optional<HostFrame> HostBench::next_frame(kernel::Duration within) {
  const kernel::Time limit = now() + within;
  if (frames_.empty()) {
    if (driven_.empty() && !has_driven_by(limit)) {
      segment().run_until(limit);
      return std::nullopt;
    }
    collect();
  }
  HostFrame frame = frame_of(std::move(frames_.front()));
  frames_.pop_front();
  segment().run_until(std::max(now(), frame.end));
  note(frame);
  last_end_ = frame.end;
  return frame;
}

HostFrame HostBench::frame_of(Transmission sent) {
  HostFrame frame{std::move(sent), {}, {}, kernel::Duration::max()};
  const auto& all = frame.sent.characters;
  frame.start = all.empty() ? frame.sent.driver_on : all.front().start;
  frame.end = all.empty() ? frame.sent.driver_off : all.back().busy_until;
  frame.silence = frame.start - last_end_;
  // Who receives characters knows of one when it is over.
  const kernel::Time known = frame.sent.driver_on - characters(1);
  for (const Span& span : said_) {
    if (span.start <= known) frame.silence = std::min(frame.silence, frame.start - span.end);
  }
  std::erase_if(said_, [&](const Span& span) { return span.end < frame.start; });
  return frame;
}

kernel::Duration HostBench::late_turnaround_time() {
  const kernel::Time rest_ends = last_end_ + time_out() + time_out_tolerance();
  if (now() < rest_ends) await(rest_ends - now());
  const kernel::Time soon = was_told() ? now() + time_out() / 100 : rest_ends;
  return std::max(time_out(), std::min(soon, rest_ends) - last_end_);
}

kernel::Time HostBench::answer(std::span<const std::uint8_t> octets, kernel::Duration turnaround_time) {
  const kernel::Time start = std::max(now(), last_end_ + turnaround_time);
  const kernel::Time end = codec_.drive(tester(), octets, start, {});
  note(Deed{start, kNodeDrove, {octets.begin(), octets.end()}});
  said_.push_back({start, end});
  return end;
}

void HostBench::answer_levels(const line::Levels& levels, kernel::Duration turnaround_time) {
  line::Waveform wave;
  wave.start = std::max(now(), last_end_ + turnaround_time);
  wave.rate = rules().bit_rate;
  wave.levels = levels;
  said_.push_back({wave.start, wave.end()});
  note(Deed{wave.start, kNodeDrove, {}, levels.size()});
  tester().drive(wave);
}

kernel::Time HostBench::say(std::span<const std::uint8_t> octets) {
  const kernel::Time end = codec_.drive(tester(), octets, now(), {});
  said_.push_back({now(), end});
  note(Deed{now(), kNodeDrove, {octets.begin(), octets.end()}});
  segment().run_until(end);
  return end;
}

line::Levels HostBench::levels_of(std::uint8_t octet, valve_bus::CharacterProfile profile) const {
  valve_bus::Rules other = rules();
  other.characters = profile;
  line::Levels levels;
  valve_bus::CharacterCodec(other).append(levels, std::span(&octet, 1));
  return levels;
}

void HostBench::note_write(const valve_bus::Command& command) {
  if (command.command == rules().write_command) writes_.at(command.id) = command;
}

bool HostBench::is_refresh(const valve_bus::Command& command) const {
  return writes_.at(command.id) == command;
}

void HostBench::clear_observations() {
  frames_.clear();
  told_.clear();
  driven_.clear();
  arrived_.clear();
}

void HostBench::note(Seen seen) {
  if (history_.size() == kHistoryLines) history_.pop_front();
  history_.push_back(std::move(seen));
}

std::vector<std::string> HostBench::decode_lines() const {
  std::vector<Seen> all(history_.begin(), history_.end());
  std::ranges::stable_sort(all, {}, &HostBench::time_of);
  std::vector<std::string> lines;
  for (const Seen& seen : all) lines.push_back(line_of(seen));
  return lines;
}

kernel::Time HostBench::time_of(const Seen& seen) {
  if (const auto* frame = std::get_if<HostFrame>(&seen)) return frame->start;
  if (const auto* event = std::get_if<HostEvent>(&seen)) return event->when;
  return std::get<Deed>(seen).when;
}

std::string HostBench::line_of(const Seen& seen) const {
  if (const auto* frame = std::get_if<HostFrame>(&seen)) return frame_text(*frame, rules());
  if (const auto* event = std::get_if<HostEvent>(&seen)) return "PC was told: " + text_of(*event);
  constexpr std::size_t kMostOctets = 12;
  const Deed& deed = std::get<Deed>(seen);
  if (deed.octets.empty() && deed.levels == 0)
    return fmt::format("{} at {}", deed.what, kernel::describe(deed.when));
  const auto first = std::span(deed.octets).first(std::min(deed.octets.size(), kMostOctets));
  const char* more = first.size() < deed.octets.size() ? " ..." : "";
  // What the PC writes is no frame of the bus.
  const std::string octets = deed.what == kNodeDrove ? octets_in_words(first, rules())
                                                     : fmt::format("{:02X}", fmt::join(first, " "));
  const std::string what = deed.levels > 0 ? fmt::format("{} levels", deed.levels) : octets + more;
  return fmt::format("{} {}, at {}", deed.what, what, kernel::describe(deed.when));
}

}  // namespace fieldproof::conformance
