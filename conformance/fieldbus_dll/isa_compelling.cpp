#include <fmt/format.h>
#include <fmt/ranges.h>

#include "conformance/fieldbus_dll/isa_scene.hpp"

// The IUT holds a token and compels another station: who has the line, and when again.
namespace fieldproof::conformance {
namespace {

using fieldbus_dll::IsaService;
using fieldbus_dll::Priority;

// The IUT has a long token, has just sent a CD to the peer, and has a DLSDU to send after it.
struct Compelled {
  DrivenDlpdu cd;
  Octets behind;
};

// `sent` is the end of the CD.
void expect_compels(IsaScene& scene) {
  IsaBench& bench = scene.bench;
  scene.judge.expect(bench.submit(IsaService::compel, Priority::normal, {}), "data_refused",
                     "a CD is accepted", "it was refused");
  scene.submitted = {bench.numbered_data(6)};
  bench.submit_unit_data(Priority::normal, scene.submitted[0]);
  bench.send(bench.es(Priority::time_available, 5'000));
  scene.answer = expect_next(bench, scene.judge, "no_compelling", "a CD to the peer");
  scene.sent = scene.answer.end;
  const Octets right{bench.control(bench.rules().codes.cd, Priority::normal), IsaBench::kPeer,
                     bench.address()};
  scene.judge.expect(scene.answer.octets == right, "dlpdu_wrong", [&] {
    return Mismatch{
        {fmt::format("CD: {:02X}", fmt::join(right, " "))}, scene.answer.text(), scene.answer.begin};
  });
  bench.user().deliveries.clear();
}

IsaStep compels() {
  return {"the user submits a CD to 22 and a normal DLSDU; an ES time-available for 5000 octet durations",
          "the CD", expect_compels};
}

void expect_goes_on(IsaScene& scene) {
  scene.answer = expect_next(scene.bench, scene.judge, "does_not_go_on", "the DLSDU after the CD");
  scene.judge.expect(scene.answer.rest() == scene.submitted[0], "does_not_go_on", [&] {
    return Mismatch{{"the DLSDU after the CD"}, scene.answer.text(), scene.answer.begin};
  });
}

void expect_silence_in_reply(IsaScene& scene) {
  IsaBench& bench = scene.bench;
  const kernel::Time end =
      bench.send_at(scene.sent + bench.reply_wait() - bench.octets(1),
                    bench.dt(Priority::normal, scene.fresh(2 + bench.random().below(100))));
  scene.judge.expect(!bench.next_begins(end), "talks_into_reply", "silence while the reply is on the line",
                     "the station began to drive");
}

void expect_no_voice_into_late_reply(IsaScene& scene) {
  IsaBench& bench = scene.bench;
  const kernel::Time begin = scene.sent + bench.reply_wait() + bench.octets(2);
  const kernel::Time end = bench.send_at(begin, bench.dt(Priority::normal, scene.fresh(20)));
  const auto next = bench.next(end);
  scene.judge.expect(!next || next->begin <= begin, "talks_into_reply", [&] {
    return Mismatch{
        {fmt::format("the station begins before {}, or when the reply is over", kernel::describe(begin))},
        next->text(),
        next->begin};
  });
  bench.run_until(end);
}

void expect_no_answer_while_waiting(IsaScene& scene) {
  constexpr std::uint8_t kThirdNode = 0x23;
  Octets cd = scene.bench.cd(Priority::normal);
  cd[2] = kThirdNode;
  scene.reply(cd);
  for (const DrivenDlpdu& one : scene.bench.listen()) {
    scene.judge.expect(!is_type(one, scene.bench.rules().codes.dt), "answers_while_waiting", [&] {
      return Mismatch{{"no DT: the station waits for a reply itself"}, one.text(), one.begin};
    });
  }
}

}  // namespace

std::vector<IsaCase> isa_compelling_cases() {
  using namespace isa_chart;
  using enum Priority;
  const IsaStep goes_on = expected<IsaScene>("the DLSDU after the CD", expect_goes_on);
  const LinkStep returned = says("the token returned", "token_not_returned");
  // Whatever was left of the token and of the data is gone by then.
  const LinkStep ended = says("data or EE", "does_not_recover");
  using link_sources::isa_paper;
  using link_sources::own;
  return {
      on_chart(
          must_in_time("fieldbus_dll/isa_dle/compelling/a_late_reply_is_waited_for", "ISA-19",
                       "A reply that begins within V(RR) is taken, and the token holder goes on after it.",
                       isa_paper("VC(RR): the time for which a reply is waited for"),
                       {{"rr_runs_through_reply", "talks_into_reply"},
                        {"reply_wait_without_slots", "talks_into_reply"},
                        {"reply_ends_token", "does_not_go_on"}}),
          {{3, 20},
           {compels(),
            IsaStep{"22 begins to reply an octet before V(RR) is over",
                    "silence while the reply is on the line", expect_silence_in_reply},
            delivered("the reply", "reply_not_taken"), goes_on, returned}}),
      on_chart(must_in_time("fieldbus_dll/isa_dle/compelling/a_missing_reply_costs_rr", "ISA-20",
                            "Without a reply the token holder goes on when V(RR) is over, not before.",
                            isa_paper("VC(RR): the time for which a reply is waited for"),
                            {{"reply_wait_without_slots", "resumes_early"},
                             {"reply_wait_a_tenth_longer", "resumes_late"},
                             {"missing_reply_ends_token", "does_not_go_on"}},
                            {{own("V(RR) is V(MRD) x V(ST), 32 octets, from the end of the CD"),
                              {"resumes_early", "resumes_late"}}}),
               {{3, 20},
                {compels(), goes_on,
                 expected<IsaScene>(
                     "it begins within an octet after V(RR), 32 octet durations after the CD, not before",
                     [](IsaScene& scene) {
                       const kernel::Time over = scene.sent + scene.bench.reply_wait();
                       expect_begins(scene.judge, scene.answer, over, "resumes_early",
                                     over + scene.bench.octets(1), "resumes_late");
                     }),
                 returned}}),
      on_chart(must_in_time(
                   "fieldbus_dll/isa_dle/compelling/a_reply_behind_rr_is_none", "ISA-21",
                   "A reply that begins after V(RR) is none, and nothing is sent into it.",
                   isa_paper("VC(RR): the time for which a reply is waited for"),
                   {{"reply_wait_a_tenth_longer", "late_reply_taken"}, {"deaf_and_late", "talks_into_reply"}},
                   {{own("late replies are discarded"), {"late_reply_taken"}}}),
               {{3, 20},
                {compels(),
                 IsaStep{"22 begins to reply two octets after V(RR)",
                         "the station has begun before, or begins after the reply",
                         expect_no_voice_into_late_reply},
                 returned,
                 require(
                     "the reply is not delivered",
                     [](IsaScene& scene) { return !scene.bench.user().was_delivered(scene.data); },
                     "late_reply_taken")}}),
      on_chart(must_case("fieldbus_dll/isa_dle/compelling/a_cd_in_place_of_a_reply_is_not_answered", "ISA-26",
                         "Who waits for a reply does not answer a CD: two would have the line.",
                         own("another DLPDU in place of a reply"),
                         {{"answers_while_waiting", "answers_while_waiting"}}),
               {{2, 10},
                {compels(),
                 stimulus<IsaScene>("the user submits normal data for a reply, 4 octets",
                                    [](IsaScene& scene) {
                                      scene.bench.submit(IsaService::reply_data, normal,
                                                         scene.bench.numbered_data(4));
                                    }),
                 IsaStep{"23 compels the station", "no DT: it waits for a reply itself",
                         expect_no_answer_while_waiting},
                 cd(normal), ended, es(time_available, 5'000), ended, serves()}}),
  };
}

}  // namespace fieldproof::conformance
