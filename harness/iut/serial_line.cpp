#include "harness/iut/serial_line.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/serial.h>
#include <poll.h>
#include <pty.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/serial_port.hpp>
#include <system_error>

#include "harness/iut/misbehaviour.hpp"

namespace fieldproof::iut {
namespace {

using SerialPort = boost::asio::serial_port;

constexpr kernel::Duration kMostPatience = 2 * kernel::kSecond;  // of who writes, with one who takes nothing

[[noreturn]] void refuse_line(const std::string& path, const std::string& why) {
  throw kernel::Error(kernel::ErrorKind::implementation, fmt::format("serial:{}: {}", path, why));
}

std::string cause(int error) {
  return std::system_category().message(error);
}

// Devices of the majors 136 to 143 are the far ends of pseudo terminals.
bool is_pseudo_terminal(int descriptor) {
  struct stat state{};
  return ::fstat(descriptor, &state) == 0 && S_ISCHR(state.st_mode) && major(state.st_rdev) >= 136 &&
         major(state.st_rdev) <= 143;
}

// What <asm/termbits.h> calls termios2; it cannot be included beside <termios.h>.
struct FreeRate {
  std::uint32_t input, output, control, local;
  unsigned char discipline;
  std::array<unsigned char, 19> characters;
  std::uint32_t input_rate, output_rate;
};
constexpr auto kGetFreeRate = _IOR('T', 0x2A, FreeRate);
constexpr auto kSetFreeRate = _IOW('T', 0x2B, FreeRate);
constexpr std::uint32_t kRateMask = 0010017;  // CBAUD
constexpr std::uint32_t kAnyRate = 0010000;   // BOTHER
constexpr std::uint32_t kMarkOrSpace = 010000000000;

SerialPort::parity parity_option(line::Parity parity) {
  switch (parity) {
    case line::Parity::none:
      return SerialPort::parity(SerialPort::parity::none);
    case line::Parity::even:
    case line::Parity::space:
      return SerialPort::parity(SerialPort::parity::even);
    default:
      return SerialPort::parity(SerialPort::parity::odd);
  }
}

std::string set_direction(int descriptor) {
  serial_rs485 direction{};
  if (::ioctl(descriptor, TIOCGRS485, &direction) != 0) return "the driver offers no RS-485 direction";
  direction.flags |= SER_RS485_ENABLED | SER_RS485_RTS_ON_SEND;
  if (::ioctl(descriptor, TIOCSRS485, &direction) != 0) return "the driver refuses RS-485 direction";
  return "RS-485 direction by the driver";
}

}  // namespace

bool ask_for_real_time() {
  sched_param priority{};
  priority.sched_priority = 1;
  const int policy = SCHED_FIFO | SCHED_RESET_ON_FORK;
  return ::sched_setscheduler(0, policy, &priority) == 0;
}

struct SerialLine::Port {
  boost::asio::io_context context{1};
  SerialPort port{context};
};

SerialLine::SerialLine(const WallClock& clock) : clock_(clock), last_look_(clock.now()) {
  // Sleeps of this thread end when they should, not up to 50 us later.
  ::prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);
  ask_for_real_time();
}

SerialLine::SerialLine(const std::string& path, const WallClock& clock) : SerialLine(clock) {
  open_device(path);
}

SerialLine::SerialLine(SerialLine&& other) noexcept
    : clock_(other.clock_),
      port_(std::move(other.port_)),
      master_(std::move(other.master_)),
      slave_(std::move(other.slave_)),
      link_(std::exchange(other.link_, {})),
      path_(std::move(other.path_)),
      direction_(std::move(other.direction_)),
      is_terminal_(other.is_terminal_),
      character_(other.character_),
      step_(other.step_),
      last_look_(other.last_look_) {}

SerialLine::~SerialLine() {
  // A pseudo terminal outlives this end of it, and would keep the next one out.
  if (port_ != nullptr && port_->port.is_open()) ::ioctl(descriptor(), TIOCNXCL);
  if (!link_.empty()) ::unlink(link_.c_str());
}

void SerialLine::open_device(const std::string& path) {
  path_ = path;
  port_ = std::make_unique<Port>();
  boost::system::error_code error;
  if (port_->port.open(path, error)) refuse_line(path, fmt::format("cannot be opened: {}", error.message()));
  // Two who read one line get half of it each.
  if (::ioctl(descriptor(), TIOCEXCL) != 0) refuse_line(path, "cannot be taken for this program alone");
  const SerialPort::flow_control no_flow_control(SerialPort::flow_control::none);
  if (port_->port.set_option(no_flow_control, error)) {
    refuse_line(path, fmt::format("cannot be used without flow control: {}", error.message()));
  }
  ::fcntl(descriptor(), F_SETFL, ::fcntl(descriptor(), F_GETFL) | O_NONBLOCK);
  is_terminal_ = is_pseudo_terminal(descriptor());
  direction_ = is_terminal_ ? "a pseudo terminal has no direction" : set_direction(descriptor());
}

