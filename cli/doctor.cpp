#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "cli/attachments.hpp"
#include "cli/exit_code.hpp"
#include "cli/implementations.hpp"
#include "cli/protocol_entry.hpp"
#include "cli/serial_pool.hpp"
#include "cli/verbs.hpp"
#include "harness/iut/misbehaviour.hpp"
#include "harness/iut/plugin.hpp"
#include "harness/kernel/error.hpp"
#include "harness/kernel/untrusted_text.hpp"

// `fieldproof doctor`: can an implementation be attached and get through a case, and how well does this
// machine know instants? What it cannot use ends the program with exit code 5, as a run would.
namespace fieldproof::cli {
namespace {

constexpr unsigned kRounds = 200;
// Reasons of what an implementation does to the bench begin so; those of what it does on the line do not.
constexpr std::string_view kMisbehaves = "implementation_";

// What was measured so many times.
class Samples {
 public:
  void add(kernel::Duration sample) { all_.push_back(sample); }
  std::string text() const {
    return fmt::format("{:.1f} us, the worst of {} {:.1f} us", microseconds(median()), all_.size(),
                       microseconds(worst()));
  }
  kernel::Duration median() const {
    std::vector<kernel::Duration> sorted = all_;
    std::ranges::sort(sorted);
    return sorted.empty() ? kernel::Duration{} : sorted[sorted.size() / 2];
  }
  kernel::Duration worst() const { return all_.empty() ? kernel::Duration{} : std::ranges::max(all_); }

 private:
  static double microseconds(kernel::Duration time) { return static_cast<double>(time.count()) * 1e-6; }
  std::vector<kernel::Duration> all_;
};

class Doctor {
 public:
  Doctor(Session& session, iut::RoleName role) : session_(session), role_(std::move(role)) {}

  void examine_machine();
  void examine(const conformance::Assignment& one);

 private:
  void say(std::string_view what, const std::string& finding) {
    session_.terminal.print(fmt::format("  {:<26}{}\n", what, kernel::escaped_line(finding)));
  }
  void examine_channel(iut::DevicePool& pool, std::string_view what);
  void examine_line(const std::string& uri);
  void try_a_case(const conformance::Assignment& one);

