#include "protocols/fieldbus_dll/ff_rules.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace fieldproof::fieldbus_dll {
namespace {

using judge::Standing;

constexpr std::string_view kOverview = "overviews of Foundation Fieldbus, not verified again";

using FfFactRow = FactRow<FfRules>;

constexpr std::array kFfRows{
    FfFactRow{
        "codes",
        [](const FfRules& r) {
          const FfCodes& c = r.codes;
          return fmt::format(
              "CD {:02X} DT1 {:02X} DT3 {:02X} SR {:02X} CT {:02X} TD {:02X} PN {:02X} PR {:02X} PT {:02X} "
              "RT "
              "{:02X} RI {:02X} CL {:02X} TL {:02X} IDLE {:02X}",
              c.cd, c.dt1, c.dt3, c.sr, c.ct, c.td, c.pn, c.pr, c.pt, c.rt, c.ri, c.cl, c.tl, c.idle);
        },
        kSourceMemory, Standing::memory},
    FfFactRow{"first_node", [](const FfRules& r) { return fmt::format("{:02X}", r.first_node); },
              kSourceMemory, Standing::memory},
    FfFactRow{"last_node", [](const FfRules& r) { return fmt::format("{:02X}", r.last_node); }, kSourceMemory,
              Standing::memory},
    FfFactRow{"first_unpolled", [](const FfRules& r) { return fmt::format("{:02X}", r.first_unpolled); },
              kSourceVendors, Standing::searched},
    FfFactRow{"unpolled", [](const FfRules& r) { return fmt::format("{}", r.unpolled); }, kSourceVendors,
              Standing::searched},
    FfFactRow{"scheduling_overhead_octets",
              [](const FfRules& r) { return fmt::format("{} octets", r.scheduling_overhead_octets); },
              kSourceVendors, Standing::searched},
    FfFactRow{"least_token_octets",
              [](const FfRules& r) { return fmt::format("{} octets", r.least_token_octets); }, kSourceVendors,
              Standing::searched},
    FfFactRow{"token_holding_octets",
              [](const FfRules& r) { return fmt::format("{} octets", r.token_holding_octets); },
              kSourceVendors, Standing::searched},
    FfFactRow{"claim_delay_octets",
              [](const FfRules& r) { return fmt::format("{} octets", r.claim_delay_octets); }, kSourceVendors,
              Standing::searched},
    FfFactRow{"misses_until_removal",
              [](const FfRules& r) { return fmt::format("{}", r.misses_until_removal); }, kOverview,
              Standing::memory},
    FfFactRow{"target_rotation", [](const FfRules& r) { return kernel::describe(r.target_rotation); },
              kSourceVendors, Standing::searched},
    FfFactRow{"time_distribution_period",
              [](const FfRules& r) { return kernel::describe(r.time_distribution_period); }, kSourceVendors,
              Standing::searched},
    FfFactRow{"steers_by_three_steps",
              [](const FfRules& r) { return std::string(r.steers_by_three_steps ? "yes" : "no"); },
              kSourceOwn, Standing::own},
    FfFactRow{"returns_with_last_data",
              [](const FfRules& r) { return std::string(r.returns_with_last_data ? "yes" : "no"); },
              kSourceOwn, Standing::own},
};

// A link parameter and what it may be.
struct Range {
  std::string_view name;
  std::int64_t value;
  std::int64_t least;
  std::int64_t most;
};

}  // namespace

std::optional<std::string> impossible(const FfRules& rules) {
  const LinkRules& link = rules.link;
  const std::int64_t answer = std::int64_t{link.response_delay_slots - 1} * link.slot_time_octets;
  const std::array ranges{
      Range{"V(ST)", link.slot_time_octets, 1, 4095},
      Range{"V(MRD)", link.response_delay_slots, 1, 11},
      Range{"V(MID)", link.inter_pdu_delay_octets, 0, std::min<std::int64_t>(120, answer)},
      Range{"V(PhPE) + 1", link.preamble_octets, 1, 8},
      Range{"V(DMDT)", rules.least_token_octets, 32, 32'767},
      Range{"V(DTHT)", rules.token_holding_octets, 276, 65'000},
      Range{"V(MICD)", rules.claim_delay_octets, 1, 4095},
      Range{"V(FUN)", rules.first_unpolled, 21, 247},
      Range{"V(NUN)", rules.unpolled, 0, 228},
  };
  for (const Range& range : ranges) {
    if (range.value >= range.least && range.value <= range.most) continue;
    return fmt::format("{} is {}, and may be {} to {}", range.name, range.value, range.least, range.most);
  }
  return std::nullopt;
}

std::vector<Fact> facts(const FfRules& rules) {
  return facts_of<FfRules>(kFfRows, rules);
}

}  // namespace fieldproof::fieldbus_dll
