#include "conformance/token_bus/station_sources.hpp"

#include <utility>

namespace fieldproof::conformance {

namespace token_sources {
judge::Reference paper(std::string place) {
  return {"Lee, Moon, Moon, Kwon, Lee and Park, token bus on IEEE 802.3", std::move(place),
          judge::Standing::seed};
}
judge::Reference standard(std::string place) {
  return {"IEEE 802.4", std::move(place), judge::Standing::sure};
}
judge::Reference controller(std::string place) {
  return {"MC68824 token bus controller, user's manual", std::move(place), judge::Standing::searched};
}
judge::Reference mib(std::string place) {
  return {"RFC 1230, IEEE 802.4 token bus MIB", std::move(place), judge::Standing::searched};
}
judge::Reference memory(std::string place) {
  return {"IEEE 802.4, from memory", std::move(place), judge::Standing::memory};
}
judge::Reference derived(std::string place) {
  return {"the paper's table of codes, and IEEE 802.3", std::move(place), judge::Standing::derived};
}
judge::Reference own(std::string place) {
  return {"this project's choice", std::move(place), judge::Standing::own};
}
}  // namespace token_sources

const std::vector<PartialSource>& token_details() {
  static const std::vector<PartialSource> details{
      {token_sources::paper("table of codes"), {"frame_malformed", "check_wrong"}},
      {token_sources::derived("preamble of a repeater of IEEE 802.3"), {"preamble_short"}},
      {token_sources::standard("a source is individual, and the station's own"), {"source_wrong"}},
      {token_sources::own("silence of IEEE 802.3 between transmissions"), {"begins_too_early"}},
      {token_sources::own("what goes on after something else"), {"does_not_recover"}},
      {token_sources::own("events"), {"reported_unfounded", "reported_twice"}},
  };
  return details;
}

}  // namespace fieldproof::conformance
