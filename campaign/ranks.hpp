// The ranks of mpirun: who of them this process is, and messages between them.
//
// Contract: MPI is loaded only where mpirun started this program (it sets OMPI_COMM_WORLD_SIZE), so nobody
// else pays for it or needs it. Messages between two ranks keep their order. One object at a time, used by
// one thread.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

struct fieldproof_ranks;

namespace fieldproof::campaign {

class Ranks {
 public:
  // Nothing where this is no rank. Throws kernel::Error(usage) where it is one of several, and this program
  // has no MPI, or MPI cannot be loaded. The module lies beside `program`, or in lib/fieldproof of its
  // prefix.
  static std::unique_ptr<Ranks> of_this_process(const std::filesystem::path& program);

  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;
  ~Ranks();  // waits for all others to come to their end

  int rank() const { return rank_; }
  int count() const { return count_; }
  // At most 2^31 - 1 octets.
  void send(int to, std::string_view message);
  // The next message and who sent it, if there is one.
  std::optional<std::pair<int, std::string>> receive();

 private:
  explicit Ranks(const fieldproof_ranks& module);

  const fieldproof_ranks& module_;
  int rank_ = 0;
  int count_ = 1;
};

}  // namespace fieldproof::campaign
