#include "conformance/interbus/ring_emulator.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "conformance/interbus/master_bench.hpp"
#include "conformance/interbus/master_mutants.hpp"
#include "harness/line/frame_check_16.hpp"

namespace fieldproof::interbus {
namespace {

// Drives a frame as a master would and keeps what comes back.
class Line : public segment::Port {
 public:
  explicit Line(std::vector<VirtualStation> stations)
      : ring(Rules{}, std::move(stations)), code_(Rules{}.telegram) {
    ring.wire(*this);
  }

  // The octets that come back of a cycle with this transfer phase.
  std::vector<std::uint8_t> cycle(std::vector<std::uint8_t> octets, bool is_id = false) {
    return mixed_cycle(std::move(octets), [is_id](std::size_t) { return is_id; });
  }
  // The same with SL telegram by telegram.
  std::vector<std::uint8_t> mixed_cycle(std::vector<std::uint8_t> octets,
                                        const std::function<bool(std::size_t)>& is_selected) {
    const std::size_t transfer = octets.size();
    const std::uint16_t check = line::shared_frame_check_16("CRC-16/IBM-3740").compute(octets);
    octets.insert(octets.end(),
                  {static_cast<std::uint8_t>(check >> 8), static_cast<std::uint8_t>(check), 0, 0});
    line::Waveform wave;
    wave.start = now_;
    wave.rate = 500'000;
    for (std::size_t n = 0; n < octets.size(); ++n) {
      const unsigned header =
          line::kDataTelegram | (is_selected(n) ? line::kSelect : 0U) | (n >= transfer ? line::kControl : 0U);
      code_.append(wave.levels, static_cast<std::uint8_t>(header), octets[n]);
      wave.levels.append_idle(2);
    }
    for (unsigned n = 0; n < status_telegrams; ++n) {
      code_.append(wave.levels, 0, 0);
      wave.levels.append_idle(1);
    }
    now_ += kernel::kMillisecond;
    returned.clear();
    send(wave);
    return returned;
  }

  unsigned status_telegrams = 0;  // after the cycle

  // How the master divides what it sends: levels to a bit, and bits to a waveform, which drift apart.
  unsigned fineness = 1;
  std::size_t bits_to_a_part = 100'000;
  kernel::Duration drift{};

  void send(const line::Waveform& wave) {
    kernel::Duration late{};
    for (std::size_t at = 0; at < wave.levels.size(); at += bits_to_a_part, late += drift) {
      const std::size_t count = std::min(bits_to_a_part, wave.levels.size() - at);
      line::Waveform part{wave.time_of(at) + late, wave.rate * fineness, {}};
      for (std::size_t n = at; n < at + count; ++n) part.levels.append_fill(wave.levels[n], fineness);
      ring.receive(0, part);
    }
    if (ring.next_time() != kernel::kNever) ring.on_time(ring.next_time());
  }

  void drive(line::Waveform& wave) override {
    is_overdriven = is_overdriven || wave.start + kernel::kMicrosecond < driven_until_;
    start = wave.start;
    driven_until_ = wave.end();
    code_.decode(wave.levels, 0, [this](const line::Telegram& t) {
      if (t.is_data()) returned.push_back(t.data);
    });
    wave.levels.clear();
  }

  RingEmulator ring;
  kernel::Time start{};
  std::vector<std::uint8_t> returned;
  bool is_overdriven = false;  // before what was driven is over

