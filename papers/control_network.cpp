// The sections of Lee, Moon, Moon, Kwon, Lee and Park about the token bus of IEEE 802.4 on the physical layer
// of IEEE 802.3. The paper prints a table and sentences, and measures nothing: what is compared are these.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "harness/traffic/csma_cd.hpp"
#include "harness/traffic/milliseconds.hpp"
#include "harness/traffic/token_loads.hpp"
#include "papers/sections.hpp"
#include "protocols/token_bus/frame.hpp"
#include "protocols/token_bus/line_code.hpp"

namespace fieldproof::papers {
namespace {

using kernel::Duration;
using reports::PublishedCurves;
using reports::PublishedRow;
using reports::PublishedSection;
using token_bus::MacSymbol;
using token_bus::PhySymbol;

// ---- coding ----

std::string braced(std::span<const PhySymbol> symbols) {
  std::vector<std::string> pairs;
  const auto name = [](PhySymbol symbol) {
    return symbol == PhySymbol::idl ? "IDL" : symbol == PhySymbol::cd1 ? "CD1" : "CD0";
  };
  for (std::size_t n = 0; n + 1 < symbols.size(); n += 2) {
    pairs.push_back(fmt::format("{{{}, {}}}", name(symbols[n]), name(symbols[n + 1])));
  }
  return fmt::format("{}", fmt::join(pairs, ", "));
}

double unlike_characters(std::string_view one, std::string_view other) {
  const auto [length, longest] = std::minmax({one.size(), other.size()});
  auto unlike = static_cast<double>(longest - length);
  for (std::size_t n = 0; n < length; ++n) unlike += one[n] == other[n] ? 0 : 1;
  return unlike;
}

PublishedRow coding_row(std::string what, std::string published, std::vector<MacSymbol> symbols) {
  const std::string found = braced(token_bus::phy_symbols_of(symbols));
  const auto compared = reports::within(0, 0, unlike_characters(found, published), "unlike");
  return {std::move(what), std::move(published), found, "", compared};
}

token_bus::PhySymbols token_on_line(const token_bus::Rules& rules) {
  token_bus::MacSymbols symbols;
  const token_bus::Frame token{.kind = token_bus::FrameKind::token, .destination = 4, .source = 10};
  token_bus::append_framed(symbols, token_bus::with_check(token_bus::octets_of(token, rules)),
                           {.preamble_octets = rules.preamble_octets});
  return token_bus::phy_symbols_of(symbols);
}

// Preamble and SFD of IEEE 802.3 are 56 and 8 bits: (10)^31 and 11.
PublishedRow sfd_row(const token_bus::PhySymbols& line) {
  constexpr std::size_t kSpareBits = 2;
  constexpr std::size_t kPreambleAndSfd = 64;
  std::string sfd;
  for (unsigned n = 0; n < kPreambleAndSfd / 2 - 1; ++n) sfd += "10";
  sfd += "11";
  const std::string found = token_bus::written(line).substr(kSpareBits, kPreambleAndSfd);
  return {"the first symbol of SD ends an SFD of IEEE 802.3", "no additional overhead",
          found == sfd ? "bits 3 to 66 are a preamble and an SFD" : "they are not: " + found,
          "with 4 octets of pad_idle; the 2 that IEEE 802.4 asks for at 5 Mbit/s are too few",
          reports::within(0, 0, unlike_characters(found, sfd), "bits")};
}

// The pair with which a start delimiter begins.
PublishedRow delimiter_row() {
  const token_bus::PhySymbols line =
      token_bus::phy_symbols_of(std::vector{MacSymbol::non_data, MacSymbol::non_data});
  const std::string found = braced(std::span(line).first(2));
  const std::string published = "{CD1, CD0}";
  return {"SD begins with, in the text", published, found, "as the table and the SFD of IEEE 802.3 have it",
          reports::within(0, 0, unlike_characters(found, published), "unlike")};
}

PublishedRow out_of_phase_row() {
  constexpr std::size_t kSymbols = 16;
  const auto line = token_bus::phy_symbols_of(std::vector<MacSymbol>(kSymbols, MacSymbol::pad_idle));
  struct NeverSlips final : token_bus::ClockControl {
    bool may_slip() const override { return false; }
  };
  token_bus::MacDecoder decoder(std::make_unique<NeverSlips>());
  std::size_t zeros = 0;
  for (std::size_t n = 1; n < line.size(); ++n) {
    if (decoder.take(line[n]) == MacSymbol::zero) ++zeros;
  }
  return {"pad_idle one bit out of phase", "zeros",
          fmt::format("{} zeros of {} symbols", zeros, kSymbols - 1), "",
          reports::within(kSymbols - 1, 0, static_cast<double>(zeros), "zeros")};
}

// ---- rotations ----

constexpr unsigned kPayload = 64;  // octets of a data frame
// Half of the longest round trip of IEEE 802.3.
constexpr Duration kLongestWay = 25'600 * kernel::kNanosecond;

traffic::TimedToken ring_of(unsigned stations, Duration hold, bool has_lower_classes) {
  const token_bus::Rules rules;
  const Duration gap = token_bus::octets(rules, rules.response_gap_octets);
  traffic::TimedToken token{.stations = stations,
                            .pass = gap + token_bus::frame_time(rules, 0) + kLongestWay,
                            .hold = hold,
                            .longest_frame = gap + token_bus::frame_time(rules, kPayload)};
  if (has_lower_classes) {
    token.targets = {stations * 2 * kernel::kMillisecond, stations * kernel::kMillisecond,
                     stations * 500 * kernel::kMicrosecond};
  }
  return token;
}

// ---- both ways of access ----

constexpr unsigned kStations = 16;
constexpr std::uint64_t kFramesPerPoint = 100'000;

struct Access {
  double median = 0, mean = 0, rare = 0, longest = 0;  // ms; `rare`: one frame in 10,000 takes longer
  std::uint64_t beyond = 0;
  std::uint64_t given_up = 0;
};

Access access_of(const measure::Distribution& delays, std::uint64_t beyond, std::uint64_t given_up) {
  constexpr double kRare = 0.9999;
  const auto in_ms = [](std::int64_t picoseconds) { return traffic::ms(Duration{picoseconds}); };
  return {in_ms(delays.quantile(0.5)),
          delays.mean() / traffic::kPicosecondsPerMs,
          in_ms(delays.quantile(kRare)),
          in_ms(delays.max()),
          beyond,
          given_up};
}

class BothAccesses {
 public:
  BothAccesses(double per_ms, const traffic::TimedToken& token, Duration bound, std::uint64_t seed)
      : per_ms_(per_ms) {
    const double of_a_station = per_ms / kStations;
    traffic::QueuedFrames frames(token,
                                 {.frame = token.longest_frame, .per_ms = {of_a_station}, .bound = bound},
                                 kernel::Random(seed));
    const auto rotations = static_cast<std::uint64_t>(
        static_cast<double>(kFramesPerPoint) / per_ms * traffic::kPicosecondsPerMs /
        static_cast<double>((token.stations * token.pass).count()));
    traffic::rotate_timed_token(token, frames,
                                std::max<std::uint64_t>(rotations, kFramesPerPoint / 10) * token.stations);
    token_ = access_of(frames.delays(traffic::AccessClass::six), frames.beyond(), 0);

    const auto octet = [](unsigned count) { return count * 800 * kernel::kNanosecond; };
    constexpr unsigned kAroundPayload = 8 + 14 + 4;  // preamble with SFD, header, check
    const traffic::CsmaFigures csma = traffic::run_csma_cd(
        {.stations = kStations, .per_ms = of_a_station, .frame = octet(kAroundPayload + kPayload)},
        {.seed = seed, .frames = kFramesPerPoint, .bound = bound});
    csma_ = access_of(csma.delays, csma.beyond, csma.given_up);
  }

