#include "conformance/fieldbus_dll/ff_bench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "protocols/fieldbus_dll/ff_settings.hpp"

namespace fieldproof::conformance {
namespace {

using fieldbus_dll::FfAddress;
using fieldbus_dll::FfConfiguration;

constexpr std::uint8_t kDeviceNode = 0x21;
constexpr std::uint8_t kMasterNode = 0x10;

bool is_scheduler_in(const FfNeeds& needs, const FfSetting& setting) {
  return setting.is_link_master && !needs.is_in_standby;
}

FfConfiguration configuration_of(const FfNeeds& needs, const FfSetting& setting) {
  FfConfiguration configuration;
  const bool is_scheduler = is_scheduler_in(needs, setting);
  configuration.node = is_scheduler ? kMasterNode : kDeviceNode;
  configuration.begins_as_scheduler = is_scheduler;
  if (!is_scheduler) {
    configuration.published = {FfBench::kPublished, FfBench::kPublished + 1};
    configuration.subscribed = {FfBench::kSubscribed};
  }
  if (needs.change) needs.change(configuration);
  field::take_settings(fieldbus_dll::kFfTable, setting.settings, configuration);
  return configuration;
}

}  // namespace

void append_address(Octets& octets, FfAddress address, bool is_long) {
  for (int n = is_long ? 3 : 1; n >= 0; --n) octets.push_back(static_cast<std::uint8_t>(address >> (8 * n)));
}

bool FfUpperTester::was_delivered(const Octets& octets) const {
  return std::ranges::any_of(data, [&](const fieldbus_dll::FfDlpdu& one) { return one.data == octets; });
}

FfBench::FfBench(const FfNeeds& needs, const FfSetting& setting)
    : LinkBench(configuration_of(needs, setting).rules.link, setting.seed, setting.volume,
                setting.link_stresses),
      configuration_(configuration_of(needs, setting)),
      is_link_master_(setting.is_link_master),
      station_(setting.make_device(configuration_)) {
  start_recording(setting, rules());
  station_->wire(attach_station(*station_, setting.plan), user_);
  has_started_ = station_->start(now());
  refresh_iut();
  if (is_scheduler_in(needs, setting) || !needs.is_live) return;
  wait(octets(20));
  send({rules().codes.pn, node()});
  // The latest answer is over by then.
  wait(std::max(observation_timeout(), response_delay() + frame(2)));
  send(activation(node()));
  wait(observation_timeout());
  const kernel::Time begin = now();
  while (next(begin)) {
  }
}

std::string FfReport::text() const {
  if (kind == Kind::event) return fmt::format("{} of {:02X}", text_of(event.kind), event.node);
  return describe(dlpdu);
}

void FfBench::set_supply(bool is_on) {
  if (is_on) {
    has_started_ = station_->start(now());
  } else {
    station_->stop(now());
  }
  note_supply(is_on);
  refresh_iut();
}

std::string FfBench::words(const DrivenDlpdu& dlpdu) const {
  return dlpdu.has_right_check ? words_of(dlpdu.octets, rules()) : dlpdu.text();
}

bool FfBench::submit(Priority priority, const Octets& data, FfAddress to) {
  destinations_.insert(to);
  const bool is_taken = station_->submit({priority, to, data}, now());
  refresh_iut();
  return is_taken;
}

bool FfBench::write(FfAddress address, const Octets& data) {
  const bool is_taken = station_->write(address, data, now());
  refresh_iut();
  return is_taken;
}

bool FfBench::order_transfer(std::uint8_t node) {
  const bool is_taken = station_->order_transfer(node, now());
  refresh_iut();
  return is_taken;
}

bool FfBench::ask_user_request(const Octets& request) {
  const bool is_taken = station_->ask(request, now());
  refresh_iut();
  return is_taken;
}

std::vector<DrivenDlpdu> FfBench::serve(kernel::Time until, const Answers& answers) {
  std::vector<DrivenDlpdu> all;
  while (const auto one = next(until)) {
    all.push_back(*one);
    if (const auto reply = answers ? answers(*one) : returned(*one))
      run_until(send_at(one->end + least_gap() + reply->later, reply->octets));
  }
  return all;
}

void FfBench::answer_one(const DrivenDlpdu& dlpdu) {
  if (const auto reply = returned(dlpdu)) run_until(send_at(dlpdu.end + least_gap(), reply->octets));
}

std::optional<FfBench::Reply> FfBench::returned(const DrivenDlpdu& dlpdu) const {
  const auto& codes = rules().codes;
  const unsigned code = dlpdu.octet(0);
  constexpr unsigned kPriorityAndFinal = 0x07;
  constexpr unsigned kLongToo = 0x0F;
  if ((code & ~kPriorityAndFinal) == codes.pt && code != codes.rt) return Reply{{codes.rt}};
  if ((code & ~kLongToo) == codes.cd) {
    const FfAddress address = static_cast<FfAddress>(dlpdu.octet(1) << 8 | dlpdu.octet(2));
    return Reply{dt3(address, {0x55})};
  }
  return std::nullopt;
}

// ---- DLPDUs of the tester ----

Octets FfBench::pt(Priority least, unsigned duration) {
  begins_circulation_ = !begins_circulation_;
  const unsigned mark = begins_circulation_ ? fieldbus_dll::kFinalBit : 0U;
  return {static_cast<std::uint8_t>(control(rules().codes.pt, least) | mark), node(),
          static_cast<std::uint8_t>(duration >> 8), static_cast<std::uint8_t>(duration & 0xFF)};
}

Octets FfBench::cd(FfAddress address) const {
  Octets octets{control(rules().codes.cd, Priority::normal)};
  append_address(octets, address);
  return octets;
}

Octets FfBench::dt1(Priority priority, FfAddress to, FfAddress from, const Octets& data,
                    bool is_final) const {
  constexpr unsigned kLong = 0x08;
  constexpr unsigned kFinal = 0x04;
  Octets octets{control(rules().codes.dt1, priority)};
  if (fieldbus_dll::is_long(to)) octets[0] |= kLong;
  if (is_final) octets[0] |= kFinal;
  append_address(octets, to);
  append_address(octets, from);
  octets.insert(octets.end(), data.begin(), data.end());
  return octets;
}

Octets FfBench::dt3(FfAddress from, const Octets& data) const {
  constexpr unsigned kFinal = 0x04;
  constexpr unsigned kLong = 0x08;
  Octets octets{static_cast<std::uint8_t>(control(rules().codes.dt3, Priority::normal) | kFinal)};
  if (fieldbus_dll::is_long(from)) octets[0] |= kLong;
  append_address(octets, from);
  octets.push_back(1);
  octets.insert(octets.end(), data.begin(), data.end());
  return octets;
}

Octets FfBench::activation(std::uint8_t node) const {
  return dt1(Priority::normal, fieldbus_dll::address_of(node), fieldbus_dll::address_of(kScheduler),
             {static_cast<std::uint8_t>(fieldbus_dll::SpduKind::activation)});
}

void FfBench::ask() {
  send({rules().codes.pn, node()});
  next();
}

}  // namespace fieldproof::conformance
