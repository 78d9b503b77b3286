#include "protocols/interbus/attached_slave.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace fieldproof::interbus {
AttachedSlave::AttachedSlave(iut::Attachment attachment, const SlaveConfiguration& configuration,
                             const std::string& case_id, std::uint64_t seed)
    : words_(configuration.words), attached_(std::move(attachment)) {
  front_ = front_of(attached_, configuration.rules, "slave");
  attached_.begin({case_id, seed, slave_settings(configuration)}, *this);
}

// A slave of the bench is supplied from the beginning.
void AttachedSlave::wire(const SlavePorts& ports, Terminals& terminals) {
  ports_ = {ports.upstream, ports.branch, ports.remote};
  terminals_ = &terminals;
  set_power(true, kernel::kStart);
}

void AttachedSlave::set_power(bool is_on, kernel::Time now) {
  if (front_) front_->reset();
  is_supplied_ = is_on;
  attached_.set_power(is_on, now);
}

void AttachedSlave::receive(segment::PortIndex port, const line::Waveform& reception) {
  if (!is_supplied_) return;
  if (!front_) {
    return attached_.call(reception.start, [&](iut::Device& device) { device.receive(port, reception); });
  }
  front_->hear(port, reception, [&](auto telegrams) { tell(port, telegrams, reception.start); });
}

void AttachedSlave::tell(unsigned port, std::span<const iut::Character> telegrams, kernel::Time now) {
  attached_.call(now, [&](iut::Device& device) { device.receive(port, telegrams, now); });
}

void AttachedSlave::on_time(kernel::Time now) {
  if (!is_supplied_) return;
  if (front_) front_->complete(now, [&](unsigned port, auto telegrams) { tell(port, telegrams, now); });
  if (!front_ || attached_.next_time() <= now) attached_.on_time(now);
}

kernel::Time AttachedSlave::next_time() const {
  if (!is_supplied_) return kernel::kNever;
  return std::min(attached_.next_time(), front_ ? front_->next_time() : kernel::kNever);
}

void AttachedSlave::end() {
  if (front_) front_->reset();
  attached_.end();
}

void AttachedSlave::send(unsigned port, kernel::Time start, std::span<const std::uint16_t> characters) {
  if (!front_) iut::refuse_impossible("sends characters; this slave has announced levels");
  drive(port, front_->levels_of(start, characters));
}

void AttachedSlave::transmit(unsigned port, line::Waveform& wave) {
  if (front_) iut::refuse_impossible("drives levels; this slave has announced telegrams");
  drive(port, wave);
}

void AttachedSlave::drive(unsigned port, line::Waveform& wave) {
  attached_.expect_drive(wave);
  if (port >= ports_.size() || ports_.at(port) == nullptr) {
    iut::refuse_impossible(fmt::format("drives port {}, where nothing is plugged in", port));
  }
  ports_.at(port)->drive(wave);
}

void AttachedSlave::write(iut::Item item, std::uint64_t value, kernel::Time when) {
  if (item - kOutputWord >= static_cast<int>(words_) || value > 0xFFFF) {
    iut::refuse_impossible(
        fmt::format("writes {} to item {}; this slave has {} output words, from item {} on", value, item,
                    words_, kOutputWord));
  }
  // The words of a cycle may come in any order.
  attached_.expect_in_order(when, fmt::format("moves output word {}", item - kOutputWord));
  terminals_->output(item - kOutputWord, static_cast<std::uint16_t>(value), when);
}

std::uint64_t AttachedSlave::read(iut::Item item, kernel::Time when) {
  attached_.expect_ahead(when, "looks at its terminals");
  if (item == kPeripheralFault) return terminals_->has_peripheral_fault(when) ? 1 : 0;
  if (item == kReconfiguration) return terminals_->wants_reconfiguration(when) ? 1 : 0;
  if (item == kRemotePlugged) return remote_present_ && ports_[kFromRemote] != nullptr ? 1 : 0;
  if (item == kBranchPlugged) return branch_present_ && ports_[kFromBranch] != nullptr ? 1 : 0;
  if (item < kInputWord || item >= kInputWord + words_) {
    iut::refuse_impossible(fmt::format("reads item {}; this slave has {} input words, from item {} on", item,
                                       words_, kInputWord));
  }
  return terminals_->input(item - kInputWord, when);
}

// ---- a slave of ours ----

bool ServedSlave::begin(const iut::CaseBegin& begin, iut::Bench& bench) {
  play(make_(slave_configuration_of(begin)), bench);
  is_wired_ = false;
  return true;
}

// Where nothing is plugged in when the supply comes first, nothing will be.
void ServedSlave::set_power(bool is_on, kernel::Time now) {
  if (!is_on) return;
  if (is_wired_) {
    return act(now, [&] {
      station().set_power(false, now);
      station().set_power(true, now);
    });
  }
  is_wired_ = true;
  SlavePorts ports{.upstream = &port(kFromUpstream)};
  is_branch_plugged_ = bench().read(kBranchPlugged, now) != 0;
  is_remote_plugged_ = bench().read(kRemotePlugged, now) != 0;
  if (is_branch_plugged_) ports.branch = &port(kFromBranch);
  if (is_remote_plugged_) ports.remote = &port(kFromRemote);
  station().wire(ports, *this);
}

// A plug is put in or pulled between two calls.
void ServedSlave::before_call() {
  const auto follow = [&](iut::Item item, bool on_branch, bool& known) {
    const bool is_plugged = bench().read(item, now()) != 0;
    if (is_plugged == known) return;
    known = is_plugged;
    station().set_next_present(on_branch, is_plugged);
  };
  follow(kBranchPlugged, true, is_branch_plugged_);
  follow(kRemotePlugged, false, is_remote_plugged_);
}

std::uint16_t ServedSlave::input(unsigned word, kernel::Time when) {
  return static_cast<std::uint16_t>(bench().read(static_cast<iut::Item>(kInputWord + word), not_past(when)));
}

void ServedSlave::output(unsigned word, std::uint16_t value, kernel::Time when) {
  bench().write(static_cast<iut::Item>(kOutputWord + word), value, not_past(when));
}

bool ServedSlave::has_peripheral_fault(kernel::Time when) {
  return bench().read(kPeripheralFault, not_past(when)) != 0;
}

bool ServedSlave::wants_reconfiguration(kernel::Time when) {
  return bench().read(kReconfiguration, not_past(when)) != 0;
}

}  // namespace fieldproof::interbus
