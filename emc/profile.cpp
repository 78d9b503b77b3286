#include "emc/profile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "harness/config/nearest.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::emc {
namespace {

using Json = nlohmann::ordered_json;

Profile profile_a() {
  Profile profile{"A", "unshielded, not isolated", {}};
  profile.coupling.common_mode_limit_v = 12;
  return profile;
}

Profile changed(Profile profile, std::string name, std::string title, double Coupling::* member,
                double value) {
  profile.name = std::move(name);
  profile.title = std::move(title);
  profile.coupling.*member = value;
  return profile;
}

std::vector<Profile> make_built_in() {
  const Profile a = profile_a();
  const Profile a2{"A2", "unshielded, isolated", {}};
  const Profile b = changed(a, "B", "shield on a pigtail, not isolated", &Coupling::shield_db, 30);
  Profile d{"D", "unshielded, isolated, fast receiver", {}};
  d.coupling.filter_mhz = 16;
  d.coupling.bit_v = 1.5;
  Profile e{"E", "unshielded, isolated, receiver of a 31.25 kbit/s bus", {}};
  e.coupling.filter_mhz = 0.1;
  e.coupling.bit_v = 0.375;
  // The weakest signal that a receiver of IEC 61158-2 must accept: 150 mV from peak to peak.
  const Profile e2 =
      changed(e, "E2", "the same with the weakest signal of that bus", &Coupling::bit_v, 0.075);
  // IEC 61158-2 at 1 Mbit/s: 5.5 V from peak to peak at least.
  Profile f{"F", "unshielded, isolated, receiver of a 1 Mbit/s bus", {}};
  f.coupling.filter_mhz = 3;
  f.coupling.bit_v = 2.75;
  return {
      a,
      a2,
      changed(a2, "A3", "unshielded, isolated, well balanced", &Coupling::imbalance_db, 40),
      b,
      changed(b, "B2", "shield on a pigtail, opto-coupler", &Coupling::common_mode_limit_v, 50),
      changed(a, "C", "shield bonded all around, not isolated", &Coupling::shield_db, 58),
      d,
      e,
      e2,
      f,
  };
}

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return result;
}

const Profile* find(std::string_view name) {
  const auto profiles = Profile::built_in();
  const auto found = std::find_if(profiles.begin(), profiles.end(),
                                  [&](const Profile& profile) { return lower(profile.name) == lower(name); });
  return found == profiles.end() ? nullptr : &*found;
}

std::vector<std::string_view> names_of_built_in() {
  std::vector<std::string_view> names;
  for (const Profile& profile : Profile::built_in()) names.push_back(profile.name);
  return names;
}

std::string read_name(const config::Value& value) {
  const std::string_view name = value.as_string();
  const bool is_word =
      !name.empty() && name.size() <= 64 && std::all_of(name.begin(), name.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
               c == '.' || c == '-';
      });
  if (!is_word) {
    config::fail(value, "a name has 1 to 64 letters, digits, \"_\", \".\" or \"-\", for example \"line_7\"");
  }
  if (find(name) != nullptr) {
    config::fail(value, fmt::format("\"{}\" is a built-in profile; choose a name of your own", name));
  }
  return std::string(name);
}

// In the order of CouplingMethod and of PulseShape.
constexpr std::array<std::string_view, 2> kMethods{"capacitive_clamp", "coupling_network"};
constexpr std::array<std::string_view, 2> kPulses{"standard_formula", "double_exponential"};

void read_parameter(const config::Value& value, const CouplingParameter& parameter, Coupling& coupling) {
  if (std::isinf(parameter.largest) && value.is_null()) {
    coupling.*parameter.member = parameter.largest;
    return;
  }
  const double largest = std::min(parameter.largest, 1e9);
  coupling.*parameter.member = value.as_number(parameter.smallest, largest);
}

