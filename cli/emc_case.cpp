#include "cli/emc_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <nlohmann/json.hpp>
#include <utility>

#include "cli/attachments.hpp"
#include "cli/case_file.hpp"
#include "cli/implementations.hpp"
#include "cli/networks.hpp"
#include "cli/run_setup.hpp"
#include "emc/plan_disturbances.hpp"
#include "emc/random_flips.hpp"
#include "emc/residual/residual_error.hpp"
#include "harness/fault/plan_file.hpp"
#include "harness/judge/result_json.hpp"
#include "harness/kernel/error.hpp"
#include "reports/run_directory.hpp"

namespace fieldproof::cli {
namespace {

using config::ObjectReader;
using nlohmann::ordered_json;

constexpr std::array<std::string_view, 4> kCriterionNames{"A", "B", "C", "D"};
constexpr std::array<std::string_view, 3> kLatchModels{"M1", "M2", "M3"};
constexpr kernel::Duration kLongest = 3600 * kernel::kSecond;

fault::PlanReading plan_reading() {
  return {.disturbances = emc::plan_disturbances()};
}

emc::Criterion criterion_from(const config::Value& value) {
  return static_cast<emc::Criterion>(value.as_choice(kCriterionNames));
}

const ProtocolEntry& protocol_from(const config::Value& value) {
  std::vector<std::string_view> names;
  for (const ProtocolEntry& entry : protocols())
    if (entry.network.plan != nullptr) names.push_back(entry.name);
  const std::string_view name = names.at(value.as_choice(names));
  return *std::ranges::find(protocols(), name, &ProtocolEntry::name);
}

const conformance::Suite& suite_of(const config::Value& protocol, const Session& session) {
  for (const auto& suite : session.catalogue().suites())
    if (suite->protocol() == protocol.as_string()) return *suite;
  config::fail(protocol, "the protocol has no suite, so nobody can be put into its network");
}

void read_disturbance(ObjectReader& reader, EmcCase& test) {
  const auto bursts = reader.optional("bursts");
  const auto channel = reader.optional("binary_symmetric");
  if (bursts.has_value() == channel.has_value()) {
    config::fail(reader.value(),
                 R"(what disturbs is not clear; write either "bursts" or "binary_symmetric")");
  }
  if (bursts) test.bursts = emc::read_bursts(*bursts);
  if (channel) {
    test.flip_probability = config::read_object(*channel, [](ObjectReader& object) {
      return object.required("flip_probability").as_number(emc::kLeastBer, emc::kGreatestBer);
    });
  }
  if (const auto windows = reader.optional("windows")) {
    for (const config::Value& one : windows->as_array(1)) {
      test.windows.push_back(config::read_object(one, [](ObjectReader& object) {
        const kernel::Time from = kernel::kStart + object.required("from").as_duration();
        return EmcWindow{from, kernel::kStart + object.required("to").as_duration(from - kernel::kStart +
                                                                                  kernel::kPicosecond)};
      }));
    }
  }
  if (const auto plan = reader.optional("plan")) test.plan = fault::read_plan(*plan, plan_reading());
}

// Somebody who has no place in the network is an error of where it is said: here, or in `--iut`.
void plan_network_of(EmcCase& test, const ProtocolEntry& entry, const config::Value& implementations,
                     bool has_other_iut) {
  try {
    test.network = entry.network.plan(test.request);
    test.network->make(test.seed);
  } catch (const kernel::Error& error) {
    if (has_other_iut || error.kind() != kernel::ErrorKind::usage) throw;
    config::fail(implementations, error.what());
  }
}

EmcCase read_emc_case(ObjectReader& reader, const std::filesystem::path& folder, const Session& session,
                      bool has_other_iut) {
  EmcCase test;
  reader.required("schema").as_choice(std::array{kEmcCaseSchema});
  const config::Value protocol = reader.required("protocol");
  const ProtocolEntry& entry = protocol_from(protocol);
  test.protocol = &entry;
  if (const auto network = reader.optional("network"))
    test.request.file = (folder / network->as_string()).lexically_normal().string();
  test.request.implementations =
      implementations_from(reader.required("implementations"), suite_of(protocol, session), kAnyPosition);
  if (const auto latch = reader.optional("latch")) {
    if (!entry.network.has_latch_models)
      config::fail(*latch, "the stations of this network have no latch model; leave it out");
    test.request.latch = latch->as_choice(kLatchModels);
    test.latch = kLatchModels.at(test.request.latch);
  }
  test.seed = judge::unsigned_from(reader.required("seed"));
  test.duration = reader.required("duration").as_duration(kernel::kPicosecond, kLongest);
  read_disturbance(reader, test);
  test.worst =
      static_cast<emc::Criterion>(reader.required("worst").as_choice(std::span(kCriterionNames).first(3)));
  test.end.criterion = criterion_from(reader.required("criterion"));
  test.end.reason = reader.required("reason").as_string();
  test.end.decided_by = reader.required("decided_by").as_string();
  test.end.fingerprint = judge::unsigned_from(reader.required("fingerprint"), 16);
  test.request.limits = limits_from(session.settings);
  test.request.attach = attachments();
  if (has_other_iut) test.request.implementations = network_implementations(session, entry);
  plan_network_of(test, entry, reader.required("implementations"), has_other_iut);
  return test;
}

ordered_json windows_json(const std::vector<EmcWindow>& windows) {
  ordered_json json = ordered_json::array();
  for (const EmcWindow& one : windows)
    json.push_back({{"from", kernel::describe(one.from - kernel::kStart)},
                    {"to", kernel::describe(one.to - kernel::kStart)}});
  return json;
}

}  // namespace

EmcEnd end_of(const emc::ImmunityResult& result) {
  return {result.criterion, result.reason, result.decided_by, result.fingerprint};
}

emc::ImmunityResult end_by(const iut::Misbehaviour& misbehaviour) {
  emc::ImmunityResult result;
  result.came_up = true;
  result.criterion = emc::Criterion::d;
  result.reason = misbehaviour.reason();
  result.decided_by = "an implementation crashed, hung or broke its contract";
  result.complaint = fmt::format("{}: {}", misbehaviour.reason(), misbehaviour.what());
  return result;
}

emc::ImmunitySettings immunity_settings(const EmcCase& test, std::stop_token stop) {
  emc::ImmunitySettings settings;
  settings.bursts = test.bursts.settings;
  if (const double flips = test.flip_probability; flips > 0) {
    settings.make_channel = [flips](kernel::Random random) {
      return std::make_unique<emc::BernoulliChannel>(flips, random);
    };
  }
  settings.plan = test.plan;
  settings.duration = test.duration;
  settings.seed = test.seed;
  settings.stop = std::move(stop);
  return settings;
}

std::uint64_t seed_of(const EmcCase& test, std::uint64_t campaign_seed) {
  const kernel::Random random(campaign_seed);
  if (test.flip_probability > 0)
    return random.split("flips").split(std::bit_cast<std::uint64_t>(test.flip_probability)).seed();
  const emc::BurstSettings& bursts = test.bursts.settings;
  return random.split("bursts")
      .split(std::bit_cast<std::uint64_t>(bursts.level.open_circuit_volts()))
      .split(static_cast<std::uint64_t>(bursts.repetition))
      .split(static_cast<std::uint64_t>(bursts.polarity))
      .seed();
}

fault::Plan plan_with(const FlippedBits& bits) {
  const config::Document document = config::Document::parse(plan_of(bits, ""), "the bits that were struck");
  return fault::read_plan(document.root(), plan_reading());
}

void write_emc_case(const std::filesystem::path& file, const EmcCase& test) {
  ordered_json json;
  json["schema"] = kEmcCaseSchema;
  json["protocol"] = test.protocol->name;
  if (!test.request.file.empty()) {
    const std::filesystem::path folder = std::filesystem::absolute(file).parent_path();
    json["network"] = std::filesystem::relative(test.request.file, folder).string();
  }
  json["implementations"] = ordered_json::parse(implementations_json(test.request.implementations));
  if (!test.latch.empty()) json["latch"] = test.latch;
  json["seed"] = std::to_string(test.seed);
  json["duration"] = kernel::describe(test.duration);
  if (test.flip_probability > 0) {
    json["binary_symmetric"] = {{"flip_probability", test.flip_probability}};
  } else {
    json["bursts"] = emc::json_of(test.bursts);
  }
  if (!test.windows.empty()) json["windows"] = windows_json(test.windows);
  if (test.plan) json["plan"] = ordered_json::parse(fault::canonical_text(*test.plan));
  json["worst"] = emc::name(test.worst);
  json["criterion"] = emc::name(test.end.criterion);
  json["reason"] = test.end.reason;
  json["decided_by"] = test.end.decided_by;
  json["fingerprint"] = judge::fingerprint_text(test.end.fingerprint);
  reports::write_text_file(file.string(),
                           json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n");
}

EmcCase load_emc_case(const std::filesystem::path& file, const Session& session, bool has_other_iut) {
  const config::Document document = config::Document::load(file);
  return config::read_object(document.root(), [&](ObjectReader& reader) {
    return read_emc_case(reader, std::filesystem::absolute(file).parent_path(), session, has_other_iut);
  });
}

}  // namespace fieldproof::cli
