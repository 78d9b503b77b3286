#include "harness/iut/plugin.hpp"

#define BOOST_DLL_USE_STD_FS
#include <fmt/format.h>

#include <algorithm>
#include <boost/dll/shared_library.hpp>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <vector>

#include "harness/iut/fieldproof_plugin.h"
#include "harness/iut/limits.hpp"
#include "harness/iut/misbehaviour.hpp"
#include "harness/kernel/check.hpp"
#include "harness/kernel/untrusted_text.hpp"

namespace fieldproof::iut {
namespace {

[[noreturn]] void refuse_library(const std::string& name, const std::string& why) {
  throw kernel::Error(kernel::ErrorKind::implementation, fmt::format("{}: {}", name, why));
}

fieldproof_time ticks_of(kernel::Time time) {
  return time.time_since_epoch().count();
}
kernel::Time time_of(fieldproof_time ticks) {
  return kernel::Time{kernel::Duration{ticks}};
}

// Nearly every call tells one character: a copy into another shape would cost as much as the call. Hence the
// shape is one, and fieldproof_character may alias.
static_assert(std::is_standard_layout_v<Character> && sizeof(Character) == sizeof(fieldproof_character) &&
              offsetof(Character, start) == offsetof(fieldproof_character, start) &&
              offsetof(Character, busy_until) == offsetof(fieldproof_character, busy_until) &&
              offsetof(Character, data) == offsetof(fieldproof_character, data) &&
              offsetof(Character, is_parity_wrong) == offsetof(fieldproof_character, is_parity_wrong) &&
              offsetof(Character, is_stop_missing) == offsetof(fieldproof_character, is_stop_missing) &&
              sizeof(kernel::Time) == sizeof(fieldproof_time) && sizeof(bool) == sizeof(unsigned char));
const fieldproof_character* as_they_lie(std::span<const Character> characters) {
  return reinterpret_cast<const fieldproof_character*>(characters.data());
}

constexpr const char* kNoCharacters =
    "has no function 'receive'; its role receives characters whatever the unit of its line";

// A library stays loaded as long as what it gave is used.
struct Plugin {
  std::string name;  // in sentences: "plugin:./libnode.so"
  boost::dll::shared_library library{};
  const fieldproof_implementation* implementation = nullptr;
};

// What is wrong with a file that the dynamic linker refuses, and what would be right.
std::string why_not_loaded(const std::string& path, const std::string& refusal) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) {
    return "there is no such file; write the path of a shared library";
  }
  if (!std::filesystem::is_regular_file(path, ignored))
    return "this is no file; write the path of a shared library";
  // The words of the linker lie within those of who called it.
  constexpr std::string_view kBefore = "dlerror system message: ";
  const std::size_t begin = refusal.find(kBefore);
  const std::size_t end = refusal.rfind("): ");
  const bool has_both = begin != std::string::npos && end != std::string::npos && begin < end;
  const std::string words =
      has_both ? refusal.substr(begin + kBefore.size(), end - begin - kBefore.size()) : refusal;
  return fmt::format("this is no shared library that can be loaded here ({}); build it with -shared -fPIC",
                     kernel::escaped_line(words));
}

std::string own_name_of(const fieldproof_implementation& implementation) {
  return implementation.name != nullptr ? kernel::escaped_line(implementation.name) : "without a name";
}

Plugin loaded(const std::string& path) {
  Plugin plugin{.name = "plugin:" + path};
  try {
    plugin.library.load(path, boost::dll::load_mode::rtld_now | boost::dll::load_mode::rtld_local);
  } catch (const std::exception& error) {
    refuse_library(plugin.name, fmt::format("cannot be loaded: {}", why_not_loaded(path, error.what())));
  }
  if (!plugin.library.has("fieldproof_plugin")) {
    refuse_library(plugin.name, "does not export 'fieldproof_plugin'");
  }
  const auto& entry = plugin.library.get<const fieldproof_implementation*(unsigned)>("fieldproof_plugin");
  plugin.implementation = entry(FIELDPROOF_PLUGIN_VERSION);
  return plugin;
}