void read_coupling(const config::Value& value, Coupling& coupling) {
  config::read_object(value, [&](config::ObjectReader& object) {
    if (const auto method = object.optional("method")) {
      coupling.method = static_cast<CouplingMethod>(method->as_choice(kMethods));
    }
    if (const auto pulse = object.optional("pulse")) {
      coupling.pulse = static_cast<PulseShape>(pulse->as_choice(kPulses));
    }
    for (const CouplingParameter& parameter : coupling_parameters()) {
      if (const auto member = object.optional(parameter.name)) read_parameter(*member, parameter, coupling);
    }
    if (const auto level = object.optional("forced_level")) {
      coupling.forced_level = level->as_integer<int>(0, 1) == 1;
    }
  });
}

}  // namespace

std::span<const Profile> Profile::built_in() {
  static const std::vector<Profile> profiles = make_built_in();
  return profiles;
}

const Profile& Profile::named(std::string_view name) {
  if (const Profile* profile = find(name)) return *profile;
  const std::vector<std::string_view> names = names_of_built_in();
  std::string sentence =
      fmt::format("there is no profile \"{}\"; built in are {}", name, fmt::join(names, ", "));
  if (const auto meant = config::misspelled(name, names))
    sentence += fmt::format("; did you mean {}?", *meant);
  throw kernel::Error(kernel::ErrorKind::usage, sentence);
}

const Profile& Profile::named(const config::Value& name) {
  const std::vector<std::string_view> names = names_of_built_in();
  return named(names.at(name.as_choice(names)));
}

Profile Profile::read(const config::Value& root) {
  return config::read_object(root, [&](config::ObjectReader& object) {
    Profile profile;
    const config::Value name = object.required("name");
    profile.name = read_name(name);
    profile.title = profile.name;
    if (const auto title = object.optional("title")) profile.title = std::string(title->as_string());
    if (const auto from = object.optional("based_on")) profile.coupling = named(*from).coupling;
    if (const auto coupling = object.optional("coupling")) read_coupling(*coupling, profile.coupling);
    try {
      check_coupling(profile.coupling);
    } catch (const kernel::Error& error) {
      config::fail(object.value(), error.what());
    }
    return profile;
  });
}

Profile Profile::load(const std::filesystem::path& path) {
  const config::Document document = config::Document::load(path);
  return read(document.root());
}

std::string json_text(const Profile& profile) {
  if (find(profile.name) != nullptr) return Json(profile.name).dump();
  Json coupling{{"method", kMethods.at(static_cast<std::size_t>(profile.coupling.method))},
                {"pulse", kPulses.at(static_cast<std::size_t>(profile.coupling.pulse))}};
  for (const CouplingParameter& parameter : coupling_parameters()) {
    const double value = profile.coupling.*parameter.member;
    coupling[std::string(parameter.name)] = std::isinf(value) ? Json() : Json(value);
  }
  coupling["forced_level"] = profile.coupling.forced_level ? 1 : 0;
  return Json{{"name", profile.name}, {"title", profile.title}, {"coupling", std::move(coupling)}}.dump();
}

std::vector<std::string> caveats_of(const Profile& profile) {
  std::string chosen;
  for (const CouplingParameter& parameter : coupling_parameters()) {
    if (parameter.standing == Standing::standard) continue;
    const double value = profile.coupling.*parameter.member;
    chosen += chosen.empty() ? "" : ", ";
    chosen += std::isinf(value) ? fmt::format("{} none", parameter.name)
                                : fmt::format("{} = {}", parameter.name, value);
  }
  return {
      fmt::format("The coupling of profile {} ({}) is a model of this project and is not calibrated: the "
                  "voltage at which errors begin on a real line may be several times higher or lower.",
                  profile.name, profile.title),
      "No published error rate against burst voltage was found for these buses to hold the model to; what it "
      "is checked for are shapes and ratios: growth with the level, the part of the receiver's sampling, "
      "clustering at 5 and 100 kHz.",
      "Parameters without a verified source: " + chosen + ".",
  };
}

}  // namespace fieldproof::emc
