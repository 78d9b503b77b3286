#include <fmt/format.h>

#include "conformance/fieldbus_dll/ff_scene.hpp"

// What ends a token or the wait for an answer, and what does not; what a station does for long.
namespace fieldproof::conformance {
namespace {

using fieldbus_dll::Priority;

// What another sends, or the scheduler to another.
struct HeardDlpdu {
  std::string name;
  Octets octets;
  bool is_of_scheduler = false;
  bool has_fixed_length = true;
};

std::vector<HeardDlpdu> all_dlpdus(const FfBench& bench) {
  constexpr std::uint8_t kOther = FfBench::kPeer;
  const auto& codes = bench.rules().codes;
  const auto with = [&](std::uint8_t code, unsigned bits) { return static_cast<std::uint8_t>(code | bits); };
  return {{"CD", bench.cd(FfBench::kPeersAddress), true},
          {"PT", {with(codes.pt, 1), kOther, 0x01, 0x18}, true},
          {"PN", {codes.pn, kOther}, true},
          {"TD", {codes.td, 0, 0, 0, 0, 0x7D, 0}, true},
          {"CL", {codes.cl, kOther}, true},
          {"TL", {codes.tl, kOther, 0, 1}, true},
          {"DT1", bench.dt1(Priority::normal, FfBench::kPeersAddress, 0x2330, {0x41}), false, false},
          {"DT3", bench.dt3(FfBench::kPeersAddress, {0x41}), false, false},
          {"SR", {with(codes.sr, fieldbus_dll::kFinalBit), 0}},
          {"RT", {codes.rt}},
          {"RI", {codes.ri, 0, 100}},
          {"PR", {codes.pr, kOther}},
          {"CT", {codes.ct, kOther}},
          {"IDLE", {codes.idle}}};
}

// Before the station may begin; what the tester sent last is over then.
void say_before_it_begins(FfScene& scene, const Octets& octets) {
  const kernel::Time begin = scene.sent + scene.bench.least_gap() / 2;
  scene.sent = scene.bench.send_at(begin, octets);
  scene.bench.run_until(scene.sent);
}

void expect_token_after(FfScene& scene, const Octets& octets, const std::string& name, bool ends) {
  scene.submitted = {scene.bench.numbered_data(4)};
  scene.submit(Priority::normal, scene.submitted[0]);
  scene.sent = scene.bench.send(scene.bench.pt(Priority::normal, 3'000));
  say_before_it_begins(scene, octets);
  if (ends) {
    expect_silence(scene.bench, scene.judge, "token_not_ended", name + " ends a token");
    scene.sent = scene.bench.send(scene.bench.pt(Priority::normal, 3'000));
  }
  scene.expect_used(scene.submitted, {"frames_missing", "sent_twice"});
}

void expect_answer_after(FfScene& scene, const Octets& octets, const std::string& name, bool ends) {
  scene.sent = scene.bench.send(scene.bench.cd(FfBench::kPublished));
  const kernel::Time until = scene.sent + scene.bench.response_delay();
  say_before_it_begins(scene, octets);
  if (ends) return expect_silence(scene.bench, scene.judge, "answer_not_ended", name + " ends the wait");
  const DrivenDlpdu one =
      expect_next(scene.bench, scene.judge, "gives_up_early", "a DT3: " + name + " is none");
  expect_begins(scene.judge, one, scene.sent + scene.bench.least_gap(), "answers_too_early", until,
                "answers_too_late");
}

void expect_dlpdus_end(FfScene& scene) {
  for (const HeardDlpdu& one : all_dlpdus(scene.bench)) {
    expect_token_after(scene, one.octets, one.name, one.is_of_scheduler);
    expect_answer_after(scene, one.octets, one.name, true);
  }
}

void expect_other_lengths_end_nothing(FfScene& scene) {
  for (const HeardDlpdu& one : all_dlpdus(scene.bench)) {
    if (!one.has_fixed_length) continue;
    Octets longer = one.octets;
    longer.push_back(0);
    std::vector<Octets> others{longer};
    if (one.octets.size() > 1) others.emplace_back(one.octets.begin(), one.octets.end() - 1);
    for (const Octets& other : others) {
      const std::string name = fmt::format("{} of {} octets", one.name, other.size());
      expect_token_after(scene, other, name, false);
      expect_answer_after(scene, other, name, false);
    }
  }
}

// So that an answer could wait for the end of each of them.
void with_long_wait(fieldbus_dll::FfConfiguration& configuration) {
  configuration.rules.link.response_delay_slots = 11;
}

// A token that ends a quarter of a bit before what the station has could, or with it: others keep the line
// busy until then.
struct LastRoom {
  bool has_data;
  bool is_too_short;
};

void use_last_room(FfScene& scene, const LastRoom& room) {
  constexpr unsigned kDuration = 100;
  constexpr std::size_t kDt1Octets = 13;  // with 8 of data
  FfBench& bench = scene.bench;
  scene.sent = bench.send(bench.pt(Priority::normal, kDuration));
  const kernel::Time over = scene.sent + bench.octets(kDuration);
  const kernel::Time begin = over - bench.frame(room.has_data ? kDt1Octets : 1);
  const kernel::Duration shift = room.is_too_short ? bench.octets(1) / 32 : -scene.latency;
  keep_busy(bench, begin + shift - bench.least_gap(),
            scene.turn % 2 == 0 ? DlpduIsNone::by_its_check : DlpduIsNone::by_its_first_octet);
  if (room.is_too_short && !room.has_data)
    return expect_silence(bench, scene.judge, "talks_behind_duration", "not even RT fits");
  const DrivenDlpdu one = expect_next(bench, scene.judge, "token_not_returned", "DT1 or RT");
  const bool is_data = room.has_data && !room.is_too_short;
  scene.judge.expect(is_data ? dlsdu_of(one) == scene.submitted[0] : is_of(one, bench.rules().codes.rt),
                     room.is_too_short ? "sends_what_does_not_fit" : "exact_fit_not_sent",
                     [&] { return Mismatch{{is_data ? "the DT1" : "RT"}, one.text(), one.begin}; });
  scene.judge.expect(one.end <= over + kLinkRounding, "talks_behind_duration", [&] {
    return Mismatch{{"it ends within the duration"}, kernel::describe(one.end - over), one.begin};
  });
}

void expect_last_room_used(FfScene& scene) {
  scene.submitted = {scene.bench.numbered_data(8)};
  scene.submit(Priority::normal, scene.submitted[0]);
  for (const LastRoom& room :
       {LastRoom{true, true}, LastRoom{true, false}, LastRoom{false, true}, LastRoom{false, false}})
    use_last_room(scene, room);
}

// What it refuses need not be sent.
void submit_many(FfScene& scene) {
  for (int n = 0; n < 300; ++n) {
    const Octets data = scene.bench.numbered_data(2);
    if (scene.submit(scene.priority(), data)) scene.submitted.push_back(data);
  }
}

FfCase endings_case(const std::string& id, const std::string& requirement, std::vector<MustCatch> catches,
                    const FfStep& step, FfNeeds needs) {
  return on_chart(
      must_case("fieldbus_dll/ff_device/endings/" + id, "FF-47", requirement,
                link_sources::own("what ends a token or the wait for an answer"), std::move(catches)),
      {{}, {ff_chart::write(4), step, ff_chart::serves()}}, std::move(needs));
}

}  // namespace

std::vector<FfCase> ff_endings_cases() {
  using namespace ff_chart;
  using enum Priority;
  const FfStep each{
      "each DLPDU that there is, of others or to another, before the station may begin to use a "
      "token, and before it may begin to answer a CD",
      "those of a scheduler end the token, all of them the wait", expect_dlpdus_end};
  using link_sources::own;
  return {
      endings_case("each_dlpdu_ends_what_it_ends",
                   "A DLPDU of a scheduler ends a token, each DLPDU the wait for an answer.",
                   {{"claims_end_nothing", "token_not_ended"},
                    {"returns_end_tokens", "token_not_returned"},
                    {"idle_ends_nothing", "answer_not_ended"}},
                   each, {.change = with_long_wait}),
      endings_case("each_dlpdu_is_known_by_the_code_of_its_link",
                   "DLPDUs are known by the codes of the link, also those that are not answered.",
                   {{"time_by_the_usual_code", "token_not_ended"}}, each, {.change = with_other_codes}),
      endings_case(
          "other_lengths_end_nothing", "What has another length than its DLPDU is none, and ends nothing.",
          {{"tail_ignored", "token_not_returned"}},
          FfStep{"each DLPDU of fixed length with an octet more and with one less, in the same places",
                 "the token is used, the CD answered", expect_other_lengths_end_nothing},
          {.change = with_long_wait}),
      on_chart(
          must_in_time("fieldbus_dll/ff_device/token/its_end_is_kept_to_a_quarter_of_a_bit", "FF-49",
                       "What ends within the duration of a token is sent, and nothing that ends later.",
                       own("the duration begins with the end of the PT and holds whole frames"),
                       {{"fit_is_strict", "exact_fit_not_sent"},
                        {"half_a_bit_into_what_follows", "sends_what_does_not_fit"},
                        {"returns_whatever_is_left", "talks_behind_duration"}}),
          {{},
           {pt(normal, 500), used({}, {"", "unexpected_dlpdu"}),
            stimulus<FfScene>("the time until it begins is measured",
                              [](FfScene& scene) {
                                scene.latency = scene.answer.begin - scene.sent - scene.bench.least_gap();
                              }),
            repeat({2, 20},
                   {FfStep{"a DLSDU of 8 octets; PTs, while others keep the line busy until its DT1 ends a "
                           "quarter of a bit after the duration, then with it; the same for a RT",
                           "RT, the DT1; silence, RT", expect_last_room_used}})}}),
      on_chart(
          must_case("fieldbus_dll/ff_device/token/all_of_many_is_sent", "FF-48",
                    "What a station has taken from its user is sent, however much it is.",
                    own("what is submitted is sent or refused"), {{"queue_of_128", "frames_missing"}}),
          {{3, 3},
           {stimulus<FfScene>("the user submits 300 DLSDUs of a priority, each in its turn", submit_many),
            pt(time_available, 65'535),
            expected<FfScene>("all that was accepted, in order",
                              [](FfScene& scene) {
                                scene.expect_used(scene.submitted, {"frames_missing", "sent_twice"});
                              })}}),
      on_chart(must_case("fieldbus_dll/ff_device/frame/all_of_many_are_taken", "FF-48",
                         "A station takes DLPDUs for ever.", own("nothing that comes is the last"),
                         {{"takes_256", "token_not_returned"}}),
               {{},
                {repeat({300, 300},
                        {send("a DT1 to the station",
                              [](FfScene& scene) {
                                return scene.bench.dt1(normal,
                                                       fieldbus_dll::address_of(scene.bench.node(), 0x30),
                                                       FfBench::kPeersAddress, scene.fresh(4));
                              }),
                         wait(8), delivered("not_delivered"), pn(), probe_response("no_probe_response"),
                         pt(normal, 500), used({}, {"", "unexpected_dlpdu"})}),
                 serves()}}),
      on_chart(
          must_case("fieldbus_dll/ff_device/probe/a_long_silence_changes_nothing", "FF-48",
                    "A station that hears nothing for long is what it was.",
                    own("silence is no event for a device"), {{"forgets_in_silence", "no_probe_response"}}),
          {{},
           {wait(45'000), pn(), probe_response("no_probe_response"), wait(45'000), pt(normal, 500),
            used({}, {"", "unexpected_dlpdu"}), serves()}}),
  };
}

}  // namespace fieldproof::conformance
