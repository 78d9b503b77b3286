#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "harness/kernel/random.hpp"
#include "harness/kernel/time.hpp"

// The burst generator of IEC 61000-4-4: how high, how often and when.
//
// Bursts of 75 pulses follow each other every 300 ms. Within the standard's tolerances each run draws its own
// pulse rate, burst duration and burst period; each pulse strays from its place by up to 1 % of the pitch;
// the generator knows nothing of the clock of the line. The polarity holds for the whole run.
//
// Limit: within a run all bursts have the drawn rate and duration; the amplitude has no tolerance, so that a
// level means the voltage that it is called by.
namespace fieldproof::emc {

enum class PortKind : std::uint8_t { signal, power };
enum class Repetition : std::uint8_t { khz_5, khz_100, khz_2_5_edition_1 };
enum class Polarity : std::int8_t { positive = 1, negative = -1 };

std::string_view text_of(Repetition repetition);  // "5 kHz"
std::string_view text_of(Polarity polarity);      // "+"
// As options and plans write them.
std::string_view word_of(Repetition repetition);  // "5kHz"
inline std::string_view word_of(Polarity polarity) {
  return text_of(polarity);
}

// A severity level: 1 to 4 as the standard has them, or level X with a voltage of one's own.
class Level {
 public:
  // 1..4, else a usage error.
  static Level standard(PortKind port, unsigned number);
  static constexpr double kLeastVolts = 1;
  static constexpr double kMostVolts = 10'000;
  // Level X with a voltage between these, else a usage error.
  static Level free(double open_circuit_volts);

  unsigned number() const { return number_; }  // 0: X
  double open_circuit_volts() const { return volts_; }
  std::string text() const;  // "3 (1000 V)", "X (4500 V)"

 private:
  Level(unsigned number, double volts) : number_(number), volts_(volts) {}

  unsigned number_;
  double volts_;
};

// Where a burst begins, against the line.
enum class BurstPhase : std::uint8_t {
  asynchronous,  // anywhere within a burst period, drawn once per run
  // The same, and each burst begins another part of the pulse pitch later, so that a number of bursts
  // (`sweep_steps`) meets the line evenly at all phases.
  swept,
};

// The clock of the generator and the clock of a line are two clocks. Where both are taken as ideal and a
// pulse pitch is a whole number of bits, all pulses of a run meet the same place of a bit, and flip rates
// become an artefact of the model. Whoever wants to show that has to say so here.
enum class GeneratorClock : std::uint8_t { its_own, commensurable_with_the_line_to_show_the_artefact };

// What a run draws within the standard's 20 %. With the nominal period there are 200 bursts per minute, with
// the nominal duration 75 pulses in each, however fast they come.
enum class Tolerances : std::uint8_t {
  none,  // phase and jitter alone keep the clocks apart
  rate,
  rate_duration_and_period,
};

struct BurstSettings {
  Level level = Level::standard(PortKind::signal, 3);
  Repetition repetition = Repetition::khz_5;
  Polarity polarity = Polarity::positive;
  Tolerances tolerances = Tolerances::rate_duration_and_period;
  // Each pulse strays from its place. Where no tolerances are drawn it does so whatever is said here.
  bool has_jitter = true;
  BurstPhase phase = BurstPhase::asynchronous;
  // The first burst begins so long after `on`, and none runs when the generator is switched on; drawn where
  // nothing is said.
  std::optional<kernel::Duration> first_burst{};
  unsigned sweep_steps = 16;
  GeneratorClock clock = GeneratorClock::its_own;
  // Pulses come from `on` on, before `off`.
  kernel::Time on = kernel::kStart;
  kernel::Time off = kernel::kNever;
};

// What a run has drawn.
struct BurstTiming {
  kernel::Duration pitch;    // from pulse to pulse
  std::int64_t pulses;       // of a burst
  kernel::Duration period;   // from burst to burst
  kernel::Duration phase;    // of the first whole burst, behind `on`
  kernel::Duration jitter;   // a pulse is at most so far from its place
  kernel::Duration sweep;    // each burst begins so much later than the period says
  std::int64_t sweep_steps;  // until it begins again
};

// The pulses of a run, lazily, in order.
//
// Contract: the instants are a function of settings and stream alone, not of what is asked and when: the
// schedules of several receivers, made from equal streams, have the same pulses. Questions in the order of
// time cost a comparison each and the drawing of the pulses in between; a question further on, or back, costs
// a few divisions, however far it is.
class BurstSchedule {
 public:
  // `random` is split, not drawn from.
  BurstSchedule(const BurstSettings& settings, const kernel::Random& random);

  // The first pulse at or after `from`; kNever when there is none.
  kernel::Time first_from(kernel::Time from) {
    if (from < known_from_ || from > next_) seek(from);
    if (!is_drawn_) draw_pulse();
    return next_;
  }
  // Draws no pulse that is too late however it strays.
  bool has_pulse_in(kernel::Time from, kernel::Time to) {
    if (from < known_from_ || from > next_) seek(from);
    return next_ < to && (is_drawn_ || first_from(from) < to);
  }

  const BurstTiming& timing() const { return timing_; }

  // The burst of a pulse, for reports: from its first pulse to one pitch after its last.
  struct Window {
    kernel::Time from;
    kernel::Time to;
  };
  Window window_of(kernel::Time pulse) const;

 private:
  kernel::Time burst_begin(std::int64_t burst) const;
  // The last burst that surely begins before `time`.
  std::int64_t burst_before(kernel::Time time) const;
  void seek(kernel::Time from);
  void jump_to(kernel::Time wanted);
  void step();
  void begin_burst(std::int64_t burst);
  void draw_pulse();
  kernel::Time pulse_here() const;

  BurstTiming timing_;
  std::int64_t first_number_;  // of a burst
  kernel::Time origin_;
  kernel::Time on_;  // no pulse comes before
  kernel::Time off_;
  kernel::RandomChildren jitter_;  // of each pulse
  // The pulse that was found last, or where its search stands.
  std::int64_t burst_ = 0;
  kernel::Time begin_{};  // of that burst
  std::int64_t number_ = 0;
  // No pulse lies in [known_from_, next_); next_ is one when it is drawn.
  kernel::Time known_from_ = kernel::kNever;
  kernel::Time next_ = kernel::kNever;
  bool is_drawn_ = true;
};

}  // namespace fieldproof::emc