 private:
  line::TelegramCode code_;
  kernel::Time now_ = kernel::kStart;
  kernel::Time driven_until_ = kernel::kStart;
};

using Octets = std::vector<std::uint8_t>;

TEST(RingEmulator, answers_the_same_however_the_master_divides_its_telegrams) {
  const Octets octets{0xA5, 0x5A, 0x12, 0x34, 0x56, 0x78};
  const auto answer = [&](unsigned fineness, std::size_t bits, kernel::Duration drift) {
    Line line({{0x0203, 2, -1, false}});
    line.fineness = fineness;
    line.bits_to_a_part = bits;
    line.drift = drift;
    return line.cycle(octets);
  };
  const Octets expected = answer(1, 100'000, {});
  ASSERT_EQ(expected.size(), octets.size() + 4);
  EXPECT_EQ(answer(20, 100'000, {}), expected);
  for (const std::size_t bits : {15U, 7U, 31U, 100U}) {
    EXPECT_EQ(answer(1, bits, {}), expected) << bits;
    EXPECT_EQ(answer(16, bits, {}), expected) << bits;
    EXPECT_EQ(answer(1, bits, 30 * kernel::kNanosecond), expected) << bits;
  }
}

TEST(RingEmulator, stands_telegrams_that_run_over_each_other) {
  Line line({{0x0203, 2, -1, false}});
  line.bits_to_a_part = 40;
  line.drift = -7 * kernel::kMicrosecond;
  for (int n = 0; n < 50; ++n) {
    line.drift -= 333 * kernel::kNanosecond;
    line.cycle({0xA5, 0x5A, 0x12, 0x34, 0x56, 0x78});
  }
  line.bits_to_a_part = 100'000;
  EXPECT_EQ(line.cycle({0xA5, 0x5A, 0x12, 0x34, 0x56, 0x78}).size(), 10U);
}

TEST(RingEmulator, computes_the_published_check_value) {
  const Octets digits{'1', '2', '3', '4', '5', '6', '7', '8', '9'};
  EXPECT_EQ(RingEmulator(Rules{}, line_of(1, 0x0103, 1)).check_of(digits), 0x29B1);
}

TEST(RingEmulator, counts_telegrams_that_do_not_belong_to_their_cycle) {
  Line line(line_of(1, 0x0103, 1));
  const Octets octets{0xA5, 0x5A, 0x00, 0x03};
  line.cycle(octets, true);
  line.cycle(octets, false);
  EXPECT_EQ(line.ring.statistics().wrong_phases, 0U);
  line.mixed_cycle(octets, [](std::size_t n) { return n < 2; });  // SL changes within the transfer
  EXPECT_EQ(line.ring.statistics().wrong_phases, 1U);
  EXPECT_FALSE(line.ring.cycle(2).in_phase);
  line.mixed_cycle(octets, [](std::size_t n) { return n < 6; });  // and within the check
  EXPECT_EQ(line.ring.statistics().wrong_phases, 3U);
}

TEST(RingEmulator, a_word_that_a_cycle_does_not_have_is_none) {
  SeenCycle seen;
  EXPECT_EQ(seen.word(0), std::nullopt);
  seen.octets = {0xA5};
  EXPECT_EQ(seen.word(0), std::nullopt);
  EXPECT_EQ(seen.describe_word(0), "the cycle ends after 1 telegrams");
  seen.octets = {0xA5, 0x5A};
  EXPECT_EQ(seen.word(0), 0xA55A);
  EXPECT_EQ(seen.describe_word(0), "A55Ah");
  EXPECT_EQ(seen.word(1), std::nullopt);
}

TEST(RingEmulator, one_station_closes_the_ring_until_its_interface_is_switched_on) {
  Line line(line_of(2, 0x0103, 1));
  Octets seen = line.cycle({0xA5, 0x5A, 0x00, 0x03}, true);
  ASSERT_EQ(seen.size(), 8U);
  EXPECT_EQ(Octets(seen.begin(), seen.begin() + 4), (Octets{0x01, 0x03, 0xA5, 0x5A}));
  EXPECT_EQ(line.start, kernel::kStart + 6 * kernel::kMicrosecond);
  EXPECT_EQ(line.ring.closed_stations(), 1U);
  line.cycle({0xA5, 0x5A, 0x00, 0x02}, true);
  EXPECT_EQ(line.ring.closed_stations(), 2U);
  line.ring.set_input(0, 0x1111);
  line.ring.set_input(1, 0x2222);
  seen = line.cycle({0xA5, 0x5A, 0xBB, 0xBB, 0xAA, 0xAA});
  // The last station's input comes first, the last station's output was sent first.
  EXPECT_EQ(Octets(seen.begin(), seen.begin() + 6), (Octets{0x22, 0x22, 0x11, 0x11, 0xA5, 0x5A}));
  EXPECT_EQ(line.ring.output(0), 0xAAAA);
  EXPECT_EQ(line.ring.output(1), 0xBBBB);
  EXPECT_EQ(line.ring.check_of({seen.data(), 6}), seen[6] << 8 | seen[7]);
}

TEST(RingEmulator, shifts_by_single_bits_and_keeps_the_check) {
  for (const int bits : {1, 2, 8, -1, -2, -8}) {
    Line line(line_of(1, 0x0103, 1));
    line.ring.set_script([bits](const auto&, CycleFaults& faults) { faults.longer_bits = bits; });
    line.ring.set_input(0, 0x1234);
    const Octets seen = line.cycle({0xA5, 0x5A, 0x00, 0x00});
    EXPECT_EQ(line.ring.check_of({seen.data(), 4}), seen[4] << 8 | seen[5]);
    std::uint64_t stream = 0x1234A55A;  // what a ring of the right length gives
    stream = bits > 0 ? (stream >> bits | ((1ULL << bits) - 1) << (32 - bits)) : stream << -bits;
    const std::uint32_t got = static_cast<std::uint32_t>(seen[0]) << 24 |
                              static_cast<std::uint32_t>(seen[1]) << 16 |
                              static_cast<std::uint32_t>(seen[2]) << 8 | seen[3];
    EXPECT_EQ(got, static_cast<std::uint32_t>(stream)) << bits;
  }
}

TEST(RingEmulator, suffers_what_the_script_says) {
  const auto with = [](auto change) {
    Line line(line_of(1, 0x0103, 1));
    line.ring.set_script([change](const auto&, CycleFaults& faults) { change(faults); });
    return line.cycle({0xA5, 0x5A, 0x00, 0x00});
  };
  const Octets clean = with([](CycleFaults&) {});
  ASSERT_EQ(clean.size(), 8U);
  EXPECT_EQ(with([](CycleFaults& f) { f.dropped = 3; }).size(), 7U);
  EXPECT_EQ(with([](CycleFaults& f) { f.duplicated = 7; }).size(), 9U);
  EXPECT_EQ(with([](CycleFaults& f) { f.inserted = 0; }).at(1), clean[0]);
  EXPECT_EQ(with([](CycleFaults& f) { f.flips = {{2, 0x10, false}}; }).at(2), clean[2] ^ 0x10);
  EXPECT_EQ(with([](CycleFaults& f) { f.marked_by = 0; }).at(7), 0xFF);
  EXPECT_TRUE(with([](CycleFaults& f) { f.stuck = true; }).empty());
  EXPECT_TRUE(with([](CycleFaults& f) { f.stuck = false; }).empty());
}

TEST(RingEmulator, suffers_the_same_when_each_telegram_is_driven_by_itself) {
  const auto with = [](std::size_t bits_to_a_part, auto change) {
    Line line(line_of(1, 0x0103, 1));
    line.bits_to_a_part = bits_to_a_part;
    line.status_telegrams = 5;
    line.ring.set_script([change](const auto&, CycleFaults& faults) { change(faults); });
    const Octets returned = line.cycle({0xA5, 0x5A, 0x00, 0x00});
    EXPECT_FALSE(line.is_overdriven);
    return returned;
  };
  constexpr std::size_t kTelegramAndGap = line::kDataTelegramLevels + 2;
  for (int index = 0; index < 8; ++index) {
    const auto inserted = [index](CycleFaults& f) { f.inserted = index; };
    EXPECT_EQ(with(kTelegramAndGap, inserted), with(1'000, inserted)) << index;
    const auto twice = [index](CycleFaults& f) { f.duplicated = index; };
    EXPECT_EQ(with(kTelegramAndGap, twice), with(1'000, twice)) << index;
  }
  EXPECT_EQ(with(kTelegramAndGap, [](CycleFaults& f) { f.trailing_telegram = true; }).size(), 9U);
}

TEST(RingEmulator, is_silent_when_the_ring_is_open_and_marks_a_bad_check) {
  Line line(line_of(1, 0x0103, 1));
  line.ring.cut_after(-1);
  EXPECT_TRUE(line.cycle({0xA5, 0x5A, 0x00, 0x00}).empty());
  line.ring.mend();
  EXPECT_EQ(line.cycle({0xA5, 0x5A, 0x00, 0x00}).size(), 8U);
  EXPECT_EQ(line.ring.statistics().bad_checks, 0U);
  EXPECT_TRUE(line.ring.last_cycle().check_good);
}

TEST(MasterMutants, an_unknown_name_is_told_with_the_nearest) {
  try {
    conformance::master_mutants().maker("outputs_tron");
    FAIL();
  } catch (const std::exception& error) {
    EXPECT_NE(std::string(error.what()).find("outputs_torn"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace fieldproof::interbus
