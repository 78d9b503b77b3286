// Subject: master.
// Every state of the master with every event, as a table that a person approves.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "harness/line/frame_check_16.hpp"
#include "protocols/interbus/master.hpp"

namespace fieldproof::interbus {
namespace {

enum class Answer { good, bad, none, other_station };

// A line with one station of one word, played by hand: answers each cycle when it is driven.
class OneStation : public segment::Port {
 public:
  explicit OneStation(const Rules& rules)
      : code_(rules.telegram), check_(line::shared_frame_check_16(rules.frame_check)) {
    MasterConfiguration configuration;
    configuration.rules = rules;
    master_ = std::make_unique<Master>(configuration);
    master_->wire(*this);
    master_->on_cycle_end([this](kernel::Time, bool, bool) { ++finished_; });
  }

  Master& master() { return *master_; }
  MasterState state() const { return master_->status().state; }
  kernel::Time now() const { return now_; }
  void set_answer(Answer answer) { answer_ = answer; }
  unsigned finished() const { return finished_; }
  unsigned waves() const { return waves_; }  // that the master drove

  // One step of the master's time line; false when it wants nothing more.
  bool step() {
    const kernel::Time next = master_->next_time();
    if (next == kernel::kNever) return false;
    now_ = std::max(now_, next);
    master_->on_time(now_);
    if (driven_.levels.empty()) return true;
    ++waves_;
    const line::Waveform sent = std::exchange(driven_, {});
    answer(sent);
    return true;
  }
  // Until the state is reached; false when it is not.
  bool step_to(MasterState wanted) {
    for (int n = 0; n < 5000 && state() != wanted; ++n) {
      if (!step()) break;
    }
    return state() == wanted;
  }
  // So many finished cycles, or a second without one.
  void finish_cycles(unsigned count) {
    const unsigned until = finished_ + count;
    const kernel::Time end = now_ + kernel::kSecond;
    while (finished_ < until && now_ < end && step()) {
    }
  }

  void drive(line::Waveform& wave) override {
    driven_.start = wave.start;
    driven_.rate = wave.rate;
    std::swap(driven_.levels, wave.levels);
    wave.levels.clear();
  }

 private:
  void answer(const line::Waveform& sent) {
    std::vector<line::Telegram> data;
    code_.decode(sent.levels, 0, [&](const line::Telegram& t) {
      if (t.is_data()) data.push_back(t);
    });
    if (data.empty() || answer_ == Answer::none) return;
    const bool is_id = (data.front().header & line::kSelect) != 0;
    const std::uint16_t word = is_id ? (answer_ == Answer::other_station ? 0x0102 : 0x0103) : 0x1234;
    std::vector<std::uint8_t> octets{static_cast<std::uint8_t>(word >> 8), static_cast<std::uint8_t>(word)};
    const std::size_t transfer = data.size() - kTrailerOctets;
    for (std::size_t n = 0; n + 2 < transfer; ++n) octets.push_back(data[n].data);
    const auto check = check_.check_octets(check_.update(check_.start(), octets));
    octets.insert(octets.end(), {check[0], check[1], 0, 0});
    // A data cycle of another ring is rejected, so that the ID cycle after it shows it.
    if (answer_ == Answer::bad || (answer_ == Answer::other_station && !is_id)) octets[0] ^= 1;
    line::Waveform back;
    back.start = sent.start + 6 * kernel::kMicrosecond;
    back.rate = sent.rate;
    for (std::size_t n = 0; n < octets.size(); ++n) {
      back.levels.append_idle(data[n].level - back.levels.size());
      code_.append(back.levels, data[n].header, octets[n]);
    }
    master_->receive(0, back);
  }

