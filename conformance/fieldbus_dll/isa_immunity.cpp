#include <fmt/format.h>

#include <set>

#include "conformance/fieldbus_dll/isa_cases.hpp"
#include "conformance/fieldbus_dll/isa_expect.hpp"
#include "conformance/fieldbus_dll/link_immunity.hpp"

// Bursts at the receiver of a station of the profile ISA-D.
namespace fieldproof::conformance {
namespace {

using fieldbus_dll::IsaSchedule;
using fieldbus_dll::IsaScheduleItem;
using fieldbus_dll::IsaType;
using fieldbus_dll::Priority;

bool asks_for_something(const IsaBench& bench, const DrivenDlpdu& dlpdu) {
  const auto& codes = bench.rules().codes;
  const bool is_question = is_type(dlpdu, codes.et) || is_type(dlpdu, codes.es) || is_type(dlpdu, codes.cd);
  return is_question && dlpdu.octet(1) == bench.address();
}

Octets something_of_isa(IsaBench& bench) {
  const auto elsewhere = [](Octets octets) {
    octets[1] = IsaBench::kPeer;
    return octets;
  };
  switch (bench.random().below(6)) {
    case 0:
      return bench.et(Priority::time_available);
    case 1:
      return bench.es(Priority::time_available, 200);
    case 2:
      return bench.cd(Priority::time_available);
    case 3:
      return elsewhere(bench.et(Priority::time_available));
    case 4:
      return elsewhere(bench.cd(Priority::time_available));
    default: {
      Octets du{bench.control(bench.rules().codes.du, Priority::normal), bench.address(), IsaBench::kPeer};
      for (const std::uint8_t octet : bench.numbered_data(2 + bench.random().below(20))) du.push_back(octet);
      return du;
    }
  }
}

void ask_dle_under_stress(IsaBench& bench, CaseJudge& judge, std::set<Octets>& submitted,
                          LinkBurstLedger& ledger) {
  const Octets data = bench.numbered_data(4);
  if (bench.submit_unit_data(Priority::normal, data)) submitted.insert(data);
  bench.send(something_of_isa(bench));
  const bool is_asked = asks_for_something(bench, bench.sent().back());
  for (const DrivenDlpdu& one : listen_under_stress(bench, judge, is_asked, ledger)) {
    const bool is_data = is_type(one, bench.rules().codes.du);
    judge.expect(!is_data || submitted.erase(one.rest()) == 1, "data_wrong",
                 [&] { return Mismatch{{"what was submitted, once"}, one.text(), one.begin}; });
  }
}

void bursts_ask_a_dle_for_nothing(IsaBench& bench, CaseJudge& judge) {
  LinkBurstLedger ledger;
  std::set<Octets> submitted;
  under_each_stress(
      bench, bench.volume(4, 100), [&] { ask_dle_under_stress(bench, judge, submitted, ledger); },
      [&] {
        expect_serves(bench, judge);
        submitted.clear();
      });
  measure_stress(bench, judge, ledger);
}

// ---- a scheduler ----

constexpr int kRoundOctets = 300;
constexpr std::uint64_t kOctetsUntilEe = 17;  // with the silence before it

IsaSchedule an_et_and_an_es() {
  return {.version = 1,
          .period = kRoundOctets * kOctetAt31250,
          .items = {{20 * kOctetAt31250, IsaType::et, 0x21, Priority::normal, 0},
                    {160 * kOctetAt31250, IsaType::es, 0x22, Priority::normal, 200}}};
}

// All holders return their tokens at once; what arrives of that is another matter.
void the_schedule_goes_on_under_bursts(IsaBench& bench, CaseJudge& judge) {
  const IsaSchedule schedule = an_et_and_an_es();
  int period = 0;
  for (int round = 0; round < bench.volume(3, 60); ++round) {
    for (const fault::Stress& stress : bench.stresses()) {
      for (const int end = period + 2; period < end; ++period) {
        for (const IsaScheduleItem& item : schedule.items) {
          const kernel::Time due = kernel::kStart + period * schedule.period + item.at;
          const DrivenDlpdu one = expect_next(bench, judge, due + 2 * bench.slot(), "delegation_missing",
                                              "the next item of the schedule");
          const bool is_sequence = item.type == IsaType::es;
          const auto code = is_sequence ? bench.rules().codes.es : bench.rules().codes.et;
          judge.expect(is_type(one, code) && one.octet(1) == item.node, "delegation_wrong", [&] {
            return Mismatch{{fmt::format("an {} for {:02X}", is_sequence ? "ES" : "ET", item.node)},
                            one.text(),
                            one.begin};
          });
          expect_begins(judge, one, due - bench.slot(), "delegation_early", due + bench.slot(),
                        "delegation_late");
          bench.begin_stress(stress,
                             bench.octets(static_cast<std::int64_t>(bench.random().below(kOctetsUntilEe))));
          bench.run_until(bench.send_at(one.end + bench.least_gap(), bench.ee(item.node)));
          bench.end_stress();
        }
      }
    }
  }
  judge.measure("periods", "", static_cast<double>(period));
  measure_stress(bench, judge, {});
}

IsaCase bursts_at_dle(std::string_view name, std::int64_t bit_rate) {
  return {{.id = fmt::format("fieldbus_dll/isa_dle/immunity/bursts_ask_for_nothing_at_{}", name),
           .purpose = "ISA-19",
           .requirement = "Under bursts a station says what was asked for, and what was sent is reported to "
                          "its user; after a "
                          "burst the first token is used.",
           .reference = link_sources::line("frame check 1DCF"),
           .stimulus =
               fmt::format("{}, while tokens, CDs and data go on, for it and for others.", kBurstStimulus),
           .expected = "Nothing unasked, nothing reported otherwise; after each burst its data is sent.",
           .tags = {"must", std::string(kStressTag)},
           .catches = {{"stuck_behind_violation", "does_not_recover"}}},
          bursts_ask_a_dle_for_nothing,
          {.bit_rate = bit_rate}};
}

}  // namespace

std::vector<IsaCase> isa_immunity_cases() {
  using link_sources::isa_paper;
  using link_sources::own;
  return {
      bursts_at_dle("31250_bit_s", 31'250),
      bursts_at_dle("1_mbit_s", 1'000'000),
      {{.id = "fieldbus_dll/isa_las/immunity/the_schedule_goes_on_under_bursts",
        .purpose = "ISA-31",
        .requirement = "Under bursts the scheduler delegates its token in the order and at the times of its "
                       "schedule: what does not come back it takes back.",
        .reference = isa_paper("duration guarded on both sides"),
        .details = {{own("within one V(ST) of its time"), {"delegation_early", "delegation_late"}}},
        .stimulus = fmt::format("{}, at any place of the EEs; all holders return their tokens at once.",
                                kBurstStimulus),
        .expected = "Each item in its turn and at its time.",
        .tags = {"must", "timing", std::string(kStressTag)},
        .catches = {{"single_token_for_ever", "delegation_missing"},
                    {"reclaims_by_uc_only", "delegation_missing"}}},
       the_schedule_goes_on_under_bursts,
       {.schedule = an_et_and_an_es()}}};
}

}  // namespace fieldproof::conformance
