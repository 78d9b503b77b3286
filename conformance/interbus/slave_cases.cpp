#include "conformance/interbus/slave_cases.hpp"

#include <array>
#include <utility>

namespace fieldproof::conformance {
namespace {

SlaveCase canary() {
  return {canary_of("interbus/slave", sources::own("rules of the suite"),
                    "An ID cycle and a valid data cycle with random words.",
                    "the case asks for a returned loopback word that differs from the one sent."),
          [](SlaveBench& bench, CaseJudge& judge) {
            bench.bring_up();
            bench.data_cycle(bench.random_words());
            const std::optional<CycleOnLine> out = bench.cycle_on(bench.out(), 0);
            judge.expect(out && out->word(out->octets - 2) == 0xFFFF && out->word(0) == 0x1234, "canary",
                         "a slave that answers with what nobody sent", "it answered with what was sent");
          }};
}

// Why a network of the user's does not have what the case needs.
std::optional<std::string> missing_in_network(const SlaveNeeds& needs,
                                              const interbus::NetworkDescription& network, int position) {
  const std::vector<interbus::RingPlace> places = ring_order(network);
  const auto has_neighbour = [&](bool on_branch) {
    for (const interbus::RingPlace& place : places) {
      if (place.before == position - 1 && place.on_branch == on_branch) return true;
    }
    return false;
  };
  if (needs.change_rules != nullptr)
    return "the case has settings of its own, and the network has given ones";
  const interbus::RingPlace& own = places[static_cast<std::size_t>(position - 1)];
  if (needs.id_code && own.station->id_code != *needs.id_code)
    return "the station of the network has another ID code than the case asks for";
  if (needs.remote_neighbour && !has_neighbour(false))
    return "nothing is connected to the remote-bus interface (OUT1) of the slave";
  if (needs.branch_neighbour && !has_neighbour(true))
    return "nothing is connected to the second interface (OUT2) of the slave";
  return std::nullopt;
}

judge::CaseResult not_applicable(const TestCase& test_case, std::string sentence) {
  judge::CaseResult result;
  result.id = test_case.id;
  result.purpose = test_case.purpose;
  result.requirement = test_case.requirement;
  result.reference = test_case.reference;
  result.verdict = judge::Verdict::not_applicable;
  result.reason = std::move(sentence);
  return result;
}

}  // namespace

const std::vector<SlaveCase>& slave_cases() {
  static const std::vector<SlaveCase> cases = [] {
    static constexpr std::array kChapters{
        slave_power_up_cases,    slave_id_cycle_cases,    slave_data_cycle_cases, slave_length_code_cases,
        slave_frame_check_cases, slave_short_cycle_cases, slave_telegram_cases,   slave_timing_cases,
        slave_supervision_cases, slave_interface_cases,   slave_message_cases,    slave_immunity_cases,
        slave_compared_cases};
    auto all = cases_of<SlaveCase>(kChapters, {});
    all.push_back(canary());
    return all;
  }();
  return cases;
}

judge::CaseResult run_slave_case(const SlaveCase& slave_case, const SlaveSetting& setting) {
  const TestCase& test_case = slave_case.test_case;
  if (setting.network) {
    if (auto sentence = missing_in_network(slave_case.needs, *setting.network, setting.position))
      return not_applicable(test_case, *sentence);
  }
  std::optional<std::string> reason_not_runnable;
  SlaveCase asked = slave_case;
  asked.procedure = [&](SlaveBench& bench, CaseJudge& judge) {
    if (test_case.not_applicable) reason_not_runnable = test_case.not_applicable(bench.pics());
    if (!reason_not_runnable) slave_case.procedure(bench, judge);
  };
  judge::CaseResult result = run_on_bench(asked, setting);
  return reason_not_runnable ? not_applicable(test_case, *reason_not_runnable) : result;
}

std::vector<SlaveCase> joined(const std::vector<std::vector<SlaveCase>>& parts) {
  std::vector<SlaveCase> all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

Applicability for_item(const std::string& item, const std::string& sentence) {
  return [item, sentence](const judge::Pics& pics) -> std::optional<std::string> {
    if (pics.supports(item)) return std::nullopt;
    return sentence;
  };
}
Applicability for_other_settings() {
  return for_item("other_settings", "the slave cannot be given other settings than the usual ones");
}
Applicability for_all(std::vector<Applicability> each) {
  return [each = std::move(each)](const judge::Pics& pics) -> std::optional<std::string> {
    for (const Applicability& one : each) {
      if (auto sentence = one(pics)) return sentence;
    }
    return std::nullopt;
  };
}
Applicability for_outputs() {
  return for_item("outputs", "the slave has no outputs");
}
Applicability for_inputs() {
  return for_item("inputs", "the slave has no inputs");
}
Applicability for_remote() {
  return for_item("remote_interface", "the slave has no outgoing remote-bus interface (OUT1)");
}

namespace sources {
judge::Reference park(std::string place) {
  return {"Park 2004", std::move(place), judge::Standing::seed};
}
judge::Reference practical_guide(std::string place) {
  return {"Buesing and Meyer, INTERBUS Practical Guide", std::move(place), judge::Standing::searched};
}
judge::Reference phoenix_maintenance(std::string place) {
  return {"Phoenix Contact UK, operation and maintenance of INTERBUS", std::move(place),
          judge::Standing::searched};
}
judge::Reference calculated(std::string place) {
  return {"computed from the polynomial", std::move(place), judge::Standing::calc};
}
judge::Reference derived(std::string place) {
  return {"follows from Park 2004 and the Practical Guide", std::move(place), judge::Standing::derived};
}
judge::Reference from_memory(std::string place) {
  return {"INTERBUS literature from memory", std::move(place), judge::Standing::memory};
}
judge::Reference own(std::string place) {
  return {"this project's choice", std::move(place), judge::Standing::own};
}
}  // namespace sources

namespace details {
PartialSource check_coding() {
  return {sources::own("bit order and final XOR of the frame check"), {"check_wrong"}};
}
PartialSource status_coding() {
  return {sources::own("a clean status word is 0000h and passes as it came"), {"status_word_wrong"}};
}
PartialSource mark(std::vector<std::string> reasons) {
  return {sources::own("coding of the mark in the status word; that there is one is from memory"),
          std::move(reasons)};
}
PartialSource message(std::vector<std::string> reasons) {
  return {sources::own("place of the message bit of a check error; that there is one is from memory"),
          std::move(reasons)};
}
std::vector<PartialSource> answer() {
  return {{sources::own("coding of SL and CR in the check phase and in ID cycles"), {"header_wrong"}},
          check_coding(),
          status_coding()};
}
}  // namespace details

}  // namespace fieldproof::conformance
