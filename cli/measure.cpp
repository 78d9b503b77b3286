#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "cli/burst_options.hpp"
#include "cli/exit_code.hpp"
#include "cli/interruption.hpp"
#include "cli/networks.hpp"
#include "cli/run_setup.hpp"
#include "cli/stored_document.hpp"
#include "cli/verbs.hpp"
#include "conformance/assigned.hpp"
#include "emc/burst_clamp.hpp"
#include "harness/measure/cyclic_copy.hpp"
#include "harness/measure/frequency.hpp"
#include "harness/network/network_measurement.hpp"
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
                                            "50Hz, 614.25 Hz, 1.5kHz or 250 mHz (millihertz)",
                                            word));
    }
    signals.push_back({.frequency = *frequency});
  }
  return signals;
}

// Of the usual signals those that the network can carry; where it carries none, one whose edges meet each
// phase of its cycle.
std::vector<measure::SquareWave> signals_for(const network::Network& network,
                                             std::vector<measure::SquareWave> usual) {
  constexpr double kMillihertzOfTheLimit = 437;
  const std::span<const network::CycleKind> kinds = network.cycles();
  if (kinds.empty() || kinds.front().theory <= kernel::Duration::zero()) return usual;
  const double limit = measure::highest_frequency_hz(kinds.front().theory + kinds.front().jitter);
  std::erase_if(usual, [limit](const measure::SquareWave& one) { return one.frequency.hertz() > limit; });
  if (usual.empty()) {
    const std::int64_t millihertz = std::max<std::int64_t>(1, std::llround(kMillihertzOfTheLimit * limit));
    usual.push_back({.frequency = measure::Frequency::from_millihertz(millihertz)});
  }
  return usual;
}

// So that the slowest signal has some fifty trains.
kernel::Duration duration_for(const std::vector<measure::SquareWave>& signals, kernel::Duration usual) {
  constexpr std::int64_t kPeriods = 400;
  kernel::Duration longest = usual;
  for (const measure::SquareWave& one : signals) longest = std::max(longest, one.frequency.periods(kPeriods));
  return std::min<kernel::Duration>(longest, 3'600 * kernel::kSecond);
}

network::MeasurementSettings measurement_from(const Session& session) {
  network::MeasurementSettings measurement;
  measurement.protocol = session.operands.front();
  measurement.signals = signals_from(session.settings);
  measurement.duration = virtual_time_from(session.settings);
  measurement.seed = session.settings.number("seed", 0, std::numeric_limits<std::uint64_t>::max());
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
  BurstsWhileMeasuring(const Settings& settings, const conformance::PlannedNetwork& planned,
                       std::uint64_t seed)
      : profile_(settings.origin("profile") == Origin::fallback
                     ? emc::Profile::named(planned.default_profile())
                     : profile_from(settings)),
        bursts_(bursts_from(settings)),
        clamp_(bursts_,
               emc::LineResponse(profile_.coupling)
                   .wrong_output(bursts_.level.open_circuit_volts(), bursts_.polarity),
               kernel::Random(seed).split("bursts"), planned.make(seed)->recovery_limit().time) {}

  void disturb(network::MeasurementSettings& measurement) {
    measurement.disturb = [this](network::Network& network) {
      clamp_.couple(network, network.segment().now());
    };
    measurement.phase_during = [this](kernel::Time from, kernel::Time to) {
      return clamp_.phase_during(from, to);
    };
    measurement.next_disturbance = [this](kernel::Time after) { return clamp_.burst_after(after); };
    measurement.conditions.push_back(
        {"bursts",
         fmt::format("{}, {}, level {}, profile {} ({})", emc::text_of(bursts_.repetition),
                     emc::text_of(bursts_.polarity), bursts_.level.text(), profile_.name, profile_.title)});
    for (const std::string& caveat : emc::caveats_of(profile_)) {
      measurement.conditions.push_back({std::string(reports::kCaveat), caveat});
    }
  }

 private:
  emc::Profile profile_;
  emc::BurstSettings bursts_;
  emc::BurstClamp clamp_;
};

measure::Measurement measured_by(Session& session, std::stop_token stop) {
  const ProtocolEntry& row = network_entry_of(session, "measure");
  const std::unique_ptr<conformance::PlannedNetwork> planned = plan_network(session, row);
  network::MeasurementSettings settings = measurement_from(session);
  if (session.settings.origin("signal") == Origin::fallback) {
    settings.signals = signals_for(*planned->make(settings.seed), std::move(settings.signals));
    if (session.settings.origin("duration") == Origin::fallback)
      settings.duration = duration_for(settings.signals, settings.duration);
  }
  std::optional<BurstsWhileMeasuring> bursts;
  if (session.settings.is_set("bursts")) {
    bursts.emplace(session.settings, *planned, settings.seed).disturb(settings);
  } else if (session.settings.origin("profile") == Origin::command_line) {
    session.settings.refuse("profile", "a profile is one of bursts; say which with --bursts");
  }
  settings.stop = std::move(stop);
  settings.on_progress = [&](std::size_t done) { session.terminal.progress(done); };
  session.terminal.print(
      simulation_header(session, settings.seed, session.settings.text("network"), row.network.own_network));
  session.terminal.print(players_text(network_implementations(session, row)));
  session.terminal.begin_progress(settings.signals.size(), "signals");
  measure::Measurement measured =
      network::measure_network([&](std::uint64_t seed) { return planned->make(seed); }, settings);
  session.terminal.end_progress();
  measured.implementations = players_of(network_implementations(session, row));
  return measured;
}

}  // namespace

int measure_protocol(Session& session) {
  const Interruption interruption(session.settings.duration("max-time"));
  const measure::Measurement measured = measured_by(session, interruption.token());
  session.terminal.print(reports::measurement_text(measured));
  write_document(session, "measure", reports::measurement_json(measured));
  if (!interruption.reason().empty()) session.terminal.log(interruption.reason());
  if (interruption.signal() != 0) return kSignalBase + interruption.signal();
  if (measured.series.empty()) return kNothingJudged;
  int code = measured.failures.empty() ? code_of(measure::agreement(measured)) : kFailed;
  if (code != kAllAsExpected && measured.failures.empty() && !measured.implementations.empty()) {
    session.terminal.print(
        "The closed forms are those of the reference stations. Others may be faster or slower within\n"
        "what the standard allows, so a difference is no failure here, and a row that is open may be one;\n"
        "'fieldproof run' judges each station.\n");
    code = kInconclusive;
  }
  if (code != kAllAsExpected) {
    session.terminal.print(fmt::format("reproduce: fieldproof measure {} {}\n", session.operands.front(),
                                       session.settings.reproduce_options()));
  }
  return code;
}

}  // namespace fieldproof::cli
