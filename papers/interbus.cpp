// The sections of Park 2004 that need no disturbance: cycle times, the highest frequency, square waves.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "harness/measure/cyclic_copy.hpp"
#include "harness/network/signal_run.hpp"
#include "papers/sections.hpp"
#include "protocols/interbus/paper.hpp"
#include "protocols/interbus/running_network.hpp"
#include "protocols/interbus/timing.hpp"

namespace fieldproof::papers {
namespace {

using interbus::Formula;
using interbus::NetworkDescription;
using kernel::Duration;
using network::SignalRecord;
using reports::PublishedRow;
using reports::PublishedSection;

// What the paper publishes in numbers. Its traces of input and output are pictures without a number.
constexpr Duration kCalculatedCycle = 755 * kernel::kMicrosecond;  // "about 0.755 ms"
constexpr Duration kSetCycle = 860 * kernel::kMicrosecond;         // set first
constexpr double kHighestFrequencyHz = 614;
constexpr std::array<std::int64_t, 3> kSignalsHz = {50, 150, 200};

constexpr double kHalfOfLastDigitMs = 0.0005;  // the paper prints three decimals of a millisecond
constexpr double kLastDigitMs = 0.001;
constexpr double kNearly = 0.01;  // what is called nearly equal
constexpr double kTwoTelegramsMs = 2 * 1.15 * 13 * 0.002;
constexpr std::uint64_t kFewestPulses = 100;

double milliseconds(double picoseconds) {
  return picoseconds / 1e9;
}
double milliseconds(Duration duration) {
  return milliseconds(static_cast<double>(duration.count()));
}

std::string told(Duration duration) {
  return fmt::format("{:.4f} ms", milliseconds(duration));
}

NetworkDescription at_cycle(NetworkDescription network, Duration cycle) {
  network.cycle_time = cycle;
  return network;
}

SignalRecord record_at(const NetworkDescription& description, const Settings& settings,
                       measure::Frequency frequency, Duration duration) {
  network::SignalSettings signal;
  signal.wave.frequency = frequency;
  signal.duration = duration;
  signal.seed = settings.seed;
  interbus::RunningNetwork network(description);
  return network::record_signal(network, signal);
}

// The cycle time that a network runs at, from a second of it.
Duration measured_cycle(const NetworkDescription& network, const Settings& settings) {
  const SignalRecord record =
      record_at(network, settings, measure::Frequency::from_hertz(50), kernel::kSecond);
  return Duration{std::llround(record.cycles.front().times.total().mean())};
}

PublishedRow cycle_row(std::string what, Duration published, Duration reproduced, std::string remark) {
  return {std::move(what), fmt::format("{} ms", milliseconds(published)), told(reproduced), std::move(remark),
          reports::within(milliseconds(published), kHalfOfLastDigitMs, milliseconds(reproduced), "ms")};
}

Duration by_formula(Formula formula, unsigned user_octets) {
  interbus::TimingInput input = interbus::timing_input(interbus::paper_network());
  input.user_octets = user_octets;
  return interbus::cycle_time(formula, input);
}

}  // namespace

PublishedSection interbus_cycle_times(const Settings& settings) {
  const NetworkDescription network = interbus::paper_network();
  const NetworkDescription as_printed = interbus::paper_network_as_printed();
  const Duration shortest = measured_cycle(network, settings);
  const Duration shortest_as_printed = measured_cycle(as_printed, settings);
  const Duration printed = by_formula(Formula::f1, 4);
  PublishedSection section;
  section.heading = "Cycle time: calculated 0.755 ms, best at 0.814 ms, first set to 0.86 ms";
  section.note =
      "The paper calls 0.755 and 0.814 ms nearly equal; they are 7.8 % apart and it gives no reason.";
  section.rows = {
      cycle_row("calculated, as printed: 8 + n telegrams, n = 2", kCalculatedCycle,
                by_formula(Formula::f1, 2), "f1 = [1.15 * 13 * (8 + n) + 3 m] t_bit + 450 us; m = 1"),
      cycle_row("calculated, the network itself: 6 + n, n = 4", kCalculatedCycle, by_formula(Formula::f4, 4),
                "f4; the two modules have 4 octets and the text counts 6 octets of frame information"),
      cycle_row("shortest cycle of that network", kCalculatedCycle, shortest,
                "simulated, telegram by telegram"),
      cycle_row("calculated, as printed, with the 4 octets of the network", kCalculatedCycle, printed,
                "f1 with n = 4: the paper calculates its network of 4 octets with n = 2"),
      {"calculated beside the best time", "nearly equal", told(interbus::kPaperBestCycle - kCalculatedCycle),
       "0.814 - 0.755 ms: 7.8 %, of which the paper gives no reason",
       reports::within(milliseconds(kCalculatedCycle), kNearly * milliseconds(kCalculatedCycle),
                       milliseconds(interbus::kPaperBestCycle), "ms")},
      {"shortest cycle with 8 + n telegrams", "0.814 ms (set, best result)", told(shortest_as_printed),
       "simulated; that 0.814 ms is this time with its last digit cut is a reading, the paper does not say "
       "so",
       reports::within(milliseconds(interbus::kPaperBestCycle), kLastDigitMs,
                       milliseconds(shortest_as_printed), "ms")},
      {"from 6 + n to 8 + n telegrams", "",
       fmt::format("{:.1f} us", 1e3 * milliseconds(shortest_as_printed - shortest)),
       "exactly two telegrams, 2 * 1.15 * 13 bit * 2 us: 8 + n as printed instead of 6 + n, both with n = 4",
       reports::own(
           reports::within(kTwoTelegramsMs, 1e-6, milliseconds(shortest_as_printed - shortest), "ms"))},
      cycle_row("set to the best time", interbus::kPaperBestCycle,
                measured_cycle(at_cycle(network, interbus::kPaperBestCycle), settings), "simulated"),
      cycle_row("set to the first time", kSetCycle, measured_cycle(at_cycle(network, kSetCycle), settings),
                "simulated")};
  return section;
}

PublishedSection interbus_highest_frequency(const Settings& settings) {
  const NetworkDescription network = at_cycle(interbus::paper_network(), interbus::kPaperBestCycle);
  const double highest = measure::highest_frequency_hz(interbus::kPaperBestCycle);
  PublishedSection section;
  section.heading = "Highest frequency: 614 Hz at 0.814 ms";
  section.note = "f_max = 1 / (2 T): half a period lasts one cycle. The paper calls it theoretical only.";
  section.rows.push_back({"f_max", fmt::format("{} Hz", kHighestFrequencyHz),
                          fmt::format("{:.2f} Hz", highest), "by the closed form",
                          reports::within(kHighestFrequencyHz, 0.5, highest, "Hz")});
  for (const std::int64_t hertz : {614, 620, 700}) {
    const SignalRecord record =
        record_at(network, settings, measure::Frequency::from_hertz(hertz), settings.duration);
    const measure::EdgeSkew& skew = record.paths.front().skew;
    const double expected =
        measure::pulse_width(record.settings.wave.high(), interbus::kPaperBestCycle).lost_probability;
    const auto pulses = static_cast<double>(skew.pulses);
    const double lost = static_cast<double>(skew.lost_pulses) / pulses;
    // Four standard errors of a share.
    const double tolerance = 100 * 4 * std::sqrt(expected * (1 - expected) / pulses);
    section.rows.push_back(
        {fmt::format("pulses lost at {} Hz", hertz), "",
         fmt::format("{} of {} ({:.2f} %)", skew.lost_pulses, skew.pulses, 100 * lost),
         fmt::format("simulated; by theory 1 - H/T = {:.2f} %", 100 * expected),
         reports::of_samples(reports::own(reports::within(100 * expected, tolerance, 100 * lost, "%")),
                             skew.pulses, kFewestPulses)});
  }
  return section;
}

PublishedSection interbus_square_waves(const Settings& settings) {
  const NetworkDescription network = at_cycle(interbus::paper_network(), interbus::kPaperBestCycle);
  PublishedSection section;
  section.heading = "Input and output at 50, 150 and 200 Hz";
  section.note =
      "The paper shows pictures of an oscilloscope without a number, and says that the distortion grows "
      "towards the highest frequency. Latch model M2.";
  for (const std::int64_t hertz : kSignalsHz) {
    const SignalRecord record =
        record_at(network, settings, measure::Frequency::from_hertz(hertz), settings.duration);
    const network::PathRecord& path = record.paths.front();
    const auto delays = path.skew.rise_delays.total();
    const auto widths = path.skew.widths.total();
    const auto theory =
        interbus::path_delay(network, path.path.from, path.path.to, interbus::LatchModel::frame_edges);
    const auto duty = [&](std::int64_t picoseconds) {
      return 100 * milliseconds(static_cast<double>(picoseconds)) * 1e-3 * static_cast<double>(hertz);
    };
    const double most = 100 * measure::max_duty_error(static_cast<double>(hertz), interbus::kPaperBestCycle);
    section.rows.push_back(
        {fmt::format("{} Hz: delay of an edge", hertz), "",
         fmt::format("{:.3f} to {:.3f} ms", milliseconds(static_cast<double>(delays.min())),
                     milliseconds(static_cast<double>(delays.max()))),
         fmt::format("mean {:.3f} ms; by theory {:.3f} to {:.3f} ms, mean {:.3f} ms",
                     milliseconds(delays.mean()), milliseconds(theory.min), milliseconds(theory.max),
                     milliseconds(theory.mean)),
         reports::of_samples(
             reports::own(reports::at_most(milliseconds(theory.max),
                                           milliseconds(static_cast<double>(delays.max())), "ms")),
             path.skew.pulses, kFewestPulses)});
    section.rows.push_back(
        {fmt::format("{} Hz: duty cycle of a period at the output", hertz), "",
         fmt::format("{:.1f} to {:.1f} %", duty(widths.min()), duty(widths.max())),
         fmt::format("50 % at the input; by theory at most {:.2f} % off: T f", most),
         reports::of_samples(reports::own(reports::at_most(
                                 most, std::max(50 - duty(widths.min()), duty(widths.max()) - 50), "%")),
                             path.skew.pulses, kFewestPulses)});
    measure::Trace trace = path.trace;
    trace.length = std::min(trace.length, 60 * kernel::kMillisecond);
    section.traces.push_back({fmt::format("{} Hz", hertz), std::move(trace)});
  }
  return section;
}

}  // namespace fieldproof::papers
