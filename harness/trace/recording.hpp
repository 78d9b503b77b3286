#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "harness/trace/trace.hpp"

// What happened in one run, as data: what people read (trace.txt, timeline.json) and what other programs
// open (pcapng, VCD) is written from it.
//
// Contract: records stand in the order in which they were told, which is that of virtual time but for faults,
// told when a transmission arrives, and for transmissions that were given ahead of their time. The last
// records are kept, because a run ends with what went wrong: within the recorder's bounds, without a hole,
// and `is_cut` says that there was more before.
namespace fieldproof::trace {

struct Transmission {
  Channel channel = 0;
  line::Waveform wave{};              // as it was driven
  std::optional<std::size_t> change;  // of Recording::changes: what its receiver got instead
};

struct Fault {
  Channel channel = 0;
  kernel::Time time{};
  std::string text;
};

struct Observation {
  Channel channel = 0;
  kernel::Time time{};
  std::string what;
  std::uint64_t value = 0;
};

using Record = std::variant<Transmission, Fault, Observation>;

Channel channel_of(const Record& record);
kernel::Time time_of(const Record& record);

// A receiver got something else than what was sent: nothing when it was lost, several when it was repeated
// or torn. On a link the receiver's channel is that of the transmission, which names the change; on a medium
// each receiver has its own.
struct Change {
  Channel channel = 0;
  line::Waveform sent{};  // as it would have arrived
  std::vector<line::Waveform> arrivals;
};

// "levels 17, 18 changed", "lost", "2.000 us late"; one clause, for people.
std::string describe(const Change& change);

// From here on the case does this.
struct Step {
  kernel::Time time{};
  std::string text;  // "2 of 5: the node is polled again"
};

struct Recording {
  std::vector<std::string> channels;  // names by number
  std::vector<Record> records;
  std::vector<Change> changes;
  std::vector<Step> steps{};  // in order of time
  bool is_cut = false;
};

// Which faults belong to a change: those on its channel while what was sent arrived.
class FaultIndex {
 public:
  // The recording must outlive the index.
  explicit FaultIndex(const Recording& recording);

  std::vector<const Fault*> of(const Change& change) const;

 private:
  std::map<Channel, std::vector<const Fault*>> faults_;  // in order of time
};

// Keeps a recording of the trace that it is set at. The trace must outlive what it is told.
//
// It keeps two parts of at most half the bounds each and forgets the older one when the newer one is full: of
// a long run at least half of what the bounds allow, for the price of a move now and then.
class BoundedRecorder final : public Recorder {
 public:
  static constexpr std::size_t kMostRecords = 20'000;
  static constexpr std::size_t kMostLevels = std::size_t{1} << 28;  // 32 MiB

  explicit BoundedRecorder(const Trace& trace, std::size_t most_records = kMostRecords,
                           std::size_t most_levels = kMostLevels)
      : trace_(trace), part_records_(most_records / 2), part_levels_(most_levels / 2) {}

  void on_driven(Channel channel, const line::Waveform& wave) override;
  void on_fault(Channel channel, kernel::Time time, std::string_view what) override;
  void on_observation(Channel channel, kernel::Time time, std::string_view what,
                      std::uint64_t value) override;
  void on_changed(Channel receiver, kernel::Time driven_at, const line::Waveform& sent,
                  std::span<const line::Waveform> arrivals) override;
  void on_step(kernel::Time time, std::string_view text) override;

  // What was kept; the recorder is empty then. The trace need not be there any more.
  Recording take();

 private:
  struct Part {
    std::vector<Record> records;
    std::vector<Change> changes;
    std::vector<Step> steps;
    std::size_t levels = 0;
    std::map<std::pair<Channel, kernel::Time>, std::size_t> driven;  // the last transmission of a start

    line::Waveform kept(const line::Waveform& wave);
  };

  // Room for one more record of so many levels; false when they are more than a part may hold.
  bool make_room(std::size_t levels);
  void add(Record record);
  void forget_older();

  const Trace& trace_;
  std::size_t part_records_;
  std::size_t part_levels_;
  std::vector<std::string> channels_;
  Part older_;
  Part newer_;
  bool is_cut_ = false;
};

}  // namespace fieldproof::trace
