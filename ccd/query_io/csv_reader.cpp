/// Rational CSV (the public CCD benchmark's: Wang, Ferguson, Schneider, Jiang, Attene, Panozzo 2021) and plain CSV.

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <string>
#include <utility>

#include "query_io/line_reader.h"
#include "query_io/query_reader.h"
#include "query_io/rational.h"

namespace tightrope::ccd {
namespace {

constexpr std::size_t rows_per_query = 8;
constexpr std::size_t rational_fields = 7;
constexpr std::size_t most_fields = coordinates_per_query + 1;

struct Fields {
  std::array<std::string_view, most_fields> text{};
  std::size_t count = 0;  ///< all fields of the line, stored or not
};

Fields split(std::string_view line) {
  Fields fields;
  while (true) {
    const auto comma = line.find(',');
    std::string_view field = line.substr(0, comma);
    while (!field.empty() && (field.front() == ' ' || field.front() == '\t')) field.remove_prefix(1);
    while (!field.empty() && (field.back() == ' ' || field.back() == '\t')) field.remove_suffix(1);
    if (fields.count < most_fields) fields.text[fields.count] = field;
    ++fields.count;
    if (comma == std::string_view::npos) return fields;
    line.remove_prefix(comma + 1);
  }
}

/// Text of a file for a message: short, printable.
std::string quoted(std::string_view text) {
  constexpr std::size_t most = 24;
  std::string shown;
  for (const char c : text.substr(0, most)) shown += c >= ' ' && c <= '~' ? c : '?';
  return fmt::format("'{}{}'", shown, text.size() > most ? "..." : "");
}

std::optional<unsigned char> parse_truth(std::string_view text) {
  if (text == "0") return static_cast<unsigned char>(0);
  if (text == "1") return static_cast<unsigned char>(1);
  return std::nullopt;
}

/// A decimal or hexadecimal float, rounded to nearest; empty if it is none. Independent of the locale.
std::optional<double> parse_float(std::string_view text) {
  const bool negative = !text.empty() && text.front() == '-';
  if (!text.empty() && (text.front() == '-' || text.front() == '+')) text.remove_prefix(1);
  if (text.empty() || text.front() == '-' || text.front() == '+') return std::nullopt;
  const bool hex = text.starts_with("0x") || text.starts_with("0X");
  const std::string_view digits = hex ? text.substr(2) : text;
  if (digits.empty() || digits.front() == '-' || digits.front() == '+') return std::nullopt;
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value,
                                            hex ? std::chars_format::hex : std::chars_format::general);
  if (end != digits.data() + digits.size() || error == std::errc::invalid_argument) return std::nullopt;
  // from_chars leaves what it cannot represent to the caller; strtod tells overflow from underflow.
  if (error == std::errc::result_out_of_range) value = std::strtod(std::string(text).c_str(), nullptr);
  return negative ? -value : value;
}

class CsvReader final : public QueryReader {
 public:
  CsvReader(const std::filesystem::path& path, Kind kind) : lines_(path), kind_(kind) { first_ = lines_.next(); }

  std::optional<FileError> open_error() {
    if (lines_.error()) return lines_.error();
    if (first_.empty()) return FileError{fmt::format("{}: no queries in this file", lines_.path().string())};
    const std::size_t count = split(first_).count;
    rational_ = count == rational_fields;
    has_truth_ = rational_ || count == most_fields;
    if (!rational_ && count != coordinates_per_query && count != most_fields) {
      return here(fmt::format(
          "{} fields; a row has 7 (xn,xd,yn,yd,zn,zd,truth; 8 rows a query), or 24 coordinates and perhaps the truth",
          count));
    }
    return std::nullopt;
  }

  std::optional<FileError> next(std::size_t limit, QueryBlock& block) override {
    block.clear();
    block.kind = kind_;
    while (block.size() < limit) {
      const std::string_view line = first_.empty() ? lines_.next() : std::exchange(first_, {});
      if (line.empty()) break;
      if (auto error = rational_ ? rational_query(line, block) : plain_query(line, block)) return error;
    }
    return lines_.error();
  }

