// INTERBUS rings at full line fidelity: every telegram is encoded to levels and decoded again at every
// station.
//
// Four measures. "real time": simulated time per processor time, beside a row that only counts real time, so
// the ratio is how much faster than real time a ring runs. "hop": one telegram over one of the links, beside
// the floor, a hand-written loop without scheduler, trace, frame check, states and time that only decodes,
// shifts and encodes the same telegrams. "cycle": one data cycle, for rings of 1 to 512 stations. "injector":
// the paper's set-up with burst channels on both directions of its cable, whose bursts are yet to come,
// beside the same without.
#include <array>
#include <bit>
#include <cstdint>
#include <ctime>
#include <deque>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/rows.hpp"
#include "emc/burst_channel.hpp"
#include "emc/profile.hpp"
#include "harness/segment/segment.hpp"
#include "protocols/interbus/master.hpp"
#include "protocols/interbus/network.hpp"
#include "protocols/interbus/ring.hpp"

namespace fieldproof::bench {
namespace {

using interbus::NetworkDescription;
using kernel::kMillisecond;

NetworkDescription line_of(unsigned stations, unsigned words) {
  NetworkDescription network;
  network.name = "line";
  const auto code = interbus::length_code_of(words, network.rules);
  for (unsigned n = 0; n < stations; ++n) {
    interbus::StationDescription station;
    station.name = "station_" + std::to_string(n + 1);
    station.id_code = static_cast<std::uint16_t>(*code << 8 | 0x03);
    network.stations.push_back(station);
  }
  return network;
}

// A ring that runs.
struct Running {
  explicit Running(const NetworkDescription& network)
      : master(interbus::master_configuration(network)),
        seat(segment.attach(master, "master")),
        ring(segment, network, seat) {
    master.wire(ring.out());
    master.start(segment.now());
    segment.refresh(seat);
    for (int tries = 0; master.status().state != interbus::MasterState::run; ++tries) {
      if (tries > 20'000) throw std::logic_error("the ring of a benchmark does not come up");
      segment.run_for(5 * kMillisecond);
    }
  }

  // Runs `cycles` data cycles.
  void run(std::uint64_t cycles) {
    const interbus::MasterStatus before = master.status();
    segment.run_for(before.cycle_time * static_cast<std::int64_t>(cycles));
    if (master.status().rejected_cycles != 0) throw std::logic_error("a ring without faults rejects a cycle");
  }

  segment::Segment segment;
  interbus::Master master;
  std::size_t seat;
  interbus::Ring ring;
};

// Data telegrams and status telegrams that a cycle puts on each link.
struct CycleSize {
  std::size_t data;
  std::size_t status;
};

CycleSize size_of_cycle(Running& running) {
  struct Counter final : segment::Tap {
    void on_wave(const line::Waveform& wave) override {
      line::TelegramCode(line::TelegramLayout{}).decode(wave.levels, 0, [&](const line::Telegram& telegram) {
        ++(telegram.is_data() ? size.data : size.status);
      });
    }
    CycleSize size{0, 0};
  };
  static Counter counter;
  counter.size = {0, 0};
  running.ring.link_to(1).tap_driven(counter);
  running.run(1);
  return counter.size;
}

// ---- the floor ----

// Telegrams of one train in packed levels, gap after each.
class Floor {
 public:
  Floor(CycleSize size, unsigned stations) : size_(size), registers_(stations) {
    for (auto& octets : registers_) octets.fill(0x5A);
    train_.resize(buffer_words());
    next_.resize(buffer_words());
    write_train();
  }

  // One cycle: the train over every forward and return link. Gives the telegrams carried.
  std::uint64_t run_cycle() {
    write_train();
    for (auto& octets : registers_) {
      pass<true>(octets);
      train_.swap(next_);
    }
    for (std::size_t n = 0; n < registers_.size(); ++n) {
      pass<false>(registers_[n]);
      train_.swap(next_);
    }
    return (size_.data + size_.status) * 2 * registers_.size();
  }

 private:
  using Register = std::array<std::uint8_t, 2>;

  std::size_t buffer_words() const { return ((size_.data * 15 + size_.status * 6) / 64) + 4; }

  void put(std::vector<std::uint64_t>& words, std::size_t at, std::uint64_t bits, unsigned count) {
    const std::uint64_t zeros = ~bits & ((std::uint64_t{1} << count) - 1);
    const unsigned shift = at % 64;
    words[at / 64] &= ~(zeros << shift);
    words[at / 64 + 1] &= ~((zeros >> 1) >> (63 - shift));
  }

  void write_train() {
    std::fill(train_.begin(), train_.end(), ~std::uint64_t{0});
    std::size_t at = 0;
    for (std::size_t n = 0; n < size_.data; ++n, at += 15) put(train_, at, 0x1008 | (n & 0xFF) << 4, 13);
    for (std::size_t n = 0; n < size_.status; ++n, at += 6) put(train_, at, 0x10, 5);
    levels_ = at;
  }

