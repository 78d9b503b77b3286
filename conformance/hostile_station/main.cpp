// A station that is right until a call in the case that it is told, and then does the worst: what the bench
// makes of implementations that crash, hang, flood or talk nonsense is tested with it. A node of the valve
// bus, or a basic device of the data link: whom the bench asks for.
//
//   hostile_station ACT CALL CASE [MARK]    "segv receive data_is_not_looked_at"; a mark is for who looks for
//   it
#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <string>

#include "harness/iut/server.hpp"
#include "protocols/fieldbus_dll/attached_ff_device.hpp"
#include "protocols/fieldbus_dll/ff_station.hpp"
#include "protocols/valve_bus/attached_node.hpp"
#include "protocols/valve_bus/node.hpp"

namespace fieldproof::conformance {
namespace {

void say(std::string_view octets) {
  while (!octets.empty()) {
    const ssize_t count = ::write(STDOUT_FILENO, octets.data(), octets.size());
    if (count <= 0) ::_exit(9);
    octets.remove_prefix(static_cast<std::size_t>(count));
  }
}

void say(std::span<const std::uint8_t> message) {
  say(std::string_view(reinterpret_cast<const char*>(message.data()), message.size()));
}

// Until the stack is used up.
std::size_t dig(std::size_t depth) {
  std::array<char, 4'096> held{};
  volatile char* const kept = held.data();
  kept[depth % held.size()] = 1;
  const std::size_t deeper = kept[0] == 2 ? 0 : dig(depth + 1);
  return deeper + static_cast<std::size_t>(kept[0]);
}

[[noreturn]] void hang() {
  while (true) ::pause();
}

// A station that is right, and an item that it may write 0 to.
struct RightStation {
  std::unique_ptr<iut::Device> device;
  iut::Item written;
};

RightStation right_station(const iut::RoleName& role) {
  if (role.protocol == "valve_bus") {
    return {std::make_unique<valve_bus::ServedNode>(
                [](const auto& configuration) { return std::make_unique<valve_bus::Node>(configuration); }),
            valve_bus::kValves};
  }
  return {std::make_unique<fieldbus_dll::ServedFfDevice>([](const auto& configuration) {
            return std::make_unique<fieldbus_dll::FfStation>(configuration);
          }),
          fieldbus_dll::kEvent};
}

class Hostile final : public iut::Device {
 public:
  Hostile(std::string act, std::string call, std::string in_case, RightStation right)
      : act_(std::move(act)),
        call_(std::move(call)),
        in_case_(std::move(in_case)),
        written_(right.written),
        right_(std::move(right.device)) {}

  iut::UnitKind unit_kind() const override { return right_->unit_kind(); }
  iut::Capabilities capabilities() const override { return right_->capabilities(); }
  void on_activity(unsigned port, bool begins, kernel::Time now) override {
    right_->on_activity(port, begins, now);
  }
  bool begin(const iut::CaseBegin& begin, iut::Bench& bench) override {
    bench_ = &bench;
    is_time_stuck_ = is_time_creeping_ = false;
    is_due_ = begin.id.find(in_case_) != std::string::npos;
    const bool is_served = right_->begin(begin, bench);
    do_worst("begin", {});
    return is_served;
  }
  void set_power(bool is_on, kernel::Time now) override {
    right_->set_power(is_on, now);
    do_worst("power", now);
  }
  void receive(unsigned port, std::span<const iut::Character> characters, kernel::Time now) override {
    right_->receive(port, characters, now);
  }
  void receive(unsigned port, const line::Waveform& reception) override {
    right_->receive(port, reception);
    do_worst("receive", reception.end());
  }
  void on_time(kernel::Time now) override {
    now_ = now;
    right_->on_time(now);
    do_worst("on_time", now);
  }
  kernel::Time next_time() const override {
    if (is_time_creeping_) return now_ + kernel::Duration{1};
    return is_time_stuck_ ? now_ : right_->next_time();
  }
  void end() override {
    right_->end();
    do_worst("end", now_);
  }

 private:
  void do_worst(std::string_view call, kernel::Time now) {
    now_ = now;
    if (!is_due_ || call != call_) return;
    is_due_ = false;
    const auto found = acts().find(act_);
    if (found == acts().end()) ::_exit(64);
    found->second(*this);
  }

  void transmit(unsigned port, kernel::Duration on, kernel::Duration start, kernel::Duration off) {
    bench_->set_driver(port, true, now_ + on);
    bench_->send(port, now_ + start, std::array<std::uint16_t, 1>{0x155});
    bench_->set_driver(port, false, now_ + off);
  }
  template <typename Fill>
  static void message(iut::MessageType type, Fill fill) {
    iut::MessageWriter writer;
    writer.begin(type);
    fill(writer);
    say(writer.finish());
  }

