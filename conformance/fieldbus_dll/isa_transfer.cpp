#include <fmt/format.h>
#include <fmt/ranges.h>

#include "conformance/fieldbus_dll/isa_scene.hpp"

// Who is the scheduler: TL, and two of them.
namespace fieldproof::conformance {
namespace {

using fieldbus_dll::IsaSchedule;
using fieldbus_dll::IsaType;
using fieldbus_dll::Priority;

constexpr int kPeriod = 200;
constexpr std::uint8_t kServed = 0x21;
constexpr std::uint8_t kHeir = 0x11;
constexpr std::uint8_t kLower = 0x0F;
constexpr std::uint16_t kVersion = 0x0102;

IsaSchedule periodic() {
  return {.version = kVersion,
          .period = kPeriod * kOctetAt31250,
          .items = {{20 * kOctetAt31250, IsaType::et, kServed, Priority::normal, 0}}};
}

IsaSchedule late_items() {
  return {.version = 1,
          .period = {},
          .items = {{60 * kOctetAt31250, IsaType::et, kServed, Priority::normal, 0},
                    {130 * kOctetAt31250, IsaType::es, 0x22, Priority::normal, 40}}};
}

IsaSchedule at_once() {
  return {.version = 1, .period = {}, .items = {{{}, IsaType::et, kServed, Priority::normal, 0}}};
}

bool is_scheduling(const IsaBench& bench, const DrivenDlpdu& dlpdu) {
  const auto& codes = bench.rules().codes;
  return is_type(dlpdu, codes.et) || is_type(dlpdu, codes.es) || is_type(dlpdu, codes.tl);
}

Octets tl_to(const IsaScene& scene, std::uint8_t node) {
  return {scene.bench.rules().codes.tl, node, kLower, 0, 1};
}

IsaStep no_scheduler(const std::string& why) {
  return expected<IsaScene>(
      "no ET, ES or TL in three periods of the schedule: " + why, [why](IsaScene& scene) {
        const kernel::Time end = scene.bench.now() + 3 * kPeriod * kOctetAt31250;
        while (const auto one = scene.bench.next(end)) {
          scene.judge.expect(!is_scheduling(scene.bench, *one), "two_schedulers", [&] {
            return Mismatch{{fmt::format("no ET, ES or TL: {}", why)}, one->text(), one->begin};
          });
        }
      });
}

void expect_taken(IsaScene& scene) {
  IsaBench& bench = scene.bench;
  const DrivenDlpdu first = expect_next(bench, scene.judge, "not_taken", "a DLPDU of the new scheduler");
  expect_begins(scene.judge, first, scene.sent + bench.least_gap(), "answers_too_early",
                scene.sent + bench.reply_wait(), "taken_late");
  scene.judge.expect(fieldbus_dll::isa_dlpdu_of(first.octets, bench.rules()).has_value(), "not_taken",
                     "a DLPDU of the new scheduler", first.text());
  std::vector<DrivenDlpdu> tokens;
  if (is_scheduling(bench, first)) tokens.push_back(first);
  while (const auto one = bench.next(scene.sent + bench.octets(400)))
    if (is_scheduling(bench, *one)) tokens.push_back(*one);
  const auto& codes = bench.rules().codes;
  const bool is_right = tokens.size() == 2 && is_type(tokens[0], codes.et) && is_type(tokens[1], codes.es);
  scene.judge.expect(is_right, "schedule_not_run", [&] {
    return Mismatch{{"the ET and the ES of its schedule"}, fmt::format("{} tokens", tokens.size())};
  });
}

void order_late_transfer(IsaScene& scene) {
  scene.bench.run_until(kernel::kStart + (kPeriod + 14) * kOctetAt31250);
  scene.bench.order_transfer(kHeir);
}

void expect_transfer_ordered(IsaScene& scene) {
  scene.answer = expect_next(scene.bench, scene.judge, "no_transfer", "a TL");
  const Octets right{scene.bench.rules().codes.tl, kHeir, scene.bench.address(), kVersion >> 8,
                     kVersion & 0xFF};
  scene.judge.expect(scene.answer.octets == right, "transfer_wrong", [&] {
    return Mismatch{{fmt::format("{:02X}", fmt::join(right, " "))}, scene.answer.text(), scene.answer.begin};
  });
}

void expect_retaken(IsaScene& scene) {
  const kernel::Time over = scene.answer.end + scene.bench.reply_wait();
  const DrivenDlpdu next = expect_next(scene.bench, scene.judge, over + 2 * kPeriod * kOctetAt31250,
                                       "not_retaken", "the schedule goes on");
  expect_begins(scene.judge, next, over, "retaken_early", over + (kPeriod + 40) * kOctetAt31250,
                "not_retaken");
  scene.judge.expect(is_scheduling(scene.bench, next), "not_retaken", "the next item of the schedule",
                     next.text());
}

void expect_kept(IsaScene& scene) {
  const auto next = scene.bench.next(scene.bench.now() + 2 * kPeriod * kOctetAt31250);
  scene.judge.expect(next && is_scheduling(scene.bench, *next), "left_to_higher",
                     "the schedule goes on: the other has the higher address", "the scheduler is gone");
  scene.answer = *next;
}

}  // namespace

std::vector<IsaCase> isa_transfer_cases() {
  using namespace isa_chart;
  const IsaStep transfer_to_station =
      send("a TL to the station", [](IsaScene& scene) { return tl_to(scene, scene.bench.address()); });
  const IsaStep returned = stimulus<IsaScene>("its holder returns it at once",
                                              [](IsaScene& scene) { scene.reply(scene.bench.ee(kServed)); });
  const IsaStep transferred = repeat(
      {}, {delegated("the token of the schedule"), returned,
           stimulus<IsaScene>("the user orders a transfer to 11, so late that the next item is due in it",
                              order_late_transfer),
           expected<IsaScene>("a TL with the version of the schedule", expect_transfer_ordered)});
  const auto et_of = [](std::uint8_t node, const std::string& text) {
    return send(text, [node](IsaScene& scene) {
      return Octets{scene.bench.control(scene.bench.rules().codes.et, Priority::normal), 0x22, node};
    });
  };
  using link_sources::isa_paper;
  using link_sources::own;
  return {
      on_chart(
          must_case("fieldbus_dll/isa_las/transfer/a_link_master_takes_over", "ISA-35",
                    "A TL makes a link master the scheduler.",
                    isa_paper("TL: the scheduling token goes to another link master"),
                    {{"ignores_transfer", "not_taken"},
                     {"shows_itself_late", "taken_late"},
                     {"shows_itself_as_nothing", "not_taken"},
                     {"schedule_not_begun", "schedule_not_run"}},
                    {{own("the first DLPDU within V(RR)"), {"taken_late"}},
                     {own("its schedule begins with the TL"), {"schedule_not_run"}}}),
          {{},
           {wait(300), transfer_to_station,
            expected<IsaScene>(
                "a DLPDU within V(RR), then the ET and the ES of its schedule, due after 60 and 130 octets",
                expect_taken)}},
          {.schedule = late_items(), .is_scheduler = false}),
      on_chart(
          must_case("fieldbus_dll/isa_las/transfer/what_is_due_comes_first", "ISA-35",
                    "Who was handed the link and has an item that is due, sends that.",
                    own("what comes first on a free link"), {{"sign_of_life_first", "sign_of_life_unasked"}}),
          {{},
           {wait(300), transfer_to_station,
            expected<IsaScene>("the item that is due at once",
                               [](IsaScene& scene) {
                                 const DrivenDlpdu one =
                                     expect_next(scene.bench, scene.judge, "not_taken", "the ET");
                                 scene.judge.expect(is_type(one, scene.bench.rules().codes.et),
                                                    "sign_of_life_unasked", "the ET that is due", one.text());
                               })}},
          {.schedule = at_once(), .is_scheduler = false}),
      on_chart(
          must_case("fieldbus_dll/isa_las/transfer/a_wrong_one_is_none", "ISA-35",
                    "A TL with a wrong check or for another makes a link master no scheduler.",
                    isa_paper("there is one scheduler"), {{"takes_transfer_of_others", "two_schedulers"}}),
          {{},
           {wait(300),
            drive("a TL whose last bit is wrong",
                  [](IsaScene& scene) {
                    return half_bits_of_frame(
                        with_wrong_bits(with_frame_check(tl_to(scene, scene.bench.address())), {55}));
                  }),
            no_scheduler("the check of the TL is wrong"),
            send("a TL for another", [](IsaScene& scene) { return tl_to(scene, kHeir); }),
            no_scheduler("the TL is for another")}},
          {.schedule = late_items(), .is_scheduler = false}),
      on_chart(must_case("fieldbus_dll/isa_las/transfer/in_standby_it_uses_tokens", "ISA-35",
                         "A link master that is not the scheduler uses tokens as every station.",
                         isa_paper("link masters that are not the scheduler"),
                         {{"deaf_in_standby", "token_not_used"}}),
               {{},
                {wait(300), repeat({2, 20}, {submit({Priority::normal}, 8), et(Priority::normal),
                                             answer<IsaScene>(
                                                 "a DU with the data of its user", "token_not_used",
                                                 [](const IsaScene& scene, const DrivenDlpdu& du) {
                                                   return is_type(du, scene.bench.rules().codes.du) &&
                                                          du.rest() == scene.submitted.back();
                                                 },
                                                 "token_not_used"),
                                             says("the EE", "token_not_returned")})}},
               {.schedule = late_items(), .is_scheduler = false}),
      on_chart(must_case("fieldbus_dll/isa_las/transfer/what_is_not_taken_is_retaken", "ISA-36",
                         "A scheduler whose heir says nothing takes the link back when V(RR) is over.",
                         isa_paper("there is one scheduler"),
                         {{"never_retakes", "not_retaken"},
                          {"retakes_early", "retaken_early"},
                          {"transfer_without_version", "transfer_wrong"}},
                         {{own("V(RR) supervises a TL"), {"retaken_early", "not_retaken"}}}),
               {{},
                {transferred,
                 expected<IsaScene>("the heir is silent: the schedule goes on when V(RR) is over, not before",
                                    expect_retaken)}},
               {.schedule = periodic()}),
      on_chart(must_case("fieldbus_dll/isa_las/transfer/what_is_taken_is_left", "ISA-37",
                         "A scheduler that has handed the link over is one no more.",
                         isa_paper("there is one scheduler"),
                         {{"keeps_schedule_behind_transfer", "two_schedulers"}}),
               {{},
                {transferred,
                 stimulus<IsaScene>("the heir sends a DU",
                                    [](IsaScene& scene) {
                                      scene.reply({scene.bench.control(scene.bench.rules().codes.du,
                                                                       Priority::time_available),
                                                   scene.bench.rules().everybody, kHeir},
                                                  scene.bench.least_gap());
                                    }),
                 no_scheduler("the heir has taken the link")}},
               {.schedule = periodic()}),
      on_chart(must_case("fieldbus_dll/isa_las/transfer/the_lower_address_keeps_the_link", "ISA-38",
                         "Of two schedulers the one with the lower address stays.", own("two schedulers"),
                         {{"never_yields", "two_schedulers"}, {"always_yields", "left_to_higher"}}),
               {{},
                {delegated("the token of the schedule"), returned, wait(40),
                 et_of(kHeir, "an ET from a higher address, 11"),
                 expected<IsaScene>("the schedule goes on", expect_kept), returned, wait(40),
                 et_of(kLower, "an ET from a lower address, 0F"),
                 no_scheduler("one with a lower address is the scheduler")}},
               {.schedule = periodic()}),
  };
}

}  // namespace fieldproof::conformance