  template <bool kShifts>
  void pass(Register& octets) {
    std::fill(next_.begin(), next_.end(), ~std::uint64_t{0});
    std::size_t at = 0;
    while (at < levels_) {
      const unsigned shift = at % 64;
      std::uint64_t window = (train_[at / 64] >> shift) | ((train_[at / 64 + 1] << 1) << (63 - shift));
      unsigned left = 64;
      do {
        if ((window & 1) != 0) {
          const auto idle = static_cast<unsigned>(std::countr_one(window));
          at += idle;
          left -= idle;
          if (left < 13) break;
          window >>= idle;
        }
        if ((window & 8) != 0) {
          auto data = static_cast<std::uint8_t>((window >> 4) & 0xFF);
          if constexpr (kShifts) {
            const std::uint8_t out = octets[0];
            octets[0] = octets[1];
            octets[1] = data;
            data = out;
          }
          put(next_, at, std::uint64_t{0x1008} | std::uint64_t{data} << 4, 13);
          window >>= 13;
          left -= 13;
          at += 13;
        } else {
          put(next_, at, 0x10, 5);
          window >>= 5;
          left -= 5;
          at += 5;
        }
      } while (left >= 13 && at < levels_);
    }
  }

  CycleSize size_;
  std::vector<Register> registers_;
  std::vector<std::uint64_t> train_;
  std::vector<std::uint64_t> next_;
  std::size_t levels_ = 0;
};

// ---- rows ----

constexpr unsigned kHopStations = 64;

Batch make_floor() {
  Running running(line_of(kHopStations, 1));
  auto floor = std::make_shared<Floor>(size_of_cycle(running), kHopStations);
  return [=] { return floor->run_cycle(); };
}

Batch make_hops() {
  auto running = std::make_shared<Running>(line_of(kHopStations, 1));
  const CycleSize size = size_of_cycle(*running);
  return [=] {
    running->run(1);
    return (size.data + size.status) * 2 * kHopStations;
  };
}

// Microseconds of simulated time.
std::function<Batch()> real_time_of(const NetworkDescription& network, std::uint64_t cycles) {
  return [=]() -> Batch {
    auto running = std::make_shared<Running>(network);
    return [=] {
      running->run(cycles);
      return static_cast<std::uint64_t>(
          (running->master.status().cycle_time * static_cast<std::int64_t>(cycles)) / kernel::kMicrosecond);
    };
  };
}

// The clock on the wall: a microsecond takes a microsecond of a processor that is kept busy.
Batch make_clock() {
  return [] {
    timespec begin{};
    timespec end{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &begin);
    const auto elapsed = [&] {
      clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &end);
      return (end.tv_sec - begin.tv_sec) * 1'000'000 + (end.tv_nsec - begin.tv_nsec) / 1000;
    };
    while (elapsed() < 1000) {
    }
    return static_cast<std::uint64_t>(elapsed());
  };
}

std::function<Batch()> cycles_of(unsigned stations) {
  return [=]() -> Batch {
    auto running = std::make_shared<Running>(line_of(stations, stations > 256 ? 0 : 1));
    return [=] {
      running->run(1);
      return std::uint64_t{1};
    };
  };
}

// The paper's set-up, with a burst channel on each link or without. The bursts are yet to come: the channels
// look at their schedule for each transmission and find nothing.
struct Coupled {
  explicit Coupled(bool has_injector) : running(line_of(1, 2)) {
    if (!has_injector) return;
    const emc::WrongOutput wrong =
        emc::LineResponse(emc::Profile::named("A").coupling).wrong_output(1000, emc::Polarity::positive);
    emc::BurstSettings bursts;
    bursts.on = running.segment.now() + 1'000'000 * kernel::kSecond;
    for (segment::Link* link : {&running.ring.link_to(1), &running.ring.link_from(1)}) {
      channels.emplace_back(emc::BurstSchedule(bursts, kernel::Random(1)), wrong,
                            emc::BurstReceiver{500'000, nullptr, line::Sampling{}, true, true},
                            running.segment.trace(), link->trace_channel());
      link->set_channel(&channels.back());
    }
  }

  Running running;
  std::deque<emc::BurstChannel> channels;
};

std::function<Batch()> coupled(bool has_injector) {
  return [=]() -> Batch {
    auto ring = std::make_shared<Coupled>(has_injector);
    return [=] {
      ring->running.run(1000);
      return std::uint64_t{1000};
    };
  };
}

constexpr double kInjectorWithoutHits = 1 / 1.3;

const Rows kRows({
    {"INTERBUS hop, 64 stations", "hand-written loop", "hops", "", 0, make_floor},
    {"INTERBUS hop, 64 stations", "fieldproof", "hops", "hand-written loop", 0.5, make_hops},
    {"INTERBUS, 1 station, 4 octets, against real time", "clock", "us", "", 0, make_clock},
    {"INTERBUS, 1 station, 4 octets, against real time", "fieldproof", "us", "clock", 500,
     real_time_of(line_of(1, 2), 1000)},
    {"INTERBUS, 64 stations, 128 octets, against real time", "clock", "us", "", 0, make_clock},
    {"INTERBUS, 64 stations, 128 octets, against real time", "fieldproof", "us", "clock", 5,
     real_time_of(line_of(64, 1), 4)},
    {"INTERBUS data cycle", "1 station", "cycles", "", 0, cycles_of(1)},
    {"INTERBUS data cycle", "10 stations", "cycles", "", 0, cycles_of(10)},
    {"INTERBUS data cycle", "64 stations", "cycles", "", 0, cycles_of(64)},
    {"INTERBUS data cycle", "512 stations without data", "cycles", "", 0, cycles_of(512)},
    {"INTERBUS, 1 station, injector without hits", "no injector", "cycles", "", 0, coupled(false)},
    {"INTERBUS, 1 station, injector without hits", "injector", "cycles", "no injector", kInjectorWithoutHits,
     coupled(true)},
});

}  // namespace
}  // namespace fieldproof::bench
