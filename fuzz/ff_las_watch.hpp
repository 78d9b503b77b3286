#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "fuzz/link_line.hpp"
#include "protocols/fieldbus_dll/ff_device.hpp"

// What a link active scheduler of the profile FF-P may never do, whatever comes from others. Each of these is
// an invariant that ends the program when it is broken:
//
//   V(MID) of silence stands in front of each of its frames;
//   it is silent while a token, a CD or a probe of its own is out: until the token returns or is over, an
//   answer has come, or the line has been silent for V(MRD) x V(ST); each item of the schedule gets its CD,
//   in its order, not before it is due, and at that instant when the line was silent for V(MRD) x V(ST);
//   whatever else it says ends, with the token or the answer, V(MSO) before the next item;
//   tokens are for V(DMDT) to V(DTHT), for live nodes only; who has let three go by gets none;
//   the priority of tokens changes by one step at most, and only where a circulation begins;
//   probes are for nodes that are not live, outside of what is unpolled.
//
// When another may have become the scheduler only the first is held, until it claims the link.
namespace fieldproof::fuzz {

class FfLasWatch final : public segment::Tap {
 public:
  explicit FfLasWatch(const fieldbus_dll::FfConfiguration& configuration);

  // Others begin to drive.
  void on_begin(kernel::Time now);
  // What arrived; they have ended.
  void on_wave(const line::Waveform& wave) override;
  void on_said(const LinkSaid& said);

 private:
  enum class Asks : std::uint8_t { token, data, probe, transfer };
  struct Question {
    Asks asks;
    std::uint8_t node;
    kernel::Time end;
    kernel::Time token_ends;  // kNever: of anything else
    bool may_be_answered = false;
  };
  static constexpr unsigned kNodes = 256;

  kernel::Duration times(std::int64_t octets) const;
  kernel::Time end_of(const LinkSaid& said) const;
  kernel::Time due() const;
  void close_question(kernel::Time now);
  void check_cd(const LinkSaid& said);
  void check_token(const LinkSaid& said);
  void check_probe(const LinkSaid& said);
  void check_room(kernel::Time end) const;

  fieldbus_dll::FfConfiguration configuration_;
  bool is_line_busy_ = false;
  kernel::Time heard_until_ = kernel::kStart;
  kernel::Time driven_until_ = kernel::kStart;
  bool is_scheduler_ = true;    // surely
  bool knows_schedule_ = true;  // nobody else has told the time
  bool is_asked_for_time_ = false;
  std::optional<Question> question_;
  std::array<bool, kNodes> may_be_live_{};
  std::array<bool, kNodes> is_surely_live_{};
  std::array<unsigned, kNodes> misses_{};
  std::optional<unsigned> priority_;
  unsigned probes_ = 0;  // since the last token
  std::uint64_t items_done_ = 0;
};

}  // namespace fieldproof::fuzz
