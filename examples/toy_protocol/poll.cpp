#include "poll.hpp"

namespace poll {
namespace {

std::uint8_t check_of(std::uint8_t address, std::uint8_t value) {
  return static_cast<std::uint8_t>(address ^ value ^ 0x5A);
}

class CheckIgnored final : public Responder {
  using Responder::Responder;
  bool is_right(const Octets&) const override { return true; }
};

class AnswersForAll final : public Responder {
  using Responder::Responder;
  bool is_for_me(const Octets&) const override { return true; }
};

std::vector<Mutants::Row> rows() {
  using namespace conformance;
  return {{"check_ignored", "M1", "does not look at the check", mutant<CheckIgnored>()},
          {"answers_for_all", "M2", "takes every address for its own", mutant<AnswersForAll>()},
          {"answers_late", "M3", "answers after 3 ms",
           with_rules<Responder>([](Rules& rules) { rules.turnaround_time = 3 * kernel::kMillisecond; })}};
}

}  // namespace

Octets request_to(std::uint8_t address) {
  return {address, check_of(address, 0)};
}

Octets answer_of(std::uint8_t address, std::uint8_t value) {
  return {value, check_of(address, value)};
}

std::optional<std::uint8_t> value_in(std::uint8_t address, const std::optional<Octets>& octets) {
  if (!octets || octets->size() != 2 || octets->back() != check_of(address, octets->front()))
    return std::nullopt;
  return octets->front();
}

void Responder::wire(segment::Port& line, Value value) {
  line_ = &line;
  value_ = std::move(value);
}

void Responder::receive(segment::PortIndex, const line::Waveform& wave) {
  answers_at_ = kernel::kNever;  // whoever speaks into the turnaround time takes the line
  const std::optional<Octets> octets = uart_.octets_in(wave);
  if (!octets || octets->size() != 2 || !is_for_me(*octets) || !is_right(*octets)) return;
  answers_at_ = wave.end() + configuration_.rules.turnaround_time;
}

void Responder::on_time(kernel::Time now) {
  if (now < answers_at_) return;
  answers_at_ = kernel::kNever;
  line::Waveform wave = uart_.wave_of(answer_of(configuration_.address, value_(now)), now);
  line_->drive(wave);
}

const Mutants& mutants() {
  static const Mutants table("responder", {rows});
  return table;
}

}  // namespace poll
