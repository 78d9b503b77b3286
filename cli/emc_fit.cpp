#include "cli/emc_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "cli/burst_options.hpp"
#include "cli/counts_file.hpp"
#include "cli/exit_code.hpp"
#include "cli/networks.hpp"
#include "cli/stored_document.hpp"
#include "emc/residual/residual_error.hpp"
#include "harness/kernel/error.hpp"
#include "reports/results.hpp"
#include "reports/text_summary.hpp"

namespace fieldproof::cli {
namespace {

using nlohmann::ordered_json;

constexpr std::uint64_t kMostLevels = 1'000'000;  // of a frame

struct EmcFit {
  std::string protocol;
  std::string network;
  std::string file;
  emc::Profile profile;
  std::int64_t bit_rate = 0;
  unsigned levels = 0;
  std::vector<emc::CountedFrames> rows;
  emc::BurstFit fit;
  std::uint64_t bad = 0;
  std::uint64_t undetected = 0;

  double undetected_bound() const { return emc::upper_bound_of_share(undetected, bad); }
};

// Nothing is simulated, so what says how to would be ignored.
void refuse_simulation(const Settings& settings) {
  for (const char* option :
       {"test-levels", "repetition", "polarity", "channel", "search", "sensitivity", "out"}) {
    if (settings.origin(option) == Origin::command_line)
      settings.refuse(option, "--fit simulates nothing; leave one of them out");
  }
}

// What the exposed receivers of the network get, and how long a frame of it is where nothing is said.
void describe_line(const Session& session, network::Network& network, EmcFit& made) {
  const auto exposed = std::ranges::find_if(network.places(), &network::Place::is_exposed);
  if (exposed == network.places().end())
    session.settings.refuse("network", "no receiver of it lies in the clamp");
  made.bit_rate = exposed->level_rate;
  if (session.settings.is_set("bits")) {
    made.levels = static_cast<unsigned>(session.settings.number("bits", 1, kMostLevels));
  } else if (const auto frames = network.protected_frames(); !frames.empty()) {
    made.levels = frames.front().bits;
  } else {
    session.settings.refuse("bits",
                            "its frames have no one length; write how many levels one has on the line");
  }
}

// More frames than a line carries in that time are a slip of the pen.
void check_rows(const EmcFit& made) {
  const double seconds = static_cast<double>(made.levels) / static_cast<double>(made.bit_rate);
  for (const emc::CountedFrames& row : made.rows) {
    const double most = row.time_s / seconds * 1.001 + 1;
    if (static_cast<double>(row.frames) <= most) continue;
    throw kernel::Error(
        kernel::ErrorKind::configuration,
        fmt::format(
            "{}: {} frames at {:g} V, and {:g} s are room for {:.0f} of {} bits at {} bit/s; --bits N says "
            "how long one is",
            made.file, row.frames, row.volts, row.time_s, most, made.levels, made.bit_rate));
  }
}

std::string factor_text(std::string_view name, const emc::FittedFactor& factor) {
  return fmt::format("{:<34} {:>8.3g}  95 % from {}{:.3g} to {}{:.3g}\n", name, factor.value,
                     factor.is_open_below ? "below " : "", factor.from, factor.is_open_above ? "above " : "",
                     factor.to);
}

std::string meaning_of(emc::FitVerdict verdict) {
  switch (verdict) {
    case emc::FitVerdict::consistent:
      return "the counts follow level, repetition and polarity as the model says";
    case emc::FitVerdict::contradicts:
      return "no gain and strength explain them: another mechanism, or another frame or profile than said";
    case emc::FitVerdict::open:
      return "too few conditions with errors to put the model to the test";
  }
  return "";
}

std::string fit_text(const EmcFit& made) {
  std::string text = fmt::format("{}: {} conditions; frames of {} bits at {} bit/s, profile {} ({})\n",
                                 reports::escaped_line(made.file), made.rows.size(), made.levels,
                                 made.bit_rate, made.profile.name, reports::escaped_line(made.profile.title));
  text += fmt::format("{:>8} {:>8} {:>3} {:>12} {:>10} {:>12} {:>8}\n", "level, V", "pulses", "pol", "frames",
                      "bad", "expected", "sigma");
  for (std::size_t n = 0; n < made.rows.size(); ++n) {
    const emc::CountedFrames& row = made.rows[n];
    const double expected = made.fit.expected[n];
    const double sigma = std::sqrt(expected * (1 - expected / static_cast<double>(row.frames)));
    text += fmt::format(
        "{:>8g} {:>8} {:>3} {:>12} {:>10} {:>12.1f} {:>8}\n", row.volts, emc::text_of(row.repetition),
        emc::text_of(row.polarity), row.frames, row.bad, expected,
        sigma > 0 ? fmt::format("{:+.1f}", (static_cast<double>(row.bad) - expected) / sigma) : "-");
  }
  text += factor_text("gain, a factor on the voltage", made.fit.gain);
  text += factor_text("strength, a factor on how pulses hit", made.fit.strength);
  text += fmt::format("chi-squared {:.1f} with {} degrees of freedom, p = {:.3g}\n", made.fit.chi_squared,
                      std::max(made.fit.degrees, 0), made.fit.probability);
  text += made.bad == 0 ? "undetected: no frame was bad\n"
                        : fmt::format("undetected: {} of {} bad frames, at most {:.3g} (one-sided 95 %)\n",
                                      made.undetected, made.bad, made.undetected_bound());
  return text + fmt::format("{}: {}\n", emc::name(made.fit.verdict), meaning_of(made.fit.verdict));
}

ordered_json factor_json(const emc::FittedFactor& factor) {
  return {{"value", factor.value},
          {"from", factor.from},
          {"to", factor.to},
          {"is_open_below", factor.is_open_below},
          {"is_open_above", factor.is_open_above}};
}

std::string fit_json(const EmcFit& made) {
  ordered_json rows = ordered_json::array();
  for (std::size_t n = 0; n < made.rows.size(); ++n) {
    const emc::CountedFrames& row = made.rows[n];
    rows.push_back({{"level_v", row.volts},
                    {"repetition", emc::word_of(row.repetition)},
                    {"polarity", emc::word_of(row.polarity)},
                    {"time_s", row.time_s},
                    {"frames", row.frames},
                    {"frames_bad", row.bad},
                    {"undetected", row.undetected},
                    {"expected_bad", made.fit.expected[n]}});
  }
  const ordered_json document = {{"schema", "fieldproof/emc_fit/1"},
                                 {"protocol", made.protocol},
                                 {"network", made.network},
                                 {"profile", made.profile.name},
                                 {"bits", made.levels},
                                 {"bit_rate", made.bit_rate},
                                 {"gain", factor_json(made.fit.gain)},
                                 {"strength", factor_json(made.fit.strength)},
                                 {"chi_squared", made.fit.chi_squared},
                                 {"degrees_of_freedom", std::max(made.fit.degrees, 0)},
                                 {"probability", made.fit.probability},
                                 {"verdict", emc::name(made.fit.verdict)},
                                 {"undetected",
                                  {{"bad", made.bad},
                                   {"undetected", made.undetected},
                                   {"upper_bound_of_share", made.undetected_bound()}}},
                                 {"rows", std::move(rows)}};
  return document.dump(1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace

int fit_emc(Session& session) {
  refuse_simulation(session.settings);
  const ProtocolEntry& row = network_entry_of(session, "emc");
  const auto planned = row.network.plan(network_request(session, row));
  const auto network = planned->make(1);
  EmcFit made;
  made.protocol = row.name;
  made.network = planned->name();
  made.file = session.settings.text("fit");
  made.profile = session.settings.origin("profile") == Origin::fallback
                     ? emc::Profile::named(planned->default_profile())
                     : profile_from(session.settings);
  describe_line(session, *network, made);
  made.rows = load_counts(made.file);
  check_rows(made);
  for (const emc::CountedFrames& counted : made.rows) {
    made.bad += counted.bad;
    made.undetected += counted.undetected;
  }
  made.fit = emc::BurstModel(made.profile.coupling, made.levels, made.bit_rate).fit(made.rows);
  session.terminal.print(fit_text(made));
  write_document(session, "emc", fit_json(made));
  switch (made.fit.verdict) {
    case emc::FitVerdict::consistent:
      return kAllAsExpected;
    case emc::FitVerdict::contradicts:
      return kFailed;
    case emc::FitVerdict::open:
      return kInconclusive;
  }
  return kInconclusive;
}

}  // namespace fieldproof::cli
