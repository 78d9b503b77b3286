#include "conformance/token_bus/dual_channel_row.hpp"

#include "conformance/bench_role.hpp"
#include "conformance/token_bus/dual_channel_cases.hpp"
#include "conformance/token_bus/dual_channel_mutants.hpp"
#include "conformance/token_bus/dual_channel_sequence.hpp"
#include "harness/field/pics.hpp"
#include "protocols/token_bus/attached_dual_channel.hpp"
#include "protocols/token_bus/dual_channel.hpp"
#include "protocols/token_bus/translator_dissector.hpp"

namespace fieldproof::conformance {

RoleRow channel_manager_row() {
  // Its sides are written as the MAC side of a translator is.
  using Cases = CaseRole<ManagerCase, ManagerSetting, token_bus::TranslatorDissector>;
  return row_of<token_bus::ChannelManagerRole, token_bus::ChannelManager>(
      {.what = "channel manager of the token bus", .mutants = channel_manager_mutants},
      Cases{.name = "channel_manager",
            .cases = manager_cases,
            .check = expect_judgeable_sides<ManagerCase, ManagerSetting>,
            .pics_items = [] { return field::pics_items_of(token_bus::kChannelManagerTable); },
            .usual_answers = [] { return field::declared_by(token_bus::kChannelManagerTable, {}); },
            .settings = &token_bus::kChannelManagerTable,
            .are_settings_declared = true,
            .sequences =
                SequenceRow<ManagerCase>{channel_manager_sequence_role, run_channel_manager_sequence}});
}

}  // namespace fieldproof::conformance
