#include <fmt/format.h>
#include <fmt/ranges.h>

#include "conformance/fieldbus_dll/isa_scene.hpp"

// The IUT is compelled by a CD; and what comes of it, and of tokens, where DLPDUs have other codes.
namespace fieldproof::conformance {
namespace {

using fieldbus_dll::IsaService;
using fieldbus_dll::Priority;

IsaStep works_on_reply() {
  return stimulus<IsaScene>("the user says that it works on a reply",
                            [](IsaScene& scene) { scene.bench.user().works_on_reply = true; });
}

// Octet durations after the end of V(FD).
IsaStep until_fd(std::int64_t more) {
  return stimulus<IsaScene>(
      fmt::format("{} octet durations pass; V(FD) is 24", 24 + more), [more](IsaScene& scene) {
        scene.bench.run_until(scene.sent + scene.bench.reply_forming() + scene.bench.octets(more));
      });
}

IsaStep offer(Priority priority) {
  return stimulus<IsaScene>(
      fmt::format("the user submits {} data for a reply, 2 to 51 octets", fieldbus_dll::text_of(priority)),
      [priority](IsaScene& scene) {
        scene.submitted.push_back(expect_submitted(scene.bench, scene.judge, IsaService::reply_data, priority,
                                                   2 + scene.bench.random().below(50)));
        scene.bench.user().works_on_reply = false;
      });
}

// With the DLSDU of this number, 0 for none.
IsaStep replied(std::size_t number, std::string reason_for_other_data) {
  return expected<IsaScene>(
      fmt::format("a final DT to 22 with {}, begun between V(MID) and V(FD)",
                  number == 0 ? "no data" : fmt::format("DLSDU {}", number)),
      [number, reason = std::move(reason_for_other_data)](IsaScene& scene) {
        const Octets data = number == 0 ? Octets{} : scene.submitted.at(number - 1);
        const DrivenDlpdu dt = expect_next(scene.bench, scene.judge, "no_reply", "a DT");
        expect_begins(scene.judge, dt, scene.sent + scene.bench.least_gap(), "answers_too_early",
                      scene.sent + scene.bench.reply_forming(), "reply_too_late");
        const auto require_that = [&](bool holds, std::string_view why, const std::string& what) {
          scene.judge.expect(holds, why, [&] { return Mismatch{{what}, dt.text(), dt.begin}; });
        };
        require_that(is_type(dt, scene.bench.rules().codes.dt) && dt.octet(1) == IsaBench::kPeer,
                     "dlpdu_wrong", "DT to the station that compelled");
        require_that(is_final(dt), "not_final", "F = 1: the reply token is returned");
        require_that(dt.rest() == data, reason, fmt::format("DLSDU [{:02X}]", fmt::join(data, " ")));
      });
}

// Of one priority, and then a CD of another, by the turn.
Priority of_turn(unsigned turn) {
  return static_cast<Priority>(1 + turn % 3);
}

void compel_beside_what_is_worked_out(IsaScene& scene) {
  scene.bench.user().works_on_reply = true;
  scene.bench.user().works_on = of_turn(scene.turn);
  scene.sent = scene.bench.send(scene.bench.cd(of_turn(scene.turn / 3)));
}

void expect_reply_unless_worked_out(IsaScene& scene) {
  if (of_turn(scene.turn) == of_turn(scene.turn / 3))
    return expect_silence(scene.bench, scene.judge, "does_not_wait", "data of this priority are worked out");
  const DrivenDlpdu dt = expect_next(scene.bench, scene.judge, "no_reply", "an empty DT");
  scene.judge.expect(dt.rest().empty(), "data_wrong",
                     [&] { return Mismatch{{"an empty DT"}, dt.text(), dt.begin}; });
  scene.bench.wait(scene.bench.octets(32));
}

void with_other_isa_codes(fieldbus_dll::IsaConfiguration& configuration) {
  configuration.rules.codes = {
      .cd = 0xC0, .dt = 0x10, .du = 0x20, .et = 0x80, .es = 0x40, .ee = 0xE0, .tl = 0x35};
}

}  // namespace

std::vector<IsaCase> isa_compelled_cases() {
  using namespace isa_chart;
  using enum Priority;
  const LinkStep over = wait(32);
  using link_sources::isa_paper;
  using link_sources::own;
  const PartialSource forming{own("V(FD) is 24 octets, from the end of the CD"), {"reply_too_late"}};
  return {
      on_chart(
          must_in_time("fieldbus_dll/isa_dle/compelled/data_is_sent", "ISA-22",
                       "A station that is compelled sends its data in one DT and returns the reply token.",
                       isa_paper("reply token"),
                       {{"short_silence", "answers_too_early"},
                        {"reply_not_final", "not_final"},
                        {"reply_to_scheduler", "dlpdu_wrong"},
                        {"replies_twice", "talks_behind_reply"}},
                       {forming}),
          {{3, 30},
           {offer(normal), cd(normal), replied(1, "data_wrong"),
            silence("talks_behind_reply", "one DT is sent")}}),
      on_chart(
          must_in_time("fieldbus_dll/isa_dle/compelled/what_comes_behind_fd_is_kept", "ISA-23",
                       "A station whose reply is not there within V(FD) is silent.",
                       isa_paper("VC(FD): the time to form a reply"),
                       {{"replies_late", "reply_too_late"}, {"late_reply_lost", "late_data_lost"}},
                       {forming, {own("what was too late answers the next CD"), {"late_data_lost"}}}),
          {{2, 10},
           {works_on_reply(), cd(normal), until_fd(2), offer(normal),
            silence("reply_too_late", "V(FD) is over"), cd(normal), replied(1, "late_data_lost"), over}}),
      on_chart(must_in_time("fieldbus_dll/isa_dle/compelled/what_comes_within_fd_is_sent", "ISA-23",
                            "A reply that is there within V(FD) is sent.",
                            isa_paper("VC(FD): the time to form a reply"),
                            {{"does_not_wait_for_user", "data_wrong"}}, {forming}),
               {{2, 10},
                {works_on_reply(), cd(normal), until_fd(-2), offer(normal), replied(1, "data_wrong"), over}}),
      on_chart(must_case("fieldbus_dll/isa_dle/compelled/no_data_is_an_empty_reply", "ISA-24",
                         "A station that is compelled and has nothing to send sends an empty DT.",
                         own("a CD without data"), {{"no_data_no_reply", "no_reply"}}, {forming}),
               {{2, 10},
                {cd(urgent), replied(0, "data_wrong"), over, cd(normal), replied(0, "data_wrong"), over,
                 cd(time_available), replied(0, "data_wrong"), over}}),
      on_chart(must_case("fieldbus_dll/isa_dle/compelled/lower_priorities_are_kept", "ISA-25",
                         "A reply has at least the priority of the CD.", own("priority of a CD"),
                         {{"reply_ignores_priority", "lower_priority_sent"}}, {forming}),
               {{},
                {offer(normal), cd(urgent), replied(0, "lower_priority_sent"), over, offer(urgent),
                 cd(normal), replied(2, "data_wrong"), over, cd(normal), replied(1, "data_wrong"), over}}),
      on_chart(must_case("fieldbus_dll/isa_dle/compelled/its_priority_is_what_is_waited_for", "ISA-23",
                         "A station waits for data of the priority of the CD.",
                         own("what is worked out is asked of item 16 + the priority of the CD"),
                         {{"waits_for_urgent_data", "does_not_wait"}, {"waits_for_any_data", "no_reply"}},
                         {forming}),
               {{},
                {repeat({9, 9}, {IsaStep{"the user works on data of a priority alone; a CD of each priority, "
                                         "each with each in turn",
                                         "silence where they are the same, else an empty DT",
                                         [](IsaScene& scene) {
                                           compel_beside_what_is_worked_out(scene);
                                           expect_reply_unless_worked_out(scene);
                                         }}}),
                 serves()}}),
      on_chart(
          must_case("fieldbus_dll/isa_dle/compelled/less_urgent_data_within_fd_are_kept", "ISA-25",
                    "A reply has at least the priority of the CD, also within V(FD).",
                    own("priority of a CD"), {{"anything_ends_the_wait", "lower_priority_sent"}}, {forming}),
          {{2, 6},
           {works_on_reply(), cd(urgent), until_fd(-8), offer(time_available),
            silence("lower_priority_sent", "what came is less urgent than the CD"), works_on_reply(),
            cd(normal), until_fd(-8), offer(urgent), replied(2, "data_wrong"), over, cd(time_available),
            replied(1, "data_wrong"), over}}),
      on_chart(must_case("fieldbus_dll/isa_dle/settings/other_codes_are_used", "ISA-22",
                         "The first octets of DLPDUs are those of the link.",
                         own("codes are settings, because their standard was not at hand"),
                         {{"codes_of_the_usual_link", "no_reply"}}, {forming}),
               {{},
                {offer(normal), cd(normal), replied(1, "data_wrong"), over, submit({normal}, 8), et(normal),
                 used({2}, {"no_data_frame", "sent_twice"}), submit({normal, normal}, 8), es(normal, 500),
                 used({3, 4}, {"no_data_frame", "sent_twice"}),
                 end_reason(fieldbus_dll::EndReason::nothing_to_send)}},
               {.change = with_other_isa_codes}),
  };
}

}  // namespace fieldproof::conformance
