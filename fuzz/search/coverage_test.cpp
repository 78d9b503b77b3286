// Subject: coverage of libraries that are loaded anew for each run, as a plug-in is for each case.
#include "fuzz/search/coverage.hpp"

#include <dlfcn.h>
#include <gtest/gtest.h>
#include <sys/mman.h>

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

namespace fieldproof::fuzz {
namespace {

class Library {
 public:
  explicit Library(const std::string& path) : handle_(::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL)) {
    if (handle_ == nullptr) throw std::runtime_error(::dlerror());
  }
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;
  ~Library() { ::dlclose(handle_); }

  // One call site in this program: a library that ends in a jump to the counter reports that.
  [[gnu::noinline]] void walk(unsigned edge, unsigned count) const {
    reinterpret_cast<void (*)(unsigned, unsigned)>(::dlsym(handle_, "walk"))(edge, count);
  }
  static bool is_loaded(const std::string& path) {
    void* const handle = ::dlopen(path.c_str(), RTLD_NOW | RTLD_NOLOAD);
    if (handle != nullptr) ::dlclose(handle);
    return handle != nullptr;
  }

 private:
  void* handle_;
};

// What lies where a library was: the next one comes to another address.
class Obstacle {
 public:
  Obstacle() : place_(::mmap(nullptr, kSize, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0)) {}
  Obstacle(const Obstacle&) = delete;
  Obstacle& operator=(const Obstacle&) = delete;
  ~Obstacle() { ::munmap(place_, kSize); }

 private:
  static constexpr std::size_t kSize = std::size_t{1} << 20U;
  void* place_;
};

class Coverage : public testing::TestWithParam<const char*> {
 protected:
  // Loads the library, walks and unloads it.
  std::size_t run(unsigned edge, unsigned count) {
    begin_coverage();
    {
      Library(GetParam()).walk(edge, count);
    }
    const std::size_t found = take_coverage().new_features;
    EXPECT_FALSE(Library::is_loaded(GetParam()));
    return found;
  }
};

TEST_P(Coverage, IsTheSameWhereverALibraryIsLoaded) {
  run(0, 1);
  EXPECT_TRUE(has_coverage());
  EXPECT_EQ(run(0, 1), 0U);
  EXPECT_GT(run(1, 1), 0U);
  for (int n = 0; n < 50; ++n) {
    const Obstacle one;
    EXPECT_EQ(run(0, 1), 0U) << n;
    EXPECT_EQ(run(1, 1), 0U) << n;
  }
  EXPECT_GT(run(1, 2), 0U);
  EXPECT_EQ(run(1, 2), 0U);
}

TEST_P(Coverage, OfALibraryThatWasThereBeforeTheRunIsSeen) {
  {
    const Library before(GetParam());
    begin_coverage();
    before.walk(2, 1);
    EXPECT_GT(take_coverage().new_features, 0U);
    begin_coverage();
    before.walk(2, 1);
    EXPECT_EQ(take_coverage().new_features, 0U);
  }
  EXPECT_EQ(run(2, 1), 0U);
}

// Between runs a library comes and goes, as when a sequence is made smaller.
TEST_P(Coverage, OfNoRunIsNotSeenAndKeepsNothing) {
  for (int n = 0; n < 3; ++n) {
    {
      Library(GetParam()).walk(3, 1);
    }
    EXPECT_FALSE(Library::is_loaded(GetParam()));
    EXPECT_EQ(take_coverage().new_features, 0U);
  }
  EXPECT_GT(run(3, 1), 0U);
}

// A feature has one number: what two runs have in common is seen in both, wherever the library was.
TEST_P(Coverage, HasTheSameNumbersInEachRun) {
  const auto features_of = [](unsigned edge, unsigned count) {
    begin_coverage();
    {
      Library(GetParam()).walk(edge, count);
    }
    return take_coverage();
  };
  const RunCoverage first = features_of(4, 5);
  const Obstacle one;
  const RunCoverage second = features_of(4, 40);
  EXPECT_EQ(second.new_edges, 0U);
  EXPECT_GT(second.new_features, 0U);
  EXPECT_TRUE(std::ranges::is_sorted(second.features));
  std::vector<std::uint64_t> added;
  std::ranges::set_difference(second.features, first.features, std::back_inserter(added));
  EXPECT_EQ(added.size(), second.new_features);
  EXPECT_EQ(features_of(4, 40).features, std::vector<std::uint64_t>{}) << "nothing is new";
}

INSTANTIATE_TEST_SUITE_P(OfLibraries, Coverage,
                         testing::Values(COUNTING_LIBRARY_COUNTERS, COUNTING_LIBRARY_GUARDS,
                                         COUNTING_LIBRARY_CALLS));

}  // namespace
}  // namespace fieldproof::fuzz
