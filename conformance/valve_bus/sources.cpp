#include "conformance/valve_bus/sources.hpp"

#include <utility>

namespace fieldproof::conformance {

namespace valve_sources {
judge::Reference paper(std::string place) {
  return {"Kim, Seo and Lee, pneumatic control by fieldbus", std::move(place), judge::Standing::seed};
}
judge::Reference calculated(std::string place) {
  return {"computed from the block check", std::move(place), judge::Standing::calc};
}
judge::Reference own(std::string place) {
  return {"this project's choice", std::move(place), judge::Standing::own};
}
judge::Reference derived(std::string place) {
  return {"follows from Kim, Seo and Lee", std::move(place), judge::Standing::derived};
}
}  // namespace valve_sources

const std::vector<PartialSource>& node_details() {
  using valve_sources::own;
  static const std::vector<PartialSource> details{
      {own("turnaround from 3.5 characters to 2 ms more"), {"answer_too_early", "answer_too_late"}},
      {own("driver times"), {"driver_on_late", "driver_not_released"}},
      {own("silence inside a frame"), {"gap_in_answer"}},
      {own("character formats"), {"answer_garbled", "ninth_bit_wrong"}},
      {own("which switch has which bit"), {"answer_data_wrong"}},
      {own("order of the bits; DATA1 is the second board"), {"valves_wrong"}},
      {own("2 ms after the delimiter"), {"valves_too_late"}},
      {own("together means within 1 us"), {"valves_one_by_one"}},
      {own("a write is not answered"), {"write_answered"}},
      {own("after 3.5 characters of silence, or power-up, a node serves whatever came before"),
       {"does_not_recover"}},
  };
  return details;
}

const std::vector<PartialSource>& host_details() {
  using valve_sources::own;
  static const std::vector<PartialSource> details{
      {own("silence inside a frame and in front of it"), {"gap_in_frame", "no_delimiter"}},
      {own("driver times"), {"driver_on_late", "driver_released_early", "driver_not_released"}},
      {own("character formats"), {"frame_garbled", "ninth_bit_wrong"}},
      {own("a read that failed is repeated twice"), {"no_retry"}},
      {own("what is reported to the PC of a read"),
       {"told_as_old", "told_twice", "error_not_told", "error_wrong", "old_data_not_told", "old_data_wrong",
        "old_data_told_as_new"}},
      {own("how long a host may wait before it sends or reports"), {"no_request", "response_not_told"}},
      {own("silence of 3.5 characters ends a frame, whatever came before it"), {"does_not_recover"}},
  };
  return details;
}

}  // namespace fieldproof::conformance
