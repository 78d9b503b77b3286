#include "conformance/fieldbus_dll/isa_scene.hpp"

// A scheduler whose token does not come back as it should.
namespace fieldproof::conformance {
namespace {

using fieldbus_dll::IsaSchedule;
using fieldbus_dll::IsaType;
using fieldbus_dll::Priority;

constexpr std::uint8_t kHolder = 0x21;
constexpr std::uint8_t kOther = 0x23;
constexpr int kDuration = 100;

// A token, and a second one that is due while the first is out.
IsaSchedule two_items(IsaType first, std::uint16_t duration = 0) {
  return {.version = 1,
          .period = {},
          .items = {{20 * kOctetAt31250, first, kHolder, Priority::time_available, duration},
                    {30 * kOctetAt31250, IsaType::et, 0x22, Priority::normal, 0}}};
}

Octets du_of_holder(IsaBench& bench, std::size_t size) {
  Octets octets{bench.control(bench.rules().codes.du, Priority::normal), 0x22, kHolder};
  for (const std::uint8_t octet : bench.numbered_data(size)) octets.push_back(octet);
  return octets;
}

using Instant = kernel::Time (*)(const IsaScene&);

// It begins so long after an instant at most, and not before.
IsaStep second(const std::string& text, Instant earliest, kernel::Duration (*span)(const IsaScene&)) {
  return expected<IsaScene>(text, [=](IsaScene& scene) {
    const kernel::Time from = earliest(scene);
    const kernel::Time until = from + span(scene);
    const DrivenDlpdu one =
        expect_next(scene.bench, scene.judge, until + scene.bench.octets(1'000), "not_reclaimed",
                    "the token is reclaimed and the next item delegated");
    expect_begins(scene.judge, one, from, "reclaimed_early", until, "reclaimed_late");
  });
}

void expect_not_talked_into(IsaScene& scene) {
  IsaBench& bench = scene.bench;
  const DrivenDlpdu next = expect_next(bench, scene.judge, scene.sent + bench.observation_timeout(),
                                       "not_reclaimed", "the token is reclaimed");
  expect_begins(scene.judge, next, scene.sent, "talks_into_holder", kernel::kNever - kLinkRounding, "");
  const kernel::Time earliest = scene.sent + bench.least_gap();
  expect_begins(scene.judge, next, earliest, "gap_too_short", earliest + bench.slot(), "reclaimed_late");
}

IsaStep silent_until(const std::string& why, const std::string& reason, Instant instant) {
  return expected<IsaScene>("silence: " + why, [=](IsaScene& scene) {
    const auto next = scene.bench.next(instant(scene));
    scene.judge.expect(!next.has_value(), reason,
                       [&] { return Mismatch{{"silence: " + why}, next->text(), next->begin}; });
  });
}

}  // namespace

std::vector<IsaCase> isa_supervision_cases() {
  using namespace isa_chart;
  const auto first = [](const std::string& token) {
    return delegated("an " + token + ", the next token due 10 octet durations later");
  };
  const auto one_slot = [](const IsaScene& scene) { return scene.bench.slot(); };
  const auto silent_holder = [&](const std::string& token) {
    return Chart<IsaScene>{
        {},
        {first(token),
         second(
             "the next token within V(ST) after V(RR), not before",
             [](const IsaScene& scene) { return scene.answer.end + scene.bench.reply_wait(); }, one_slot)}};
  };
  const IsaStep holder_sends = stimulus<IsaScene>("its holder sends a DU of 6 octets", [](IsaScene& scene) {
    scene.reply(du_of_holder(scene.bench, 6));
  });
  const IsaStep returns = send("its holder's EE", [](IsaScene& scene) { return scene.bench.ee(kHolder); });
  const IsaStep after_ee = second(
      "the next token V(MID) to V(MID) and V(ST) after that EE",
      [](const IsaScene& scene) { return scene.sent + scene.bench.least_gap(); }, one_slot);
  using link_sources::isa_paper;
  using link_sources::own;
  const PartialSource times{own("V(RR) is 32 octets, VC(UC) the duration and a margin"),
                            {"reclaimed_early", "reclaimed_late"}};
  return {
      on_chart(
          must_in_time("fieldbus_dll/isa_las/supervision/who_says_nothing_loses_the_token", "ISA-31",
                       "A token whose holder says nothing is taken back when V(RR) is over.",
                       isa_paper("duration guarded on both sides"),
                       {{"reclaims_by_uc_only", "reclaimed_late"}, {"reclaims_early", "reclaimed_early"}},
                       {times}),
          silent_holder("ES for 500 octet durations, whose holder says nothing"),
          {.schedule = two_items(IsaType::es, 500)}),
      on_chart(
          must_in_time("fieldbus_dll/isa_las/supervision/a_single_frame_that_does_not_come", "ISA-31",
                       "A token for one frame whose holder says nothing is taken back when V(RR) is over.",
                       own("V(RR) supervises an ET, too"),
                       {{"single_token_for_ever", "not_reclaimed"}, {"reclaims_early", "reclaimed_early"}},
                       {times}),
          silent_holder("ET, whose holder says nothing"), {.schedule = two_items(IsaType::et)}),
      on_chart(
          must_in_time("fieldbus_dll/isa_las/supervision/who_talks_too_long_is_not_talked_into", "ISA-32",
                       "A holder that is still sending when its duration is over is not disturbed.",
                       own("VC(UC) that runs out on a busy line"),
                       {{"reclaims_into_holder", "talks_into_holder"}}),
          {{},
           {first("ES for 40 octet durations"),
            stimulus<IsaScene>("its holder sends a frame of 108 octets",
                               [](IsaScene& scene) {
                                 scene.sent = scene.bench.send_at(scene.answer.end + scene.bench.least_gap(),
                                                                  du_of_holder(scene.bench, 100));
                               }),
            expected<IsaScene>("the next token V(MID) to V(MID) and V(ST) after that frame",
                               expect_not_talked_into)}},
          {.schedule = two_items(IsaType::es, 40)}),
      on_chart(must_in_time("fieldbus_dll/isa_las/supervision/who_keeps_the_token_loses_it_with_its_duration",
                            "ISA-33", "A token that is not returned is taken back when its duration is over.",
                            isa_paper("VC(UC) at the scheduler"),
                            {{"no_supervision", "not_reclaimed"},
                             {"supervises_without_margin", "reclaimed_early"},
                             {"supervises_long", "reclaimed_late"}},
                            {times}),
               {{},
                {first("ES for 100 octet durations"), holder_sends,
                 second(
                     "the next token within an octet after VC(UC), 100 octets and V(ST), not before",
                     [](const IsaScene& scene) {
                       return scene.answer.end + scene.bench.octets(kDuration) + scene.bench.slot();
                     },
                     [](const IsaScene& scene) { return scene.bench.octets(1); })}},
               {.schedule = two_items(IsaType::es, kDuration)}),
      on_chart(
          must_case("fieldbus_dll/isa_las/supervision/the_end_of_another_is_none", "ISA-34",
                    "Only the holder can return a token.", own("EE of another"),
                    {{"end_of_anybody_taken", "end_of_other_taken"}}),
          {{},
           {first("ES for 200 octet durations"), holder_sends,
            stimulus<IsaScene>("an EE of a third station",
                               [](IsaScene& scene) {
                                 scene.bench.send_at(scene.sent + scene.bench.least_gap(),
                                                     scene.bench.ee(kOther));
                               }),
            silent_until("the holder has not returned its token", "end_of_other_taken",
                         [](const IsaScene& scene) { return scene.answer.end + scene.bench.octets(70); }),
            returns, after_ee}},
          {.schedule = two_items(IsaType::es, 200)}),
      on_chart(
          must_in_time("fieldbus_dll/isa_las/supervision/a_holder_may_wait_for_a_reply", "ISA-31",
                       "A holder of a token for one frame may compel with it, and waits for the reply before "
                       "it returns the token.",
                       own("a CD is a frame, its reply is none of the holder's"),
                       {{"forgets_reply_wait", "talks_into_token"}}),
          {{},
           {first("ET"),
            stimulus<IsaScene>("its holder compels 22, which is silent",
                               [](IsaScene& scene) {
                                 scene.reply(
                                     {scene.bench.control(scene.bench.rules().codes.cd, Priority::normal),
                                      0x22, kHolder});
                               }),
            silent_until("the holder waits for a reply, until an octet after V(RR)", "talks_into_token",
                         [](const IsaScene& scene) {
                           return scene.sent + scene.bench.reply_wait() + scene.bench.octets(1);
                         }),
            returns, after_ee}},
          {.schedule = two_items(IsaType::et)}),
  };
}

}  // namespace fieldproof::conformance
