#include "cli/emc_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "harness/trace/recording.hpp"

namespace fieldproof::cli {
namespace {

constexpr std::size_t kMostChanges = 12;  // that are told

// What lies outside of the windows passes; what is changed is noted.
class WindowedChannel final : public fault::Channel {
 public:
  WindowedChannel(fault::Channel& channel, const std::vector<EmcWindow>& windows, trace::Channel receiver,
                  EmcRun& run)
      : channel_(channel), windows_(windows), receiver_(receiver), run_(run) {}

  bool pass(const line::Waveform& sent, line::Waveforms& arrivals) override {
    const auto holds = [&sent](const EmcWindow& window) { return window.holds(sent.start); };
    if (!windows_.empty() && std::ranges::none_of(windows_, holds)) return false;
    const std::size_t first = arrivals.size();
    if (!channel_.pass(sent, arrivals)) return false;
    run_.changed.push_back(sent.start);
    if (run_.changes.size() < kMostChanges) {
      trace::Change& change = run_.changes.emplace_back(trace::Change{receiver_, sent, {}});
      for (std::size_t n = first; n < arrivals.size(); ++n) change.arrivals.push_back(arrivals[n]);
    }
    return true;
  }

 private:
  fault::Channel& channel_;
  const std::vector<EmcWindow>& windows_;
  trace::Channel receiver_;
  EmcRun& run_;
};

}  // namespace

EmcRun run_emc_case(const EmcCase& test, const emc::LineResponse& response, bool is_recorded,
                    std::stop_token stop) {
  EmcRun run;
  run.dissector = std::make_shared<trace::PlainDissector>();
  const auto struck = std::make_shared<FlippedBits>();
  emc::ImmunitySettings settings = immunity_settings(test, std::move(stop));
  std::unique_ptr<network::Network> network;
  std::optional<trace::BoundedRecorder> recorder;
  try {
    network = test.network->make(test.seed);
    if (auto dissector = network->dissector()) run.dissector = std::move(dissector);
    settings.around = [&](fault::Channel& channel, const network::Place& place) {
      // Where levels are finer than bits, as half bits are, each is looked at.
      const std::int64_t bit_rate = run.dissector->bit_rate();
      return watched(std::make_unique<WindowedChannel>(channel, test.windows, place.trace_channel, run),
                     place.name, bit_rate > 0 ? bit_rate : place.level_rate, struck);
    };
    recorder.emplace(network->segment().trace());
    if (is_recorded) network->segment().trace().set_recorder(&*recorder);
    run.result = emc::run_immunity(*network, response, settings);
  } catch (const iut::Misbehaviour& misbehaviour) {
    run.result = end_by(misbehaviour);
  }
  // Also of a run that ended by what an implementation did: what was on the line until then is shown.
  if (recorder) {
    trace::Trace& trace = network->segment().trace();
    trace.set_recorder(nullptr);
    for (trace::Channel n = 0; n < trace.channel_count(); ++n) run.channels.push_back(trace.channel_name(n));
    run.recording = recorder->take();
  }
  run.struck = std::move(*struck);
  return run;
}

}  // namespace fieldproof::cli
