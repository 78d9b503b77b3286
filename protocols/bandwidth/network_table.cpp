// The numbers of a network file: the paper gives the quantities and no values, so ranges and defaults are
// this project's choice.
#include <array>

#include "protocols/bandwidth/network.hpp"

namespace fieldproof::bandwidth {
namespace {

using field::between;
using field::Choice;
using field::item;
using field::kTime;
using field::row;
using judge::Standing;
using kernel::Duration;

constexpr std::string_view kPaper = "S.-H. Hong and others, distributed control and fieldbus, section 5";
constexpr std::string_view kOwn = "this project's choice";
constexpr auto kPacket = between(kernel::kMicrosecond, kernel::kSecond);
constexpr auto kPacketOrNone = between(Duration::zero(), kernel::kSecond);
constexpr field::Range kNode{0, kMostNodes - 1};

constexpr std::array kAccess{
    Choice{"token", 0, "nodes pass the server to each other"},
    Choice{"polling", 1, "a master sends it to each node, which answers"},
};
constexpr std::array kRules{
    Choice{"hong", 0, "2 T_i + T_1 <= bound"},
    Choice{"sharp", 1, "T_i + 2 T_1 <= bound"},
};
constexpr std::array kLengthRules{
    Choice{"printed", 0, "N - gamma + 1 packets, as the paper has it"},
    Choice{"safe", 1, "the least over each number of data that a slot has"},
};

constexpr auto kLoopRows = field::rows<LoopDescription>(
    row<&LoopDescription::bound>({kTime, between(3 * kernel::kMicrosecond, 1'000 * kernel::kSecond),
                                  "from a sample until the actuator has got what came of it, at most", kPaper,
                                  Standing::seed}),
    row<&LoopDescription::sensor>({{}, kNode, "node of the sensor", kPaper, Standing::seed}),
    row<&LoopDescription::controller>({{}, kNode, "node of the controller", kPaper, Standing::seed}),
    row<&LoopDescription::skew>({kTime, between(Duration::zero(), 1'000 * kernel::kSecond),
                                 "how late the controller samples, after the grid of the slots", kOwn,
                                 Standing::own}));
constexpr field::Table<LoopDescription> kLoopTable = field::table<LoopDescription>(kLoopRows);

constexpr auto kQueueRows = field::rows<QueueDescription>(
    row<&QueueDescription::first>({{}, kNode, "first node with such a queue", kPaper, Standing::seed}),
    row<&QueueDescription::last>({{}, kNode, "last node with such a queue", kPaper, Standing::seed}),
    row<&QueueDescription::mean_gap>({kTime, between(Duration::zero(), 1'000 * kernel::kSecond),
                                      "between packets that arrive at each of them; 0: not known", kPaper,
                                      Standing::seed}));
constexpr field::Table<QueueDescription> kQueueTable = field::table<QueueDescription>(kQueueRows);

constexpr auto kRows = field::rows<Network>(
    field::internal<&Network::name>(),
    row<&Network::access>({{}, {}, "how the server comes to the nodes", kPaper, Standing::seed, kAccess}),
    row<&Network::rule>({{}, {}, "how long a sampling period may be", kPaper, Standing::derived, kRules}),
    row<&Network::length_rule>(
        {{}, {}, "how long a non-real-time packet may be", kPaper, Standing::derived, kLengthRules}),
    row<&Network::nodes>(
        {{}, {2, kMostNodes}, "that the server visits, 0 to nodes - 1", kPaper, Standing::seed}),
    row<&Network::server_overhead>(
        {kTime, kPacket, "of the server at a node (sigma)", kPaper, Standing::seed}),
    row<&Network::empty_answer>({kTime, kPacketOrNone,
                                 "of a node that is polled and has nothing to send; part of sigma in bounds",
                                 kOwn, Standing::own}),
    row<&Network::periodic_packet>({kTime, kPacket, "of a sample or an order (L_p)", kPaper, Standing::seed}),
    row<&Network::real_time_packet>(
        {kTime, kPacket, "of an alarm or an event (L_c)", kPaper, Standing::seed}),
    row<&Network::non_real_time_packet>({kTime, kPacketOrNone,
                                         "of a piece of a file or a message (L_n); 0: the longest that the "
                                         "rule allows",
                                         kPaper, Standing::seed}),
    field::list<&Network::loops>(kLoopTable, kMostLoops, {{}, {}, "control loops", kPaper, Standing::seed},
                                 1),
    field::list<&Network::real_time>(kQueueTable, kMostNodes,
                                     {{}, {}, "nodes with a real-time queue", kPaper, Standing::seed}),
    field::list<&Network::non_real_time>(
        kQueueTable, kMostNodes, {{}, {}, "nodes with a non-real-time queue", kPaper, Standing::seed}));
constexpr field::Table<Network> kTable = field::table<Network>(kRows);

}  // namespace

const field::Table<Network>& kNetworkTable = kTable;

}  // namespace fieldproof::bandwidth
