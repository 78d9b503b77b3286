#include "protocols/interbus/signal_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "harness/kernel/error.hpp"
#include "harness/kernel/random.hpp"
#include "harness/measure/torn_image.hpp"
#include "harness/measure/two_channel_recorder.hpp"
#include "protocols/interbus/latching_slave.hpp"
#include "protocols/interbus/live_network.hpp"
#include "protocols/interbus/station_timing.hpp"

namespace fieldproof::interbus {
namespace {

using kernel::Duration;
using kernel::Time;

// Behind a train: its phase takes up to one cycle, its last edge up to three to the output.
constexpr std::int64_t kRestCycles = 6;

Ring::MakeSlave slaves_for(const NetworkDescription& network, const SignalSettings& settings) {
  if (settings.make_slave) return settings.make_slave;
  const Duration way = sample_to_latch(network);
  return [latch = settings.latch, way](int, const SlaveConfiguration& configuration) {
    return std::make_unique<LatchingSlave>(configuration, latch, way);
  };
}

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

// A recorder, and where its word stands among those that belong together.
struct Watched {
  CopiedPath path;
  measure::TwoChannelRecorder recorder;
  measure::TornImageCounter* image;
  std::size_t word;
};

class SignalRun {
 public:
  SignalRun(const NetworkDescription& network, const SignalSettings& settings)
      : settings_(settings), live_(network, slaves_for(network, settings)), generator_(settings.wave) {
    watch(copied_paths(network));
    if (!live_.bring_up()) refuse(network.name, live_.status());
    if (settings_.disturb) settings_.disturb(live_.ring(), live_.segment());
    cycle_ = live_.status().cycle_time;
  }

  SignalRecord run() {
    plan_trains();
    const MasterStatus before = live_.status();
    live_.forget_starts();
    for (std::int64_t train = 1; train <= trains_; ++train) {
      live_.segment().run_until(begin_ + train * span_);
      collect_cycles();
      collect_outputs();
    }
    return finish(before);
  }

 private:
  [[noreturn]] static void refuse(const std::string& name, const MasterStatus& status) {
    throw kernel::Error(
        kernel::ErrorKind::configuration,
        fmt::format(
            "network \"{}\": no data cycles within ten seconds of power-up ({}); a network to "
            "measure must come up",
            name,
            status.configuration_error.empty() ? "no configuration error" : status.configuration_error));
  }

  void watch(const std::vector<CopiedPath>& paths) {
    std::map<std::pair<int, int>, std::size_t> words;
    for (const CopiedPath& path : paths) ++words[{path.from, path.to}];
    std::map<std::pair<int, int>, measure::TornImageCounter*> images;
    std::map<std::pair<int, int>, std::size_t> next_word;
    for (const auto& [stations, count] : words) images[stations] = &images_.emplace_back(count);
    for (const CopiedPath& path : paths) {
      const std::pair stations{path.from, path.to};
      Watched& watched = watched_.emplace_back(
          Watched{path, measure::TwoChannelRecorder(generator_), images[stations], next_word[stations]++});
      live_.ring().terminals(path.from).set_signal(
          path.input_word, [&watched](Time when) { return watched.recorder.input(when); });
    }
  }

  void plan_trains() {
    live_.segment().run_for(3 * cycle_);
    const Time start =
        live_.data_cycle_starts().empty() ? live_.segment().now() : live_.data_cycle_starts().back();
    begin_ = start + 2 * cycle_;
    const Duration busy =
        settings_.wave.phase + settings_.wave.frequency.periods(settings_.periods_per_train);
    span_ = (busy / cycle_ + 1 + kRestCycles) * cycle_;
    trains_ = std::max<std::int64_t>(1, settings_.duration / span_);
    const auto phases = spread_phases(trains_, cycle_, kernel::Random(settings_.seed).split("phases"));
    for (std::int64_t train = 0; train < trains_; ++train) {
      generator_.trigger(begin_ + train * span_ + phases[static_cast<std::size_t>(train)],
                         settings_.periods_per_train);
    }
  }

  void collect_cycles() {
    for (const Time start : live_.data_cycle_starts()) {
      if (last_start_) {
        record_.cycle_times.add(measure::phase_during(settings_.phase_during, *last_start_, start),
                                start - *last_start_);
      }
      last_start_ = start;
    }
    live_.forget_starts();
  }

  void collect_outputs() {
    for (int position = 1; position <= static_cast<int>(live_.ring().size()); ++position) {
      TerminalBlock& terminals = live_.ring().terminals(position);
      for (const TerminalBlock::Change& change : terminals.changes()) on_change(position, change);
      terminals.forget_changes();
    }
  }

  void on_change(int position, const TerminalBlock::Change& change) {
    for (Watched& watched : watched_) {
      if (watched.path.to != position || watched.path.output_word != change.word) continue;
      watched.recorder.on_output(change.when, change.after);
      watched.image->on_word(watched.word, change.when, watched.recorder.shown_edge());
    }
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

  SignalRecord finish(const MasterStatus& before) {
    const MasterStatus after = live_.status();
    record_.settings = settings_;
    record_.trains = trains_;
    record_.data_cycles = after.data_cycles - before.data_cycles;
    record_.id_cycles = after.id_cycles - before.id_cycles;
    record_.rejected_cycles = after.rejected_cycles - before.rejected_cycles;
    record_.has_stopped = after.state != MasterState::run;
    for (const Watched& watched : watched_) {
      record_.paths.push_back({watched.path, measure::edge_skew(watched.recorder, settings_.phase_during),
                               trace_of(watched.recorder)});
    }
    for (measure::TornImageCounter& image : images_) {
      image.finish();
      record_.images += image.images();
      record_.torn_images += image.torn_images();
    }
    return std::move(record_);
  }

  const SignalSettings& settings_;
  LiveNetwork live_;
  measure::SignalGenerator generator_;
  std::deque<measure::TornImageCounter> images_;
  std::deque<Watched> watched_;
  Duration cycle_{};
  Duration span_{};
  std::int64_t trains_ = 0;
  Time begin_{};
  std::optional<Time> last_start_;
  SignalRecord record_;
};

}  // namespace

std::vector<CopiedPath> copied_paths(const NetworkDescription& network) {
  const std::vector<RingPlace> places = ring_order(network);
  const auto position = [&](const std::string& name) {
    const auto at =
        std::ranges::find(places, name, [](const RingPlace& place) { return place.station->name; });
    return static_cast<int>(at - places.begin()) + 1;
  };
  std::vector<CopiedPath> paths;
  for (const CopyRule& rule : network.copy) {
    paths.push_back(
        {position(rule.from), rule.input_word, position(rule.to), rule.output_word,
         fmt::format("{} word {} to {} word {}", rule.from, rule.input_word, rule.to, rule.output_word)});
  }
  return paths;
}

SignalRecord record_signal(const NetworkDescription& network, const SignalSettings& settings) {
  if (network.copy.empty()) {
    throw kernel::Error(kernel::ErrorKind::configuration,
                        fmt::format("network \"{}\": /copy: nothing is copied from an input to an output; "
                                    "name at least one copy",
                                    network.name));
  }
  return SignalRun(network, settings).run();
}

}  // namespace fieldproof::interbus
