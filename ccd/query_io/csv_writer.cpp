#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <map>

#include "query_io/query_writer.h"
#include "query_io/rational.h"
#include "query_io/unfinished_file.h"

namespace tightrope::ccd {
namespace {

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

struct Output {
  UnfinishedFile place;
  std::unique_ptr<std::FILE, Close> file;
};

void append_query(std::string& text, const double* points, unsigned char truth) {
  for (std::size_t point = 0; point < 8; ++point) {
    for (std::size_t k = 0; k < 3; ++k) {
      append_rational(text, points[3 * point + k]);
      text += ',';
    }
    text += truth != 0 ? "1\n" : "0\n";
  }
}

class RationalCsvWriter final : public QueryWriter {
 public:
  RationalCsvWriter(std::filesystem::path directory, std::string stem)
      : directory_(std::move(directory)), stem_(std::move(stem)) {}

  std::optional<FileError> append(const QueryBlock& block) override {
    if (block.size() == 0) return std::nullopt;
    auto found = outputs_.find(block.kind);
    if (found == outputs_.end()) {
      if (auto error = open(block.kind)) return error;
      found = outputs_.find(block.kind);
    }
    text_.clear();
    for (std::size_t i = 0; i < block.size(); ++i) {
      append_query(text_, block.points.data() + i * coordinates_per_query, block.truths[i]);
    }
    if (std::fwrite(text_.data(), 1, text_.size(), found->second.file.get()) != text_.size()) {
      return failed(found->second.place.final_path());
    }
    return std::nullopt;
  }

  std::optional<FileError> commit() override {
    for (auto& [kind, output] : outputs_) {
      if (std::fclose(output.file.release()) != 0) return failed(output.place.final_path());
    }
    for (auto& [kind, output] : outputs_) {
      if (auto error = output.place.commit()) return error;
    }
    outputs_.clear();
    return std::nullopt;
  }

 private:
  static FileError failed(const std::filesystem::path& path) {
    return {fmt::format("{}: {}", path.string(), std::strerror(errno))};
  }

  std::optional<FileError> open(Kind kind) {
    const std::filesystem::path folder = directory_ / std::string(name(kind));
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) return FileError{fmt::format("{}: {}", folder.string(), error.message())};
    UnfinishedFile place(folder / (stem_ + ".csv"));
    std::unique_ptr<std::FILE, Close> file(std::fopen(place.path().c_str(), "wb"));
    if (!file) return failed(place.final_path());
    outputs_.emplace(kind, Output{std::move(place), std::move(file)});
    return std::nullopt;
  }

  std::filesystem::path directory_;
  std::string stem_;
  std::map<Kind, Output> outputs_;
  std::string text_;
};

}  // namespace

OpenedWriter create_rational_csv(const std::filesystem::path& directory, const std::string& stem) {
  return std::make_unique<RationalCsvWriter>(directory, stem);
}

}  // namespace tightrope::ccd
