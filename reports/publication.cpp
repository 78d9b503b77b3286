#include "reports/publication.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "harness/kernel/untrusted_text.hpp"
#include "reports/measurement_writer.hpp"
#include "reports/text_summary.hpp"
#include "reports/trace_json.hpp"

namespace fieldproof::reports {
namespace {

using Json = nlohmann::ordered_json;
using kernel::as_utf8;

constexpr std::size_t kWhatWidth = 50;
constexpr std::size_t kPublishedWidth = 26;
constexpr std::size_t kReproducedWidth = 24;
constexpr std::size_t kTraceColumns = 100;
constexpr std::string_view kNoNumber = "(no number)";

constexpr std::array kReproductions = {Reproduction::agrees, Reproduction::differs, Reproduction::own,
                                       Reproduction::not_checked, Reproduction::inconclusive};

std::string_view relation_of(const Compared& compared) {
  switch (compared.relation) {
    case Compared::Relation::within:
      return "within";
    case Compared::Relation::at_most:
      return "at_most";
    case Compared::Relation::more_than:
      return "more_than";
  }
  return "";
}

bool holds(const Compared& compared) {
  switch (compared.relation) {
    case Compared::Relation::within:
      return std::abs(compared.ours - compared.reference) <= compared.tolerance;
    case Compared::Relation::at_most:
      return compared.ours <= compared.reference + compared.tolerance;
    case Compared::Relation::more_than:
      return compared.ours > compared.reference;
  }
  return false;
}

std::string numbers_of(const Compared& compared) {
  const auto number = [&](double value) {
    return fmt::format("{:.6g}{}{}", value, compared.unit.empty() ? "" : " ", compared.unit);
  };
  switch (compared.relation) {
    case Compared::Relation::within:
      return fmt::format("{} of {} +- {:.2g}", number(compared.ours), number(compared.reference),
                         compared.tolerance);
    case Compared::Relation::at_most:
      return fmt::format("{} of at most {}", number(compared.ours), number(compared.reference));
    case Compared::Relation::more_than:
      return fmt::format("{} of more than {}", number(compared.ours), number(compared.reference));
  }
  return "";
}

std::string sign_of(const PublishedRow& row) {
  const std::string_view word = text_of(reproduction_of(row.compared));
  return row.compared ? fmt::format("{}: {}", word, escaped_line(numbers_of(*row.compared)))
                      : std::string(word);
}

std::string row_text(const PublishedRow& row) {
  const std::string published = row.published.empty() ? std::string(kNoNumber) : escaped_line(row.published);
  std::string text =
      fmt::format("  {:<{}} {:<{}} {:<{}} {}", escaped_line(row.what), kWhatWidth, published, kPublishedWidth,
                  escaped_line(row.reproduced), kReproducedWidth, sign_of(row));
  text.erase(text.find_last_not_of(' ') + 1);
  if (!row.remark.empty()) text += fmt::format("\n      {}", escaped_line(row.remark));
  return text + "\n";
}

std::string section_text(const PublishedSection& section) {
  std::string text = fmt::format("\n{}\n", escaped_line(section.heading));
  if (!section.note.empty()) text += fmt::format("  {}\n", escaped_line(section.note));
  if (!section.rows.empty()) {
    text += fmt::format("  {:<{}} {:<{}} {}\n", "", kWhatWidth, "paper", kPublishedWidth, "reproduced");
  }
  for (const PublishedRow& row : section.rows) text += row_text(row);
  for (const PublishedTrace& one : section.traces) {
    text += fmt::format("\n{}, {}\n{}", escaped_line(one.name), kernel::describe(one.trace.length),
                        trace_text(one.trace, kTraceColumns));
  }
  return text;
}

Json figure_json(const PublishedCurves& figure) {
  Json curves = Json::array();
  for (const PublishedCurves::Curve& curve : figure.curves) {
    Json points = Json::array();
    for (const PublishedCurves::Point& point : curve.points)
      points.push_back({{"x", point.x}, {"y", point.y}});
    curves.push_back({{"name", as_utf8(curve.name)}, {"points", std::move(points)}});
  }
  return {{"name", as_utf8(figure.name)},
          {"x_label", as_utf8(figure.x_label)},
          {"y_label", as_utf8(figure.y_label)},
          {"curves", std::move(curves)}};
}

Json compared_json(const Compared& compared) {
  return {{"with", compared.is_own ? "own" : "paper"},
          {"relation", relation_of(compared)},
          {compared.is_own ? "reference" : "published", compared.reference},
          {"tolerance", compared.tolerance},
          {"ours", std::isfinite(compared.ours) ? Json(compared.ours) : Json()},
          {"unit", as_utf8(compared.unit)},
          {"is_too_few", compared.is_too_few}};
}

Json section_json(const PublishedSection& section) {
  Json json = {{"heading", as_utf8(section.heading)},
               {"note", as_utf8(section.note)},
               {"rows", Json::array()},
               {"traces", Json::array()},
               {"figures", Json::array()}};
  for (const PublishedRow& row : section.rows) {
    Json one = {{"what", as_utf8(row.what)},
                {"published", nullptr},
                {"reproduced", as_utf8(row.reproduced)},
                {"remark", as_utf8(row.remark)},
                {"verdict", text_of(reproduction_of(row.compared))},
                {"compared", nullptr}};
    if (!row.published.empty()) one["published"] = as_utf8(row.published);
    if (row.compared) one["compared"] = compared_json(*row.compared);
    json["rows"].push_back(std::move(one));
  }
  for (const PublishedTrace& one : section.traces) {
    json["traces"].push_back({{"name", as_utf8(one.name)}, {"trace", trace_json(one.trace)}});
  }
  for (const PublishedCurves& one : section.figures) json["figures"].push_back(figure_json(one));
  return json;
}

}  // namespace

std::string_view text_of(Reproduction reproduction) {
  switch (reproduction) {
    case Reproduction::agrees:
      return "agrees";
    case Reproduction::differs:
      return "DIFFERS";
    case Reproduction::own:
      return "own";
    case Reproduction::not_checked:
      return "not checked";
    case Reproduction::inconclusive:
      return "inconclusive";
  }
  return "";
}

Compared within(double reference, double tolerance, double ours, std::string unit) {
  return {.reference = reference, .tolerance = tolerance, .ours = ours, .unit = std::move(unit)};
}

Compared at_most(double limit, double ours, std::string unit) {
  return {.reference = limit, .ours = ours, .unit = std::move(unit), .relation = Compared::Relation::at_most};
}

Compared more_than(double limit, double ours, std::string unit) {
  return {
      .reference = limit, .ours = ours, .unit = std::move(unit), .relation = Compared::Relation::more_than};
}

Compared own(Compared compared) {
  compared.is_own = true;
  return compared;
}

Compared of_samples(Compared compared, std::uint64_t samples, std::uint64_t needed) {
  compared.is_too_few = samples < needed;
  return compared;
}

Reproduction reproduction_of(const std::optional<Compared>& compared) {
  if (!compared) return Reproduction::not_checked;
  if (compared->is_too_few || !std::isfinite(compared->ours)) return Reproduction::inconclusive;
  if (!holds(*compared)) return Reproduction::differs;
  return compared->is_own ? Reproduction::own : Reproduction::agrees;
}

std::uint64_t rows_that(const Publication& publication, Reproduction reproduction) {
  std::uint64_t rows = 0;
  for (const PublishedSection& section : publication.sections) {
    rows += static_cast<std::uint64_t>(std::ranges::count_if(section.rows, [&](const PublishedRow& row) {
      return reproduction_of(row.compared) == reproduction;
    }));
  }
  return rows;
}

std::string publication_text(const Publication& publication) {
  std::string text = fmt::format("{}\n", escaped_line(publication.title));
  for (const PublishedSection& section : publication.sections) text += section_text(section);
  std::string counts;
  for (const Reproduction one : kReproductions) {
    counts += fmt::format("{}{} {}", counts.empty() ? "\n" : ", ", rows_that(publication, one), text_of(one));
  }
  return text + counts + "\n";
}

std::string publication_json(const Publication& publication) {
  Json json = {{"schema", "fieldproof/publication/2"},
               {"title", as_utf8(publication.title)},
               {"seed", fmt::format("{}", publication.seed)},
               {"rows", Json::object()},
               {"sections", Json::array()}};
  for (const Reproduction one : kReproductions) json["rows"][text_of(one)] = rows_that(publication, one);
  for (const PublishedSection& section : publication.sections)
    json["sections"].push_back(section_json(section));
  return json.dump(1) + "\n";
}

}  // namespace fieldproof::reports
