#include "protocols/fieldbus_dll/ff_link.hpp"

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace fieldproof::fieldbus_dll {
namespace {

class Reader final : public FfSilentUser {
 public:
  void on_data(const FfDlpdu& dlpdu, kernel::Time) override { data.push_back(dlpdu.data); }
  void on_published(const FfDlpdu& dlpdu, kernel::Time) override { published.push_back(dlpdu.data); }

  std::vector<Octets> data;
  std::vector<Octets> published;
};

FfConfiguration scheduler() {
  FfConfiguration configuration;
  configuration.node = 0x10;
  configuration.begins_as_scheduler = true;
  configuration.schedule = {
      .version = 1, .macrocycle = 8'000, .items = {{1'000, address_of(0x20, 0x20), Priority::normal}}};
  return configuration;
}

FfConfiguration publisher() {
  FfConfiguration configuration;
  configuration.node = 0x20;
  configuration.published = {address_of(0x20, 0x20)};
  return configuration;
}

FfConfiguration subscriber() {
  FfConfiguration configuration;
  configuration.node = 0x21;
  configuration.subscribed = {address_of(0x20, 0x20)};
  return configuration;
}

struct SmallLink {
  explicit SmallLink(FfDisturb disturb = {}) : link({}, kernel::Random(1), std::move(disturb)) {
    link.on_driven([this](const FfDriven& one) { ++driven[std::string(describe(one.dlpdu).substr(0, 3))]; });
    link.add_master(scheduler(), nobody);
    link.add_device(publisher(), nobody);
    link.add_device(subscriber(), reader);
  }
  FfSilentUser nobody;
  Reader reader;
  FfLink link;
  std::map<std::string, int> driven;
};

TEST(FfLinkTest, CarriesWhatIsPublishedAndWhatIsSubmitted) {
  SmallLink small;
  EXPECT_TRUE(small.link.write(0x20, address_of(0x20, 0x20), {1, 2, 3}));
  EXPECT_TRUE(small.link.submit(0x20, {Priority::urgent, address_of(0x21, 0x30), {4}}));
  small.link.run_to(kernel::kStart + 3 * kernel::kSecond);
  ASSERT_FALSE(small.reader.published.empty());
  EXPECT_EQ(small.reader.published.front(), (Octets{1, 2, 3}));
  EXPECT_EQ(small.reader.data, (std::vector<Octets>{{4}}));
  // One in each macrocycle of 250 ms since the publisher is live.
  EXPECT_GE(small.driven["DT3"], 11);
  EXPECT_LE(small.driven["DT3"], 12);
}

TEST(FfLinkTest, OfADeadStationNothingIsOnTheLine) {
  SmallLink small;
  small.link.write(0x20, address_of(0x20, 0x20), {1});
  small.link.run_to(kernel::kStart + 2 * kernel::kSecond);
  small.link.kill(0x20);
  const std::size_t before = small.reader.published.size();
  small.link.run_to(kernel::kStart + 4 * kernel::kSecond);
  EXPECT_EQ(small.reader.published.size(), before);
}

TEST(FfLinkTest, LosesTheShareOfFramesThatIsSaid) {
  SmallLink small(losing_frames(0.2, kernel::Random(2)));
  small.link.write(0x20, address_of(0x20, 0x20), {1});
  small.link.run_to(kernel::kStart + 500 * kernel::kSecond);
  // Both the CD and the DT3 must come through. 2000 macrocycles: five standard errors are 0.054.
  EXPECT_NEAR(static_cast<double>(small.reader.published.size()) / 2'000, 0.64, 0.06);
}

}  // namespace
}  // namespace fieldproof::fieldbus_dll
