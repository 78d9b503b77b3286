#include <fmt/format.h>

#include "conformance/fieldbus_dll/isa_scene.hpp"

// V(MID), V(FD) and V(RR) at their ends, at each octet of their width and beside powers of two. A line that
// others keep busy with what is no DLPDU, data that come late and replies that do show how long a station
// waits.
namespace fieldproof::conformance {
namespace {

using fieldbus_dll::IsaConfiguration;
using fieldbus_dll::IsaService;
using fieldbus_dll::Priority;

struct IsaTimersRow {
  unsigned silence;  // V(MID)
  unsigned forming;  // V(FD)
  unsigned wait;     // V(RR)
  unsigned response_slots;
  unsigned slot;
  std::vector<MustCatch> catches;
};

kernel::Duration half_bit_of(const IsaBench& bench) {
  return bench.octets(1) / 16;
}

DlpduIsNone kind_of_turn(const IsaScene& scene) {
  return scene.turn % 2 == 0 ? DlpduIsNone::by_its_check : DlpduIsNone::by_its_first_octet;
}

// ---- compelled ----

void offer_and_compel(IsaScene& scene, bool is_worked_out) {
  scene.bench.user().works_on_reply = is_worked_out;
  scene.submitted = {scene.bench.numbered_data(8)};
  if (!is_worked_out) scene.bench.submit(IsaService::reply_data, Priority::normal, scene.submitted[0]);
  scene.sent = scene.bench.send(scene.bench.cd(Priority::normal));
}

IsaStep compelled(bool is_worked_out) {
  const std::string what =
      is_worked_out ? "the user says that it works on a reply" : "the user submits data for a reply";
  return stimulus<IsaScene>(what + "; a CD normal",
                            [is_worked_out](IsaScene& scene) { offer_and_compel(scene, is_worked_out); });
}

void expect_reply(IsaScene& scene, kernel::Time earliest) {
  scene.answer = expect_next(scene.bench, scene.judge, "no_reply", "a DT with the data");
  expect_begins(scene.judge, scene.answer, earliest, "answers_too_early",
                scene.sent + scene.bench.reply_forming(), "reply_too_late");
  scene.judge.expect(
      is_type(scene.answer, scene.bench.rules().codes.dt) && scene.answer.rest() == scene.submitted[0],
      "data_wrong",
      [&] { return Mismatch{{"a DT with the data"}, scene.answer.text(), scene.answer.begin}; });
}

IsaStep replied_at_once() {
  return expected<IsaScene>("the DT, begun between V(MID) and V(FD)", [](IsaScene& scene) {
    expect_reply(scene, scene.sent + scene.bench.least_gap());
    scene.latency = scene.answer.begin - scene.sent - scene.bench.least_gap();
  });
}

void expect_reply_when_silent(IsaScene& scene) {
  const kernel::Time until =
      scene.sent + scene.bench.reply_forming() - scene.bench.least_gap() - scene.latency;
  const bool is_busy = keep_busy(scene.bench, until, kind_of_turn(scene));
  expect_reply(scene, (is_busy ? until : scene.sent) + scene.bench.least_gap());
}

void expect_no_reply_when_silent(IsaScene& scene) {
  IsaBench& bench = scene.bench;
  const kernel::Time until = scene.sent + bench.reply_forming() - bench.least_gap() + half_bit_of(bench);
  if (!keep_busy(bench, until, kind_of_turn(scene)))
    return expect_reply(scene, scene.sent + bench.least_gap());
  expect_silence(bench, scene.judge, "reply_too_late", "V(FD) is over before V(MID) is");
  scene.sent = bench.send(bench.cd(Priority::normal));
  expect_reply(scene, scene.sent + bench.least_gap());
}

void submit_for_reply(IsaScene& scene, kernel::Time when) {
  scene.bench.run_until(when);
  scene.bench.submit(IsaService::reply_data, Priority::normal, scene.submitted[0]);
  scene.bench.user().works_on_reply = false;
}

void expect_reply_of_late_data(IsaScene& scene) {
  IsaBench& bench = scene.bench;
  const kernel::Time over = scene.sent + bench.reply_forming();
  submit_for_reply(scene, over - half_bit_of(bench) - scene.latency);
  expect_reply(scene, bench.now());
}

void expect_no_reply_of_later_data(IsaScene& scene) {
  IsaBench& bench = scene.bench;
  submit_for_reply(scene, scene.sent + bench.reply_forming() + half_bit_of(bench) / 2);
  expect_silence(bench, scene.judge, "reply_too_late", "V(FD) is over");
  scene.sent = bench.send(bench.cd(Priority::normal));
  expect_reply(scene, scene.sent + bench.least_gap());
}

// ---- compelling ----

void expect_to_compel(IsaScene& scene) {
  scene.bench.submit(IsaService::compel, Priority::normal, {});
  scene.bench.send(scene.bench.et(Priority::normal));
  scene.answer = expect_next(scene.bench, scene.judge, "no_compelling", "a CD to the peer");
  scene.sent = scene.answer.end;
}

IsaStep compels() {
  return {"the user submits a CD to 22; an ET normal", "the CD", expect_to_compel};
}

// When V(RR) is over on a line that is silent since then.
void expect_resumed(IsaScene& scene, kernel::Time silent_since) {
  IsaBench& bench = scene.bench;
  const kernel::Time right = std::max(scene.sent + bench.reply_wait(), silent_since + bench.least_gap());
  const DrivenDlpdu ee = expect_next(bench, scene.judge, "does_not_go_on", "an EE");
  expect_begins(scene.judge, ee, right, "resumes_early", right + bench.octets(1), "resumes_late");
}

void expect_resumed_behind(IsaScene& scene, kernel::Duration after_wait) {
  const kernel::Time until = scene.sent + scene.bench.reply_wait() + after_wait;
  const bool is_busy = keep_busy(scene.bench, until, kind_of_turn(scene));
  expect_resumed(scene, is_busy ? until : scene.sent);
}

// Half of half a bit before the end of V(RR), or after it.
void reply_beside_end(IsaScene& scene, bool is_late) {
  IsaBench& bench = scene.bench;
  const kernel::Duration quarter = half_bit_of(bench) / 2;
  const kernel::Time over = scene.sent + bench.reply_wait();
  bench.user().deliveries.clear();
  bench.run_until(
      bench.send_at(is_late ? over + quarter : over - quarter, bench.dt(Priority::normal, scene.fresh(4))));
  bench.listen();
}

std::vector<IsaStep> timed_replies() {
  return {compelled(false),
          IsaStep{"others keep the line busy, turn by turn with a wrong check and with no first octet, until "
                  "V(MID) before V(FD) is over",
                  "the DT begins until then", expect_reply_when_silent},
          compelled(false),
          IsaStep{"they keep it busy half a bit longer; another CD",
                  "no DT until then, but behind the other CD", expect_no_reply_when_silent},
          compelled(true),
          IsaStep{"the user submits data half a bit before V(FD) is over", "the DT with them",
                  expect_reply_of_late_data},
          compelled(true),
          IsaStep{"the user submits data a quarter of a bit after V(FD) is over; another CD",
                  "no DT until then, but behind the other CD", expect_no_reply_of_later_data}};
}

std::vector<IsaStep> timed_waits() {
  using namespace isa_chart;
  const auto behind = [](std::int64_t octets) {
    return [octets](IsaScene& scene) { expect_resumed_behind(scene, scene.bench.octets(octets)); };
  };
  return {
      compels(),
      expected<IsaScene>("an EE begins when V(RR) is over, or within an octet",
                         [](IsaScene& scene) { expect_resumed(scene, scene.sent); }),
      compels(),
      IsaStep{"others keep the line busy until two octets before V(RR) is over",
              "the EE begins when V(RR) and V(MID) are over", behind(-2)},
      compels(),
      IsaStep{"others keep the line busy until two octets after V(RR) is over",
              "the EE begins when V(MID) is over", behind(2)},
      compels(),
      stimulus<IsaScene>("22 begins to reply a quarter of a bit before V(RR) is over",
                         [](IsaScene& scene) { reply_beside_end(scene, false); }),
      delivered("the reply", "reply_not_taken"),
      compels(),
      stimulus<IsaScene>("22 begins to reply a quarter of a bit after V(RR) is over",
                         [](IsaScene& scene) { reply_beside_end(scene, true); }),
      require(
          "the reply is not delivered",
          [](IsaScene& scene) { return !scene.bench.user().was_delivered(scene.data); }, "late_reply_taken")};
}

IsaCase isa_timers_case(IsaTimersRow row) {
  using namespace isa_chart;
  const auto change = [silence = row.silence, forming = row.forming, wait = row.wait,
                       slots = row.response_slots, slot = row.slot](IsaConfiguration& configuration) {
    configuration.rules.link.inter_pdu_delay_octets = silence;
    configuration.rules.link.response_delay_slots = slots;
    configuration.rules.link.slot_time_octets = slot;
    configuration.rules.reply_forming_octets = forming;
    configuration.rules.reply_wait_octets = wait;
  };
  return on_chart(
      must_in_time(fmt::format("fieldbus_dll/isa_dle/settings/mid_{}_fd_{}_rr_{}_are_kept", row.silence,
                               row.forming, row.wait),
                   "ISA-41",
                   fmt::format("A station of a link with V(MID) {}, V(FD) {} and V(RR) {} keeps them.",
                               row.silence, row.forming, row.wait),
                   link_sources::own("V(MID), V(FD) and V(RR) are settings"), std::move(row.catches)),
      {{},
       {compelled(false), replied_at_once(), repeat({2, 6}, timed_replies()), repeat({2, 6}, timed_waits()),
        serves()}},
      {.change = change});
}

}  // namespace

std::vector<IsaCase> isa_timers_cases() {
  std::vector<IsaCase> all;
  for (IsaTimersRow& row : std::vector<IsaTimersRow>{
           {0, 1, 2, 4, 8, {{"silence_of_the_usual_link", "no_reply"}}},
           {1, 2, 255, 8, 32, {{"forms_an_octet_longer", "reply_too_late"}}},
           {2,
            25,
            33,
            3,
            20,
            {{"forms_half_a_bit_longer", "reply_too_late"}, {"forms_an_octet_less", "no_reply"}}},
           {7,
            255,
            256,
            5,
            256,
            {{"forms_within_the_usual_time", "no_reply"},
             {"waits_eight_bits", "resumes_early"},
             {"waits_half_a_bit_longer", "late_reply_taken"}}},
           {15,
            256,
            257,
            9,
            60,
            {{"forms_within_eight_bits", "no_reply"}, {"waits_half_a_bit_less", "resumes_early"}}},
           {24, 30, 40, 4, 8, {{"longest_silence_refused", "no_reply"}}},
           {63, 257, 4'096, 11, 512, {{"no_dlpdu_ends_the_wait", "no_reply"}}},
           {64, 128, 32'767, 11, 4'095, {{"waits_the_usual_time", "resumes_early"}}},
           {65, 32'768, 32'769, 11, 4'095, {{"silence_of_the_usual_link", "answers_too_early"}}},
           {120, 65'534, 65'535, 11, 4'095, {{"forms_within_the_usual_time", "no_reply"}}}}) {
    all.push_back(isa_timers_case(std::move(row)));
  }
  return all;
}

}  // namespace fieldproof::conformance
