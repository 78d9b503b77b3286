#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "harness/kernel/random.hpp"
#include "harness/kernel/scheduler.hpp"
#include "harness/segment/earliest_due.hpp"
#include "harness/segment/receiver.hpp"
#include "harness/segment/segment.hpp"
#include "harness/segment/station.hpp"
#include "harness/trace/trace.hpp"

// A bus that several stations share. Each has a place on the cable, told as the propagation time from its
// beginning; a transmission reaches a place after the time between the two.
//
// A reception is told at its END (`now` is the end of the waveform): an overlap can begin until then. At each
// place for itself, transmissions that overlap there form a group and are told as one waveform: a
// transmission that stays alone as it was driven, with its start shifted by the propagation time; a group as
// the waveform in which the rule of contention leaves the line, marked by an observation "contention" in the
// trace and told to the watchers. Where nobody drives the line is idle.
//
// The levels of a group have the rate of its members when all are on one grid, else 16 times the highest
// rate, each level as the line is in its middle. The medium must outlive the last run of its segment, and a
// station must not drive it from its destructor.
//
// A station whose place senses activity is told besides when others begin to drive the line at its place and
// when nobody of them does any more, whatever a fault makes of what they drive.
//
// Limit: propagation only; no attenuation, no reflections.
namespace fieldproof::segment {

// The observation where several transmissions meet at a receiver.
inline constexpr std::string_view kContention = "contention";

// What the line is where drivers disagree.
enum class ContentionRule : std::uint8_t {
  zero_wins,
  one_wins,
  noise,  // a random level, drawn for each level and place
};

struct Contention {
  trace::Channel place;
  kernel::Time from;  // of the group
  kernel::Time to;
  std::size_t transmissions;
};

class ContentionWatcher {
 public:
  virtual ~ContentionWatcher() = default;
  virtual void on_contention(const Contention& contention) = 0;
};

class Medium;

// A place on the medium.
class MediumPort final : public Port, public Receiver {
 public:
  // Made by Medium::attach.
  MediumPort(Medium& medium, std::size_t index, std::string_view name, std::size_t station, PortIndex port,
             kernel::Duration position, bool receives_own_echo);

  void drive(line::Waveform& wave) override;

  // Is the line driven here at this instant (by this station too)? Transmissions that were given ahead of
  // their time are not heard before it.
  bool is_busy(kernel::Time now) const;

  // From now on its station is told of activity.
  void sense_activity();

  const std::string& name() const;
  trace::Channel trace_channel() const { return trace_channel_; }

  // Hears what the station is told.
  void tap_arrived(Tap& tap) { taps_.push_back(&tap); }
  // Hears what the station drives, when it is given to the port.
  void tap_driven(Tap& tap) { driven_taps_.push_back(&tap); }

 private:
  friend class Medium;

  static constexpr std::size_t kNobody = ~std::size_t{0};

  struct Transmission {
    line::Waveform wave;
    std::size_t places = 0;  // that have not been told yet
  };
  // A transmission at this place.
  struct Flight {
    Transmission* transmission;
    kernel::Time start;
    kernel::Time end;
  };

  void expect(const Flight& flight);
  std::size_t first_group(kernel::Time& end) const;
  kernel::Time next() const;
  void tell_due(kernel::Time now);
  void tell_activity(kernel::Time now);
  void tell_group(std::size_t count, kernel::Time end);
  void pass(const line::Waveform& wave, kernel::Time now);
  void tell(const line::Waveform& wave);

  Medium& medium_;
  std::size_t index_;  // of the place on the medium
  trace::Channel trace_channel_;
  std::size_t station_;
  PortIndex port_;
  kernel::Duration position_;
  bool receives_own_echo_;
  bool senses_activity_ = false;
  bool is_active_ = false;  // as its station knows
  kernel::Random random_;
  std::vector<Tap*> taps_;
  std::vector<Tap*> driven_taps_;
  std::vector<Flight> flights_;  // ordered by start
  std::vector<Flight> own_;      // what this place drives and does not hear
  std::vector<Flight> group_;
  line::Waveforms arrivals_;
  std::vector<line::Waveform> late_;  // changed by the channel so that they end later; ordered by end
};

class Medium final : private kernel::Timer {
 public:
  // `random` is split by the names of the places, not drawn from.
  Medium(Segment& segment, std::string name, ContentionRule rule, const kernel::Random& random);
  ~Medium() override;
  Medium(const Medium&) = delete;
  Medium& operator=(const Medium&) = delete;

  // A place for station number `station`, heard there as `port`. The receiver of a station that does not hear
  // itself gets what the others drive, also while it drives.
  MediumPort& attach(std::string_view name, std::size_t station, PortIndex port, kernel::Duration position,
                     bool receives_own_echo = false);
  // A place without a station: who listens taps it.
  MediumPort& listen(std::string_view name, kernel::Duration position);

  // Hears what is driven, when it is given to a port, in the order in which it is given.
  void tap_driven(Tap& tap) { driven_taps_.push_back(&tap); }
  void watch(ContentionWatcher& watcher) { watchers_.push_back(&watcher); }

  const std::string& name() const { return name_; }

 private:
  friend class MediumPort;

  void on_time(kernel::Time now) override;
  void drive(MediumPort& from, line::Waveform& wave);
  void release(MediumPort::Transmission& transmission);
  void contend(MediumPort& at, const std::vector<MediumPort::Flight>& group, kernel::Time end,
               line::Waveform& resolved);
  void resolve_on_grid(const std::vector<MediumPort::Flight>& group, kernel::Time end, kernel::Random& random,
                       line::Waveform& resolved) const;
  void resolve_by_instants(const std::vector<MediumPort::Flight>& group, kernel::Time end,
                           kernel::Random& random, line::Waveform& resolved) const;
  bool one_wins(kernel::Random& random) const;
  void arm();

  Segment& segment_;
  std::string name_;
  ContentionRule rule_;
  kernel::Random random_;
  kernel::SlotId slot_;
  std::deque<MediumPort> ports_;
  EarliestDue due_;  // of the ports
  std::deque<MediumPort::Transmission> transmissions_;
  std::vector<MediumPort::Transmission*> free_;
  std::vector<Tap*> driven_taps_;
  std::vector<ContentionWatcher*> watchers_;
};

}  // namespace fieldproof::segment
