// What the catalogue of this program says of its cases, for the page of a report.
#pragma once

#include "conformance/catalogue.hpp"
#include "reports/page_content.hpp"

namespace fieldproof::cli {

// Without the canaries, which no selection has unless they are named.
reports::PageCatalogue page_catalogue(const conformance::Catalogue& catalogue);

}  // namespace fieldproof::cli
