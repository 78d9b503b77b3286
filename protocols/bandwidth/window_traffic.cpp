#include "protocols/bandwidth/window_traffic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "harness/kernel/error.hpp"
#include "harness/kernel/random.hpp"
#include "protocols/bandwidth/window_load.hpp"

namespace fieldproof::bandwidth {
namespace {

using kernel::Duration;
using kernel::Time;

constexpr Time kNothing{Duration{-1}};  // no instant of a sampling

[[noreturn]] void refuse_windows(const std::string& sentence) {
  throw kernel::Error(kernel::ErrorKind::configuration, sentence);
}

// What waits in the one place for periodic data of a node.
struct Stream {
  std::size_t loop = 0;
  bool is_controller = false;
  Duration period{};
  Time next{};             // sampling
  Time waits = kNothing;   // generated then
  Time sample = kNothing;  // of the sensor, from which it comes
  StreamFigures figures{};
};

struct Loop {
  std::size_t controller = 0;  // stream
  unsigned arrived = 0;        // since the last sampling
  Time newest = kNothing;      // sample of what has arrived
  LoopFigures figures{};
};

class WindowLine {
 public:
  WindowLine(const WindowTraffic& traffic, const WindowRun& run)
      : traffic_(traffic),
        run_(run),
        slot_(traffic_),
        real_time_(traffic_, traffic_.real_time, run.real_time, traffic_.real_time_packet,
                   kernel::Random(run.seed).split("real-time")),
        non_real_time_(traffic_, traffic_.non_real_time, run.non_real_time, traffic_.non_real_time_packet,
                       kernel::Random(run.seed).split("non-real-time")),
        stream_at_(traffic.nodes, -1),
        at_(run.first_node) {
    for (const LoopTraffic& loop : traffic.loops) {
      add_stream(loop.sensor, loop, loop.sensor_offset * traffic.slot, false);
      add_stream(loop.controller, loop, loop.controller_offset * traffic.slot + loop.skew, true);
      loops_.push_back({.controller = streams_.size() - 1});
    }
  }

  WindowFigures run() {
    const std::uint64_t start = slots_of_start(traffic_);
    counts_from_ = kernel::kStart + static_cast<std::int64_t>(start) * traffic_.slot;
    const Time end = counts_from_ + static_cast<std::int64_t>(run_.slots) * traffic_.slot;
    if (run_.begins_in_packet) leave_after_packet();
    while (now_ < counts_from_) visit();
    begin_counting();
    while (now_ < end) visit();
    return figures(now_);
  }

 private:
  void add_stream(std::uint8_t node, const LoopTraffic& loop, Duration first, bool is_controller) {
    stream_at_[node] = static_cast<int>(streams_.size());
    streams_.push_back({.loop = loops_.size(),
                        .is_controller = is_controller,
                        .period = loop.every * traffic_.slot,
                        .next = kernel::kStart + first});
  }

  void leave_after_packet() {
    send(Packet::non_real_time, traffic_.non_real_time_packet, kNothing, byte_);
    pass_on(true);
  }

  void visit() {
    WindowVisit visit(at_, byte_);
    bool is_answered = false;  // by a packet that ends the visit
    for (Packet packet = visit.next(waiting()); packet != Packet::none; packet = visit.next(waiting())) {
      is_answered = packet != Packet::real_time;
      if (packet == Packet::real_time) {
        send(packet, traffic_.real_time_packet, kNothing, visit.byte());
        real_time_.on_sent(at_, now_);
      } else if (packet == Packet::periodic) {
        send_periodic(streams_[static_cast<std::size_t>(stream_at_[at_])], visit.byte());
      } else {
        send(packet, traffic_.non_real_time_packet, kNothing, visit.byte());
        non_real_time_.on_sent(at_, now_);
      }
    }
    if (traffic_.has_periodic_byte) byte_ = visit.byte();
    pass_on(is_answered);
  }

  void pass_on(bool is_answered) {
    now_ += is_answered ? traffic_.overhead : traffic_.overhead + traffic_.empty_answer;
    if (++at_ == traffic_.nodes) at_ = 0;
    ++visits_;
  }