  std::uint64_t rounded() const override { return rounded_; }

 private:
  FileError here(std::string_view what) const {
    return {fmt::format("{}:{}: {}", lines_.path().string(), lines_.line_number(), what)};
  }
  std::optional<FileError> wrong_count(const Fields& fields, std::size_t wanted) const {
    if (fields.count == wanted) return std::nullopt;
    return here(fmt::format("{} fields instead of {}", fields.count, wanted));
  }
  std::optional<FileError> rational_query(std::string_view line, QueryBlock& block);
  std::optional<FileError> rational_row(std::string_view line, QueryBlock& block, unsigned char& truth);
  std::optional<FileError> plain_query(std::string_view line, QueryBlock& block);

  LineReader lines_;
  Kind kind_;
  std::string_view first_;  ///< the row that told the format, until it is read as a query
  bool rational_ = false;
  bool has_truth_ = false;
  std::uint64_t rounded_ = 0;
};

std::optional<FileError> CsvReader::rational_row(std::string_view line, QueryBlock& block, unsigned char& truth) {
  const Fields fields = split(line);
  if (auto error = wrong_count(fields, rational_fields)) return error;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::string_view numerator = fields.text[2 * k];
    const std::string_view denominator = fields.text[2 * k + 1];
    const Rational coordinate = parse_rational(numerator, denominator);
    if (!coordinate.fault.empty()) {
      return here(fmt::format("{} in {},{}", coordinate.fault, quoted(numerator), quoted(denominator)));
    }
    if (!coordinate.exact) ++rounded_;
    block.points.push_back(coordinate.value);
  }
  const auto parsed = parse_truth(fields.text[6]);
  if (!parsed) return here(fmt::format("truth {} is neither 0 nor 1", quoted(fields.text[6])));
  truth = *parsed;
  return std::nullopt;
}

std::optional<FileError> CsvReader::rational_query(std::string_view line, QueryBlock& block) {
  unsigned char truth = 0;
  if (auto error = rational_row(line, block, truth)) return error;
  for (std::size_t row = 1; row < rows_per_query; ++row) {
    line = lines_.next();
    if (lines_.error()) return lines_.error();
    if (line.empty()) return here(fmt::format("the last query has {} of {} rows", row, rows_per_query));
    unsigned char truth_of_row = 0;
    if (auto error = rational_row(line, block, truth_of_row)) return error;
    if (truth_of_row != truth) {
      return here(fmt::format("truth {} where the query's rows before have {}", truth_of_row, truth));
    }
  }
  block.truths.push_back(truth);
  return std::nullopt;
}

std::optional<FileError> CsvReader::plain_query(std::string_view line, QueryBlock& block) {
  const Fields fields = split(line);
  if (auto error = wrong_count(fields, coordinates_per_query + (has_truth_ ? 1 : 0))) return error;
  for (std::size_t k = 0; k < coordinates_per_query; ++k) {
    const auto coordinate = parse_float(fields.text[k]);
    if (!coordinate) return here(fmt::format("{} is not a number", quoted(fields.text[k])));
    if (!std::isfinite(*coordinate)) return here(fmt::format("{} is not finite as a double", quoted(fields.text[k])));
    block.points.push_back(*coordinate);
  }
  if (!has_truth_) return std::nullopt;
  const auto truth = parse_truth(fields.text[coordinates_per_query]);
  if (!truth) return here(fmt::format("truth {} is neither 0 nor 1", quoted(fields.text[coordinates_per_query])));
  block.truths.push_back(*truth);
  return std::nullopt;
}

}  // namespace

OpenedReader open_csv(const std::filesystem::path& path, Kind kind) {
  auto reader = std::make_unique<CsvReader>(path, kind);
  if (auto error = reader->open_error()) return *std::move(error);
  return reader;
}

}  // namespace tightrope::ccd
