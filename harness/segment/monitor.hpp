#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "harness/kernel/time.hpp"
#include "harness/segment/medium.hpp"
#include "harness/segment/station.hpp"
#include "harness/trace/trace.hpp"

// An always-on monitor of one line: it sees every transmission and notes what no participant may do, whatever
// a test case looks at. Put it on what is driven into a link (`Link::tap_driven`), or on a place of a medium
// (`MediumPort::tap_arrived`, and `Medium::watch` for contention).
//
// Contract: transmissions come in order of their start; one that is known only after a later one may lie in
// the silence in front of that, and then no pause is judged. Each violation becomes an observation of the
// trace (value: how long or how many) and enters a list that is bounded; all are counted. A judge reads them
// at the end of a case, after `finish`.
namespace fieldproof::segment {

struct MonitorRules {
  // Silence between two transmissions, and from the last one to `finish`. Before the first nothing is asked.
  std::optional<kernel::Duration> longest_silence;
  // An overlap of no more is none: it comes from instants that were rounded.
  kernel::Duration rounding{};
  // A gap that is not zero (transmissions that follow without a gap are one).
  std::optional<kernel::Duration> shortest_gap;
  // Babble: transmissions that follow each other without a gap, together; told once per such run.
  std::optional<kernel::Duration> longest_drive;
  // Babble: at most so many transmissions may begin within any window of this length (first instant included,
  // last not).
  std::size_t most_transmissions = 0;  // 0: no limit
  kernel::Duration window{};
};

enum class ViolationKind : std::uint8_t { overlap, long_silence, short_gap, long_drive, too_many };

inline constexpr std::array kViolationKinds = {ViolationKind::overlap, ViolationKind::long_silence,
                                               ViolationKind::short_gap, ViolationKind::long_drive,
                                               ViolationKind::too_many};

// The observation's name: "monitor: overlap" ...
std::string_view text_of(ViolationKind kind);

struct Violation {
  ViolationKind kind;
  kernel::Time time;          // of the transmission at which it was seen; of `finish`
  kernel::Duration measured;  // overlap, silence, gap, drive; too_many: what the transmissions began within

  friend bool operator==(const Violation&, const Violation&) = default;
};

class LineMonitor final : public Tap, public ContentionWatcher {
 public:
  static constexpr std::size_t kKept = 64;

  // Observations are made at `place`. A window without a limit, or the other way round, is a broken
  // invariant.
  LineMonitor(const MonitorRules& rules, trace::Trace& trace, trace::Channel place);

  void on_wave(const line::Waveform& wave) override;
  // Counts contention at its own place only.
  void on_contention(const Contention& contention) override;
  // The end of the case: judges the silence until then.
  void finish(kernel::Time now);

  // The first kKept violations, in the order in which they were seen.
  const std::vector<Violation>& violations() const { return violations_; }
  std::uint64_t count() const { return count_; }
  // A transmission with a change of level: a driver that is on, and no more, says nothing.
  bool has_seen() const { return has_changed_; }

 private:
  kernel::Time end_of(const line::Waveform& wave);
  bool is_before_the_last(kernel::Time start, kernel::Time end) const;
  void check_pause(kernel::Time start);
  void check_drive(kernel::Time start, kernel::Time end);
  void check_number(kernel::Time start);
  void note(ViolationKind kind, kernel::Time time, kernel::Duration measured);

  MonitorRules rules_;
  trace::Trace& trace_;
  trace::Channel place_;
  bool has_heard_ = false;
  bool has_changed_ = false;
  kernel::Time heard_until_{};
  kernel::Time last_since_{};    // the last transmission,
  kernel::Time before_until_{};  // and the end of what was in front of it
  kernel::Time drive_since_{};
  bool is_drive_told_ = false;
  std::vector<kernel::Time> begins_;  // the last ones, a ring
  std::size_t oldest_ = 0;            // of them, when it is full
  std::int64_t known_rate_ = 0;
  kernel::Duration level_{};  // at that rate; zero when it is no whole number of picoseconds
  std::vector<Violation> violations_;
  std::uint64_t count_ = 0;
};

}  // namespace fieldproof::segment