  const Access& token() const { return token_; }
  const Access& csma() const { return csma_; }
  PublishedRow row(Duration bound) const {
    const auto text = [](const Access& one) {
      return fmt::format("median {:.3f}, mean {:.3f}, 1 of 10,000 over {:.3f}, longest {:.3f} ms", one.median,
                         one.mean, one.rare, one.longest);
    };
    return {fmt::format("{} frames of {} octets in a millisecond", per_ms_, kPayload), "",
            fmt::format("token: {}; CSMA/CD: {}", text(token_), text(csma_)),
            fmt::format("over {:.3f} ms: {} with the token, {} with CSMA/CD and {} given up",
                        traffic::ms(bound), token_.beyond, csma_.beyond, csma_.given_up),
            std::nullopt};
  }

 private:
  double per_ms_;
  Access token_;
  Access csma_;
};

constexpr std::array kLoadsOfAccess = {0.5, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0};

std::string first_load(const std::vector<std::pair<double, bool>>& broken) {
  for (const auto& [load, is_broken] : broken)
    if (is_broken) return fmt::format("{} frames in a millisecond", load);
  return "none of these loads";
}

}  // namespace

PublishedSection control_network_coding(const Settings&) {
  PublishedSection section;
  section.heading = "Table 3 and section 3: MAC symbols on the line of IEEE 802.3";
  section.note =
      "A text says that SD begins with non_data, which be {CD1, CD0}; the table and the SFD have {CD1, CD1}, "
      "and so it "
      "is here. The decoding table is left out by the paper.";
  using enum MacSymbol;
  section.rows = {coding_row("silence", "{IDL, IDL}", {silence}),
                  coding_row("pad_idle", "{CD1, CD0}, {CD1, CD0}", {pad_idle, pad_idle}),
                  coding_row("zero", "{CD0, CD1}", {zero}),
                  coding_row("one", "{CD1, CD0}", {one}),
                  coding_row("non_data", "{CD1, CD1}, {CD0, CD0}", {non_data, non_data}),
                  delimiter_row(),
                  out_of_phase_row()};
  const token_bus::Rules rules;
  const token_bus::PhySymbols line = token_on_line(rules);
  section.rows.push_back(sfd_row(line));
  section.rows.push_back(
      {"bit rate of the MAC at 10 Mbit/s", "5 Mbit/s",
       fmt::format("{} Mbit/s", token_bus::mac_symbol_rate(rules) / 1'000'000), "",
       reports::within(5, 0, static_cast<double>(token_bus::mac_symbol_rate(rules)) / 1e6, "Mbit/s")});
  section.rows.push_back({"a token between 16-bit addresses", "",
                          fmt::format("{} bits of the line, {:.1f} us", line.size(),
                                      1e3 * traffic::ms(token_bus::frame_time(rules, 0))),
                          "4 octets of preamble", std::nullopt});
  return section;
}

PublishedSection control_network_rotation(const Settings& settings) {
  PublishedSection section;
  section.heading = "Section 1: data go in a time that is known";
  section.note =
      "Between two tokens lie at most max( N (H + tau), max TTRT + L + (N - 1) H ), H = THT + L. Adversaries "
      "who "
      "saturate the ring, send at random or come just in time must not exceed it, and are to reach 94 % of "
      "it.";
  constexpr double kReach = 0.94;
  constexpr std::uint64_t kRotations = 400;
  PublishedCurves curves{"longest rotation of the token", "stations", "ms", {{"bound", {}}, {"reached", {}}}};
  for (const unsigned stations : {2U, 4U, 8U, 16U, 32U, 64U}) {
    for (const bool has_lower_classes : {true, false}) {
      const traffic::TimedToken token = ring_of(stations, 500 * kernel::kMicrosecond, has_lower_classes);
      const double bound = traffic::ms(traffic::rotation_bound(token));
      const double reached =
          traffic::ms(traffic::longest_under_attack(token, kernel::Random(settings.seed), kRotations));
      section.rows.push_back(
          {fmt::format("{} stations, {}", stations,
                       has_lower_classes ? "classes 6, 4, 2 and 0" : "class 6 alone"),
           "", fmt::format("{:.4f} ms of at most {:.4f} ms", reached, bound),
           fmt::format("{:.2f} % of the bound", 100 * reached / bound),
           reports::own(reports::within((1 + kReach) / 2 * bound, (1 - kReach) / 2 * bound, reached, "ms"))});
      if (!has_lower_classes) continue;
      curves.curves[0].points.push_back({static_cast<double>(stations), bound});
      curves.curves[1].points.push_back({static_cast<double>(stations), reached});
    }
  }
  section.figures.push_back(std::move(curves));
  return section;
}

PublishedSection control_network_access(const Settings& settings) {
  PublishedSection section;
  const traffic::TimedToken token = ring_of(kStations, 300 * kernel::kMicrosecond, false);
  const Duration bound = traffic::rotation_bound(token) + token.longest_frame;
  section.heading = "Section 1: the access of IEEE 802.3 is not deterministic";
  section.note = fmt::format(
      "{} stations, frames of {} octets that arrive at random, urgent ones (class 6) on the token at 5 "
      "Mbit/s, and the "
      "same over CSMA/CD at 10 Mbit/s with half a slot between any two stations. A frame that finds its "
      "queue empty "
      "waits for one rotation at most: {:.3f} ms with its own time.",
      kStations, kPayload, traffic::ms(bound));
  PublishedCurves rare{"delay that one frame in 10,000 exceeds",
                       "frames in a millisecond",
                       "ms",
                       {{"token bus", {}}, {"CSMA/CD", {}}}};
  std::vector<std::pair<double, bool>> by_token;
  std::vector<std::pair<double, bool>> by_csma;
  for (const double load : kLoadsOfAccess) {
    const BothAccesses both(load, token, bound, settings.seed);
    section.rows.push_back(both.row(bound));
    rare.curves[0].points.push_back({load, both.token().rare});
    rare.curves[1].points.push_back({load, both.csma().rare});
    by_token.emplace_back(load, both.token().beyond > 0);
    by_csma.emplace_back(load, both.csma().beyond + both.csma().given_up > 0);
  }
  section.figures.push_back(std::move(rare));
  section.rows.push_back({"the first of these loads at which a frame is late or given up", "",
                          fmt::format("token: {}; CSMA/CD: {}", first_load(by_token), first_load(by_csma)),
                          "", std::nullopt});
  return section;
}

}  // namespace fieldproof::papers
