#include "emc/immunity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <optional>
#include <utility>

#include "emc/burst_clamp.hpp"
#include "harness/fault/plan.hpp"
#include "harness/segment/segment.hpp"

namespace fieldproof::emc {
namespace {

using kernel::Duration;
using kernel::kMillisecond;
using kernel::kSecond;
using kernel::Time;
using network::Exchange;
using network::State;

constexpr Duration kSlice = 5 * kMillisecond;

// Counts what a channel of any kind does.
class CountedChannel final : public fault::Channel {
 public:
  explicit CountedChannel(fault::Channel& channel) : channel_(channel) {}

  bool pass(const line::Waveform& sent, line::Waveforms& arrivals) override {
    ++statistics_.transmissions;
    const bool is_changed = channel_.pass(sent, arrivals);
    if (is_changed) {
      ++statistics_.hit_transmissions;
      ++statistics_.changed_transmissions;
    }
    return is_changed;
  }

  const BurstStatistics& statistics() const { return statistics_; }

 private:
  fault::Channel& channel_;
  BurstStatistics statistics_;
};

class Run final : private network::ExchangeWatcher {
 public:
  Run(network::Network& network, const ImmunitySettings& settings)
      : network_(network),
        segment_(network.segment()),
        acceptance_(network.acceptance()),
        random_(settings.seed),
        statistics_(network, random_.split("process data")),
        settings_(settings) {
    for (const network::CycleKind& kind : network.cycles()) result_.cycles.push_back({kind});
    last_begin_.resize(result_.cycles.size());
    network_.watch(*this);
  }

  // Without bursts.
  std::string complaint_on_quiet_line() {
    if (!come_up()) {
      const std::string complaint(network_.complaint());
      if (is_stopped()) return "";
      return complaint.empty() ? "it does not come up" : complaint;
    }
    statistics_.begin();
    const bool is_delivered = delivers_all(most_exchanges_waited());
    statistics_.end();
    network_.end();
    if (is_stopped()) return "";
    if (const auto wrong = statistics_.first_wrong()) return text_of(*wrong);
    return is_delivered ? "" : "not all words that were sent arrived";
  }

  void suffer_and_recover(const LineResponse& response) {
    if (!come_up()) {
      result_.complaint = network_.complaint();
      return;
    }
    result_.came_up = true;
    // What was not served while stations were still being found is no error.
    bad_run_ = result_.longest_bad_run = 0;
    first_trouble_.reset();
    on_ = result_.on = segment_.now();
    off_ = on_ + settings_.duration;
    result_.course = ImmunityCourse(on_, settings_.duration);
    couple(response);
    statistics_.begin();
    suffer();
    recover();
    sum_up();
    network_.end();
    result_.fingerprint = segment_.trace().fingerprint();
  }

  const ImmunityResult& result() const { return result_; }

 private:
  bool come_up() {
    start();
    const Time end = segment_.now() + network_.bring_up_limit();
    while (segment_.now() < end && !is_exchanging_ && !is_stopped()) segment_.run_for(kSlice);
    return is_exchanging_;
  }

  void start() {
    is_exchanging_ = false;
    std::ranges::fill(last_begin_, std::nullopt);
    network_.start();
  }

  bool is_stopped() {
    if (settings_.stop.stop_requested()) result_.is_complete = false;
    return !result_.is_complete;
  }

  void couple(const LineResponse& response) {
    if (settings_.plan || settings_.make_channel) {
      put_channels();
    } else {
      const BurstSettings& bursts = settings_.bursts;
      clamp_.emplace(bursts, response.wrong_output(bursts.level.open_circuit_volts(), bursts.polarity),
                     random_.split("bursts"), network_.recovery_limit().time);
      clamp_->couple(network_, segment_.now(), off_);
    }
    if (!settings_.around) return;
    for (const network::Place& place : network_.places()) {
      fault::Channel* const channel = place.receiver->channel();
      if (place.is_exposed && channel != nullptr)
        place.receiver->set_channel(&owned(settings_.around(*channel, place)));
    }
  }

  fault::Channel& owned(std::unique_ptr<fault::Channel> channel) {
    return *channels_.emplace_back(std::move(channel));
  }

  void put_channels() {
    const kernel::Random random = random_.split("channels");
    if (settings_.plan) installed_.emplace(*settings_.plan, segment_.trace(), random);
    for (const network::Place& place : network_.places()) {
      if (!place.is_exposed) continue;
      fault::Channel* const channel =
          installed_ ? installed_->channel_for({place.name, place.trace_channel, place.level_rate})
                     : &owned(settings_.make_channel(random.split(counted_.size())));
      if (channel == nullptr) continue;
      counted_.emplace_back(*channel);
      place.receiver->set_channel(&counted_.back());
    }
  }

