// The bench of a responder, three cases on it, and what `check` and `fuzz` draw.
#include <array>

#include <conformance/bench_role.hpp>
#include <conformance/bus_bench.hpp>

#include "poll.hpp"

namespace poll {
namespace {

using namespace conformance;

using PollSetting = PlannedSetting<Device, Configuration>;

struct Dissector : trace::OctetDissector {
  explicit Dissector(const Rules& rules) : OctetDissector(rules.bit_rate) {}
};

// The tester is the master.
class PollBench final : public BusBench<Device, Configuration> {
 public:
  PollBench(const NoNeeds&, const PollSetting& setting)
      : BusBench("responder", {}, setting), uart_(configuration().rules.bit_rate) {
    device().wire(place(), [this](kernel::Time) { return value_; });
  }

  Octets right_request() const { return request_to(configuration().address); }

  // Sends it, waits for longer than an answer may take, and judges what has come.
  void expect_answer(CaseJudge& judge, const Octets& request, std::uint8_t value) {
    const kernel::Time asked = ask(request, value);
    judge.expect_equal(driven().size(), 1U, "no_answer", "answers");
    const double took = static_cast<double>((driven().front().start - asked).count()) * 1e-9;
    judge.expect_between("turnaround time", "ms", took, 0, 2, "answers_late");
    judge.expect(value_in(configuration().address, uart_.octets_in(driven().front())) == value,
                 "answer_wrong", "the value, and a check that fits", "another answer");
  }
  void expect_silence(CaseJudge& judge, const Octets& request, std::string_view reason) {
    ask(request, random_octet());
    judge.expect_equal(driven().size(), 0U, reason, "answers");
  }

 private:
  // Gives the end of the request.
  kernel::Time ask(const Octets& request, std::uint8_t value) {
    value_ = value;
    clear_driven();
    const kernel::Time asked = send(uart_.wave_of(request, now()));
    segment().run_for(8 * kernel::kMillisecond);
    return asked;
  }

  line::OctetLine uart_;
  std::uint8_t value_ = 0;
};

using PollCase = BenchCase<PollBench, NoNeeds>;

void values_come_back(PollBench& bench, CaseJudge& judge) {
  for (int n = 0; n < bench.volume(20, 500); ++n)
    bench.expect_answer(judge, bench.right_request(), bench.random_octet());
}

// The second octet, with each pattern of wrong bits.
void wrong_checks_are_ignored(PollBench& bench, CaseJudge& judge) {
  for (unsigned flaw = 1; flaw < 256; ++flaw) {
    Octets request = bench.right_request();
    request[1] ^= static_cast<std::uint8_t>(flaw);
    bench.expect_silence(judge, request, "wrong_check_answered");
  }
  bench.expect_answer(judge, bench.right_request(), bench.random_octet());
}

void other_addresses_are_ignored(PollBench& bench, CaseJudge& judge) {
  for (unsigned address = 0; address < 256; ++address) {
    const auto other = static_cast<std::uint8_t>(address);
    if (other != bench.configuration().address)
      bench.expect_silence(judge, request_to(other), "answers_for_another");
  }
  bench.expect_answer(judge, bench.right_request(), bench.random_octet());
}

PollCase poll_case(std::string id, std::string requirement, std::string stimulus,
                   std::vector<MustCatch> catches, void (*procedure)(PollBench&, CaseJudge&)) {
  return {{.id = "poll/responder/" + std::move(id),
           .purpose = "toy",
           .requirement = std::move(requirement),
           .reference = {"the head of poll.hpp", "", judge::Standing::own},
           .stimulus = std::move(stimulus),
           .expected = "One right answer within 2 ms, or silence.",
           .tags = {"must"},
           .catches = std::move(catches)},
          procedure};
}

const std::vector<PollCase>& cases() {
  static const std::vector<PollCase> all{
      poll_case("answer/values_come_back", "A request is answered within 2 ms, with the value and its check.",
                "Requests, random values.", {{"answers_late", "answers_late"}}, values_come_back),
      poll_case("check/wrong_checks_are_ignored", "A request whose check does not fit is not answered.",
                "Requests with each wrong check.", {{"check_ignored", "wrong_check_answered"}},
                wrong_checks_are_ignored),
      poll_case("address/other_addresses_are_ignored", "A request to another responder is not answered.",
                "Requests to each other address.", {{"answers_for_all", "answers_for_another"}},
                other_addresses_are_ignored)};
  return all;
}

const SequenceRole& sequences() {
  static constexpr std::array<std::int64_t, 3> kLikely{7, 0, 1};
  static const SequenceRole role{
      poll_case("check/follows_the_rules", "Right requests of its own are answered, and nothing else.",
                "Requests at random.", {}, nullptr)
          .test_case,
      {.words = {{.word = "request",
                  .meaning = "a request, its check inverted in the bits of the flaw",
                  .numbers = {{"address", 0, 255, 7, kLikely},
                              {"flaw", 0, 255, 0, kLikely},
                              {"value", 0, 255, 0}}}}},
      {{DerivedKind::values, {"check_ignored", "answers_what_it_must_not"}},
       {DerivedKind::words, {"answers_for_all", "answers_what_it_must_not"}},
       {DerivedKind::repetitions, {"answers_late", "answers_late"}}}};
  return role;
}

void run_sequence(const Sequence& sequence, PollBench& bench, CaseJudge& judge) {
  for (const SequenceCommand& command : sequence.commands) {
    Octets request = request_to(static_cast<std::uint8_t>(command.numbers[0]));
    request[1] ^= static_cast<std::uint8_t>(command.numbers[1]);
    if (request == bench.right_request()) {
      bench.expect_answer(judge, request, static_cast<std::uint8_t>(command.numbers[2]));
    } else {
      bench.expect_silence(judge, request, "answers_what_it_must_not");
    }
  }
}

}  // namespace

std::unique_ptr<Suite> suite(SuiteGiven given) {
  return std::make_unique<Suite>(
      SuiteRows{.protocol = "poll",
                .roles = {row_of<ResponderRole, Responder>(
                    {.what = "responder", .mutants = mutants},
                    CaseRole<PollCase, PollSetting, Dissector>{
                        .name = "responder",
                        .cases = cases,
                        .sequences = SequenceRow<PollCase>{sequences, run_sequence}})},
                .why_no_network = "the cases make the line that they need; leave out the network"},
      std::move(given));
}

}  // namespace poll
