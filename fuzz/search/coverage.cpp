#include "fuzz/search/coverage.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "fuzz/search/loaded_image.hpp"

namespace fieldproof::fuzz {
namespace {

constexpr std::size_t kOwnCounters = std::size_t{1} << 16U;
constexpr std::size_t kClasses = 8;

// A place in a library, wherever that is loaded.
struct PlaceInImage {
  std::string path;
  std::uintptr_t offset = 0;
  friend auto operator<=>(const PlaceInImage&, const PlaceInImage&) = default;
};

// Counters in the code itself. They are touched only while the library is kept.
struct InlineCounters {
  LoadedImage image;
  PlaceInImage place;
  std::span<std::uint8_t> counters;
  KeptImage kept{};

  bool can_be_read() const { return kept != nullptr || image.is_program; }
};

// Code whose calls come from here.
struct CallingImage {
  LoadedImage image;
  std::uintptr_t first = 0;  // of its counters
  KeptImage kept{};
};

// What was seen of them in all runs.
struct KnownCounters {
  std::vector<std::uint8_t> classes;  // bits, by counter
  std::uint64_t first_feature = 0;
};

// In a function: code may report before the objects of this file are made.
struct Record {
  std::array<std::uint8_t, kOwnCounters> own{};    // of guards and of call sites
  std::array<std::uint8_t, kOwnCounters> known{};  // bits of the classes that were seen, by counter
  std::map<PlaceInImage, KnownCounters> known_inline;
  std::uint64_t features = kOwnCounters * kClasses;  // that have numbers
  std::vector<InlineCounters> inline_counters;
  std::map<PlaceInImage, std::uint32_t> first_guards;
  std::uint32_t guards = 0;
  std::vector<CallingImage> calling;  // in this run
  std::map<std::string, std::uintptr_t> first_calls;
  bool is_used = false;
  bool is_recording = false;  // between begin_coverage and take_coverage
};

Record& record() {
  static Record one;
  return one;
}

PlaceInImage place_in(const LoadedImage& image, std::uintptr_t address) {
  return {image.path, address - image.base};
}
std::uintptr_t address_of(const void* place) {
  return reinterpret_cast<std::uintptr_t>(place);
}

void count(std::size_t place) {
  Record& all = record();
  all.is_used = true;
  std::uint8_t& counter = all.own[place % kOwnCounters];
  if (counter != std::numeric_limits<std::uint8_t>::max()) ++counter;
}

// By its place in its library, so that it is the same wherever that is loaded.
void count_call_site(std::uintptr_t site) {
  Record& all = record();
  auto found = std::ranges::find_if(all.calling, [&](const auto& one) { return one.image.holds(site); });
  if (found == all.calling.end()) {
    const auto image = loaded_image_of(site);
    if (!image) return;
    constexpr std::uintptr_t kApart = 0x9E37;
    const auto [first, is_new] = all.first_calls.try_emplace(image->path, all.first_calls.size() * kApart);
    if (!all.is_recording) return;  // it may be gone when the next call comes
    all.calling.push_back({*image, first->second, keep_loaded(*image)});
    found = all.calling.end() - 1;
  }
  count(found->first + site - found->image.base);
}

void add_guards(std::uint32_t* start, std::uint32_t* stop) {
  const auto image = loaded_image_of(address_of(start));
  if (start == stop || !image) return;
  Record& all = record();
  const auto [first, is_new] =
      all.first_guards.try_emplace(place_in(*image, address_of(start)), all.guards + 1);
  if (is_new) all.guards += static_cast<std::uint32_t>(stop - start);
  for (std::uint32_t* guard = start; guard != stop; ++guard) {
    if (*guard == 0) *guard = first->second + static_cast<std::uint32_t>(guard - start);
  }
}

void add_inline_counters(std::uint8_t* start, std::uint8_t* stop) {
  const auto image = loaded_image_of(address_of(start));
  if (start == stop || !image) return;
  Record& all = record();
  all.is_used = true;
  InlineCounters added{*image, place_in(*image, address_of(start)), {start, stop}};
  if (all.is_recording) added.kept = keep_loaded(*image);
  // Of the library that was here, or of this one where it was loaded before.
  std::erase_if(all.inline_counters, [&](const InlineCounters& one) {
    const bool is_here = one.counters.data() < stop && start < one.counters.data() + one.counters.size();
    return is_here || one.place == added.place;
  });
  all.inline_counters.push_back(std::move(added));
}

// What was unloaded meanwhile is forgotten, the rest is kept until the end of the run.
void keep_what_is_there(std::vector<InlineCounters>& all) {
  std::erase_if(all, [](InlineCounters& one) {
    if (loaded_image_of(address_of(one.counters.data())) != one.image) return true;
    one.kept = keep_loaded(one.image);
    return !one.can_be_read();
  });
}

// Nothing is recorded any more. Code that is unloaded here may report once more.
void end_run() {
  Record& all = record();
  all.is_recording = false;
  const auto calling = std::exchange(all.calling, {});
  std::vector<KeptImage> kept;
  for (InlineCounters& one : all.inline_counters) kept.push_back(std::exchange(one.kept, nullptr));
}

// 1, 2, 3, 4.. 8.. 16.. 32.. 128..: a bit each.
std::uint8_t class_of(std::uint8_t count) {
  constexpr std::array<unsigned, kClasses> kLeast{1, 2, 3, 4, 8, 16, 32, 128};
  const auto above = std::ranges::upper_bound(kLeast, static_cast<unsigned>(count));
  return static_cast<std::uint8_t>(1U << static_cast<unsigned>(above - kLeast.begin() - 1));
}

void take(std::span<const std::uint8_t> counters, std::span<std::uint8_t> known, std::uint64_t first_feature,
          RunCoverage& run) {
  for (std::size_t n = 0; n < counters.size(); ++n) {
    if (counters[n] == 0) continue;
    const std::uint8_t bit = class_of(counters[n]);
    run.features.push_back(first_feature + n * kClasses + static_cast<unsigned>(std::countr_zero(bit)));
    run.new_edges += known[n] == 0 ? 1U : 0U;
    run.new_features += (known[n] & bit) == 0 ? 1U : 0U;
    known[n] = static_cast<std::uint8_t>(known[n] | bit);
  }
}

}  // namespace

bool has_coverage() {
  return record().is_used;
}

void begin_coverage() {
  end_run();
  Record& all = record();
  keep_what_is_there(all.inline_counters);
  all.own.fill(0);
  for (const auto& one : all.inline_counters) std::ranges::fill(one.counters, std::uint8_t{0});
  all.is_recording = true;
}

RunCoverage take_coverage() {
  Record& all = record();
  RunCoverage run;
  if (!all.is_recording) return run;
  take(all.own, all.known, 0, run);
  for (const InlineCounters& one : all.inline_counters) {
    if (!one.can_be_read()) continue;
    KnownCounters& known = all.known_inline[one.place];
    if (known.classes.size() < one.counters.size()) {
      known.classes.resize(one.counters.size());
      known.first_feature = std::exchange(all.features, all.features + one.counters.size() * kClasses);
    }
    take(one.counters, known.classes, known.first_feature, run);
  }
  end_run();
  std::ranges::sort(run.features);
  if (run.new_features == 0) run.features.clear();
  return run;
}

}  // namespace fieldproof::fuzz

