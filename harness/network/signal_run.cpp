#include "harness/network/signal_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "harness/kernel/error.hpp"
#include "harness/kernel/random.hpp"
#include "harness/measure/torn_image.hpp"
#include "harness/measure/two_channel_recorder.hpp"

namespace fieldproof::network {
namespace {

using kernel::Duration;
using kernel::Time;

constexpr Duration kSignalStep = 10 * kernel::kMillisecond;
// Cycles that the network runs before the cycle time is read off it, and before the first train begins.
constexpr std::int64_t kSettlingCycles = 3;
constexpr std::int64_t kCyclesBeforeTrains = 2;
// After a train: its phase takes up to one cycle, its last edge up to three to the output.
constexpr std::int64_t kRestCycles = 6;

// Evenly spread over a cycle, one at random in each part, in random order.
std::vector<Duration> spread_phases(std::int64_t count, Duration cycle, kernel::Random random) {
  std::vector<Duration> phases;
  for (std::int64_t n = 0; n < count; ++n) {
    const std::int64_t begin = n * cycle.count() / count;
    const std::int64_t end = (n + 1) * cycle.count() / count;
    phases.push_back(Duration{random.between(begin, std::max(begin, end - 1))});
  }
  random.shuffle(phases);
  return phases;
}

// Stations, and which word between them where it is an image of its own.
using Together = std::tuple<int, int, std::optional<std::size_t>>;

Together together(const CopiedPath& path) {
  return {path.from, path.to, path.is_image_of_its_own ? std::optional(path.sink) : std::nullopt};
}

// A recorder, and where its word stands among those that belong together.
struct Watched {
  CopiedPath path;
  measure::TwoChannelRecorder recorder;
  measure::TornImageCounter* image;
  std::size_t word;
};

class SignalRun final : private ExchangeWatcher {
 public:
  SignalRun(Network& network, const SignalSettings& settings)
      : network_(network), settings_(settings), generator_(settings.wave) {
    for (const CycleKind& kind : network.cycles()) record_.cycles.push_back({kind});
    last_begin_.resize(record_.cycles.size());
    watch_paths(network.paths());
    network.watch(*this);
    bring_up();
    if (settings_.disturb) settings_.disturb(network);
  }

  SignalRecord run() {
    plan_trains();
    is_recording_ = true;
    for (std::int64_t train = 1; train <= trains_; ++train) {
      network_.segment().run_until(begin_ + train * span_);
    }
    return finish();
  }

 private:
  void watch_paths(const std::vector<CopiedPath>& paths) {
    if (paths.empty()) {
      throw kernel::Error(kernel::ErrorKind::configuration,
                          fmt::format("network \"{}\": /copy: nothing is copied from an input to an output; "
                                      "name at least one copy",
                                      network_.name()));
    }
    std::map<Together, std::size_t> words;
    for (const CopiedPath& path : paths) ++words[together(path)];
    std::map<Together, measure::TornImageCounter*> images;
    std::map<Together, std::size_t> next_word;
    for (const auto& [image, count] : words) images[image] = &images_.emplace_back(count);
    for (const CopiedPath& path : paths) {
      const Together image = together(path);
      Watched& watched = watched_.emplace_back(
          Watched{path, measure::TwoChannelRecorder(generator_), images[image], next_word[image]++});
      by_sink_[path.sink] = &watched;
      network_.set_source_function(path.source,
                                   [&watched](Time when) { return watched.recorder.input(when); });
    }
  }

  void bring_up() {
    network_.start();
    segment::Segment& segment = network_.segment();
    const Time end = segment.now() + network_.bring_up_limit();
    while (segment.now() < end && network_.state() != State::exchanging) segment.run_for(kSignalStep);
    if (network_.state() == State::exchanging) return;
    const std::string complaint = network_.complaint();
    throw kernel::Error(
        kernel::ErrorKind::configuration,
        fmt::format("network \"{}\" does not come up within {} of power-up ({}); a network to measure "
                    "must come up",
                    network_.name(), kernel::describe(network_.bring_up_limit()),
                    complaint.empty() ? "its controller reports nothing" : complaint));
  }

