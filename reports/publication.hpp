// What a paper publishes beside what is reproduced of it.
//
// Contract: a row has a published text only where the paper prints it; where it shows a picture the row says
// so and has none. Its word follows from the numbers that it compares and from nothing else: a row without
// such numbers claims nothing. The JSON is valid against reports/schema/publication.schema.json, "schema" is
// "fieldproof/publication/2"; equal publications give equal octets.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/measure/measurement.hpp"

namespace fieldproof::reports {

// What a row comes to. `agrees` and `own` are what is within the tolerance: of a number or a sentence of the
// paper, of another method of this project.
enum class Reproduction : std::uint8_t { agrees, differs, own, not_checked, inconclusive };
std::string_view text_of(Reproduction reproduction);

// The numbers that decide about a row. A sentence is a limit that it sets: "none" is at most 0.
struct Compared {
  enum class Relation : std::uint8_t { within, at_most, more_than };

  double reference = 0;  // published, or by the other method
  double tolerance = 0;
  double ours = 0;
  std::string unit{};
  Relation relation = Relation::within;
  bool is_own = false;
  bool is_too_few = false;  // data to tell
};
Compared within(double reference, double tolerance, double ours, std::string unit = "");
Compared at_most(double limit, double ours, std::string unit = "");
Compared more_than(double limit, double ours, std::string unit = "");
Compared own(Compared compared);
// Of so many samples, of which fewer than `needed` tell nothing.
Compared of_samples(Compared compared, std::uint64_t samples, std::uint64_t needed);

struct PublishedRow {
  std::string what;
  std::string published;             // as printed; empty: the paper has no number
  std::string reproduced;            // with unit
  std::string remark;                // how it is reproduced, or why the two differ
  std::optional<Compared> compared;  // nothing where there is nothing to agree with
};
Reproduction reproduction_of(const std::optional<Compared>& compared);

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

std::uint64_t rows_that(const Publication& publication, Reproduction reproduction);

std::string publication_text(const Publication& publication);
std::string publication_json(const Publication& publication);

}  // namespace fieldproof::reports
