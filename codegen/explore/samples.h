#pragma once
/// Inputs to measure schemes on, and the exact values of the predicate there.

#include <tightrope/enclosure.h>

#include <span>
#include <string>
#include <vector>

#include "codegen/bounds.h"

namespace tightrope::codegen::explore {

/// One number an input slot, in the order of dsl::Predicate::slots.
using Row = std::vector<double>;

/// An element of an output.
struct Place {
  std::size_t stage = 0;
  std::size_t output = 0;
  std::size_t element = 0;
};

/// The elements of all outputs of the stages up to `last_stage`, in order.
std::vector<Place> places(const dsl::Predicate& predicate, std::size_t last_stage);

/// A row near the zero set of one element of a `sign` output.
struct NearZero {
  Row row;
  std::size_t place = 0;  ///< in places()
  int sign = 0;           ///< of the exact value; 0 if it is 0
};

struct Samples {
  std::vector<Row> rows;
  std::vector<std::vector<Enclosure>> exact;  ///< by row and place
  std::vector<NearZero> near_zero;
};

/// Seeded random rows: half of them `spread`, half `close`, as tightrope report --measure has them (codegen/measure.h).
std::vector<Row> random_rows(const dsl::Predicate& predicate, Precision inputs, int count);

/// Rows of a CSV file: one number a slot, decimal or hexadecimal; empty lines and lines that begin with '#' are none.
/// Returns "" or one line on what is wrong with it. In single precision numbers that are no floats are rounded.
std::string read_rows(const std::string& file, const dsl::Predicate& predicate, Precision inputs,
                      std::vector<Row>& rows);

/// The rows with the exact values of the predicate, as many as an exact evaluation of all of them may take; and rows
/// near zero: on the way from one row to another on which a sign changes, the place of the change, off by 2^-j of the
/// way, j uniform over the last two fifths of the digits. A bound that is twice as large leaves about one j more
/// undecided.
Samples samples(const dsl::Predicate& predicate, std::vector<Row> rows, Precision inputs, std::size_t last_stage);

}  // namespace tightrope::codegen::explore