  // The cycle is measured: only a network of references is sure to keep to its closed form.
  void plan_trains() {
    segment::Segment& segment = network_.segment();
    const Duration theory = record_.cycles.front().kind.theory;
    segment.run_for(kSettlingCycles * theory);
    cycle_ = measured_cycle_.value_or(theory);
    begin_ = last_begin_.front().value_or(segment.now()) + kCyclesBeforeTrains * cycle_;
    begin_ = std::max(begin_, segment.now());
    const Duration busy =
        settings_.wave.phase + settings_.wave.frequency.periods(settings_.periods_per_train);
    span_ = (busy / cycle_ + 1 + kRestCycles) * cycle_;
    trains_ = std::max<std::int64_t>(1, settings_.duration / span_);
    const auto phases = spread_phases(trains_, cycle_, kernel::Random(settings_.seed).split("phases"));
    for (std::int64_t train = 0; train < trains_; ++train) {
      generator_.trigger(begin_ + train * span_ + phases[static_cast<std::size_t>(train)],
                         settings_.periods_per_train);
    }
    std::ranges::fill(last_begin_, std::nullopt);
    for (CycleRecord& cycle : record_.cycles)
      cycle.course = measure::TimeCourse(trains_ * span_, settings_.most_windows);
  }

  void on_exchange(const Exchange& exchange) override {
    if (!is_recording_) return;
    ++(exchange.kind == ExchangeKind::data ? record_.data_exchanges : record_.service_exchanges);
    if (exchange.outcome != Outcome::served) {
      ++record_.unserved_exchanges;
    } else {
      last_served_ = network_.segment().now();
    }
    record_.retries += exchange.retries;
  }

  void on_shown(std::size_t signal, std::uint16_t word, Time when) override {
    if (!is_recording_) return;
    const auto found = by_sink_.find(signal);
    if (found == by_sink_.end()) return;
    Watched& watched = *found->second;
    watched.recorder.on_output(when, word);
    watched.image->on_word(watched.word, when, watched.recorder.shown_edge());
  }

  void on_cycle_begin(std::size_t kind, Time when) override {
    std::optional<Time>& before = last_begin_.at(kind);
    if (before && is_recording_) record_time(kind, *before, when);
    if (before && kind == 0) measured_cycle_ = when - *before;
    before = when;
  }

  void on_delay(std::size_t kind, Time from, Time to) override {
    if (is_recording_) record_time(kind, from, to);
  }

  void record_time(std::size_t kind, Time from, Time to) {
    const measure::Phase phase = measure::phase_during(settings_.phase_during, from, to);
    CycleRecord& cycle = record_.cycles.at(kind);
    cycle.times.add(phase, to - from);
    cycle.course.add(to - begin_, phase, (to - from).count());
  }

  measure::Trace trace_of(const measure::TwoChannelRecorder& recorder) const {
    measure::Trace trace;
    trace.length = span_;
    const auto& edges = generator_.edges();
    for (std::size_t n = 0; n < edges.size() && edges[n] < begin_ + span_; ++n) {
      trace.input.push_back({edges[n] - begin_, n % 2 == 0});
    }
    for (const auto& edge : recorder.output_edges()) {
      if (edge.when < begin_ + span_) trace.output.push_back({edge.when - begin_, edge.number % 2 == 1});
    }
    return trace;
  }

  SignalRecord finish() {
    record_.settings = settings_;
    record_.trains = trains_;
    record_.lasted = trains_ * span_;
    // Bands that are nearer to each other than half a window are not told apart either.
    record_.bands =
        measure::bands_between(settings_.next_disturbance, begin_, record_.lasted,
                               record_.lasted / (2 * static_cast<std::int64_t>(settings_.most_windows)));
    record_.delivery_faults = network_.delivery_faults();
    record_.remarks = network_.remarks();
    record_.has_stopped = network_.state() != State::exchanging;
    if (record_.has_stopped) {
      record_.complaint = network_.complaint();
      record_.stopped_after = std::max(last_served_ - begin_, Duration{});
    }
    for (const Watched& watched : watched_) {
      record_.paths.push_back({watched.path, measure::edge_skew(watched.recorder, settings_.phase_during),
                               trace_of(watched.recorder)});
    }
    for (measure::TornImageCounter& image : images_) {
      image.finish();
      record_.images += image.images();
      record_.torn_images += image.torn_images();
    }
    network_.end();
    return std::move(record_);
  }

  Network& network_;
  const SignalSettings& settings_;
  measure::SignalGenerator generator_;
  std::deque<measure::TornImageCounter> images_;
  std::deque<Watched> watched_;
  std::map<std::size_t, Watched*> by_sink_;
  Duration cycle_{};
  std::optional<Duration> measured_cycle_;
  Duration span_{};
  std::int64_t trains_ = 0;
  Time begin_{};
  Time last_served_{};
  bool is_recording_ = false;
  std::vector<std::optional<Time>> last_begin_;
  SignalRecord record_;
};

}  // namespace

SignalRecord record_signal(Network& network, const SignalSettings& settings) {
  return SignalRun(network, settings).run();
}

}  // namespace fieldproof::network
