#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "harness/kernel/random.hpp"
#include "protocols/token_bus/device.hpp"
#include "protocols/token_bus/line_side.hpp"

// The reference station of the token bus: the access control machine of IEEE 802.4.
//
//   offline ──start──▶ idle ──bus idle: claims──▶ claim_token ──all passes silent──▶ use_token
//   idle ──token──▶ use_token ──queues empty or time over──▶ check_access_class ──all done──▶ pass_token
//   pass_token ──token sent──▶ check_token_pass ──a frame──▶ idle; silence──▶ pass_token, the next stage
//   pass_token ──window opened──▶ await_response ──set_successor──▶ pass_token
//   use_token ──request with response──▶ await_ifm_response ──response──▶ use_token
//   idle ──window with its address──▶ demand_delay ──▶ demand_in ──token──▶ use_token
//
// The states keep the standard's names and numbers. check_access_class and pass_token take no time here: what
// is to be sent waits for the gap, in the state that follows.
//
// A transmission begins the response gap after the line fell silent, at the earliest; each is one frame, and
// says that no other follows in it.
//
// Every decision that a wrong implementation takes otherwise has a name and can be overridden one by one.
namespace fieldproof::token_bus {

enum class AccessState : std::uint8_t {
  offline,
  idle,
  demand_in,
  demand_delay,
  claim_token,
  use_token,
  await_ifm_response,
  check_access_class,
  pass_token,
  check_token_pass,
  await_response
};
std::string_view text_of(AccessState state);

class TokenStation : public StationDevice {
 public:
  explicit TokenStation(const StationConfiguration& configuration);

  void wire(segment::Port& line, StationUser& user) override;
  bool start(kernel::Time now) override;
  void stop(kernel::Time now) override;
  bool submit(const DataRequest& request, kernel::Time now) override;
  void set_in_ring_desired(bool is_desired, kernel::Time now) override;
  void set_response(const Octets& data, kernel::Time now) override;
  Counters counters() const override { return counters_; }

  void receive(segment::PortIndex port, const line::Waveform& reception) override;
  void on_activity(segment::PortIndex port, bool begins, kernel::Time now) override;
  void on_time(kernel::Time now) override;
  kernel::Time next_time() const override;

  AccessState state() const { return state_; }
  Address address() const { return configuration_.address; }
  bool is_in_ring() const { return is_in_ring_; }
  Address successor() const { return successor_; }
  Address predecessor() const { return predecessor_; }

 protected:
  using Time = kernel::Time;
  using Duration = kernel::Duration;
  // What follows silence after a token, one after the other.
  enum class PassStage : std::uint8_t { token, who_follows, solicit_any, failed };
  enum class NoiseAfterToken : std::uint8_t { wait_on, success, failure };

  const Rules& rules() const { return configuration_.rules; }
  StationUser& user() { return *user_; }
  LineSide& line() { return line_; }
  const LineSide& line() const { return line_; }
  kernel::Random& random() { return random_; }
  virtual bool wants_ring() const;

  // ---- decisions: reception ----
  virtual std::vector<Reception> received(const line::Waveform& wave) const {
    return FrameReader(rules()).read(wave);
  }
  virtual std::optional<Frame> understood(const Octets& octets) const { return frame_of(octets, rules()); }
  virtual bool is_duplicate(const Frame& frame) const { return frame.source == address(); }
  virtual bool is_for_me(const Frame& frame) const {
    return frame.destination == address() || is_group(frame.destination);
  }
  virtual void count(ReceptionKind kind);
  virtual Frame response_to(const Frame& request, const Octets& data) const;
  // ---- decisions: supply ----
  virtual bool forgets_ring() const { return true; }

  // ---- decisions: initialisation ----
  virtual unsigned bus_idle_slots() const;
  // The two bits of the address that pass number `pass` of a contest looks at; random ones in the last.
  virtual unsigned claim_bits(unsigned pass) { return contest_bits(pass); }
  virtual unsigned claim_slots(unsigned bits) const { return 2 * bits; }
  virtual unsigned claim_passes() const { return contest_passes(rules()); }
  virtual bool is_alone_after_claim() const { return true; }
  virtual bool loses_claim() const { return line_.is_active(); }

  // ---- decisions: joining ----
  // The window, from 0, in which a solicitation may be answered.
  virtual std::optional<unsigned> window_of(const Frame& solicitation) const;
  virtual Duration window_delay(unsigned window) const { return slots(rules(), window); }
  virtual unsigned demand_bits(unsigned pass) { return contest_bits(pass); }
  virtual unsigned demand_slots(unsigned bits) const { return 3 - bits; }
  virtual bool yields_in_delay() const { return true; }
  virtual bool forgets_offer() const { return true; }
  virtual bool follows(const Frame& who_follows) const {
    // Who is alone follows nobody.
    return is_in_ring_ && predecessor_ != address() && address_of(who_follows.data) == predecessor_;
  }

  // ---- decisions: holding ----
  // How many of its class go before it.
  virtual std::size_t place_of(const DataRequest&, const std::deque<DataRequest>& waiting) const {
    return waiting.size();
  }
  virtual void on_token_taken(Time) {}
  // How long a class is served from now on; the first is 6. Its timer begins anew.
  virtual Duration hold_time(unsigned place, Time now);
  virtual bool may_begin(unsigned /*place*/, Time begin) const { return begin < hold_until_; }
  virtual line::Levels written(const Frame& frame, Time begin) const;
  // Of what is due then: a station that is in time may still begin later.
  virtual Time begin_of(const Frame&, Time due) const { return due; }
  virtual bool drops_token_on(const Frame&) const { return true; }
  virtual unsigned request_repetitions() const { return rules().max_retry_limit; }

