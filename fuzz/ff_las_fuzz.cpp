// A link active scheduler of the profile FF-P on a link, with nodes that do what a script says.
//
// Input: a script. Its first octet chooses the target rotation time and the schedule, then each step is an
// octet that chooses what comes, and its parameters: what the next frame of the scheduler is answered with, a
// stretch in which all nodes do what they should, other frames with a check that fits, levels, silence, what
// the user wants. Invariants: those of ff_las_watch.hpp; when the line is clean again, it runs its schedule.

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "fuzz/ff_las_watch.hpp"
#include "fuzz/link_line.hpp"
#include "fuzz/octet_reader.hpp"
#include "fuzz/script.hpp"
#include "harness/kernel/check.hpp"
#include "protocols/fieldbus_dll/ff_las.hpp"

namespace {

using fieldproof::fieldbus_dll::FfConfiguration;
using fieldproof::fieldbus_dll::FfDlpdu;
using fieldproof::fieldbus_dll::FfEvent;
using fieldproof::fieldbus_dll::FfLas;
using fieldproof::fieldbus_dll::Priority;
using fieldproof::fuzz::FfLasWatch;
using fieldproof::fuzz::LinkEar;
using fieldproof::fuzz::LinkLine;
using fieldproof::fuzz::LinkOctets;
using fieldproof::fuzz::OctetReader;
using fieldproof::kernel::Time;

constexpr unsigned kMostSteps = 64;
constexpr std::uint8_t kLasNode = 0x10;
constexpr std::uint32_t kMacrocycle = 6'400;  // 200 ms
constexpr std::int64_t kMostWaited = 400;     // octet durations, for what the scheduler says next

FfConfiguration las_configuration(std::uint8_t choice) {
  using fieldproof::kernel::kMillisecond;
  FfConfiguration made;
  made.node = kLasNode;
  made.begins_as_scheduler = true;
  made.live = {0x11, 0x22, 0xF0};
  made.schedule.macrocycle = kMacrocycle;
  made.schedule.items = {{.at = 320, .address = 0x2220}, {.at = 3'200, .address = 0x1130}};
  if ((choice & 1U) != 0) made.schedule.items.push_back({.at = 3'210, .address = 0xF020});
  if ((choice & 2U) != 0) made.rules.target_rotation = 100 * kMillisecond;
  if ((choice & 4U) != 0) made.rules.time_distribution_period = 300 * kMillisecond;
  return made;
}

class NoUser final : public fieldproof::fieldbus_dll::FfUser {
  void on_data(const FfDlpdu&, Time) override {}
  void on_published(const FfDlpdu&, Time) override {}
  void on_event(const FfEvent&, Time) override {}
};

class FfLasWorld final : private LinkLine {
 public:
  explicit FfLasWorld(std::uint8_t choice)
      : LinkLine(las_configuration(choice).rules.link, choice),
        configuration_(las_configuration(choice)),
        las_(configuration_),
        watch_(configuration_),
        ear_(configuration_.rules.link),
        driven_(*this) {
    seat_ = segment().attach(las_, "las");
    auto& place = medium().attach("las/in", seat_, 0, {});
    place.sense_activity();
    place.tap_arrived(watch_);
    place.tap_driven(driven_);
    las_.wire(place, user_);
    FIELDPROOF_CHECK(las_.start(now()), "these rules are possible");
    segment().refresh(seat_);
  }

  void step(OctetReader& input);
  void recover();

 private:
  class Driven final : public fieldproof::segment::Tap {
   public:
    explicit Driven(FfLasWorld& world) : world_(world) {}
    void on_wave(const fieldproof::line::Waveform& wave) override {
      world_.ear_.on_wave(wave);
      world_.watch_.on_said(world_.ear_.said().back());
    }

   private:
    FfLasWorld& world_;
  };

  void follow(Time) override {}
  void on_begin(Time now) override { watch_.on_begin(now); }

  LinkOctets next_said();
  void answer(OctetReader& input, std::uint8_t flip);
  void answer_as_asked(unsigned count);

  FfConfiguration configuration_;
  NoUser user_;
  FfLas las_;
  FfLasWatch watch_;
  LinkEar ear_;
  Driven driven_;
  std::size_t seat_ = 0;
};

// Waits for it, and for V(MID) behind its end. Empty: it was silent.
LinkOctets FfLasWorld::next_said() {
  const std::size_t before = ear_.said().size();
  for (std::int64_t waited = 0; waited < kMostWaited && ear_.said().size() == before; ++waited)
    pass(octet_times(1));
  if (ear_.said().size() == before) return {};
  const LinkOctets octets = ear_.said().back().octets;
  pass(octet_times(static_cast<std::int64_t>(octets.size()) + 5 + 8));
  return octets;
}

void FfLasWorld::answer(OctetReader& input, std::uint8_t flip) {
  const std::uint8_t choice = input.octet();
  const LinkOctets said = next_said();
  const std::uint8_t node = said.size() > 1 ? said[1] : std::uint8_t{0x22};
  const auto size = static_cast<std::size_t>(choice >> 3);
  LinkOctets octets;
  switch (choice % 8U) {
    case 0:
      return;
    case 1:
      octets = {0x34};
      break;
    case 2:
      octets = {0xD6, 0x11, 0x20, node, 0x01};
      octets.resize(octets.size() + size);
      break;
    case 3:
      octets = {0xD2, 0x11, 0x20, node, 0x01};
      octets.resize(octets.size() + size);
      break;
    case 4:
      octets = {0x55, node, 0x20, 1};
      octets.resize(octets.size() + size);
      break;
    case 5:
      octets = {0x17, 0};
      break;
    case 6:
      octets = {0x27, node};
      break;
    default:
      octets = {0x14, node};
      break;
  }
  send(octets, flip);
}

void FfLasWorld::answer_as_asked(unsigned count) {
  for (unsigned n = 0; n < count; ++n) {
    const LinkOctets said = next_said();
    if (said.empty()) continue;
    const unsigned control = said[0];
    if ((control & 0xF8U) == 0x30 && (control & 3U) != 0) send(LinkOctets{0x34}, 0);
    if ((control & 0xF0U) == 0xA0) send(LinkOctets{0x55, said[1], said[2], 1}, 0);
  }
}

void FfLasWorld::step(OctetReader& input) {
  const auto [kind_of_step, flip] = fieldproof::fuzz::read_choice(input, 12);
  switch (kind_of_step) {
    case 0:
    case 1:
    case 2:
    case 3:
      return answer(input, flip);
    case 4:
      return answer_as_asked(input.octet() % 16U);
    case 5:
      return send(input.take(input.octet() % 16U), flip);
    case 6:
      return send_together(input, flip);
    case 7:
      return levels(input, 2 * configuration_.rules.link.bit_rate, flip);
    case 8:
      return pass(octet_times(input.octet()));
    case 9:
      return pass(octet_times(input.octet()) / 16);
    case 10: {
      const std::uint8_t choice = input.octet();
      (void)las_.submit({static_cast<Priority>(choice % 3U + 1), 0x2230, LinkOctets(choice >> 2U)}, now());
      break;
    }
    default:
      las_.order_transfer(input.octet(), now());
  }
  // What the user wants may be said at once.
  segment().refresh(seat_);
  pass({});
}

void FfLasWorld::recover() {
  // A token, a silence behind which the link is claimed, and the schedule.
  pass(2 * fieldproof::kernel::kSecond);
  const auto is_cd = [](const fieldproof::fuzz::LinkSaid& said) { return (said.octets[0] & 0xF0U) == 0xA0; };
  const auto before = std::ranges::count_if(ear_.said(), is_cd);
  constexpr int kCycles = 5;
  pass(kCycles * std::int64_t{kMacrocycle} * fieldproof::fieldbus_dll::kTick);
  const auto items = static_cast<std::ptrdiff_t>(configuration_.schedule.items.size());
  const auto compelled = std::ranges::count_if(ear_.said(), is_cd) - before;
  FIELDPROOF_CHECK(compelled >= (kCycles - 1) * items, "a scheduler runs its schedule");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return fieldproof::fuzz::play_script<FfLasWorld>(data, size, kMostSteps);
}
