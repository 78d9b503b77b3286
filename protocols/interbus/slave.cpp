#include "protocols/interbus/slave.hpp"

#include <algorithm>

#include "protocols/interbus/cycle_frame.hpp"

namespace fieldproof::interbus {
namespace {

constexpr unsigned kCheckOctets = 2;
constexpr unsigned kStatusOctets = 2;
constexpr std::size_t kIdOctets = 2;

std::uint8_t high(unsigned word) {
  return static_cast<std::uint8_t>(word >> 8);
}
std::uint8_t low(unsigned word) {
  return static_cast<std::uint8_t>(word & 0xFF);
}

kernel::Duration half_bits(unsigned count, std::int64_t bit_rate) {
  return kernel::levels_duration(count, 2 * bit_rate);
}

}  // namespace

std::string_view name(Slave::Mode mode) {
  return mode == Slave::Mode::reset ? "reset" : "active";
}

std::string_view name(Slave::Phase phase) {
  constexpr std::array<std::string_view, 5> kNames = {"pause", "data_transfer", "data_check", "id_transfer",
                                                      "id_check"};
  return kNames.at(static_cast<std::size_t>(phase));
}

Slave::Slave(const SlaveConfiguration& configuration)
    : Slave(configuration, line::TelegramReceiverOptions{}) {}

Slave::Slave(const SlaveConfiguration& configuration, line::TelegramReceiverOptions receiver)
    : configuration_(configuration),
      code_(line::shared_telegram_code(configuration.rules.telegram)),
      check_(line::shared_frame_check_16(configuration.rules.frame_check)),
      receivers_{line::TelegramReceiver{code_, configuration.rules.bit_rate, receiver},
                 line::TelegramReceiver{code_, configuration.rules.bit_rate, receiver},
                 line::TelegramReceiver{code_, configuration.rules.bit_rate, receiver}},
      relays_{TelegramRelay{configuration.rules.bit_rate}, TelegramRelay{configuration.rules.bit_rate},
              TelegramRelay{configuration.rules.bit_rate}},
      shift_(std::max<std::size_t>(configuration.words * 2, kIdOctets)) {
  const Rules& r = configuration_.rules;
  const unsigned forward = configuration_.is_local ? r.local_delay_half_bits : r.forward_delay_half_bits;
  const unsigned back = configuration_.is_local ? r.local_delay_half_bits : r.return_delay_half_bits;
  delays_ = {half_bits(forward, r.bit_rate), half_bits(back, r.bit_rate)};
}

void Slave::wire(const SlavePorts& ports, Terminals& terminals) {
  ports_ = ports;
  ways_[kFromUpstream].port = ports.upstream;
  ways_[kFromBranch].port = ports.branch;
  ways_[kFromRemote].port = ports.remote;
  terminals_ = &terminals;
  shifts_status_ = status_telegram_shifts();
  clear_outputs(kernel::kStart);
}

void Slave::set_next_present(bool on_branch, bool present) {
  (on_branch ? branch_present_ : remote_present_) = present;
}

void Slave::set_power(bool is_on, kernel::Time now) {
  now_ = now;
  is_supplied_ = is_on;
  for (line::TelegramReceiver& receiver : receivers_) receiver.reset();
  messages_ = 0;
  outgoing_reset_until_ = kernel::Time{kernel::Duration::min()};
  last_telegram_ = last_data_ = supervised_life_ = kNoTelegram;
  enter_reset(now);
}

// ---- the way of a telegram through the station ----

segment::PortIndex Slave::next_after(segment::PortIndex from) const {
  if (from == kFromUpstream && forward_branch_on_) return kFromBranch;
  const bool remote = from == kFromUpstream ? forward_remote_on_ : return_remote_on_;
  return from != kFromRemote && remote ? kFromRemote : kFromUpstream;
}

// The way out costs the forward delay once, the way back the return delay once, also in the station that
// closes the ring.
kernel::Duration Slave::delay_to(segment::PortIndex to, segment::PortIndex from) const {
  kernel::Duration delay{};
  if (from == kFromUpstream) delay += delays_[0];
  if (to == kFromUpstream) delay += delays_[1];
  return delay;
}

void Slave::open_way(segment::PortIndex from, kernel::Time now) {
  const segment::PortIndex to = next_after(from);
  relays_[from].open(ways_[to], delay_to(to, from), now);
}

void Slave::receive(segment::PortIndex port, const line::Waveform& reception) {
  if (!is_supplied_) return;
  now_ = reception.start;
  if (port != kFromUpstream) return relay_only(port, reception);
  open_way(kFromUpstream, now_);
  // The ends of the last telegrams are counted in levels and become times once for a whole reception.
  std::size_t status_end = 0;
  std::size_t data_end = 0;
  TelegramRelay& relay = relays_[kFromUpstream];
  // Only where levels are bits.
  const bool is_counted = reception.rate == rules().bit_rate;
  const bool is_plain = !is_deaf_ && !shifts_status_ && resynchronises();
  receivers_[kFromUpstream].receive(reception, [&](const line::Waveform& wave,
                                                   const line::Telegram& telegram) {
    if (is_plain && telegram.header == line::kDataTelegram && phase_ == Phase::data_transfer) {
      // In the middle of a transfer: most of what a slave ever does.
      const std::uint8_t out = shift_.shift(telegram.data, check_);
      relay.put(wave, telegram.level, code_.levels_of(line::kDataTelegram, out), line::kDataTelegramLevels);
    } else if (is_plain && !route_changed_ && !telegram.is_data()) {
      relay.put(wave, telegram);
    } else {
      on_upstream(wave, telegram);
    }
    if (!is_counted || &wave != &reception) return note_life(wave, telegram);
    (telegram.is_data() ? data_end : status_end) = telegram.level + telegram.levels();
  });
  relays_[kFromUpstream].close();
  if (data_end > 0) last_data_ = reception.time_of(data_end);
  if (status_end + data_end > 0) last_telegram_ = reception.time_of(std::max(status_end, data_end));
  supervise();
}

// A telegram is as long as its bits, however wide the levels of the wave are.
kernel::Time Slave::end_of(const line::Waveform& wave, const line::Telegram& telegram) const {
  return kernel::level_time(wave.time_of(telegram.level), telegram.levels(), rules().bit_rate);
}

void Slave::note_life(const line::Waveform& wave, const line::Telegram& telegram) {
  last_telegram_ = end_of(wave, telegram);
  if (telegram.is_data()) last_data_ = last_telegram_;
}

// Regenerates what comes back from after an interface.
void Slave::relay_only(segment::PortIndex from, const line::Waveform& reception) {
  const bool is_on = from == kFromBranch ? return_branch_on_ : return_remote_on_;
  if (!is_on) return;
  TelegramRelay& relay = relays_[from];
  open_way(from, now_);
  const bool counts = is_sign_of_life(from);
  if (counts) {
    receivers_[from].receive(reception, [&](const line::Waveform& wave, const line::Telegram& telegram) {
      relay.put(wave, telegram);
      note_life(wave, telegram);
    });
  } else {
    receivers_[from].receive(reception, [&relay](const line::Waveform& wave, const line::Telegram& telegram) {
      relay.put(wave, telegram);
    });
  }
  relay.close();
  if (counts) supervise();
}

void Slave::on_upstream(const line::Waveform& wave, const line::Telegram& telegram) {
  if (is_deaf_) return;
  if (route_changed_) switch_forward_ways(telegram);
  const auto header = static_cast<std::uint8_t>(telegram.header & ~line::kStopMissing);
  if (!telegram.is_data()) {
    relays_[kFromUpstream].put(wave, telegram);
    if (shifts_status_ && phase_ == Phase::data_transfer) shift_.shift(0xFF, check_);
    return;
  }
  const std::uint8_t out = on_data(wave, telegram);
  relays_[kFromUpstream].put(wave, telegram.level, code_.levels_of(header, out), line::kDataTelegramLevels);
  if (telegram.is_stop_missing() && !resynchronises()) is_deaf_ = true;
}

// The interfaces have switched at the end of an ID cycle. Its end telegrams still go the old way, what
// follows them goes the new one.
void Slave::switch_forward_ways(const line::Telegram& telegram) {
  if (!goes_new_way(telegram)) return;
  route_changed_ = false;
  forward_branch_on_ = branch_on_;
  forward_remote_on_ = remote_on_;
  relays_[kFromUpstream].close();
  open_way(kFromUpstream, now_);
}

// ---- the cycle ----

std::uint8_t Slave::on_data(const line::Waveform& wave, const line::Telegram& telegram) {
  const bool id_cycle = (telegram.header & line::kSelect) != 0;
  const bool check = (telegram.header & line::kControl) != 0;
  return check ? on_check(id_cycle, wave, telegram) : on_transfer(id_cycle, wave, telegram);
}

std::uint8_t Slave::on_transfer(bool id_cycle, const line::Waveform& wave, const line::Telegram& telegram) {
  if (phase_ != (id_cycle ? Phase::id_transfer : Phase::data_transfer)) {
    const kernel::Time when = wave.time_of(telegram.level);
    // A transfer that breaks into a cycle abandons it; the new one begins here, and with it a new error.
    if (phase_ != Phase::pause) abandon_cycle(when);
    enter_transfer(id_cycle, when);
  }
  if (lacks_stop(telegram)) own_error_ = true;
  const std::uint8_t out = shift_.shift(telegram.data, check_);
  if (id_cycle) on_control_octet(wave.time_of(telegram.level));
  return out;
}

void Slave::enter_transfer(bool id_cycle, kernel::Time when) {
  switch_return_ways();
  own_error_ = false;
  upstream_clean_ = true;
  check_octets_seen_ = 0;
  const auto preset = check_preset();
  if (id_cycle) {
    phase_ = Phase::id_transfer;
    const std::uint16_t id = id_register(when);
    messages_read_ = messages_;
    const auto octets = shift_.load(kIdOctets, preset);
    octets[0] = high(id);
    octets[1] = low(id);
  } else {
    phase_ = Phase::data_transfer;
    sample_inputs(when, shift_.load(configuration_.words * 2U, preset));
  }
}

std::uint8_t Slave::on_check(bool id_cycle, const line::Waveform& wave, const line::Telegram& telegram) {
  if (phase_ == (id_cycle ? Phase::id_transfer : Phase::data_transfer)) {
    enter_check(wave.time_of(telegram.level));
  } else if (phase_ != (id_cycle ? Phase::id_check : Phase::data_check)) {
    // Check telegrams without their transfer phase are passed on as they are; in the pause they are the end
    // telegrams after a cycle.
    if (phase_ != Phase::pause) abandon_cycle(wave.time_of(telegram.level));
    on_stray_check();
    return telegram.data;
  }
  const unsigned n = check_octets_seen_++;
  if (n < kCheckOctets) {
    if (!check_octet_fits(n, telegram.data, check_expected_.at(n)) || lacks_stop(telegram)) own_error_ = true;
    return check_sent_.at(n);
  }
  const auto mark = n == kCheckOctets ? high(rules().status_marked) : low(rules().status_marked);
  const auto clean = n == kCheckOctets ? high(rules().status_clean) : low(rules().status_clean);
  if (telegram.data != clean) upstream_clean_ = false;
  // The octet leaves before the stop level has come.
  const std::uint8_t out = status_octet_to_send(telegram.data, mark, own_error_);
  if (lacks_stop(telegram)) own_error_ = true;
  if (n + 1 == kCheckOctets + kStatusOctets) finish_cycle(end_of(wave, telegram));
  return out;
}

void Slave::enter_check(kernel::Time when) {
  if (phase_ == Phase::data_transfer) on_transfer_end(when);
  phase_ = phase_ == Phase::data_transfer ? Phase::data_check : Phase::id_check;
  if (!shift_.has_shifted(least_octets(shift_.held().size()))) own_error_ = true;
  const auto received = shift_.received_check(check_);
  check_expected_ = check_.check_octets(received);
  check_sent_ = check_.check_octets(check_to_send(received, shift_.sent_check(check_)));
}

void Slave::finish_cycle(kernel::Time end) {
  const bool good = accepts_cycle(!own_error_, upstream_clean_);
  if (phase_ == Phase::data_check) {
    finish_data_cycle(good, end);
  } else {
    finish_id_cycle(good, end);
  }
  on_cycle_end(end);
  phase_ = Phase::pause;
}

void Slave::finish_data_cycle(bool good, kernel::Time end) {
  if (!good) return on_cycle_rejected(end, own_error_);
  // Until an ID cycle has told the master what is here, outputs stay safe.
  if (may_drive_outputs(mode_)) latch_outputs(end);
}

void Slave::finish_id_cycle(bool good, kernel::Time end) {
  if (!good) return on_cycle_rejected(end, own_error_);
  mode_ = Mode::active;
  on_id_read(messages_read_);
  const auto held = shift_.held();
  apply_control(control_word(static_cast<std::uint16_t>(held[0] << 8 | held[1])), end);
}

void Slave::abandon_cycle(kernel::Time when) {
  own_error_ = true;
  phase_ = Phase::pause;
  on_cycle_rejected(when, true);
}

// ---- time ----

void Slave::supervise() {
  const kernel::Time life = sign_of_life(last_telegram_, last_data_);
  // What brings no new sign of life must not wake a supervision that has run out.
  if (life == supervised_life_) return;
  supervised_life_ = life;
  silence_end_ = life + rules().silence_limit;
}

void Slave::on_time(kernel::Time now) {
  now_ = now;
  flush_receivers(now);
  if (silence_end_ <= now && !is_silence_ending()) enter_reset(now);
}

// A telegram that has begun before the limit is no silence any more, in however many parts it comes.
bool Slave::is_silence_ending() const {
  return receivers_[kFromUpstream].pending_from() < silence_end_;
}

kernel::Time Slave::next_time() const {
  const kernel::Time pending = receivers_[kFromUpstream].pending_until();
  return std::min({is_silence_ending() ? pending : std::min(pending, silence_end_),
                   receivers_[kFromBranch].pending_until(), receivers_[kFromRemote].pending_until()});
}

void Slave::flush_receivers(kernel::Time now) {
  for (const segment::PortIndex from : {kFromUpstream, kFromBranch, kFromRemote}) {
    line::TelegramReceiver& receiver = receivers_[from];
    if (receiver.pending_until() > now) continue;
    open_way(from, now);
    receiver.flush([&](const line::Waveform& wave, const line::Telegram& telegram) {
      if (from == kFromUpstream) {
        on_upstream(wave, telegram);
        note_life(wave, telegram);
      } else {
        relays_[from].put(wave, telegram);
      }
    });
    relays_[from].close();
    if (from == kFromUpstream) supervise();
  }
}

// What an ID cycle has switched holds for what comes back from the next cycle on: the end of that ID cycle is
// still on its way through the branch when its last telegram has passed here.
void Slave::switch_return_ways() {
  return_branch_on_ = branch_on_;
  return_remote_on_ = remote_on_;
}

void Slave::enter_reset(kernel::Time now) {
  silence_end_ = kernel::kNever;
  mode_ = Mode::reset;
  phase_ = Phase::pause;
  if (reset_switches_off()) {
    branch_on_ = remote_on_ = false;
    forward_branch_on_ = forward_remote_on_ = route_changed_ = false;
    switch_return_ways();
  }
  is_deaf_ = false;
  on_reset(now);
}

// ---- decisions ----

kernel::Time Slave::sign_of_life(kernel::Time last_telegram, kernel::Time) const {
  return last_telegram;
}

line::FrameCheck16::State Slave::check_to_send(line::FrameCheck16::State,
                                               line::FrameCheck16::State sent) const {
  return sent;
}

std::uint8_t Slave::status_octet_to_send(std::uint8_t received, std::uint8_t mark, bool own_error) const {
  return own_error ? received | mark : received;
}

std::size_t Slave::least_octets(std::size_t register_octets) const {
  return register_octets + kLoopbackOctets;
}

bool Slave::check_octet_fits(unsigned, std::uint8_t received, std::uint8_t expected) const {
  return received == expected;
}

bool Slave::accepts_cycle(bool own_check_good, bool upstream_clean) const {
  return own_check_good && upstream_clean;
}

void Slave::sample_inputs(kernel::Time when, std::span<std::uint8_t> octets) {
  for (unsigned word = 0; word < octets.size() / 2; ++word) {
    const std::uint16_t value = terminals().input(word, when);
    octets[2 * word] = high(value);
    octets[2 * word + 1] = low(value);
  }
}

std::uint16_t Slave::word_of(std::uint8_t first, std::uint8_t second) const {
  return static_cast<std::uint16_t>(first << 8 | second);
}

std::uint16_t Slave::id_register(kernel::Time when) {
  const Rules& r = rules();
  // A peripheral fault shows as long as it lasts, a pressed button as long as it is pressed.
  messages_ &= static_cast<std::uint16_t>(~(r.message_peripheral_fault | r.message_reconfiguration));
  if (terminals().has_peripheral_fault(when)) messages_ |= r.message_peripheral_fault;
  if (terminals().wants_reconfiguration(when)) messages_ |= r.message_reconfiguration;
  return configuration_.id_code | messages_;
}

void Slave::on_cycle_rejected(kernel::Time, bool own_error) {
  if (own_error) set_messages(rules().message_check_error);
}

void Slave::on_reset(kernel::Time now) {
  clear_outputs(now);
}

std::uint16_t Slave::heeded_control_bits() const {
  const Rules& r = rules();
  return r.control_remote_off | r.control_local_off | r.control_reset | r.control_acknowledge;
}

// ---- what the decisions act with ----

void Slave::latch_outputs(kernel::Time when) {
  const auto held = shift_.held();
  for (unsigned word = 0; word < held.size() / 2; ++word) {
    terminals().output(word, word_of(held[2 * word], held[2 * word + 1]), when);
  }
}

void Slave::clear_outputs(kernel::Time when) {
  for (unsigned word = 0; word < configuration_.words; ++word) terminals().output(word, 0, when);
}

void Slave::apply_control(std::uint16_t control, kernel::Time when) {
  const Rules& r = rules();
  control &= heeded_control_bits();
  if ((control & r.control_acknowledge) != 0) messages_ = 0;
  if ((control & r.control_reset) != 0) {
    // Long enough that everything after this station has reset itself.
    outgoing_reset_until_ = when + r.silence_limit + r.silence_tolerance;
  }
  const bool may_switch_on = when >= outgoing_reset_until_;
  const bool branch = may_switch_on && configuration_.has_branch && branch_present_ &&
                      (control & r.control_local_off) == 0 && ports_.branch != nullptr;
  const bool remote =
      may_switch_on && remote_present_ && (control & r.control_remote_off) == 0 && ports_.remote != nullptr;
  route_changed_ = branch != branch_on_ || remote != remote_on_;
  branch_on_ = branch;
  remote_on_ = remote;
}

}  // namespace fieldproof::interbus