  void suffer() {
    while (segment_.now() < off_ && !is_stopped()) {
      segment_.run_until(std::min(segment_.now() + kSlice, off_));
      restart_if_stopped();
    }
    // Bursts and plans know themselves when they end.
    if (clamp_ || installed_) return;
    for (const network::Place& place : network_.places()) {
      if (place.is_exposed) place.receiver->set_channel(nullptr);
    }
  }

  void restart_if_stopped() {
    if (network_.state() != State::stopped) return;
    if (result_.stops == 0) {
      why_stopped_ = network_.complaint();
      first_stop_ = segment_.now();
    }
    ++result_.stops;
    result_.course.note_stop(segment_.now());
    start();
  }

  void recover() {
    const std::uint64_t most = most_exchanges_waited();
    result_.recovered_by_itself = delivers_all(most);
    result_.recovery_exchanges = recovery_exchanges_;
    result_.recovery_time = recovery_time_;
    if (result_.recovered_by_itself || !result_.is_complete) return;
    network_.stop();
    segment_.run_for(acceptance_.pause_before_start);
    result_.recovered_after_start = come_up() && delivers_all(most);
  }

  std::uint64_t most_exchanges_waited() const {
    return std::max<std::uint64_t>(acceptance_.least_exchanges_waited,
                                   acceptance_.limits_waited * network_.recovery_limit().exchanges);
  }

  std::string text_of(const network::WrongWord& wrong) const {
    return fmt::format("at {} '{}' got 0x{:04X}, and 0x{:04X} was sent", kernel::describe(wrong.when),
                       network_.signals()[wrong.signal].name, wrong.got, wrong.sent);
  }

  // Each signal arrives once more, within so many exchanges.
  bool delivers_all(std::uint64_t most) {
    is_recovering_ = true;
    recovery_exchanges_ = 0;
    statistics_.begin_recovery();
    const Time begin = segment_.now();
    const Time end = begin + std::max(acceptance_.least_time_waited,
                                      acceptance_.limits_waited * network_.recovery_limit().time);
    while (segment_.now() < end && !statistics_.is_recovered() && recovery_exchanges_ < most &&
           !is_stopped()) {
      if (network_.state() == State::stopped || !segment_.step()) break;
    }
    recovery_time_ = segment_.now() - begin;
    return statistics_.is_recovered() && is_exchanging_;
  }

  void on_exchange(const Exchange& exchange) override {
    const std::uint64_t refused = statistics_.counts().refused;
    statistics_.on_exchange(exchange, effect_on_line());
    result_.course.take(statistics_.counts(), exchange.end);
    const bool is_served = exchange.outcome == network::Outcome::served;
    if (is_served && exchange.kind == network::ExchangeKind::data && network_.state() == State::exchanging) {
      is_exchanging_ = true;
    }
    bad_run_ = is_served ? 0 : bad_run_ + 1;
    // Also where it was served and a sink did not take over its word.
    if (!first_trouble_ && (!is_served || exchange.retries > 0 || statistics_.counts().refused > refused))
      first_trouble_ = exchange.end;
    result_.longest_bad_run = std::max(result_.longest_bad_run, bad_run_);
    result_.poor_quality = result_.poor_quality || network_.reports_poor_quality();
    if (is_recovering_) ++recovery_exchanges_;
  }

  void on_shown(std::size_t signal, std::uint16_t word, Time when) override {
    statistics_.on_shown(signal, word, when);
  }

  void on_cycle_begin(std::size_t kind, Time when) override {
    std::optional<Time>& before = last_begin_.at(kind);
    if (before) {
      const measure::Phase phase = clamp_ ? clamp_->phase_during(*before, when) : measure::Phase::quiet;
      result_.cycles[kind].times.add(phase, when - *before);
    }
    before = when;
  }

  void on_delay(std::size_t kind, Time from, Time to) override {
    const measure::Phase phase = clamp_ ? clamp_->phase_during(from, to) : measure::Phase::quiet;
    result_.cycles.at(kind).times.add(phase, to - from);
  }

  template <typename Use>
  void for_each_statistics(Use use) const {
    if (clamp_) {
      for (const BurstChannel& channel : clamp_->channels()) use(channel.statistics());
    }
    for (const CountedChannel& channel : counted_) use(channel.statistics());
  }

  // Since the exchange before.
  network::LineEffect effect_on_line() {
    std::uint64_t hit = 0;
    std::uint64_t changed = 0;
    for_each_statistics([&](const BurstStatistics& one) {
      hit += one.hit_transmissions;
      changed += one.changed_transmissions;
    });
    const bool is_hit = std::exchange(hit_before_, hit) != hit;
    if (std::exchange(changed_before_, changed) != changed) return network::LineEffect::changed;
    return is_hit ? network::LineEffect::hit : network::LineEffect::untouched;
  }

