#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "protocols/fieldbus_dll/isa_device.hpp"
#include "protocols/fieldbus_dll/line_end.hpp"

// The reference data link entity of the profile ISA-D.
//
//   idle ──ET, ES──▶ holding ──nothing, no time, single frame done: EE──▶ idle
//     │                │  ▲                └──VC(RD) = 0: silence──▶ idle
//     │               CD  │ the reply, or VC(RR) = 0
//     │                ▼  │
//     │           awaiting_reply ──another DLPDU: the token is dropped──▶ idle
//     └──CD──▶ replying ──DT, or VC(FD) = 0: silence──▶ idle
//
// It keeps V(MID) of silence after whatever was on the line. VC(RR) that runs out while others are active
// waits for the end of that activity. What a scheduler sends while a token is held shows that it was taken
// back, and whatever is sent before a reply, that nobody waits for it any more.
//
// Every decision that a wrong implementation takes otherwise has a name and can be overridden one by one.
namespace fieldproof::fieldbus_dll {

enum class DleState : std::uint8_t { idle, holding, awaiting_reply, replying };

class IsaDle : public IsaDevice {
 public:
  explicit IsaDle(const IsaConfiguration& configuration);

  void wire(segment::Port& line, IsaUser& user) override;
  bool start(kernel::Time now) override;
  void stop(kernel::Time now) override;
  bool submit(const IsaRequest& request, kernel::Time now) override;

  void receive(segment::PortIndex port, const line::Waveform& reception) override;
  void on_activity(segment::PortIndex port, bool begins, kernel::Time now) override;
  void on_time(kernel::Time now) override;
  kernel::Time next_time() const override;

  DleState state() const { return state_; }
  std::uint8_t address() const { return configuration_.address; }

 protected:
  // A delegated token.
  struct Token {
    IsaDlpdu by;        // the ET or ES
    kernel::Time ends;  // VC(RD) = 0; kNever of an ET
    bool is_used = false;
  };
  // Where a DLPDU was on the line.
  struct Place {
    kernel::Time begin;
    kernel::Time end;
  };
  using Queues = LinkQueues<IsaRequest>;

  const IsaConfiguration& configuration() const { return configuration_; }
  const IsaRules& rules() const { return configuration_.rules; }
  IsaUser& user() { return *user_; }
  LineEnd& line() { return line_; }
  const LineEnd& line() const { return line_; }
  const std::optional<Token>& token() const { return token_; }
  kernel::Duration octet_times(std::int64_t count) const { return octets(rules().link, count); }

  // ---- decisions ----
  virtual std::vector<Arrived> heard_in(const line::Waveform& reception) { return line_.receive(reception); }
  virtual std::optional<IsaDlpdu> understood(std::span<const std::uint8_t> octets) const;
  virtual bool is_meant(const IsaDlpdu& dlpdu) const;
  virtual bool is_delivered(const IsaDlpdu& dlpdu) const;
  virtual kernel::Duration silence_before_sending() const;
  // When it may begin to send; kNever while others are active.
  virtual kernel::Time may_begin() const;
  // VC(RR) that runs out while a reply may be on the line waits for its end.
  virtual bool lets_a_reply_end() const { return true; }
  virtual Octets written(const IsaDlpdu& dlpdu) const { return octets_of(dlpdu, rules()); }
  virtual kernel::Time put_on_line(const Octets& octets, kernel::Time now);
  virtual kernel::Time token_end(const IsaDlpdu& es, const Place& place) const;
  virtual bool may_send(Priority priority, Priority least) const { return priority >= least; }
  virtual std::optional<Priority> next_to_send(const Queues& queues, Priority least) const;
  virtual bool is_single(const IsaDlpdu& token) const { return token.type == IsaType::et; }
  // A frame that would begin now ends in time, with all that must follow it.
  virtual bool fits(const IsaRequest& request, kernel::Time now) const;
  virtual kernel::Duration needed_for(const IsaRequest& request) const;
  virtual bool returns_token(EndReason, kernel::Time now) const;
  virtual kernel::Duration reply_wait() const { return octet_times(rules().reply_wait_octets); }
  virtual kernel::Duration reply_forming() const { return octet_times(rules().reply_forming_octets); }
  virtual bool waits_for_user(Priority least, kernel::Time now) { return user_->is_reply_coming(least, now); }
  virtual bool is_expected_reply(const IsaDlpdu& dlpdu) const;
  virtual bool is_too_long(const IsaRequest& request) const;
  virtual bool are_impossible() const { return impossible(rules()).has_value(); }
  virtual void on_dlpdu(const IsaDlpdu& dlpdu, const Place& place);

  // ---- actions ----
  kernel::Time transmit(const IsaDlpdu& dlpdu, kernel::Time now);
  virtual void tell(IsaEventKind kind, std::uint8_t node, kernel::Time now) {
    user_->on_event({kind, node}, now);
  }
  void deliver(const IsaDlpdu& dlpdu, kernel::Time now);
  // Sends a request of this station's; a CD makes it wait for the reply.
  virtual void send(const IsaRequest& request, kernel::Time now);
  void take_token(const IsaDlpdu& dlpdu, const Place& place);
  virtual void use_token(kernel::Time now);
  virtual void end_token(EndReason reason, kernel::Time now);
  void drop_token() { token_.reset(); }
  void begin_reply(const IsaDlpdu& cd, kernel::Time cd_end);
  void reply(kernel::Time now);
  virtual void on_reply_wait_over(kernel::Time now);
  // Where it goes when it waits for no reply any more.
  virtual void resume(kernel::Time now);
  void enter(DleState state) { state_ = state; }
  bool may_begin_now(kernel::Time now) const { return may_begin() <= now; }
  Queues& queues() { return to_send_; }
  const Queues& queues() const { return to_send_; }

 private:
  struct Awaited {
    std::uint8_t node;
    kernel::Time until;  // VC(RR) = 0
  };
  struct Compelled {
    IsaDlpdu by;
    kernel::Time until;  // VC(FD) = 0
    bool waits_for_user = false;
  };

  bool must_wait_for_reply() const { return line_.hears_activity() && lets_a_reply_end(); }
  bool has_reply() const;
  void end_reply();

  IsaConfiguration configuration_;
  LineEnd line_;
  IsaUser* user_ = nullptr;
  bool is_stopped_ = false;
  DleState state_ = DleState::idle;
  Queues to_send_;
  Queues replies_;
  std::optional<Token> token_;
  std::optional<Awaited> awaited_;
  std::optional<Compelled> compelled_;
};

}  // namespace fieldproof::fieldbus_dll
