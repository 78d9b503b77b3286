// A search over a library that is loaded into this process, which it can end: the search is made in a child,
// and what the child had come to outlives it. POSIX (Linux).
//
// Contract: signals that ask this process to end are handed on to the child. A child that makes no sequence
// for 120 s is ended. Nothing of the child's work is to be done again here: it prints and writes itself.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "conformance/sequence.hpp"
#include "fuzz/search/sequence_search.hpp"

namespace fieldproof::cli {

// What a search was doing when the library ended it.
struct BrokenSearch {
  std::string how;                                // "was ended by signal 11 (Segmentation fault)"
  bool hangs = false;                             // it was ended here
  std::vector<std::uint8_t> octets{};             // of the sequence that was run, or made smaller, then
  fuzz::SequenceFuzzResult before{};              // what the sequences before it showed; without a corpus
  std::vector<std::vector<std::uint8_t>> kept{};  // octets of the sequences that passed new edges
};

class GuardedSearch {
 public:
  GuardedSearch();
  ~GuardedSearch();
  GuardedSearch(const GuardedSearch&) = delete;
  GuardedSearch& operator=(const GuardedSearch&) = delete;

  // Does `work` in a child, and answers with its exit code; or with nothing when the library ended it first,
  // and then broken() says what it did. An error that `work` throws is thrown here.
  std::optional<int> run(const std::function<int()>& work);
  const BrokenSearch& broken() const { return broken_; }

  // What the search in the child tells: before a sequence, of one that is kept, of the end of sequences.
  void begins(const fuzz::SequenceFuzzResult& before, std::span<const std::uint8_t> octets);
  void keeps(std::span<const std::uint8_t> octets) const;
  void has_found();

 private:
  struct Shared;
  [[noreturn]] void be_the_child(const std::function<int()>& work);
  int status_of(int child);  // as waitpid gives it
  void read_what_was_left(int status);

  Shared* shared_ = nullptr;  // memory of both processes
  int kept_ = -1;             // a file of both, without a name
  bool hangs_ = false;
  BrokenSearch broken_;
};

}  // namespace fieldproof::cli
