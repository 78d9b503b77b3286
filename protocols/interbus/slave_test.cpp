#include "protocols/interbus/slave.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "harness/segment/segment.hpp"
#include "protocols/interbus/cycle_frame.hpp"
#include "protocols/interbus/terminal_block.hpp"

namespace fieldproof::interbus {
namespace {

using kernel::kMillisecond;

// What a wire carries, as the master's side sends and hears it.
struct Sent {
  std::uint8_t header;
  std::uint8_t data;
};

// The master's place, in the hands of a test.
class Hand final : public segment::Station {
 public:
  explicit Hand(const Rules& rules)
      : code_(rules.telegram), receiver_(code_, rules.bit_rate), rate_(rules.bit_rate) {}

  void send(const std::vector<Sent>& telegrams, kernel::Time when, segment::Port& out) {
    line::Waveform wave{when, rate_, {}};
    for (const Sent& t : telegrams) {
      code_.append(wave.levels, t.header, t.data);
      if ((t.header & line::kStopMissing) == 0) continue;
      wave.levels.set(wave.levels.size() - 1, false);
      wave.levels.append_idle(1);
    }
    out.drive(wave);
  }

  void receive(segment::PortIndex, const line::Waveform& wave) override {
    receiver_.receive(wave, [&](const line::Waveform& w, const line::Telegram& t) {
      heard.push_back({t.header, t.data});
      starts.push_back(w.time_of(t.level));
      if (heard.size() == 1) first_heard = starts.back();
    });
  }
  void on_time(kernel::Time) override {}
  kernel::Time next_time() const override { return kernel::kNever; }

  std::vector<Sent> heard;
  std::vector<kernel::Time> starts;
  kernel::Time first_heard{};

 private:
  line::TelegramCode code_;
  line::TelegramReceiver receiver_;
  std::int64_t rate_;
};

class SlaveTest : public ::testing::Test {
 protected:
  static SlaveConfiguration two_words() {
    SlaveConfiguration configuration;
    configuration.id_code = 0x0203;
    configuration.words = 2;
    return configuration;
  }

  void SetUp() override {
    const std::size_t master = segment.attach(hand, "master");
    const std::size_t seat = segment.attach(slave, "slave@1");
    forward = &segment.connect("slave@1/in", seat, kFromUpstream, {});
    slave.wire(
        {.upstream = &segment.connect("master/in", master, 0, {}), .branch = nullptr, .remote = nullptr},
        terminals);
  }

  // Sends at once and lets everything on the way arrive.
  void send(const std::vector<Sent>& telegrams) {
    hand.heard.clear();
    hand.send(telegrams, segment.now(), *forward);
    segment.run_for(2 * kMillisecond);
  }

