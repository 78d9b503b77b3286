#include <fmt/format.h>

#include <set>

#include "conformance/fieldbus_dll/ff_cases.hpp"
#include "conformance/fieldbus_dll/ff_expect.hpp"
#include "conformance/fieldbus_dll/link_immunity.hpp"

// Bursts at the receiver of a station of the profile FF-P.
namespace fieldproof::conformance {
namespace {

using fieldbus_dll::FfConfiguration;
using fieldbus_dll::Priority;

// Was it asked to say something: by a PT, a CD or a PN for it?
bool asks(const FfBench& bench, const DrivenDlpdu& dlpdu) {
  if (is_cd(bench, dlpdu)) return dlpdu.octet(1) == bench.node();
  const bool is_for_one = is_pt(bench, dlpdu) || is_of(dlpdu, bench.rules().codes.pn);
  return is_for_one && dlpdu.octet(1) == bench.node();
}

// What a station may be sent under bursts: what asks it, and what does not.
Octets something(FfBench& bench) {
  const Octets data = bench.numbered_data(2 + bench.random().below(20));
  switch (bench.random().below(6)) {
    case 0:
      return bench.pt(Priority::time_available, 200);
    case 1:
      return bench.cd(FfBench::kPublished);
    case 2:
      return {bench.rules().codes.pn, FfBench::kPeer};
    case 3: {
      Octets pt = bench.pt(Priority::time_available, 200);
      pt[1] = FfBench::kPeer;
      return pt;
    }
    case 4:
      return bench.dt3(FfBench::kSubscribed, data);
    default:
      return bench.dt1(Priority::normal, fieldbus_dll::address_of(bench.node(), 0x30), FfBench::kPeersAddress,
                       data);
  }
}

// One DLPDU, and what the station says to it.
void ask_under_stress(FfBench& bench, CaseJudge& judge, std::set<Octets>& submitted,
                      LinkBurstLedger& ledger) {
  const Octets data = bench.numbered_data(4);
  if (bench.submit(Priority::normal, data)) submitted.insert(data);
  bench.send(something(bench));
  const bool is_asked = asks(bench, bench.sent().back());
  for (const DrivenDlpdu& one : listen_under_stress(bench, judge, is_asked, ledger)) {
    judge.expect(!is_dt1(bench, one) || submitted.erase(dlsdu_of(one)) == 1, "data_wrong",
                 [&] { return Mismatch{{"what was submitted, once"}, one.text(), one.begin}; });
  }
}

void bursts_ask_for_nothing(FfBench& bench, CaseJudge& judge) {
  LinkBurstLedger ledger;
  std::set<Octets> submitted;
  bench.write(FfBench::kPublished, bench.numbered_data(8));
  under_each_stress(
      bench, bench.volume(4, 100), [&] { ask_under_stress(bench, judge, submitted, ledger); },
      [&] {
        expect_serves(bench, judge);
        submitted.clear();
      });
  measure_stress(bench, judge, ledger);
}

// ---- a scheduler ----

constexpr std::uint32_t kMacrocycleUnderBursts = 9'600;
constexpr std::uint8_t kFirstNode = 0x11;
constexpr std::uint8_t kSecondNode = 0x12;

void two_nodes_and_two_items(FfConfiguration& configuration) {
  configuration.live = {kFirstNode, kSecondNode};
  configuration.schedule = {.version = 1,
                            .macrocycle = kMacrocycleUnderBursts,
                            .items = {{800, 0x1120, Priority::normal}, {5'600, 0x1220, Priority::normal}}};
}

// How many answers of a node in a row have arrived otherwise than it gave them.
class HitAnswers {
 public:
  explicit HitAnswers(const FfBench& bench) : bench_(bench) {}
  void answer(std::uint8_t node) {
    judge_last();
    node_ = node;
    changed_before_ = bench_.stressed_transmissions();
  }
  std::size_t in_a_row(std::uint8_t node) {
    judge_last();
    return in_a_row_[node];
  }

 private:
  void judge_last() {
    if (!node_) return;
    const bool is_hit = bench_.stressed_transmissions() != changed_before_;
    in_a_row_[*node_] = is_hit ? in_a_row_[*node_] + 1 : 0;
    node_.reset();
  }

  const FfBench& bench_;
  std::optional<std::uint8_t> node_;
  std::uint64_t changed_before_ = 0;
  std::map<std::uint8_t, std::size_t> in_a_row_;
};

void a_scheduler_goes_on_under_bursts(FfBench& bench, CaseJudge& judge) {
  const auto& items = bench.configuration().schedule.items;
  const kernel::Duration macrocycle = kMacrocycleUnderBursts * fieldbus_dll::kTick;
  const kernel::Duration most = bench.octets(bench.rules().scheduling_overhead_octets);
  HitAnswers hits(bench);
  std::map<std::uint8_t, std::size_t> tokens;
  std::size_t compelled = 0;
  const auto answers = [&](const DrivenDlpdu& one) -> std::optional<FfBench::Reply> {
    if (is_cd(bench, one)) {
      const auto& item = items[compelled % items.size()];
      const kernel::Time due = kernel::kStart +
                               static_cast<std::int64_t>(compelled / items.size()) * macrocycle +
                               std::int64_t{item.at} * fieldbus_dll::kTick;
      judge.expect(one.octet(1) == item.address >> 8, "compelled_wrong", [&] {
        return Mismatch{{fmt::format("CD for {:04X}", item.address)}, one.text(), one.begin};
      });
      expect_begins(judge, one, due, "compelled_early", due + most, "compelled_late");
      ++compelled;
    }
    if (is_pt(bench, one)) {
      ++tokens[one.octet(1)];
      hits.answer(one.octet(1));
    }
    const bool is_told_to_all = is_dt1(bench, one) && addresses_in(one).to == fieldbus_dll::kEverybody;
    judge.expect(!is_told_to_all || hits.in_a_row(kFirstNode) >= 3 || hits.in_a_row(kSecondNode) >= 3,
                 "removed_too_early", [&] {
                   return Mismatch{{"the live list as it is: no three answers of a node in a row were hit"},
                                   one.text(),
                                   one.begin};
                 });
    return bench.returned(one);
  };
  kernel::Time end = kernel::kStart;
  for (int round = 0; round < bench.volume(3, 60); ++round) {
    for (const fault::Stress& stress : bench.stresses()) {
      const kernel::Duration later = kernel::Duration{
          static_cast<std::int64_t>(bench.random().below(static_cast<std::uint64_t>(macrocycle.count())))};
      bench.begin_stress(stress, later);
      end += 2 * macrocycle;
      bench.serve(end, answers);
      bench.end_stress();
    }
  }
  const auto rounds = static_cast<std::size_t>((end - kernel::kStart) / macrocycle);
  judge.expect(compelled + items.size() >= rounds * items.size(), "not_compelled", [&] {
    return Mismatch{{fmt::format("some {} CDs", rounds * items.size())}, fmt::format("{}", compelled)};
  });
  judge.measure("macrocycles", "", static_cast<double>(rounds));
  judge.measure("tokens", "", static_cast<double>(tokens[kFirstNode] + tokens[kSecondNode]));
  measure_stress(bench, judge, {});
}

FfCase bursts_at_device(std::string_view rate, void (*change)(FfConfiguration&)) {
  using link_sources::line;
  return {{.id = fmt::format("fieldbus_dll/ff_device/immunity/bursts_ask_for_nothing_at_{}", rate),
           .purpose = "FF-37",
           .requirement =
               "Under bursts a station says what was asked for, and what was sent is reported to its user; "
               "after a burst the first token is used.",
           .reference = line("frame check 1DCF"),
           .stimulus = fmt::format("{}, while tokens, CDs, probes and data go on, for it and for others.",
                                   kBurstStimulus),
           .expected = "Nothing unasked, nothing reported otherwise; after each burst its data is sent.",
           .tags = {"must", std::string(kStressTag)},
           .catches = {{"takes_violated_frames", "told_otherwise"},
                       {"stuck_behind_violation", "does_not_recover"}}},
          bursts_ask_for_nothing,
          {.change = change}};
}

}  // namespace

std::vector<FfCase> ff_immunity_cases() {
  using link_sources::memory;
  using link_sources::vendors;
  return {
      bursts_at_device("31250_bit_s", nullptr),
      bursts_at_device("1_mbit_s",
                       [](FfConfiguration& configuration) { configuration.rules.link.bit_rate = 1'000'000; }),
      {{.id = "fieldbus_dll/ff_las/immunity/the_link_goes_on_under_bursts",
        .purpose = "FF-14",
        .requirement =
            "Under bursts the scheduler compels at the times of its schedule, and removes nobody who "
            "has not missed three tokens in a row.",
        .reference = vendors("V(MSO)"),
        .details = {{memory("removal from the live list"), {"removed_too_early"}}},
        .stimulus = fmt::format("{}, at any place of the macrocycle; all nodes answer.", kBurstStimulus),
        .expected = "Each CD in its turn, from its time to V(MSO) later; no change of the live list without "
                    "three answers in a row that were hit.",
        .tags = {"must", "timing", std::string(kStressTag)},
        .catches = {{"removed_after_one_miss", "removed_too_early"}}},
       a_scheduler_goes_on_under_bursts,
       {.change = two_nodes_and_two_items}}};
}

}  // namespace fieldproof::conformance
