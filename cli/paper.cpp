#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <vector>

#include "cli/exit_code.hpp"
#include "cli/paper_sections.hpp"
#include "cli/run_setup.hpp"
#include "cli/simulated_network.hpp"
#include "cli/stored_document.hpp"
#include "cli/verbs.hpp"
#include "harness/kernel/error.hpp"

// `fieldproof paper`: what a paper published beside what is reproduced of it.
namespace fieldproof::cli {
namespace {

struct Section {
  std::string_view paper;
  reports::PublishedSection (*reproduce)(const PaperSettings&);
};

struct Paper {
  std::string_view name;
  std::string_view title;
  std::string_view network;                          // that its sections simulate
  kernel::Duration shortest = kernel::kMillisecond;  // virtual time of a signal
};

constexpr std::array kPapers = {
    Paper{"interbus", "J.-H. Park, The Study on the Cycling Time for Interbus, 2004", kCycleTimePaper},
    Paper{"valve_bus",
          "D.-S. Kim, H.-S. Seo and W.-H. Lee, pneumatic control systems by fieldbus communication",
          "of the valve bus"},
    Paper{"foundation",
          "S. H. Hong and B. K. Son, Delay Analysis of Urgent Data in the Foundation Fieldbus, 2003",
          "of 16 nodes at 1 Mbit/s", kernel::kSecond},
    Paper{"fieldbus",
          "S.-H. Hong, K.-A. Kim, J.-Y. Kim and S.-J. Ko, distributed control and automation systems and "
          "fieldbus",
          "of a control loop and eight other nodes"},
};

// In the order in which they are printed.
constexpr std::array kSections = {
    Section{"interbus", &interbus_cycle_times},       Section{"interbus", &interbus_highest_frequency},
    Section{"interbus", &interbus_square_waves},      Section{"interbus", &interbus_bursts},
    Section{"valve_bus", &valve_bus_cycle_times},     Section{"valve_bus", &valve_bus_block_check},
    Section{"valve_bus", &valve_bus_resonance},       Section{"foundation", &foundation_rotations},
    Section{"foundation", &foundation_targets},       Section{"foundation", &foundation_shares},
    Section{"foundation", &foundation_lengths},       Section{"foundation", &foundation_stations},
    Section{"fieldbus", &control_loop_quiet},         Section{"fieldbus", &control_loop_under_bursts},
    Section{"fieldbus", &control_loop_with_operator},
};

const Paper& paper_named(const std::string& name) {
  const auto found = std::ranges::find(kPapers, name, &Paper::name);
  if (found != kPapers.end()) return *found;
  std::vector<std::string_view> names;
  for (const Paper& paper : kPapers) names.push_back(paper.name);
  throw kernel::Error(kernel::ErrorKind::usage,
                      fmt::format("there is no paper '{}'; there are '{}'", name, fmt::join(names, "', '")));
}

}  // namespace

int paper(Session& session) {
  const Paper& chosen = paper_named(session.operands.empty() ? "interbus" : session.operands.front());
  PaperSettings settings;
  settings.seed = session.settings.number("seed", 0, std::numeric_limits<std::uint64_t>::max());
  settings.duration = virtual_time_from(session.settings);
  if (settings.duration < chosen.shortest) {
    throw kernel::Error(
        kernel::ErrorKind::usage,
        fmt::format("--duration {}: the sections of paper {} need {} at least",
                    kernel::describe(settings.duration), chosen.name, kernel::describe(chosen.shortest)));
  }
  session.terminal.print(simulation_header(session, settings.seed, "", chosen.network));
  reports::Publication publication{std::string(chosen.title), settings.seed, {}};
  session.terminal.begin_progress(
      static_cast<std::size_t>(std::ranges::count(kSections, chosen.name, &Section::paper)), "sections");
  for (const Section& section : kSections) {
    if (section.paper != chosen.name) continue;
    publication.sections.push_back(section.reproduce(settings));
    session.terminal.progress(publication.sections.size());
  }
  session.terminal.end_progress();
  session.terminal.print(reports::publication_text(publication));
  write_document(session, "paper", reports::publication_json(publication));
  return reports::is_reproduced(publication) ? kAllAsExpected : kFailed;
}

}  // namespace fieldproof::cli