  static std::vector<Sent> cycle(const std::vector<std::uint8_t>& octets, std::uint8_t transfer,
                                 std::uint8_t check) {
    const auto& frame_check = line::shared_frame_check_16("CRC-16/IBM-3740");
    const auto sum = frame_check.check_octets(frame_check.update(frame_check.start(), octets));
    std::vector<Sent> telegrams;
    for (const std::uint8_t octet : octets) telegrams.push_back({transfer, octet});
    for (const std::uint8_t octet : {sum[0], sum[1], std::uint8_t{0}, std::uint8_t{0}}) {
      telegrams.push_back({check, octet});
    }
    return telegrams;
  }
  static std::vector<Sent> data_cycle(std::uint16_t first, std::uint16_t second) {
    const auto octet = [](unsigned value) { return static_cast<std::uint8_t>(value & 0xFF); };
    return cycle({0xA5, 0x5A, octet(first >> 8), octet(first), octet(second >> 8), octet(second)},
                 kDataCycle.transfer, kDataCycle.check);
  }
  // Sends an ID cycle and tells when the silence after it is too long.
  kernel::Time limit_behind_an_id_cycle() {
    const kernel::Time begin = segment.now();
    send(id_cycle());
    return begin + kernel::levels_duration(8 * 13, 500'000) + 25 * kMillisecond;
  }

  static std::vector<Sent> id_cycle(std::uint8_t control = 0x03) {
    return cycle({0xA5, 0x5A, 0x00, control}, kIdCycle.transfer, kIdCycle.check);
  }
  std::vector<std::uint8_t> octets_heard() const {
    std::vector<std::uint8_t> octets;
    for (const Sent& t : hand.heard) octets.push_back(t.data);
    return octets;
  }

  segment::Segment segment;
  Hand hand{Rules{}};
  TerminalBlock terminals{2};
  Slave slave{two_words()};
  segment::Link* forward = nullptr;
};

TEST_F(SlaveTest, AnIdCycleReturnsTheIdCodeAndThenTheLoopbackWord) {
  send(id_cycle());
  EXPECT_EQ(octets_heard(), (std::vector<std::uint8_t>{0x02, 0x03, 0xA5, 0x5A, 0x29, 0xCC, 0x00, 0x00}));
  EXPECT_EQ(slave.mode(), Slave::Mode::active);
}

TEST_F(SlaveTest, ADataCycleExchangesInputsAndOutputs) {
  terminals.set_input(0, 0x1234);
  terminals.set_input(1, 0x5678);
  send(id_cycle());
  const kernel::Time begin = segment.now();
  send(data_cycle(0xCAFE, 0xBEEF));
  std::vector<std::uint8_t> returned = octets_heard();
  ASSERT_EQ(returned.size(), 10U);
  returned.resize(6);
  EXPECT_EQ(returned, (std::vector<std::uint8_t>{0x12, 0x34, 0x56, 0x78, 0xA5, 0x5A}));
  EXPECT_EQ(terminals.output(0), 0xCAFE);
  EXPECT_EQ(terminals.output(1), 0xBEEF);
  // Out and back cost 1.5 bit each; the outputs change with the end of the last check telegram.
  EXPECT_EQ(hand.first_heard - begin, 6 * kernel::kMicrosecond);
  EXPECT_EQ(terminals.last_write() - begin, kernel::levels_duration(130, 500'000));
}

TEST_F(SlaveTest, WithoutAnIdCycleOutputsStaySafe) {
  send(data_cycle(0xCAFE, 0xBEEF));
  EXPECT_EQ(hand.heard.size(), 10U);
  EXPECT_EQ(terminals.output(0), 0);
}

TEST_F(SlaveTest, SilenceResetsJustAfterTheLimitAndNotBefore) {
  send(id_cycle());
  const kernel::Time begin = segment.now();
  send(data_cycle(0xCAFE, 0xBEEF));
  const kernel::Time end = begin + kernel::levels_duration(130, 500'000);
  segment.run_until(end + 25 * kMillisecond - kernel::kPicosecond);
  EXPECT_EQ(terminals.output(0), 0xCAFE);
  EXPECT_EQ(slave.mode(), Slave::Mode::active);
  segment.run_until(end + 25 * kMillisecond);
  EXPECT_EQ(terminals.output(0), 0);
  EXPECT_EQ(slave.mode(), Slave::Mode::reset);
}

TEST_F(SlaveTest, ATelegramThatBeginsBeforeTheLimitEndsTheSilenceInHoweverManyParts) {
  const line::TelegramCode code{line::TelegramLayout{}};
  line::Levels telegram;
  code.append(telegram, 0, 0);
  for (const std::size_t first_part : {std::size_t{2}, telegram.size()}) {
    const kernel::Time limit = limit_behind_an_id_cycle();
    segment.run_until(limit - 4 * kernel::kMicrosecond);
    line::Waveform part{segment.now(), 500'000, telegram.slice(0, first_part)};
    forward->drive(part);
    segment.run_until(part.end());
    if (first_part < telegram.size()) {
      line::Waveform rest{part.end(), 500'000, telegram.slice(first_part, telegram.size() - first_part)};
      forward->drive(rest);
    }
    segment.run_until(limit + 20 * kMillisecond);
    EXPECT_EQ(slave.mode(), Slave::Mode::active) << first_part;
    segment.run_until(limit + 26 * kMillisecond);
    EXPECT_EQ(slave.mode(), Slave::Mode::reset) << first_part;
  }
}

// What began before the limit and then is no telegram only puts the reset off until that is known.
TEST_F(SlaveTest, AnEdgeBeforeTheLimitThatIsNoTelegramEndsNoSilence) {
  const kernel::Time limit = limit_behind_an_id_cycle();
  segment.run_until(limit - 4 * kernel::kMicrosecond);
  line::Waveform glitch{segment.now(), 16 * 500'000, {}};
  glitch.levels.append(0, 3);
  forward->drive(glitch);
  segment.run_until(limit);
  EXPECT_EQ(slave.mode(), Slave::Mode::active);
  segment.run_until(limit + 26 * kernel::kMicrosecond);
  EXPECT_EQ(slave.mode(), Slave::Mode::reset);
}

// Nor do many of them, each of which begins before it is known what the one before was.
TEST_F(SlaveTest, ATrainOfEdgesThatAreNoTelegramsEndsNoSilence) {
  const kernel::Time limit = limit_behind_an_id_cycle();
  segment.run_until(limit - 4 * kernel::kMicrosecond);
  line::Waveform glitch{segment.now(), 16 * 500'000, {}};
  glitch.levels.append(0, 3);
  for (int n = 0; n < 100; ++n) {
    glitch.start = segment.now();
    forward->drive(glitch);
    segment.run_for(20 * kernel::kMicrosecond);
  }
  EXPECT_EQ(slave.mode(), Slave::Mode::reset);
}

TEST_F(SlaveTest, NoiseBehindASilenceResetsNothingAnew) {
  send(id_cycle());
  segment.run_for(30 * kMillisecond);
  ASSERT_EQ(slave.mode(), Slave::Mode::reset);
  const std::uint64_t writes = terminals.write_count();
  line::Waveform noise{segment.now(), 500'000, {}};
  noise.levels.append_idle(6);
  noise.levels.append(0, 2);  // no telegram yet
  forward->drive(noise);
  segment.run_for(18 * kernel::kMicrosecond);
  EXPECT_EQ(terminals.write_count(), writes);
}

TEST_F(SlaveTest, AWrongBitIsMarkedNotLatchedAndToldInTheNextIdCycle) {
  send(id_cycle());
  std::vector<Sent> bad = data_cycle(0xCAFE, 0xBEEF);
  bad[3].data ^= 0x10;
  send(bad);
  ASSERT_EQ(hand.heard.size(), 10U);
  EXPECT_EQ(octets_heard()[8], 0xFF);
  EXPECT_EQ(octets_heard()[9], 0xFF);
  EXPECT_EQ(terminals.output(0), 0);
  send(id_cycle());
  EXPECT_EQ(octets_heard()[0], 0x42);
  send(id_cycle());
  EXPECT_EQ(octets_heard()[0], 0x02);
}

// An octet of the status word has left when its own stop level comes.
TEST_F(SlaveTest, AMissingStopLevelCountsFromTheNextTelegramOn) {
  constexpr std::size_t kLastOfCheck = 7;
  const std::vector<std::vector<std::uint8_t>> status{{0xFF, 0xFF}, {0x00, 0xFF}, {0x00, 0x00}};
  send(id_cycle());
  for (std::size_t n = 0; n < status.size(); ++n) {
    std::vector<Sent> bad = data_cycle(0xCAFE, 0xBEEF);
    bad[kLastOfCheck + n].header |= line::kStopMissing;
    send(bad);
    ASSERT_EQ(hand.heard.size(), 10U);
    EXPECT_EQ(octets_heard()[8], status[n][0]) << n;
    EXPECT_EQ(octets_heard()[9], status[n][1]) << n;
    EXPECT_EQ(terminals.output(0), 0) << n;
    send(id_cycle());
    EXPECT_EQ(octets_heard()[0], 0x42) << n;
  }
}

// What a cut telegram delays leaves in time again as soon as there is time between telegrams.
TEST_F(SlaveTest, IsLateNoLongerThanWhatLeftBeforeTakes) {
  const line::TelegramCode code{Rules{}.telegram};
  line::Waveform cut{segment.now(), 500'000, {}};
  cut.levels.append(code.levels_of(line::kDataTelegram, 0xFF), 4);
  forward->drive(cut);
  line::Waveform train{segment.now() + 36 * kernel::kMicrosecond, 500'000, {}};
  for (int n = 0; n < 5; ++n) {
    code.append(train.levels, line::kDataTelegram, 0x00);
    train.levels.append_idle(2);
  }
  forward->drive(train);
  segment.run_for(2 * kMillisecond);
  std::vector<std::int64_t> starts;
  for (const kernel::Time start : hand.starts)
    starts.push_back((start - kernel::kStart) / kernel::kMicrosecond);
  EXPECT_EQ(starts, (std::vector<std::int64_t>{26, 52, 78, 104, 132, 162}));
}

// A fragment whose check fits by chance: one octet and its own check, as a flipped SL bit can leave it.
TEST_F(SlaveTest, ATransferShorterThanTheRegisterIsAnError) {
  send(id_cycle());
  send(data_cycle(0xCAFE, 0xBEEF));
  send(cycle({0x83}, kDataCycle.transfer, kDataCycle.check));
  EXPECT_EQ(terminals.output(0), 0xCAFE);
  EXPECT_EQ(terminals.output(1), 0xBEEF);
  EXPECT_EQ(octets_heard().back(), 0xFF);
  send(cycle({0xA5, 0x5A, 0x00, 0x11, 0x22}, kDataCycle.transfer, kDataCycle.check));
  EXPECT_EQ(terminals.output(0), 0xCAFE);
  send(cycle({0xA5, 0x5A, 0x00, 0x11, 0x22, 0x33}, kDataCycle.transfer, kDataCycle.check));
  EXPECT_EQ(terminals.output(0), 0x0011);
}

// Every state with every event: the table is the state diagram of the README, printed by the station itself.
TEST_F(SlaveTest, EveryStateWithEveryEvent) {
  using Event = std::pair<std::string, std::vector<Sent>>;
  const std::vector<Event> to_state = {
      {"pause", {}},
      {"data_transfer", {{kDataCycle.transfer, 0xA5}}},
      {"data_check", {{kDataCycle.transfer, 0xA5}, {kDataCycle.check, 0}}},
      {"id_transfer", {{kIdCycle.transfer, 0xA5}}},
      {"id_check", {{kIdCycle.transfer, 0xA5}, {kIdCycle.check, 0}}},
  };
  const std::vector<Event> events = {
      {"status telegram", {{0, 0}}},
      {"data telegram", {{kDataCycle.transfer, 1}}},
      {"check of data", {{kDataCycle.check, 1}}},
      {"ID telegram", {{kIdCycle.transfer, 1}}},
      {"check of ID", {{kIdCycle.check, 1}}},
      {"good ID cycle", id_cycle()},
      {"good data cycle", data_cycle(1, 2)},
      {"silence", {}},
  };
  std::string table;
  for (const bool active : {false, true}) {
    for (const Event& state : to_state) {
      for (const Event& event : events) {
        segment.run_for(30 * kMillisecond);  // back to reset, pause
        if (active) send(id_cycle());
        send(state.second);
        ASSERT_EQ(name(slave.phase()), state.first);
        ASSERT_EQ(name(slave.mode()), active ? "active" : "reset");
        const std::uint64_t writes = terminals.write_count();
        send(event.second);
        if (event.first == "silence") segment.run_for(30 * kMillisecond);
        table += std::string(active ? "active " : "reset ") + state.first + " + " + event.first + " -> " +
                 std::string(name(slave.mode())) + " " + std::string(name(slave.phase()));
        if (terminals.write_count() != writes) table += ", outputs " + std::to_string(terminals.output(0));
        table += "\n";
      }
    }
  }
  EXPECT_EQ(table, R"(reset pause + status telegram -> reset pause
reset pause + data telegram -> reset data_transfer
reset pause + check of data -> reset pause
reset pause + ID telegram -> reset id_transfer
reset pause + check of ID -> reset pause
reset pause + good ID cycle -> active pause
reset pause + good data cycle -> reset pause
reset pause + silence -> reset pause
reset data_transfer + status telegram -> reset data_transfer
reset data_transfer + data telegram -> reset data_transfer
reset data_transfer + check of data -> reset data_check
reset data_transfer + ID telegram -> reset id_transfer
reset data_transfer + check of ID -> reset pause
reset data_transfer + good ID cycle -> active pause
reset data_transfer + good data cycle -> reset pause
reset data_transfer + silence -> reset pause, outputs 0
reset data_check + status telegram -> reset data_check
reset data_check + data telegram -> reset data_transfer
reset data_check + check of data -> reset data_check
reset data_check + ID telegram -> reset id_transfer
reset data_check + check of ID -> reset pause
reset data_check + good ID cycle -> active pause
reset data_check + good data cycle -> reset pause
reset data_check + silence -> reset pause, outputs 0
reset id_transfer + status telegram -> reset id_transfer
reset id_transfer + data telegram -> reset data_transfer
reset id_transfer + check of data -> reset pause
reset id_transfer + ID telegram -> reset id_transfer
reset id_transfer + check of ID -> reset id_check
reset id_transfer + good ID cycle -> reset pause
reset id_transfer + good data cycle -> reset pause
reset id_transfer + silence -> reset pause, outputs 0
reset id_check + status telegram -> reset id_check
reset id_check + data telegram -> reset data_transfer
reset id_check + check of data -> reset pause
reset id_check + ID telegram -> reset id_transfer
reset id_check + check of ID -> reset id_check
reset id_check + good ID cycle -> active pause
reset id_check + good data cycle -> reset pause
reset id_check + silence -> reset pause, outputs 0
active pause + status telegram -> active pause
active pause + data telegram -> active data_transfer
active pause + check of data -> active pause
active pause + ID telegram -> active id_transfer
active pause + check of ID -> active pause
active pause + good ID cycle -> active pause
active pause + good data cycle -> active pause, outputs 1
active pause + silence -> reset pause, outputs 0
active data_transfer + status telegram -> active data_transfer
active data_transfer + data telegram -> active data_transfer
active data_transfer + check of data -> active data_check
active data_transfer + ID telegram -> active id_transfer
active data_transfer + check of ID -> active pause
active data_transfer + good ID cycle -> active pause
active data_transfer + good data cycle -> active pause
active data_transfer + silence -> reset pause, outputs 0
active data_check + status telegram -> active data_check
active data_check + data telegram -> active data_transfer
active data_check + check of data -> active data_check
active data_check + ID telegram -> active id_transfer
active data_check + check of ID -> active pause
active data_check + good ID cycle -> active pause
active data_check + good data cycle -> active pause, outputs 1
active data_check + silence -> reset pause, outputs 0
active id_transfer + status telegram -> active id_transfer
active id_transfer + data telegram -> active data_transfer
active id_transfer + check of data -> active pause
active id_transfer + ID telegram -> active id_transfer
active id_transfer + check of ID -> active id_check
active id_transfer + good ID cycle -> active pause
active id_transfer + good data cycle -> active pause, outputs 1
active id_transfer + silence -> reset pause, outputs 0
active id_check + status telegram -> active id_check
active id_check + data telegram -> active data_transfer
active id_check + check of data -> active pause
active id_check + ID telegram -> active id_transfer
active id_check + check of ID -> active id_check
active id_check + good ID cycle -> active pause
active id_check + good data cycle -> active pause, outputs 1
active id_check + silence -> reset pause, outputs 0
)");
}

}  // namespace
}  // namespace fieldproof::interbus
