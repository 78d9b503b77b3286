#include "protocols/fieldbus_dll/relationships.hpp"

#include <utility>

namespace fieldproof::fieldbus_dll {
namespace {

enum class Said : std::uint8_t { request = 1, response = 2, report = 3 };

constexpr std::size_t kKindAndNumber = 2;

Octets said(Said kind, std::uint8_t number, const Octets& data) {
  Octets octets{static_cast<std::uint8_t>(kind), number};
  octets.insert(octets.end(), data.begin(), data.end());
  return octets;
}

}  // namespace

bool Relationships::request(std::uint8_t server, const Octets& data, kernel::Time now) {
  if (asked_.contains(server)) return false;
  const auto number = static_cast<std::uint8_t>(last_request_ + 1);
  const FfAddress address = address_of(server, kSelectorOfRelationships);
  if (!submit_({Priority::normal, address, said(Said::request, number, data)})) return false;
  last_request_ = number;
  asked_[server] = {number, now};
  return true;
}

std::size_t Relationships::give_up(kernel::Duration longest, kernel::Time now) {
  return std::erase_if(asked_, [&](const auto& one) { return one.second.when + longest <= now; });
}

std::optional<std::uint8_t> Relationships::report(Priority priority, const Octets& data) {
  const auto number = static_cast<std::uint8_t>(last_report_ + 1);
  if (!submit_({priority, kEverybody, said(Said::report, number, data)})) return std::nullopt;
  last_report_ = number;
  return number;
}

void Relationships::on_data(const FfDlpdu& dlpdu, kernel::Time when) {
  const bool is_for_all = dlpdu.destination == kEverybody;
  const bool is_theirs = is_for_all || (dlpdu.destination & 0xFF) == kSelectorOfRelationships;
  if (!is_theirs) return rest_.on_data(dlpdu, when);
  if (dlpdu.data.size() < kKindAndNumber) return;
  const Octets data(dlpdu.data.begin() + kKindAndNumber, dlpdu.data.end());
  switch (static_cast<Said>(dlpdu.data[0])) {
    case Said::request:
      if (!is_for_all) take_request(dlpdu, data, when);
      return;
    case Said::response:
      if (!is_for_all) take_response(dlpdu, data, when);
      return;
    case Said::report:
      if (is_for_all) take_report(dlpdu, data, when);
      return;
  }
}

void Relationships::take_request(const FfDlpdu& dlpdu, const Octets& data, kernel::Time when) {
  if (!serve_) return;
  const std::uint8_t client = node_of(dlpdu.source);
  const Octets response = said(Said::response, dlpdu.data[1], serve_(client, data, when));
  submit_({Priority::normal, address_of(client, kSelectorOfRelationships), response});
}

void Relationships::take_response(const FfDlpdu& dlpdu, const Octets& data, kernel::Time when) {
  const auto asked = asked_.find(node_of(dlpdu.source));
  // It was given up, or has been answered.
  if (asked == asked_.end() || asked->second.number != dlpdu.data[1]) return;
  const Response response{asked->first, data, asked->second.when, when};
  asked_.erase(asked);
  if (on_response_) on_response_(response);
}

void Relationships::take_report(const FfDlpdu& dlpdu, const Octets& data, kernel::Time when) {
  const std::uint8_t source = node_of(dlpdu.source);
  const std::uint8_t number = dlpdu.data[1];
  const auto [last, is_first] = last_heard_.try_emplace(source, number);
  if (!is_first) missed_reports_ += static_cast<std::uint8_t>(number - last->second - 1);
  last->second = number;
  if (on_report_) on_report_({source, dlpdu.priority, number, data, when});
}

}  // namespace fieldproof::fieldbus_dll
