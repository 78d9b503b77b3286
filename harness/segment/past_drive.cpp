#include "harness/segment/past_drive.hpp"

#include <fmt/format.h>

#include "harness/kernel/error.hpp"

namespace fieldproof::segment {

void refuse_past_drive(const std::string& line, kernel::Time start, kernel::Time now) {
  throw kernel::Error(kernel::ErrorKind::implementation,
                      fmt::format("{} is driven at {} when it is {} already; a station drives now or later",
                                  line, kernel::describe(start), kernel::describe(now)));
}

}  // namespace fieldproof::segment