class PluginDevice final : public Device {
 public:
  PluginDevice(Plugin plugin, const std::string& protocol, const std::string& role, UnitOffer told)
      : plugin_(std::move(plugin)), functions_(functions_of(checked(plugin_))) {
    if (functions_.receive == nullptr) {
      if (told == UnitOffer::in_characters_too) refuse_library(plugin_.name, kNoCharacters);
      functions_.receive = &refuse_characters;
    }
    bench_.version = FIELDPROOF_PLUGIN_VERSION;
    bench_.size = sizeof bench_;
    bench_.context = this;
    bench_.driver = &on_driver;
    bench_.characters = &on_characters;
    bench_.transmit_levels = &on_transmit_levels;
    bench_.write = &on_write;
    bench_.read = &on_read;
    bench_.log = &on_log;
    self_ = functions_.create(protocol.c_str(), role.c_str(), &bench_);
    if (self_ == nullptr)
      refuse_library(plugin_.name, fmt::format("does not serve the role '{}/{}'", protocol, role));
  }
  ~PluginDevice() override { functions_.destroy(self_); }

  UnitKind unit_kind() const override { return static_cast<UnitKind>(functions_.unit); }
  Capabilities capabilities() const override {
    return {.senses_activity = functions_.on_activity != nullptr};
  }

  bool begin(const CaseBegin& begin, Bench& bench) override {
    std::vector<fieldproof_setting> settings;
    for (const auto& [name, value] : begin.settings) settings.push_back({name.c_str(), value});
    const fieldproof_case test_case{begin.id.c_str(), begin.seed, settings.data(),
                                    static_cast<unsigned>(settings.size())};
    case_bench_ = &bench;
    bool is_served = false;
    call([&] {
      fieldproof_time next = FIELDPROOF_NEVER;
      is_served = functions_.begin(self_, &test_case, &next) != 0;
      return next;
    });
    return is_served;
  }
  void set_power(bool is_on, kernel::Time now) override {
    call([&] { return functions_.set_power(self_, is_on ? 1 : 0, ticks_of(now)); });
  }
  void receive(unsigned port, std::span<const Character> characters, kernel::Time now) override {
    call([&] {
      return functions_.receive(self_, port, as_they_lie(characters),
                                static_cast<unsigned>(characters.size()), ticks_of(now));
    });
  }
  void receive(unsigned port, const line::Waveform& reception) override {
    const std::size_t count = reception.levels.size();
    packed_.clear();
    for (std::size_t n = 0; n < count; n += 8) {
      packed_.push_back(static_cast<unsigned char>(reception.levels.window(n) & 0xFF));
    }
    call([&] {
      return functions_.receive_levels(self_, port, ticks_of(reception.start), reception.rate, packed_.data(),
                                       static_cast<unsigned>(count), ticks_of(reception.end()));
    });
  }
  void on_activity(unsigned port, bool begins, kernel::Time now) override {
    call([&] { return functions_.on_activity(self_, port, begins ? 1 : 0, ticks_of(now)); });
  }
  void on_time(kernel::Time now) override {
    call([&] { return functions_.on_time(self_, ticks_of(now)); });
  }
  kernel::Time next_time() const override { return next_time_; }
  void end() override {
    case_bench_ = nullptr;
    functions_.end(self_);
  }

  // Throws for a table of functions that cannot be called.
  static const fieldproof_implementation& checked(const Plugin& plugin) {
    if (plugin.implementation == nullptr || plugin.implementation->version != FIELDPROOF_PLUGIN_VERSION) {
      refuse_library(plugin.name, fmt::format("is not made for version {} of fieldproof_plugin.h",
                                              FIELDPROOF_PLUGIN_VERSION));
    }
    const fieldproof_implementation& it = *plugin.implementation;
    if (it.size < kLeastTable)
      refuse_library(plugin.name, "has a shorter table of functions than its version has");
    if (it.unit < FIELDPROOF_CHARACTERS || it.unit > FIELDPROOF_TELEGRAMS) {
      refuse_library(
          plugin.name,
          fmt::format("has unit {}; there are 1 (characters), 2 (levels) and 3 (telegrams)", it.unit));
    }
    const bool has_receive =
        it.unit == FIELDPROOF_LEVELS ? it.receive_levels != nullptr : it.receive != nullptr;
    if (it.create == nullptr || it.destroy == nullptr || it.begin == nullptr || it.set_power == nullptr ||
        !has_receive || it.on_time == nullptr || it.end == nullptr) {
      refuse_library(plugin.name, "leaves a function out of its table");
    }
    return it;
  }

 private:
  // Tables of this version end here at the earliest.
  static constexpr std::size_t kLeastTable = offsetof(fieldproof_implementation, on_activity);

  // What a shorter table does not have is null.
  static fieldproof_implementation functions_of(const fieldproof_implementation& table) {
    fieldproof_implementation functions{};
    std::memcpy(&functions, &table, std::min<std::size_t>(table.size, sizeof functions));
    return functions;
  }

