#include "protocols/valve_bus/host.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "harness/segment/medium.hpp"
#include "harness/segment/segment.hpp"

namespace fieldproof::valve_bus {
namespace {

using kernel::kMicrosecond;
using kernel::kMillisecond;
using Octets = std::vector<std::uint8_t>;

// A host alone on a line with nodes that say what the test wants.
class HostTest : public testing::Test, private segment::Station, private HostApplication {
 protected:
  explicit HostTest(HostConfiguration configuration = {}) : configuration_(std::move(configuration)) {
    host_ = std::make_unique<Host>(configuration_);
    nodes_seat_ = segment_.attach(*this, "nodes");
    host_seat_ = segment_.attach(*host_, "host");
    nodes_ = &line_.attach("nodes/in", nodes_seat_, 0, {});
    host_->wire(line_.attach("host/in", host_seat_, 0, {}, configuration_.receives_own_echo), *this);
    host_->set_power(true, now());
    segment_.refresh(host_seat_);
    wait(kMillisecond);
  }

  kernel::Time now() const { return segment_.now(); }
  void wait(kernel::Duration duration) { segment_.run_for(duration); }
  void write(const Octets& octets) {
    host_->write(octets, now());
    segment_.refresh(host_seat_);
  }
  // Until the host has said a frame, at most 200 ms; its octets.
  Octets request() {
    octets_.clear();
    for (int n = 0; n < 20'000 && octets_.size() < kCommandOctets; ++n) wait(10 * kMicrosecond);
    return octets_;
  }
  // The octets, so long after the last stop bit of the request.
  void answer(const Octets& octets, kernel::Duration turnaround_time = 400 * kMicrosecond) {
    codec_.drive(*nodes_, octets, heard_until_ + turnaround_time, {});
  }
  std::string told() { return std::exchange(told_, {}); }

  HostConfiguration configuration_;
  segment::Segment segment_;
  segment::Medium line_{segment_, "line", segment::ContentionRule::noise, kernel::Random(1)};
  CharacterCodec codec_{configuration_.rules};
  std::unique_ptr<Host> host_;
  segment::MediumPort* nodes_ = nullptr;
  std::size_t nodes_seat_ = 0;
  std::size_t host_seat_ = 0;
  Octets octets_;                   // that the host drove
  kernel::Time first_start_bit_{};  // of them
  kernel::Time heard_until_{};

 private:
  void receive(segment::PortIndex, const line::Waveform& wave) override {
    codec_.decode(wave, [&](const line::UartCharacter& character) {
      if (octets_.empty()) first_start_bit_ = character.start;
      octets_.push_back(character.octet());
      heard_until_ = character.busy_until;
    });
  }
  void on_time(kernel::Time) override {}
  kernel::Time next_time() const override { return kernel::kNever; }
  void on_response(const HostResponse& response, kernel::Time) override {
    told_ += fmt(response.id) + " " + fmt(response.data0) + " " + fmt(response.data1) +
             (response.is_old ? " old\n" : "\n");
  }
  void on_error(const HostError& error, kernel::Time) override {
    told_ += fmt(error.id) + ": " + std::string(describe(error.kind)) + "\n";
  }
  static std::string fmt(unsigned octet) {
    constexpr std::string_view kDigits = "0123456789ABCDEF";
    return {kDigits[octet / 16], kDigits[octet % 16]};
  }

  std::string told_;
};

TEST_F(HostTest, SendsAWriteWithItsCheck) {
  write({5, 0, 0xA5, 0x3C});
  EXPECT_EQ(request(), (Octets{0x05, 0x00, 0xA5, 0x3C, 0x9C}));
  EXPECT_EQ(told(), "");
}

TEST_F(HostTest, TellsTheResponseToARead) {
  write({0x63, 1, 0, 0});
  EXPECT_EQ(request(), (Octets{0x63, 0x01, 0x00, 0x00, 0x62}));
  answer({0xF0, 0x0F, 0xFF});
  wait(5 * kMillisecond);
  EXPECT_EQ(told(), "63 F0 0F\n");
  EXPECT_EQ(host_->counters(0x63), HostCounters{});
}

TEST_F(HostTest, PollsThreeTimesAndTellsWhatItKnewAsOld) {
  write({7, 1, 0, 0, 7, 1, 0, 0});
  request();
  answer({0x12, 0x34, 0x26});
  EXPECT_EQ(request().size(), kCommandOctets);
  const kernel::Time silent_since = heard_until_;
  EXPECT_EQ(request().size(), kCommandOctets);
  const kernel::Duration waited = first_start_bit_ - silent_since;
  EXPECT_GE(waited, response_time_out({}));
  EXPECT_LE(waited, response_time_out({}) + character_notice({}) + bits({}, 2));
  EXPECT_EQ(request().size(), kCommandOctets);
  EXPECT_EQ(request().size(), 0U);
  EXPECT_EQ(told(), "07 12 34\n07: no response\n07 12 34 old\n");
  EXPECT_EQ(host_->counters(7), (HostCounters{.timeouts = 3, .rejected = 0, .late = 0, .retries = 2}));
}

TEST_F(HostTest, PollsAgainBehindAResponseThatIsWrong) {
  write({7, 1, 0, 0});
  request();
  answer({0x12, 0x34, 0x27});
  request();
  answer({0x12, 0x34});
  request();
  answer({0x12, 0x34, 0x26});
  wait(5 * kMillisecond);
  EXPECT_EQ(told(), "07 12 34\n");
  EXPECT_EQ(host_->counters(7), (HostCounters{.timeouts = 0, .rejected = 2, .late = 0, .retries = 2}));
}

TEST_F(HostTest, WaitsOutTheWindowOfAWrongResponse) {
  write({7, 1, 0, 0});
  request();
  const kernel::Time end = heard_until_;
  answer({0xFF});
  request();
  EXPECT_GE(first_start_bit_ - end, response_time_out({}));
}

TEST_F(HostTest, TakesAResponseUntilTheTimeOut) {
  write({7, 1, 0, 0, 7, 1, 0, 0, 8, 1, 0, 0});
  request();
  answer({1, 2, 3}, response_time_out({}) - kMicrosecond);
  request();
  EXPECT_EQ(told(), "07 01 02\n");
  request();
  request();
  answer({1, 2, 3}, response_time_out({}) + 100 * kMicrosecond);
  octets_.clear();
  request();
  EXPECT_EQ(octets_.front(), 8);
  EXPECT_EQ(told(), "07: no response\n07 01 02 old\n");
  EXPECT_EQ(host_->counters(7).late, 1U);
  answer({4, 5, 1});
  wait(5 * kMillisecond);
  EXPECT_EQ(told(), "08 04 05\n");
}

TEST_F(HostTest, RefusesWhatIsNoCommand) {
  write({0, 1, 0, 0, 100, 0, 0, 0, 5, 2, 0, 0, 99, 0, 1, 2});
  EXPECT_EQ(request(), (Octets{99, 0, 1, 2, 99 ^ 1 ^ 2}));
  EXPECT_EQ(told(), "00: refused ID\n64: refused ID\n05: refused command\n");
}

TEST_F(HostTest, RefreshesTheLastWriteOfEachNode) {
  write({5, 0, 1, 0, 6, 0, 2, 0, 5, 0, 3, 0});
  for (int n = 0; n < 3; ++n) request();
  const kernel::Time last = first_start_bit_;
  EXPECT_EQ(request(), (Octets{6, 0, 2, 0, 4}));
  EXPECT_EQ(request(), (Octets{5, 0, 3, 0, 6}));
  EXPECT_LE(std::chrono::abs(first_start_bit_ - last - 50 * kMillisecond), 10 * kMicrosecond);
}

TEST_F(HostTest, LeavesTheLineAloneBehindAWrite) {
  write({5, 0, 1, 0, 6, 0, 2, 0});
  request();
  const kernel::Time end = heard_until_;
  answer({1, 1, 0});
  request();
  EXPECT_GE(first_start_bit_ - end, delimiter({}) + kMillisecond);
  EXPECT_LE(first_start_bit_ - end, delimiter({}) + kMillisecond + bits({}, 2));
  EXPECT_EQ(told(), "");
}

TEST_F(HostTest, GivesUpACommandOfWhichTheRestDoesNotCome) {
  write({5, 1, 0});
  wait(101 * kMillisecond);
  EXPECT_EQ(told(), "05: part of a command\n");
  write({6, 0, 1, 1});
  EXPECT_EQ(request(), (Octets{6, 0, 1, 1, 6}));
}

TEST_F(HostTest, TellsWhatItsFifoDidNotTake) {
  for (int n = 0; n < 128; ++n) write({5, 0, 1, 1});
  write({9, 0, 1, 1});
  EXPECT_TRUE(host_->has_overflowed());
  EXPECT_EQ(told(), "09: FIFO overflow\n");
}

TEST_F(HostTest, ReadsItsSwitchesAtPowerUp) {
  host_->set_dip(1);
  write({5, 0, 1, 1});
  EXPECT_EQ(request(), (Octets{5, 0, 1, 1, 5}));
  host_->set_power(false, now());
  host_->set_power(true, now());
  segment_.refresh(host_seat_);
  codec_ = CharacterCodec(Rules{.bit_rate = dip_bit_rates()[1]});
  write({5, 0, 2, 2});
  EXPECT_EQ(request(), (Octets{5, 0, 2, 2, 5}));
}

TEST_F(HostTest, TellsItsPcThatTheLineDoesNotFallSilent) {
  write({5, 1, 0, 0});
  request();
  const Octets babble(600, 0);
  codec_.drive(*nodes_, babble, now() + 50 * kMicrosecond, {});
  wait(20 * kMillisecond);
  EXPECT_EQ(told(), "05: line busy\n");
  EXPECT_EQ(host_->state(), HostState::idle);
}

class HostThatHearsItself : public HostTest {
 protected:
  HostThatHearsItself() : HostTest({.rules = {}, .receives_own_echo = true}) {}
};

TEST_F(HostThatHearsItself, TakesItsEchoForNoResponse) {
  write({5, 1, 4, 0});
  request();
  answer({0x11, 0x22, 0x33});
  wait(5 * kMillisecond);
  EXPECT_EQ(told(), "05 11 22\n");
}

class HostThatVerifies : public HostTest {
 protected:
  HostThatVerifies() : HostTest({.rules = {}, .verifies_writes = true}) {}
};

TEST_F(HostThatVerifies, ReadsWhatItHasWritten) {
  write({5, 0, 0x11, 0x22});
  request();
  EXPECT_EQ(request()[1], 1);
  answer({0x11, 0x22, 0x33});
  wait(5 * kMillisecond);
  EXPECT_EQ(told(), "");
  write({5, 0, 0x11, 0x22});
  request();
  request();
  answer({0x11, 0x23, 0x32});
  wait(5 * kMillisecond);
  EXPECT_EQ(told(), "05: readback mismatch\n");
}

class HostWithAcknowledge : public HostTest {
 protected:
  HostWithAcknowledge() : HostTest(acknowledged()) {}
  static HostConfiguration acknowledged() {
    HostConfiguration configuration;
    configuration.rules.answers_writes = true;
    return configuration;
  }
};

TEST_F(HostWithAcknowledge, WritesAgainUntilItIsAcknowledged) {
  write({5, 0, 1, 2});
  request();
  answer({1, 3, 2});
  request();
  answer({1, 2, 3});
  wait(5 * kMillisecond);
  EXPECT_EQ(told(), "");
  EXPECT_EQ(host_->counters(5), (HostCounters{.timeouts = 0, .rejected = 1, .late = 0, .retries = 1}));
  write({5, 0, 1, 2});
  for (int n = 0; n < 3; ++n) request();
  wait(5 * kMillisecond);
  EXPECT_EQ(told(), "05: not acknowledged\n");
}

// Each state in which an event can meet the host, and what becomes of it.
TEST_F(HostTest, HasAStateForEachEvent) {
  std::string states;
  const auto tell = [&](std::string_view event) {
    constexpr std::array<std::string_view, 4> kNames{"off", "idle", "awaiting", "resting"};
    states +=
        std::string(event) + " -> " + std::string(kNames[static_cast<std::size_t>(host_->state())]) + "\n";
  };
  const kernel::Duration frame_end = delimiter({}) + character_notice({}) + kMicrosecond;
  tell("power up");
  write({5, 0, 1, 1});
  request();
  tell("write");
  answer({1});
  wait(600 * kMicrosecond);
  tell("octet after a write");
  wait(kMillisecond);
  tell("distance over");
  write({6, 1, 0, 0});
  request();
  tell("read");
  answer({1, 2, 3}, 200 * kMicrosecond);
  wait(200 * kMicrosecond + 3 * character_time({}));
  tell("three octets");
  wait(frame_end);
  tell("silence after a response");
  write({6, 1, 0, 0});
  request();
  answer({1, 2, 4}, 200 * kMicrosecond);
  wait(200 * kMicrosecond + 3 * character_time({}) + frame_end);
  tell("silence after a wrong response");
  wait(3 * kMillisecond);
  tell("time-out of the first attempt");
  request();
  wait(response_time_out({}) + character_notice({}) + kMicrosecond);
  tell("time-out of the last attempt");
  wait(kMillisecond);
  tell("time for a late response over");
  host_->set_power(false, now());
  tell("power off");
  EXPECT_EQ(states,
            "power up -> idle\n"
            "write -> resting\n"
            "octet after a write -> resting\n"
            "distance over -> idle\n"
            "read -> awaiting\n"
            "three octets -> awaiting\n"
            "silence after a response -> idle\n"
            "silence after a wrong response -> awaiting\n"
            "time-out of the first attempt -> awaiting\n"
            "time-out of the last attempt -> resting\n"
            "time for a late response over -> idle\n"
            "power off -> off\n");
  EXPECT_EQ(host_->next_time(), kernel::kNever);
}

}  // namespace
}  // namespace fieldproof::valve_bus
