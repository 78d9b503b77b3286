#pragma once

#include <string>

#include "protocols/token_bus/attached_sides.hpp"
#include "protocols/token_bus/translator_settings.hpp"

// A translator between the bench and an implementation outside, in both directions: port 0 is the physical
// side, port 1 the MAC side. It is given the settings of translator_settings, and writes and reads nothing.
namespace fieldproof::token_bus {

class AttachedTranslator final : public AttachedSides<TranslatorDevice> {
 public:
  AttachedTranslator(iut::Attachment attachment, const TranslatorConfiguration& configuration,
                     const std::string& case_id, std::uint64_t seed);

  void wire(segment::Port& phy, segment::Port& mac) override { wire_ports({&phy, &mac}); }
};

class ServedTranslator final : public ServedSides<TranslatorDevice, TranslatorConfiguration> {
 public:
  using ServedSides::ServedSides;

  bool begin(const iut::CaseBegin& begin, iut::Bench& bench) override;
};

// The role as benches and attachments know it.
struct TranslatorRole {
  using Device = TranslatorDevice;
  using Configuration = TranslatorConfiguration;
  using Attached = AttachedTranslator;
  using Served = ServedTranslator;
  static constexpr const char* protocol = "token_bus";
  static constexpr const char* role = "translator";
};

}  // namespace fieldproof::token_bus
