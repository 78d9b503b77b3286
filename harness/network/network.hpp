#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "harness/judge/verdict.hpp"
#include "harness/kernel/time.hpp"
#include "harness/line/character.hpp"
#include "harness/line/sampling.hpp"
#include "harness/line/telegram.hpp"
#include "harness/measure/measurement.hpp"
#include "harness/network/acceptance.hpp"
#include "harness/segment/receiver.hpp"
#include "harness/segment/segment.hpp"
#include "harness/trace/dissector.hpp"
#include "harness/trace/trace.hpp"

// A running installation of stations on a segment, whatever its protocol: what a burst campaign and a
// measurement ask of it. Who plays which station is the affair of whoever builds it.
//
// Contract: the network owns its segment and drives nothing by itself before `start`. Words of process data
// belong to signals, each from one source to one sink; a watcher is told each exchange when it has ended, and
// what sinks show as they show it. Whether the installation runs is decided from what passes on its lines,
// not from what a station reports about itself.
namespace fieldproof::network {

enum class State : std::uint8_t {
  coming_up,   // since the last start no process data have been exchanged
  exchanging,  // they are
  stopped,     // they were, and are not any more; or it did not come up in the time that it has for that
};

// One word of process data.
struct Signal {
  std::string name;
  bool is_output = false;  // from the controller to the process
  unsigned bits = 16;
  // The sink is an image that is looked at when an exchange has ended; else it shows each change at once.
  bool is_image = false;
  // What the sink shows when it has been reset or put into its safe state; never sent.
  std::optional<std::uint16_t> safe_value{};
  // Words that may be shown without being wrong: those of so many exchanges, the present one included.
  unsigned admissible_words = 1;
};

enum class ExchangeKind : std::uint8_t {
  data,     // carries process data
  service,  // identification, a pass of the token
};

enum class Outcome : std::uint8_t {
  served,
  rejected,  // something came and was not accepted
  missing,   // nothing came
};

std::string_view name(Outcome outcome);

struct Exchange {
  kernel::Time end{};
  ExchangeKind kind = ExchangeKind::data;
  Outcome outcome = Outcome::served;
  std::uint64_t retries = 0;  // within it
  // The signals whose words it carried, and which get new ones now.
  std::size_t first_signal = 0;
  std::size_t signal_count = 0;
};

class ExchangeWatcher {
 public:
  ExchangeWatcher() = default;
  ExchangeWatcher(const ExchangeWatcher&) = delete;
  ExchangeWatcher& operator=(const ExchangeWatcher&) = delete;
  virtual ~ExchangeWatcher() = default;

