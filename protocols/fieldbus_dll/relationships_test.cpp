#include "protocols/fieldbus_dll/relationships.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "protocols/fieldbus_dll/ff_link.hpp"

namespace fieldproof::fieldbus_dll {
namespace {

constexpr std::uint8_t kClient = 0x20;
constexpr std::uint8_t kServer = 0x21;
constexpr std::uint8_t kListener = 0x22;
constexpr FfAddress kOfServer = 0x2130;
constexpr kernel::Duration kLongest = 2 * kernel::kSecond;

class Rest final : public FfSilentUser {
 public:
  void on_data(const FfDlpdu& dlpdu, kernel::Time) override { data.push_back(dlpdu.data); }
  void on_published(const FfDlpdu& dlpdu, kernel::Time) override { published.push_back(dlpdu.data); }

  std::vector<Octets> data;
  std::vector<Octets> published;
};

// A scheduler and three stations, which are live; the server answers with what it got, backwards.
struct ThreeApplications {
  explicit ThreeApplications(double loss = 0) : link({}, kernel::Random(1), disturb(loss)) {
    FfConfiguration configuration;
    configuration.node = 0x10;
    configuration.begins_as_scheduler = true;
    configuration.rules.last_node = 0x24;
    configuration.live = {kClient, kServer, kListener};
    link.add_master(configuration, nobody);
    configuration.begins_as_scheduler = false;
    for (const std::uint8_t node : {kClient, kServer, kListener}) {
      configuration.node = node;
      link.add_device(configuration, applications.at(node - kClient));
    }
    server().serve([](std::uint8_t, const Octets& request, kernel::Time) {
      return Octets(request.rbegin(), request.rend());
    });
    client().on_response([this](const Relationships::Response& one) { responses.push_back(one); });
    for (Relationships* const one : {&client(), &listener()})
      one->on_report([this](const Relationships::Report& told) { reports.push_back(told); });
    link.run_to(kernel::kStart + 20 * kernel::kSecond);
  }

  static FfDisturb disturb(double loss) {
    return loss > 0 ? losing_frames(loss, kernel::Random(7)) : FfDisturb{};
  }
  Relationships::Submit submit_at(std::uint8_t node) {
    return [this, node](const FfRequest& request) { return link.submit(node, request); };
  }
  Relationships& client() { return applications[0]; }
  Relationships& server() { return applications[1]; }
  Relationships& listener() { return applications[2]; }
  void wait(kernel::Duration duration) { link.run_to(link.now() + duration); }

