// What a paper publishes beside what is reproduced of it.
//
// Contract: a row has a published text only where the paper prints it; where it shows a picture the row says
// so and has none. The JSON is valid against reports/schema/publication.schema.json, "schema" is
// "fieldproof/publication/1"; equal publications give equal octets.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "harness/measure/measurement.hpp"

namespace fieldproof::reports {

struct PublishedRow {
  std::string what;
  std::string published;       // as printed; empty: the paper has no number
  std::string reproduced;      // with unit
  std::string remark;          // how it is reproduced, or why the two differ
  std::optional<bool> agrees;  // nothing where there is nothing to agree with
};

struct PublishedTrace {
  std::string name;
  measure::Trace trace;
};

// Curves over one axis, as a figure of a paper shows them. Each has its own points, in order of x.
struct PublishedCurves {
  struct Point {
    double x = 0;
    double y = 0;
  };
  struct Curve {
    std::string name;
    std::vector<Point> points;
  };
  std::string name;
  std::string x_label;  // with unit
  std::string y_label;
  std::vector<Curve> curves;
};

struct PublishedSection {
  std::string heading;
  std::string note;  // what the paper says or shows
  std::vector<PublishedRow> rows;
  std::vector<PublishedTrace> traces{};
  std::vector<PublishedCurves> figures{};  // in the page alone; the text has the rows
};

struct Publication {
  std::string title;
  std::uint64_t seed = 0;
  std::vector<PublishedSection> sections;
};

// No row disagrees.
bool is_reproduced(const Publication& publication);

std::string publication_text(const Publication& publication);
std::string publication_json(const Publication& publication);

}  // namespace fieldproof::reports