  Waiting waiting() {
    slot_.advance(now_);
    Waiting waiting;
    waiting.real_time = real_time_.is_at(at_) && real_time_.offers(at_, now_, slot_);
    if (const int stream = stream_at_[at_]; stream >= 0) {
      Stream& one = streams_[static_cast<std::size_t>(stream)];
      sample(one, now_);
      waiting.periodic = one.waits != kNothing;
    }
    waiting.non_real_time =
        !waiting.periodic && non_real_time_.is_at(at_) && non_real_time_.offers(at_, now_, slot_);
    return waiting;
  }

  // All samplings up to this instant.
  void sample(Stream& stream, Time until) {
    for (; stream.next <= until; stream.next += stream.period) {
      if (stream.is_controller && !control(loops_[stream.loop])) continue;
      ++stream.figures.generated;
      if (stream.waits != kNothing) ++stream.figures.replaced;
      stream.waits = stream.next;
      stream.sample = stream.is_controller ? loops_[stream.loop].newest : stream.next;
    }
  }

  // The sampling of a controller: has it a datum to compute with?
  static bool control(Loop& loop) {
    if (loop.newest == kNothing) return false;
    ++loop.figures.samplings;
    if (loop.arrived == 0) ++loop.figures.vacant;
    if (loop.arrived > 1) loop.figures.lost += loop.arrived - 1;
    loop.arrived = 0;
    return true;
  }

  void send(Packet packet, Duration length, Time generated, PeriodicByte byte) {
    const Time begin = now_;
    now_ += length;
    if (run_.on_sent) run_.on_sent({packet, at_, begin, now_, generated, byte});
  }

  void send_periodic(Stream& stream, PeriodicByte byte) {
    const Time generated = stream.waits;
    stream.waits = kNothing;
    send(Packet::periodic, traffic_.periodic_packet, generated, byte);
    slot_.on_sent_periodic();
    count(stream, generated);
    Loop& loop = loops_[stream.loop];
    if (stream.is_controller) {
      loop.figures.longest_delay = std::max(loop.figures.longest_delay, now_ - stream.sample);
      return;
    }
    // What arrives at the instant of a sampling counts for it.
    sample(streams_[loop.controller], now_ - kernel::kPicosecond);
    ++loop.arrived;
    loop.newest = stream.sample;
  }

  void count(Stream& stream, Time generated) {
    const Duration delay = now_ - generated;
    if (generated < counts_from_) {
      longest_of_start_ = std::max(longest_of_start_, delay);
      return;
    }
    ++stream.figures.delivered;
    stream.figures.sum += delay;
    stream.figures.longest = std::max(stream.figures.longest, delay);
    if (delay <= traffic_.slot) return;
    ++stream.figures.over_slot;
    if (!first_late_) {
      first_late_ = LateDatum{static_cast<std::size_t>(&stream - streams_.data()), generated, now_};
    }
  }

  void begin_counting() {
    for (Stream& stream : streams_) {
      sample(stream, counts_from_ - kernel::kPicosecond);
      stream.figures = {};
    }
    for (Loop& loop : loops_) loop.figures = {};
    real_time_.begin_counting(now_);
    non_real_time_.begin_counting(now_);
    visits_ = 0;
  }

  WindowFigures figures(Time now) {
    WindowFigures it;
    for (const Stream& stream : streams_) it.streams.push_back(stream.figures);
    for (const Loop& loop : loops_) it.loops.push_back(loop.figures);
    it.real_time = real_time_.figures(now, true);
    it.non_real_time = non_real_time_.figures(now, true);
    it.slots = run_.slots;
    it.visits = visits_;
    it.longest_of_start = longest_of_start_;
    it.first_late = first_late_;
    return it;
  }

