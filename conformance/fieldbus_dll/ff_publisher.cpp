#include <fmt/format.h>
#include <fmt/ranges.h>

#include "conformance/fieldbus_dll/ff_cases.hpp"
#include "conformance/fieldbus_dll/ff_expect.hpp"

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

void expect_buffer(CaseJudge& judge, const DrivenDlpdu& dt3, const Octets& wanted, std::string_view reason) {
  judge.expect(buffer_in(dt3).data == wanted, reason, [&] {
    return Mismatch{{fmt::format("buffer {:02X}", fmt::join(wanted, " "))}, dt3.text(), dt3.begin};
  });
}

Octets write_some(FfBench& bench, CaseJudge& judge, std::size_t size) {
  const Octets data = bench.numbered_data(size);
  judge.expect(bench.write(FfBench::kPublished, data), "write_refused", "the buffer is written",
               "it was not");
  return data;
}

void the_latest_write_is_published(FfBench& bench, CaseJudge& judge) {
  for (int n = 0; n < bench.volume(3, 30); ++n) {
    Octets last;
    for (std::uint64_t writes = 1 + bench.random().below(3); writes > 0; --writes) {
      last = write_some(bench, judge, 16);
      bench.wait(bench.octets(static_cast<std::int64_t>(bench.random().below(20))));
    }
    expect_buffer(judge, expect_published(bench, judge), last, "buffer_wrong");
  }
}

void a_buffer_is_published_whole(FfBench& bench, CaseJudge& judge) {
  Octets before = write_some(bench, judge, 16);
  for (int n = 0; n < bench.volume(20, 300); ++n) {
    bench.send(bench.cd(FfBench::kPublished));
    // Written while the answer is formed or on the line.
    bench.wait(bench.octets(static_cast<std::int64_t>(bench.random().below(24))));
    const Octets after = write_some(bench, judge, 16);
    const DrivenDlpdu dt3 = expect_next(bench, judge, "not_published", "a DT3");
    const Octets found = buffer_in(dt3).data;
    judge.expect(found == before || found == after, "buffer_torn", [&] {
      return Mismatch{{fmt::format("the old buffer {:02X}", fmt::join(before, " ")),
                       fmt::format("the new one {:02X}", fmt::join(after, " "))},
                      dt3.text(),
                      dt3.begin};
    });
    bench.listen();
    before = after;
  }
}

void what_is_not_fresh_shows(FfBench& bench, CaseJudge& judge) {
  const auto writes_in = [](const DrivenDlpdu& dt3) { return buffer_in(dt3).writes; };
  for (int n = 0; n < bench.volume(2, 20); ++n) {
    const Octets data = write_some(bench, judge, 8);
    const DrivenDlpdu first = expect_published(bench, judge);
    const DrivenDlpdu again = expect_published(bench, judge);
    expect_buffer(judge, first, data, "buffer_wrong");
    expect_buffer(judge, again, data, "buffer_wrong");
    judge.expect(writes_in(again) == writes_in(first), "freshness_wrong",
                 [&] { return Mismatch{{"the number of writes as before"}, again.text(), again.begin}; });
    write_some(bench, judge, 8);
    const DrivenDlpdu fresh = expect_published(bench, judge);
    judge.expect(writes_in(fresh) == static_cast<std::uint8_t>(writes_in(first) + 1), "freshness_wrong",
                 [&] { return Mismatch{{"one write more"}, fresh.text(), fresh.begin}; });
  }
  const DrivenDlpdu before = expect_published(bench, judge);
  for (int n = 0; n < 256; ++n) write_some(bench, judge, 8);
  const DrivenDlpdu behind = expect_published(bench, judge);
  judge.expect(writes_in(behind) == writes_in(before), "freshness_wrong", [&] {
    return Mismatch{{"the number of writes as before: its octet went round"}, behind.text(), behind.begin};
  });
}

void an_unknown_address_is_not_published(FfBench& bench, CaseJudge& judge) {
  write_some(bench, judge, 8);
  for (const unsigned selector : {0x33U, 0x21U, 0xFFU}) {
    const fieldbus_dll::FfAddress address =
        fieldbus_dll::address_of(bench.node(), static_cast<std::uint8_t>(selector));
    bench.send(bench.cd(address));
    for (const DrivenDlpdu& one : bench.listen()) {
      const bool is_status = (one.octet(0) & ~fieldbus_dll::kFinalBit) == bench.rules().codes.sr;
      judge.expect(is_status || is_of(one, bench.rules().codes.rt), "unknown_address_published", [&] {
        return Mismatch{
            {"SR, RT or silence: there is no such buffer, or nothing in it"}, one.text(), one.begin};
      });
    }
  }
  for (const unsigned node : {0x22U, 0x20U, 0x10U}) {
    bench.send(bench.cd(fieldbus_dll::address_of(static_cast<std::uint8_t>(node), 0x20)));
    expect_silence(bench, judge, "answers_others", "the buffer is another's");
  }
  expect_published(bench, judge);
}