  static const std::map<std::string, std::function<void(Hostile&)>, std::less<>>& acts();

  std::string act_;
  std::string call_;
  std::string in_case_;
  iut::Item written_;
  std::unique_ptr<iut::Device> right_;
  iut::Bench* bench_ = nullptr;
  kernel::Time now_{};
  bool is_due_ = false;
  bool is_time_stuck_ = false;
  bool is_time_creeping_ = false;
};

const std::map<std::string, std::function<void(Hostile&)>, std::less<>>& Hostile::acts() {
  using kernel::kMicrosecond;
  using kernel::kMillisecond;
  static const std::map<std::string, std::function<void(Hostile&)>, std::less<>> all = {
      {"exit_0", [](Hostile&) { ::_exit(0); }},
      {"exit_255", [](Hostile&) { ::_exit(255); }},
      {"quick_exit", [](Hostile&) { std::quick_exit(1); }},
      {"bus_error", [](Hostile&) { ::raise(SIGBUS); }},
      {"illegal_instruction", [](Hostile&) { ::raise(SIGILL); }},
      {"broken_pipe",
       [](Hostile&) {
         ::signal(SIGPIPE, SIG_DFL);
         ::raise(SIGPIPE);
       }},
      {"quit", [](Hostile&) { ::raise(SIGQUIT); }},
      {"alarm",
       [](Hostile&) {
         ::signal(SIGALRM, SIG_DFL);
         ::raise(SIGALRM);
       }},
      {"null_pointer",
       [](Hostile&) {
         volatile int* volatile nowhere = nullptr;
         *nowhere = 1;
       }},
      {"endless_recursion", [](Hostile&) { std::exit(static_cast<int>(dig(0))); }},
      {"throws", [](Hostile&) { throw 7; }},
      {"stops_itself", [](Hostile&) { ::raise(SIGSTOP); }},
      {"sleeps", [](Hostile&) { ::sleep(1'000); }},
      {"waits_for_input",
       [](Hostile&) {
         std::array<char, 1> octet{};
         while (::read(STDIN_FILENO, octet.data(), 1) > 0) {
         }
         hang();
       }},
      {"many_children",
       [](Hostile&) {
         for (int n = 0; n < 20; ++n) {
           if (::fork() == 0) hang();
         }
         hang();
       }},
      {"length_of_three_octets",
       [](Hostile&) {
         say(std::string_view("\x05\0\0", 3));
         hang();
       }},
      {"type_zero", [](Hostile&) { say(std::string_view("\x01\0\0\0\0", 5)); }},
      {"longest_message_and_one", [](Hostile&) { say(std::string_view("\x01\0\0\x04", 4)); }},
      {"all_ones", [](Hostile&) { say(std::string(64, '\xFF')); }},
      {"zeros_for_ever",
       [](Hostile&) {
         while (true) say(std::string(4'096, '\0'));
       }},
      {"hello_again", [](Hostile&) { message(iut::MessageType::hello, [](auto& w) { w.u8(3); }); }},
      {"value_for_nothing", [](Hostile&) { message(iut::MessageType::value, [](auto& w) { w.u64(1); }); }},
      {"power_to_the_bench", [](Hostile&) { message(iut::MessageType::power, [](auto& w) { w.u8(1); }); }},
      {"empty_done", [](Hostile&) { message(iut::MessageType::done, [](auto&) {}); }},
      {"drives_a_port_without_end",
       [](Hostile& station) { station.transmit(65'535, kMicrosecond, 5 * kMicrosecond, kMillisecond); }},
      {"writes_all_ones",
       [](Hostile& station) { station.bench_->write(station.written_, ~std::uint64_t{0}, station.now_); }},
      {"writes_item_0xffff", [](Hostile& station) { station.bench_->write(0xFFFF, 0, station.now_); }},
      {"reads_item_0xffff", [](Hostile& station) { station.bench_->read(0xFFFF, station.now_); }},
      {"writes_in_the_past",
       [](Hostile& station) { station.bench_->write(station.written_, 0, station.now_ - kMillisecond); }},
      {"exit_3", [](Hostile&) { ::_exit(3); }},
      {"abort", [](Hostile&) { std::abort(); }},
      {"segv", [](Hostile&) { ::raise(SIGSEGV); }},
      {"kill", [](Hostile&) { ::raise(SIGKILL); }},
      {"term", [](Hostile&) { ::raise(SIGTERM); }},
      {"floating_point", [](Hostile&) { ::raise(SIGFPE); }},
      {"last_words",
       [](Hostile&) {
         std::fputs("stack smashed \x1b[31m at 0xdead\n", stderr);
         std::abort();
       }},
      {"close_output",
       [](Hostile&) {
         ::close(STDOUT_FILENO);
         hang();
       }},
      {"leave_a_child",
       [](Hostile&) {
         if (::fork() == 0) hang();
         ::_exit(0);
       }},
      {"hang", [](Hostile&) { hang(); }},
      {"hang_for_all_signals",
       [](Hostile&) {
         for (int signal = 1; signal < 32; ++signal) ::signal(signal, SIG_IGN);
         hang();
       }},
      {"spin",
       [](Hostile&) {
         volatile bool for_ever = true;  // read each time: a loop without effects may be left out
         while (for_ever) {
         }
       }},
      {"flood_the_log",
       [](Hostile&) {
         const std::string line(4000, 'x');
         while (true) std::fprintf(stderr, "%s\n", line.c_str());
       }},
      {"no_length", [](Hostile&) { say(std::string_view("\0\0\0\0", 4)); }},
      {"endless_length", [](Hostile&) { say("\xFF\xFF\xFF\x7F"); }},
      {"unknown_type", [](Hostile&) { say(std::string_view("\x01\0\0\0\x4D", 5)); }},
      {"cut_content", [](Hostile&) { message(iut::MessageType::write, [](auto& writer) { writer.u8(1); }); }},
      {"content_too_long",
       [](Hostile&) { message(iut::MessageType::done, [](auto& w) { w.u64(0).u64(0); }); }},
      {"words_of_the_bench", [](Hostile&) { message(iut::MessageType::case_end, [](auto&) {}); }},
      {"printed_text", [](Hostile&) { say("Hello, world\n"); }},
      {"half_a_message",
       [](Hostile&) {
         say(std::string_view("\x09\0\0\0\x83\0\0", 7));
         hang();
       }},
      {"answers_twice",
       [](Hostile&) { message(iut::MessageType::done, [](auto& writer) { writer.i64(0); }); }},
      {"refuses_in_the_middle",
       [](Hostile&) {
         message(iut::MessageType::unsupported, [](auto&) {});
         hang();
       }},
      {"flood",
       [](Hostile& station) {
         for (int n = 0; n < 50'000; ++n) station.bench_->write(station.written_, 0, station.now_);
       }},
      {"time_stands_still", [](Hostile& station) { station.is_time_stuck_ = true; }},
      {"time_creeps", [](Hostile& station) { station.is_time_creeping_ = true; }},
      {"drives_more_than_a_line",
       [](Hostile& station) {
         for (int n = 0; n < 3; ++n) station.transmit(0, kMicrosecond, kMicrosecond, 6 * kernel::kSecond);
       }},
      {"drives_in_the_past",
       [](Hostile& station) { station.transmit(0, -kMillisecond, -kMillisecond, kMillisecond); }},
      {"drives_backwards",
       [](Hostile& station) { station.transmit(0, kMillisecond, 10 * kMicrosecond, 5 * kMicrosecond); }},
      {"drives_for_ever",
       [](Hostile& station) {
         station.transmit(0, kMicrosecond, 2 * kMicrosecond, 100'000 * kernel::kSecond);
       }},
      {"drives_another_port",
       [](Hostile& station) { station.transmit(7, kMicrosecond, 5 * kMicrosecond, kMillisecond); }},
      {"writes_what_is_not_there", [](Hostile& station) { station.bench_->write(77, 1, station.now_); }},
      {"writes_too_much",
       [](Hostile& station) { station.bench_->write(station.written_, 0x10000, station.now_); }},
      {"reads_what_is_not_there", [](Hostile& station) { station.bench_->read(77, station.now_); }},
  };
  return all;
}

}  // namespace
}  // namespace fieldproof::conformance

int main(int argc, char** argv) {
  using namespace fieldproof;
  using conformance::Hostile;
  if (argc < 4) return 64;
  try {
    iut::serve(
        STDIN_FILENO, STDOUT_FILENO, {"valve_bus", "node"},
        [&](const iut::RoleName& role) {
          return std::make_unique<Hostile>(argv[1], argv[2], argv[3], conformance::right_station(role));
        },
        "hostile station");
  } catch (const std::exception&) {
    return 5;  // the bench does not listen any more
  }
}
