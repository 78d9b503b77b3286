#include "emc/interbus/immunity.hpp"

#include <algorithm>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "emc/framing.hpp"
#include "emc/interbus/burst_clamp.hpp"
#include "harness/kernel/random.hpp"
#include "harness/segment/segment.hpp"
#include "protocols/interbus/master.hpp"
#include "protocols/interbus/timing.hpp"

namespace fieldproof::emc {
namespace {

using interbus::MasterState;
using kernel::Duration;
using kernel::kMillisecond;
using kernel::kSecond;
using kernel::Time;

constexpr Duration kSlice = 5 * kMillisecond;
constexpr std::uint64_t kMostRecoveryCycles = 1000;

std::unique_ptr<interbus::MasterDevice> make_master(const InterbusStations& stations,
                                                    const interbus::MasterConfiguration& configuration) {
  if (stations.make_master) return stations.make_master(configuration);
  return std::make_unique<interbus::Master>(configuration);
}

// What the network exchanges, and whether it is what came out.
class Oracle {
 public:
  Oracle(interbus::MasterDevice& master, interbus::Ring& ring, kernel::Random random)
      : master_(master), ring_(ring), random_(std::move(random)) {
    for (int position = 1; position <= static_cast<int>(ring.size()); ++position) watch(position);
    sent_.resize(ring.word_count());
    put_out_.resize(ring.word_count());
    at_terminals_.resize(ring.word_count());
    held_.resize(ring.word_count());
  }

  void begin() {
    ledger_ = {};
    wrong_before_ = 0;
  }
  const ErrorLedger& ledger() const { return ledger_; }
  // Whether the last good cycle was not put out somewhere.
  bool has_missed() const { return has_missed_; }

  // At the end of a cycle: judges the images and gives both sides new values.
  void on_cycle_end(kernel::Time now, bool is_data, bool accepted, bool is_corrupted) {
    if (is_data) {
      ++ledger_.sent;
      if (is_corrupted) ++ledger_.corrupted;
      if (!accepted) {
        ++ledger_.detected;
        if (has_latched_) ++ledger_.partly_latched;
      }
    } else if (was_rejected_) {
      ++ledger_.repeated;
    }
    was_rejected_ = !accepted;
    judge_inputs(is_data && accepted);
    if (is_data && accepted) judge_outputs();
    if (ledger_.accepted_wrong() != wrong_before_) ++ledger_.wrong_cycles;
    wrong_before_ = ledger_.accepted_wrong();
    has_latched_ = false;
    exchange(now);
  }

 private:
  void watch(int position) {
    const unsigned first = ring_.first_word(position);
    ring_.terminals(position).on_change([this, first](const interbus::TerminalBlock::Change& change) {
      put_out_[first + change.word] = change.after;
      if (change.after == 0) {
        ++ledger_.cleared_outputs;  // the safe value, never sent
        return;
      }
      has_latched_ = true;
      if (change.after != sent_[first + change.word]) ++ledger_.accepted_wrong_outputs;
    });
  }

  // A good data cycle brings what was at the terminals when it began; nothing else changes the image. Outside
  // of `run` an image may be empty.
  void judge_inputs(bool is_good_data) {
    const bool is_running = master_.status().state == MasterState::run;
    for (unsigned word = 0; word < held_.size(); ++word) {
      const std::uint16_t actual = master_.input(word);
      if (is_good_data) {
        if (actual != at_terminals_[word]) ++ledger_.accepted_wrong_inputs;
      } else if (is_running && actual != held_[word]) {
        ++ledger_.accepted_wrong_inputs;
      }
      held_[word] = actual;
    }
  }

  // The words of a cycle that the master takes for good are at the outputs when it has ended.
  void judge_outputs() {
    has_missed_ = false;
    for (int position = 1; position <= static_cast<int>(ring_.size()); ++position) {
      for (unsigned n = 0; n < ring_.configuration(position).words; ++n) {
        const unsigned word = ring_.first_word(position) + n;
        if (put_out_[word] == sent_[word]) continue;
        ++ledger_.missed_outputs;
        has_missed_ = true;
      }
    }
  }

  void exchange(kernel::Time now) {
    for (int position = 1; position <= static_cast<int>(ring_.size()); ++position) {
      const unsigned words = ring_.configuration(position).words;
      for (unsigned n = 0; n < words; ++n) {
        const unsigned word = ring_.first_word(position) + n;
        sent_[word] = static_cast<std::uint16_t>(random_.between(1, 0xFFFF));
        at_terminals_[word] = static_cast<std::uint16_t>(random_.between(1, 0xFFFF));
        master_.write_output(word, sent_[word], now);
        ring_.terminals(position).set_input(n, at_terminals_[word]);
      }
    }
  }

