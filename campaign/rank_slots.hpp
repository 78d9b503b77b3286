// Slots that are ranks of mpirun: rank 0 distributes and runs jobs itself, the others run what they are
// given.
//
// Contract: each rank says first which host it is on and which program it runs; one that runs another program
// is refused (its results would be those of another suite). What goes wrong on a rank is told with its host.
// Whatever ends rank 0 in good order ends the others, too; when a rank is killed, mpirun ends all.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "campaign/local_slots.hpp"
#include "campaign/ranks.hpp"

namespace fieldproof::campaign {

class RankSlots final : public Slots {
 public:
  // `program` is what all ranks must be: version and build.
  RankSlots(Ranks& ranks, std::size_t slots_of_each, std::string program);
  ~RankSlots() override;

  std::size_t free() const override;
  void give(const Job& job) override;
  std::vector<JobResult> wait(std::chrono::milliseconds longest) override;
  void abandon() override;

 private:
  struct Other {
    std::string host;  // empty: it has not come yet
    std::size_t running = 0;
  };
  void on_message(int from, const std::string& message, std::vector<JobResult>& ended);
  bool take_messages(std::vector<JobResult>& ended);

  Ranks& ranks_;
  std::size_t slots_of_each_;
  std::string program_;
  LocalSlots own_;
  std::vector<Other> others_;  // rank 1, 2 ...
  bool is_abandoned_ = false;
};

// What the ranks but 0 do until rank 0 says that it is the end.
void serve_as_rank(Ranks& ranks, std::size_t slots, const std::string& program);

}  // namespace fieldproof::campaign