  const WindowTraffic traffic_;
  const WindowRun run_;
  SlotView slot_;
  QueueSet real_time_;
  QueueSet non_real_time_;
  std::vector<int> stream_at_;  // by node; -1: none
  std::vector<Stream> streams_;
  std::vector<Loop> loops_;
  PeriodicByte byte_;
  std::uint8_t at_;
  Time now_ = kernel::kStart;
  Time counts_from_ = kernel::kStart;
  std::uint64_t visits_ = 0;
  Duration longest_of_start_{};
  std::optional<LateDatum> first_late_;
};

void check_node(const WindowTraffic& traffic, std::uint8_t node, std::vector<bool>& taken, const char* what) {
  if (node >= traffic.nodes) {
    refuse_windows(
        fmt::format("node {} has {}, and the server visits nodes 0 to {}", node, what, traffic.nodes - 1));
  }
  if (taken[node])
    refuse_windows(fmt::format("node {} has {} twice; each node has one place for it", node, what));
  taken[node] = true;
}

void check_loops(const WindowTraffic& traffic) {
  std::vector<bool> taken(traffic.nodes, false);
  for (const LoopTraffic& loop : traffic.loops) {
    check_node(traffic, loop.sensor, taken, "periodic data");
    check_node(traffic, loop.controller, taken, "periodic data");
    if (loop.every == 0 || (loop.every & (loop.every - 1)) != 0 || loop.sensor_offset >= loop.every ||
        loop.controller_offset >= loop.every) {
      refuse_windows("a loop samples each 2^n-th slot, from an offset below that");
    }
    if (loop.skew < Duration::zero() || loop.skew >= traffic.slot) {
      refuse_windows("a controller samples less than a slot after the begin of its slot");
    }
  }
}

}  // namespace

const char* name_of(Load load) {
  switch (load) {
    case Load::none:
      return "none";
    case Load::arriving:
      return "as it arrives";
    case Load::saturated:
      return "always";
    case Load::random:
      return "random";
    case Load::just_late:
      return "just late";
  }
  return "";
}

unsigned WindowTraffic::repeats_after() const {
  unsigned slots = 1;
  for (const LoopTraffic& loop : loops) slots = std::max(slots, loop.every);
  return slots;
}

std::vector<std::uint8_t> WindowTraffic::nodes_with_data(std::uint64_t number) const {
  std::vector<std::uint8_t> nodes_of_slot;
  for (const LoopTraffic& loop : loops) {
    if (number % loop.every == loop.sensor_offset) nodes_of_slot.push_back(loop.sensor);
    if (number % loop.every == loop.controller_offset) nodes_of_slot.push_back(loop.controller);
  }
  return nodes_of_slot;
}

std::uint64_t slots_of_start(const WindowTraffic& traffic) {
  return 3 * std::uint64_t{traffic.repeats_after()} + 2;
}

void check(const WindowTraffic& traffic) {
  if (traffic.nodes == 0 || traffic.nodes > 128) refuse_windows("a server visits 1 to 128 nodes");
  if (traffic.loops.empty()) refuse_windows("without a control loop there is nothing to schedule");
  if (traffic.slot <= Duration::zero() || traffic.overhead <= Duration::zero() ||
      traffic.empty_answer < Duration::zero() || traffic.periodic_packet < Duration::zero() ||
      traffic.real_time_packet < Duration::zero() || traffic.non_real_time_packet < Duration::zero()) {
    refuse_windows("a slot and the overhead of the server last longer than 0, and no time is negative");
  }
  check_loops(traffic);
  for (const auto* queues : {&traffic.real_time, &traffic.non_real_time}) {
    std::vector<bool> taken(traffic.nodes, false);
    const bool is_real_time = queues == &traffic.real_time;
    for (const QueueTraffic& queue : *queues) {
      check_node(traffic, queue.node, taken, is_real_time ? "a real-time queue" : "a non-real-time queue");
    }
  }
}

WindowFigures run_windows(const WindowTraffic& traffic, const WindowRun& run) {
  check(traffic);
  if (run.first_node >= traffic.nodes) refuse_windows("the server begins at a node that it visits");
  return WindowLine(traffic, run).run();
}

}  // namespace fieldproof::bandwidth
