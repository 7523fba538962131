#include "fit/report.h"

#include <fmt/format.h>

#include <algorithm>

namespace tightrope::ccd {
namespace {

std::string share(std::uint64_t part, std::uint64_t whole) {
  return fmt::format("{:.2f} %", 100 * static_cast<double>(part) / static_cast<double>(whole));
}

std::string percent(double x) { return fmt::format("{:.3f} %", 100 * x); }

std::string scene(Kind kind, const SceneFigures& f) {
  const bool faces = kind == Kind::vertex_face;
  std::string text = fmt::format("{}: {} queries", name(kind), f.queries);
  if (f.not_finite > 0) text += fmt::format(", {} of them not finite", f.not_finite);
  text += fmt::format(
      "\n  coordinates up to {:.4g}, the smallest that is not 0 {:.4g}; {} significant bits, {} of the queries fit "
      "float\n",
      f.largest, f.smallest, f.bits, share(f.floats, f.queries));
  text += fmt::format("  points of a query up to {:.4g} apart in a coordinate, displacements up to {:.4g}\n",
                      f.difference, f.displacement);
  text += fmt::format("  at rest: {} in {}, {} in {} of the queries\n", faces ? "the vertex" : "the first edge",
                      share(f.first_at_rest, f.queries), faces ? "the face" : "the second edge",
                      share(f.second_at_rest, f.queries));
  return text;
}

std::string looks(const Choice& choice) {
  constexpr const char* layout = "  {:<56} {:>10} {:>9} {:>9}\n";
  std::string text = fmt::format(fmt::runtime(layout), "first look", "left open", "ns/query", "speed-up");
  text += fmt::format(fmt::runtime(layout), "full model", "", fmt::format("{:.1f}", choice.full_nanoseconds), "1.00");
  for (const LookMeasurement& m : choice.looks) {
    text += fmt::format(fmt::runtime(layout), in_words(m.look, choice.kind, m.look.range ? "range" : ""),
                        percent(m.open), fmt::format("{:.1f}", m.nanoseconds),
                        fmt::format("{:.2f}", choice.full_nanoseconds / m.nanoseconds));
  }
  return text;
}

const LookMeasurement& measured(const Choice& choice, const Look& look) {
  return *std::find_if(choice.looks.begin(), choice.looks.end(), [&](const auto& m) { return m.look == look; });
}

/// "x: a; without it b": what one property of the look is worth.
std::string worth(const Choice& choice, bool Look::*property, const std::string& with, const std::string& without) {
  Look other = choice.look;
  other.*property = !(other.*property);
  const auto found =
      std::find_if(choice.looks.begin(), choice.looks.end(), [&](const auto& m) { return m.look == other; });
  if (found == choice.looks.end()) return fmt::format("  - {}\n", choice.look.*property ? with : without);
  const LookMeasurement& taken = measured(choice, choice.look);
  return fmt::format("  - {}: {:.1f} ns and {} open, else {:.1f} ns and {}\n", choice.look.*property ? with : without,
                     taken.nanoseconds, percent(taken.open), found->nanoseconds, percent(found->open));
}

std::string reasons(const SceneSample& sample, const Choice& choice, const FitRequest& request) {
  const bool faces = choice.kind == Kind::vertex_face;
  const SceneFigures& f = sample.figures();
  std::string text = fmt::format(
      "  chosen: {}\n",
      in_words(choice.look, choice.kind, choice.exponent ? fmt::format("range 2^{}", *choice.exponent) : ""));
  text += f.floats < f.queries ? "  - double: some coordinates are no floats\n"
                               : worth(choice, &Look::single, "float, which the coordinates are", "double");
  text += worth(choice, &Look::range, "one bound for the scene", "maxima at run time");
  if ((faces ? f.second_at_rest : f.either_at_rest) > 0) {
    text += worth(choice, &Look::at_rest, faces ? "an instance for faces at rest" : "an instance for edges at rest",
                  "no instance for rest");
  } else {
    text += faces ? "  - no face is at rest (a vertex at rest saves nothing)\n" : "  - no edge is at rest\n";
  }
  text += worth(choice, &Look::both_ends, "planes of both ends", "the plane at t = 0 alone");
  text += fmt::format("  behind it: {}", name(choice.method));
  if (request.times) text += ", the only one with exact times";
  if (!request.times && request.max_false_positives <= 0) text += ", exact: no false positives";
  text += "\n";
  for (const MethodMeasurement& m : choice.methods) {
    text += fmt::format("    {:<11} {:>9.1f} ns an open query, false positives {:.3g}\n", name(m.method), m.nanoseconds,
                        m.false_positives);
  }
  return text;
}

}  // namespace

std::string in_words(const Look& look, Kind kind, const std::string& range) {
  std::string text = look.single ? "float" : "double";
  text += ", " + (look.range ? range : std::string("run-time maxima"));
  if (look.at_rest) text += kind == Kind::vertex_face ? ", face at rest" : ", edge at rest";
  return text + (look.both_ends ? ", both ends" : "");
}

std::string report(const SceneSample& sample, const Choice& choice, const FitRequest& request) {
  std::string text = scene(choice.kind, sample.figures()) + looks(choice) + reasons(sample, choice, request);
  text += fmt::format(
      "  expected: {:.1f} ns a query, {:.2f} times as fast as the full model ({:.1f} ns); false positives {:.3g}\n",
      choice.nanoseconds, choice.full_nanoseconds / choice.nanoseconds, choice.full_nanoseconds,
      choice.false_positives);
  return text;
}

}  // namespace tightrope::ccd
