#include "conformance/fieldbus_dll/link_sources.hpp"

#include <utility>

namespace fieldproof::conformance {

namespace link_sources {
judge::Reference isa_paper(std::string place) {
  return {"Hong, Kim, Kim and Ko, distributed control and the fieldbus", std::move(place),
          judge::Standing::seed};
}
judge::Reference ff_paper(std::string place) {
  return {"Hong and Son, delay of urgent data in the Foundation Fieldbus", std::move(place),
          judge::Standing::seed};
}
judge::Reference line(std::string place) {
  return {"IEC 61158-2, as the open implementation nanoFIP has it", std::move(place),
          judge::Standing::searched};
}
judge::Reference vendors(std::string place) {
  return {"vendors' tables of link parameters", std::move(place), judge::Standing::searched};
}
judge::Reference memory(std::string place) {
  return {"IEC 61158, from memory", std::move(place), judge::Standing::memory};
}
judge::Reference calculated(std::string place) {
  return {"computed from the rules of the token", std::move(place), judge::Standing::calc};
}
judge::Reference own(std::string place) {
  return {"this project's choice", std::move(place), judge::Standing::own};
}
}  // namespace link_sources

const std::vector<PartialSource>& isa_details() {
  using link_sources::line;
  using link_sources::own;
  using link_sources::vendors;
  static const std::vector<PartialSource> details{
      {line("preamble and delimiters"), {"frame_malformed", "check_wrong"}},
      {vendors("V(MID): silence after every DLPDU"), {"gap_too_short", "answers_too_early"}},
      {own("who is silent for V(RR) says nothing any more"), {"answers_too_late", "next_too_late"}},
      {own("encoding of the profile ISA-D"),
       {"dlpdu_wrong", "source_wrong", "end_reason_wrong", "unexpected_dlpdu"}},
      {own("EE after a single frame, too"), {"token_not_returned"}},
  };
  return details;
}

const std::vector<PartialSource>& ff_details() {
  using link_sources::line;
  using link_sources::memory;
  using link_sources::own;
  using link_sources::vendors;
  static const std::vector<PartialSource> details{
      {line("preamble and delimiters"), {"frame_malformed", "check_wrong"}},
      {vendors("V(MID): silence after every DLPDU"), {"gap_too_short", "answers_too_early"}},
      {memory("V(MRD) x V(ST): until then an answer has begun"), {"answers_too_late"}},
      {memory("octets of the DLPDUs"), {"dlpdu_wrong", "unexpected_dlpdu"}},
      {own("what is answered after something else"), {"does_not_recover"}},
  };
  return details;
}

}  // namespace fieldproof::conformance