SerialLine SerialLine::at_new_terminal(const std::string& link, const WallClock& clock) {
  SerialLine line(clock);
  std::array<char, 128> name{};
  int master = -1;
  int slave = -1;
  if (::openpty(&master, &slave, name.data(), nullptr, nullptr) != 0)
    refuse_line(link, fmt::format("no pseudo terminal can be made: {}", cause(errno)));
  line.master_ = Descriptor(master);
  line.slave_ = Descriptor(slave);
  termios raw{};
  ::tcgetattr(slave, &raw);
  ::cfmakeraw(&raw);
  ::tcsetattr(slave, TCSANOW, &raw);
  for (const int end : {master, slave}) ::fcntl(end, F_SETFD, FD_CLOEXEC);
  ::fcntl(master, F_SETFL, O_NONBLOCK);
  // One that was killed has left its name behind.
  struct stat before{};
  if (::lstat(link.c_str(), &before) == 0 && S_ISLNK(before.st_mode)) ::unlink(link.c_str());
  if (::symlink(name.data(), link.c_str()) != 0)
    refuse_line(link, fmt::format("no pseudo terminal can be found there: {}", cause(errno)));
  line.link_ = link;
  line.path_ = link;
  line.is_terminal_ = true;
  line.direction_ = "a pseudo terminal has no direction";
  return line;
}

int SerialLine::descriptor() const {
  return port_ ? port_->port.native_handle() : master_.number();
}

void SerialLine::set_clock(const WallClock& clock) {
  clock_ = clock;
  last_look_ = clock.now();
}

void SerialLine::set(std::int64_t bit_rate, const line::CharacterFormat& format) {
  character_ = kernel::levels_duration(format.half_bits(), 2 * bit_rate);
  if (is_terminal_) return;  // it has none of these
  SerialPort& port = port_->port;
  using Stop = SerialPort::stop_bits;
  const bool is_mark_or_space = format.parity == line::Parity::mark || format.parity == line::Parity::space;
  boost::system::error_code error;
  const auto must = [&](const auto& option, const char* what) {
    if (port.set_option(option, error))
      refuse_line(path_, fmt::format("does not take the {} of {}", what, format.text()));
  };
  must(SerialPort::character_size(format.data_bits), "data bits");
  must(parity_option(format.parity), "parity");
  must(Stop(format.stop_bits == line::StopBits::one ? Stop::one : Stop::two), "stop bits");
  set_rate(bit_rate, is_mark_or_space);
}

// The bit rates of POSIX are not all that there are: a UART divides its clock by any number.
void SerialLine::set_rate(std::int64_t bit_rate, bool is_mark_or_space) const {
  FreeRate rate{};
  const auto wanted = static_cast<std::uint32_t>(bit_rate);
  bool is_set = ::ioctl(descriptor(), kGetFreeRate, &rate) == 0;
  rate.control =
      (rate.control & ~(kRateMask | kMarkOrSpace)) | kAnyRate | (is_mark_or_space ? kMarkOrSpace : 0);
  rate.input_rate = rate.output_rate = wanted;
  is_set = is_set && ::ioctl(descriptor(), kSetFreeRate, &rate) == 0 &&
           ::ioctl(descriptor(), kGetFreeRate, &rate) == 0;
  if (!is_set) refuse_line(path_, fmt::format("does not take {} bit/s: {}", bit_rate, cause(errno)));
  constexpr double kTolerance = 0.02;  // what a receiver can live with
  const double off = static_cast<double>(rate.output_rate) / static_cast<double>(wanted) - 1;
  if (off > kTolerance || off < -kTolerance)
    refuse_line(path_, fmt::format("makes {} bit/s of {} bit/s", rate.output_rate, bit_rate));
}

// Until one of the events, or something at `also`; false when it is that.
bool SerialLine::wait(kernel::Duration longest, short events, int also) const {
  std::array<pollfd, 2> waits{{{descriptor(), events, 0}, {also, POLLIN, 0}}};
  const timespec time = WallClock::wait_of(longest);
  return ::ppoll(waits.data(), waits.size(), &time, nullptr) <= 0 || waits[1].revents == 0;
}

