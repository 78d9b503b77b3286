#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>

#include "protocols/fieldbus_dll/ff_device.hpp"

// How applications talk over the data link of FF-P beside buffers that are published: as client and server,
// and by reports to all.
//
//   client/server         a request of normal priority to the server, and its response; the client waits for
//                         one response of each server, and gives it up when its time is over
//   report distribution   to everybody, with the priority of what it tells; nobody answers
//
// That there are these kinds beside publisher and subscriber, and that requests are queued, reports sent
// without an answer, is from memory; octets and numbers are this project's choice. In front of what an
// application says stands its kind (1: request, 2: response, 3: report) and a number: of the request, or of
// the report, so that who gets reports can count those that it missed. Nothing is sent again: what is lost on
// the line is a response that does not come, or a gap.
namespace fieldproof::fieldbus_dll {

class Relationships final : public FfUser {
 public:
  using Submit = std::function<bool(const FfRequest&)>;
  // What a server answers to whom.
  using Serve = std::function<Octets(std::uint8_t client, const Octets& request, kernel::Time when)>;

  // Data to this selector, and to everybody, is theirs; all else goes to `rest`, which must outlive them.
  static constexpr std::uint8_t kSelectorOfRelationships = 0x30;

  struct Response {
    std::uint8_t server;
    Octets data;
    kernel::Time asked;
    kernel::Time came;
  };
  struct Report {
    std::uint8_t source;
    Priority priority;
    std::uint8_t number;
    Octets data;
    kernel::Time came;
  };

  // `submit` hands a request to the station whose user this is.
  Relationships(Submit submit, FfUser& rest) : submit_(std::move(submit)), rest_(rest) {}

  void serve(Serve serve) { serve_ = std::move(serve); }
  void on_response(std::function<void(const Response&)> listener) { on_response_ = std::move(listener); }
  void on_report(std::function<void(const Report&)> listener) { on_report_ = std::move(listener); }

  // False: an earlier one to this server waits for its response, or the station refuses it.
  bool request(std::uint8_t server, const Octets& data, kernel::Time now);
  // Requests that have waited for as long get no response any more. Gives how many there were.
  std::size_t give_up(kernel::Duration longest, kernel::Time now);
  // Its number; nothing when the station refuses it.
  std::optional<std::uint8_t> report(Priority priority, const Octets& data);

  // Reports of others that have not come, by the gaps in their numbers: at most 255 of one in a row.
  std::uint64_t missed_reports() const { return missed_reports_; }

  void on_data(const FfDlpdu& dlpdu, kernel::Time when) override;
  void on_published(const FfDlpdu& dlpdu, kernel::Time when) override { rest_.on_published(dlpdu, when); }
  void on_event(const FfEvent& event, kernel::Time when) override { rest_.on_event(event, when); }

 private:
  struct Asked {
    std::uint8_t number;
    kernel::Time when;
  };

  void take_request(const FfDlpdu& dlpdu, const Octets& data, kernel::Time when);
  void take_response(const FfDlpdu& dlpdu, const Octets& data, kernel::Time when);
  void take_report(const FfDlpdu& dlpdu, const Octets& data, kernel::Time when);

  Submit submit_;
  FfUser& rest_;
  Serve serve_;
  std::function<void(const Response&)> on_response_;
  std::function<void(const Report&)> on_report_;
  std::map<std::uint8_t, Asked> asked_;  // by server
  std::uint8_t last_request_ = 0;
  std::uint8_t last_report_ = 0;
  std::map<std::uint8_t, std::uint8_t> last_heard_;  // number of the last report, by source
  std::uint64_t missed_reports_ = 0;
};

}  // namespace fieldproof::fieldbus_dll
