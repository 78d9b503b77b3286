#include "cli/sequence_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>

#include <nlohmann/json.hpp>

#include "cli/case_file.hpp"
#include "cli/pics_file.hpp"
#include "harness/judge/result_json.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::cli {
namespace {

using nlohmann::ordered_json;

SequenceFile read_sequence_file(config::ObjectReader& reader, const conformance::Catalogue& catalogue) {
  SequenceFile read;
  reader.required("schema").as_choice(std::array{kSequenceSchema});
  const config::Value role = reader.required("role");
  try {
    std::tie(read.suite, read.role) = sequence_role_at(std::string(role.as_string()), catalogue);
  } catch (const kernel::Error& error) {
    if (error.kind() != kernel::ErrorKind::usage) throw;
    config::fail(role, error.what());
  }
  read.setup.seed = judge::unsigned_from(reader.required("seed"));
  read.setup.implementations = implementations_from(reader.required("implementations"), *read.suite);
  if (const auto pics = reader.optional("pics")) read.setup.pics = pics_from(*pics, catalogue.pics_items());
  read.sequence = conformance::read_sequence(reader, read.role->vocabulary);
  read.end = end_from(reader);
  return read;
}

}  // namespace

std::string role_path(const conformance::SequenceRole& role) {
  const std::string& id = role.test_case.id;
  return id.substr(0, id.find('/', id.find('/') + 1));
}

std::pair<const conformance::Suite*, const conformance::SequenceRole*> sequence_role_at(
    const std::string& path, const conformance::Catalogue& catalogue) {
  std::vector<std::string> known;
  for (const auto& suite : catalogue.suites()) {
    for (const conformance::SequenceRole& role : suite->sequence_roles()) {
      known.push_back(role_path(role));
      if (known.back() == path) return {suite.get(), &role};
    }
  }
  throw kernel::Error(kernel::ErrorKind::usage,
                      fmt::format("there are no sequences for '{}'; there are some for '{}'", path,
                                  fmt::join(known, "', '")));
}

std::string sequence_file_text(const SequenceFile& file) {
  ordered_json json;
  json["schema"] = kSequenceSchema;
  json["role"] = role_path(*file.role);
  json["seed"] = std::to_string(file.setup.seed);
  json["implementations"] = ordered_json::parse(implementations_json(file.setup.implementations));
  if (file.setup.pics) json["pics"] = ordered_json::parse(pics_text(*file.setup.pics)).at("items");
  json.update(ordered_json::parse(conformance::sequence_json(file.sequence, file.role->vocabulary)));
  add_end(json, file.end);
  return json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

bool is_sequence_file(const std::filesystem::path& file) {
  return has_schema(file, kSequenceSchema);
}

SequenceFile load_sequence_file(const std::filesystem::path& file, const conformance::Catalogue& catalogue) {
  const config::Document document = config::Document::load(file);
  return config::read_object(
      document.root(), [&](config::ObjectReader& reader) { return read_sequence_file(reader, catalogue); });
}

}  // namespace fieldproof::cli