void what_is_subscribed_is_delivered(FfBench& bench, CaseJudge& judge) {
  const Octets data = bench.numbered_data(8);
  bench.send(bench.dt3(FfBench::kSubscribed, data));
  bench.send(bench.dt3(FfBench::kSubscribed + 1, bench.numbered_data(8)));
  bench.wait(bench.octets(20));
  const auto& published = bench.user().published;
  judge.expect(!published.empty(), "subscription_not_delivered", "the subscribed buffer is delivered",
               "nothing was");
  judge.expect(published.size() == 1 && published[0].data == data, "other_buffer_delivered",
               "the subscribed buffer alone", fmt::format("{} buffers", published.size()));
  expect_serves(bench, judge);
}

}  // namespace

std::vector<FfCase> ff_publisher_cases() {
  using link_sources::ff_paper;
  using link_sources::memory;
  using link_sources::own;
  const PartialSource returned{memory("final use, RT"), {"token_not_returned_once"}};
  return {
      {{.id = "fieldbus_dll/ff_device/publisher/the_latest_write_is_published",
        .purpose = "FF-11",
        .requirement =
            "A station that is compelled sends the buffer as it was written last, and the token returns.",
        .reference = ff_paper("CD: scheduled data"),
        .details = {returned},
        .stimulus = "One to three writes, a CD.",
        .expected = "A DT3 with the last of them, begun within V(MRD) x V(ST); the token returned once.",
        .tags = {"must", "timing"},
        .catches = {{"mute_after_activation", "not_published"},
                    {"publishes_first_write", "buffer_wrong"},
                    {"answers_late", "answers_too_late"},
                    {"published_not_final", "token_not_returned_once"}}},
       the_latest_write_is_published},
      {{.id = "fieldbus_dll/ff_device/publisher/a_buffer_is_published_whole",
        .purpose = "FF-11",
        .requirement = "A buffer that is written while it is sent is sent as it was before or as it is then.",
        .reference = memory("buffers of a publisher"),
        .stimulus = "Writes at random instants after a CD.",
        .expected = "The old buffer or the new one.",
        .tags = {"must"},
        .catches = {{"mute_after_activation", "not_published"}, {"buffer_torn", "buffer_torn"}}},
       a_buffer_is_published_whole},
      {{.id = "fieldbus_dll/ff_device/publisher/what_is_not_fresh_shows",
        .purpose = "FF-12",
        .requirement = "A buffer that was not written since is sent again, and a subscriber can see that.",
        .reference = own("the number of writes in a DT3"),
        .details = {returned},
        .stimulus = "A write, two CDs, a write, a CD; 256 writes and a CD.",
        .expected = "The same data and number of writes twice, then one more; the same number.",
        .tags = {"must"},
        .catches = {{"mute_after_activation", "not_published"},
                    {"counts_reads", "freshness_wrong"},
                    {"counts_nothing", "freshness_wrong"},
                    {"counts_to_255", "freshness_wrong"}}},
       what_is_not_fresh_shows},
      {{.id = "fieldbus_dll/ff_device/publisher/an_unknown_address_is_not_published",
        .purpose = "FF-13",
        .requirement = "A CD for what a station does not publish gets no DT3.",
        .reference = memory("CD and SR"),
        .details = {returned},
        .stimulus = "CDs for other selectors of the station and for other nodes.",
        .expected = "SR or silence; silence.",
        .tags = {"must"},
        .catches = {{"mute_after_activation", "not_published"},
                    {"publishes_anything", "unknown_address_published"},
                    {"answers_for_all_nodes", "answers_others"}}},
       an_unknown_address_is_not_published},
      {{.id = "fieldbus_dll/ff_device/publisher/what_is_subscribed_is_delivered",
        .purpose = "FF-11",
        .requirement = "What its publisher sends is reported to a subscriber, and nothing else.",
        .reference = ff_paper("scheduled data"),
        .stimulus = "DT3 of the publisher, and of another.",
        .expected = "The first is delivered.",
        .tags = {"must"},
        .catches = {{"mute_after_activation", "does_not_recover"},
                    {"subscribed_to_all", "other_buffer_delivered"},
                    {"subscribed_to_none", "subscription_not_delivered"}}},
       what_is_subscribed_is_delivered},
  };
}

}  // namespace fieldproof::conformance
