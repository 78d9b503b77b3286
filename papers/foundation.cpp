// The sections of Hong and Son about the delay of urgent data in the Foundation Fieldbus. The paper shows its
// results as pictures: no number of them can be compared, only equations, parameters and sentences.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "harness/traffic/milliseconds.hpp"
#include "harness/traffic/token_rotation.hpp"
#include "harness/traffic/urgent_delay.hpp"
#include "papers/sections.hpp"
#include "protocols/fieldbus_dll/urgent_experiment.hpp"

namespace fieldproof::papers {
namespace {

using reports::PublishedRow;
using reports::PublishedSection;
using traffic::UrgentTraffic;

constexpr std::array kLoads = {0.2, 0.35, 0.5};
constexpr std::array kTargets = {16'600, 20'000, 25'000, 30'000, 34'816, 48'680, 60'000};  // TTRT, us
constexpr double kFlowTolerance = 0.001;  // of a mean rotation, beside chance
constexpr double kModelTolerance = 0.02;  // of what the model is said to be good for
constexpr std::uint64_t kFewestPackets = 1'000;

struct Shares {
  std::string_view name;
  double urgent, available;
};
constexpr std::array kShares = {Shares{"2:1", 2, 1}, Shares{"1:1", 1, 1}, Shares{"1:2", 1, 2}};

double octets_ms(unsigned octets) {
  return octets * 0.008;  // at 1 Mbit/s
}

// As much leaves as arrives: R / (1 - U).
double balanced_rotation(const UrgentTraffic& traffic) {
  return traffic::ms(traffic.empty_rotation) / (1 - traffic.load());
}

// A traffic, as the model has it and as its queues and rotations go.
class Studied {
 public:
  Studied(const traffic::UrgentTraffic& traffic, std::uint64_t seed)
      : traffic_(traffic),
        model_(traffic::urgent_delay(traffic)),
        conserving_(traffic::urgent_delay(traffic, traffic::Balance::flow_conserving)),
        simulated_(traffic::rotate_token(traffic, {.seed = seed})),
        is_starved_(traffic::available_capacity(traffic, seed) <= traffic.available_per_ms) {}

  const traffic::UrgentDelay& model() const { return model_; }
  const traffic::UrgentDelay& conserving() const { return conserving_; }
  const traffic::TokenFigures& simulated() const { return simulated_; }
  bool is_starved() const { return is_starved_; }
  kernel::Duration target() const { return traffic_.target_rotation; }

  PublishedRow row(std::string what) const {
    return {std::move(what), "", reproduced(), remark(), compared()};
  }

 private:
  std::string reproduced() const {
    return fmt::format("{:.4f} ms (+- {:.4f}) simulated, mean ATRT {:.3f} ms, P1 {:.4f}",
                       simulated_.mean_delay, 1.96 * simulated_.standard_error, simulated_.mean_rotation,
                       simulated_.priority_1);
  }
  std::string remark() const {
    if (model_.is_urgent_unstable) return "the model has no stationary state: urgent queues grow";
    std::string text = fmt::format(
        "model (26) {:.4f} ms ({:+.1f} %), as printed {:.4f} ms, without its own rotation {:.4f} ms, "
        "flow-conserving {:.4f} ms",
        model_.delay, 100 * (model_.delay / simulated_.mean_delay - 1), model_.delay_as_printed,
        model_.delay_without_own_rotation, conserving_.delay_without_own_rotation);
    if (is_starved_) {
      text += fmt::format(
          "; unstable: more time-available data come than the token can carry, {} wait in a "
          "queue at the end",
          simulated_.longest_available);
    }
    return text;
  }
  // What must hold whatever the model says: as much leaves as arrives, so a rotation takes R / (1 - U).
  std::optional<reports::Compared> compared() const {
    if (is_starved_) return std::nullopt;
    return reports::own(
        reports::within(balanced_rotation(traffic_),
                        kFlowTolerance * balanced_rotation(traffic_) + 3 * simulated_.rotation_error,
                        simulated_.mean_rotation, "ms"));
  }

  traffic::UrgentTraffic traffic_;
  traffic::UrgentDelay model_;
  traffic::UrgentDelay conserving_;
  traffic::TokenFigures simulated_;
  bool is_starved_;
};

// Model and simulation over one parameter.
class DelayCurves {
 public:
  DelayCurves(std::string name, std::string x_label)
      : figure_{std::move(name),
                std::move(x_label),
                "mean delay, ms",
                {{"simulation", {}}, {"model (26)", {}}, {"flow-conserving model", {}}}} {}

  void add(double x, const Studied& one) {
    figure_.curves[0].points.push_back({x, one.simulated().mean_delay});
    if (!one.model().is_urgent_unstable) figure_.curves[1].points.push_back({x, one.model().delay});
    if (!one.conserving().is_urgent_unstable)
      figure_.curves[2].points.push_back({x, one.conserving().delay_without_own_rotation});
  }
  reports::PublishedCurves figure() const { return figure_; }

 private:
  reports::PublishedCurves figure_;
};

// Stations and frames beside the simulation that has neither: delays, and rotations.
void add_station_rows(PublishedSection& section, std::string what, const traffic::UrgentTraffic& traffic,
                      const Settings& settings) {
  const auto found = fieldbus_dll::run_urgent_experiment(traffic, settings.duration, settings.seed);
  const Studied studied(traffic, settings.seed);
  const traffic::TokenFigures& wanted = studied.simulated();
  PublishedRow row{
      what, "",
      fmt::format("{:.4f} ms (+- {:.4f}) of {} packets, mean ATRT {:.3f} ms, P1 {:.4f}", found.mean_delay,
                  1.96 * found.standard_error, found.urgent_packets, found.mean_rotation, found.priority_1),
      fmt::format("without frames {:.4f} ms, ATRT {:.3f} ms, P1 {:.4f}; model {:.4f} ms", wanted.mean_delay,
                  wanted.mean_rotation, wanted.priority_1, studied.model().delay),
      std::nullopt};
  if (studied.is_starved()) {
    row.remark += "; time-available queues grow, so nothing is compared";
    section.rows.push_back(std::move(row));
    return;
  }
  const double rotation = balanced_rotation(traffic);
  row.compared = reports::of_samples(
      reports::own(reports::within(
          wanted.mean_delay,
          4 * std::hypot(found.standard_error, wanted.standard_error) + 0.005 * wanted.mean_delay,
          found.mean_delay, "ms")),
      found.urgent_packets, kFewestPackets);
  section.rows.push_back(std::move(row));
  section.rows.push_back(
      {what + ": rotations", "", fmt::format("mean ATRT {:.3f} ms", found.mean_rotation),
       "beside R / (1 - U)",
       reports::of_samples(reports::own(reports::within(rotation, 0.001 * rotation + 4 * found.rotation_error,
                                                        found.mean_rotation, "ms")),
                           found.urgent_packets, kFewestPackets)});
}

kernel::Duration microseconds(int count) {
  return count * kernel::kMicrosecond;
}

// (14) integrates to the TTRT and with it an atom that equals the TTRT; the text gives that priority 0.
PublishedRow atom_row(const Studied& one) {
  double below = 0;
  double printed = 0;
  for (const traffic::RotationAtom& atom : one.model().rotation) {
    if (atom.time < one.target()) below += atom.probability;
    if (atom.time <= one.target()) printed += atom.probability;
  }
  return {"(14) beside the text, TTRT 16.6 ms: share of rotations below it", fmt::format("{:.4f}", printed),
          fmt::format("{:.4f}", below), "an ATRT that equals the TTRT gives priority 0, says the text",
          reports::within(printed, 0.001, below)};
}

PublishedRow equation_row(std::string what, double by_equation, const Studied& one, std::string remark) {
  return {std::move(what), fmt::format("{:.4f} ms", by_equation),
          fmt::format("{:.4f} ms simulated", one.simulated().mean_delay), std::move(remark),
          reports::within(by_equation, kModelTolerance * by_equation, one.simulated().mean_delay, "ms")};
}

// By Little's law the sum (26) is too long by the rotation of the packet in transmission.
PublishedRow own_rotation_row(const Studied& one) {
  const traffic::UrgentDelay& model = one.model();
  return {"(26) with the rotation of a packet in transmission, TTRT 60 ms",
          fmt::format("{:.4f} ms", model.delay),
          fmt::format("{:.4f} ms by Little's law", model.delay_without_own_rotation),
          "the rotation of that packet has begun already",
          reports::within(model.delay, 0.001, model.delay_without_own_rotation, "ms")};
}

PublishedRow balance_row(const Studied& one) {
  const double model = one.model().mean_rotation;
  return {"(5), (8), (11), TTRT 20 ms: mean rotation by (18)", fmt::format("{:.3f} ms", model),
          fmt::format("{:.3f} ms simulated", one.simulated().mean_rotation),
          "each priority as if it lasted for ever breaks the balance of flow, R / (1 - U)",
          reports::within(model, 0.01 * model, one.simulated().mean_rotation, "ms")};
}

}  // namespace

PublishedSection foundation_rotations(const Settings& settings) {
  PublishedSection section;
  section.heading = "Figures 5 and 6: how long the token takes for a rotation, U = 0.35";
  section.note =
      "The paper shows both distributions as pictures. (3) lacks a factor that (16) and (20) have; an ATRT "
      "that "
      "equals the TTRT counts as too long, as the text says and (14) leaves open.";
  for (const int target : {16'600, 34'816}) {
    const Studied one(traffic::paper_traffic(0.35, 1, 1, microseconds(target)), settings.seed);
    section.rows.push_back(
        {fmt::format("TTRT {:.3f} ms: mean ATRT and share of tokens with priority 1", target / 1e3), "",
         fmt::format("{:.3f} ms, {:.4f} simulated", one.simulated().mean_rotation,
                     one.simulated().priority_1),
         fmt::format("model (18), (15): {:.3f} ms, {:.4f}; (18) supposes that each priority "
                     "lasts for ever, and breaks the flow balance where P1 < 1",
                     one.model().mean_rotation, one.model().priority_1),
         std::nullopt});
    section.rows.push_back(
        {fmt::format("TTRT {:.3f} ms: what (3) sums up to", target / 1e3), "a distribution",
         fmt::format("{:.0f} as printed, 1 with rho11^j", one.model().printed_mass),
         "a distribution sums up to 1", reports::within(1, 1e-6, one.model().printed_mass)});
  }
  return section;
}

PublishedSection foundation_sentences(const Settings& settings) {
  PublishedSection section;
  section.heading = "What the equations and sentences say, beside each other and beside the simulation";
  section.note =
      "Each row is one of the places where the paper contradicts itself, or what its rules come to. U = "
      "0.35, "
      "lambda0:lambda1 = 1:1 where nothing else is said.";
  const auto of = [&](int target, double load = 0.35, double urgent = 1, double available = 1) {
    return Studied(traffic::paper_traffic(load, urgent, available, microseconds(target)), settings.seed);
  };
  const Studied tied = of(16'600);
  const Studied shortest = of(20'000);
  const Studied longest = of(60'000);
  section.rows = {atom_row(tied),
                  equation_row("(26) from n = 1 on, TTRT 60 ms", longest.model().delay_as_printed, longest,
                               "it loses the packet that finds nobody"),
                  own_rotation_row(longest), balance_row(shortest)};
  const auto sentence = [&](std::string what, std::string published, double with, double without) {
    section.rows.push_back({std::move(what), std::move(published),
                            fmt::format("{:+.1f} %", 100 * (with / without - 1)), "mean delays as simulated",
                            reports::more_than(without, with, "ms")});
  };
  const auto delay = [](const Studied& one) { return one.simulated().mean_delay; };
  sentence("figure 7: a TTRT of 60 ms over one of 20 ms", "longer delays", delay(longest), delay(shortest));
  sentence("figure 9: a load of 0.5 over one of 0.2, TTRT 48.68 ms", "longer delays", delay(of(48'680, 0.5)),
           delay(of(48'680, 0.2)));
  sentence("figure 8: lambda0:lambda1 = 1:2 over 2:1, TTRT 48.68 ms", "longer delays",
           delay(of(48'680, 0.35, 1, 2)), delay(of(48'680, 0.35, 2, 1)));
  traffic::UrgentTraffic shorter = traffic::paper_traffic(0.35, 1, 1, microseconds(48'680));
  shorter.available_length = kernel::Duration{static_cast<std::int64_t>(octets_ms(75) * 1e9)};
  traffic::set_load(shorter, 0.35, 1, 1);
  sentence("figure 10: time-available packets of 267 octets over 75", "longer delays", delay(of(48'680)),
           delay(Studied(shorter, settings.seed)));
  return section;
}

PublishedSection foundation_targets(const Settings& settings) {
  PublishedSection section;
  section.heading = "Figures 7 and 9: delay of urgent data over TTRT and load, lambda0:lambda1 = 1:1";
  section.note =
      "The paper: the delay falls with TTRT and rises with the load. So says the model. In the simulation it "
      "hardly depends on TTRT while the time-available queues are stable, and falls where they starve.";
  for (const double load : kLoads) {
    DelayCurves curves(fmt::format("Figure 7: delay of urgent data, U = {}", load), "TTRT, ms");
    for (const int target : kTargets) {
      const Studied one(traffic::paper_traffic(load, 1, 1, microseconds(target)), settings.seed);
      section.rows.push_back(one.row(fmt::format("U = {}, TTRT {:.3f} ms", load, target / 1e3)));
      curves.add(target / 1e3, one);
    }
    section.figures.push_back(curves.figure());
  }
  return section;
}

PublishedSection foundation_shares(const Settings& settings) {
  PublishedSection section;
  section.heading = "Figure 8: delay of urgent data over the share of time-available data, TTRT 48.68 ms";
  section.note =
      "The paper does not print its TTRT here, and says that more time-available data raise the delay. At "
      "equal "
      "load model and simulation say the opposite: fewer, longer packets.";
  for (const double load : kLoads) {
    for (const Shares& shares : kShares) {
      section.rows.push_back(
          Studied(traffic::paper_traffic(load, shares.urgent, shares.available, microseconds(48'680)),
                  settings.seed)
              .row(fmt::format("U = {}, lambda0:lambda1 = {}", load, shares.name)));
    }
  }
  return section;
}

PublishedSection foundation_stations(const Settings& settings) {
  PublishedSection section;
  section.heading = "Section V: the experiment with 16 boards, as stations on a simulated line";
  section.note = fmt::format(
      "Each frame of scheduler and nodes is on a line of 1 Mbit/s, for {:.0f} s. It agrees where the delay "
      "is within four standard errors and 0.5 % of the simulation without frames, and the rotation within "
      "0.1 % and four standard errors of R / (1 - U).",
      traffic::ms(settings.duration) / 1e3);
  for (const double load : kLoads) {
    for (const int target : {20'000, 34'816, 48'680}) {
      const traffic::UrgentTraffic traffic = traffic::paper_traffic(load, 1, 1, microseconds(target));
      add_station_rows(section, fmt::format("U = {}, TTRT {:.3f} ms", load, target / 1e3), traffic, settings);
    }
  }
  return section;
}

PublishedSection foundation_lengths(const Settings& settings) {
  PublishedSection section;
  section.heading = "Figures 10 and 11: delay of urgent data over the length of packets, TTRT 48.68 ms";
  section.note =
      "The paper keeps load and equal rates, and says that shorter time-available packets lower the delay. "
      "With "
      "that reading they raise it, in the model and in the simulation, because more of them come. With the "
      "rates of the longest packets kept instead, they lower it.";
  const auto add = [&](std::string what, const traffic::UrgentTraffic& traffic) {
    section.rows.push_back(Studied(traffic, settings.seed).row(std::move(what)));
  };
  const auto of = [](double load, unsigned urgent_octets, unsigned available_octets) {
    traffic::UrgentTraffic traffic = traffic::paper_traffic(load, 1, 1, microseconds(48'680));
    traffic.urgent_length = kernel::Duration{static_cast<std::int64_t>(octets_ms(urgent_octets) * 1e9)};
    traffic.available_length = kernel::Duration{static_cast<std::int64_t>(octets_ms(available_octets) * 1e9)};
    return traffic;
  };
  for (const double load : kLoads) {
    for (const unsigned octets : {75U, 139U, 203U, 267U}) {
      traffic::UrgentTraffic traffic = of(load, 75, octets);
      traffic::set_load(traffic, load, 1, 1);
      add(fmt::format("U = {}, time-available packets of {} octets", load, octets), traffic);
      if (octets == 267) continue;
      add(fmt::format("the same, at the rates of U = {} with 267 octets", load), of(load, 75, octets));
    }
    for (const unsigned octets : {27U, 51U}) {
      traffic::UrgentTraffic traffic = of(load, octets, 267);
      traffic::set_load(traffic, load, 1, 1);
      add(fmt::format("U = {}, urgent packets of {} octets", load, octets), traffic);
    }
  }
  return section;
}

}  // namespace fieldproof::papers