  Session& session_;
  iut::RoleName role_;
};

// A sleep that is too long, and octets between the two ends of a pseudo terminal: what stamps are made of.
void Doctor::examine_machine() {
  session_.terminal.print("this machine\n");
  say("real-time priority", iut::ask_for_real_time()
                                ? "permitted"
                                : "not permitted: stamps are as wide as others keep this program waiting");
  const iut::WallClock clock;
  Samples steps;
  for (unsigned n = 0; n < kRounds; ++n) {
    const kernel::Time before = clock.now();
    steps.add(clock.now() - before);
  }
  say("a look at the clock", steps.text());
  const auto link = std::filesystem::temp_directory_path() / fmt::format("fieldproof-{}", ::getpid());
  iut::SerialLine far = iut::SerialLine::at_new_terminal(link.string(), clock);
  iut::SerialLine near(link.string(), clock);
  near.look_every(50 * kernel::kMicrosecond);
  Samples ways;
  Samples widths;
  Samples late;
  for (unsigned n = 0; n < kRounds; ++n) {
    const kernel::Time until = clock.now() + kernel::kMillisecond;
    while (near.read(until)) {
    }
    late.add(clock.now() - until);
    const std::uint8_t octet = 0x55;
    const iut::Stamp written = far.write(std::span(&octet, 1));
    if (const auto arrival = near.read(clock.now() + kernel::kSecond)) {
      ways.add(arrival->stamp.latest - written.earliest);
      widths.add(arrival->stamp.latest - arrival->stamp.earliest);
    }
  }
  say("a sleep of 1 ms ends late", late.text());
  say("an octet over a terminal", ways.text());
  say("a stamp is known to", widths.text());
  say("U of a turnaround", fmt::format("usually {}, at worst {}, as busy as the machine is now",
                                       kernel::describe(2 * ways.median() + widths.median()),
                                       kernel::describe(2 * ways.worst() + widths.worst())));
}

void Doctor::examine_channel(iut::DevicePool& pool, std::string_view what) {
  iut::DevicePool::Lease device = pool.take();
  say(what, fmt::format("attached, calls itself '{}'", device->own_name()));
  say("echo, unknown case", "as they should be");
  const iut::WallClock clock;
  Samples calls;
  for (unsigned n = 0; n < kRounds; ++n) {
    const kernel::Time before = clock.now();
    device->test_itself();
    calls.add((clock.now() - before) / 2);
  }
  say("a call", calls.text());
  device.set_reusable();
}

void Doctor::examine_line(const std::string& uri) {
  const iut::SerialSettings settings = iut::serial_settings(uri);
  const Role& role = role_named(role_.protocol + "/" + role_.role);
  if (role.uart == nullptr)
    throw kernel::Error(kernel::ErrorKind::usage, fmt::format("'{}': {}", uri, no_serial_line_for(role)));
  std::optional<iut::DevicePool> upper;
  if (settings.upper.empty()) {
    say("upper channel",
        "none: outputs and inputs are not seen, nothing is asked; settings and supply stay as they are");
  } else {
    examine_channel(upper.emplace(settings.upper, role_), "upper channel");
  }
  const iut::WallClock clock;
  iut::SerialLine line(settings.path, clock);
  say("line", line.is_terminal() ? "open; a pseudo terminal: no bit rate, parity, framing, break, ninth bit"
                                 : "open");
  const iut::UartLine uart = role.uart({});  // where a case says nothing
  const std::int64_t rate = settings.bit_rate.value_or(uart.bit_rate);
  const line::CharacterFormat format = settings.format.value_or(uart.eight_bit_format());
  line.set(rate, format);
  say("settings", line.is_terminal() ? "a pseudo terminal has none"
                                     : fmt::format("{} bit/s {} accepted", rate, format.text()));
  say("direction", line.direction());
  const kernel::Time until = clock.now() + 200 * kernel::kMillisecond;
  std::size_t unasked = 0;
  while (const auto arrival = line.read(until)) unasked += arrival->octets.size();
  say("unasked", unasked == 0 ? "silent for 200 ms" : fmt::format("{} octets within 200 ms", unasked));
  if (settings.latency)
    say("latency", fmt::format("{} each way, as the URI says", kernel::describe(*settings.latency)));
}

// What answers an echo may still crash, hang or be mute in its calls when a case begins. How it is judged is
// a matter of `run`. A box at a real line moves real things: it is not asked for one.
void Doctor::try_a_case(const conformance::Assignment& one) {
  const std::vector<std::string> cases_of_role{fmt::format("{}/{}/**", role_.protocol, role_.role)};
  const std::vector<conformance::Entry> entries = session_.catalogue().select(cases_of_role);
  conformance::Setup setup;
  setup.implementations = {one};
  setup.volume = conformance::Volume::quick;
  const conformance::Entry& first = entries.front();
  const judge::CaseResult result = first.suite->run(*first.test_case, setup).result;
  say("a case", fmt::format("{}: {}{}{}", result.id, judge::name(result.verdict),
                            result.reason.empty() ? "" : ", ", result.reason));
  const bool misbehaves =
      result.reason.starts_with(kMisbehaves) && result.reason != iut::reasons::kUnsupported;
  if (result.verdict != judge::Verdict::error && !misbehaves) return;
  throw kernel::Error(
      kernel::ErrorKind::implementation,
      fmt::format("'{}' is not usable as {}/{}: it does not get through {} ({}){}{}",
                  kernel::escaped_line(one.uri), role_.protocol, role_.role, result.id, result.reason,
                  result.findings.empty() ? "" : ": ",
                  result.findings.empty() ? "" : kernel::escaped_line(result.findings.front().actual)));
}

void Doctor::examine(const conformance::Assignment& one) {
  const std::string& uri = one.uri;
  session_.terminal.print(fmt::format("{}\n", kernel::escaped_line(uri)));
  if (!is_attachment(uri)) {
    say("built in", "nothing is attached");
  } else if (uri.starts_with(iut::kSerialUri)) {
    examine_line(uri);
  } else if (is_in_process(uri)) {
    const auto device = library_of(uri, role_);
    say("library", fmt::format("loaded into this process, calls itself '{}'",
                               iut::own_name_of_plugin(plugin_path(uri))));
  } else {
    const auto pool = pool_of(uri, role_);
    examine_channel(*pool, "implementation");
  }
  if (!is_attachment(uri) || uri.starts_with(iut::kSerialUri)) return;
  say("role", fmt::format("{}/{}", role_.protocol, role_.role));
  try_a_case(one);
}

// Whose case it is that a real one would be asked for.
iut::RoleName role_of(const conformance::Assignment& assignment) {
  const bool is_at_line = assignment.uri.starts_with(iut::kSerialUri);
  for (const Role* role : roles()) {
    const bool is_meant =
        assignment.role.empty() ? !is_at_line || role->uart != nullptr : role->name == assignment.role;
    if (is_meant) return {std::string(role->protocol), std::string(role->name)};
  }
  throw kernel::Error(kernel::ErrorKind::usage,
                      fmt::format("'{}': no role '{}' can be attached", assignment.uri, assignment.role));
}

}  // namespace

int doctor(Session& session) {
  const auto implementations =
      parse_implementations(session.settings.list("iut"), session.catalogue(), session.catalogue().entries());
  Doctor(session, {}).examine_machine();
  for (const conformance::Assignment& one : implementations) {
    Doctor(session, role_of(one)).examine(one);
  }
  return kAllAsExpected;
}

}  // namespace fieldproof::cli