  line::TelegramCode code_;
  const line::FrameCheck16& check_;
  std::unique_ptr<Master> master_;
  line::Waveform driven_;
  kernel::Time now_ = kernel::kStart;
  Answer answer_ = Answer::good;
  unsigned finished_ = 0;
  unsigned waves_ = 0;
};

constexpr unsigned kStopAfter = 3;

// A line whose master has come to the state.
std::unique_ptr<OneStation> in_state(MasterState state) {
  Rules rules;
  rules.stop_after_bad_cycles = kStopAfter;
  auto line = std::make_unique<OneStation>(rules);
  if (state == MasterState::off) return line;
  line->master().start(line->now());
  if (state == MasterState::ready) return line;
  if (state == MasterState::identification) {
    EXPECT_TRUE(line->step_to(state));
    return line;
  }
  EXPECT_TRUE(line->step_to(MasterState::run));
  line->finish_cycles(1);
  if (state == MasterState::run) return line;
  line->set_answer(Answer::bad);
  EXPECT_TRUE(line->step_to(MasterState::bus_stop));
  line->set_answer(Answer::good);
  EXPECT_TRUE(line->step_to(MasterState::locating));
  EXPECT_TRUE(line->step_to(state));
  return line;
}

using StationEvent = void (*)(OneStation&);

struct StateRow {
  const char* name;
  StationEvent event;
};

// Up to so many cycles, until one has changed the state.
void cycles(OneStation& line, Answer answer, unsigned count) {
  const MasterState before = line.state();
  line.set_answer(answer);
  for (unsigned n = 0; n < count && line.state() == before; ++n) line.finish_cycles(1);
}

constexpr unsigned kMany = 8;  // more than a recognition of one station and more than the limit of bad cycles

const StateRow kRows[] = {
    {"start", [](OneStation& line) { line.master().start(line.now()); }},
    {"stop", [](OneStation& line) { line.master().stop(line.now()); }},
    {"stop, then cycle",
     [](OneStation& line) {
       line.master().stop(line.now());
       cycles(line, Answer::good, 2);
     }},
    {"good cycle", [](OneStation& line) { cycles(line, Answer::good, 1); }},
    {"good cycles", [](OneStation& line) { cycles(line, Answer::good, kMany); }},
    {"bad cycle", [](OneStation& line) { cycles(line, Answer::bad, 1); }},
    {"bad cycles", [](OneStation& line) { cycles(line, Answer::bad, kMany); }},
    {"no return", [](OneStation& line) { cycles(line, Answer::none, 1); }},
    {"never a return", [](OneStation& line) { cycles(line, Answer::none, kMany); }},
    {"ID requested",
     [](OneStation& line) {
       line.master().request_id_cycle(line.now());
       cycles(line, Answer::good, 2);
     }},
    {"other station", [](OneStation& line) { cycles(line, Answer::other_station, 2); }},
};

void end_row(std::string& table) {
  table.erase(table.find_last_not_of(' ') + 1);
  table += '\n';
}

constexpr MasterState kStates[] = {MasterState::off, MasterState::ready,    MasterState::identification,
                                   MasterState::run, MasterState::locating, MasterState::bus_stop};

TEST(MasterStates, every_state_with_every_event) {
  std::string table = fmt::format("\n{:<16}", "");
  for (const MasterState state : kStates) table += fmt::format("| {:<14}", name(state));
  end_row(table);
  for (const StateRow& row : kRows) {
    table += fmt::format("{:<16}", row.name);
    for (const MasterState state : kStates) {
      const auto line = in_state(state);
      ASSERT_EQ(line->state(), state);
      row.event(*line);
      table += fmt::format("| {:<14}", name(line->state()));
    }
    end_row(table);
  }
  // A cell is the state after the event, or the first other state that the cycles led to. Ready, off and
  // bus_stop have no cycles of their own: ready ends with the first good ID cycle of the recognition.
  const std::string approved = R"(
                | off           | ready         | identification| run           | locating      | bus_stop
start           | ready         | ready         | identification| run           | locating      | ready
stop            | off           | off           | off           | run           | off           | off
stop, then cycle| off           | off           | off           | off           | off           | off
good cycle      | off           | identification| identification| run           | locating      | bus_stop
good cycles     | off           | identification| run           | run           | bus_stop      | bus_stop
bad cycle       | off           | ready         | identification| run           | locating      | bus_stop
bad cycles      | off           | ready         | bus_stop      | bus_stop      | bus_stop      | bus_stop
no return       | off           | ready         | identification| run           | locating      | bus_stop
never a return  | off           | ready         | bus_stop      | bus_stop      | bus_stop      | bus_stop
ID requested    | off           | identification| identification| run           | locating      | bus_stop
other station   | off           | identification| identification| bus_stop      | locating      | bus_stop
)";
  EXPECT_EQ(table, approved) << table;
}

// A stop that waits for its data cycle, when the ID cycle under way turns out to be the last bad one.
TEST(MasterStates, a_stop_holds_when_the_bus_is_given_up) {
  Rules rules;
  rules.stop_after_bad_cycles = 2;
  OneStation line(rules);
  line.master().start(line.now());
  ASSERT_TRUE(line.step_to(MasterState::run));
  line.finish_cycles(1);
  line.set_answer(Answer::bad);
  line.finish_cycles(1);
  ASSERT_EQ(line.state(), MasterState::run);
  // The ID cycle that follows has started, and has not come back.
  const std::uint64_t cycles = line.finished();
  const std::uint64_t waves = line.waves();
  while (line.waves() == waves) ASSERT_TRUE(line.step());
  ASSERT_EQ(line.finished(), cycles);
  line.master().stop(line.now());
  ASSERT_EQ(line.state(), MasterState::run);
  line.finish_cycles(1);
  EXPECT_EQ(line.state(), MasterState::off);
  EXPECT_EQ(line.master().next_time(), kernel::kNever);
}

}  // namespace
}  // namespace fieldproof::interbus