  // Sources may be given new words from here.
  virtual void on_exchange(const Exchange& exchange) = 0;
  // The sink of a signal that is no image shows another word from `when` on.
  virtual void on_shown(std::size_t signal, std::uint16_t word, kernel::Time when) = 0;
  // A cycle of this kind (see `Network::cycles`) begins.
  virtual void on_cycle_begin(std::size_t kind, kernel::Time when) = 0;
  // A delay of this kind has ended.
  virtual void on_delay(std::size_t /*kind*/, kernel::Time /*from*/, kernel::Time /*to*/) {}
};

// What the levels at a receiver are made of, where its receiver is a declared one: then a burst channel knows
// which wrong times it cannot see.
using ReceivedUnits = std::variant<std::monostate, line::TelegramLayout, line::CharacterFormat>;

// A receiver in the installation.
struct Place {
  std::string name;  // "slave@3/in"
  segment::Receiver* receiver = nullptr;
  trace::Channel trace_channel{};
  std::int64_t level_rate = 0;  // levels per second that its sender drives
  ReceivedUnits units{};
  // When its receiver looks at a level: of Manchester code once in each half bit.
  line::Sampling sampling{};
  // Its senders drive whole units only.
  bool has_whole_units = false;
  // Its cable lies in the clamp of a burst test. Where it does not, `why_not` is the reason.
  bool is_exposed = true;
  std::string_view why_not{};
};

// A kind of cycle that the installation goes through, or of delay in it, with the closed form of its time.
struct CycleKind {
  std::string name;           // "poll cycle"
  kernel::Duration theory{};  // zero where none holds; `form` says why
  std::string form;           // where the closed form comes from, in words
  bool is_bound = false;      // it is the most that may be, not the time
  kernel::Duration
      jitter{};           // the most by which these times may differ; zero: no more than instants are rounded
  bool is_delay = false;  // it has a begin and an end of its own
};

// How soon the installation has to exchange all data again.
struct RecoveryLimit {
  std::uint64_t exchanges = 0;
  kernel::Duration time{};  // that so many take
  std::string_view source{};
  judge::Standing standing = judge::Standing::own;
};

// Closed forms of the edge of a binary signal on a copied path.
struct PathTheory {
  kernel::Duration cycle{};        // from sample to sample
  kernel::Duration least_delay{};  // from the sample to what is shown
};

// A word that the installation carries from the input of one station to the output of another.
struct CopiedPath {
  std::string name;  // "di16 word 0 to do16 word 0"
  int from = 0;      // stations, from 1 on
  int to = 0;
  std::size_t source = 0;  // signals: that of the input, that of the output
  std::size_t sink = 0;
  // Words on the same way are one image where they are sampled and shown together; this one is by itself.
  bool is_image_of_its_own = false;
  std::optional<PathTheory> theory{};
  std::string_view why_open{};  // where no closed form holds
};

// What a person calls the exchanges.
struct ExchangeWords {
  std::string_view data = "exchanges";
  std::string_view service = "exchanges for service";
  std::string_view unserved = "exchanges that were not served";
};

// What a check protects, for the theory of what it cannot see.
struct ProtectedFrame {
  std::string name;             // "data cycle"
  std::string frame_check;      // of the catalogue; empty: the exclusive or of octets
  unsigned bits = 0;            // with the check
  kernel::Duration distance{};  // from one of these frames to the next
};

class Network {
 public:
  Network() = default;
  Network(const Network&) = delete;
  Network& operator=(const Network&) = delete;
  virtual ~Network() = default;

  virtual const std::string& name() const = 0;
  virtual segment::Segment& segment() = 0;

  // Power-up, or what an operator does after a stop.
  virtual void start() = 0;
  virtual void stop() = 0;
  virtual State state() const = 0;
  // Until it exchanges data after a start on a quiet line; grows with its size.
  virtual kernel::Duration bring_up_limit() const = 0;
  // Why it does not come up, as its controller reports it; may be empty.
  virtual std::string complaint() const { return {}; }
  // Its controller reports that the share of errors is high.
  virtual bool reports_poor_quality() const { return false; }

  virtual std::span<const Place> places() const = 0;
  virtual std::span<const CycleKind> cycles() const = 0;
  // What must never happen to data on their way, with how often it did: "delivered twice".
  virtual std::vector<measure::Count> delivery_faults() const { return {}; }
  // What else it counts of itself: "faults of channel A that were reported".
  virtual std::vector<measure::Count> remarks() const { return {}; }
  // By which it is decided whether it works.
  virtual AcceptanceRules acceptance() const { return {}; }
  virtual RecoveryLimit recovery_limit() const = 0;
  virtual ExchangeWords exchange_words() const { return {}; }
  // What a reader of a measurement has to know: options, other closed forms.
  virtual std::vector<measure::Condition> conditions() const { return {}; }
  virtual std::vector<ProtectedFrame> protected_frames() const = 0;
  // What is on its lines, in words; null: not known.
  virtual std::shared_ptr<const trace::Dissector> dissector() const { return nullptr; }

  virtual std::span<const Signal> signals() const = 0;
  virtual void set_source(std::size_t signal, std::uint16_t word) = 0;
  // Of an input: a signal in time, from now on.
  virtual void set_source_function(std::size_t signal, std::function<std::uint16_t(kernel::Time)> word) = 0;
  // The image at the sink; of signals with an image only.
  virtual std::uint16_t image(std::size_t signal) const = 0;
  // What its controller carries from inputs to outputs by itself. Sources are inputs, sinks are outputs.
  virtual std::vector<CopiedPath> paths() const = 0;
  // One at a time; it outlives the last run of the segment.
  virtual void watch(ExchangeWatcher& watcher) = 0;

  // The case is over for all stations.
  virtual void end() = 0;
};

}  // namespace fieldproof::network
