// Every test case and every mutant of every protocol's suite, in one order: suites as they were given,
// cases as the suite lists them.
//
// Contract: ids are unique, begin with protocol and role, and each mutant that a case declares exists in
// the role of the case; a suite that breaks this is a broken invariant, found when the catalogue is made. The
// catalogue owns the suites; entries point into them and live as long as the catalogue.
// A selector or a name that matches nothing throws kernel::Error(usage) with the three nearest ones.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "conformance/suite.hpp"
#include "conformance/test_case.hpp"

namespace fieldproof::conformance {

struct Entry {
  const Suite* suite = nullptr;
  const TestCase* test_case = nullptr;
};

struct MutantEntry {
  const Suite* suite = nullptr;
  const Mutant* mutant = nullptr;

  std::string path() const;  // "PROTOCOL/ROLE/crc_preset_zero"
};

class Catalogue {
 public:
  explicit Catalogue(std::vector<std::unique_ptr<Suite>> suites);

  const std::vector<std::unique_ptr<Suite>>& suites() const { return suites_; }
  const std::vector<Entry>& entries() const { return entries_; }
  const std::vector<MutantEntry>& mutants() const { return mutants_; }

  // The union of what the selectors match, without what the exclusions match, in catalogue order. Without a
  // selector that includes, everything but the canaries is included.
  std::vector<Entry> select(std::span<const std::string> selectors) const;

  // The items of all suites; what two suites call alike they mean alike.
  std::vector<judge::PicsItem> pics_items() const;

  const Entry& at(std::string_view id) const;
  const Suite& suite(std::string_view protocol) const;

  // By path ("PROTOCOL/ROLE/crc_preset_zero"), or by the part of the path that is unique ("crc_preset_zero"
  // among `among`, or among all when that is empty). Several that fit are an error that names them.
  const MutantEntry& mutant(std::string_view name, std::span<const Entry> among = {}) const;

 private:
  void add(const Suite& suite);
  void check_case(const Suite& suite, const TestCase& test_case) const;

  std::vector<std::unique_ptr<Suite>> suites_;
  std::vector<Entry> entries_;
  std::vector<MutantEntry> mutants_;
};

}  // namespace fieldproof::conformance
