// The JSON Schemas that the program knows: of its files, and of the settings of each role.
#pragma once

#include <string>
#include <vector>

#include "conformance/catalogue.hpp"

namespace fieldproof::cli {

struct NamedText {
  std::string name;
  std::string text;
};

// Files first, in the order of their names, then roles.
std::vector<NamedText> named_schemas(const conformance::Catalogue& catalogue);
std::string pics_schema_text(const conformance::Catalogue& catalogue);
std::string campaign_schema_text();
std::string sequence_schema_text(const conformance::Catalogue& catalogue);

}  // namespace fieldproof::cli