  void sum_up() {
    statistics_.end();
    result_.counts = statistics_.counts();
    result_.course.take(result_.counts, segment_.now());
    result_.course.set_bursts(bands());
    result_.first_wrong = statistics_.first_wrong();
    if (result_.first_wrong) result_.first_wrong_text = text_of(*result_.first_wrong);
    for_each_statistics([&](const BurstStatistics& one) {
      ++result_.receivers;
      result_.line += one;
    });
    if (clamp_) result_.bursts = clamp_->bursts_between(on_, off_);
    result_.had_a_burst = !clamp_ || clamp_->phase_during(on_, off_) == measure::Phase::burst;
    result_.criterion = criterion();
  }

  // Nearer to each other than half a window they are not told apart.
  std::vector<measure::Band> bands() {
    if (!clamp_) return {};
    return measure::bands_between([this](Time after) { return clamp_->burst_after(after); }, on_,
                                  settings_.duration, settings_.duration / (2 * ImmunityCourse::kWindows));
  }

  Criterion criterion() {
    const std::uint64_t limit = network_.recovery_limit().exchanges;
    const std::uint64_t wrong = result_.counts.accepted_wrong();
    if (wrong > 0) {
      return because(Criterion::d, "wrong_word_accepted",
                     fmt::format("{} words were accepted and nobody had sent them", wrong),
                     result_.first_wrong->when);
    }
    for (const measure::Count& fault : network_.delivery_faults()) {
      if (fault.count > 0)
        return because(Criterion::d, fault.what, fmt::format("{}: {}", fault.what, fault.count));
    }
    if (!result_.recovered_by_itself && !result_.recovered_after_start) {
      return because(Criterion::d, "dead_after_start",
                     "not all words arrived after a start (least_bring_up, limits_waited)");
    }
    if (result_.stops > 0) {
      const std::string why = why_stopped_.empty() ? fmt::format("no exchange for silence_cycles = {}",
                                                                 acceptance_.silence_cycles)
                                                   : why_stopped_;
      return because(Criterion::c, "stopped", fmt::format("it stopped {} times: {}", result_.stops, why),
                     first_stop_);
    }
    if (!result_.recovered_by_itself) {
      return because(Criterion::c, "start_needed",
                     fmt::format("not all words arrived within limits_waited = {} and a start mended it",
                                 acceptance_.limits_waited));
    }
    if (result_.recovery_exchanges > limit) {
      return because(Criterion::c, "recovery_too_long",
                     fmt::format("recovery took {} exchanges, and recovery_cycles = {} allow {}",
                                 result_.recovery_exchanges, acceptance_.recovery_cycles, limit));
    }
    const network::ErrorStatistics& counts = result_.counts;
    if (result_.longest_bad_run == 0 && counts.retried == 0 && counts.refused == 0) return Criterion::a;
    return because(Criterion::b, "exchange_not_served_at_once", {}, first_trouble_);
  }

  Criterion because(Criterion criterion, std::string_view reason, std::string why,
                    std::optional<Time> when = std::nullopt) {
    result_.reason = reason;
    result_.decided_by = std::move(why);
    result_.decided_at = when;
    return criterion;
  }

  network::Network& network_;
  segment::Segment& segment_;
  network::AcceptanceRules acceptance_;
  kernel::Random random_;
  network::ExchangeStatistics statistics_;
  const ImmunitySettings& settings_;
  std::optional<BurstClamp> clamp_;
  std::optional<fault::InstalledPlan> installed_;
  std::vector<std::unique_ptr<fault::Channel>> channels_;
  std::deque<CountedChannel> counted_;
  Time on_{};
  Time off_{};
  bool is_exchanging_ = false;  // a served exchange of data since the last start, seen on the line as well
  bool is_recovering_ = false;
  std::uint64_t recovery_exchanges_ = 0;
  Duration recovery_time_{};
  Time first_stop_{};
  std::optional<Time> first_trouble_;  // an exchange that was not served, or not at the first attempt
  std::string why_stopped_;            // the first time, where the network can say so
  std::uint64_t bad_run_ = 0;
  std::uint64_t hit_before_ = 0;
  std::uint64_t changed_before_ = 0;
  std::vector<std::optional<Time>> last_begin_;  // by kind of cycle
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
      return "every exchange was served at the first attempt, and its words were taken over";
    case Criterion::b:
      return "exchanges were rejected or repeated and old data held; it recovered by itself within its limit";
    case Criterion::c:
      return "the bus stopped, or did not recover by itself in time; it worked after a start";
    case Criterion::d:
      return "wrong data were accepted, it did not work after a start, or "
             "an implementation crashed, hung or broke its contract";
  }
  return "";
}

std::string complaint_on_quiet_line(network::Network& network, std::uint64_t seed, std::stop_token stop) {
  ImmunitySettings settings;
  settings.seed = seed;
  settings.stop = std::move(stop);
  return Run(network, settings).complaint_on_quiet_line();
}

ImmunityResult run_immunity(network::Network& network, const LineResponse& response,
                            const ImmunitySettings& settings) {
  Run run(network, settings);
  run.suffer_and_recover(response);
  return run.result();
}

}  // namespace fieldproof::emc
