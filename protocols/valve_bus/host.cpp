#include "protocols/valve_bus/host.hpp"

#include <algorithm>
#include <utility>

#include "harness/kernel/check.hpp"

namespace fieldproof::valve_bus {
namespace {

constexpr unsigned kDriverOffBits = 1;
// Of the time-out; a response that is later than this is not waited for.
constexpr int kLatePercent = 5;

}  // namespace

std::string_view describe(HostErrorKind kind) {
  constexpr std::array<std::string_view, 9> kNames{"refused ID",   "refused command",  "no response",
                                                   "bad response", "not acknowledged", "readback mismatch",
                                                   "line busy",    "FIFO overflow",    "part of a command"};
  return kNames.at(static_cast<std::size_t>(kind));
}

Host::Host(const HostConfiguration& configuration)
    : Host(configuration, std::make_unique<CommandFifo>(configuration.rules)) {}

Host::Host(const HostConfiguration& configuration, std::unique_ptr<CommandFifo> fifo)
    : configuration_(configuration),
      rules_(configuration.rules),
      dip_(configuration.dip),
      codec_(rules_),
      collector_(rules_),
      fifo_(std::move(fifo)) {}

void Host::wire(segment::Port& line, HostApplication& application) {
  line_ = &line;
  application_ = &application;
}

void Host::set_power(bool is_on, kernel::Time now) {
  fifo_->clear();
  exchange_.reset();
  known_.fill(std::nullopt);
  counters_.fill({});
  refresh_order_.clear();
  is_late_ = false;
  state_ = is_on ? HostState::idle : HostState::off;
  if (!is_on) return;
  read_dip();
  // What was on the line before is not known.
  free_at_ = now + silence();
}

void Host::read_dip() {
  rules_.bit_rate = bit_rate_of(dip_);
  codec_ = CharacterCodec(rules_);
  collector_ = FrameCollector(rules_);
}

// ---- the PC ----

void Host::write(std::span<const std::uint8_t> octets, kernel::Time now) {
  if (state_ == HostState::off) return;
  if (fifo_->part_ends_at() <= now) on_part(fifo_->take_part(), now);
  for (const std::uint8_t octet : octets) {
    if (!fifo_->put(octet, now)) on_lost_command(octet, now);
  }
}

void Host::on_lost_command(std::uint8_t id, kernel::Time now) {
  tell(HostError{id, HostErrorKind::fifo_overflow}, now);
}

void Host::on_part(std::span<const std::uint8_t> part, kernel::Time now) {
  if (!part.empty()) tell(HostError{part.front(), HostErrorKind::part_of_command}, now);
}

bool Host::is_address(std::uint8_t id) const {
  return id >= rules_.first_address && id <= rules_.last_address;
}

bool Host::is_command(std::uint8_t command) const {
  return command == rules_.write_command || command == rules_.read_command;
}

// The next command that may be sent; those in front of it are refused.
std::optional<Command> Host::next_valid_command(kernel::Time now) {
  while (const auto command = next_command()) {
    if (!is_address(command->id)) {
      refuse({command->id, HostErrorKind::refused_id}, now);
    } else if (!is_command(command->command)) {
      refuse({command->id, HostErrorKind::refused_command}, now);
    } else {
      return command;
    }
  }
  return std::nullopt;
}

std::optional<Host::Exchange> Host::next_exchange(kernel::Time now) {
  if (refresh_due_at() <= now && may_refresh(was_refresh_)) {
    was_refresh_ = true;
    return Exchange{writes_[refresh_order_.at(next_refresh(now))].command, Purpose::refresh};
  }
  was_refresh_ = false;
  const auto command = next_valid_command(now);
  if (!command) return std::nullopt;
  if (command->command == rules_.write_command) keep_write(*command);
  return Exchange{*command, Purpose::command};
}

// ---- the line ----

void Host::receive(segment::PortIndex, const line::Waveform& reception) {
  if (state_ == HostState::off) return;
  const kernel::Time now = reception.end();
  codec_.decode(reception, [&](const line::UartCharacter& character) {
    if (is_own(character)) return;
    if (collector_.ends_at() <= character.start) end_frame(now);
    on_character(judged(character));
  });
}

void Host::on_time(kernel::Time now) {
  if (state_ == HostState::off) return;
  if (collector_.known_at() <= now) end_frame(now);
  if (fifo_->part_ends_at() <= now) on_part(fifo_->take_part(), now);
  if (window_closes_at() <= now) close_window(now);
  if (state_ == HostState::resting && free_at_ <= now) state_ = HostState::idle;
  if (busy_limit_at() <= now) on_line_busy(now);
  if (sends_at() <= now) {
    if (!exchange_) exchange_ = next_exchange(now);
    if (exchange_) send(now);
  }
}

kernel::Time Host::next_time() const {
  if (state_ == HostState::off) return kernel::kNever;
  kernel::Time next = std::min(collector_.known_at(), fifo_->part_ends_at());
  next = std::min({next, window_closes_at(), busy_limit_at(), sends_at()});
  return state_ == HostState::resting ? std::min(next, free_at_) : next;
}

kernel::Time Host::refresh_due_at() const {
  return refresh_order_.empty() ? kernel::kNever : writes_[refresh_order_.front()].due;
}

// Since when there is something to send; kNever without.
kernel::Time Host::work_since() const {
  return exchange_ || fifo_->has_command() ? free_at_ : refresh_due_at();
}

kernel::Time Host::sends_at() const {
  const bool is_silent = collector_.is_empty() || !waits_for_silence();
  if (state_ != HostState::idle || !is_silent) return kernel::kNever;
  return std::max(work_since(), free_at_);
}

kernel::Time Host::window_closes_at() const {
  if (state_ != HostState::awaiting) return kernel::kNever;
  const kernel::Time sure = window_end_ + character_notice(rules_);
  if (collector_.is_empty() || collector_.frame().start > window_end_) return sure;
  // Something is being said. If it is a response it is over by then.
  constexpr unsigned kCharacters = 2 * kResponseOctets;
  return sure + half_characters(rules_, 2 * kCharacters) + delimiter(rules_);
}

kernel::Time Host::busy_limit_at() const {
  if (state_ != HostState::idle || collector_.is_empty()) return kernel::kNever;
  const kernel::Time since = std::max({work_since(), collector_.frame().start, waits_since_});
  return since == kernel::kNever ? since : since + longest_talk();
}

void Host::end_frame(kernel::Time now) {
  const CollectedFrame frame = collector_.frame();
  collector_.clear();
  leave_silent_until(frame.busy_until + silence());
  const bool is_in_window = state_ == HostState::awaiting && !is_rejected_ && frame.start <= window_end_;
  if (is_in_window) {
    on_window_frame(frame, now);
  } else {
    on_stray(frame, now);
  }
}

// ---- requests ----

void Host::send(kernel::Time now) {
  const Command command = sent(exchange_->command);
  std::array<std::uint8_t, kCommandOctets> octets = octets_of(command);
  octets.back() = request_check(command);
  const kernel::Time start = now + bits(rules_, rules_.driver_on_bits);
  request_end_ = start + half_characters(rules_, 2 * kCommandOctets);
  last_id_ = command.id;
  is_late_ = false;
  is_rejected_ = false;
  leave_silent_until(request_end_ + silence());
  transmit(octets, start);
  if (command.command == rules_.write_command) note_write(exchange_->command, start);
  if (awaits_response(*exchange_)) {
    state_ = HostState::awaiting;
    window_end_ = request_end_ + time_out();
  } else {
    end_write();
    enter_resting(request_end_ + delimiter(rules_) + rules_.write_distance);
  }
}

void Host::transmit(std::span<const std::uint8_t> octets, kernel::Time start) {
  FIELDPROOF_CHECK(line_ != nullptr, "a host that drives has been wired");
  const auto characters = static_cast<unsigned>(octets.size());
  driving_until_ = start + half_characters(rules_, 2 * characters) + bits(rules_, kDriverOffBits);
  codec_.drive(*line_, octets, start, {rules_.driver_on_bits, kDriverOffBits});
}

std::int64_t Host::bit_rate_of(unsigned dip) const {
  const auto rates = dip_bit_rates();
  return rates[dip % rates.size()];
}

std::uint8_t Host::request_check(const Command& command) const {
  return octets_of(command).back();
}

bool Host::awaits_response(const Exchange& exchange) const {
  return exchange.command.command == rules_.read_command || rules_.answers_writes;
}

// Refreshes that are due and commands of the PC take turns.
bool Host::may_refresh(bool was_refresh) const {
  return !(was_refresh && fifo_->has_command());
}

bool Host::may_repeat(const Exchange& exchange) const {
  return exchange.attempt < rules_.read_attempts;
}

kernel::Duration Host::late_span() const {
  return time_out() * kLatePercent / 100;
}

void Host::keep_write(const Command& command) {
  writes_[command.id].command = command;
}

void Host::note_write(const Command& command, kernel::Time start) {
  writes_[command.id].due = refreshed_at(start);
  std::erase(refresh_order_, command.id);
  if (is_refreshed(command.id)) refresh_order_.push_back(command.id);
}

// ---- responses ----

void Host::on_window_frame(const CollectedFrame& frame, kernel::Time now) {
  const bool is_early = frame.start - request_end_ < shortest_turnaround_time();
  const auto response = is_early ? std::nullopt : response_in(frame);
  if (response) {
    accept(*response, now);
  } else {
    reject();
  }
}

std::optional<Response> Host::response_in(const CollectedFrame& frame) const {
  const auto octets = frame.whole(kResponseOctets);
  if (!octets || !fits(*octets)) return std::nullopt;
  return response_of(*octets);
}

bool Host::fits(std::span<const std::uint8_t> octets) const {
  return block_check(octets) == 0;
}

void Host::accept(const Response& response, kernel::Time now) {
  const Command command = exchange_->command;
  const bool is_write = command.command == rules_.write_command;
  if (is_write && response != Response{command.data0, command.data1}) {
    reject();
    return;
  }
  state_ = HostState::idle;
  if (is_write) {
    end_write();
    return;
  }
  const Purpose purpose = exchange_->purpose;
  exchange_.reset();
  if (purpose == Purpose::verification) {
    if (!is_verified(command, response)) {
      tell(HostError{command.id, HostErrorKind::readback_mismatch}, now);
    }
    return;
  }
  known_[command.id] = response;
  tell(HostResponse{command.id, response.data0, response.data1}, now);
}

void Host::end_write() {
  const Exchange write = *std::exchange(exchange_, std::nullopt);
  if (!is_read_back(write)) return;
  // It carries what is expected; a node does not look at the data of a read.
  Command read = write.command;
  read.command = static_cast<std::uint8_t>(rules_.read_command);
  exchange_ = Exchange{read, Purpose::verification};
}

bool Host::is_verified(const Command& written, const Response& read) const {
  return read == Response{written.data0, written.data1};
}

void Host::reject() {
  ++counted(last_id_).rejected;
  is_rejected_ = true;
  if (!waits_out_a_wrong_response()) window_end_ = request_end_;
}

void Host::close_window(kernel::Time now) {
  const bool has_begun = !collector_.is_empty() && collector_.frame().start <= window_end_;
  const bool is_silent = !is_rejected_ && !has_begun;
  if (!is_rejected_ && !is_silent) reject();
  if (is_silent) ++counted(last_id_).timeouts;
  is_late_ = is_silent;
  repeat_or_fail(is_silent ? HostErrorKind::no_response : HostErrorKind::bad_response, now);
}

void Host::repeat_or_fail(HostErrorKind kind, kernel::Time now) {
  if (!may_repeat(*exchange_)) {
    fail(kind, now);
    return;
  }
  ++exchange_->attempt;
  ++counted(exchange_->command.id).retries;
  waits_since_ = now;
  state_ = HostState::idle;
}

void Host::fail(HostErrorKind kind, kernel::Time now) {
  const Exchange failed = *std::exchange(exchange_, std::nullopt);
  const bool is_write = failed.command.command == rules_.write_command;
  enter_resting(now + late_span());
  tell(HostError{failed.command.id,
                 is_write && kind != HostErrorKind::line_busy ? HostErrorKind::not_acknowledged : kind},
       now);
  if (!is_write && failed.purpose == Purpose::command) tell_old(failed.command.id, now);
}

// What nobody waits for: drained.
void Host::on_stray(const CollectedFrame&, kernel::Time) {
  if (is_late_) ++counted(last_id_).late;
}

// The line does not fall silent, so nothing can be sent. The PC is told as if it had been.
void Host::on_line_busy(kernel::Time now) {
  waits_since_ = now;
  if (!exchange_) exchange_ = next_exchange(now);
  if (!exchange_) return;
  const Command& command = exchange_->command;
  if (exchange_->purpose == Purpose::refresh) {
    note_write(command, now);
    exchange_.reset();
  } else if (command.command == rules_.write_command) {
    note_write(command, now);
    fail(HostErrorKind::line_busy, now);
  } else {
    repeat_or_fail(HostErrorKind::line_busy, now);
  }
}

void Host::enter_resting(kernel::Time until) {
  state_ = HostState::resting;
  leave_silent_until(until);
}

// ---- the PC is told ----

void Host::tell(const HostResponse& response, kernel::Time now) {
  application_->on_response(response, now);
}

void Host::tell(const HostError& error, kernel::Time now) {
  application_->on_error(error, now);
}

void Host::tell_old(std::uint8_t id, kernel::Time now) {
  if (const auto& old = known_[id]) tell(HostResponse{id, old->data0, old->data1, true}, now);
}

}  // namespace fieldproof::valve_bus
