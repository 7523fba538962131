#include "codegen/charts/write_chart.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>

#include "codegen/charts/gnuplot.h"
#include "codegen/charts/html.h"
#include "codegen/charts/text.h"

namespace tightrope::charts {
namespace {

namespace fs = std::filesystem;

enum class Format { svg, png, html };

std::optional<Format> format_of(const std::string& file) {
  std::string extension = fs::path(file).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (extension == ".svg") return Format::svg;
  if (extension == ".png") return Format::png;
  if (extension == ".html") return Format::html;
  return std::nullopt;
}

std::string cannot_write(const std::string& file, const std::string& why) {
  return fmt::format("cannot write {}: {}", file, why);
}

/// Writes to a temporary name beside the file, which then takes its place.
std::string write_whole(const std::string& file, const std::string& bytes) {
  const std::string temporary = fmt::format("{}.{}.tmp", file, ::getpid());
  errno = 0;
  std::ofstream stream(temporary, std::ios::binary | std::ios::trunc);
  stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  stream.close();
  std::error_code error;
  if (!stream) {
    const std::string why = std::strerror(errno);
    fs::remove(temporary, error);
    return cannot_write(file, why);
  }
  fs::rename(temporary, file, error);
  if (!error) return "";
  const std::string why = error.message();
  fs::remove(temporary, error);
  return cannot_write(file, why);
}

void replace_all(std::string& text, const std::string& what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size())) {
    text.replace(at, what.size(), by);
  }
}

/// gnuplot's SVG with the chart's own title and description, which screen readers read, and with markers drawn
/// bolder.
std::string finished(std::string svg, const Chart& chart) {
  const auto fill = [&](const std::string& element, const std::string& text) {
    const std::string open = "<" + element + ">";
    const std::size_t begin = svg.find(open);
    const std::size_t end = svg.find("</" + element + ">");
    if (begin == std::string::npos || end == std::string::npos || end < begin) return;
    svg.replace(begin + open.size(), end - begin - open.size(), escaped(printable(text)));
  };
  fill("title", chart.title);
  fill("desc", chart.subtitle + ". " + chart.caption);
  // Thin strokes are as thick as the marker is large; rings, which are large, stay as they are.
  replace_all(svg, "stroke-width='0.222'", "stroke-width='0.32'");
  replace_all(svg, "<circle id='gpPt5' stroke-width='0.32'", "<circle id='gpPt5' stroke-width='0.16'");
  return svg;
}

}  // namespace

std::string check_chart_file(const std::string& file) {
  if (!format_of(file)) return fmt::format("{}: a chart is a .svg, .png or .html file", file);
  if (find_gnuplot().empty()) return "charts need gnuplot, which is not installed (Debian package gnuplot-nox)";
  std::error_code error;
  if (fs::is_directory(file, error)) return cannot_write(file, "is a directory");
  const std::string temporary = fmt::format("{}.{}.tmp", file, ::getpid());
  errno = 0;
  if (!std::ofstream(temporary, std::ios::binary)) return cannot_write(file, std::strerror(errno));
  fs::remove(temporary, error);
  return "";
}

std::string write_chart(const Chart& chart, const std::string& file) {
  const auto format = format_of(file);
  if (!format) return check_chart_file(file);
  const Layout place = layout(chart);
  auto drawn = draw(chart, place, *format == Format::png ? Terminal::png : Terminal::svg);
  if (const auto* failure = std::get_if<Failure>(&drawn)) return failure->message;
  std::string bytes = std::get<std::string>(std::move(drawn));
  if (*format != Format::png) bytes = finished(std::move(bytes), chart);
  if (*format == Format::html) bytes = html_page(chart, place, bytes);
  return write_whole(file, bytes);
}

}  // namespace tightrope::charts
