#include "conformance/interbus/slave_in_parts.hpp"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "conformance/interbus/slave_line.hpp"

namespace fieldproof::conformance {
namespace {

struct Given {
  segment::PortIndex port;
  std::int64_t level;  // of its start, from the start of time
  std::size_t levels;

  friend bool operator==(const Given&, const Given&) = default;
};

// Writes down what it is given.
class WritingSlave final : public interbus::SlaveDevice {
 public:
  explicit WritingSlave(std::vector<Given>& given) : given_(given) {}

  void wire(const interbus::SlavePorts&, interbus::Terminals&) override {}
  void set_next_present(bool, bool) override {}
  void set_power(bool, kernel::Time) override {}
  void receive(segment::PortIndex port, const line::Waveform& wave) override {
    given_.push_back(
        {port, kernel::levels_within(wave.start - kernel::kStart, wave.rate), wave.levels.size()});
  }
  void on_time(kernel::Time) override {}
  kernel::Time next_time() const override { return kernel::kNever; }

 private:
  std::vector<Given>& given_;
};

class SlaveInPartsTest : public ::testing::Test {
 protected:
  SlaveInParts made(ReturnParts returns) {
    return SlaveInParts(std::make_unique<WritingSlave>(given_), rules_, returns);
  }
  line::Waveform wave_at(std::int64_t level) const {
    return {kernel::level_time(kernel::kStart, level, rules_.bit_rate), rules_.bit_rate, train_.levels()};
  }
  static void run(SlaveInParts& slave) {
    while (slave.next_time() != kernel::kNever) slave.on_time(slave.next_time());
  }
  void add_cycle(bool is_id_cycle) {
    const std::vector<std::uint8_t> octets{0xA5, 0x5A, 0x00, 0x03};
    train_.cycle(is_id_cycle, octets, 0x1234, 0);
  }

  interbus::Rules rules_;
  TrainWriter train_{rules_};
  std::vector<Given> given_;
};

// A cycle of eight telegrams and their gaps takes 120 levels here.
TEST_F(SlaveInPartsTest, WhatFollowsAnIdCycleIsGivenWhenItBegins) {
  SlaveInParts slave = made(ReturnParts::whole);
  for (const bool is_id_cycle : {false, true, true, false, false}) add_cycle(is_id_cycle);
  slave.receive(interbus::kFromUpstream, wave_at(0));
  EXPECT_EQ(given_, (std::vector<Given>{{interbus::kFromUpstream, 0, 240}}));
  EXPECT_EQ(slave.next_time(), kernel::level_time(kernel::kStart, 240, rules_.bit_rate));
  run(slave);
  EXPECT_EQ(given_, (std::vector<Given>{{interbus::kFromUpstream, 0, 240},
                                        {interbus::kFromUpstream, 240, 120},
                                        {interbus::kFromUpstream, 360, 240}}));
}

TEST_F(SlaveInPartsTest, AStatusTelegramAfterAnIdCycleGoesTheNewWayBeforeTheNextTransferDoes) {
  SlaveInParts slave = made(ReturnParts::whole);
  add_cycle(true);
  train_.status(2);
  add_cycle(false);
  slave.receive(interbus::kFromUpstream, wave_at(0));
  run(slave);
  ASSERT_EQ(given_.size(), 3U);
  EXPECT_EQ(given_[1].level, 120);
  EXPECT_EQ(given_[2].level, 120 + static_cast<std::int64_t>(given_[1].levels));
  EXPECT_EQ(given_[2].levels, 120U);
}

TEST_F(SlaveInPartsTest, WhatComesBackIsGivenWholeOrTelegramByTelegram) {
  add_cycle(true);
  add_cycle(false);
  SlaveInParts whole = made(ReturnParts::whole);
  whole.receive(interbus::kFromRemote, wave_at(0));
  run(whole);
  EXPECT_EQ(given_, (std::vector<Given>{{interbus::kFromRemote, 0, 240}}));
  given_.clear();
  SlaveInParts each = made(ReturnParts::telegrams);
  each.receive(interbus::kFromRemote, wave_at(0));
  run(each);
  ASSERT_EQ(given_.size(), 16U);
  EXPECT_EQ(given_[15].level, 15 * 15);
}

TEST_F(SlaveInPartsTest, ATransmissionWithinAnotherOneEndsIt) {
  SlaveInParts slave = made(ReturnParts::whole);
  add_cycle(true);
  add_cycle(true);
  slave.receive(interbus::kFromUpstream, wave_at(0));
  slave.receive(interbus::kFromUpstream, wave_at(60));
  run(slave);
  EXPECT_EQ(given_, (std::vector<Given>{{interbus::kFromUpstream, 0, 120},
                                        {interbus::kFromUpstream, 60, 120},
                                        {interbus::kFromUpstream, 180, 120}}));
}

TEST_F(SlaveInPartsTest, WithoutSupplyNothingIsLeftToGive) {
  SlaveInParts slave = made(ReturnParts::whole);
  add_cycle(true);
  add_cycle(true);
  slave.receive(interbus::kFromUpstream, wave_at(0));
  slave.set_power(false, kernel::kStart);
  run(slave);
  EXPECT_EQ(given_.size(), 1U);
}

}  // namespace
}  // namespace fieldproof::conformance
