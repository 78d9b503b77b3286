#include "conformance/interbus/slave_model.hpp"

#include <fmt/format.h>

#include "harness/kernel/check.hpp"

namespace fieldproof::conformance {
namespace {

std::uint16_t reversed(unsigned value) {
  unsigned result = 0;
  for (unsigned bit = 0; bit < 16; ++bit) result |= ((value >> bit) & 1U) << (15 - bit);
  return static_cast<std::uint16_t>(result);
}

const line::FrameCheckParameters& parameters_of(const interbus::Rules& rules) {
  const line::FrameCheckParameters& parameters = line::frame_check_named(rules.frame_check);
  FIELDPROOF_CHECK(parameters.width == 16, "the frame check of the rules is a 16-bit one");
  return parameters;
}

}  // namespace

BitwiseCheck::BitwiseCheck(const line::FrameCheckParameters& parameters)
    : is_reflected_(parameters.refin),
      start_(is_reflected_ ? reversed(static_cast<unsigned>(parameters.init))
                           : static_cast<std::uint16_t>(parameters.init)),
      xorout_(static_cast<std::uint16_t>(parameters.xorout)) {
  const auto poly = static_cast<unsigned>(parameters.poly);
  for (unsigned octet = 0; octet < 256; ++octet) {
    unsigned reg = is_reflected_ ? octet : octet << 8;
    for (unsigned bit = 0; bit < 8; ++bit) {
      if (is_reflected_) {
        reg = (reg & 1U) != 0 ? reg >> 1 ^ reversed(poly) : reg >> 1;
      } else {
        reg = (reg & 0x8000U) != 0 ? reg << 1 ^ poly : reg << 1;
      }
    }
    table_.at(octet) = static_cast<std::uint16_t>(reg & 0xFFFF);
  }
}

std::uint16_t BitwiseCheck::word(std::uint16_t state) const {
  const auto value = static_cast<unsigned>(state ^ xorout_);
  return static_cast<std::uint16_t>(is_reflected_ ? (value & 0xFF) << 8 | value >> 8 : value);
}

std::uint16_t BitwiseCheck::of(std::span<const std::uint8_t> octets) const {
  std::uint16_t state = start_;
  for (const std::uint8_t octet : octets) state = next(state, octet);
  return word(state);
}

void find_first_cycle(std::span<const SeenTelegram> telegrams, FoundCycle& found) {
  found.is_found = false;
  found.end = 0;
  std::size_t transfer_end = 0;  // of the run of transfer telegrams that lies behind
  std::size_t transfer_begin = 0;
  std::size_t checks = 0;
  for (std::size_t n = 0; n < telegrams.size(); ++n) {
    const SeenTelegram& telegram = telegrams[n];
    const bool is_check = (telegram.header & line::kControl) != 0;
    const bool fits = transfer_end > transfer_begin && !telegram.is_stop_missing() &&
                      ((telegram.header ^ telegrams[transfer_begin].header) & line::kSelect) == 0;
    if (!is_check) {
      if (!fits || checks > 0) transfer_begin = n;
      transfer_end = telegram.is_stop_missing() ? transfer_begin : n + 1;
      if (telegram.is_stop_missing()) transfer_begin = transfer_end = n + 1;
      checks = 0;
      continue;
    }
    if (!fits) {
      transfer_begin = transfer_end = n + 1;
      checks = 0;
      continue;
    }
    if (++checks != 4) continue;
    found.is_found = true;
    found.is_id_cycle = (telegram.header & line::kSelect) != 0;
    found.end = n + 1;
    found.octets.clear();
    for (std::size_t k = transfer_begin; k < transfer_end; ++k) found.octets.push_back(telegrams[k].data);
    found.check = static_cast<std::uint16_t>(telegrams[n - 3].data << 8 | telegrams[n - 2].data);
    found.status = static_cast<std::uint16_t>(telegrams[n - 1].data << 8 | telegram.data);
    return;
  }
}

void find_last_cycle(std::span<const SeenTelegram> telegrams, FoundCycle& found) {
  FoundCycle next;
  std::size_t end = 0;
  found.is_found = false;
  found.end = 0;
  for (;;) {
    find_first_cycle(telegrams.subspan(end), next);
    if (!next.is_found) return;
    end += next.end;
    found = next;
    found.end = end;
  }
}

SlaveModel::SlaveModel(const interbus::Rules& rules)
    : check_(parameters_of(rules)), status_marked_(rules.status_marked) {}

const RightAnswer& SlaveModel::answer(const CycleOnLine& in, std::span<const std::uint8_t> load) {
  std::uint16_t received = check_.start();
  std::uint16_t sent = check_.start();
  right_.octets.resize(in.octets);
  for (std::size_t n = 0; n < in.octets; ++n) {
    const std::uint8_t leaving = n < load.size() ? load[n] : in.telegrams[n - load.size()].data;
    right_.octets[n] = leaving;
    received = check_.next(received, in.telegrams[n].data);
    sent = check_.next(sent, leaving);
  }
  right_.is_own_error = check_.word(received) != in.check();
  right_.check = check_.word(sent);
  right_.status = static_cast<std::uint16_t>(in.status() | (right_.is_own_error ? status_marked_ : 0));
  return right_;
}

std::uint8_t SlaveModel::header_of(const CycleOnLine& cycle, std::size_t n) const {
  return static_cast<std::uint8_t>(line::kDataTelegram | (cycle.is_id_cycle ? line::kSelect : 0) |
                                   (n < cycle.octets ? 0 : line::kControl));
}

bool SlaveModel::is_right(const CycleOnLine& out) const {
  unsigned difference = 0;
  for (std::size_t n = 0; n < out.octets; ++n) {
    difference |= static_cast<unsigned>(out.telegrams[n].data ^ right_.octets[n]) |
                  static_cast<unsigned>(out.telegrams[n].header ^ header_of(out, n));
  }
  for (std::size_t n = out.octets; n < out.octets + 4; ++n)
    difference |= static_cast<unsigned>(out.telegrams[n].header ^ header_of(out, n));
  return difference == 0 && out.check() == right_.check && out.status() == right_.status;
}

AnswerDifference SlaveModel::difference(const CycleOnLine& out, std::size_t register_octets) const {
  for (std::size_t n = 0; n < out.octets + 4; ++n) {
    const std::uint8_t header = out.telegrams[n].header;
    const std::uint8_t right = header_of(out, n);
    if (header == right) continue;
    const auto text = [](unsigned h) {
      return fmt::format("SL={} CR={} stop {}", h & 1, h >> 1 & 1,
                         (h & line::kStopMissing) != 0 ? "missing" : "present");
    };
    return {"header_wrong", fmt::format("header of telegram {}", n), text(right), text(header)};
  }
  for (std::size_t n = 0; n < out.octets; ++n) {
    const std::uint8_t octet = out.telegrams[n].data;
    if (octet == right_.octets[n]) continue;
    const bool is_register = n < register_octets;
    return {is_register ? "register_content_wrong" : "passed_octet_changed",
            fmt::format("transfer telegram {}, {}", n,
                        is_register ? "an octet of its own register" : "an octet that it passes on"),
            fmt::format("{:02X}h", right_.octets[n]), fmt::format("{:02X}h", octet)};
  }
  if (out.check() != right_.check) {
    return {"check_wrong", "check", fmt::format("{:04X}h", right_.check),
            fmt::format("{:04X}h", out.check())};
  }
  if (out.status() != right_.status) {
    return {"status_word_wrong", "status word", fmt::format("{:04X}h", right_.status),
            fmt::format("{:04X}h", out.status())};
  }
  return {};
}

}  // namespace fieldproof::conformance
