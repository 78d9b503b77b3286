#include "protocols/bandwidth/window_server.hpp"

namespace fieldproof::bandwidth {

const char* name_of(Packet packet) {
  switch (packet) {
    case Packet::none:
      return "nothing";
    case Packet::real_time:
      return "real-time";
    case Packet::periodic:
      return "periodic";
    case Packet::non_real_time:
      return "non-real-time";
  }
  return "";
}

}  // namespace fieldproof::bandwidth
