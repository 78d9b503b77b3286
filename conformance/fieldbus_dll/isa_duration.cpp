#include <fmt/format.h>

#include <array>

#include "conformance/fieldbus_dll/isa_scene.hpp"

// The duration of an ES: what fits, to the octet.
namespace fieldproof::conformance {
namespace {

using fieldbus_dll::EndReason;
using fieldbus_dll::Priority;

constexpr std::size_t kHeader = 3;
constexpr std::size_t kEndOctets = 4;

// In octet durations, a begun one counted.
unsigned in_octets(const IsaBench& bench, kernel::Duration duration) {
  const kernel::Duration one = bench.octets(1);
  return static_cast<unsigned>((duration + one - kLinkRounding) / one);
}

// The least duration into which a DU with `size` octets fits: it, V(MID), and the EE.
unsigned exact_fit(const IsaBench& bench, kernel::Duration latency, std::size_t size) {
  return in_octets(bench,
                   latency + bench.frame(kHeader + size) + bench.least_gap() + bench.frame(kEndOctets));
}

void send_es(IsaScene& scene, unsigned duration) {
  scene.sent = scene.bench.send(scene.bench.es(Priority::time_available, duration));
}

void expect_isa_exact_fit(IsaScene& scene) {
  IsaBench& bench = scene.bench;
  const Octets& data = scene.submitted.back();
  const unsigned duration = exact_fit(bench, scene.latency, data.size());
  send_es(scene, duration);
  const TokenUse use = expect_token_use(bench, scene.judge, scene.sent);
  const kernel::Time over = scene.sent + bench.octets(duration);
  // It may begin a little later than it did before, so that nothing fits.
  const kernel::Duration needed =
      bench.frame(kHeader + data.size()) + bench.least_gap() + bench.frame(kEndOctets);
  if (use.data.empty() && use.end.begin + needed > over + kLinkRounding) {
    send_es(scene, 2 * duration);
    scene.expect_used({data}, {"frames_missing", "sent_twice"});
    return;
  }
  expect_dlsdus(scene.judge, use.data, dlsdu_in, {data}, {"exact_fit_not_sent", "sent_twice"});
  scene.judge.expect(use.end.end <= over + kLinkRounding, "talks_behind_duration", [&] {
    return Mismatch{{fmt::format("the EE ends until {}", kernel::describe(over))},
                    kernel::describe(use.end.end),
                    use.end.begin};
  });
}

// In whole octet durations: a station that begins sooner than these does not.
unsigned too_short(const IsaScene& scene) {
  const kernel::Duration latency = scene.bench.octets(scene.latency / scene.bench.octets(1));
  return exact_fit(scene.bench, latency, scene.submitted.back().size()) - 1;
}

void expect_no_fit(IsaScene& scene) {
  send_es(scene, too_short(scene));
  scene.expect_used({}, {"", "sends_what_does_not_fit"});
  expect_end_reason(scene.judge, scene.use, EndReason::no_time);
}

void expect_fit_then(IsaScene& scene) {
  send_es(scene, too_short(scene) + 100);
  scene.expect_used({scene.submitted.back()}, {"queued_data_lost", "sent_twice"});
}

void expect_none_after_es(IsaScene& scene) {
  constexpr std::array kDurations{10U, 20U, 50U, 100U, 500U, 5'000U};
  const unsigned duration = kDurations[scene.round];
  send_es(scene, duration);
  const kernel::Duration left = scene.expect_none_after("ES", duration);
  scene.judge.measure(fmt::format("left of {} octets", duration), "octets",
                      static_cast<double>(left / scene.bench.octets(1)));
}

}  // namespace

std::vector<IsaCase> isa_duration_cases() {
  using namespace isa_chart;
  const IsaStep latency =
      repeat({}, {submit({Priority::normal}, 8), es(Priority::time_available, 500),
                  used({1}, {"frames_missing", "sent_twice"}),
                  stimulus<IsaScene>("the time until it begins is measured", [](IsaScene& scene) {
                    scene.latency = scene.answer.begin - scene.sent;
                    scene.judge.measure("start latency", "octets",
                                        static_cast<double>(scene.latency / scene.bench.octets(1)));
                  })});
  const LinkStep none = silence("acts_on_no_duration", "an ES for 0 octets is none");
  using link_sources::isa_paper;
  using link_sources::own;
  return {
      on_chart(must_in_time("fieldbus_dll/isa_dle/duration/an_exact_fit_is_sent", "ISA-08",
                            "A frame is sent under an ES when it, V(MID) and the EE end within its duration.",
                            isa_paper("duration guarded on both sides"),
                            {{"fit_is_strict", "exact_fit_not_sent"},
                             {"duration_from_begin_of_es", "exact_fit_not_sent"}},
                            {{own("what the duration must hold"), {"exact_fit_not_sent"}}}),
               {{},
                {latency,
                 repeat({3, 30}, {submit({Priority::normal}, 2, 121),
                                  IsaStep{"an ES for exactly what a DU with it needs, V(MID) and the EE",
                                          "the DU and the EE, which ends in time", expect_isa_exact_fit}})}}),
      on_chart(
          must_in_time("fieldbus_dll/isa_dle/duration/what_does_not_fit_stays", "ISA-09",
                       "A frame that does not fit stays queued, and the token is returned.",
                       own("what the duration must hold"),
                       {{"fit_without_end", "token_not_returned"},
                        {"fits_always", "sends_what_does_not_fit"},
                        {"queue_lost_without_time", "queued_data_lost"}}),
          {{},
           {latency,
            repeat({3, 30}, {submit({Priority::normal}, 2, 121),
                             IsaStep{"an ES for an octet less than a DU with it, V(MID) and the EE need",
                                     "no data, and the EE with reason 1", expect_no_fit},
                             IsaStep{"an ES for 100 octets more", "the DU under it", expect_fit_then}})}}),
      on_chart(must_in_time("fieldbus_dll/isa_dle/duration/nothing_is_sent_behind_it", "ISA-12",
                            "A station sends nothing after the duration of its token, the EE included.",
                            isa_paper("VC(RD) at the holder"),
                            {{"end_behind_duration", "talks_behind_duration"},
                             {"duration_little_endian", "talks_behind_duration"},
                             {"duration_ignored", "talks_behind_duration"}}),
               {{6, 6},
                {submit(std::vector(25, Priority::time_available), 2, 251),
                 IsaStep{"an ES for 10, 20, 50, 100, 500, 5000 octet durations, in turn",
                         "the last frame ends within the duration, the EE included", expect_none_after_es},
                 repeat({3, 3},
                        {es(Priority::time_available, 8'000), says("data, and EE", "token_not_returned")})}}),
      on_chart(must_case("fieldbus_dll/isa_dle/duration/zero_is_no_token", "ISA-13",
                         "An ES for no duration is ignored.", own("0 is no duration"),
                         {{"zero_is_for_ever", "acts_on_no_duration"}}),
               {{},
                {submit({Priority::urgent}, 4), es(Priority::urgent, 0), none, es(Priority::normal, 0), none,
                 es(Priority::time_available, 0), none, es(Priority::normal, 200),
                 used({1}, {"does_not_recover", "sent_twice"})}}),
  };
}

}  // namespace fieldproof::conformance
