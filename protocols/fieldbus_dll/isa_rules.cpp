#include "protocols/fieldbus_dll/isa_rules.hpp"

#include <fmt/format.h>

#include <array>

namespace fieldproof::fieldbus_dll {
namespace {

using judge::Standing;

constexpr std::string_view kLine = "IEC 61158-2: its rates";
constexpr std::string_view kRange = "vendors' tables of link parameters: inside of their range";
constexpr std::string_view kSizes =
    "IEC 61158, from memory; the frames of 75 and 267 octets of Hong and Son fit";
constexpr std::string_view kOwn = "this project's choice";
constexpr std::string_view kProduct = "V(MRD) x V(ST)";
constexpr std::string_view kChanged = "changed for this run";

std::string octets_text(unsigned count) {
  return fmt::format("{} octets", count);
}

struct Row {
  std::string_view rule;
  std::string (*value)(const IsaRules&);
  std::string_view source;
  Standing standing;
};

constexpr std::array kRows{
    Row{"bit_rate", [](const IsaRules& r) { return fmt::format("{} bit/s", r.link.bit_rate); }, kLine,
        Standing::sure},
    Row{"preamble_octets", [](const IsaRules& r) { return octets_text(r.link.preamble_octets); },
        "nanoFIP, an open implementation; 1 to 8", Standing::searched},
    Row{"slot_time_octets", [](const IsaRules& r) { return octets_text(r.link.slot_time_octets); }, kRange,
        Standing::searched},
    Row{"response_delay_slots",
        [](const IsaRules& r) { return fmt::format("{}", r.link.response_delay_slots); }, kRange,
        Standing::searched},
    Row{"inter_pdu_delay_octets",
        [](const IsaRules& r) { return octets_text(r.link.inter_pdu_delay_octets); }, kRange,
        Standing::searched},
    Row{"most_data",
        [](const IsaRules& r) {
          return fmt::format("{}, {}, {} octets", r.link.most_data[0], r.link.most_data[1],
                             r.link.most_data[2]);
        },
        kSizes, Standing::memory},
    Row{"codes",
        [](const IsaRules& r) {
          const IsaCodes& c = r.codes;
          return fmt::format("CD {:02X} DT {:02X} DU {:02X} ET {:02X} ES {:02X} EE {:02X} TL {:02X}", c.cd,
                             c.dt, c.du, c.et, c.es, c.ee, c.tl);
        },
        kOwn, Standing::own},
    Row{"first_address", [](const IsaRules& r) { return fmt::format("{:02X}", r.first_address); }, kOwn,
        Standing::own},
    Row{"last_address", [](const IsaRules& r) { return fmt::format("{:02X}", r.last_address); }, kOwn,
        Standing::own},
    Row{"everybody", [](const IsaRules& r) { return fmt::format("{:02X}", r.everybody); }, kOwn,
        Standing::own},
    Row{"reply_wait_octets", [](const IsaRules& r) { return octets_text(r.reply_wait_octets); }, kProduct,
        Standing::own},
    Row{"reply_forming_octets", [](const IsaRules& r) { return octets_text(r.reply_forming_octets); }, kOwn,
        Standing::own},
    Row{"supervision_margin_octets",
        [](const IsaRules& r) { return octets_text(r.supervision_margin_octets); }, kOwn, Standing::own},
};

}  // namespace

std::vector<IsaFact> facts(const IsaRules& rules) {
  std::vector<IsaFact> all;
  for (const Row& row : kRows) {
    IsaFact& fact = all.emplace_back(IsaFact{row.rule, row.value(rules), row.source, row.standing});
    if (fact.value == row.value(IsaRules{})) continue;
    fact.source = kChanged;
    fact.standing = Standing::own;
  }
  return all;
}

}  // namespace fieldproof::fieldbus_dll