void SerialLine::wait_until_sent() const {
  constexpr unsigned kEmpty = 1;  // TIOCSER_TEMT
  unsigned state = 0;
  while (::ioctl(descriptor(), TIOCSERGETLSR, &state) == 0) {
    if ((state & kEmpty) != 0) return;
    wait(10 * kernel::kMicrosecond, 0);
  }
  ::tcdrain(descriptor());
}

Stamp SerialLine::write(std::span<const std::uint8_t> octets) {
  const kernel::Time begin = clock_.now();
  const auto length = static_cast<std::int64_t>(octets.size()) * character_;
  if (receives_own_echo_) echo_.insert(echo_.end(), octets.begin(), octets.end());
  while (!octets.empty()) {
    const ssize_t sent = ::write(descriptor(), octets.data(), octets.size());
    if (sent > 0) {
      octets = octets.subspan(static_cast<std::size_t>(sent));
      continue;
    }
    if (sent < 0 && errno != EAGAIN && errno != EINTR) blame_gone("takes nothing any more", errno);
    if (clock_.now() - begin > kMostPatience + length) {
      throw Misbehaviour(reasons::kHangs, fmt::format("serial:{} does not take what it is sent within {}",
                                                      path_, kernel::describe(kMostPatience)));
    }
    wait(kernel::kMillisecond, POLLOUT);
  }
  if (is_terminal_) return {begin, clock_.now()};
  wait_until_sent();
  return {begin + length, std::max(begin + length, clock_.now())};
}

std::optional<Arrival> SerialLine::read(kernel::Time until, int also) {
  std::array<std::uint8_t, 4096> part{};
  while (true) {
    const kernel::Time look = clock_.now();
    const ssize_t count = ::read(descriptor(), part.data(), part.size());
    if (count > 0) {
      Arrival arrival{{last_look_, clock_.now()}, {part.begin(), part.begin() + count}};
      last_look_ = look;
      take_echo(arrival.octets);
      if (arrival.octets.empty()) continue;
      return arrival;
    }
    // Nobody has the other end of a terminal that was made here before the first one opens it.
    if (count == 0) blame_gone("has been hung up", 0);
    if (errno != EAGAIN && errno != EINTR) blame_gone("has gone", errno);
    last_look_ = look;
    if (look >= until || !wait(std::min(until - look, step_), POLLIN, also)) return std::nullopt;
  }
}

void SerialLine::take_echo(std::vector<std::uint8_t>& octets) {
  const std::size_t count = std::min(echo_.size(), octets.size());
  for (std::size_t n = 0; n < count; ++n) {
    if (octets[n] == echo_[n]) continue;
    throw Misbehaviour(
        reasons::kGarbage,
        fmt::format("serial:{} was sent {:02X} and {:02X} came back: somebody drove the line at the "
                    "same time, or the adapter has no echo",
                    path_, echo_[n], octets[n]));
  }
  echo_.erase(echo_.begin(), echo_.begin() + static_cast<std::ptrdiff_t>(count));
  octets.erase(octets.begin(), octets.begin() + static_cast<std::ptrdiff_t>(count));
}

void SerialLine::forget_arrived() {
  echo_.clear();
  // Bounded: one who sends without end is heard by the case.
  for (int n = 0; n < 16 && read(kernel::kStart); ++n) {
  }
}

void SerialLine::blame_gone(const char* what, int error) const {
  throw Misbehaviour(reasons::kGone, error == 0 ? fmt::format("serial:{} {}", path_, what)
                                                : fmt::format("serial:{} {}: {}", path_, what, cause(error)));
}

bool can_be_read(int descriptor) {
  pollfd wait{descriptor, POLLIN, 0};
  return ::poll(&wait, 1, 0) > 0;
}

kernel::Duration measured_latency(unsigned rounds) {
  ask_for_real_time();  // as the line will be read
  const WallClock clock;
  std::array<int, 2> ends{-1, -1};
  if (::openpty(&ends[0], &ends[1], nullptr, nullptr, nullptr) != 0) return kernel::kMillisecond;
  const Descriptor master(ends[0]);
  const Descriptor slave(ends[1]);
  termios raw{};
  ::tcgetattr(slave.number(), &raw);
  ::cfmakeraw(&raw);
  ::tcsetattr(slave.number(), TCSANOW, &raw);
  kernel::Duration worst{};
  for (unsigned n = 0; n < rounds; ++n) {
    std::uint8_t octet = 0x55;
    const kernel::Time begin = clock.now();
    pollfd wait{slave.number(), POLLIN, 0};
    if (::write(master.number(), &octet, 1) != 1 || ::poll(&wait, 1, 1'000) != 1) break;
    worst = std::max(worst, clock.now() - begin);
    if (::read(slave.number(), &octet, 1) != 1) break;
  }
  return worst;
}

}  // namespace fieldproof::iut