  FfSilentUser nobody;
  Rest rest;
  FfLink link;
  std::array<Relationships, 3> applications{Relationships{submit_at(kClient), rest},
                                            Relationships{submit_at(kServer), rest},
                                            Relationships{submit_at(kListener), rest}};
  std::vector<Relationships::Response> responses;
  std::vector<Relationships::Report> reports;
};

TEST(RelationshipsTest, AServerAnswersItsClient) {
  ThreeApplications all;
  const kernel::Time now = all.link.now();
  ASSERT_TRUE(all.client().request(kServer, {1, 2, 3}, now));
  all.wait(kLongest);
  ASSERT_EQ(all.responses.size(), 1U);
  EXPECT_EQ(all.responses[0].server, kServer);
  EXPECT_EQ(all.responses[0].data, (Octets{3, 2, 1}));
  EXPECT_EQ(all.responses[0].asked, now);
  // Two tokens, two frames of some 5 ms: no less, and no more than a few rotations.
  EXPECT_GT(all.responses[0].came - now, 8 * kernel::kMillisecond);
  EXPECT_LT(all.responses[0].came - now, 300 * kernel::kMillisecond);
  EXPECT_TRUE(all.rest.data.empty());
}

TEST(RelationshipsTest, OneRequestWaitsForTheServersResponse) {
  ThreeApplications all;
  ASSERT_TRUE(all.client().request(kServer, {1}, all.link.now()));
  EXPECT_FALSE(all.client().request(kServer, {2}, all.link.now()));
  EXPECT_TRUE(all.client().request(kListener, {3}, all.link.now())) << "another server";
  all.wait(kLongest);
  EXPECT_TRUE(all.client().request(kServer, {4}, all.link.now()));
  // Who serves nobody does not answer.
  EXPECT_FALSE(all.client().request(kListener, {5}, all.link.now()));
  EXPECT_EQ(all.client().give_up(kLongest, all.link.now()), 1U);
  EXPECT_TRUE(all.client().request(kListener, {6}, all.link.now()));
}

TEST(RelationshipsTest, WhatWasGivenUpIsNotAnsweredAnyMore) {
  ThreeApplications all;
  ASSERT_TRUE(all.client().request(kServer, {1}, all.link.now()));
  EXPECT_EQ(all.client().give_up(kernel::Duration{}, all.link.now()), 1U);
  ASSERT_TRUE(all.client().request(kServer, {2, 3}, all.link.now()));
  all.wait(kLongest);
  ASSERT_EQ(all.responses.size(), 1U);
  EXPECT_EQ(all.responses[0].data, (Octets{3, 2}));
}

TEST(RelationshipsTest, AReportIsForEverybodyWithItsPriority) {
  ThreeApplications all;
  ASSERT_TRUE(all.server().report(Priority::urgent, {9}));
  ASSERT_TRUE(all.server().report(Priority::time_available, {8}));
  all.wait(kLongest);
  ASSERT_EQ(all.reports.size(), 4U);
  for (const Relationships::Report& one : all.reports) {
    EXPECT_EQ(one.source, kServer);
    EXPECT_EQ(one.data, one.priority == Priority::urgent ? Octets{9} : Octets{8});
  }
  EXPECT_EQ(all.listener().missed_reports(), 0U);
  EXPECT_TRUE(all.rest.data.empty());
}

// 64 octets of urgent data have room for 62 of a report.
TEST(RelationshipsTest, WhatTheStationRefusesWasNotSaid) {
  ThreeApplications all;
  EXPECT_FALSE(all.server().report(Priority::urgent, Octets(63, 1)));
  EXPECT_EQ(all.server().report(Priority::urgent, Octets(62, 1)), 1);
  EXPECT_FALSE(all.client().request(kServer, Octets(127, 1), all.link.now()));
  EXPECT_TRUE(all.client().request(kServer, Octets(126, 1), all.link.now()));
}

TEST(RelationshipsTest, WhatIsNotTheirsGoesToTheRest) {
  ThreeApplications all;
  all.link.submit(kClient, {Priority::normal, 0x2120, {7, 7}});
  all.wait(kLongest);
  EXPECT_EQ(all.rest.data, (std::vector<Octets>{{7, 7}}));
}

TEST(RelationshipsTest, WhatIsNoneIsNothing) {
  ThreeApplications all;
  for (const Octets& none :
       {Octets{}, Octets{1}, Octets{0, 1}, Octets{4, 1}, Octets{2, 1, 5}, Octets{3, 9, 5}})
    all.link.submit(kClient, {Priority::normal, kOfServer, none});
  // Neither requests nor responses are for everybody.
  for (const Octets& none : {Octets{1, 1, 5}, Octets{2, 1, 5}, Octets{}})
    all.link.submit(kClient, {Priority::normal, kEverybody, none});
  all.wait(kLongest);
  EXPECT_TRUE(all.responses.empty());
  EXPECT_TRUE(all.reports.empty());
  EXPECT_TRUE(all.rest.data.empty());
}

// More requests and reports than numbers, of which a tenth of the frames is lost at each receiver.
TEST(RelationshipsTest, WhatIsLostIsGivenUpOrMissed) {
  ThreeApplications all(0.1);
  std::size_t asked = 0;
  std::size_t given_up = 0;
  std::size_t reported = 0;
  for (int n = 0; n < 400; ++n) {
    given_up += all.client().give_up(kLongest, all.link.now());
    asked += all.client().request(kServer, {static_cast<std::uint8_t>(n)}, all.link.now()) ? 1U : 0U;
    reported += all.server().report(Priority::urgent, {1}) ? 1U : 0U;
    all.wait(kernel::kSecond);
  }
  all.wait(kLongest);
  given_up += all.client().give_up(kLongest, all.link.now());
  EXPECT_EQ(all.responses.size() + given_up, asked);
  EXPECT_GT(given_up, asked / 20);
  EXPECT_LT(given_up, asked / 2);
  EXPECT_EQ(reported, 400U);
  // Two listeners; reports are numbered, so each gap is seen but for those in front of the first and after
  // the last that came.
  const std::size_t missed = all.client().missed_reports() + all.listener().missed_reports();
  EXPECT_LE(all.reports.size() + missed, 2 * reported);
  EXPECT_GE(all.reports.size() + missed, 2 * reported - 10);
  EXPECT_GT(missed, reported / 10);
}

}  // namespace
}  // namespace fieldproof::fieldbus_dll
