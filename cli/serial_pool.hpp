#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "harness/iut/pool.hpp"
#include "harness/iut/serial_line.hpp"
#include "harness/iut/wall_clock_device.hpp"

// The serial lines of a run, by URI, with the channels of their upper testers. A line serves one case at a
// time: others wait for it, however many run side by side.
namespace fieldproof::cli {

class SerialPool {
 public:
  SerialPool(iut::RoleName role, iut::MakeUartLine make_uart)
      : role_(std::move(role)), make_uart_(make_uart) {}

  // Opens what is not open yet: first the upper channel, which may be what makes the line. Throws
  // kernel::Error(implementation) for one that cannot be used.
  iut::Attachment take(const std::string& uri, const iut::PeerLimits& limits);

 private:
  struct Box {
    std::mutex in_use;
    iut::SerialSettings settings;
    std::unique_ptr<iut::SerialLine> line;
    std::unique_ptr<iut::DevicePool> upper;
    kernel::Duration latency{};
  };
  struct Use;

  Box& box(const std::string& uri, const iut::PeerLimits& limits);

  iut::RoleName role_;
  iut::MakeUartLine make_uart_;
  std::mutex mutex_;
  std::map<std::string, std::unique_ptr<Box>> boxes_;
};

}  // namespace fieldproof::cli
