#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <span>

#include "conformance/fieldbus_dll/ff_scene.hpp"

// CD: the buffer of a publisher.
namespace fieldproof::conformance {
namespace {

// The DT3 to a CD for the first buffer of the station.
DrivenDlpdu expect_published(FfBench& bench, CaseJudge& judge) {
  const kernel::Time end = bench.send(bench.cd(FfBench::kPublished));
  const std::vector<DrivenDlpdu> all = bench.listen();
  judge.expect(!all.empty() && is_dt3(bench, all.front()), "not_published", [&] {
    return Mismatch{{"a DT3"}, all.empty() ? std::string("silence") : all.front().text()};
  });
  const DrivenDlpdu& dt3 = all.front();
  expect_begins(judge, dt3, end + bench.least_gap(), "answers_too_early", end + bench.response_delay(),
                "answers_too_late");
  judge.expect(buffer_in(dt3).from == FfBench::kPublished, "dlpdu_wrong",
               [&] { return Mismatch{{"the address of the buffer as the source"}, dt3.text(), dt3.begin}; });
  const bool is_returned_by_rt = all.size() == 2 && is_of(all[1], bench.rules().codes.rt);
  judge.expect(all.size() == 1 || is_returned_by_rt, "unexpected_dlpdu", [&] {
    return Mismatch{{"the DT3, and a RT where it has no F"}, all[1].text(), all[1].begin};
  });
  judge.expect(has_final_use(dt3) != is_returned_by_rt, "token_not_returned_once",
               [&] { return Mismatch{{"the token returned by F or by RT, once"}, dt3.text(), dt3.begin}; });
  return dt3;
}

// One of these is in the DT3.
void expect_buffer(FfScene& scene, const std::vector<Octets>& right, std::string_view reason) {
  const auto is_in = [&](const Octets& one) { return buffer_in(scene.answer).data == one; };
  scene.judge.expect(std::ranges::any_of(right, is_in), reason, [&] {
    std::vector<std::string> texts;
    for (const Octets& one : right) texts.push_back(fmt::format("buffer {:02X}", fmt::join(one, " ")));
    return Mismatch{texts, scene.answer.text(), scene.answer.begin};
  });
}

FfStep published() {
  return {"a CD for its buffer",
          "a DT3 begun between V(MID) and V(MRD) x V(ST), the token returned once, by F or by RT",
          [](FfScene& scene) {
            scene.before = scene.answer;
            scene.answer = expect_published(scene.bench, scene.judge);
          }};
}

// The octet that counts them goes round.
FfStep writes_are(unsigned more) {
  const std::string text = more == 0 ? "the number of writes in it as before" : "one write more in it";
  return expected<FfScene>(text, [text, more](FfScene& scene) {
    const auto right = static_cast<std::uint8_t>(buffer_in(scene.before).writes + more);
    const unsigned writes = buffer_in(scene.answer).writes;
    scene.judge.expect(writes == right, "freshness_wrong", [&] {
      return Mismatch{{fmt::format("{}: {}", text, right)}, fmt::format("{}", writes), scene.answer.begin};
    });
  });
}

template <std::uint64_t octets>
void wait_up_to(FfScene& scene) {
  scene.bench.wait(scene.bench.octets(static_cast<std::int64_t>(scene.bench.random().below(octets))));
}

// Written while the answer is formed or on the line.
void expect_whole(FfScene& scene) {
  scene.answer = expect_next(scene.bench, scene.judge, "not_published", "a DT3");
  const std::span older = std::span(scene.written).first(scene.written.size() - 2);
  scene.judge.expect(
      !is_dt3(scene.bench, scene.answer) || std::ranges::count(older, buffer_in(scene.answer).data) == 0,
      "write_lost", "the buffer as it was written before the CD, or after it",
      "what was written earlier: a write has been lost");
  expect_buffer(scene, {scene.written.end()[-2], scene.written.back()}, "buffer_torn");
  scene.bench.listen();
}

void expect_no_buffer(FfScene& scene) {
  for (const DrivenDlpdu& one : scene.bench.listen()) {
    const auto& codes = scene.bench.rules().codes;
    const bool is_status = (one.octet(0) & ~fieldbus_dll::kFinalBit) == codes.sr;
    scene.judge.expect(is_status || is_of(one, codes.rt), "unknown_address_published", [&] {
      return Mismatch{
          {"SR, RT or silence: there is no such buffer, or nothing in it"}, one.text(), one.begin};
    });
  }
}

}  // namespace

std::vector<FfCase> ff_publisher_cases() {
  using namespace ff_chart;
  const FfStep latest = expected<FfScene>("the buffer as it was written last", [](FfScene& scene) {
    expect_buffer(scene, {scene.written.back()}, "buffer_wrong");
  });
  using link_sources::ff_paper;
  using link_sources::memory;
  using link_sources::own;
  const PartialSource returned{memory("final use, RT"), {"token_not_returned_once"}};
  return {
      on_chart(
          must_in_time(
              "fieldbus_dll/ff_device/publisher/the_latest_write_is_published", "FF-11",
              "A station that is compelled sends the buffer as it was written last, and the token returns.",
              ff_paper("CD: scheduled data"),
              {{"mute_after_activation", "not_published"},
               {"publishes_first_write", "buffer_wrong"},
               {"answers_late", "answers_too_late"},
               {"published_not_final", "token_not_returned_once"}},
              {returned}),
          {{3, 30},
           {repeat({1, 3}, {write(16), stimulus<FfScene>("up to 19 octet durations pass", wait_up_to<20>)}),
            published(), latest}}),
      on_chart(
          must_case("fieldbus_dll/ff_device/publisher/a_buffer_is_published_whole", "FF-11",
                    "A buffer that is written while it is sent is sent as it was before or as it is then.",
                    memory("buffers of a publisher"),
                    {{"mute_after_activation", "not_published"},
                     {"buffer_torn", "buffer_torn"},
                     {"each_second_write_lost", "write_lost"}}),
          {{},
           {write(16),
            repeat({20, 300},
                   {cd(), stimulus<FfScene>("up to 23 octet durations pass", wait_up_to<24>), write(16),
                    expected<FfScene>("a DT3 with the buffer as it was before, or as it is then",
                                      expect_whole)})}}),
      on_chart(must_case("fieldbus_dll/ff_device/publisher/what_is_not_fresh_shows", "FF-12",
                         "A buffer that was not written since is sent again, and a subscriber can see that.",
                         own("the number of writes in a DT3"),
                         {{"mute_after_activation", "not_published"},
                          {"counts_reads", "freshness_wrong"},
                          {"counts_nothing", "freshness_wrong"},
                          {"counts_to_255", "freshness_wrong"}},
                         {returned}),
               {{2, 20},
                {write(8), published(), latest, published(), latest, writes_are(0), write(8), published(),
                 writes_are(1), repeat({256, 256}, {write(8)}), published(), writes_are(0)}}),
      on_chart(
          must_case("fieldbus_dll/ff_device/publisher/an_unknown_address_is_not_published", "FF-13",
                    "A CD for what a station does not publish gets no DT3.", memory("CD and SR"),
                    {{"mute_after_activation", "not_published"},
                     {"publishes_anything", "unknown_address_published"},
                     {"answers_for_all_nodes", "answers_others"}},
                    {returned}),
          {{},
           {write(8),
            repeat({3, 3}, {send("a CD for the selectors 33, 21 and FF of the station, in turn",
                                 [](FfScene& scene) {
                                   constexpr std::array<std::uint8_t, 3> kSelectors{0x33, 0x21, 0xFF};
                                   return scene.bench.cd(
                                       fieldbus_dll::address_of(scene.bench.node(), kSelectors[scene.turn]));
                                 }),
                            expected<FfScene>("SR, RT or silence: there is no such buffer, or nothing in it",
                                              expect_no_buffer)}),
            repeat({3, 3}, {send("a CD for the nodes 22, 20 and 10, in turn",
                                 [](FfScene& scene) {
                                   constexpr std::array<std::uint8_t, 3> kOthers{0x22, 0x20, 0x10};
                                   return scene.bench.cd(fieldbus_dll::address_of(kOthers[scene.turn], 0x20));
                                 }),
                            silence("answers_others", "the buffer is another's")}),
            published()}}),
      on_chart(must_case("fieldbus_dll/ff_device/publisher/what_is_subscribed_is_delivered", "FF-11",
                         "What its publisher sends is reported to a subscriber, and nothing else.",
                         ff_paper("scheduled data"),
                         {{"mute_after_activation", "does_not_recover"},
                          {"subscribed_to_all", "other_buffer_delivered"},
                          {"subscribed_to_none", "subscription_not_delivered"}}),
               {{},
                {send("a DT3 of the publisher",
                      [](FfScene& scene) { return scene.bench.dt3(FfBench::kSubscribed, scene.fresh(8)); }),
                 send("a DT3 of another",
                      [](FfScene& scene) {
                        return scene.bench.dt3(FfBench::kSubscribed + 1, scene.bench.numbered_data(8));
                      }),
                 wait(20),
                 require(
                     "the subscribed buffer is delivered",
                     [](FfScene& scene) { return !scene.bench.user().published.empty(); },
                     "subscription_not_delivered"),
                 require(
                     "no other buffer is",
                     [](FfScene& scene) {
                       const auto& all = scene.bench.user().published;
                       return all.size() == 1 && all[0].data == scene.data;
                     },
                     "other_buffer_delivered"),
                 serves()}}),
  };
}

}  // namespace fieldproof::conformance
