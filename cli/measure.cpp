#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/burst_options.hpp"
#include "cli/exit_code.hpp"
#include "cli/run_setup.hpp"
#include "cli/simulated_network.hpp"
#include "cli/stored_document.hpp"
#include "cli/verbs.hpp"
#include "emc/framing.hpp"
#include "emc/interbus/burst_clamp.hpp"
#include "harness/kernel/error.hpp"
#include "harness/measure/frequency.hpp"
#include "protocols/interbus/network_measurement.hpp"
#include "reports/measurement_writer.hpp"

// `fieldproof measure`: cycle time, jitter and skew of a network, theory beside measurement.
namespace fieldproof::cli {
namespace {

std::vector<measure::SquareWave> signals_from(const Settings& settings) {
  std::vector<measure::SquareWave> signals;
  for (const std::string& word : settings.words("signal")) {
    const auto frequency = measure::Frequency::read(word);
    if (!frequency) {
      settings.refuse("signal", fmt::format("'{}' is no frequency of 1 mHz to 1 MHz; write for example "
                                            "50Hz,614.25Hz,1.5kHz",
                                            word));
    }
    signals.push_back({.frequency = *frequency});
  }
  return signals;
}

interbus::MeasurementSettings measurement_from(const Settings& settings) {
  constexpr std::array kModels = {interbus::LatchModel::same_instant, interbus::LatchModel::frame_edges,
                                  interbus::LatchModel::previous_frame};
  interbus::MeasurementSettings measurement;
  measurement.signals = signals_from(settings);
  measurement.duration = virtual_time_from(settings);
  measurement.latch = kModels.at(settings.choice("latch"));
  measurement.seed = settings.number("seed", 0, std::numeric_limits<std::uint64_t>::max());
  return measurement;
}

int code_of(measure::Agreement agreement) {
  switch (agreement) {
    case measure::Agreement::holds:
      return kAllAsExpected;
    case measure::Agreement::open:
      return kInconclusive;
    case measure::Agreement::differs:
      return kFailed;
  }
  return kInternal;
}

// Bursts that begin with the signal and go on until its end.
class BurstsWhileMeasuring {
 public:
  BurstsWhileMeasuring(const Settings& settings, const interbus::NetworkDescription& network,
                       std::uint64_t seed)
      : profile_(profile_from(settings)), bursts_(bursts_from(settings)) {
    const interbus::Rules& rules = network.rules;
    const emc::LineResponse response(profile_.coupling);
    clamp_.emplace(bursts_, response.wrong_output(bursts_.level.open_circuit_volts(), bursts_.polarity),
                   emc::BurstReceiver{rules.bit_rate, std::make_shared<emc::TelegramFraming>(rules.telegram),
                                      line::Sampling{}, true, true},
                   kernel::Random(seed).split("bursts"),
                   rules.published_recovery_cycles * interbus::cycle_time_in_force(network));
  }

  void disturb(interbus::MeasurementSettings& measurement) {
    measurement.disturb = [this](interbus::Ring& ring, segment::Segment& segment) {
      clamp_->couple(ring, segment, segment.now());
    };
    measurement.phase_during = [this](kernel::Time from, kernel::Time to) {
      return clamp_->phase_during(from, to);
    };
    measurement.conditions.push_back(
        {"bursts",
         fmt::format("{}, {}, level {}, profile {} ({})", emc::text_of(bursts_.repetition),
                     emc::text_of(bursts_.polarity), bursts_.level.text(), profile_.name, profile_.title)});
    for (const std::string& caveat : emc::caveats_of(profile_)) {
      measurement.conditions.push_back({"unverified", caveat});
    }
  }

 private:
  emc::Profile profile_;
  emc::BurstSettings bursts_;
  std::optional<emc::BurstClamp> clamp_;
};

measure::Measurement measure_interbus(Session& session) {
  interbus::MeasurementSettings settings = measurement_from(session.settings);
  const interbus::NetworkDescription network = simulated_network_from(session.settings);
  std::optional<BurstsWhileMeasuring> bursts;
  if (session.settings.is_set("bursts")) {
    bursts.emplace(session.settings, network, settings.seed).disturb(settings);
  } else if (session.settings.origin("profile") == Origin::command_line) {
    session.settings.refuse("profile", "a profile is one of bursts; say which with --bursts");
  }
  settings.on_progress = [&](std::size_t done) { session.terminal.progress(done); };
  session.terminal.print(
      simulation_header(session, settings.seed, session.settings.text("network"), kCycleTimePaper));
  session.terminal.begin_progress(settings.signals.size(), "signals");
  measure::Measurement measured = interbus::measure_network(network, settings);
  session.terminal.end_progress();
  return measured;
}

struct Measured {
  std::string_view protocol;
  measure::Measurement (*serve)(Session&);
};
constexpr std::array kMeasured = {Measured{"interbus", &measure_interbus}};

}  // namespace

int measure_protocol(Session& session) {
  const std::string& protocol = session.operands.front();
  const auto row = std::ranges::find(kMeasured, protocol, &Measured::protocol);
  if (row == kMeasured.end()) {
    throw kernel::Error(kernel::ErrorKind::usage,
                        fmt::format("there is nothing to measure of '{}'; there is 'interbus'", protocol));
  }
  const measure::Measurement measured = row->serve(session);
  session.terminal.print(reports::measurement_text(measured));
  write_document(session, "measure", reports::measurement_json(measured));
  const int code = code_of(measure::agreement(measured));
  if (code != kAllAsExpected) {
    session.terminal.print(fmt::format("reproduce: fieldproof measure {} {}\n", session.operands.front(),
                                       session.settings.reproduce_options()));
  }
  return code;
}

}  // namespace fieldproof::cli
