#include "protocols/fieldbus_dll/link_rules.hpp"

namespace fieldproof::fieldbus_dll {

std::string_view text_of(Priority priority) {
  switch (priority) {
    case Priority::time_available:
      return "time-available";
    case Priority::normal:
      return "normal";
    case Priority::urgent:
      return "urgent";
  }
  return "";
}

}  // namespace fieldproof::fieldbus_dll
