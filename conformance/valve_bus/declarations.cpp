#include "conformance/valve_bus/declarations.hpp"

#include "harness/field/pics.hpp"
#include "protocols/valve_bus/host_settings.hpp"
#include "protocols/valve_bus/node_settings.hpp"

namespace fieldproof::conformance {
namespace {

using field::part;
using field::row;

constexpr std::string_view kBench = "what the bench can do";
constexpr field::Range kStartUp = field::between({}, 10 * kernel::kSecond);

constexpr auto kNodeRows = field::rows<NodeDeclaration>(
    part<&NodeDeclaration::configuration>(valve_bus::kNodeTable),
    row<&NodeDeclaration::address_switches_can_be_set>(
        {{}, {}, "the bench can give the node another address", kBench}),
    row<&NodeDeclaration::start_up_time>(
        {field::kTime, kStartUp, "from power-up to where the node receives", kBench}),
    row<&NodeDeclaration::power_can_be_switched>(
        {{}, {}, "the bench can switch the supply of the station", kBench}));
constexpr auto kNode = field::table<NodeDeclaration>(kNodeRows);

constexpr auto kHostRows =
    field::rows<HostDeclaration>(part<&HostDeclaration::configuration>(valve_bus::kHostTable),
                                 row<&HostDeclaration::dip_can_be_set>(
                                     {{}, {}, "the bench can turn the DIP switches of the host", kBench}),
                                 row<&HostDeclaration::takes_early_responses>(
                                     {{}, {}, "a response within 10 bits of its request is taken", kBench}),
                                 row<&HostDeclaration::power_can_be_switched>(
                                     {{}, {}, "the bench can switch the supply of the station", kBench}));
constexpr auto kHost = field::table<HostDeclaration>(kHostRows);

}  // namespace

std::vector<judge::PicsItem> node_pics_items() {
  return field::pics_items_of(kNode);
}
judge::Pics declared_node() {
  return field::declared_by(kNode, NodeDeclaration{});
}
NodeDeclaration node_declared_in(const judge::Pics& pics) {
  return field::declared_in(kNode, pics);
}

std::vector<judge::PicsItem> host_pics_items() {
  return field::pics_items_of(kHost);
}
judge::Pics declared_host() {
  return field::declared_by(kHost, HostDeclaration{});
}
HostDeclaration host_declared_in(const judge::Pics& pics) {
  return field::declared_in(kHost, pics);
}

}  // namespace fieldproof::conformance