  interbus::MasterDevice& master_;
  interbus::Ring& ring_;
  kernel::Random random_;
  std::vector<std::uint16_t> sent_;          // the output image of the cycle in work
  std::vector<std::uint16_t> at_terminals_;  // the inputs that it will bring
  std::vector<std::uint16_t> held_;          // the input image as it was seen last
  std::vector<std::uint16_t> put_out_;       // at the output terminals
  bool has_latched_ = false;
  bool has_missed_ = false;
  bool was_rejected_ = false;
  std::uint64_t wrong_before_ = 0;
  ErrorLedger ledger_;
};

// Counts what a channel of any kind does.
class CountedChannel final : public fault::Channel {
 public:
  explicit CountedChannel(std::unique_ptr<fault::Channel> channel) : channel_(std::move(channel)) {}

  bool pass(const line::Waveform& sent, line::Waveforms& arrivals) override {
    ++statistics_.transmissions;
    const bool is_changed = channel_->pass(sent, arrivals);
    if (is_changed) {
      ++statistics_.hit_transmissions;
      ++statistics_.changed_transmissions;
    }
    return is_changed;
  }

  const BurstStatistics& statistics() const { return statistics_; }

 private:
  std::unique_ptr<fault::Channel> channel_;
  BurstStatistics statistics_;
};

class Run {
 public:
  Run(const interbus::NetworkDescription& network, const InterbusStations& stations,
      const LineResponse& response, const ImmunitySettings& settings)
      : network_(network),
        random_(settings.seed),
        master_(make_master(stations, interbus::master_configuration(network))),
        seat_(segment_.attach(*master_, "master")),
        ring_(segment_, network, seat_, stations.make_slave),
        oracle_(*master_, ring_, random_.split("process data")),
        settings_(settings) {
    master_->wire(ring_.out());
    master_->on_cycle_end(
        [this](Time now, bool is_data, bool accepted) { on_cycle_end(now, is_data, accepted); });
    if (!come_up()) return;
    result_.came_up = true;
    result_.cycle_time = master_->status().cycle_time;
    off_ = segment_.now() + settings_.duration;
    if (settings_.make_channel) {
      couple_channels();
    } else {
      couple_bursts(response, stations.are_references());
    }
    oracle_.begin();
    suffer();
    recover();
    sum_up();
  }

  const ImmunityResult& result() const { return result_; }

 private:
  bool come_up() {
    const auto stations = static_cast<std::int64_t>(ring_.size());
    start();
    const Time end = segment_.now() + 10 * kSecond +
                     8 * stations * (interbus::structural_cycle_time(network_) + 2 * kMillisecond);
    while (segment_.now() < end && !is_exchanging_) segment_.run_for(kSlice);
    return is_exchanging_;
  }

  void start() {
    is_exchanging_ = false;
    master_->start(segment_.now());
    segment_.refresh(seat_);
  }

  void couple_channels() {
    const kernel::Random random = random_.split("channels");
    for (segment::Link* link : cables_in_clamp(ring_)) {
      counted_.emplace_back(settings_.make_channel(random.split(counted_.size())));
      link->set_channel(&counted_.back());
    }
  }

  void couple_bursts(const LineResponse& response, bool are_references) {
    const BurstSettings& bursts = settings_.bursts;
    const interbus::Rules& rules = network_.rules;
    const BurstReceiver receiver{rules.bit_rate, std::make_shared<TelegramFraming>(rules.telegram),
                                 line::Sampling{}, true, are_references};
    clamp_.emplace(bursts, response.wrong_output(bursts.level.open_circuit_volts(), bursts.polarity),
                   receiver, random_.split("bursts"));
    clamp_->couple(ring_, segment_, segment_.now(), off_);
  }

  void suffer() {
    while (segment_.now() < off_) {
      segment_.run_until(std::min(segment_.now() + kSlice, off_));
      restart_if_stopped();
    }
    // Bursts know themselves when they end.
    if (settings_.make_channel) {
      for (segment::Link* link : cables_in_clamp(ring_)) link->set_channel(nullptr);
    }
  }