// What instrumented code calls. The names are the compilers'.
// NOLINTBEGIN(bugprone-reserved-identifier)
extern "C" {

void __sanitizer_cov_trace_pc_guard_init(std::uint32_t* start, std::uint32_t* stop);
void __sanitizer_cov_trace_pc_guard(std::uint32_t* guard);
void __sanitizer_cov_8bit_counters_init(std::uint8_t* start, std::uint8_t* stop);
void __sanitizer_cov_pcs_init(const std::uintptr_t* start, const std::uintptr_t* stop);
void __sanitizer_cov_trace_pc();

void __sanitizer_cov_trace_pc_guard_init(std::uint32_t* start, std::uint32_t* stop) {
  fieldproof::fuzz::add_guards(start, stop);
}

void __sanitizer_cov_trace_pc_guard(std::uint32_t* guard) {
  fieldproof::fuzz::count(*guard);
}

void __sanitizer_cov_8bit_counters_init(std::uint8_t* start, std::uint8_t* stop) {
  fieldproof::fuzz::add_inline_counters(start, stop);
}

void __sanitizer_cov_pcs_init(const std::uintptr_t*, const std::uintptr_t*) {}

void __sanitizer_cov_trace_pc() {
  fieldproof::fuzz::count_call_site(reinterpret_cast<std::uintptr_t>(__builtin_return_address(0)));
}

}  // extern "C"
// NOLINTEND(bugprone-reserved-identifier)
