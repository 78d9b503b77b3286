#include "protocols/fieldbus_dll/isa_rules.hpp"

#include <fmt/format.h>

#include <array>

namespace fieldproof::fieldbus_dll {
namespace {

using judge::Standing;

constexpr std::string_view kLine = "IEC 61158-2: its rates";
constexpr std::string_view kSizes =
    "IEC 61158, from memory; the frames of 75 and 267 octets of Hong and Son fit";
constexpr std::string_view kProduct = "V(MRD) x V(ST)";

std::string octets_text(unsigned count) {
  return fmt::format("{} octets", count);
}

using IsaFactRow = FactRow<IsaRules>;

constexpr std::array kIsaRows{
    IsaFactRow{"bit_rate", [](const IsaRules& r) { return fmt::format("{} bit/s", r.link.bit_rate); }, kLine,
               Standing::sure},
    IsaFactRow{"preamble_octets", [](const IsaRules& r) { return octets_text(r.link.preamble_octets); },
               "nanoFIP, an open implementation; 1 to 8", Standing::searched},
    IsaFactRow{"slot_time_octets", [](const IsaRules& r) { return octets_text(r.link.slot_time_octets); },
               kSourceVendors, Standing::searched},
    IsaFactRow{"response_delay_slots",
               [](const IsaRules& r) { return fmt::format("{}", r.link.response_delay_slots); },
               kSourceVendors, Standing::searched},
    IsaFactRow{"inter_pdu_delay_octets",
               [](const IsaRules& r) { return octets_text(r.link.inter_pdu_delay_octets); }, kSourceVendors,
               Standing::searched},
    IsaFactRow{"most_data",
               [](const IsaRules& r) {
                 return fmt::format("{}, {}, {} octets", r.link.most_data[0], r.link.most_data[1],
                                    r.link.most_data[2]);
               },
               kSizes, Standing::memory},
    IsaFactRow{"codes",
               [](const IsaRules& r) {
                 const IsaCodes& c = r.codes;
                 return fmt::format("CD {:02X} DT {:02X} DU {:02X} ET {:02X} ES {:02X} EE {:02X} TL {:02X}",
                                    c.cd, c.dt, c.du, c.et, c.es, c.ee, c.tl);
               },
               kSourceOwn, Standing::own},
    IsaFactRow{"first_address", [](const IsaRules& r) { return fmt::format("{:02X}", r.first_address); },
               kSourceOwn, Standing::own},
    IsaFactRow{"last_address", [](const IsaRules& r) { return fmt::format("{:02X}", r.last_address); },
               kSourceOwn, Standing::own},
    IsaFactRow{"everybody", [](const IsaRules& r) { return fmt::format("{:02X}", r.everybody); }, kSourceOwn,
               Standing::own},
    IsaFactRow{"reply_wait_octets", [](const IsaRules& r) { return octets_text(r.reply_wait_octets); },
               kProduct, Standing::own},
    IsaFactRow{"reply_forming_octets", [](const IsaRules& r) { return octets_text(r.reply_forming_octets); },
               kSourceOwn, Standing::own},
    IsaFactRow{"supervision_margin_octets",
               [](const IsaRules& r) { return octets_text(r.supervision_margin_octets); }, kSourceOwn,
               Standing::own},
};

}  // namespace

std::vector<Fact> facts(const IsaRules& rules) {
  return facts_of<IsaRules>(kIsaRows, rules);
}

}  // namespace fieldproof::fieldbus_dll
