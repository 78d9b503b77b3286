#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "protocols/fieldbus_dll/isa_dle.hpp"

// The reference link master of the profile ISA-D: the link active scheduler (LAS), or a station that a TL can
// make it.
//
//   standby ──TL──▶ scheduling ──ET──▶ awaiting_single ───EE, or VC(RR) = 0──▶ scheduling
//      ▲               │    └────ES──▶ awaiting_sequence ─EE, VC(RR) = 0 before anything, VC(UC) = 0─┘
//      │               TL
//      │               ▼
//      └─the heir─ transferring ──VC(RR) = 0: not taken──▶ scheduling
//
// Another one that acts as a scheduler makes it leave when that has the lower address. Between the items of
// the schedule it sends what its own user has submitted, where that ends in time.
//
// Of a single frame only VC(RR) tells that the holder is lost. It runs anew after whatever is heard, and
// twice as long after a CD of the holder, who waits as long for its reply.
namespace fieldproof::fieldbus_dll {

enum class LasState : std::uint8_t { standby, scheduling, awaiting_single, awaiting_sequence, transferring };

class IsaLas : public IsaDle {
 public:
  explicit IsaLas(const IsaConfiguration& configuration);

  bool start(kernel::Time now) override;
  void stop(kernel::Time now) override;
  bool order_transfer(std::uint8_t node, kernel::Time now) override;
  bool submit(const IsaRequest& request, kernel::Time now) override;

  void on_activity(segment::PortIndex port, bool begins, kernel::Time now) override;
  void on_time(kernel::Time now) override;
  kernel::Time next_time() const override;

  LasState las_state() const { return state_; }

 protected:
  std::uint8_t holder() const { return holder_; }

  // ---- decisions ----
  void on_dlpdu(const IsaDlpdu& dlpdu, const Place& place) override;
  virtual bool is_from_holder(const IsaDlpdu& dlpdu) const { return dlpdu.source == holder_; }
  virtual bool yields_to(const IsaDlpdu& other) const { return other.source < address(); }
  virtual bool shows_transfer(const IsaDlpdu& dlpdu) const { return dlpdu.source == *heir_; }
  virtual bool retakes() const { return true; }
  virtual void on_transferred(kernel::Time now);
  virtual kernel::Time supervision_end(const IsaScheduleItem& item, kernel::Time es_end) const;
  virtual kernel::Time response_end(kernel::Time from) const { return from + reply_wait(); }
  virtual bool reclaims_while_busy() const { return false; }
  // The holder waits for a reply itself before it says anything.
  virtual kernel::Time response_end_behind_cd(kernel::Time from) const {
    return response_end(response_end(from));
  }
  virtual kernel::Time due(const IsaScheduleItem& item) const { return begin_ + item.at; }
  virtual void advance();
  virtual bool shows_itself() const { return true; }

  // ---- actions ----
  void delegate(const IsaScheduleItem& item, kernel::Time now);
  void take_scheduler(const IsaDlpdu& tl, kernel::Time now);
  void leave(std::uint8_t other, kernel::Time now);
  void enter_las(LasState state);

 private:
  void on_holder(const IsaDlpdu& dlpdu, kernel::Time now);
  void schedule(kernel::Time now);
  bool send_own(kernel::Time now);
  void transfer(kernel::Time now);
  void show_itself(kernel::Time now);
  void on_timer(kernel::Time now);
  void reclaim(IsaEventKind kind, kernel::Time now);
  bool is_awaiting() const;
  kernel::Time timer() const;
  const IsaScheduleItem* next_item() const;

  LasState state_ = LasState::standby;
  kernel::Time begin_{};                          // of the schedule
  std::size_t next_ = 0;                          // item of it
  kernel::Time own_not_before_ = kernel::kStart;  // its user's requests: the next item comes first
  bool has_shown_itself_ = true;
  std::uint8_t holder_ = 0;
  bool is_single_used_ = false;
  kernel::Time response_until_ = kernel::kNever;     // VC(RR) of a token or of a transfer
  kernel::Time supervision_until_ = kernel::kNever;  // VC(UC)
  std::optional<std::uint8_t> ordered_heir_;
  std::optional<std::uint8_t> heir_;
};

}  // namespace fieldproof::fieldbus_dll