  // ---- decisions: passing ----
  virtual bool opens_window(Time now);
  // Asked of a station in a ring that is fast enough: `count` tokens are still to go by.
  virtual bool is_window_due(unsigned count) { return count == 0; }
  virtual unsigned drawn_count_bits() { return static_cast<unsigned>(random_.below(4)); }
  virtual bool is_lowest() const { return successor_ > address(); }
  virtual PassStage stage_after(unsigned attempts) const;
  virtual NoiseAfterToken noise_after_token() const { return NoiseAfterToken::wait_on; }
  virtual bool resolves(unsigned passes) const { return passes < contest_passes(rules()); }
  virtual Frame leaving_frame() const;
  virtual Address answered_with() const { return address(); }
  virtual unsigned windows_of(FrameKind kind) const;
  virtual bool forgives_failures() const { return true; }
  virtual void on_pass_failed(Time now);
  virtual bool takes_successor(const Frame& frame) const { return frame.destination == address(); }

  unsigned contest_bits(unsigned pass);
  void drop_data() {
    for (auto& queue : queues_) queue.clear();
  }
  Duration residual(unsigned place, Time now) const { return rotation_until_.at(place) - now; }
  void reload(unsigned place, Time now);
  Time hold_until() const { return hold_until_; }
  const std::deque<DataRequest>& queue(unsigned place) const { return queues_.at(place); }

 private:
  struct Pending {
    Frame frame;
    Time earliest;
    bool waits_for_silence;
  };

  // ---- entry points of the machine ----
  void on_frame(const Frame& frame, Time end);
  void on_noise(Time end);
  void on_notice(Time now);
  void on_deadline(Time now);
  void on_sent(FrameKind kind, Time end);
  void report(EventKind kind, Address address, Time now) { user_->on_event({kind, address}, now); }
  void enter(AccessState state, Time deadline = kernel::kNever);
  void go_idle() { enter(AccessState::idle); }
  void go_offline();
  void send(const Frame& frame, Time earliest, bool waits_for_silence = true);
  Time pending_due() const;
  // Of a transmission that is decided on now, where others leave the line alone.
  Time earliest_begin(Time now) const;
  Time idle_due() const;
  void send_pending(Time now);
  Frame control(FrameKind kind, Address destination, std::optional<Address> data = std::nullopt) const;
  Frame data_frame(const DataRequest& request) const;

  // ---- listening ----
  void on_idle_frame(const Frame& frame, Time end);
  void on_demand_frame(const Frame& frame, Time end);
  void on_solicitation(const Frame& frame, Time end);
  void on_indication(const Frame& frame, Time end);
  void answer(Address destination, Time window_begin);
  void set_successor(Address successor, Time now);

  // ---- claiming ----
  void claim(Time now);
  void claim_goes_on(Time now);

  // ---- holding ----
  void take_token(Address from, Time now);
  void hold_token(Time now);
  void serve(Time now);
  void send_request(Time now);
  void on_holding_frame(const Frame& frame, Time end);
  void on_response_frame(const Frame& frame, Time end);
  void on_response_missing(Time now);
  void drop_token(const Frame& frame, Time end);

  // ---- passing ----
  void pass(Time now);
  void leave(Time now);
  void open_window(Time now);
  void send_token(Time now);
  void next_stage(Time now);
  void solicit(FrameKind kind, Time now);
  void on_await_frame(const Frame& frame, Time end);
  void on_contention(Time end);
  void on_window_over(Time now);
  void on_pass_success(const Frame& frame, Time end);

  StationConfiguration configuration_;
  LineSide line_;
  kernel::Random random_;
  StationUser* user_ = nullptr;
  AccessState state_ = AccessState::offline;
  Time deadline_ = kernel::kNever;
  std::optional<Pending> pending_{};
  Counters counters_{};

  // The host.
  bool is_desired_;
  std::array<std::deque<DataRequest>, kAccessClasses> queues_{};  // of 6, 4, 2, 0
  std::optional<Octets> response_{};

  // The ring.
  bool is_in_ring_ = false;
  Address successor_;
  Address predecessor_;
  std::optional<Address> offered_successor_{};  // by the solicitation that was answered
  unsigned inter_solicit_count_ = 0;
  unsigned failures_ = 0;

  // A contest: the pass of a claim, of a demander, of a resolver.
  unsigned contest_pass_ = 0;
  Address demanded_of_ = 0;

  // The token.
  unsigned place_ = 0;  // of the class that is served
  Time hold_until_ = kernel::kStart;
  std::array<Time, kAccessClasses> rotation_until_{};  // of 4, 2, 0 at 1 to 3, of ring maintenance at 0
  unsigned repetitions_ = 0;
  unsigned attempts_ = 0;  // of this pass
  bool is_leaving_ = false;
  bool is_noise_after_token_ = false;
  FrameKind awaited_by_ = FrameKind::token;  // the frame that opened the windows
};

}  // namespace fieldproof::token_bus
