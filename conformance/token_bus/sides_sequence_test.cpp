// Subject: `check` of a translator and of a channel manager.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>

#include "conformance/sequence_check.hpp"
#include "conformance/token_bus/dual_channel_sequence.hpp"
#include "conformance/token_bus/suite.hpp"
#include "conformance/token_bus/translator_sequence.hpp"
#include "harness/kernel/sanitized.hpp"
#include "protocols/token_bus/attached_dual_channel.hpp"
#include "protocols/token_bus/attached_translator.hpp"
#include "protocols/token_bus/dual_channel.hpp"
#include "protocols/token_bus/translator.hpp"

namespace fieldproof::conformance {
namespace {

constexpr const char* kQuick = "quick";

// As quick as may be declared: later or earlier within the delay is nobody's mistake.
template <typename Served, typename Reference>
iut::Attachment quick_attachment() {
  const auto device = std::make_shared<Served>([](auto configuration) {
    configuration.delay_symbols = std::min(configuration.delay_symbols, 3U);
    return std::make_unique<Reference>(configuration);
  });
  return {device.get(), device, {}};
}

const Suite& sides_suite() {
  static const std::unique_ptr<Suite> suite = [] {
    SuiteGiven given;
    given.attach = [](const iut::RoleName& role,
                      const IutRequest& request) -> std::optional<iut::Attachment> {
      if (request.uri != kQuick) return std::nullopt;
      if (role.role == "translator")
        return quick_attachment<token_bus::ServedTranslator, token_bus::Translator>();
      return quick_attachment<token_bus::ServedChannelManager, token_bus::ChannelManager>();
    };
    return token_bus_suite(given);
  }();
  return *suite;
}

struct SidesRole {
  const char* name;
  const SequenceRole& (*role)();
};
constexpr std::array kSidesRoles{SidesRole{"translator", translator_sequence_role},
                                 SidesRole{"channel_manager", channel_manager_sequence_role}};

SequenceSearchResult searched_sides(const SidesRole& role, const std::string& uri, std::uint64_t cases) {
  SequenceSearch one;
  one.suite = &sides_suite();
  one.role = &role.role();
  one.setup.implementations = {{role.name, 0, uri}};
  one.cases = kernel::kIsSanitized ? cases / 5 : cases;
  return search(one);
}

constexpr std::uint64_t kDrawn = kernel::kIsSanitized ? 100 : 300;

TEST(SidesSequence, NeitherTheReferenceNorAQuickOneIsAccused) {
  for (const SidesRole& role : kSidesRoles) {
    for (const char* uri : {"ref", kQuick}) {
      const SequenceSearchResult result = searched_sides(role, uri, kDrawn);
      EXPECT_FALSE(result.found.has_value()) << role.name << " " << uri << ": " << result.found->first.reason
                                             << result.found->first.findings.front().actual
                                             << sequence_json(result.found->smallest, role.role().vocabulary);
      EXPECT_EQ(result.passed, kernel::kIsSanitized ? kDrawn / 5 : kDrawn) << role.name << " " << uri;
    }
  }
}

TEST(SidesSequence, FindsEachMutantForCheckWithFewCommands) {
  unsigned found = 0;
  kernel::FewerIfSanitized few(3);
  for (const SidesRole& role : kSidesRoles) {
    for (const Mutant& mutant : sides_suite().mutants()) {
      if (!mutant.is_for_check || mutant.role != role.name || few.leaves_out()) continue;
      const SequenceSearchResult result = searched_sides(role, "mutant:" + mutant.name, 2'000);
      ASSERT_TRUE(result.found) << mutant.name;
      EXPECT_TRUE(result.found->is_confirmed) << mutant.name;
      EXPECT_GE(result.found->smallest.commands.size(), 2U) << mutant.name;
      EXPECT_LE(result.found->smallest.commands.size(), 5U) << mutant.name;
      ++found;
    }
  }
  EXPECT_EQ(found, kernel::kIsSanitized ? 1U : 3U);
}

}  // namespace
}  // namespace fieldproof::conformance
