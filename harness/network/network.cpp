#include "harness/network/network.hpp"

namespace fieldproof::network {

std::string_view name(Outcome outcome) {
  switch (outcome) {
    case Outcome::served:
      return "served";
    case Outcome::rejected:
      return "rejected";
    case Outcome::missing:
      return "missing";
  }
  return "";
}

}  // namespace fieldproof::network
