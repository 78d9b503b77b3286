#include "conformance/token_bus/dual_channel_bench.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "protocols/token_bus/dual_channel_settings.hpp"

namespace fieldproof::conformance {
namespace {

SideLog request_log(const token_bus::ChannelManagerConfiguration& configuration) {
  return {SideLog::Side::requests, token_bus::mac_symbol_rate(configuration.rules)};
}

}  // namespace

ManagerBench::ManagerBench(const ManagerNeeds& needs, const ManagerSetting& setting)
    : SidesBench(sides_configuration(needs, setting, token_bus::kChannelManagerTable), setting, "manager"),
      requested_{request_log(configuration()), request_log(configuration())},
      indicated_(SideLog::Side::mac, token_bus::mac_symbol_rate(configuration().rules)),
      mac_in_(into("mac/request", token_bus::kTowardsMac)),
      channel_in_{&into("a/indicate", token_bus::port_of(Channel::a)),
                  &into("b/indicate", token_bus::port_of(Channel::b))},
      mac_out_(out_of("mac/indicate", token_bus::kTowardsMac)),
      channel_out_{&out_of("a/request", token_bus::port_of(Channel::a)),
                   &out_of("b/request", token_bus::port_of(Channel::b))} {
  start_recording(setting, configuration().rules);
  mac_out_.tap_driven(indicated_);
  watch(mac_out_);
  fault::InstalledPlan* const made =
      make_plan(setting.plan, fault::names_of_transmissions({channel_in_[0]->name(), channel_in_[1]->name()},
                                                            observations_of_the_watch()));
  for (std::size_t n = 0; n < channel_out_.size(); ++n) {
    channel_out_.at(n)->tap_driven(requested_.at(n));
    watch(*channel_out_.at(n));
    segment::Link& in = *channel_in_.at(n);
    if (made != nullptr) in.set_channel(made->channel_for({in.name(), in.trace_channel(), rate()}));
  }
  device().wire(mac_out_, *channel_out_[0], *channel_out_[1], *this);
  set_power(true);
}

void ManagerBench::ask() {
  request("PPPPPPPP");
  settle();
}

void ManagerBench::request(std::string_view symbols) {
  segment().run_until(begin_request(symbols));
}

kernel::Time ManagerBench::begin_request(std::string_view symbols) {
  return drive(mac_in_, now(), rate(), request_levels_of(symbols));
}

void ManagerBench::command(SideCommand command, std::size_t symbols) {
  segment().run_until(drive(mac_in_, now(), rate(), request_levels_of(command, symbols)));
}

void ManagerBench::begin_ring(token_bus::Address address) {
  if (mac_ == nullptr) {
    const auto request = [this](const token_bus::MacSymbols& symbols, kernel::Time start) {
      drive(mac_in_, start, rate(), request_levels_of(token_bus::written(symbols)));
    };
    mac_ = std::make_unique<MacPlayer>(
        token_bus::StationConfiguration{.rules = configuration().rules, .address = address}, request);
    mac_seat_ = segment().attach(*mac_, "mac");
  }
  mac_->start_anew(now());
  segment().refresh(mac_seat_);
}

void ManagerBench::on_driven(segment::PortIndex port, const line::Waveform& wave) {
  if (mac_ == nullptr || port != token_bus::kTowardsMac) return;
  mac_->indicate(wave);
  segment().refresh(mac_seat_);
}

void ManagerBench::carry(const ChannelText& on_a, const ChannelText& on_b) {
  segment().run_until(begin_carrying(on_a, on_b));
}

kernel::Time ManagerBench::begin_carrying(const ChannelText& on_a, const ChannelText& on_b) {
  const kernel::Time begin = now();
  kernel::Time end = begin;
  for (const auto& [link, text] : {std::pair(channel_in_[0], &on_a), std::pair(channel_in_[1], &on_b)}) {
    if (text->symbols.empty()) continue;
    end = std::max(end, drive(*link, begin + symbols(text->later), rate(),
                              indication_levels_of(text->symbols), text->parts_per_million));
  }
  return end;
}

void ManagerBench::clear_requests() {
  for (SideLog& one : requested_) one.clear();
}

void ManagerBench::clear() {
  clear_requests();
  indicated_.clear();
  events_.clear();
}

void ManagerBench::on_channel_event(const token_bus::ChannelEvent& event, kernel::Time when) {
  events_.push_back(fmt::format("{}: {}", text_of(event.channel), text_of(event.kind)));
  last_event_ = when;
}

std::vector<std::string> ManagerBench::decode_lines() const {
  std::vector<std::string> lines = driven_lines([&](const segment::Link& link) {
    return SideLog(&link == &mac_in_ ? SideLog::Side::requests : SideLog::Side::mac,
                   token_bus::mac_symbol_rate(configuration().rules));
  });
  lines.push_back(shown_end("the manager requested of A", requested_[0]));
  lines.push_back(shown_end("the manager requested of B", requested_[1]));
  lines.push_back(shown_end("the manager indicated", indicated_));
  lines.push_back(fmt::format("the manager reported: {}",
                              events_.empty() ? "nothing" : fmt::format("{}", fmt::join(events_, ", "))));
  return lines;
}

}  // namespace fieldproof::conformance
