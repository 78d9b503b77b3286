#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "harness/iut/device.hpp"
#include "harness/iut/misbehaviour.hpp"

// One case of an implementation outside that takes the place of a station of the bench, in any role: it is
// called as long as it keeps to the contract, and what it does is held to what can be at all.
//
// Instants of acts are now or later, and at most an hour ahead; a drive lasts at most 10 s. What cannot be
// throws Misbehaviour(kImpossible) out of the call; one that did wrong once is not called again.
namespace fieldproof::iut {

// A device for one case and what is to be done after it.
struct Attachment {
  Device* device = nullptr;
  std::shared_ptr<void> lease;            // keeps the device
  std::function<void()> on_well_ended{};  // the case has ended as it should
  // It plays in a network that bursts disturb, and no case judges how it receives: whoever is given more than
  // levels is given what a right receiver in front of it makes of them.
  bool is_in_network = false;
};

inline constexpr kernel::Duration kLongestDrive = 10 * kernel::kSecond;

[[noreturn]] void refuse_impossible(const std::string& sentence);

// A setting by its name; `absent` where there is none.
std::int64_t setting(const CaseBegin& begin, std::string_view name, std::int64_t absent);

class AttachedCase {
 public:
  explicit AttachedCase(Attachment attachment) : attachment_(std::move(attachment)) {}
  ~AttachedCase();
  AttachedCase(const AttachedCase&) = delete;
  AttachedCase& operator=(const AttachedCase&) = delete;

  // `bench` is where the implementation acts. Throws Misbehaviour when it refuses the case.
  void begin(const CaseBegin& begin, Bench& bench);
  void set_power(bool is_on, kernel::Time now);
  void on_time(kernel::Time now);
  // Within a call: `device` is told that its time has come. A flood when it asked for that too often.
  void tell_time(Device& device, kernel::Time now);
  kernel::Time next_time() const;
  // The case is over. Once; nothing when the implementation did wrong before.
  void end();

  template <typename Call>
  void call(kernel::Time now, Call&& call) {
    if (!is_well_) return;
    is_well_ = false;
    now_ = now;
    try {
      call(*attachment_.device);
    } catch (const CannotBeDone&) {
      is_well_ = true;  // the case asks for too much, and it has done no wrong
      throw;
    }
    is_well_ = true;
  }
  Capabilities capabilities() const { return attachment_.device->capabilities(); }
  UnitKind unit_kind() const { return attachment_.device->unit_kind(); }
  bool is_in_network() const { return attachment_.is_in_network; }
  // It has done nothing wrong yet.
  bool is_well() const { return is_well_; }
  bool hears_levels() const { return unit_kind() == UnitKind::levels; }
  kernel::Time now() const { return now_; }

  // ---- what the implementation does ----
  void expect_supplied() const;
  // `does`: "reads its limit switches".
  void expect_ahead(kernel::Time when, std::string_view does) const;
  // The same, and it counts as one of the acts of the case.
  void expect_act(kernel::Time when, std::string_view does);
  // The same for what is not done earlier than the last of its kind.
  void expect_in_order(kernel::Time when, std::string_view does);
  void expect_drive(const line::Waveform& wave);
  // Together with all that it has driven in this case.
  void expect_drive(kernel::Time begin, kernel::Time end, const std::function<std::string()>& describe);
  void expect_span(kernel::Time begin, kernel::Time end, const std::function<std::string()>& describe) const;

 private:
  bool is_within_reach(kernel::Time when) const;
  void expect_time_to_pass() const;
  void count_act();

  Attachment attachment_;
  kernel::Time now_{};                                     // as the implementation was told it
  kernel::Time counted_from_{};                            // the calls of on_time
  unsigned calls_ = 0;                                     // since then
  kernel::Duration driven_{};                              // on all lines
  std::int64_t acts_ = 0;                                  // drives and moves
  std::int64_t levels_ = 0;                                // of drives
  std::map<std::string, kernel::Time, std::less<>> last_;  // of each kind
  bool has_begun_ = false;
  bool is_supplied_ = false;
  bool is_well_ = true;
  bool has_ended_ = false;
};

}  // namespace fieldproof::iut
