#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/config/document.hpp"
#include "harness/kernel/random.hpp"
#include "harness/network/attendance.hpp"
#include "harness/network/network.hpp"
#include "harness/network/turnaround.hpp"
#include "harness/network/word_exchanges.hpp"
#include "harness/segment/medium.hpp"
#include "harness/segment/segment.hpp"
#include "protocols/fieldbus_dll/line_end.hpp"
#include "protocols/fieldbus_dll/link_rules.hpp"

// A link as a file describes it, and what the running links of both profiles have in common.
//
//   { "profile": "foundation", "name": "boiler", "bit_rate": "31.25 kbit/s",
//     "masters": [16, 17], "devices": [20, 21, 22], "macrocycle": "500 ms",
//     "data": [ { "from": 20, "to": 21, "at": "0 ms" }, { "from": 21, "to": 22, "at": "100 ms" } ] }
//
// A word goes from one station to another once in a macrocycle. Foundation Fieldbus: its buffer is published
// (CD, DT3) to a subscriber. ISA: the token is delegated (ES) to the station, which sends it (DU).
namespace fieldproof::fieldbus_dll {

enum class LinkProfile : std::uint8_t { foundation, isa };

struct DataDescription {
  std::uint8_t from = 0;
  std::uint8_t to = 0;
  kernel::Duration at{};  // after the beginning of the macrocycle
};

struct LinkDescription {
  std::string name;
  LinkProfile profile = LinkProfile::foundation;
  std::int64_t bit_rate = 31'250;
  std::vector<std::uint8_t> masters;  // nodes; the first begins as the scheduler
  std::vector<std::uint8_t> devices;
  kernel::Duration macrocycle = 500 * kernel::kMillisecond;
  std::vector<DataDescription> data;      // ordered by `at`
  std::vector<std::uint8_t> not_exposed;  // stations at spurs that lie in no clamp

  // Two masters and so many devices, each with a word for the next one.
  static LinkDescription built_in(LinkProfile profile, std::int64_t bit_rate = 31'250, unsigned devices = 4);
  // Throw kernel::Error(configuration) with file, line, pointer and what would be right.
  static LinkDescription load(const std::filesystem::path& path);
  static LinkDescription read(const config::Value& root);
};

// The first thing in a description that no link has, as a sentence with what would be right.
std::optional<config::Violation> violation_of(const LinkDescription& link);
// What one item of the schedule needs until the next may begin.
kernel::Duration needed_by_item(const LinkDescription& link);

// A link that runs. An exchange carries one word; it begins with what calls for it (CD, ES), as the lower
// tester sees it on the line, or with a word that its source publishes uncalled, and ends when its answer
// must be over. Served: the application of the destination has got the word. Stopped: nobody was called for
// two macrocycles, or a station under test drives no more, though the bring-up limit is over: by then even
// one that was lost is found again. It has not come up before each station under test has driven the line.
class LinkNetwork : public network::Network, private segment::Station, private segment::Tap {
 public:
  const std::string& name() const override { return description_.name; }
  segment::Segment& segment() override { return segment_; }
  void start() override;
  void stop() override;
  network::State state() const override;
  kernel::Duration bring_up_limit() const override;
  std::string complaint() const override;
  std::span<const network::Place> places() const override { return places_; }
  std::span<const network::CycleKind> cycles() const override { return cycles_; }
  network::RecoveryLimit recovery_limit() const override;
  network::ExchangeWords exchange_words() const override;
  std::vector<measure::Condition> conditions() const override;
  std::span<const network::Signal> signals() const override { return signals_; }
  void set_source(std::size_t signal, std::uint16_t word) override;
  void set_source_function(std::size_t signal, std::function<std::uint16_t(kernel::Time)> word) override;
  std::uint16_t image(std::size_t signal) const override;
  std::vector<network::CopiedPath> paths() const override;
  void watch(network::ExchangeWatcher& watcher) override { words_.watch(watcher); }
  void end() override;

 protected:
  LinkNetwork(const LinkDescription& description, const LinkRules& rules, std::uint64_t seed);

  const LinkDescription& description() const { return description_; }
  // A station at its place on the line; it must live as long as the network. `why_silent`: see Attendance.
  segment::MediumPort& seat(segment::Station& station, std::uint8_t node, const std::string& name,
                            bool is_under_test, const std::string& why_silent = {});
  // A station that has nothing to drive has got what is for it.
  void take_part(std::uint8_t node);
  void refresh(std::uint8_t node);
  void begin_cycle(std::size_t kind, kernel::Time when) { words_.begin_cycle(kind, when); }
  // The word of this signal is called for by what ends then.
  void on_called(std::size_t signal, kernel::Time begin, kernel::Time end);
  bool is_called(std::size_t signal) const { return words_.is_called(signal); }
  // It has been sent; its destination has got it.
  void on_sent(std::size_t signal) { words_.on_sent(signal); }
  void on_got(std::size_t signal, std::uint16_t word, kernel::Time when) {
    words_.on_got(signal, word, when);
  }
  // And the turnaround time of each station under test that is called: at most `answer_limit` where it is not
  // zero, as `form` says.
  void set_cycles(std::vector<network::CycleKind> cycles, kernel::Duration answer_limit,
                  const std::string& form);
  // It is called by what ends then, and has to answer.
  void ask(std::uint8_t node, kernel::Time end);

  // ---- of a profile ----
  virtual void power_up(kernel::Time now) = 0;
  virtual void power_down(kernel::Time now) = 0;
  // What stations drive, with the check after it.
  virtual void on_driven(const Octets& octets, kernel::Time begin, kernel::Time end) = 0;
  // The application of the source has a new word.
  virtual void give(std::size_t signal, std::uint16_t word, kernel::Time now) = 0;
  // From the end of the call until the word must have arrived.
  virtual kernel::Duration answer_time() const = 0;
  // From the sample at the source to the application of the destination.
  virtual kernel::Duration least_delay(std::size_t signal) const = 0;
  // A sample is taken so long before the word is called for.
  kernel::Duration lead() const;

 private:
  struct Seat {
    segment::Station* station;
    std::uint8_t node;
    std::size_t number;
    network::Attendance::Station* attendance;  // null: a reference
    std::string name;
    std::optional<network::Turnaround> turnaround{};  // of one under test
    std::size_t turnaround_kind = 0;                  // among the cycles
  };

  void receive(segment::PortIndex, const line::Waveform&) override {}
  void on_time(kernel::Time now) override;
  kernel::Time next_time() const override { return wakes_at_; }
  void on_wave(const line::Waveform& wave) override;
  void supply(kernel::Time now);
  void set_wake();

  LinkDescription description_;
  LinkRules rules_;
  kernel::Random random_;
  segment::Segment segment_;
  segment::Medium line_;
  LineEnd tester_;
  network::Attendance attendance_;
  std::deque<Seat> seats_;
  std::vector<network::Place> places_;
  std::vector<network::Signal> signals_;
  std::vector<network::CycleKind> cycles_;
  network::WordExchanges words_;
  std::vector<kernel::Time> samples_;  // when the next word of a signal is taken
  std::size_t tester_number_ = 0;
  bool has_tester_ = false;
  kernel::Time wakes_at_ = kernel::kNever;
  kernel::Time started_{};
  kernel::Time driven_until_{};
  kernel::Time supplied_at_ = kernel::kNever;  // a start that waits for the end of what is on the line
  bool is_on_ = false;
};

}  // namespace fieldproof::fieldbus_dll
