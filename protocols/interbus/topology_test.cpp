#include "protocols/interbus/topology.hpp"

#include <gtest/gtest.h>

#include "protocols/interbus/network.hpp"

namespace fieldproof::interbus {
namespace {

struct ByTheTable : TopologyDecisions {
  explicit ByTheTable(const Rules& table) : rules(table) {}
  std::optional<unsigned> words_of(std::uint16_t id) const override { return words_of_id_code(id, rules); }
  bool searches_branches() const override { return true; }
  const Rules& rules;
};

// A ring that follows the control words; answers with the ID codes of the stations that they make reachable.
std::vector<std::uint16_t> answer(const std::vector<FoundStation>& ring,
                                  const std::vector<std::uint16_t>& off, std::vector<std::size_t>& active) {
  const Rules rules;
  active.clear();
  std::vector<bool> in(ring.size());
  std::vector<std::uint16_t> ids;
  for (std::size_t n = 0; n < ring.size(); ++n) {
    if (ring[n].before >= 0) {
      const auto before = static_cast<std::size_t>(ring[n].before);
      if (!in[before]) continue;
      if ((off[before] & (ring[n].on_branch ? rules.control_local_off : rules.control_remote_off)) != 0)
        continue;
    }
    in[n] = true;
    active.push_back(n);
    ids.push_back(ring[n].id_code);
  }
  return ids;
}

// Gives the number of ID cycles.
int recognise(Topology& topology, const std::vector<FoundStation>& ring) {
  std::vector<std::uint16_t> off(ring.size(), 3);
  std::vector<std::size_t> active;
  int cycles = 0;
  while (!topology.is_finished() && cycles < 10'000) {
    const std::vector<std::uint16_t> control(topology.control_words().begin(),
                                             topology.control_words().end());
    topology.on_ids(answer(ring, off, active));
    ++cycles;
    // What the cycle carried takes effect at its end.
    for (std::size_t n = 0; n < active.size(); ++n) {
      off[active[n]] = n < control.size() ? control[n] : topology.pad_word();
    }
  }
  return cycles;
}

TEST(Topology, finds_a_tree_in_the_order_of_the_ring) {
  const Rules rules;
  const ByTheTable decisions(rules);
  const std::vector<FoundStation> ring = {
      {0x0008, 0, -1, false}, {0x01BE, 1, 0, true}, {0x0E7F, 6, 1, false}, {0x0103, 1, 0, false},
      {0x0008, 0, 3, false},  {0x0004, 0, 4, true}, {0x0203, 2, 5, true},  {0x0603, 8, 4, false}};
  Topology topology(rules, decisions);
  EXPECT_EQ(recognise(topology, ring), 1 + 4 * 8);
  EXPECT_EQ(topology.error(), "");
  EXPECT_EQ(topology.stations(), ring);
  EXPECT_EQ(topology.words(), 18U);
}

TEST(Topology, takes_exactly_the_limits) {
  Rules rules;
  rules.max_stations = 4;
  rules.max_io_points = 64;
  rules.max_levels = 2;
  const ByTheTable decisions(rules);
  const std::vector<FoundStation> all = {
      {0x0103, 1, -1, false}, {0x0103, 1, 0, true}, {0x0103, 1, 1, false}, {0x0103, 1, 2, false}};
  Topology topology(rules, decisions);
  recognise(topology, all);
  EXPECT_EQ(topology.error(), "");
  EXPECT_EQ(topology.stations(), all);

  struct Bad {
    FoundStation last;
    const char* part;
  };
  for (const Bad& bad : {Bad{{0x0003, 0, 3, false}, "more than 4 stations"}}) {
    std::vector<FoundStation> ring = all;
    ring.push_back(bad.last);
    topology.restart();
    recognise(topology, ring);
    EXPECT_NE(topology.error().find(bad.part), std::string::npos) << topology.error();
  }
  for (const Bad& bad :
       {Bad{{0x0203, 2, 2, false}, "more than 64 I/O points"}, Bad{{0x0103, 1, 2, true}, "on level 3"},
        Bad{{0x0803, 0, 2, false}, "undefined length code 08h"}}) {
    std::vector<FoundStation> ring = all;
    ring.back() = bad.last;
    topology.restart();
    recognise(topology, ring);
    EXPECT_NE(topology.error().find(bad.part), std::string::npos) << topology.error();
  }
}

TEST(Topology, refuses_a_ring_that_grows_by_two_or_shrinks) {
  const Rules rules;
  const ByTheTable decisions(rules);
  Topology topology(rules, decisions);
  topology.on_ids(std::vector<std::uint16_t>{0x0103, 0x0103});
  EXPECT_NE(topology.error(), "");
  topology.restart();
  topology.on_ids(std::vector<std::uint16_t>{0x0103});
  EXPECT_EQ(topology.error(), "");
  topology.on_ids({});
  EXPECT_NE(topology.error(), "");
}

TEST(Topology, finishes_without_stations_when_there_is_none) {
  const Rules rules;
  const ByTheTable decisions(rules);
  Topology topology(rules, decisions);
  topology.on_ids({});
  EXPECT_TRUE(topology.stations().empty());
  EXPECT_EQ(topology.error(), "");
}

}  // namespace
}  // namespace fieldproof::interbus