  void restart_if_stopped() {
    const MasterState state = master_->status().state;
    if (state != MasterState::bus_stop && state != MasterState::off) return;
    ++result_.bus_stops;
    start();
  }

  void recover() {
    const auto is_over = [&] { return is_well_ || recovery_cycles_ >= kMostRecoveryCycles; };
    is_recovering_ = true;
    is_well_ = false;
    result_.recovered_by_itself = wait(is_over) && is_well_;
    result_.recovery_cycles = recovery_cycles_;
    if (result_.recovered_by_itself) return;
    master_->stop(segment_.now());
    segment_.run_for(50 * kMillisecond);
    result_.recovered_after_start = come_up();
  }

  bool wait(const std::function<bool()>& condition) {
    const Time end = segment_.now() + 5 * kSecond;
    while (segment_.now() < end && !condition()) {
      if (master_->status().state == MasterState::bus_stop || !segment_.step()) return false;
    }
    return condition();
  }

  void on_cycle_end(Time now, bool is_data, bool accepted) {
    const std::uint64_t changed = changed_transmissions();
    oracle_.on_cycle_end(now, is_data, accepted, changed != changed_before_);
    changed_before_ = changed;
    if (accepted && is_data && master_->status().state == MasterState::run) {
      is_exchanging_ = true;
      is_well_ = !oracle_.has_missed();
    }
    bad_run_ = accepted ? 0 : bad_run_ + 1;
    result_.longest_bad_run = std::max(result_.longest_bad_run, bad_run_);
    result_.quality_bit = result_.quality_bit || master_->status().quality_bit;
    if (is_recovering_) ++recovery_cycles_;
  }

  template <typename Use>
  void for_each_statistics(Use use) const {
    if (clamp_) {
      for (const BurstChannel& channel : clamp_->channels()) use(channel.statistics());
    }
    for (const CountedChannel& channel : counted_) use(channel.statistics());
  }

  std::uint64_t changed_transmissions() const {
    std::uint64_t sum = 0;
    for_each_statistics([&](const BurstStatistics& one) { sum += one.changed_transmissions; });
    return sum;
  }

  void sum_up() {
    result_.ledger = oracle_.ledger();
    for_each_statistics([&](const BurstStatistics& one) {
      ++result_.receivers;
      result_.line += one;
    });
    result_.criterion = criterion();
  }

  Criterion criterion() const {
    const bool works_again = result_.recovered_by_itself || result_.recovered_after_start;
    if (result_.ledger.accepted_wrong() > 0 || !works_again) return Criterion::d;
    if (result_.bus_stops > 0 || !result_.recovered_by_itself) return Criterion::c;
    if (result_.recovery_cycles > network_.rules.published_recovery_cycles) return Criterion::c;
    return result_.longest_bad_run > 0 ? Criterion::b : Criterion::a;
  }

  const interbus::NetworkDescription& network_;
  kernel::Random random_;
  segment::Segment segment_;
  std::unique_ptr<interbus::MasterDevice> master_;
  std::size_t seat_;
  interbus::Ring ring_;
  Oracle oracle_;
  ImmunitySettings settings_;
  std::optional<BurstClamp> clamp_;
  std::deque<CountedChannel> counted_;
  Time off_{};
  bool is_exchanging_ = false;  // a good data cycle in `run` since the last start
  bool is_well_ = false;        // since it was set back, one that was put out everywhere
  bool is_recovering_ = false;
  std::uint64_t recovery_cycles_ = 0;
  std::uint64_t bad_run_ = 0;
  std::uint64_t changed_before_ = 0;
  ImmunityResult result_;
};

}  // namespace

std::string_view name(Criterion criterion) {
  constexpr std::string_view kNames = "ABCD";
  return kNames.substr(static_cast<std::size_t>(criterion), 1);
}

std::string_view text_of(Criterion criterion) {
  switch (criterion) {
    case Criterion::a:
      return "no cycle was rejected";
    case Criterion::b:
      return "cycles were rejected and old data held; it recovered by itself within the published number of "
             "cycles";
    case Criterion::c:
      return "the bus stopped, or did not recover by itself in time; it worked after a start";
    case Criterion::d:
      return "wrong data were accepted, or it did not work after a start";
  }
  return "";
}

ImmunityResult run_immunity(const interbus::NetworkDescription& network, const InterbusStations& stations,
                            const LineResponse& response, const ImmunitySettings& settings) {
  return Run(network, stations, response, settings).result();
}

}  // namespace fieldproof::emc
