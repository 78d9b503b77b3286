#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "protocols/fieldbus_dll/ff_device.hpp"
#include "protocols/fieldbus_dll/line_end.hpp"

// The reference basic device of the profile FF-P.
//
//   offline ──PN: PR──▶ offline ──activation──▶ idle ──PT──▶ holding ──last DT1 with F, or RT──▶ idle
//                                                │
//                                                └──CD: DT3 with F, or SR──▶ idle
//
// It keeps V(MID) of silence after whatever was on the line and begins to answer within V(MRD) x V(ST), or
// not at all. What a scheduler sends while a token is held shows that it was taken back.
//
// It returns the token with F in its last DT1: after that nothing else would fit, or nothing else is there.
// A token that it cannot use is returned by RT. All that it sends ends within the duration.
//
// Every decision that a wrong implementation takes otherwise has a name and can be overridden one by one.
namespace fieldproof::fieldbus_dll {

enum class FfState : std::uint8_t { stopped, offline, idle, holding, replying };

class FfStation : public FfDevice {
 public:
  explicit FfStation(const FfConfiguration& configuration);

  void wire(segment::Port& line, FfUser& user) override;
  bool start(kernel::Time now) override;
  void stop(kernel::Time now) override;
  bool submit(const FfRequest& request, kernel::Time now) override;
  bool write(FfAddress address, const Octets& data, kernel::Time now) override;

  void receive(segment::PortIndex port, const line::Waveform& reception) override;
  void on_activity(segment::PortIndex port, bool begins, kernel::Time now) override;
  void on_time(kernel::Time now) override;
  kernel::Time next_time() const override;

  FfState state() const { return state_; }
  std::uint8_t node() const { return configuration_.node; }
  // 1/32 ms; what TDs have told, or its own clock from its start.
  std::uint64_t link_time(kernel::Time now) const;

 protected:
  struct Token {
    FfDlpdu by;
    kernel::Time ends;
  };
  struct Place {
    kernel::Time begin;
    kernel::Time end;
  };
  struct Buffer {
    Octets data;
    std::uint8_t writes = 0;
    bool is_written = false;
  };
  struct Answer {
    FfDlpdu dlpdu;
    kernel::Time until;
  };
  using Queues = LinkQueues<FfRequest>;

  const FfConfiguration& configuration() const { return configuration_; }
  const FfRules& rules() const { return configuration_.rules; }
  FfUser& user() { return *user_; }
  LineEnd& line() { return line_; }
  const LineEnd& line() const { return line_; }
  const std::optional<Token>& token() const { return token_; }
  kernel::Duration octet_times(std::int64_t count) const { return octets(rules().link, count); }

  // ---- decisions ----
  virtual bool are_impossible() const { return impossible(rules()).has_value(); }
  virtual std::vector<Arrived> heard_in(const line::Waveform& reception) { return line_.receive(reception); }
  virtual std::optional<FfDlpdu> understood(std::span<const std::uint8_t> octets) const;
  virtual bool is_mine(std::uint8_t node) const { return node == configuration_.node; }
  virtual kernel::Duration silence_before_sending() const;
  virtual kernel::Time may_begin() const;
  virtual kernel::Time token_end(const FfDlpdu& pt, const Place& place) const;
  virtual bool may_send(Priority priority, Priority least) const { return priority >= least; }
  virtual std::optional<Priority> next_to_send(const Queues& queues, Priority least) const;
  virtual kernel::Duration needed_for(const FfDlpdu& dlpdu) const;
  virtual bool fits(const FfDlpdu& dlpdu, kernel::Time begin) const;
  virtual bool returns_by_rt(bool has_sent_final) const { return !has_sent_final; }
  virtual kernel::Time answer_until(const Place& place) const {
    return place.end + response_delay(rules().link);
  }
  virtual bool answers_probe() const { return true; }
  virtual FfDlpdu published(FfAddress address, Buffer& buffer);
  virtual bool is_too_long(Priority priority, std::size_t octets) const;
  virtual Octets written(const FfDlpdu& dlpdu) const { return octets_of(dlpdu, rules()); }
  virtual kernel::Time put_on_line(const Octets& octets, kernel::Time now);
  virtual void on_dlpdu(const FfDlpdu& dlpdu, const Place& place);

  // ---- actions ----
  kernel::Time transmit(const FfDlpdu& dlpdu, kernel::Time now);
  virtual void tell(FfEventKind kind, std::uint8_t node, kernel::Time now) {
    user_->on_event({kind, node}, now);
  }
  void enter(FfState state) { state_ = state; }
  void answer(const FfDlpdu& dlpdu, const Place& place);
  virtual void use_token(kernel::Time now);
  void drop_token() { token_.reset(); }
  virtual void on_spdu(const FfDlpdu& dlpdu, kernel::Time now);
  FfDlpdu dt1_of(const FfRequest& request) const;
  Queues& queues() { return to_send_; }
  const Queues& queues() const { return to_send_; }
  Buffer* buffer_of(FfAddress address);
  bool may_begin_now(kernel::Time now) const { return may_begin() <= now; }
  void set_link_time(std::uint64_t ticks, kernel::Time now);
  // The instant at which link time is this; at most 10^11 ticks, some weeks, from when it was told.
  kernel::Time instant_of(std::uint64_t ticks) const;

 private:
  void on_data(const FfDlpdu& dlpdu, kernel::Time now);
  void send_answer(kernel::Time now);

  FfConfiguration configuration_;
  LineEnd line_;
  FfUser* user_ = nullptr;
  FfState state_ = FfState::stopped;
  Queues to_send_;
  std::map<FfAddress, Buffer> buffers_;
  std::set<FfAddress> subscribed_;
  std::optional<Token> token_;
  std::optional<Answer> answer_;
  FfState behind_answer_ = FfState::offline;
  // When link time was what, last.
  kernel::Time told_at_ = kernel::kStart;
  std::uint64_t told_time_ = 0;
};

}  // namespace fieldproof::fieldbus_dll