  // In the place of `receive` that a library of levels leaves out. To ask for it in each call takes as long
  // as a tenth of the call.
  static fieldproof_time refuse_characters(void*, unsigned, const fieldproof_character*, unsigned,
                                           fieldproof_time) {
    throw kernel::Error(kernel::ErrorKind::implementation, std::string("a plug-in ") + kNoCharacters);
  }

  // `call` returns when on_time is wanted. Most calls do nothing to the bench: then that is all.
  template <typename Call>
  void call(Call&& call) {
    const fieldproof_time next = call();
    if (actions_ != 0) [[unlikely]]
      end_actions();
    next_time_ = time_of(next);
  }
  [[gnu::noinline]] void end_actions() {
    actions_ = 0;
    if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
  }

  // An exception must not pass through the implementation: it is kept until the call is over.
  template <typename Act>
  static void act(void* context, Act&& act) {
    auto& self = *static_cast<PluginDevice*>(context);
    if (self.failure_ || self.case_bench_ == nullptr) return;
    try {
      if (++self.actions_ > kMostActions) {
        throw Misbehaviour(reasons::kFloods, fmt::format("{} has done more than {} things within one call",
                                                         self.plugin_.name, kMostActions));
      }
      act(*self.case_bench_);
    } catch (...) {
      self.failure_ = std::current_exception();
    }
  }

  static void on_driver(void* context, unsigned port, int is_on, fieldproof_time at) {
    act(context, [&](Bench& bench) { bench.set_driver(port, is_on != 0, time_of(at)); });
  }
  static void on_characters(void* context, unsigned port, fieldproof_time start,
                            const unsigned short* characters, unsigned count) {
    act(context, [&](Bench& bench) {
      if (count > 0xFFFF) {
        throw Misbehaviour(reasons::kImpossible,
                           fmt::format("the implementation sends {} characters at once; there are at most {}",
                                       count, 0xFFFF));
      }
      bench.send(port, time_of(start), {characters, count});
    });
  }
  static void on_transmit_levels(void* context, unsigned port, fieldproof_time start, fieldproof_time rate,
                                 const unsigned char* levels, unsigned count) {
    act(context, [&](Bench& bench) {
      constexpr fieldproof_time kGreatestRate = 100'000'000'000;
      if (rate < 1 || rate > kGreatestRate) {
        throw Misbehaviour(reasons::kImpossible,
                           fmt::format("the implementation drives {} levels per second", rate));
      }
      line::Waveform wave;
      wave.start = time_of(start);
      wave.rate = rate;
      for (unsigned n = 0; n < count; n += 8) wave.levels.append(levels[n / 8], std::min(8U, count - n));
      bench.transmit(port, wave);
    });
  }
  static void on_write(void* context, unsigned item, fieldproof_word value, fieldproof_time when) {
    act(context, [&](Bench& bench) { bench.write(item_of(item), value, time_of(when)); });
  }
  static fieldproof_word on_read(void* context, unsigned item, fieldproof_time when) {
    std::uint64_t value = 0;
    act(context, [&](Bench& bench) { value = bench.read(item_of(item), time_of(when)); });
    return value;
  }
  // Cut to its lowest octets it would be another one.
  static Item item_of(unsigned item) {
    if (item > 0xFFFF) {
      throw Misbehaviour(reasons::kImpossible,
                         fmt::format("the implementation names item {}; items are at most 65535", item));
    }
    return static_cast<Item>(item);
  }
  static void on_log(void*, const char* text) { std::fprintf(stderr, "%s\n", text); }

  Plugin plugin_;
  fieldproof_implementation functions_;
  fieldproof_bench bench_{};
  void* self_ = nullptr;
  Bench* case_bench_ = nullptr;
  kernel::Time next_time_ = kernel::kNever;
  unsigned actions_ = 0;  // within the call that runs
  std::exception_ptr failure_;
  std::vector<unsigned char> packed_;
};

}  // namespace

std::unique_ptr<Device> load_plugin(const std::string& path, const std::string& protocol,
                                    const std::string& role, UnitOffer told) {
  return std::make_unique<PluginDevice>(loaded(path), protocol, role, told);
}

std::string own_name_of_plugin(const std::string& path) {
  const Plugin plugin = loaded(path);
  return own_name_of(PluginDevice::checked(plugin));
}

std::unique_ptr<Device> make_plugin(const fieldproof_implementation& implementation,
                                    const std::string& protocol, const std::string& role, UnitOffer told) {
  return std::make_unique<PluginDevice>(
      Plugin{.name = "plugin " + own_name_of(implementation), .implementation = &implementation}, protocol,
      role, told);
}

}  // namespace fieldproof::iut
